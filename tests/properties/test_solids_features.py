"""Features of parts: on their part, in their material, with all the facts that make them."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest
from examples import examples
from hypothesis import HealthCheck, given, settings
from solids_designs import CHANGES, known_parts, machines, part_named

from cqdd_design.catalog.bearings import Bearing
from cqdd_design.catalog.fits import fit_limits
from cqdd_design.catalog.motors import find_motor
from cqdd_design.catalog.screws import pin_diameter_limits
from cqdd_design.catalog.threads import tap_drill, thread_named, thread_size_of
from cqdd_design.design import Design
from cqdd_design.errors import CatalogError, GeometryError
from cqdd_design.geometry.contours import Circle, Contour, PlanarPart
from cqdd_design.solids.features.edges import edges
from cqdd_design.solids.features.holes import FittedHole, TappedHole
from cqdd_design.solids.features.kinds import (
    AxialThread,
    Chamfer,
    Groove,
    Joint,
    Seat,
    Shoulder,
    TrueFace,
    Undercut,
    datum_cells,
)
from cqdd_design.solids.features.making import point_length
from cqdd_design.solids.features.removal import cuts, drillings
from cqdd_design.solids.features.revolved import Revolved
from cqdd_design.solids.features.zones import PIN
from cqdd_design.solids.layers import Annulus, Layer, Stack, turned
from cqdd_design.solids.part import Part
from cqdd_design.solids.parts import build_parts
from cqdd_design.solids.proportions import lay_out

SAME = 1e-9


def test_bodies_of_revolution_have_the_closed_forms_of_textbooks() -> None:
    # A full torus from two half circles.
    major, minor, density = 0.03, 0.004, 1000.0
    torus = Revolved(((major + minor, 0.01), (major - minor, 0.01)), bulges=(1.0, 1.0))
    own = torus.mass_properties(density)
    mass = density * 2.0 * math.pi**2 * major * minor**2
    assert own.mass == pytest.approx(mass, rel=1e-12)
    assert torus.volume * density == pytest.approx(mass, rel=1e-12)
    assert own.centre == pytest.approx([0.0, 0.0, 0.01], abs=1e-15)
    assert own.inertia[2, 2] == pytest.approx(mass * (major**2 + 0.75 * minor**2), rel=1e-12)
    across = mass * (0.5 * major**2 + 0.625 * minor**2)
    assert own.inertia[0, 0] == pytest.approx(across, rel=1e-12)
    # A cone standing on its point, three times beside the axis.
    radius, height = 0.004, 0.006
    outline = ((0.0, 0.0), (radius, height), (0.0, height))
    one = Revolved(outline).mass_properties(density)
    assert one.mass == pytest.approx(density * math.pi * radius**2 * height / 3.0, rel=1e-12)
    assert one.centre[2] == pytest.approx(0.75 * height)
    assert one.inertia[2, 2] == pytest.approx(0.3 * one.mass * radius**2)
    assert one.inertia[0, 0] == pytest.approx(
        one.mass * (0.15 * radius**2 + 3.0 / 80.0 * height**2)
    )
    places = ((0.01, 0.02), (-0.03, 0.005), (0.002, -0.01))
    together = Revolved(outline, places).mass_properties(density)
    alone = [one.moved(np.array([x, y, 0.0])) for x, y in places]
    summed = alone[0] + alone[1] + alone[2]
    assert together.mass == pytest.approx(summed.mass)
    assert together.centre == pytest.approx(summed.centre)
    assert together.inertia == pytest.approx(summed.inertia)


def test_chords_keep_the_area_of_the_arcs_they_stand_for() -> None:
    groove = Groove("groove", "DIN 76-B", 0.046, 0.01, 0.014, 0.025, False, 0.0006)
    cut = Undercut("undercut", "journal", 0.005, 0.02, "down", 0.0004, 0.0002, 0.002)
    for drawn in cuts((groove, cut)):
        chorded = drawn.chorded
        assert any(drawn.bulges)
        assert not chorded.bulges
        assert chorded.volume == pytest.approx(drawn.volume, rel=2e-4)
    # Widths and depths are those of the feature.
    (body,) = cuts((cut,))
    radii, heights = np.array(body.outline).T
    assert (radii.min(), radii.max()) == pytest.approx((0.0048, 0.005))
    assert heights.min() == pytest.approx(0.018)
    # The fillet, deeper than the cylinder by half its radius, meets it under the face.
    assert heights.max() == pytest.approx(0.02 - (4e-4 - math.sqrt(12e-8)))


def test_edges_are_where_turning_leaves_them() -> None:
    stepped = turned([Annulus(0.0, 0.01, 0.005, 0.02), Annulus(0.01, 0.02, 0.005, 0.012)])
    found = {(one.radius, one.height, one.inside, one.facing): one for one in edges(stepped)}
    assert set(found) == {
        (0.02, 0.0, False, "down"), (0.02, 0.01, False, "up"), (0.012, 0.02, False, "up"),
        (0.005, 0.0, True, "down"), (0.005, 0.02, True, "up"),
    }  # fmt: skip
    assert found[0.02, 0.0, False, "down"].width == pytest.approx(0.8e-3)
    # A narrow face takes a narrow chamfer: 15 % of 8 mm is more than the 0.8 mm of its diameter.
    narrow = turned([Annulus(0.0, 0.01, 0.018, 0.02)])
    assert {one.width for one in edges(narrow)} == {0.3e-3}


def test_a_chamfer_opens_no_blind_hole_under_its_face() -> None:
    """A chamfer of 0.8 mm would reach 0.05 mm into holes whose ground is 0.25 mm under the face."""

    def plate(floor: float) -> Stack:
        outline = Circle(np.zeros(2), 12.85e-3)
        pins = tuple(
            Circle(10.35e-3 * np.array([math.cos(a), math.sin(a)]), 2e-3)
            for a in np.linspace(0.0, 2.0 * math.pi, 9, endpoint=False)
        )
        drilled, whole = PlanarPart("plate", outline, pins), PlanarPart("plate", outline)
        return Stack((Layer(drilled, 0.0, 6e-3), Layer(whole, 6e-3, 6e-3 + floor)))

    def widths(floor: float) -> dict[str, float]:
        return {str(one.facing): one.width for one in edges(plate(floor)) if not one.inside}

    # 0.5 mm from the rim to the holes, where they come out below.
    assert widths(0.25e-3) == pytest.approx({"down": 0.3e-3, "up": 0.5e-3})
    # Deep enough, they are in nobody's way; through the face, they are as below.
    assert widths(0.36e-3)["up"] == pytest.approx(0.8e-3)
    assert widths(0.34e-3)["up"] == pytest.approx(0.5e-3)


def samples(cut: Revolved) -> Iterator[tuple[float, float, float]]:
    """Points just inside a body of revolution."""
    corners = np.array(cut.chorded.outline)
    middle = corners.mean(axis=0)
    for r, z in middle + 0.98 * (corners - middle):
        for x, y in cut.centres:
            for angle in np.linspace(0.1, 2.0 * math.pi, 12, endpoint=False):
                yield x + r * math.cos(angle), y + r * math.sin(angle), z


def within(contour: Contour, x: float, y: float) -> bool:
    if isinstance(contour, Circle):
        return math.hypot(x - contour.centre[0], y - contour.centre[1]) < contour.radius
    polygon = contour.sample(1e-6)
    turn = np.angle(np.roll(polygon[:, 0] - x + 1j * (polygon[:, 1] - y), -1)
                    / (polygon[:, 0] - x + 1j * (polygon[:, 1] - y))).sum()  # fmt: skip
    return abs(turn) > math.pi


def in_material(part: Part, point: tuple[float, float, float]) -> bool:
    x, y, z = point
    return any(
        layer.bottom < z < layer.top
        and within(layer.shape.outer, x, y)
        and not any(within(hole, x, y) for hole in layer.shape.holes)
        for layer in part.shape.layers
    )


def assert_features_on(part: Part) -> None:
    names = [one.name for one in part.features]
    assert len(set(names)) == len(names), part.name
    for cut in part.cuts:
        assert cut.volume > 0.0
        assert all(in_material(part, point) for point in samples(cut)), (part.name, cut)
    circles = [
        (layer.bottom, layer.top, *hole.centre, hole.radius)
        for layer in part.shape.layers
        for hole in (layer.shape.outer, *layer.shape.holes)
        if isinstance(hole, Circle)
    ]

    def runs(x: float, y: float, radius: float, bottom: float, top: float) -> bool:
        """Whether the part has a cylinder all the way between two heights."""
        ends = sorted(
            (low, high)
            for low, high, cx, cy, r in circles
            if math.hypot(cx - x, cy - y) < SAME and abs(r - radius) < SAME
        )
        level = bottom
        for low, high in ends:
            if low <= level + SAME:
                level = max(level, high)
        return level >= top - SAME

    for drilling in drillings(part.features):
        for x, y in drilling.centres:
            assert runs(x, y, drilling.radius, drilling.bottom, drilling.top), part.name
    for one in part.features:
        if isinstance(one, Seat) and part.exact_section is None:
            # A pin is drawn at the mean of its limits.
            drawn = (one.diameter,)
            if part.name == "dowel pin" and one.zone != PIN:
                zone = fit_limits(one.zone, one.diameter)
                drawn = (one.diameter + zone.lower, one.diameter + zone.upper)
            elif one.zone == PIN:
                drawn = pin_diameter_limits(one.diameter)
            radius = 0.5 * sum(drawn) / len(drawn)
            covered = runs(*one.centre, radius, one.bottom, one.top)
            assert covered or one.name in BROKEN_SEATS, (part.name, one.name)
        elif isinstance(one, TappedHole):
            assert one.through or one.drill_depth > one.thread_depth
            assert one.drill < one.thread
        elif isinstance(one, Joint):
            assert one.seat in names
        elif isinstance(one, Undercut):
            seat = next(seat for seat in part.fits if seat.name == one.seat)
            assert one.width < 0.5 * (seat.top - seat.bottom)


BROKEN_SEATS = ("ring seat", "stator register")
"""Cylinders that the halves of dowels' holes or a lip beside them break."""


