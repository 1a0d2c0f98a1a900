"""Calibration of the actuator: known unknowns come back, and what tells nothing is refused."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.actuator.bench import METRICS, run_bench
from cqdd_design.actuator.bench.calibrate import calibrate, chosen
from cqdd_design.actuator.bench.calibration_file import read_calibration, write_calibration
from cqdd_design.actuator.bench.measured import read_measured
from cqdd_design.actuator.bench.unknowns import TELLS, UNKNOWNS, Fit, apply_factors
from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.fitted_under import FittedUnder
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.actuator.specimen import Specimen
from cqdd_design.design import load_design
from cqdd_design.errors import UsageError
from cqdd_design.machine import resolve

HEAD = '{"format": "cqdd-design calibration 1", '
PAPER = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"


@pytest.fixture(scope="module")
def actuator() -> ActuatorParameters:
    return actuator_parameters(resolve(load_design(PAPER)))


def rows_of(actuator: ActuatorParameters, names: list[str]) -> dict[str, float]:
    return {metric.name: metric.value for metric in run_bench(actuator, only=names).metrics}


def test_every_unknown_is_told_by_one_measurement() -> None:
    assert set(TELLS) <= set(METRICS)
    # The motor's viscous drag is none that one row tells; a bandwidth tells the rig, or on one
    # that is known the current loop.
    assert set(TELLS.values()) == set(UNKNOWNS) - {"motor_viscous", "current_loop"}
    bandwidth = {"torque_bandwidth": 34.3}
    assert chosen(bandwidth)[1] == ("rig_stiffness",)
    assert chosen(bandwidth, rig_known=True)[1] == ("current_loop",)
    with pytest.raises(UsageError, match="rig_stiffness is given"):
        chosen(bandwidth, unknowns=["rig_stiffness"], rig_known=True)


def test_unknowns_lie_in_ranges_of_this_motor(actuator: ActuatorParameters) -> None:
    """Values of the catalogue are inside; a range ends before the gearbox holds itself."""
    motor, friction = actuator.motor, actuator.friction
    ranges = {name: unknown.bounds(actuator) for name, unknown in UNKNOWNS.items()}
    for name, value in (
        ("motor_coulomb", motor.coulomb),
        ("motor_viscous", motor.viscous),
        ("motor_cogging", motor.cogging_amplitude),
    ):
        least, most = ranges[name]
        assert 0.0 < least < value < most
        assert UNKNOWNS[name].start(actuator) == value
    assert ranges["motor_coulomb"][1] == pytest.approx(0.1 * motor.rated_torque)
    # At the upper end drag takes a fifth of the rated torque at the speed of the supply.
    idle = actuator.drive.supply_voltage / motor.torque_constant
    assert ranges["motor_viscous"][1] * idle == pytest.approx(0.2 * motor.rated_torque)
    most = ranges["friction_load"][1]
    holding = friction.load_backward * (1.0 + friction.stribeck_extra)
    holding *= 1.0 + friction.load_growth
    assert most * holding == pytest.approx(0.9)
    # Above a knee it is the steeper friction that holds.
    steep = dataclasses.replace(friction, load_growth=1.0)
    within = UNKNOWNS["friction_load"].bounds(dataclasses.replace(actuator, friction=steep))[1]
    held = within * friction.load_backward * (1.0 + friction.stribeck_extra)
    assert held * 2.0 == pytest.approx(0.9)
    assert ranges["current_loop"] == (0.01, 100.0)
    least, most = ranges["rig_stiffness"]
    assert least < UNKNOWNS["rig_stiffness"].start(actuator) < actuator.sensor_stiffness < most
    # A sensor that twists 4 mrad at what it is rated for.
    assert actuator.sensor_stiffness * 4e-3 == pytest.approx(actuator.torque_limit)
    # A motor of which nothing is known begins within the range too.
    bare = dataclasses.replace(motor, coulomb=0.0, rated_torque=math.nan)
    unknown = dataclasses.replace(actuator, motor=bare)
    least, most = UNKNOWNS["motor_coulomb"].bounds(unknown)
    assert least < UNKNOWNS["motor_coulomb"].start(unknown) < most


@pytest.mark.deep
def test_calibration_finds_what_was_changed(actuator: ActuatorParameters) -> None:
    """Rows of an actuator with other drag and cooling bring these back from the first one."""
    true = {"motor_coulomb": 0.05, "thermal_resistance": 0.7, "friction_load": 0.6}
    other = apply_factors(actuator, true)
    told = [UNKNOWNS[name].told_by for name in true]
    rest = ["no_load_speed", "backdrive_static"]
    found = calibrate(actuator, rows_of(other, told + rest), to=told)
    assert found.largest_residual < 1e-3
    for name, factor in true.items():
        assert found.factors[name] == pytest.approx(factor, rel=0.03), name
    marked = {key for key, origin in found.parameters.origins.items() if "calibrated" in origin}
    assert marked == {value for name in true for value in UNKNOWNS[name].values}
    # Rows that were not fitted are predicted as the other actuator has them.
    assert [row.name for row in found.predicted] == rest
    assert {row.name for row in found.within} == set(rest)
    assert all(abs(row.off) < 0.02 for row in found.predicted if row.off is not None)
    relations = {row.name: row.relation for row in found.rows}
    assert [relations[name] for name in told] == ["calibrated"] * 3
    assert relations["peak_torque"] == "given"
    json.dumps(found.to_dict(), allow_nan=False)


@pytest.mark.deep
def test_a_bandwidth_tells_the_rig_it_was_measured_on(actuator: ActuatorParameters) -> None:
    """Of a rig of known stiffness; on a torque sensor's, coherence ends before it can be read."""
    wanted = run_bench(actuator, only=["torque_bandwidth"], rig_stiffness=1500.0)
    measured = {"torque_bandwidth": wanted.value("torque_bandwidth")}
    found = calibrate(actuator, measured, to=["torque_bandwidth"])
    assert found.factors["rig_stiffness"] == pytest.approx(1500.0, rel=0.02)
    assert found.parameters.origins["rig.stiffness"].startswith("calibrated: rig_stiffness")
    (row,) = [row for row in found.rows if row.name == "torque_bandwidth"]
    assert (row.relation, row.before) == ("calibrated", None)
    (metric,) = [one for one in found.after.metrics if one.name == "torque_bandwidth"]
    assert "(fitted)" in metric.protocol
    # It is no part of the actuator: nothing else on the bench moves.
    plain = run_bench(actuator, only=["backdrive_dynamic", "stall_torque"])
    again = run_bench(found.parameters, only=["backdrive_dynamic", "stall_torque"])
    assert [one.value for one in plain.metrics] == [one.value for one in again.metrics]


