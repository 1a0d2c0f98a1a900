"""Axial play of the bearings: the room between their faces as a tolerance stack of the parts.

Along each loop from a bearing's face through the parts to the face that stops it, lengths add up
with their signs; each has the limits that its part's sheet gives it, a bearing's width those of
ISO 492. What is left is the room for shims and play (see `shims`), or the play itself where nothing
sets it. A bearing's own play between its rings is not in it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from cqdd_design.catalog.bearings import width_tolerance
from cqdd_design.catalog.fits import general_tolerance
from cqdd_design.catalog.materials import find_material
from cqdd_design.errors import DesignError
from cqdd_design.solids.features.flat import thickness_limits
from cqdd_design.solids.features.holes import FittedHole
from cqdd_design.solids.features.kinds import Shoulder
from cqdd_design.solids.features.making import BEARING_FACE
from cqdd_design.solids.layout import Layout, ShimLayout
from cqdd_design.solids.part import Part
from cqdd_design.solids.selection import ChosenBearing
from cqdd_design.solids.shims import SHAFT_SET, ShimSet, output_set

SHOULDER_SCREW_LENGTH = 0.25e-3
"""By which the shoulder of a screw may be longer than nominal, m (ISO 7379: +0.25/0)."""
_ROUNDING = 1e-9
_DRAWN = 20.0
"""deg C, at which lengths hold (ISO 1)."""


@dataclass(frozen=True)
class Length:
    """A member of a stack, m.

    Attributes
    ----------
    part : str
        Whose length it is.
    what : str
        Between which faces.
    nominal : float
        Positive where more of it makes more room.
    lower, upper : float
        Limits of what the part adds to the room beyond nominal.
    material, node : str
        Catalogue name, and whose temperature it has.
    """

    part: str
    what: str
    nominal: float
    lower: float
    upper: float
    material: str
    node: str


@dataclass(frozen=True)
class AxialStack:
    """A loop through a bearing.

    Attributes
    ----------
    name : str
        Of what moves.
    lengths : tuple of Length
    shims : ShimLayout or None
        Between which and the bearing the play lies; None where lengths alone set it.
    kit : ShimSet or None
        Rings there are for it.
    """

    name: str
    lengths: tuple[Length, ...]
    shims: ShimLayout | None = None
    kit: ShimSet | None = None

    @property
    def nominal(self) -> float:
        """Room with nominal lengths, m."""
        return math.fsum(one.nominal for one in self.lengths)

    @property
    def worst(self) -> tuple[float, float]:
        """Least and most room with every length at its limit, m."""
        return (
            self.nominal + math.fsum(one.lower for one in self.lengths),
            self.nominal + math.fsum(one.upper for one in self.lengths),
        )

    @property
    def likely(self) -> tuple[float, float]:
        """The same as the root of the sum of squares about the mean, m: limits taken as 3 sigma."""
        mean = 0.5 * sum(self.worst)
        half = 0.5 * math.sqrt(math.fsum((one.upper - one.lower) ** 2 for one in self.lengths))
        return mean - half, mean + half

    @property
    def packs(self) -> tuple[float, float] | None:
        """Thinnest and thickest pack that may be needed, m; None without shims."""
        if self.kit is None:
            return None
        least, most = self.worst
        return max(least - self.kit.most_play, 0.0), most - self.kit.most_play

    @property
    def play(self) -> tuple[float, float]:
        """Least and most play that is left at 20 deg C, m; negative: parts press on each other."""
        least, most = self.worst
        if self.kit is None:
            return least, most
        return min(self.kit.least_play, least), max(self.kit.most_play, most - self.kit.most)

    @property
    def clamped(self) -> bool:
        """Whether shims take all play away."""
        return self.kit is not None and self.kit.clamps

    @property
    def reserve(self) -> float:
        """Least play, m, or by how much the thickest pack falls short, negative.

        Endless where a pack clamps, which is to leave none.
        """
        least, most = self.play
        short = 0.0 if self.kit is None else most - self.kit.most_play
        if short > _ROUNDING:
            return -short
        return math.inf if self.clamped else least

    def to_dict(self) -> dict[str, object]:
        """The JSON form, mm."""

        def told(pair: tuple[float, float] | None) -> list[float] | None:
            return None if pair is None else [1e3 * value for value in pair]

        return {
            "what": self.name,
            "lengths": [
                {
                    "part": one.part,
                    "between": one.what,
                    "nominal_mm": 1e3 * one.nominal,
                    "limits_mm": [1e3 * one.lower, 1e3 * one.upper],
                }
                for one in self.lengths
            ],
            "room_worst_mm": told(self.worst),
            "room_likely_mm": told(self.likely),
            "shims": None if self.shims is None else self.shims.designation,
            "packs_mm": told(self.packs),
            "play_mm": told(self.play),
        }

    def growth(self, temperatures: Mapping[str, float]) -> float:
        """What the room gains when parts have temperatures (deg C) by node, m.

        Raises
        ------
        DesignError
            When the catalogue has no thermal expansion of a material.
        """
        return math.fsum(
            one.nominal * _expansion(one) * (temperatures[one.node] - _DRAWN)
            for one in self.lengths
        )


def _expansion(length: Length) -> float:
    found = find_material(length.material).expansion
    if found is None:
        raise DesignError(
            f"the catalogue has no thermal expansion of '{length.material}', of which the "
            f"{length.part} is made, so its axial play is known at 20 degC alone; name a material "
            "that has one (see `cqdd-design catalog materials`)."
        )
    return found


def axial_stacks(parts: Sequence[Part], layout: Layout) -> tuple[AxialStack, ...]:
    """Stacks of the shaft's bearings, of the output bearing, and of the discs on their cams.

    The discs have none where no cap stands below them.
    """
    named = {part.name: part for part in parts}
    carrier = layout.carrier
    shaft = tuple(_shaft(named, layout))
    output = (
        _between(named["output cover"], "lip over the output bearing", "face on the ring clamp"),
        _between(named["ring clamp"], "face under the cover", "face under the output bearing"),
        _width("output bearing", carrier.output, "carrier"),
    )
    found = [
        AxialStack("eccentric shaft in its bearings", shaft, carrier.shaft_shim, SHAFT_SET),
        AxialStack(
            "output bearing in the cover", output, carrier.output_shim, output_set(carrier.output)
        ),
    ]
    if carrier.cap:
        discs = tuple(_discs(named, layout))
        found.append(AxialStack("discs with their cam bearings", discs))
    return tuple(found)


def ring_stack(parts: Sequence[Part]) -> AxialStack:
    """The ring between its ledge in the housing and the clamp, which rests on the housing."""
    named = {part.name: part for part in parts}
    ring = named["ring"]
    thickness = ring.shape.top - ring.shape.bottom
    thinnest, thickest = thickness_limits(ring.material, thickness)
    lengths = (
        _between(named["housing"], "face under the clamp", "ledge of the ring"),
        _between(named["ring clamp"], "face on the ring", "face on the housing"),
        Length("ring", "thickness", -thickness, -thickest, -thinnest, ring.material, "ring"),
    )
    return AxialStack("ring under its clamp", lengths)


def _shaft(named: Mapping[str, Part], layout: Layout) -> Iterator[Length]:
    """From the housing's floor through clamp, output bearing and plate, and back."""
    support, housing = layout.shaft.support, named["housing"]
    yield _between(housing, "face under the clamp", "shoulder of the shaft bearing")
    yield _between(named["ring clamp"], "face under the output bearing", "face on the housing")
    yield _between(
        named["carrier plate"], "shoulder of the shaft bearing", "shoulder of the output bearing"
    )
    yield _width("shaft bearing, output end", support, "shaft")
    yield _between(named["eccentric shaft"], "lower shoulder", "upper shoulder")
    yield _width("shaft bearing, housing end", support, "shaft")