@pytest.mark.parametrize("name", CHANGES)
def test_features_of_known_machines_lie_on_their_parts(name: str) -> None:
    for part in known_parts(name):
        assert_features_on(part)
        if part.source == "make":
            assert part.features, part.name


@given(machines())
@settings(
    max_examples=examples(30),
    deadline=None,
    suppress_health_check=[HealthCheck.filter_too_much, HealthCheck.too_slow],
)
def test_features_survive_in_any_machine(machine: tuple[Design, Bearing]) -> None:
    design, bearing = machine
    try:
        parts = build_parts(design, lay_out(design, bearing, find_motor(design.motor.name)))
    except (GeometryError, CatalogError):
        return
    for part in parts:
        assert_features_on(part)


def all_features(kind: type) -> Iterator[tuple[Part, object]]:
    for name in CHANGES:
        for part in known_parts(name):
            for one in part.features:
                if isinstance(one, kind):
                    yield part, one


def test_every_seat_has_the_facts_that_make_it() -> None:
    seen = 0
    for part, one in all_features(Seat):
        assert isinstance(one, Seat)
        assert one.limits.lower < one.limits.upper
        assert 0.0 < one.roughness <= 1.6e-6
        zone = one.limits.upper - one.limits.lower
        # Nothing sits on what a gap seals or an indicator is held to: it only has to run true.
        true = isinstance(one, TrueFace)
        assert one.cylindricity == 0.0 if true else 0.0 < one.cylindricity < zone
        assert (one.run_out > 0.0) == bool(one.refers)
        assert one.refers or one.datum, part.name
        assert one.ground == (one.roughness < 0.8e-6)
        seen += 1
    assert seen > 100
    journal = next(
        one for one in part_named(known_parts("paper"), "eccentric shaft").fits
        if one.name == "upper journal"
    )  # fmt: skip
    # SKF: cylindricity and total run-out of a k6 seat within half of IT5, 6 um at 10 mm.
    assert isinstance(journal, Seat)
    assert (journal.zone, journal.run_out, journal.roughness) == ("k6", 3e-6, 0.4e-6)


