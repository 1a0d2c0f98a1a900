"""Sizes, tolerances of form and place, and datums of a part, tied to the faces of its solid.

They are what its drawing says: diameters of seats and fitted holes with their limits, cylindricity,
total run-out and position of their surfaces and axes, run-out of shoulders, position of holes,
profiles that wire cuts, and the letters of the datums that these refer to. `pmi_file` writes them
into the part's AP242 file.

Not among them are roughness, for which the kernel has no words, fillets, and the theoretically
exact places of holes, which are those of the solid. Nor has it words for a pattern of holes and
profile that is one (SIM on the sheet): the file ties the profile to the holes as a datum.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from cqdd_design.errors import CatalogError
from cqdd_design.solids.cad import MM
from cqdd_design.solids.features.holes import ClearanceHole, CutHole, FittedHole, TappedHole
from cqdd_design.solids.features.kinds import (
    ON_AXIS,
    AxialThread,
    CutProfile,
    Seat,
    Shoulder,
    datum_cells,
)

if TYPE_CHECKING:
    from cqdd_design.solids.features.holes import Centre, Facing
    from cqdd_design.solids.part import Part

_RIM = 0.3e-3
"""How far from its face a shoulder's cylinder is looked for, m."""
_NEAR = 0.03
"""By how much a face may lie off the nominal size, mm: some parts are drawn at their mean."""

_EARS = 1.2
"""By how much a face may reach beyond a shoulder's radius."""

ZoneKind = Literal["cylindricity", "total run-out", "run-out", "position", "profile"]
_Placed = FittedHole | ClearanceHole | TappedHole | CutHole
"""Holes whose axes have zones."""


class Size(NamedTuple):
    """A diameter with its limits, mm, and the faces of the solid that have it."""

    diameter: float
    lower: float
    upper: float
    faces: tuple[Any, ...]


class Zone(NamedTuple):
    """A tolerance of form or place.

    Attributes
    ----------
    value : float
        Width, mm; the diameter of round zones.
    round : bool
        Whether the zone is a cylinder about an axis.
    datums : tuple of str
        Letters, in their order, ``A-B`` of a common one.
    faces : tuple
        Of the solid.
    """

    kind: ZoneKind
    value: float
    round: bool
    datums: tuple[str, ...]
    faces: tuple[Any, ...]

    @property
    def letters(self) -> Iterator[str]:
        """Of the datums, those of common ones apart."""
        return (letter for cell in self.datums for letter in cell.split("-"))


class Datum(NamedTuple):
    """A letter and the faces that set it up."""

    letter: str
    faces: tuple[Any, ...]


class Stated(NamedTuple):
    """All that a part's file carries beside its solid."""

    sizes: tuple[Size, ...]
    zones: tuple[Zone, ...]
    datums: tuple[Datum, ...]


def stated_of(part: Part) -> Stated:
    """What is stated of a part and found on its solid.

    Sizes whose zones are not tabulated are left out, and tolerances that refer to a datum of which
    the solid has no face.
    """
    solid = _Faces(part)
    datums = tuple(_datums(part, solid))
    letters = {one.letter for one in datums}
    zones = (one for one in _zones(part, solid) if one.faces and letters.issuperset(one.letters))
    return Stated(tuple(size for size in _sizes(part, solid) if size.faces), tuple(zones), datums)


class _Faces:
    """Cylinders and planes of a part's solid."""

    def __init__(self, part: Part) -> None:
        every = self._every = part.solid.Faces()
        self._cylinders = [face for face in every if face.geomType() == "CYLINDER"]
        self._planes = [face for face in every if face.geomType() == "PLANE"]

    def cylinders(
        self, diameter: float, bottom: float, top: float, centres: Iterable[Centre]
    ) -> tuple[Any, ...]:
        """Those of a diameter about any of some axes, between heights; m."""
        axes = [(MM * x, MM * y) for x, y in centres]
        return tuple(
            face
            for face in self._cylinders
            if any(_is_cylinder(face, MM * diameter, MM * bottom, MM * top, one) for one in axes)
        )

    def planes(self, face: Shoulder) -> tuple[Any, ...]:
        """Those at the height of a shoulder that look its way and lie within its radii."""
        return tuple(one for one in self._planes if _is_shoulder(one, face, face.facing))

    def walls(self, *, inside: bool) -> tuple[Any, ...]:
        """Those of a prism along its outline, or along its largest opening."""
        end = max(self._planes, key=lambda face: face.Area())
        wires = end.innerWires() if inside else [end.outerWire()]
        if not wires:
            return ()
        outline = max(wires, key=lambda wire: wire.BoundingBox().DiagonalLength)
        along = {edge.hashCode() for edge in outline.Edges()}
        return tuple(
            face
            for face in self._every
            if not face.isSame(end) and any(edge.hashCode() in along for edge in face.Edges())
        )


