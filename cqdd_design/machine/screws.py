"""The screwed joints of a machine: what clamps them, and what would part them at peak torque."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from cqdd_design.catalog.materials import Material, find_material
from cqdd_design.catalog.threads import coarse_thread, thread_named
from cqdd_design.catalog.tightening import GRIP_FRICTION, Clamping
from cqdd_design.design.reducer import Reducer
from cqdd_design.machine.machine import Machine
from cqdd_design.machine.output_loads import output_loads
from cqdd_design.solids import mounting
from cqdd_design.solids.features.carrier import OUTPUT_BOLTS
from cqdd_design.solids.motor_rules import bell_torque
from cqdd_design.solids.mounting import SCREW_MATERIAL
from cqdd_design.solids.selection import CapScrew


@dataclass(frozen=True)
class ScrewJoint:
    """Equal screws on a circle.

    Attributes
    ----------
    place, screw : str
        What they hold, and which they are, in words.
    across, along : float
        Force that would make one slip, and that pulls it, N.
    cure : str
        What would hold it better.
    """

    place: str
    screw: str
    count: int
    clamping: Clamping
    across: float
    along: float
    cure: str = ""

    @property
    def stripping_safety(self) -> float | None:
        """Force that strips its thread over the greatest preload; None where not judged."""
        strips, preload = self.clamping.stripping, self.clamping.preload
        if strips is None:
            return None
        return strips / preload if preload > 0.0 else 0.0

    @property
    def slip_safety(self) -> float:
        """Least clamping force over what the forces ask for; endless where none do."""
        return self._safety(self.clamping.least_preload)

    @property
    def held_safety(self) -> float | None:
        """The same after 1000 h; None where the creep of a plastic is not known."""
        held = self.clamping.held_preload
        return None if held is None else self._safety(held)

    def _safety(self, preload: float) -> float:
        if self.across <= 0.0:
            return preload / self.along if self.along > 0.0 else math.inf
        return max(preload - self.along, 0.0) * GRIP_FRICTION / self.across


@dataclass(frozen=True)
class Tightened:
    """Equal screws as they are tightened.

    Attributes
    ----------
    place, screw : str
        What they hold, and which they are, in words.
    """

    place: str
    screw: str
    count: int
    clamping: Clamping


def tightened_screws(machine: Machine) -> tuple[Tightened, ...]:
    """Every screwed joint that is drawn, as it is put together; no load is worked out for it.

    Raises
    ------
    GeometryError
        When the machine cannot be laid out.
    """
    every = [_cover_screws(machine), _mounting_screws(machine), _output_screws(machine)]
    every += [_pin_screws(machine), _column_screws(machine), _motor_cover_screws(machine)]
    return tuple(one for one in every if one is not None)


def tightening_torques(machine: Machine) -> dict[str, float]:
    """Torque of every screw that holds a joint, N m, by the name of its part."""
    screws = {
        "cover screw": _cover_screws(machine),
        "shoulder screw": _pin_screws(machine),
        "column screw": _column_screws(machine),
        "motor cover screw": _motor_cover_screws(machine),
    }
    return {name: one.clamping.torque for name, one in screws.items() if one is not None}


def _loaded(screws: Tightened, across: float, along: float, cure: str = "") -> ScrewJoint:
    return ScrewJoint(
        screws.place, screws.screw, screws.count, screws.clamping, across, along, cure
    )


def _harder_or(screws: Tightened, cure: str, metal: str = "housing.material") -> str:
    """A stronger metal, where head's seat or thread yield before the screw; else another cure."""
    return cure if screws.clamping.screw_yields else f"take a stronger {metal}"


def screw_joints(machine: Machine) -> tuple[ScrewJoint, ...]:
    """Every screwed joint that is drawn, but for the encoder's board, which holds nothing else.

    Raises
    ------
    ContactError
        When the peak torque has no equilibrium.
    GeometryError
        When the machine cannot be laid out.
    """
    every = [
        _cover(machine),
        _mounting(machine),
        _output(machine),
        _unloaded(_pin_screws(machine)),
        _columns(machine),
        _motor_cover(machine),
    ]
    coldest = machine.design.environment.coldest
    return tuple(_in_the_cold(one, coldest) for one in every if one is not None)


