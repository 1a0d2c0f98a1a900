"""Checks of shape and manufacture: profile limits, walls, ligaments, fits, space, wire EDM."""

from __future__ import annotations

import math
from contextlib import suppress

from cqdd_design.catalog.screws import LEAST_COLUMN
from cqdd_design.errors import CqddError
from cqdd_design.gearbox.cam_bearing import least_bore
from cqdd_design.gearbox.checks import allowables
from cqdd_design.gearbox.checks.state import GearboxState, build_check
from cqdd_design.geometry.disc import ligaments
from cqdd_design.geometry.limits import at_most, rounded_down, rounded_up
from cqdd_design.geometry.output_pins import pin_limits
from cqdd_design.results import Check

_SLACK = 1e-12
"""Lengths below this are rounding, m."""
_MOVES = 20
"""Of a circle of holes, until they stand right."""


def shape_checks(state: GearboxState) -> tuple[Check, ...]:
    """All checks of this chapter, in the order of a reader's questions."""
    return (
        *_profile(state),
        _ring_wall(state),
        *_ligaments(state),
        *_fits(state),
        *_space(state),
        *_edm(state),
    )


def _mm(length: float) -> float:
    return length * 1e3


def _profile(state: GearboxState) -> tuple[Check, ...]:
    n, radius = state.stages.lobe_count, state.stages.ring_pitch_radius
    e, r = state.stages.eccentricity, state.stages.tooth_radius
    key = state.design.reducer.tooth_key
    k1, undercut = state.geometry.shortening_coefficient, state.geometry.undercut_radius_limit
    substituted = f"K1 = {_mm(e):.4g} mm x {n + 1}/{_mm(radius):.4g} mm = {k1:.4f}"

    def throw_for(limit: float) -> float:
        return _mm(limit * radius / (n + 1))

    touching = radius * math.sin(math.pi / (n + 1))
    most_undercut = allowables.UNDERCUT_SHARE * undercut
    most_overlap = allowables.TOOTH_OVERLAP_SHARE * touching
    return (
        build_check(
            "GEO-K1-LEAST",
            k1,
            allowables.SHORTENING_LEAST,
            substituted,
            f"raise eccentricity to {rounded_up(throw_for(allowables.SHORTENING_LEAST)):g} mm",
        ),
        build_check(
            "GEO-K1-MOST",
            k1,
            allowables.SHORTENING_MOST,
            substituted,
            f"lower eccentricity to {rounded_down(throw_for(allowables.SHORTENING_MOST)):g} mm",
        ),
        build_check(
            "GEO-UNDERCUT",
            _mm(r),
            _mm(most_undercut),
            f"r = {_mm(r):.4g} mm, {allowables.UNDERCUT_SHARE:g} x {_mm(undercut):.4f} mm = "
            f"{_mm(most_undercut):.4f} mm",
            f"lower {key} to {rounded_down(2.0 * _mm(most_undercut)):g} mm",
        ),
        build_check(
            "GEO-TOOTH-OVERLAP",
            _mm(r),
            _mm(most_overlap),
            f"{allowables.TOOTH_OVERLAP_SHARE:g} x {_mm(radius):.4g} mm x sin(180 deg/{n + 1}) = "
            f"{_mm(most_overlap):.4f} mm",
            f"lower {key} to {rounded_down(2.0 * _mm(most_overlap)):g} mm",
        ),
    )


def _ring_wall(state: GearboxState) -> Check:
    outer, root = state.design.reducer.ring.outer_diameter, state.geometry.ring_root_radius
    wall = 0.5 * outer - root
    enough = 2.0 * (root + allowables.RING_WALL)
    lower = state.stages.ring_pitch_radius - max(allowables.RING_WALL - wall, 0.0)
    return build_check(
        "GEO-RING-WALL",
        _mm(wall),
        _mm(allowables.RING_WALL),
        f"{_mm(outer):.4g} mm/2 - {_mm(root):.4f} mm = {_mm(wall):.4f} mm",
        f"raise ring.outer_diameter to {rounded_up(_mm(enough), 4):g} mm, or lower "
        f"ring_pitch_radius to about {rounded_down(_mm(lower), 4):g} mm",
    )