def _between(part: Part, upper: str, lower: str) -> Length:
    """From one face of a part to another, counted positive where the first lies higher."""
    one, other = (_face(part, name) for name in (upper, lower))
    off = _along(part, one) + _along(part, other)
    what = f"{lower} to {upper}"
    nodes = {"carrier plate": "carrier", "eccentric shaft": "shaft"}
    node = nodes.get(part.name, "housing")
    return Length(part.name, what, one.height - other.height, -off, off, part.material, node)


def _face(part: Part, name: str) -> Shoulder:
    return next(f for f in part.features if isinstance(f, Shoulder) and f.name == name)


def _along(part: Part, face: Shoulder) -> float:
    """Tolerance of a face's height over the face that lengths run from, m."""
    length = face.height - part.length_origin
    if abs(length) < 1e-9:
        return 0.0
    return face.along or general_tolerance(length)


def _width(name: str, chosen: ChosenBearing, node: str) -> Length:
    """Of a bearing, which takes room; a narrower one takes less."""
    row = chosen.bearing
    narrower = width_tolerance(row.bore_diameter)
    return Length(name, "width", -row.width, 0.0, narrower, chosen.material, node)


def _discs(named: Mapping[str, Part], layout: Layout) -> Iterator[Length]:
    """Between cap and plate, less the discs with their cam bearings and the collars between."""
    pack = layout.pack
    yield from _plate_to_cap(named, layout)
    material = (named.get("disc") or named["disc 1"]).material
    thinnest, thickest = thickness_limits(material, pack.disc_thickness)
    taken = -pack.disc_thickness, -thickest, -thinnest
    if pack.disc_count == 1:
        yield Length("disc", "thickness", *taken, material, "disc")
        return
    yield Length("discs", "thickness, half of the first and the last", *taken, material, "disc")
    yield _width("cam bearings", pack.cam, "disc")
    yield Length("discs", "places of the cam bearings in them", 0.0, -2.0 * BEARING_FACE,
                 2.0 * BEARING_FACE, material, "disc")  # fmt: skip
    for disc in range(1, pack.disc_count - 1):
        yield _width(f"cam bearing {disc + 1}", pack.cam, "shaft")
    collars = pack.disc_count - 1
    width = pack.pitch - pack.cam.bearing.width
    yield Length("eccentric shaft", "collars beside the lobes", -collars * width,
                 -2.0 * collars * BEARING_FACE, 2.0 * collars * BEARING_FACE,
                 named["eccentric shaft"].material, "shaft")  # fmt: skip