def _in_the_cold(joint: ScrewJoint, coldest: float) -> ScrewJoint:
    """The joint at the coldest it meets (deg C), and what helps where that leaves no preload."""
    clamping = replace(joint.clamping, coldest=coldest)
    if clamping.least_preload > 0.0 or joint.clamping.least_preload <= 0.0:
        return replace(joint, clamping=clamping)
    cure = f"take a material that shrinks less, for cold of {coldest:g} degC takes all its preload"
    return replace(joint, clamping=clamping, cure=cure)


def _unloaded(screws: Tightened | None) -> ScrewJoint | None:
    return None if screws is None else _loaded(screws, 0.0, 0.0)


def _cover(machine: Machine) -> ScrewJoint:
    """Between them cover and clamp hold the output bearing: what it carries parts them."""
    housing, loads = machine.layout.housing, output_loads(machine, machine.peak_pack)
    around = housing.screw_count * housing.bolt_circle_radius
    pulled = loads.axial / housing.screw_count + 2.0 * loads.moment / around
    return _loaded(
        _cover_screws(machine),
        float(loads.radial.max()) / housing.screw_count,
        float(pulled.max()),
        _less_push(machine.design.reducer),
    )


def _less_push(reducer: Reducer) -> str:
    """What pushes the carrier less to one side."""
    wider = "a larger output_pins.circle_radius"
    if reducer.disc_count < 2:
        return f"two discs, and {wider}, push the carrier less to one side"
    if reducer.output_pins.count % 2:
        return f"an even number of output_pins, and {wider}, push the carrier less to one side"
    return f"{wider} pushes the carrier less to one side"


def _cover_screws(machine: Machine) -> Tightened:
    layout, housing = machine.layout, machine.layout.housing
    metal, grip = _housing_metal(machine), housing.cover_flange_top - layout.pack.top
    screw = housing.screw
    engaged = min(screw.length - grip, layout.pack.top - housing.flange_bottom)
    return Tightened(
        "cover and ring clamp on the housing",
        screw.designation,
        housing.screw_count,
        _clamping(screw, metal, grip=grip, engaged=engaged, faces=2),
    )


def _mounting(machine: Machine) -> ScrewJoint:
    """Between these, from what the actuator is fixed to into the housing's flange."""
    housing, asked = machine.layout.housing, machine.design.requirements
    across, along = mounting.forces(asked, housing.screw_count, housing.bolt_circle_radius)
    return _loaded(
        _mounting_screws(machine),
        across,
        along,
        "raise ring.outer_diameter, or let dowels of what it is fixed to carry it",
    )


def _mounting_screws(machine: Machine) -> Tightened:
    housing = machine.layout.housing
    return Tightened(
        "housing on its machine, by friction",
        f"M{1e3 * housing.mount_thread:g} of 12.9 in the mounting holes",
        housing.screw_count,
        mounting.clamping(
            housing.mount_thread,
            housing.cover_flange_top - housing.face,
            housing.face - housing.flange_bottom,
            _housing_metal(machine),
        ),
    )


def _output(machine: Machine) -> ScrewJoint | None:
    """Dowels hold the torque; the bolts hold what tilts and pulls."""
    carrier, asked = machine.layout.carrier, machine.design.requirements
    screws = _output_screws(machine)
    if screws is None:
        return None
    tilting = 2.0 * (asked.external_moment or 0.0) / (OUTPUT_BOLTS * carrier.bolt_circle_radius)
    return _loaded(
        screws,
        0.0,
        (asked.external_axial or 0.0) / OUTPUT_BOLTS + tilting,
        _harder_or(
            screws,
            "raise output_pins.circle_radius, which sets them farther out",
            "carrier.material",
        ),
    )


def _output_screws(machine: Machine) -> Tightened | None:
    carrier = machine.layout.carrier
    if not carrier.bolt_thread:
        return None
    metal, steel = _carrier_metal(machine), find_material(SCREW_MATERIAL)
    size = carrier.bolt_thread
    return Tightened(
        "output's face",
        f"M{1e3 * size:g} of 12.9, {1e3 * carrier.bolt_depth:.3g} mm deep",
        OUTPUT_BOLTS,
        Clamping(
            thread=coarse_thread(size),
            screw=steel,
            # Of the other part nothing is known: steel, one and a half diameters thick.
            clamped=steel,
            tapped=metal,
            bearing_outer=1.7 * size,
            bearing_inner=1.1 * size,
            grip=1.5 * size,
            engaged=carrier.bolt_depth,
            faces=1,
        ),
    )