@pytest.mark.deep
def test_more_rows_than_unknowns_are_fitted_together(actuator: ActuatorParameters) -> None:
    other = apply_factors(actuator, {"motor_coulomb": 0.2})
    names = ["backdrive_static", "backdrive_dynamic"]
    measured = rows_of(other, names)
    found = calibrate(actuator, measured, to=names, unknowns=["motor_coulomb"])
    assert found.factors == pytest.approx({"motor_coulomb": 0.2}, rel=0.03)
    assert found.parameters.motor.coulomb == found.factors["motor_coulomb"]


@pytest.mark.deep
def test_scale_of_the_tolerances_is_found_for_a_drawn_gearbox() -> None:
    drawn = actuator_parameters(resolve(load_design(PAPER)), Specimen(seed=1))
    wanted = rows_of(apply_factors(drawn, {"tolerance_scale": 2.0}), ["torque_ripple"])
    found = calibrate(drawn, wanted)
    assert found.factors["tolerance_scale"] == pytest.approx(2.0, rel=0.03)


@pytest.mark.deep
def test_paper_on_two_rows(actuator: ActuatorParameters) -> None:
    """What the documents state of the paper's actuator: cooling and cogging fitted, no more."""
    from cqdd_design.catalog.paper import METRICS as TABLE
    from cqdd_design.roads.calibrate import PAPER_ROWS

    measured = {name: figure.value for name, figure in TABLE.items()}
    found = calibrate(actuator, measured, to=PAPER_ROWS)
    assert found.largest_residual < 1e-3
    within = {row.name for row in found.within}
    assert within == {"no_load_speed", "actuator_inertia", "mass", "backdrive_dynamic"}


@pytest.mark.parametrize(
    ("measured", "options", "says"),
    [
        ({"mass": 1.4}, {"to": ["mass"]}, "decides no unknown"),
        ({"mass": 1.4}, {}, "nothing to calibrate"),
        ({}, {}, "nothing to calibrate"),
        ({"backdrive_static": math.nan}, {}, "above 0"),
        ({"backdrive_static": -1.0}, {}, "above 0"),
        ({"backdrive_statc": 1.0}, {}, "did you mean 'backdrive_static'"),
        ({"backdrive_static": 1.0}, {"to": ["efficiency_peak"]}, "no measured value"),
        (
            {"backdrive_static": 1.0},
            {"unknowns": ["motor_coulomb", "friction_load"]},
            "cannot decide 2 unknowns",
        ),
        ({"backdrive_static": 1.0}, {"unknowns": ["friction"]}, "is no unknown"),
        ({"torque_ripple": 1.0}, {}, "draw a gearbox with --seed"),
        pytest.param(
            *({"efficiency_peak": 0.999}, {}, "no friction_load from 0.1 to"),
            marks=pytest.mark.deep,
        ),
    ],
)
def test_calibration_refuses_what_tells_nothing(
    actuator: ActuatorParameters, measured: dict[str, float], options: dict[str, object], says: str
) -> None:
    if says.startswith("draw"):
        zero = np.zeros_like(actuator.gear.error_cosine)
        gear = dataclasses.replace(actuator.gear, error_cosine=zero, error_sine=zero)
        actuator = dataclasses.replace(actuator, gear=gear)
    with pytest.raises(UsageError, match=says):
        calibrate(actuator, measured, **options)  # type: ignore[arg-type]


