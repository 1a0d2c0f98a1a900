"""Impossible shapes: refused with a limit that is true and a fix that works."""

from __future__ import annotations

import math
import re
from typing import Any

import pytest
from examples import examples
from geometry_designs import PAPER, design_of, discs, joint_angles, tooth_gaps
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design.design import Design
from cqdd_design.errors import DesignError, GeometryError
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.disc import disc_contour, lobed_outline
from cqdd_design.geometry.limits import largest_eccentricity, smallest_pitch_radius
from cqdd_design.geometry.ring import ring_contour
from cqdd_design.geometry.trochoid import undercut_radius_limit
from cqdd_design.geometry.validate import validate_geometry

BORE = 0.028


def _numbers(message: str, before: str) -> float:
    found = re.search(re.escape(before) + r" ([\d.e+-]+) mm", message)
    assert found, message
    return float(found.group(1)) * 1e-3


@given(st.integers(3, 119), st.floats(0.005, 0.3), st.floats(0.01, 0.99))
def test_largest_eccentricity_is_the_undercut_limit(n: int, R: float, share: float) -> None:
    r = share * R * math.sin(math.pi / (n + 1))
    e = largest_eccentricity(n, R, r)
    assert float(undercut_radius_limit(n, R, e)) == pytest.approx(r, rel=1e-6)
    assert smallest_pitch_radius(n, e, r) == pytest.approx(R, rel=1e-6)


@settings(max_examples=examples(60), deadline=None)
@given(discs(), st.floats(1.001, 5.0))
def test_undercut_message_is_true_and_both_fixes_work(disc: CycloidDisc, factor: float) -> None:
    n, R, r = disc.lobe_count, disc.ring_pitch_radius, disc.tooth_radius
    limit = largest_eccentricity(n, R, r)
    with pytest.raises(GeometryError, match="undercuts at ring_pin_diameter") as caught:
        CycloidDisc(n, R, factor * limit, r)
    message = str(caught.value)
    assert CycloidDisc(n, R, _numbers(message, "is above"), r)
    assert CycloidDisc(n, _numbers(message, "ring_pitch_radius to"), factor * limit, r)
    assert _numbers(message, "is above") > 0.98 * limit


def test_undercut_sentence_in_full() -> None:
    with pytest.raises(GeometryError) as caught:
        CycloidDisc(10, 0.032, 0.0028, 0.0060)
    assert str(caught.value) == (
        "eccentricity 2.8 mm is above 2.56 mm, where the disc undercuts at ring_pin_diameter "
        "12 mm; lower it, or raise ring_pitch_radius to 34.4 mm."
    )


@settings(max_examples=examples(40), deadline=None)
@given(discs(), st.floats(1.001, 3.0))
def test_overlapping_teeth(disc: CycloidDisc, factor: float) -> None:
    n, R = disc.lobe_count, disc.ring_pitch_radius
    r = factor * R * math.sin(math.pi / (n + 1))
    with pytest.raises(GeometryError, match="ring teeth overlap") as caught:
        CycloidDisc(n, R, 1e-6, r)
    message = str(caught.value)
    assert CycloidDisc(n, R, 1e-6, _numbers(message, "is above") / 2.0)
    assert CycloidDisc(n, _numbers(message, "ring_pitch_radius to"), 1e-6, r)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"lobe_count": 2}, "ratio 2 gives no disc"),
        ({"lobe_count": 10.5}, "ratio 10.5 gives no disc"),
        ({"lobe_count": math.nan}, "ratio nan gives no disc"),
        ({"eccentricity": 0.0}, "eccentricity is 0 mm; it must be above 0 mm"),
        ({"eccentricity": math.nan}, "eccentricity is nan mm"),
        ({"tooth_radius": -0.001}, "ring_pin_diameter is -2 mm"),
        ({"ring_pitch_radius": math.inf}, "ring_pitch_radius is inf mm"),
        ({"eccentricity": 0.0040}, "eccentricity 4 mm is above 2.79 mm"),
        ({"equidistant": -0.0036}, "takes away the whole tooth radius"),
        ({"equidistant": 0.0075}, "undercuts"),
        ({"radial": 0.031}, "leaves no disc at any eccentricity"),
        ({"radial": math.inf}, "modification.radial is inf mm"),
        ({"rotation": -1e-4}, "modification.rotation -0.343775 arcmin is outside 0 to"),
        ({"rotation": math.nan}, "modification.rotation nan arcmin"),
    ],
)
def test_every_impossible_disc_has_its_sentence(change: dict[str, Any], words: str) -> None:
    values: dict[str, Any] = {
        "lobe_count": 10,
        "ring_pitch_radius": 0.032,
        "eccentricity": 0.0016,
        "tooth_radius": 0.0035,
    }
    with pytest.raises(GeometryError, match=re.escape(words)):
        CycloidDisc(**{**values, **change})


