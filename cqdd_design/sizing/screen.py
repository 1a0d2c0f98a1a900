"""The screen: every candidate of a full product of axes against every closed-form check.

The product has six factors, but no check needs all of them::

    ring stage  g = (R, K1, r)       output pins  p = (N_w, d, R_w)
    cam bearing B                    thickness    b

    shape of ring and disc      g           bearing width         B, b
    shaft core, rim             g, B        ring pressure         g, b
    ligaments of the holes      g, p        ligament to the bore  g, p, B
    pin stresses and pressures  g, p, b     cam bearing           g, p, B

Checks are applied in this order, and a candidate counts for the first one it fails. The verdicts
are kept as one mask (g, p, B) and one (g, p, b); the number of candidates left after each check is
the exact count of (B, b) pairs both allow, summed over (g, p). Nothing is sampled or estimated.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cqdd_design.gearbox import rigid
from cqdd_design.gearbox.cam_bearing import least_bore
from cqdd_design.gearbox.checks import allowables
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.disc import ligament_hole_to_hole
from cqdd_design.sizing import reserves
from cqdd_design.sizing import shape_limits as shapes
from cqdd_design.sizing.bought_parts import BearingTable
from cqdd_design.sizing.columns import Columns
from cqdd_design.sizing.frame import Frame
from cqdd_design.sizing.space import SearchSpace, largest_pitch_radius
from cqdd_design.sizing.stage_tables import StageTables

BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.intp]

_RATIO_NODES = 25
_SLACK = 1e-9
"""Lengths closer than this to their limit meet it, m."""


class Tally:
    """How many candidates are left, and how many each check has taken."""

    def __init__(self, screened: int) -> None:
        self.left = screened
        self.rejected: dict[str, int] = {}

    def after(self, check: str, left: int) -> None:
        """Note how many candidates are left after a check."""
        self.rejected[check] = self.left - left
        self.left = left


@dataclass(frozen=True)
class Rings(shapes.RingSizes):
    """Ring stages with what the tables say of them, every field (G,), SI."""

    shortening_row: IntArray
    pressure_number: FloatArray
    friction_number: FloatArray


@dataclass(frozen=True)
class Rows(Columns):
    """Pairs of a ring stage and a set of output pins, every field (Q,), SI.

    `ring` is a row of `Rings`, `count` and `size` are places on the axes of the search space.
    """

    ring: IntArray
    count: IntArray
    size: IntArray
    circle: FloatArray
    hole_radius: FloatArray


@dataclass(frozen=True)
class Screened:
    """What a screen leaves, with everything a choice among it needs.

    Attributes
    ----------
    screened : int
        Candidates tried.
    rejected : dict of str to int
        Candidates by the first check they fail, in the order of the checks.
    rings, rows : Rings, Rows
        Ring stages and pairs whose shape is right.
    bearings : BearingTable
        Of the space, (B,).
    pairs : array (B, T)
        Which bearing goes into which thickness.
    fits : array (Q, B)
        Which bearings fit each row.
    cam_load : array (Q,)
        Largest cam load at the peak torque, N.
    reserve : array (Q, T)
        Least torque reserve of ring and pins.
    """

    screened: int
    rejected: dict[str, int]
    rings: Rings
    rows: Rows
    bearings: BearingTable
    pairs: BoolArray
    fits: BoolArray
    cam_load: FloatArray
    reserve: FloatArray

    @property
    def survivors(self) -> int:
        """Candidates that meet every check."""
        return self.screened - sum(self.rejected.values())


def screen(frame: Frame, tables: StageTables, space: SearchSpace) -> Screened:
    """Try every candidate of a search space.

    Parameters
    ----------
    frame, tables, space
        What the requirements fix, the rigid law's pure numbers, and the axes.

    Returns
    -------
    Screened
        Counts are exact; see the head of this module for what counts where.
    """
    bearings = frame.bearing_table().rows(space.bearings)
    tally = Tally(space.size)
    # Candidates per ring stage and pair of bearing and thickness.
    pins = len(space.pin_counts) * space.pin_sizes.size * space.inset.size
    pairs = bearings.width[:, None] <= space.thickness + _SLACK
    rings = _sound_rings(frame, tables, space, tally, pins * pairs.size)
    tally.after("BEARING-WIDTH", rings.eccentricity.size * pins * int(pairs.sum()))

    seats = _seats(frame, rings, bearings, pairs, tally, pins)
    contact = _ring_contact(frame, rings, space, seats, pairs, tally, pins)
    both = np.sum(_pair_counts(seats, pairs), axis=1, where=contact >= 1.0)
    alive = np.flatnonzero(both)
    rings, seats, contact, both = rings.rows(alive), seats[alive], contact[alive], both[alive]

    rows = _pin_rows(frame, rings, space, tally, both)
    seat = rows.circle - rows.hole_radius - allowables.LIGAMENT + _SLACK
    fits = seats[rows.ring] & (0.5 * bearings.outer <= seat[:, None])
    allowed = contact[rows.ring] >= 1.0
    tally.after("GEO-LIGAMENT-BORE", _count(fits, pairs, allowed))
    alive = np.flatnonzero(np.sum(_pair_counts(fits, pairs), axis=1, where=allowed))
    rows, fits, allowed = rows.rows(alive), fits[alive], allowed[alive]

    reserve = _pin_stresses(frame, rings, rows, space, fits, pairs, allowed, tally)
    np.minimum(reserve, contact[rows.ring], out=reserve)
    load = _cam_loads(frame, tables, rings, rows, space)
    carried = fits
    for check, limit in zip(
        reserves.CAM_CHECKS, (bearings.static_load, bearings.life_load), strict=True
    ):
        carried = carried & (load[:, None] <= limit)
        tally.after(check, _count(carried, pairs, allowed))
    return Screened(
        screened=space.size,
        rejected=tally.rejected,
        rings=rings,
        rows=rows,
        bearings=bearings,
        pairs=pairs,
        fits=fits,
        cam_load=load,
        reserve=reserve,
    )


def _pair_counts(first: BoolArray, pairs: BoolArray) -> FloatArray:
    """Bearings allowed with each thickness: (Q, B), (B, T) to (Q, T), whole numbers."""
    return np.asarray(first.astype(np.float32) @ pairs.astype(np.float32))


def _count(fits: BoolArray, pairs: BoolArray, allowed: BoolArray) -> int:
    """Candidates whose bearing fits the row and the thickness, and whose thickness is allowed."""
    return int(np.sum(_pair_counts(fits, pairs), where=allowed, dtype=np.float64))


def _sound_rings(
    frame: Frame, tables: StageTables, space: SearchSpace, tally: Tally, candidates: int
) -> Rings:
    """Ring stages whose disc and ring can be cut; `candidates` is what hangs on each."""
    shortening, share, scale = (
        axis.ravel()
        for axis in np.meshgrid(
            space.shortening, space.tooth_share, space.pitch_scale, indexing="ij"
        )
    )
    tooth = share * tables.tooth_spacing
    radius = scale * largest_pitch_radius(frame, shortening, tooth)
    rings = Rings(
        pitch_radius=radius,
        eccentricity=shortening * radius / (frame.lobe_count + 1),
        tooth_radius=tooth * radius,
        shortening_row=np.searchsorted(space.shortening, shortening),
        pressure_number=tables.pressure_at(shortening, share),
        friction_number=tables.friction_at(shortening, share),
    )
    keep = rings.eccentricity <= frame.throw_limit
    for check, met in shapes.profile_checks(frame, rings).items():
        keep &= met
        tally.after(check, int(keep.sum()) * candidates)
    rings = rings.rows(keep)
    rings = rings.rows(shapes.relief_passes_wire(frame, rings))
    tally.after("EDM-RING", rings.eccentricity.size * candidates)
    return rings


def _seats(
    frame: Frame,
    rings: Rings,
    bearings: BearingTable,
    pairs: BoolArray,
    tally: Tally,
    pins: int,
) -> BoolArray:
    """Bearings (G, B) that fit the eccentric and leave a rim to the valleys."""
    seats = bearings.bore >= least_bore(rings.eccentricity)[:, None] - _SLACK
    per_bearing = pairs.sum(axis=1) * pins
    tally.after("BEARING-CORE", int((seats.sum(axis=0) * per_bearing).sum()))
    valley = shapes.valley_distance(frame, rings)
    seats &= valley[:, None] - 0.5 * bearings.outer >= allowables.LIGAMENT - _SLACK
    tally.after("GEO-LIGAMENT-RIM", int((seats.sum(axis=0) * per_bearing).sum()))
    return np.asarray(seats)


def _ring_contact(
    frame: Frame,
    rings: Rings,
    space: SearchSpace,
    seats: BoolArray,
    pairs: BoolArray,
    tally: Tally,
    pins: int,
) -> FloatArray:
    """Torque reserve (G, T) of the ring contact."""
    counts = _pair_counts(seats, pairs)
    found = reserves.ring_reserves(
        frame,
        rings.pressure_number[:, None],
        rings.pitch_radius[:, None],
        space.thickness,
    )
    least = np.full(counts.shape, np.inf)
    for check in reserves.RING_CHECKS:
        least = np.minimum(least, found[check])
        tally.after(check, int(np.sum(counts, where=least >= 1.0, dtype=np.float64)) * pins)
    return least


def _pin_rows(
    frame: Frame, rings: Rings, space: SearchSpace, tally: Tally, both: FloatArray
) -> Rows:
    """Rows whose holes leave their ligaments; `both` (G,) is the number of (B, b) left to each."""
    sizes = [frame.pin_sizes[row] for row in space.pin_sizes]
    width = np.array([size.running_diameter + size.hole_clearance for size in sizes])
    hole = 0.5 * width + rings.eccentricity[:, None]
    offset = np.array([shapes.valley_offset(frame, count) for count in space.pin_counts])
    # Axes: ring, pin count, pin size, inset.
    outermost = shapes.largest_pin_circle(frame, rings, hole[:, None, :], offset[None, :, None])
    circle = outermost[..., None] - space.inset * rings.pitch_radius[:, None, None, None]
    holes = np.broadcast_to(hole[:, None, :, None], circle.shape)
    keep = circle > holes
    per_ring = both[:, None, None, None]

    def left() -> int:
        return int(np.sum(np.broadcast_to(per_ring, keep.shape), where=keep, dtype=np.float64))

    tally.after("GEO-LIGAMENT-PROFILE", left())
    counts = np.array(space.pin_counts)[:, None, None]
    keep &= ligament_hole_to_hole(circle, counts, 2.0 * holes) >= allowables.LIGAMENT - _SLACK
    tally.after("GEO-LIGAMENT-HOLES", left())
    keep &= holes >= frame.wire_radius
    tally.after("EDM-HOLE", left())
    ring, count, size, _ = np.nonzero(keep)
    return Rows(ring, count, size, circle[keep], holes[keep])


def _pin_stresses(
    frame: Frame,
    rings: Rings,
    rows: Rows,
    space: SearchSpace,
    fits: BoolArray,
    pairs: BoolArray,
    allowed: BoolArray,
    tally: Tally,
) -> FloatArray:
    """Least torque reserve (Q, T) of the output pins; narrows `allowed` (Q, T) in place."""
    sizes = [frame.pin_sizes[row] for row in space.pin_sizes]
    running = np.array([s.running_diameter for s in sizes])
    hole = 0.5 * (running + np.array([s.hole_clearance for s in sizes]))
    factor = np.array([rigid.peak_pin_force_factor(one) for one in space.pin_counts])
    count = np.array(space.pin_counts)
    # Axes: ring, pin count, pin size, thickness. Only the contact sees the ring, by its holes.
    per_radius = reserves.pin_reserves_per_radius(
        frame,
        factor[:, None, None],
        count[:, None, None],
        np.array([s.diameter for s in sizes])[:, None],
        0.5 * running[:, None],
        (hole + rings.eccentricity[:, None])[:, None, :, None],
        space.thickness,
    )
    each = [s.cage_ratings(space.thickness) for s in sizes]
    ratings = np.array([one[0] for one in each]), np.array([one[1] for one in each])
    needles = reserves.needle_reserves_per_radius(
        frame, factor[:, None, None], count[:, None, None], ratings, running[:, None]
    )
    counts = _pair_counts(fits, pairs)
    least = np.full(allowed.shape, np.inf)
    for check, table in (*per_radius.items(), *needles.items()):
        place = (rows.ring,) if table.ndim == 4 else ()
        whole = np.broadcast_to(
            table, (*table.shape[:-3], len(space.pin_counts), len(sizes), space.thickness.size)
        )
        np.minimum(least, whole[(*place, rows.count, rows.size)] * rows.circle[:, None], out=least)
        allowed &= least >= 1.0
        tally.after(check, int(np.sum(counts, where=allowed, dtype=np.float64)))
    return least


def _cam_loads(
    frame: Frame, tables: StageTables, rings: Rings, rows: Rows, space: SearchSpace
) -> FloatArray:
    """Largest cam load (Q,) over the period, both senses and all discs, N.

    For given K1 and N_w the radial part is the greatest of many straight lines in R/R_w, so it is
    convex, and interpolating it linearly errs on the safe side (by less than 1e-3).
    """
    ratio = rings.pitch_radius[rows.ring] / rows.circle
    if ratio.size == 0:
        return np.zeros(0)
    nodes = np.linspace(float(ratio.min()), float(ratio.max()) + 1e-9, _RATIO_NODES)
    first = int(np.searchsorted(tables.shortening, space.shortening[0] - 1e-12))
    step = 1
    if space.shortening.size > 1:
        step = round(
            (space.shortening[1] - space.shortening[0])
            / (tables.shortening[1] - tables.shortening[0])
        )
    radial = tables.radial[:, first::step][:, : space.shortening.size]
    table = np.empty((len(space.pin_counts), space.shortening.size, nodes.size))
    for place, count in enumerate(space.pin_counts):
        sums = tables.pin_sums(count, frame.disc_count, frame.clocking)
        table[place] = tables.cam_radial_peak(radial[:, :, None, :], sums, nodes[None, :])
    at = (ratio - nodes[0]) / (nodes[1] - nodes[0])
    cell = np.minimum(at.astype(np.intp), nodes.size - 2)
    along = at - cell
    row = rings.shortening_row[rows.ring]
    number = table[rows.count, row, cell] * (1.0 - along) + table[rows.count, row, cell + 1] * along
    return reserves.cam_load(
        frame, rings.pitch_radius[rows.ring], rings.eccentricity[rows.ring], number
    )
