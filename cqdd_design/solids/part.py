"""What a part is: shape, material, colour, pieces and where they stand, make or buy, fits.

A `Part` needs no CAD kernel until its `solid` is asked for.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.geometry.contours import FloatArray, Moments
from cqdd_design.results import MassProperties
from cqdd_design.solids.features.edges import edges
from cqdd_design.solids.features.holes import FittedHole
from cqdd_design.solids.features.kinds import (
    ON_AXIS,
    Chamfer,
    Feature,
    Groove,
    Seat,
    Shoulder,
    TrueFace,
)
from cqdd_design.solids.features.removal import cuts
from cqdd_design.solids.features.revolved import Revolved
from cqdd_design.solids.layers import Stack, prism_properties
from cqdd_design.solids.poses import Body, body_pose, transform

if TYPE_CHECKING:
    from cadquery import Solid

Source = Literal["make", "buy"]
Colour = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class Instance:
    """One piece of a part in the machine.

    Attributes
    ----------
    name : str
        Unique in the machine, such as ``disc 2`` or ``shoulder screw 5``.
    body : Body
        What it moves with.
    placement : array (4, 4)
        From the part's frame to the body's, m.
    """

    name: str
    body: Body
    placement: FloatArray

    def pose(self, design: Design, crank_angle: float = 0.0) -> FloatArray:
        """Transform (4, 4) from the part's frame to the ring's at a crank angle (rad)."""
        return np.asarray(body_pose(design, self.body, crank_angle) @ self.placement)


@dataclass(frozen=True, eq=False)
class Part:
    """A part and all of its pieces.

    Attributes
    ----------
    name : str
        Unique in the machine.
    shape : Stack
        In the part's own frame, m.
    material : str
        Catalogue name.
    colour : tuple of float
        Red, green, blue from 0 to 1 (sRGB).
    source : {"make", "buy"}
    designation : str
        What to order or how it is made.
    instances : tuple of Instance
        The pieces, in order.
    catalogue_mass : float or None
        Mass of one piece where a catalogue gives it, kg: an envelope's volume says too much.
    inner_body : Body or None
        For bearings: what the inner ring turns with (`Instance.body` carries the outer ring).
    exact_section, fitted_section : Moments or None
        For discs and rings: plane integrals of the exact curve, and of the arcs of the shape that
        closely fit it.
    stated : tuple of Feature
        What its maker is told besides its body; the holes of `shape` are theirs.
    edged : bool
        Whether its chamfers stand among those, and none is looked for on its layers.
    """

    name: str
    shape: Stack
    material: str
    colour: Colour
    source: Source
    designation: str
    instances: tuple[Instance, ...]
    catalogue_mass: float | None = None
    inner_body: Body | None = None
    exact_section: Moments | None = None
    fitted_section: Moments | None = None
    stated: tuple[Feature, ...] = ()
    edged: bool = False

    @property
    def count(self) -> int:
        """Number of pieces."""
        return len(self.instances)

    @cached_property
    def features(self) -> tuple[Feature, ...]:
        """All that it is made of: what is stated, and chamfers on the edges that turning leaves."""
        turned = self.source == "make" and self.exact_section is None
        if self.edged or not turned:
            return self.stated
        return *self.stated, *edges(self.shape, [f for f in self.stated if isinstance(f, Seat)])

    @property
    def turned(self) -> tuple[Chamfer | Groove, ...]:
        """Chamfers and grooves about its own axis."""
        return tuple(
            one
            for one in self.features
            if isinstance(one, Groove) or (isinstance(one, Chamfer) and one.centres == (ON_AXIS,))
        )

    @property
    def fits(self) -> tuple[Seat | FittedHole, ...]:
        """Features with a tolerance zone on which another part sits."""
        return tuple(
            one
            for one in self.stated
            if isinstance(one, Seat | FittedHole) and not isinstance(one, TrueFace)
        )

    @property
    def length_origin(self) -> float:
        """Height from which its sheet's lengths run: a datum face, or its lower end, m."""
        faces = (one for one in self.stated if isinstance(one, Shoulder) and one.datum)
        return next((one.height for one in faces), self.shape.bottom)

    @cached_property
    def cuts(self) -> tuple[Revolved, ...]:
        """What chamfers, undercuts, grooves and drills take off the shape."""
        return cuts(self.features)

    @cached_property
    def volume(self) -> float:
        """Closed-form volume of one piece as drawn, m^3."""
        return self.shape.volume - math.fsum(cut.volume for cut in self.cuts)

    @property
    def exact_volume(self) -> float:
        """Closed-form volume of one piece, m^3; of the exact curve for discs and rings."""
        if self.exact_section is None or self.fitted_section is None:
            return self.volume
        off = self.exact_section.area - self.fitted_section.area
        return self.volume + off * (self.shape.top - self.shape.bottom)

    @property
    def density(self) -> float:
        """Mass over volume, kg/m^3; that of the material unless a catalogue gives the mass."""
        if self.catalogue_mass is not None:
            return self.catalogue_mass / self.volume
        return find_material(self.material).density

    @property
    def mass(self) -> float:
        """Closed-form mass of one piece, kg."""
        return self.exact_properties.mass

    @cached_property
    def exact_properties(self) -> MassProperties:
        """Closed-form mass properties of one piece in the part's frame."""
        shape, density = self.shape, self.density
        own = shape.mass_properties(density)
        for cut in self.cuts:
            own = own + cut.mass_properties(-density)
        if self.exact_section is None or self.fitted_section is None:
            return own
        return (
            own
            + prism_properties(self.exact_section, shape.bottom, shape.top, density)
            + prism_properties(self.fitted_section, shape.bottom, shape.top, -density)
        )

    @cached_property
    def solid(self) -> Solid:
        """The CadQuery solid in the part's frame, in mm."""
        from cqdd_design.solids.cad import build_solid

        return build_solid(self.name, self.shape, self.cuts)

    @cached_property
    def seamed_solid(self) -> Solid:
        """The solid to take meshes of where merging faces left one that no mesher closes, in mm."""
        from cqdd_design.solids.cad import build_solid

        return build_solid(self.name, self.shape, [c.chorded for c in self.cuts], merged=False)

    @cached_property
    def faceted_solid(self) -> Solid:
        """The solid to take meshes of: that with chords for its smallest arcs, in mm."""
        from cqdd_design.solids.cad import build_solid

        chorded = [cut.chorded for cut in self.cuts]
        if chorded == list(self.cuts):
            return self.solid
        return build_solid(self.name, self.shape, chorded)


