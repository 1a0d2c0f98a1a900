r"""The path of the wire's centre: the contour moved into the waste by half a wire and the gap.

::

        waste      S  centre of the start hole
                   |  lead-in, perpendicular to the contour
    . . . . . . . .+. . . . . . .  path, d = wire/2 + gap from the contour
    _______________|____________   contour
        material

An arc moved sideways is an arc of the same centre and the same sweep, so the path is exact: it has
the contour's own bulges. About a corner of the material it is an arc of radius d.

Source of the length and area of a parallel curve: J. Steiner (1840): L + 2 pi d, A + L d + pi d^2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from cqdd_design.errors import ReadBackError
from cqdd_design.exporting.edm.begin import NO_PIECE, begun
from cqdd_design.exporting.edm.start_holes import start_holes
from cqdd_design.exporting.options import DEFAULTS
from cqdd_design.geometry.contours import (
    ArcContour,
    Circle,
    ComplexArray,
    Contour,
    FloatArray,
    as_complex,
    as_points,
)

if TYPE_CHECKING:
    from cqdd_design.design.actuator import Edm
    from cqdd_design.exporting.edm.flat_parts import FlatPart

_CORNER = 1e-6
"""Smallest change of direction that is a corner, rad."""


@dataclass(frozen=True, eq=False)
class WirePath:
    """Path of the wire about one contour, and the way onto it.

    Attributes
    ----------
    feature : str
        What is cut, such as ``outer contour`` or ``inner contour 2``.
    contour : ArcContour
        Closed, counter-clockwise; begins where the lead-in ends.
    start : complex
        Centre of the start hole, m.
    start_diameter : float
        Of the start hole, m.
    offset : float
        From the nominal contour to the path, m.
    outer : bool
        Whether material lies inside the contour.
    """

    feature: str
    contour: ArcContour
    start: complex
    start_diameter: float
    offset: float
    outer: bool

    @property
    def joint(self) -> complex:
        """Where the lead-in meets the path, m."""
        return complex(*self.contour.points[0])


@dataclass(frozen=True, eq=False)
class OpenChain:
    """An open chain of lines and arcs: joints (k+1,), m, and bulges (k,)."""

    points: ComplexArray
    bulges: FloatArray

    @property
    def length(self) -> float:
        """M."""
        turned = np.sinc(2.0 * np.arctan(self.bulges) / math.pi)
        return float(np.sum(np.abs(np.diff(self.points)) / turned))

    def reversed(self) -> OpenChain:
        """From its end to its begin."""
        return OpenChain(self.points[::-1], -self.bulges[::-1])

    def joined(self, after: OpenChain) -> OpenChain:
        """It, and a chain that begins where it ends."""
        return OpenChain(
            np.concatenate([self.points, after.points[1:]]),
            np.concatenate([self.bulges, after.bulges]),
        )

    def divided(self, place: float) -> tuple[OpenChain, OpenChain]:
        """What lies before and behind a way along it, m: a joint where one is within `NO_PIECE`."""
        chord = np.diff(self.points)
        lengths = np.abs(chord) / np.sinc(2.0 * np.arctan(self.bulges) / math.pi)
        ends = np.cumsum(lengths)
        segment = int(np.searchsorted(ends, place))
        left, long = float(ends[segment]) - place, float(lengths[segment])
        first = segment + (2.0 * left < long)
        if min(left, long - left) < NO_PIECE and 0 < first < len(self.bulges):
            return (
                OpenChain(self.points[: first + 1], self.bulges[:first]),
                OpenChain(self.points[first:], self.bulges[first:]),
            )
        share, quarter = 1.0 - left / long, math.atan(float(self.bulges[segment]))
        reach = share if quarter == 0.0 else math.sin(2.0 * share * quarter) / math.sin(2 * quarter)
        turned = np.exp(-2j * (1.0 - share) * quarter)
        at = self.points[segment] + chord[segment] * reach * turned
        before = OpenChain(
            np.append(self.points[: segment + 1], at),
            np.append(self.bulges[:segment], math.tan(share * quarter)),
        )
        behind = OpenChain(
            np.concatenate([[at], self.points[segment + 1 :]]),
            np.append(math.tan((1.0 - share) * quarter), self.bulges[segment + 1 :]),
        )
        return before, behind

    def beside(self, distance: float) -> complex:
        """The place to the left of its begin, m."""
        along = self.points[1] - self.points[0]
        along *= np.exp(-2j * math.atan(float(self.bulges[0]))) / np.abs(along)
        return complex(self.points[0] + 1j * distance * along)

    def moved(self, distance: float) -> OpenChain:
        """It, to the left: an arc becomes one of the same centre and sweep."""
        along = np.diff(self.points)
        along /= np.abs(along)
        half = np.exp(2j * np.arctan(self.bulges))
        leaving, arriving = along / half, along * half
        normals = 1j * np.append(leaving, arriving[-1])
        return OpenChain(self.points + distance * normals, self.bulges)


def contour_name(number: int) -> str:
    """Name of a contour of a part: 0 is the outer one."""
    return "outer contour" if number == 0 else f"inner contour {number}"


def contour_size(contour: Contour, sign: str = "dia ") -> str:
    """Diameter of a round contour, mm, behind `sign`; any other is a profile."""
    return f"{sign}{2e3 * contour.radius:.4f}" if isinstance(contour, Circle) else "profile"


def wire_paths(flat: FlatPart, edm: Edm, tab: float = DEFAULTS.tab_length) -> tuple[WirePath, ...]:
    """Paths of every contour of a part on the finishing cut, the outer one first.

    Parameters
    ----------
    tab : float
        As `start_holes` takes it.

    Raises
    ------
    GeometryError
        When a contour is too small for a start hole.
    ReadBackError
        When the wire is too thick for a contour: the part exists, but the files would not cut it.
    """
    starts = start_holes(flat, edm.wire_diameter, tab)
    return tuple(
        WirePath(
            contour_name(number),
            offset_contour(
                begun(flat, number, tab),
                edm,
                outer=number == 0,
                feature=f"{flat.label}, {contour_name(number)}",
            ),
            complex(*start.centre),
            2.0 * start.radius,
            edm.wire_offset,
            number == 0,
        )
        for number, start in enumerate(starts)
    )


def segmented(contour: Contour) -> ArcContour:
    """Return the contour as arcs; a circle becomes two half circles from its rightmost point."""
    if isinstance(contour, ArcContour):
        return contour
    right = np.array([contour.radius, 0.0])
    return ArcContour(np.stack([contour.centre + right, contour.centre - right]), np.ones(2))


def offset_contour(contour: Contour, edm: Edm, *, outer: bool, feature: str) -> ArcContour:
    """Move a counter-clockwise contour into the waste: outward if `outer`, else inward.

    Raises
    ------
    ReadBackError
        When an arc is tighter than the offset, naming `feature` and the thickest wire that fits.
    """
    distance = edm.wire_offset
    # Left of the path lies the inside.
    side = -distance if outer else distance
    nominal = segmented(contour)
    radii = nominal.arcs().radii
    turns = np.sign(nominal.bulges)
    left = np.where(turns == 0.0, math.inf, radii - turns * side)
    if not left.min() > 0.0:
        worst = float(radii[left.argmin()])
        # Whole micrometres, the next below what leaves an arc of no radius.
        most = (math.ceil(2e6 * (worst - edm.spark_gap) - 1e-6) - 1) * 1e-6
        raise ReadBackError(
            f"{feature}: edm.wire_diameter {edm.wire_diameter * 1e3:g} mm with edm.spark_gap "
            f"{edm.spark_gap * 1e6:g} um cannot follow an arc of radius {worst * 1e3:.4f} mm; "
            + (
                f"choose a wire of at most {most * 1e3:.3f} mm."
                if most > 0.0
                else f"lower edm.spark_gap below {worst * 1e6:.4g} um."
            )
        )
    leaving, arriving = directions(nominal)
    corner = np.angle(leaving / arriving)
    if (np.sign(side) * corner > _CORNER).any():
        place = as_complex(nominal.points)[int(np.argmax(np.sign(side) * corner))]
        raise ReadBackError(
            f"{feature}: the contour has a sharp inner corner at ({place.real * 1e3:.4f}, "
            f"{place.imag * 1e3:.4f}) mm, which no wire can cut; round it to "
            f"{distance * 1e3:.4f} mm."
        )
    return _moved(nominal, side, leaving, arriving, np.abs(corner) > _CORNER)


def directions(contour: ArcContour) -> tuple[ComplexArray, ComplexArray]:
    """Unit directions leaving and arriving at every joint (k,)."""
    start = as_complex(contour.points)
    along = np.roll(start, -1) - start
    along /= np.abs(along)
    half = np.exp(0.5j * contour.sweeps)
    return along / half, np.roll(along * half, 1)


def _moved(
    nominal: ArcContour,
    side: float,
    leaving: ComplexArray,
    arriving: ComplexArray,
    corners: NDArray[np.bool_],
) -> ArcContour:
    """Joints moved along their normals; an arc about the joint itself where it is a corner."""
    joints = as_complex(nominal.points)
    points: list[complex] = []
    bulges: list[float] = []
    both = leaving + arriving
    smooth = joints + 1j * side * both / np.abs(both)
    for number, joint in enumerate(joints):
        if corners[number]:
            points.append(complex(joint + 1j * side * arriving[number]))
            bulges.append(math.tan(float(np.angle(leaving[number] / arriving[number])) / 4.0))
            points.append(complex(joint + 1j * side * leaving[number]))
        else:
            points.append(complex(smooth[number]))
        bulges.append(float(nominal.bulges[number]))
    return ArcContour(as_points(np.array(points)), np.array(bulges))


def split_for_tab(contour: ArcContour, tab: float) -> tuple[OpenChain, OpenChain]:
    """Cut a closed contour into what is cut first and the tab at its end.

    Parameters
    ----------
    tab : float
        Length of the tab, m, below that of the contour; it begins at a joint where one is within
        `NO_PIECE`.

    Returns
    -------
    chain, tab : OpenChain
        Together the contour, from its first joint round to it.
    """
    start = as_complex(contour.points)
    whole = OpenChain(np.append(start, start[0]), contour.bulges)
    return whole.divided(whole.length - tab)
