"""Whatever a design file says, only the package's own errors leave the library."""

from __future__ import annotations

from pathlib import Path

import pytest
from contact_designs import contact_designs
from examples import examples
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from cqdd_design.catalog import bearings, materials, motors
from cqdd_design.design import Design, load_design
from cqdd_design.errors import CqddError
from cqdd_design.gearbox import GearboxAnalysis
from cqdd_design.library.envelope import json_ready
from cqdd_design.machine import resolve
from cqdd_design.sizing.comparison import cycloid_limits

BARE = sorted(name for name, row in motors().items() if row.torque_at == "motor")
PAPER = (Path(__file__).parents[2] / "designs" / "cqdd-10.toml").read_text(encoding="utf-8")


def lengths(low: float, high: float) -> st.SearchStrategy[str]:
    return st.floats(low, high).map(lambda value: f"{value:.6g} mm")


def mostly(sane: st.SearchStrategy[str], wild: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    """Of five draws one from anywhere: alone, wild values would leave nothing to analyse."""
    return st.one_of(sane, sane, sane, sane, wild)


def micrometres(low: int, high: int) -> st.SearchStrategy[str]:
    return st.integers(low, high).map(lambda value: f"{value} um")


@st.composite
def designs(draw: st.DrawFn) -> dict[str, object]:
    """Mappings whose values are legal one by one, though some of them make no gearbox."""
    radius = draw(st.floats(10.0, 150.0))
    ratio = draw(st.one_of(st.integers(4, 30), st.integers(4, 119)))
    pitch = radius / (ratio + 1)
    pin = draw(st.floats(0.5, 0.25 * radius))
    pins = {
        "count": draw(st.integers(3, 24)),
        "diameter": f"{pin:.6g} mm",
        "circle_radius": draw(
            mostly(lengths(0.5 * radius, 0.7 * radius), lengths(1.0, 1.2 * radius))
        ),
        "sleeve_diameter": draw(mostly(st.just("0 mm"), lengths(0.8 * pin, 3.0 * pin))),
        "sleeve": draw(mostly(st.just("plain"), st.just("needle"))),
        "sleeve_play": draw(micrometres(0, 100)),
        "hole_clearance": draw(mostly(micrometres(0, 60), micrometres(-100, 1000))),
        "support": draw(st.sampled_from(["both", "cantilever"])),
        "material": draw(st.sampled_from(sorted(materials()))),
    }
    carrier = {"joint": draw(mostly(st.just("clamped"), st.sampled_from(["hinged", "columns"])))}
    if carrier["joint"] == "columns":
        carrier["column_diameter"] = draw(
            mostly(lengths(0.1 * radius, 0.2 * radius), lengths(1.0, radius))
        )
    modification = {
        "equidistant": draw(mostly(micrometres(0, 30), micrometres(-500, 500))),
        "radial": draw(mostly(micrometres(0, 30), micrometres(-500, 500))),
        "rotation": draw(
            mostly(
                st.just("0 arcmin"),
                st.floats(0.0, 60.0).map(lambda value: f"{value:.4g} arcmin"),
            )
        ),
    }
    tooth = draw(mostly(lengths(pitch, 3.0 * pitch), lengths(0.1, 8.0 * pitch)))
    kind = draw(st.sampled_from(["solid", "conjugate", "pinwheel"]))
    size = float(tooth.split()[0])
    rollers = {
        "roller_diameter": draw(lengths(0.9 * size, 2.0 * size)),
        "roller": draw(st.sampled_from(["plain", "needle"])),
    }
    reducer = {
        "ratio": ratio,
        "ring_pitch_radius": f"{radius:.6g} mm",
        "eccentricity": draw(mostly(lengths(0.3 * pitch, 0.8 * pitch), lengths(0.01, 1.3 * pitch))),
        "ring_pin_diameter": tooth,
        "ring_type": kind,
        "disc_count": draw(st.integers(1, 3)),
        "disc_thickness": draw(lengths(0.5, 50.0)),
        "disc_material": draw(st.sampled_from(sorted(materials()))),
        "ring_material": draw(st.sampled_from(sorted(materials()))),
        "modification": modification,
        "output_pins": pins,
        "carrier": carrier,
        "cam_bearing": {
            "designation": draw(mostly(st.just("auto"), st.sampled_from(sorted(bearings()))))
        },
        "ring": {
            "outer_diameter": draw(
                mostly(lengths(2.3 * radius, 3.0 * radius), lengths(5.0, 3.0 * radius))
            ),
            **(rollers if kind == "pinwheel" and draw(st.booleans()) else {}),
        },
    }
    peak = draw(st.floats(0.01, 2000.0))
    requirements = {
        "peak_torque": f"{peak:.6g} N*m",
        "continuous_torque": f"{peak * draw(st.floats(0.01, 0.99)):.6g} N*m",
        "input_speed": draw(st.floats(1.0, 30000.0).map(lambda value: f"{value:.6g} rpm")),
    }
    motor = {"name": draw(mostly(st.sampled_from(BARE), st.sampled_from(sorted(motors()))))}
    return {"requirements": requirements, "reducer": reducer, "motor": motor}


@settings(max_examples=examples(150), deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(designs())
def test_a_random_design_is_analysed_or_refused(mapping: dict[str, object]) -> None:
    outcome = analysed(mapping)
    if isinstance(outcome, CqddError):
        assert outcome.message.rstrip().endswith((".", "?"))
        assert len(outcome.message) > 20
        return
    told: list[str] = []
    json_ready(outcome.to_dict(), "results", told)
    assert told == [], "numbers of an analysis are finite"
    assert outcome.checks


@pytest.mark.deep
@settings(max_examples=6, deadline=None, suppress_health_check=list(HealthCheck))
@given(contact_designs(most_lobes=12))
def test_limits_of_a_design_that_exists_are_found_or_refused(design: Design) -> None:
    try:
        limits = cycloid_limits(resolve(design))
    except CqddError:
        return
    assert limits
    assert all(limit.torque_capacity >= 0.0 for limit in limits)


def analysed(mapping: dict[str, object]) -> GearboxAnalysis | CqddError:
    try:
        machine = resolve(Design.from_mapping(mapping))
        analysis = machine.analyse(angles=8)
    except CqddError as error:
        return error
    return analysis


def test_teeth_that_only_a_grown_disc_would_clear() -> None:
    """A negative offset keeps the disc from undercut, but the ring's teeth are as large as ever."""
    reducer = {
        "ratio": 118,
        "ring_pitch_radius": "51.1368 mm",
        "eccentricity": "0.387922 mm",
        "ring_pin_diameter": "1.89423 mm",
        "modification": {"equidistant": "-267 um", "radial": "-30 um"},
        "output_pins": {"circle_radius": "30 mm"},
        "cam_bearing": {"designation": "6005"},
    }
    assert isinstance(analysed({"reducer": reducer}), CqddError)


@settings(max_examples=examples(150), deadline=None, suppress_health_check=list(HealthCheck))
@given(st.text(max_size=200))
@example("[reducer]\nratio = 10")
@example("a = [[[[[")
def test_random_text_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "random.toml"
    path.write_text(text, encoding="utf-8", errors="replace")
    with pytest.raises(CqddError):
        load_design(path)


@settings(max_examples=examples(200), deadline=None, suppress_health_check=list(HealthCheck))
@given(st.data())
def test_a_damaged_design_file_is_read_or_refused(tmp_path: Path, data: st.DataObject) -> None:
    """A piece of the paper's design file replaced by something else."""
    start = data.draw(st.integers(0, len(PAPER) - 1))
    length = data.draw(st.integers(0, 30))
    junk = data.draw(st.one_of(st.text(max_size=12), st.sampled_from(['"', "[", "= 1", "nan"])))
    path = tmp_path / "damaged.toml"
    path.write_text(PAPER[:start] + junk + PAPER[start + length :], "utf-8", "replace")
    refusal = ""
    try:
        load_design(path)
    except CqddError as error:
        refusal = error.message
    assert refusal == "" or "damaged.toml" in refusal