def _is_cylinder(
    face: Any, diameter: float, bottom: float, top: float, centre: tuple[float, float]
) -> bool:
    cylinder = face._geomAdaptor().Cylinder()
    axis = cylinder.Axis().Location()
    away = max(abs(axis.X() - centre[0]), abs(axis.Y() - centre[1]))
    if away > _NEAR or abs(2.0 * cylinder.Radius() - diameter) > _NEAR:
        return False
    # A seat may be the end of a longer cylinder.
    box = face.BoundingBox()
    return bool(min(top, box.zmax) - max(bottom, box.zmin) > _NEAR)


def _is_shoulder(face: Any, shoulder: Shoulder, facing: Facing) -> bool:
    box = face.BoundingBox()
    # Edges are broken, holes open in the face, and ears stand out of it.
    reach = 0.5 * max(box.xlen, box.ylen)
    return bool(
        abs(face.Center().z - MM * shoulder.height) < 1e-3
        and face.normalAt().z * (1.0 if facing == "up" else -1.0) > 0.99
        and 0.5 * MM * (shoulder.inner + shoulder.outer) < reach < _EARS * MM * shoulder.outer
    )


def _sizes(part: Part, solid: _Faces) -> Iterator[Size]:
    for feature in part.features:
        if isinstance(feature, Shoulder) and feature.rim:
            yield Size(2.0 * MM * feature.outer, -MM * feature.rim, 0.0, _rim(feature, solid))
        if not isinstance(feature, Seat | FittedHole):
            continue
        try:
            limits = feature.limits
        except CatalogError:
            continue
        yield Size(
            MM * feature.diameter, MM * limits.lower, MM * limits.upper, _round(feature, solid)
        )


def _rim(shoulder: Shoulder, solid: _Faces) -> tuple[Any, ...]:
    """The cylinder that ends in a shoulder's edge, below its chamfer."""
    into = _RIM if shoulder.facing == "down" else -_RIM
    low, high = sorted((shoulder.height, shoulder.height + into))
    return solid.cylinders(2.0 * shoulder.outer, low, high, (ON_AXIS,))


def _round(feature: Seat | FittedHole | CutHole, solid: _Faces) -> tuple[Any, ...]:
    centres = (feature.centre,) if isinstance(feature, Seat) else feature.circle.centres
    return solid.cylinders(feature.diameter, feature.bottom, feature.top, centres)


def _zones(part: Part, solid: _Faces) -> Iterator[Zone]:
    for feature in part.features:
        if isinstance(feature, Seat):
            faces = _round(feature, solid)
            refers = datum_cells(feature.refers)
            if feature.cylindricity:
                yield Zone("cylindricity", MM * feature.cylindricity, False, (), faces)
            if feature.position:
                yield Zone("position", MM * feature.position, True, refers, faces)
            elif feature.run_out and refers:
                yield Zone("total run-out", MM * feature.run_out, False, refers, faces)
        elif isinstance(feature, Shoulder):
            if feature.run_out and feature.refers:
                refers, faces = datum_cells(feature.refers), solid.planes(feature)
                yield Zone("run-out", MM * feature.run_out, False, refers, faces)
        elif isinstance(feature, CutProfile):
            yield Zone(
                "profile", MM * feature.zone, False, datum_cells(feature.refers),
                solid.walls(inside=feature.inside),
            )  # fmt: skip
        elif isinstance(feature, _Placed) and feature.position:
            yield Zone(
                "position", MM * feature.position, True, datum_cells(feature.refers),
                _bored(feature, solid),
            )  # fmt: skip


def _bored(hole: _Placed, solid: _Faces) -> tuple[Any, ...]:
    if not isinstance(hole, TappedHole):
        return solid.cylinders(hole.diameter, hole.bottom, hole.top, hole.circle.centres)
    ends = hole.mouth, hole.mouth + (-1.0 if hole.facing == "up" else 1.0) * hole.drill_depth
    return solid.cylinders(hole.drill, min(ends), max(ends), hole.circle.centres)


def _datums(part: Part, solid: _Faces) -> Iterator[Datum]:
    for feature in part.features:
        if not (isinstance(feature, Shoulder | Seat | CutHole | AxialThread) and feature.datum):
            continue
        if isinstance(feature, Shoulder):
            faces = solid.planes(feature)
        elif isinstance(feature, AxialThread):
            faces = solid.cylinders(feature.core, feature.bottom, feature.top, (ON_AXIS,))
        else:
            faces = _round(feature, solid)
        if faces:
            yield Datum(feature.datum, faces)