def test_bearings_find_a_chamfer_and_a_free_corner() -> None:
    """Turned bearing seats start with a chamfer, and ground ones end in an undercut."""
    for name in CHANGES:
        for part in known_parts(name):
            chamfers = [one for one in part.features if isinstance(one, Chamfer)]
            grooves = [one for one in part.features if isinstance(one, Groove | AxialThread)]
            reliefs = {one.seat for one in part.features if isinstance(one, Undercut)}
            for one in part.fits:
                if not isinstance(one, Seat) or "bearing" not in one.name + " " + part.name:
                    continue
                if part.exact_section is not None or "journal" in one.name:
                    continue
                ends = (one.bottom, one.top)
                entered = any(
                    abs(edge.radius - 0.5 * one.diameter) < SAME
                    and min(abs(edge.height - end) for end in ends) < SAME
                    for edge in chamfers
                )
                assert entered or grooves, (part.name, one.name)
            if part.name == "eccentric shaft":
                journals = {"lower journal and rotor seat", "upper journal"}
                assert journals <= reliefs
                for one in part.fits:
                    if one.name in journals:
                        assert any(edge.height in (one.bottom, one.top) for edge in chamfers)


def test_shoulders_stand_beside_their_seats() -> None:
    for part, one in all_features(Shoulder):
        assert isinstance(one, Shoulder)
        assert one.inner < one.outer, (part.name, one.name)
        assert one.run_out > 0.0
        height = [end for layer in part.shape.layers for end in (layer.bottom, layer.top)]
        assert min(abs(one.height - end) for end in height) < SAME, (part.name, one.name)


