"""Shapes corrected by what a printer and its material do to them.

Lengths come out short by the shrinkage s, holes and outsides off by what a coupon showed. In a file

    hole      is (d - e_hole) / (1 - s)        e: measured less (1 - s) drawn
    outside   is (d - e_outside) / (1 - s)
    height    is h / (1 - s)

A curve moves along its normals by half of that: arcs keep their centres, and corners lie where the
moved sides meet.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cqdd_design.catalog.printing import PrintedMaterial
from cqdd_design.errors import GeometryError
from cqdd_design.geometry.contours import (
    ArcContour,
    Circle,
    ComplexArray,
    Contour,
    FloatArray,
    PlanarPart,
    as_complex,
    as_points,
)
from cqdd_design.solids.features.kinds import Chamfer, Groove
from cqdd_design.solids.layers import Layer, Stack

if TYPE_CHECKING:
    from cqdd_design.design.printing import PrintedErrors
    from cqdd_design.solids.part import Part

_CORNER = 1e-3
"""Change of direction from which a joint is a corner, rad."""
_CUSP = 0.1
_STEPS = 12
"""Of Newton's method, which squares the error of a corner in each."""


@dataclass(frozen=True)
class Compensation:
    """How files differ from parts.

    Attributes
    ----------
    shrinkage : float
        Share of every length.
    hole_error, outside_error : float
        Of diameters, measured less what shrinkage alone leaves of those drawn, m.
    measured : bool
        Whether the design states any of them, of this plastic.
    """

    shrinkage: float
    hole_error: float
    outside_error: float
    measured: bool

    @property
    def scale(self) -> float:
        """File over part."""
        return 1.0 / (1.0 - self.shrinkage)


def compensation(material: PrintedMaterial, measured: PrintedErrors | None) -> Compensation:
    """Of a material, by what was measured of it on the printer; None where nothing was."""
    if measured is None:
        return Compensation(material.shrinkage, 0.0, 0.0, measured=False)
    stated = measured.shrinkage
    return Compensation(
        material.shrinkage if stated is None else stated,
        measured.hole_error,
        measured.outside_error,
        measured=True,
    )


def compensated(part: Part, by: Compensation) -> Part:
    """A part as its file has it, with the chamfers and grooves of the drawn one.

    Raises
    ------
    GeometryError
        When a hole or an arc would vanish, naming the part and the greatest error that it bears.
    """
    layers = tuple(
        Layer(_shape(part.name, layer.shape, by), by.scale * layer.bottom, by.scale * layer.top)
        for layer in part.shape.layers
    )
    return replace(
        part,
        shape=Stack(layers),
        catalogue_mass=None,
        exact_section=None,
        fitted_section=None,
        stated=tuple(_turned(one, by) for one in part.turned),
        edged=True,
    )


def _turned(feature: Chamfer | Groove, by: Compensation) -> Chamfer | Groove:
    """A chamfer or a groove, on the edge or the cylinder that the file has."""
    off = 0.5 * (by.hole_error if feature.inside else by.outside_error)

    def across(radius: float) -> float:
        return by.scale * (radius - off)

    if isinstance(feature, Chamfer):
        return replace(
            feature,
            radius=across(feature.radius),
            height=by.scale * feature.height,
            width=by.scale * feature.width,
        )
    return replace(
        feature,
        diameter=2.0 * across(0.5 * feature.diameter),
        cylinder=across(feature.cylinder),
        bottom=by.scale * feature.bottom,
        top=by.scale * feature.top,
        fillet=by.scale * feature.fillet,
    )


def _shape(name: str, shape: PlanarPart, by: Compensation) -> PlanarPart:
    outer = grown(name, shape.outer, -0.5 * by.outside_error, by.outside_error)
    holes = tuple(grown(name, hole, -0.5 * by.hole_error, by.hole_error) for hole in shape.holes)
    return PlanarPart(shape.name, outer.scaled(by.scale), tuple(h.scaled(by.scale) for h in holes))


def grown(name: str, contour: Contour, distance: float, error: float) -> Contour:
    """A counter-clockwise contour moved outward by a distance, m.

    Parameters
    ----------
    name : str
        Of the part, for sentences.
    error : float
        Of the diameter that asks for it, m, likewise.

    Raises
    ------
    GeometryError
        When it is too small.
    """
    if isinstance(contour, Circle):
        if contour.radius + distance <= 0.0:
            raise _too_small(name, contour.radius, error)
        return Circle(contour.centre, contour.radius + distance)
    turns, radii = np.sign(contour.bulges), contour.arcs().radii
    left = np.where(turns == 0.0, math.inf, radii + turns * distance)
    if left.min() <= 0.0:
        raise _too_small(name, float(radii[left.argmin()]), error)
    return _moved(contour, distance, left)


class _Sides(NamedTuple):
    """A side at every joint (k,): a circle, or a line through `on` across its normal, m."""

    bent: NDArray[np.bool_]
    centres: ComplexArray
    radii: FloatArray
    on: ComplexArray
    normals: ComplexArray

    def off(self, points: ComplexArray) -> tuple[FloatArray, ComplexArray]:
        """How far points are off their sides, m, and the way off them."""
        from_centre = points - self.centres
        reach = np.maximum(np.abs(from_centre), 1e-12)
        straight = ((points - self.on) * np.conj(self.normals)).real
        off = np.where(self.bent, reach - self.radii, straight)
        return off, np.where(self.bent, from_centre / reach, self.normals)


def _moved(contour: ArcContour, distance: float, radii: FloatArray) -> ArcContour:
    """Arcs of new radii (k,) about their centres, cut or carried on to where neighbours meet."""
    start, sweeps = as_complex(contour.points), contour.sweeps
    along = np.roll(start, -1) - start
    along = along / np.abs(along)
    half = np.exp(0.5j * sweeps)
    leaving, arriving = -1j * along / half, np.roll(-1j * along * half, 1)
    both = leaving + arriving
    joints = start + 2.0 * distance * both / np.maximum(np.abs(both) ** 2, _CUSP)
    bent = sweeps != 0.0
    centres = np.where(bent, as_complex(contour.arcs().centres), 0.0)
    after = _Sides(bent, centres, np.where(bent, radii, 0.0), start + distance * leaving, leaving)
    before = _Sides(
        np.roll(bent, 1),
        np.roll(centres, 1),
        np.roll(after.radii, 1),
        np.roll(after.on, 1),
        arriving,
    )
    corner = np.abs(np.angle(leaving / arriving)) > _CORNER
    for _ in range(_STEPS):
        f, u = after.off(joints)
        g, v = before.off(joints)
        turned = (np.conj(u) * v).imag
        step = 1j * (f * v - g * u) / np.where(corner, turned, 1.0)
        joints = np.where(corner, joints + step, joints)
    ends = np.roll(joints, -1)
    with np.errstate(divide="ignore", invalid="ignore"):
        turn = np.angle((ends - centres) / (joints - centres))
    full = np.where(np.abs(turn - sweeps) > math.pi, turn + 2.0 * math.pi * np.sign(sweeps), turn)
    return ArcContour(as_points(joints), np.where(bent, np.tan(0.25 * full), 0.0))


def _too_small(name: str, radius: float, error: float) -> GeometryError:
    return GeometryError(
        f"{name}: a curve of radius {1e3 * radius:.4g} mm vanishes under a measured error of "
        f"{1e6 * error:+g} um on the diameter; check printing.hole_error and "
        f"printing.outside_error, of which at most {2e6 * radius:.4g} um are possible here."
    )