def _ligaments(state: GearboxState) -> tuple[Check, ...]:
    limit = allowables.LIGAMENT
    geometry, stages = state.geometry, state.stages
    circle, hole = stages.pin_circle_radius, 2.0 * stages.hole_radius
    between = (hole + limit) / (2.0 * math.sin(math.pi / stages.pin_count))
    bearing = state.cam_bearing.bearing

    def one(check_id: str, kind: str, remedy: str) -> Check:
        found = geometry.ligament(kind)
        return build_check(
            check_id,
            _mm(found.thickness),
            _mm(limit),
            f"{_mm(found.thickness):.4f} mm {found.where}",
            remedy,
        )

    def short(kind: str) -> float:
        return max(limit - geometry.ligament(kind).thickness, 0.0)

    to_bore, to_rim = short("hole to bore"), short("bore to profile")
    columns: tuple[Check, ...] = ()
    if state.design.reducer.carrier.column_count:
        kinds = ("column to hole", "column to profile", "column to bore")
        thinnest = min(kinds, key=lambda kind: geometry.ligament(kind).thickness)
        diameter = state.design.reducer.carrier.column_diameter
        most = diameter - 2.0 * short(thinnest)
        remedy = (
            f"lower carrier.column_diameter to {at_most(most)}"
            if most > LEAST_COLUMN
            else 'use fewer or thinner pins, or carrier.joint = "clamped"'
        )
        columns = (one("GEO-LIGAMENT-COLUMN", thinnest, remedy),)
    return (
        one(
            "GEO-LIGAMENT-HOLES",
            "hole to hole",
            _outward(state, rounded_up(_mm(between), 4)) + "use fewer or thinner pins",
        ),
        one(
            "GEO-LIGAMENT-PROFILE",
            "hole to profile",
            _inward(state) if short("hole to profile") else "",
        ),
        one(
            "GEO-LIGAMENT-BORE",
            "hole to bore",
            _outward(state, rounded_up(_mm(circle + to_bore), 4))
            + f"use a cam bearing of at most {_mm(bearing.outer_diameter - 2.0 * to_bore):.2f} mm "
            "outside diameter",
        ),
        one(
            "GEO-LIGAMENT-RIM",
            "bore to profile",
            f"use a cam bearing of at most {_mm(bearing.outer_diameter - 2.0 * to_rim):.2f} mm "
            "outside diameter",
        ),
        *columns,
    )


def _outward(state: GearboxState, circle: float) -> str:
    """To raise the circle of the holes, mm, with "or"; nothing where they come too near the lobes.

    The lobes' nearest point moves along them, so it is looked at.
    """
    bore = state.cam_bearing.bearing.outer_diameter
    key = "reducer.output_pins.circle_radius"
    with suppress(CqddError):
        moved = ligaments(state.design.replacing({key: 1e-3 * circle}), bore_diameter=bore)
        beside = next(one.thickness for one in moved if one.kind == "hole to profile")
        if beside >= allowables.LIGAMENT - _SLACK:
            return f"raise output_pins.circle_radius to {circle:g} mm, or "
    return ""


def _inward(state: GearboxState) -> str:
    """The circle whose holes leave enough beside the lobes, by the distance to their nearest point.

    That moves along the lobe as the holes go inward, so they are looked at again; and where they
    come too near the bore on that circle, the bearing that is small enough for it.
    """
    key, bore = "reducer.output_pins.circle_radius", state.cam_bearing.bearing.outer_diameter
    circle, found = state.stages.pin_circle_radius, state.geometry.ligaments
    with suppress(CqddError):
        for _ in range(_MOVES):
            left = {one.kind: one.thickness for one in found}
            short = allowables.LIGAMENT - left["hole to profile"]
            if short <= _SLACK:
                move = f"lower output_pins.circle_radius to {_mm(circle):g} mm"
                inside = allowables.LIGAMENT - left["hole to bore"]
                if inside <= _SLACK:
                    return move
                smaller = (
                    f"a cam bearing of at most {rounded_down(_mm(bore - 2.0 * inside), 4):g} mm"
                )
                return f"use thinner pins, or {move} with {smaller} outside diameter"
            # To a hundredth of a millimetre, so that what is told is what was looked at.
            circle = 1e-5 * math.floor(1e5 * (circle - short))
            found = ligaments(state.design.replacing({key: circle}), bore_diameter=bore)
    return "use fewer or thinner pins, or lower output_pins.circle_radius"