def test_what_was_fitted_predicts_nothing(actuator: ActuatorParameters) -> None:
    rows = ["backdrive_static", "backdrive_dynamic", "output_resolution"]

    def relations(factors: Mapping[str, float]) -> list[str]:
        found = run_bench(apply_factors(actuator, factors), only=rows)
        return [metric.relation for metric in found.metrics]

    assert relations({}) == ["given", "predicted", "predicted"]
    assert relations({"motor_cogging": 0.03}) == ["given", "calibrated", "predicted"]
    fit = Fit({"motor_cogging": 0.03}, ("backdrive_dynamic",))
    assert relations(fit) == ["given", "predicted", "calibrated"]


HERE = FittedUnder(24.0, 25.0)


@pytest.mark.parametrize(
    ("row", "under", "says"),
    [
        ("no_load_speed", HERE, ""),
        ("no_load_speed", HERE._replace(voltage=30.0), "fitted at 30 V, measured here at 24 V"),
        ("backdrive_static", HERE._replace(voltage=30.0), ""),
        ("backdrive_static", HERE._replace(seed=3), "fitted to the gearbox of seed 3"),
        ("no_load_speed", HERE._replace(seed=3), ""),
        ("no_load_speed", HERE._replace(ambient=40.0), "fitted in air of 40 degC, here 25 degC"),
        ("no_load_speed", HERE._replace(rig_stiffness=8e3), ""),
        ("no_load_speed", HERE._replace(other="another design (x)"), "another design (x)"),
    ],
)
def test_rows_fitted_under_other_conditions_are_not_comparable(
    actuator: ActuatorParameters, row: str, under: FittedUnder, says: str
) -> None:
    fitted = apply_factors(actuator, Fit({"motor_cogging": 0.03}, (row,), under))
    (found,) = run_bench(fitted, only=[row]).metrics
    assert found.relation == ("not comparable" if says else "calibrated")
    assert says in found.remark


def test_the_papers_values_are_of_its_own_supply(actuator: ActuatorParameters) -> None:
    for voltage, relation in ((24.0, "predicted"), (30.0, "not comparable")):
        (speed,) = run_bench(
            actuator, only=["no_load_speed"], voltage=voltage, beside_paper=True
        ).metrics
        assert speed.relation == relation
    (alone,) = run_bench(actuator, only=["no_load_speed"], voltage=30.0).metrics
    assert alone.relation == "predicted"


def test_a_rig_of_its_own_matters_to_the_torque_bandwidth() -> None:
    on_rig = HERE._replace(rig_stiffness=8e3)
    assert (
        on_rig.differs("torque_bandwidth", HERE) == "fitted on a rig of 8000 N*m/rad, here a "
        "torque sensor"
    )
    assert not on_rig.differs("torque_bandwidth", on_rig)


# ------------------------------------------------------------------ files


def test_a_file_holds_what_it_was_measured_under(tmp_path: Path) -> None:
    path, rest = (
        tmp_path / "c.json",
        '"unknowns": {"motor_cogging": {"value": 0.03, "unit": "N*m"}}',
    )
    held = {"voltage_V": 30.0, "ambient_degC": 40.0, "rig_stiffness_Nm_per_rad": None,
            "gearbox_seed": 2}  # fmt: skip
    path.write_text(
        HEAD + f'"design_sha256": "abc", "measured_under": {json.dumps(held)}, {rest}}}'
    )
    fit, warning = read_calibration(path, "abc")
    assert fit.under == FittedUnder(30.0, 40.0, None, 2)
    assert fit.under.to_dict() == held
    assert not warning
    fit, warning = read_calibration(path, "def")
    assert "another design" in warning
    assert "another design" in fit.under.differs("mass", FittedUnder(30.0, 40.0, None, 2))
    # As earlier versions wrote it.
    path.write_text(HEAD + f'"design_sha256": "abc", {rest}}}')
    fit, warning = read_calibration(path, "abc")
    assert fit.under is None
    assert "does not say at which supply" in warning