def _plate_to_cap(named: Mapping[str, Part], layout: Layout) -> Iterator[Length]:
    """What holds the cap away from the plate: columns, screws' shoulders, or how it is bonded."""
    carrier, pack = layout.carrier, layout.pack
    apart = carrier.plate_bottom + pack.gap
    if carrier.columns is not None:
        off = general_tolerance(apart)
        column = named["carrier column"].material
        yield Length("carrier column", "length", apart, -off, off, column, "carrier")
        return
    if carrier.pin.screw is None:
        off, pin = general_tolerance(apart), named["dowel pin"].material
        yield Length("carrier cap", "set when bonded", apart, -off, off, pin, "carrier")
        return
    screw = named["shoulder screw"].material
    shoulder = carrier.shoulder_top - carrier.shoulder_bottom
    yield Length("shoulder screw", "shoulder", shoulder, 0.0, SHOULDER_SCREW_LENGTH, screw,
                 "carrier")  # fmt: skip
    for name in ("carrier plate", "carrier cap"):
        part = named[name]
        seat = next(
            f for f in part.features if isinstance(f, FittedHole) and f.circle.name == "output pins"
        )
        deep = seat.top - seat.bottom
        off = general_tolerance(deep)
        yield Length(name, f"depth of the {seat.name}", -deep, -off, off, part.material, "carrier")