def _fits(state: GearboxState) -> tuple[Check, ...]:
    pins, bearing = state.design.reducer.output_pins, state.cam_bearing.bearing
    reducer = state.design.reducer
    least, greatest = pin_limits(pins)
    sleeved = pins.sleeve_diameter > 0.0
    # A sleeve is ground to size, so its hole clearance is what the stack gets.
    spread = 0.0 if sleeved else 0.5 * (greatest - least)
    tightest = pins.hole_clearance - spread
    if abs(tightest) < _SLACK:
        tightest = 0.0
    return (
        build_check(
            "FIT-PIN-HOLE",
            tightest * 1e6,
            0.0,
            f"{pins.hole_clearance * 1e6:.4g} um - {spread * 1e6:.4g} um = {tightest * 1e6:.4g} um",
            f"raise output_pins.hole_clearance to {math.ceil(spread * 1e6 - 1e-6):g} um",
        ),
        build_check(
            "BEARING-WIDTH",
            _mm(bearing.width),
            _mm(reducer.disc_thickness),
            f"B = {_mm(bearing.width):g} mm, b = {_mm(reducer.disc_thickness):g} mm",
            f"raise disc_thickness to {_mm(bearing.width):g} mm, or use a narrower bearing",
        ),
        build_check(
            "BEARING-CORE",
            _mm(bearing.bore_diameter),
            _mm(least_bore(reducer.eccentricity)),
            f"bore {_mm(bearing.bore_diameter):g} mm, {least_bore(1.0):g} e = "
            f"{_mm(least_bore(reducer.eccentricity)):.3f} mm",
            "use a cam bearing with a bore of at least "
            f"{rounded_up(_mm(least_bore(reducer.eccentricity))):g} mm",
        ),
    )


def _space(state: GearboxState) -> tuple[Check, ...]:
    """Check the two space limits: only warnings where nobody stated the requirement."""
    design, wanted = state.design, state.design.requirements
    outer, length = design.reducer.ring.outer_diameter, design.reducer.pack_length
    discs, spacing = design.reducer.disc_count, design.reducer.disc_spacing
    thin = (wanted.length - (discs - 1) * spacing) / discs
    thinner = f"lower disc_thickness to {rounded_down(_mm(thin)):g} mm, or " if thin > 0.0 else ""
    walled = wanted.outer_diameter >= 2.0 * (state.geometry.ring_root_radius + allowables.RING_WALL)
    smaller = f"lower ring.outer_diameter to {_mm(wanted.outer_diameter):g} mm, or "
    return (
        build_check(
            "SPACE-DIAMETER",
            _mm(outer),
            _mm(wanted.outer_diameter),
            f"{_mm(outer):.4g} mm in {_mm(wanted.outer_diameter):.4g} mm",
            (smaller if walled else "")
            + f"raise requirements.outer_diameter to {rounded_up(_mm(outer), 4):g} mm",
            severity="warn" if "requirements.outer_diameter" in design.assumed else "fail",
        ),
        build_check(
            "SPACE-LENGTH",
            _mm(length),
            _mm(wanted.length),
            f"{_mm(length):.4g} mm in {_mm(wanted.length):.4g} mm",
            f"{thinner}raise requirements.length to {rounded_up(_mm(length), 4):g} mm",
            severity="warn" if "requirements.length" in design.assumed else "fail",
        ),
    )


def _edm(state: GearboxState) -> tuple[Check, ...]:
    edm, geometry = state.design.edm, state.geometry
    needed = edm.wire_offset

    def one(check_id: str, radius: float, what: str) -> Check:
        finer = 2.0 * (radius - edm.spark_gap)
        return build_check(
            check_id,
            _mm(needed),
            _mm(radius),
            f"{_mm(edm.wire_diameter):g} mm/2 + {_mm(edm.spark_gap):g} mm = {_mm(needed):.4g} mm, "
            f"least concave radius {_mm(radius):.4f} mm",
            f"use a wire of at most {rounded_down(_mm(finer)):g} mm"
            if finer > 0.0
            else f"enlarge the {what}: their radius is below the spark gap",
        )

    valleys = (
        (one("EDM-DISC", geometry.disc_min_concave_radius, "disc's valleys"),)
        if geometry.has_concave_valleys
        else ()
    )
    return (
        *valleys,
        one("EDM-HOLE", 0.5 * geometry.hole_diameter, "output holes"),
        one("EDM-RING", geometry.ring_min_concave_radius, "ring's reliefs"),
    )