@pytest.mark.parametrize("name", CHANGES)
def test_every_datum_that_is_referred_to_is_set_on_its_part(name: str) -> None:
    """A frame that names a datum which is nowhere cannot be inspected."""
    seen = 0
    for part in known_parts(name):
        if part.source != "make":
            continue
        letters = {letter for f in part.features for letter in getattr(f, "datum", "")}
        if part.name == "ring":
            # Cut sheets have their lower face as B.
            letters.add("B")
        for feature in part.features:
            asked = set(getattr(feature, "refers", "").replace("-", ""))
            seen += len(asked)
            assert asked <= letters, (part.name, feature)
    assert seen > 10


def test_the_shaft_turns_about_the_common_axis_of_its_journals() -> None:
    """ISO 5459: one cell with A-B. In two cells B would but stop what A leaves free, nothing."""
    part = next(one for one in known_parts("paper") if one.name == "eccentric shaft")
    frames = [f for f in part.features if isinstance(f, Seat) and (f.run_out or f.position)]
    assert len(frames) >= 4
    assert {datum_cells(one.refers) for one in frames} == {("A-B",)}


def test_tapped_holes_are_drilled_for_their_tap() -> None:
    for part, one in all_features(TappedHole):
        assert isinstance(one, TappedHole)
        thread = thread_named(one.designation, one.thread)
        assert (one.pitch, one.drill) == (thread.pitch, tap_drill(thread))
        points = [cut for cut in cuts((one,)) if min(r for r, _ in cut.outline) == 0.0]
        assert bool(points) != one.through, part.name
        for cut in points:
            heights = [z for _, z in cut.outline]
            assert max(heights) - min(heights) == pytest.approx(point_length(one.drill))
    # 118 degrees: half a diameter over tan 59.
    assert point_length(2.5e-3) == pytest.approx(0.751e-3, abs=1e-6)


def test_parts_that_are_put_together_share_their_bolt_circles() -> None:
    for name in CHANGES:
        circles: dict[str, set[tuple[float, tuple[float, ...]]]] = {}
        for part in known_parts(name):
            if part.name.startswith("disc"):
                continue
            for one in part.features:
                if isinstance(one, TappedHole | FittedHole):
                    key = (one.circle.radius, one.circle.angles)
                    circles.setdefault(one.circle.name, set()).add(key)
        assert circles
        assert all(len(found) == 1 for found in circles.values()), name


def test_masses_count_what_is_cut_away() -> None:
    plate = part_named(known_parts("paper"), "carrier plate")
    taken = math.fsum(cut.volume for cut in plate.cuts)
    assert 0.0 < taken < 0.05 * plate.shape.volume
    assert plate.mass == pytest.approx((plate.shape.volume - taken) * plate.density, rel=1e-12)
    whole = plate.shape.mass_properties(plate.density)
    parts = plate.exact_properties
    for cut in plate.cuts:
        parts = parts + cut.mass_properties(plate.density)
    assert parts.centre == pytest.approx(whole.centre, abs=1e-12)
    assert parts.inertia == pytest.approx(whole.inertia, rel=1e-9, abs=1e-15)


def test_a_thread_that_is_in_no_table_names_the_nearest() -> None:
    with pytest.raises(CatalogError, match=r"diameter of 3\.4 mm; the nearest is M3"):
        thread_size_of(3.4e-3)