@pytest.mark.deep
def test_file_brings_the_factors_back(actuator: ActuatorParameters, tmp_path: Path) -> None:
    wanted = rows_of(apply_factors(actuator, {"motor_cogging": 0.02}), ["backdrive_static"])
    found = calibrate(actuator, wanted)
    path = tmp_path / "c.json"
    write_calibration(found, "abc", path)
    read, warning = read_calibration(path, "abc")
    assert dict(read) == pytest.approx(dict(found.factors))
    assert (read.rows, warning) == (("backdrive_static",), "")
    assert read.under == FittedUnder(24.0, actuator.thermal.ambient)
    assert "another design" in read_calibration(path, "def")[1]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "is not JSON"),
        ("[1]", "is not a calibration"),
        ('{"format": "cqdd-design calibration 1"}', "is not a calibration"),
        (
            HEAD + '"unknowns": {"friction_lod": {"factor": 1}}}',
            "did you mean 'friction_load'",
        ),
        (
            # Of an earlier state: a factor on all friction.
            HEAD + '"unknowns": {"friction_level": {"factor": 27}}}',
            "'friction_level' is no unknown",
        ),
        (
            HEAD + '"unknowns": {"motor_coulomb": {"factor": 1}}}',
            "the value of motor_coulomb must be a number above 0",
        ),
        (
            HEAD + '"unknowns": {"motor_coulomb": {"value": 100, "unit": "mN m"}}}',
            r"it must be 'N\*m'",
        ),
        (
            HEAD + '"unknowns": {"friction_load": {"factor": 0}}}',
            "a number above 0",
        ),
        (
            HEAD + '"unknowns": {"friction_load": {"factor": 1' + 400 * "0" + "}}}",
            "no value here is that large",
        ),
        (
            HEAD + '"unknowns": {"friction_load": {"factor": 2}}, "rows": []}',
            "no table of measurements",
        ),
        (
            HEAD + '"measured_under": {"voltage_V": "24 V"}, "unknowns": {"friction_load": '
            '{"factor": 2}}}',
            "measured_under must have voltage_V",
        ),
        (
            HEAD + '"unknowns": {"friction_load": 2}}',
            "a number above 0",
        ),
    ],
)
def test_bad_calibration_files(tmp_path: Path, text: str, says: str) -> None:
    path = tmp_path / "c.json"
    path.write_text(text)
    with pytest.raises(UsageError, match=says):
        read_calibration(path, "abc")


def test_measured_rows_come_in_the_units_of_the_bench(tmp_path: Path) -> None:
    path = tmp_path / "m.csv"
    path.write_text(
        "# our rig, 2026\nname,value,unit,spread\nbackdrive_static,1990,mN*m,0.1\n"
        "efficiency_peak,82.3,%,\nno_load_speed,13.467,rad/s,\nactuator_inertia,5010,g*cm^2,\n"
        "mass,1400,g,\nbacklash,0.117,deg,0.01\ntorque_bandwidth,34.3,Hz,\n\n"
        "rated_power,0.96,kW,\ntorque_density,64.2,N*m/kg,\n",
        encoding="utf-8-sig",
    )
    assert read_measured(path) == pytest.approx(
        {
            "backdrive_static": 1.99,
            "efficiency_peak": 0.823,
            "no_load_speed": 13.467 * 30.0 / math.pi,
            "actuator_inertia": 5.01e-4,
            "mass": 1.4,
            "backlash": 7.02,
            "torque_bandwidth": 34.3,
            "rated_power": 960.0,
            "torque_density": 64.2,
        }
    )


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "is empty"),
        ("name,value,unit", "no rows"),
        ("name,value\nmass,1", "has no column unit"),
        ("name;value;unit\nmass;1;kg", "has no column name, value, unit"),
        ("name,value,unit\nmass,,kg", "line 2: mass has no value"),
        ("name,value,unit\nmass,nan,kg", "finite number above 0"),
        ("name,value,unit\nmass,-1,kg", "finite number above 0"),
        ("name,value,unit\nmass,1 kg,kg", "the unit has its own column"),
        ("name,value,unit\nmass,1", "2 cells where the head has 3"),
        ("name,value,unit\nmas,1,kg", "did you mean 'mass'"),
        ("name,value,unit\nmass,1,N", "'N' is not a unit of mass"),
        ("name,value,unit\nmass,1,", "has no unit; write it in kg"),
        ("name,value,unit\ntorque_bandwidth,200,rad/s", "a rate is in Hz"),
        ("name,value,unit\nbackdrive_static,2,J", "write a torque as N"),
        ("name,value,unit\nefficiency_peak,82,W", "is empty or %"),
        ("name,value,unit\nmass,1,kg\n\nmass,2,kg", "line 4: mass stands there twice"),
    ],
)
def test_bad_measured_files(tmp_path: Path, text: str, says: str) -> None:
    path = tmp_path / "m.csv"
    path.write_text(text)
    with pytest.raises(UsageError, match=says):
        read_measured(path)


def test_missing_measured_file(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="cannot read"):
        read_measured(tmp_path / "none.csv")
    (tmp_path / "b.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(UsageError, match="UTF-8"):
        read_measured(tmp_path / "b.csv")