def _pin_screws(machine: Machine) -> Tightened | None:
    """The shoulder's end on its step in the plate; its seat holds the forces across."""
    pin, metal = machine.layout.carrier.pin, _carrier_metal(machine)
    if pin.screw is None:
        return None
    return Tightened(
        "output pins in the carrier plate",
        f"shoulder screws {pin.screw.thread}",
        machine.layout.carrier.pin_count,
        Clamping(
            thread=thread_named(pin.screw.thread, pin.thread_diameter),
            screw=find_material(machine.design.reducer.output_pins.material),
            clamped=metal,
            tapped=metal,
            bearing_outer=pin.nominal_diameter,
            bearing_inner=pin.thread_diameter,
            grip=0.0,
            engaged=pin.thread_length,
            faces=0,
        ),
    )


def _columns(machine: Machine) -> ScrewJoint | None:
    """Half of the torque comes from the cap, which the columns' ends carry by friction."""
    carrier, screws = machine.layout.carrier, _column_screws(machine)
    if screws is None:
        return None
    half = 0.5 * machine.design.requirements.peak_torque
    return _loaded(
        screws,
        half / (screws.count * carrier.pin_circle_radius),
        0.0,
        "raise carrier.column_diameter, whose screw grows with it",
    )


def _column_screws(machine: Machine) -> Tightened | None:
    carrier = machine.layout.carrier
    columns = carrier.columns
    if columns is None:
        return None
    metal, screw = _carrier_metal(machine), columns.screw
    return Tightened(
        "columns between plate and cap",
        screw.designation,
        columns.count,
        replace(
            _clamping(
                screw,
                metal,
                grip=carrier.plate_bottom - columns.seat,
                engaged=columns.thread_top - carrier.plate_bottom,
                faces=2,
            ),
            bearing_outer=min(screw.head_diameter, 2.0 * columns.radius),
            bearing_inner=2.0 * columns.bore_radius,
        ),
    )


def _motor_cover(machine: Machine) -> ScrewJoint | None:
    """The stator of an inrunner turns back on its cover; over an outrunner it carries nothing."""
    screws, inrunner = _motor_cover_screws(machine), machine.layout.inrunner
    if screws is None or inrunner is None:
        return _unloaded(screws)
    torque = bell_torque(machine.design, machine.layout.motor_row)
    return _loaded(
        screws,
        torque / (screws.count * inrunner.ear_circle),
        0.0,
        _harder_or(screws, "lower motor.current_limit, whose torque they hold"),
    )


def _motor_cover_screws(machine: Machine) -> Tightened | None:
    motor, metal = machine.layout.motor_end, _housing_metal(machine)
    if motor is None:
        return None
    screw, grip = motor.cover_screw, motor.cover_grip
    carried = "nothing" if machine.layout.inrunner is None else "the stator"
    return Tightened(
        f"motor's cover, which carries {carried}",
        screw.designation,
        motor.ear_count,
        _clamping(
            screw, metal, grip=grip, engaged=min(screw.length - grip, motor.cover_engaged), faces=1
        ),
    )


def _clamping(
    screw: CapScrew, metal: Material, *, grip: float, engaged: float, faces: int
) -> Clamping:
    """Of a cap screw through one part into another of the same metal."""
    return Clamping(
        thread=coarse_thread(screw.thread),
        screw=find_material(SCREW_MATERIAL),
        clamped=metal,
        tapped=metal,
        bearing_outer=screw.head_diameter,
        bearing_inner=1.1 * screw.thread,
        grip=grip,
        engaged=engaged,
        faces=faces,
    )


def _housing_metal(machine: Machine) -> Material:
    return find_material(machine.design.housing.material)


def _carrier_metal(machine: Machine) -> Material:
    return find_material(machine.design.carrier_material)
