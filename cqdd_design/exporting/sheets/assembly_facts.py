"""What the assembly drawing says: parts, torques, adhesives, grease, and the order of assembly."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from cqdd_design.catalog.adhesives import NUT_LOCKING
from cqdd_design.catalog.tightening import torque_words
from cqdd_design.exporting.bill.consumables import INSERT, consumables
from cqdd_design.exporting.bill.substitutes import bought_of, ordered
from cqdd_design.exporting.sheets.wording import joint_note
from cqdd_design.machine.centring import centring
from cqdd_design.machine.grease import grease_fill
from cqdd_design.machine.motor_standing import motor_standing
from cqdd_design.machine.ring_seating import ring_seating
from cqdd_design.machine.screws import tightened_screws
from cqdd_design.machine.sealing import sealing
from cqdd_design.machine.set_heights import set_heights
from cqdd_design.solids.apart import Step, taken_apart, unit_name
from cqdd_design.solids.features.carrier import OUTPUT_BOLTS, OUTPUT_REGISTER
from cqdd_design.solids.features.kinds import AxialThread, Joint, Seat
from cqdd_design.solids.part import overall_size
from cqdd_design.solids.tool_access import reaches

if TYPE_CHECKING:
    from cqdd_design.machine import Machine
    from cqdd_design.solids.stations import Station

_MM = 1e3
_RUN_OUT = "0.2"
"""Circular run-out of class K (ISO 2768-2), mm."""
_SIDES = {"up": "from the output side", "down": "from the motor side"}

PLAY_HEAD = ("axial play", "room, mm", "r.s.s., mm", "shims, mm", "play, mm")
PARTS_HEAD = ("item", "qty", "part", "designation", "material", "g each")


class AssemblyFacts:
    """A machine on its assembly drawing."""

    def __init__(self, machine: Machine) -> None:
        self.machine = machine
        self.design = machine.given
        self.parts = machine.parts

    @property
    def number(self) -> str:
        """Of the drawing, and the stem of its files."""
        return f"{self.design.file_name}-assembly"

    @property
    def mass(self) -> float:
        """Of all pieces as drawn, kg."""
        return sum(part.mass * part.count for part in self.parts)

    def parts_list(self) -> list[tuple[str, ...]]:
        """A row a line of the bill of materials, in its numbers and words."""
        rows = [
            (
                str(part.count),
                part.name,
                ordered(part.designation),
                bought_of(part),
                f"{1e3 * part.mass:.4g}",
            )
            for part in self.parts
        ]
        if self.machine.layout.motor_end is None:
            motor = self.machine.motor
            mass = "" if motor.mass is None else f"{1e3 * motor.mass:.4g}"
            rows.append(("1", "motor", motor.name, "", mass))
        rows += [
            (str(one.quantity), one.name, one.designation, "", "")
            for one in consumables(self.machine)
        ]
        return [(str(item), *row) for item, row in enumerate(rows, start=1)]

    def torques(self) -> list[tuple[str, ...]]:
        """A row a screwed joint: place, screws, tightening torque."""
        return [
            (
                one.place,
                f"{one.count} \u00d7 {one.screw}",
                torque_words(one.clamping.torque),
            )
            for one in tightened_screws(self.machine)
        ]

    def plays(self) -> list[tuple[str, ...]]:
        """A row a stack: what moves, its room at worst and likely limits, packs, play left."""
        return [
            (
                one.name,
                _span(one.worst),
                _span(one.likely),
                "none" if one.packs is None else _span(one.packs),
                _span(one.play),
            )
            for one in self.machine.told_stacks
        ]

    def notes(self) -> list[str]:
        """Adhesives, grease and what to measure."""
        said: list[str] = []
        for part in self.parts:
            for feature in part.features:
                if isinstance(feature, Joint) and feature.kind != "screwed":
                    said.append(f"{_capital(part.name)}: {joint_note(feature)}")
        said += self._inserts()
        said.append(self._grease())
        said.append(ring_seating(self.machine))
        said.append(motor_standing(self.machine))
        said += set_heights(self.machine)
        said.append(self._nut())
        said += [sealing(self.machine), centring(self.machine)]
        said += [self.interfaces(), self.driven(), self.mounting()]
        said.append(
            f"Turned by hand, the output's face and seat run true to the housing within {_RUN_OUT} "
            "mm (ISO 2768-K); the parts' own run-outs stand on their sheets."
        )
        said.append("Screws lightly oiled; torques by VDI 2230 for a torque wrench.")
        return said

    def _inserts(self) -> list[str]:
        """When those in plastic go in, which stand in no view and in no step."""
        items = [row[0] for row in self.parts_list()[len(self.parts) :] if row[2] == INSERT]
        if not items:
            return []
        return [
            f"Items {', '.join(items)}, heat-set inserts, are melted into their holes before "
            "anything is put together; the section shows none."
        ]

    def _nut(self) -> str:
        (nut,) = (part for part in self.parts if part.name == "bearing nut")
        (thread,) = (one for one in nut.features if isinstance(one, AxialThread))
        outside = 2e3 * self.machine.layout.carrier.output.shoulder_radius
        return (
            f"Bearing nut, {thread.designation}: as firm as a hook spanner for \u00d8{outside:.4g} "
            f"makes it by hand; it holds the ring to its shoulder and sets no play. {NUT_LOCKING}"
        )

    def driven(self) -> str:
        """How what the output drives is centred on it."""
        (plate,) = (part for part in self.parts if part.name == "carrier plate")
        seats = (one for one in plate.features if isinstance(one, Seat))
        (bore,) = (one for one in seats if one.name == OUTPUT_REGISTER)
        by_spigot = (
            "What is driven is centred by a spigot in the output's bore, "
            f"\u00d8{1e3 * bore.diameter:.4g} {bore.zone} and {1e3 * (bore.top - bore.bottom):.3g} "
            "mm deep"
        )
        if not self.machine.layout.carrier.flange_dowels.count:
            return f"{by_spigot}."
        return f"{by_spigot}, or by the dowels of the output's face: the other needs play then."

    def interfaces(self) -> str:
        """Sizes that what it is built into has to know."""
        housing, carrier = self.machine.layout.housing, self.machine.layout.carrier
        diameter, length = overall_size(self.parts)
        output = "no thread in the output's face"
        if carrier.bolt_thread:
            output = (
                f"output {OUTPUT_BOLTS} \u00d7 M{_MM * carrier.bolt_thread:g} on "
                f"\u00d8{2.0 * _MM * carrier.bolt_circle_radius:.4g}"
            )
        return (
            f"Overall \u00d8{_MM * diameter:.4g} \u00d7 {_MM * length:.4g} mm. Fixed by "
            f"{housing.screw_count} \u00d7 M{_MM * housing.mount_thread:g} on "
            f"\u00d8{2.0 * _MM * housing.bolt_circle_radius:.4g}, between the cover's screws, "
            f"whose heads stand {_MM * housing.screw.head_height:.3g} mm above its flange and "
            f"need room there; {output}."
        )

    def mounting(self) -> str:
        """How the machine is fixed to another, and how long the screws may be."""
        housing = self.machine.layout.housing
        through = housing.cover_flange_top - housing.face
        most = housing.cover_flange_top - housing.flange_bottom
        screws = f"{housing.screw_count} screws M{1e3 * housing.mount_thread:g}"
        return (
            f"The actuator is fixed by {screws} from the output's side, through cover and clamp "
            f"into the housing's flange: {1e3 * (through + housing.mount_thread):.3g} to "
            f"{1e3 * most:.3g} mm longer than what they hold is thick. Longer ones come out behind "
            "it, where the motor may be."
        )

    def _grease(self) -> str:
        fill = grease_fill(self.machine)
        return (
            f"Fill the space round the discs with {fill.lubricant.name}: {1e6 * fill.volume:.2g} "
            f"cm\u00b3, {1e3 * fill.mass:.2g} g, a third of what is free there."
        )

    @cached_property
    def _apart(self) -> tuple[tuple[Step, ...], bool]:
        return taken_apart(self.machine.design, self.parts)

    def order(self) -> list[str]:
        """Steps in which the machine is put together; none where it was not found how."""
        steps, whole = self._apart
        if not whole:
            return []
        said: list[str] = []
        keys = {one.screw: one.size for one in reaches(self.machine.design, steps)}
        benches: set[str] = set()
        for step in reversed(steps):
            what = f"the {unit_name(step)}" if step.is_unit else _pieces(step.moved[0])
            begun = step.unit in benches if step.unit else bool(said)
            benches.add(step.unit)
            how = _SIDES[step.way] if begun else "to begin with"
            bench = f"{step.unit}: " if step.unit else ""
            size = keys.get(step.moved[0].part.name)
            key = "" if size is None or step.is_unit else f", key {1e3 * size:.3g}"
            said.append(f"{bench}{what}, {how}{key}")
        return said


def _span(pair: tuple[float, float]) -> str:
    return " to ".join(f"{1e3 * value:.2f}" for value in pair)


def _pieces(station: Station) -> str:
    count = len(station.pieces)
    return f"{count} \u00d7 {station.part.name}" if count > 1 else station.name


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