def placed(name: str, body: Body, *placements: FloatArray) -> tuple[Instance, ...]:
    """Pieces of a part on one body, numbered from 1."""
    return tuple(Instance(f"{name} {i}", body, at) for i, at in enumerate(placements, start=1))


def on_axis(name: str, body: Body, z: float = 0.0) -> tuple[Instance, ...]:
    """The one piece of a part that stands on the axis of its body."""
    return (Instance(name, body, transform(z=z)),)


def around(
    name: str, body: Body, centres: Iterable[FloatArray], z: float = 0.0
) -> tuple[Instance, ...]:
    """Pieces of a part that stand upright at centres (2,), m."""
    return placed(name, body, *(transform(x=x, y=y, z=z) for x, y in centres))


def overall_size(parts: Sequence[Part]) -> tuple[float, float]:
    """Largest diameter and length over all pieces where they are placed, m."""
    pieces = [(part, piece) for part in parts for piece in part.instances]
    ends = [
        piece.placement[2, 3] + (end if piece.placement[2, 2] > 0.0 else -end)
        for part, piece in pieces
        for end in (part.shape.bottom, part.shape.top)
    ]
    reach = max(
        math.hypot(*piece.placement[:2, 3]) + part.shape.outside_radius for part, piece in pieces
    )
    return 2.0 * reach, max(ends) - min(ends)