def _paper(**pins: object) -> Design:
    return design_of(PAPER, output_pins={"count": 5, "diameter": 0.004, **pins})


def _validate(design: Design, bore: float = BORE) -> None:
    validate_geometry(design, bore_diameter=bore)


def test_the_paper_design_is_possible() -> None:
    _validate(_paper(circle_radius=0.0195))


@pytest.mark.parametrize("radius", [0.016, 0.026])
def test_holes_that_break_out_name_the_radii_that_do_not(radius: float) -> None:
    edge = "bore" if radius < 0.02 else "lobed profile"
    with pytest.raises(GeometryError, match=f"break out into the {edge}") as caught:
        _validate(_paper(circle_radius=radius))
    low, high = re.search(r"choose it from ([\d.]+) to ([\d.]+) mm", str(caught.value)).groups()
    for value in (float(low), float(high)):
        _validate(_paper(circle_radius=value * 1e-3))


def test_holes_that_meet_each_other() -> None:
    with pytest.raises(
        GeometryError, match=r"lets neighbouring holes of 7\.191 mm run into"
    ) as caught:
        _validate(_paper(circle_radius=0.0195, count=18))
    fewer = int(re.search(r"output_pins.count to (\d+)", str(caught.value)).group(1))
    wider = _numbers(str(caught.value), "circle_radius to")
    _validate(_paper(circle_radius=0.0195, count=fewer))
    _validate(_paper(circle_radius=wider, count=18))
    with pytest.raises(GeometryError):
        _validate(_paper(circle_radius=0.0195, count=fewer + 1))


def test_no_room_for_holes_at_all() -> None:
    with pytest.raises(GeometryError, match="no circle_radius is right between a bore of 44 mm"):
        _validate(_paper(circle_radius=0.0243), bore=0.044)
    with pytest.raises(GeometryError, match=r"cuts through the valleys.*below 53.7 mm"):
        _validate(_paper(circle_radius=0.0195), bore=0.062)
    with pytest.raises(GeometryError, match="leaves no output hole"):
        _validate(
            design_of(
                CycloidDisc(10, 0.032, 2e-5, 0.0035),
                ring_type="conjugate",
                output_pins={"sleeve_diameter": 1e-5, "hole_clearance": -1e-4},
            )
        )


@settings(max_examples=examples(150), deadline=None)
@given(
    st.integers(4, 119),
    st.floats(0.002, 1.0),
    st.floats(1e-5, 0.1),
    st.floats(1e-4, 0.5),
    st.floats(-5e-4, 5e-4),
    st.floats(-5e-4, 5e-4),
    st.floats(0.0, 0.017),
    st.sampled_from(["solid", "conjugate", "pinwheel"]),
    st.floats(1e-5, 5e-3),
    st.floats(0.005, 2.5),
    st.integers(3, 60),
    st.floats(0.001, 1.0),
    st.floats(0.001, 0.2),
)
def test_anything_the_design_file_allows_works_or_is_refused_as_geometry(
    ratio: int,
    pitch: float,
    throw: float,
    pin: float,
    equidistant: float,
    radial: float,
    rotation: float,
    kind: str,
    clearance: float,
    outer: float,
    count: int,
    circle: float,
    bore: float,
) -> None:
    """No other exception leaves the room, and what is not refused can be drawn and meshed."""
    try:
        design = Design.from_mapping(
            {
                "reducer": {
                    "ratio": ratio,
                    "ring_pitch_radius": pitch,
                    # Near the possible, or nothing but undercut would ever be seen.
                    "eccentricity": max(1e-5, min(throw, 1.2 * pitch / (ratio + 1))),
                    "ring_pin_diameter": max(1e-4, min(pin, 4.0 * pitch / (ratio + 1))),
                    "ring_type": kind,
                    "modification": {
                        "equidistant": equidistant * 0.1,
                        "radial": radial * 0.1,
                        "rotation": rotation * 0.1,
                    },
                    "ring": {"outer_diameter": outer, "relief_clearance": clearance},
                    "output_pins": {
                        "count": count,
                        "diameter": 0.002,
                        "circle_radius": min(circle, 0.7 * pitch) if pitch > 0.0015 else circle,
                    },
                }
            },
            si=True,
        )
    except DesignError:
        return
    try:
        validate_geometry(design, bore_diameter=bore)
    except GeometryError as error:
        refusal = str(error)
    else:
        refusal = ""
    if refusal:
        assert refusal.endswith(".")
        assert "nan" not in refusal
        return
    disc = CycloidDisc.from_design(design)
    part = disc_contour(design, 0, bore_diameter=bore, tolerance=1e-6)
    assert part.moments().area > 0.0
    assert ring_contour(design).moments().area > 0.0
    assert abs(joint_angles(lobed_outline(disc, 1e-6))).max() < 1e-6
    if equidistant >= 0.0 and radial >= 0.0:
        assert tooth_gaps(disc, 0.3).gap.min() > -1e-9
