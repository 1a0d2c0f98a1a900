"""A duty over time: the file, the load cases it becomes, and the heat of its cycle."""

import math
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.demands import demands, duty_heat
from cqdd_design.actuator.duty_points import duty_points
from cqdd_design.actuator.operating import judge
from cqdd_design.design import Design, load_design, load_requirements, save_design
from cqdd_design.design.duty_file import duty_template, read_columns, read_duty
from cqdd_design.design.duty_log import DutyColumns, DutyLog
from cqdd_design.design.duty_spectrum import load_cases
from cqdd_design.design.requirements import DutyPoint
from cqdd_design.errors import DesignError, UsageError
from cqdd_design.gearbox.heat.cycle import settled_cycle
from cqdd_design.gearbox.heat.network import Heat, ThermalNetwork
from cqdd_design.gearbox.life import life
from cqdd_design.machine import resolve
from cqdd_design.machine.duty_heat import DutyCase, logged_heat
from cqdd_design.machine.duty_heat import duty_heat as heat_of
from cqdd_design.machine.temperatures import heat_checks, machine_temperatures
from cqdd_design.report.judgement.duty import duty_text

PAPER = Path(__file__).parents[2] / "designs" / "cqdd-10.toml"
HEAD = "time [s],torque [N*m],speed [rad/s]"
EXPONENTS = (3.0, 10.0 / 3.0, 6.6, 9.0, 22.0)


def made(torque, speed, time=None) -> DutyLog:
    rows = len(torque)
    times = np.linspace(0.0, 1.0, rows) if time is None else np.asarray(time, dtype=float)
    return DutyLog("made", f"{hash(np.asarray(torque).tobytes())}", 2, times, torque, speed)


def written(tmp_path: Path, text: str, name: str = "knee.csv") -> Path:
    path = tmp_path / name
    path.write_text(text)
    return path


# The file ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "columns"),
    [
        (f"{HEAD}\n0,3,1.5707963267948966\n0.5,-4,0\n2,3,1\n", None),
        ("speed [deg/s];time [ms];what;torque [mN*m]\n90;0;x;3000\n0;500;;-4000\n"
         "57.29577951308232;2000;y;3000\n", None),
        ("# of a walk\n\ntau\tdq\tt [ms]\n3\t15\t0\n-4\t0\t500\n3\t9.549296585513721\t2000\n",
         DutyColumns("t [ms]", "tau [N*m]", "dq [rpm]")),
        ('t [s],"Torque, knee [N*m]",Speed [rad/s]\n0,3,1.5707963267948966\n0.5,-4,0\n2,3,1\n',
         DutyColumns(torque="Torque, knee")),
        ("\ufeffTIME [s],TAU [N*m],OMEGA [turn/s]\r\n0,3,0.25\r\n0.5,-4,0\r\n"
         "2,3,0.15915494309189535\r\n\r\n", None),
        ("time_ms,torque_Nm,speed_rpm,temperature_C\n0,3,15,20\n500,-4,0,20\n"
         "2000,3,9.549296585513721,20\n", None),
        ("time (s),torque (N*m),velocity (deg/s)\n0,3,90\n0.5,-4,0\n2,3,57.29577951308232\n",
         None),
        ("time (s),torque (knee) [N*m],speed [deg/s]\n0,3,90\n0.5,-4,0\n2,3,57.29577951308232\n",
         DutyColumns(torque="torque (knee)")),
    ],
)  # fmt: skip
def test_columns_of_any_name_order_and_unit_are_read(tmp_path, text, columns):
    log = read_duty(written(tmp_path, text), columns)
    assert log.time == pytest.approx([0.0, 0.5, 2.0])
    assert log.torque == pytest.approx([3.0, -4.0, 3.0])
    assert log.speed == pytest.approx([0.5 * math.pi, 0.0, 1.0])
    assert log.weights == pytest.approx([0.25, 1.0, 0.75])
    lines = text.splitlines()
    assert lines[log.line(1) - 1].strip().startswith(("0.5", "0;", "-4", "500"))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "is empty"),
        (f"{HEAD}\n", "has headings and no rows"),
        (f"{HEAD}\n0,1,2\n", "has one row; a duty needs two or more"),
        (f"{HEAD}\n0,1,2\n1,,2\n", "line 3: a gap, 'torque [N*m]' is empty"),
        (f"{HEAD}\n0,1,2\n\n1,1,2\n", "line 3 is empty"),
        (f"{HEAD}\n0,1,2\n1,1\n", "line 3 has 2 cells, and the headings 3: there is no 'speed"),
        (f"{HEAD}\n0,1,2\n1,nan,2\n", "line 3: column 'torque [N*m]' is nan"),
        (f"{HEAD}\n0,1,2\n1,1,-inf\n", "line 3: column 'speed [rad/s]' is -inf"),
        (f"{HEAD}\n0,1,2\n1,x1,2\n", "line 3: 'x1' in column 'torque [N*m]' is no number"),
        (f"{HEAD}\n0,1,2\n1,1,2\n0.5,1,2\n", "line 4: 0.5 in column 'time [s]' does not rise"),
        (f"{HEAD}\n0,1,2\n1,1,2\n1,3,2\n", "line 4: 1 in column 'time [s]' stands in the line be"),
        ("time [s],torque [mm],speed [rad/s]\n0,1,2\n", "'torque [mm]' must be a torque"),
        ("time [s],torque [J],speed [rad/s]\n0,1,2\n", "J is a unit of energy"),
        ("time [s],torque [N*m],speed [Hz]\n0,1,2\n", "Hz does not say turns or radians"),
        ("time,torque [N*m],speed [rad/s]\n0,1,2\n", "column 'time' has no unit"),
        ("time [s],force [N],speed [rad/s]\n0,1,2\n", "has no column named torque or tau"),
        ("time [s],torque [N*m],torque [N*m],speed [rpm]\n0,1,2\n", "2 columns for torque"),
        (f"{HEAD}\n0,1,2\n1,1e9,2\n", "line 3: column 'torque [N*m]' is 1000000000 N*m, more than"),
        (HEAD + "\n" + "".join(f"{k / 10 + 9 * (k > 15)},1,2\n" for k in range(40)),
         "line 18: a gap of 9.1 s in column 'time [s]', where rows are 0.1 s apart"),
        (f"{HEAD}\n0,0,0\n1,-0.0,0\n", "are 0 in every row, which is rest alone"),
        ("PK\x03\x04\0\0", "is not a text file"),
        (f"{HEAD},temp\n0,6,5,1,5,40\n1,7,5,2,5,41\n", "line 2 has 6 cells, and the headings 4"),
        (f"{HEAD}\n0,1,2\n1,1,2,7\n", "line 3 has 4 cells, and the headings 3; take the others"),
        (f"{HEAD}\n0,1_000,2\n1,1,2\n", "line 2: '1_000' in column 'torque [N*m]' is no number"),
        ("0,1,0.5\n1,1,2\n", "has no line of headings; put time [s],torque [N*m],speed [rad/s]"),
        ("t [ms],load [N*m],speed [rad/s]\n0,1,2\n", '--duty-columns "torque=load [N*m]"'),
        ("time [s],torque [N*m],tau [N*m],speed [rpm]\n0,1,2,3\n", '"torque=torque [N*m]"'),
        ("time [s],a,speed [rpm]\n0,1,2\n", '--duty-columns "torque=NAME [N*m]"'),
    ],
)  # fmt: skip
def test_what_is_no_duty_is_a_sentence_with_line_and_column(tmp_path, text, says):
    path = written(tmp_path, text)
    with pytest.raises(DesignError) as caught:
        read_duty(path)
    assert says in caught.value.message
    assert str(path) in caught.value.message
    assert "\n" not in caught.value.message


def test_rest_between_two_rows_of_rest_is_no_gap(tmp_path):
    work = "".join(f"{k / 10},{k % 3},2\n" for k in range(40))
    log = read_duty(written(tmp_path, f"{HEAD}\n{work}4,0,0\n64,0,0\n"))
    assert log.weights[-2:].sum() == pytest.approx(60.05)
    for ends in ("4,0,0\n64,0,1\n", "4,1,0\n64,0,0\n"):
        with pytest.raises(DesignError, match="a gap of 60 s"):
            read_duty(written(tmp_path, f"{HEAD}\n{work}{ends}"))
    # Another gap beside it is one.
    with pytest.raises(DesignError, match="line 45: a gap of 9 s"):
        read_duty(written(tmp_path, f"{HEAD}\n{work}4,0,0\n64,0,0\n64.1,1,2\n73.1,1,2\n"))


def test_an_empty_cell_at_the_end_of_lines_is_none(tmp_path):
    assert read_duty(written(tmp_path, f"{HEAD}\n0,1,2,\n1,1,2,\n")).rows == 2
    quoted = f'{HEAD},note\n0,1,2,"a, b"\n1,1,2,""\n'
    assert read_duty(written(tmp_path, quoted)).rows == 2


def test_a_torque_held_at_rest_is_a_duty_and_so_is_turning_without_one(tmp_path):
    for row in ("0,3,0", "0,0,2"):
        assert read_duty(written(tmp_path, f"{HEAD}\n{row}\n1,0,0\n")).rows == 2


def test_columns_that_are_not_there_and_units_said_twice(tmp_path):
    path = written(tmp_path, f"{HEAD}\n0,1,2\n1,1,2\n")
    with pytest.raises(DesignError, match=r"no column 'tork' for torque.*it has time"):
        read_duty(path, DutyColumns(torque="tork"))
    with pytest.raises(DesignError, match=r"says N\*m, and duty_columns says mN\*m"):
        read_duty(path, DutyColumns(torque="torque [mN*m]"))
    with pytest.raises(UsageError, match="there is no such file"):
        read_duty(tmp_path / "hip.csv")
    assert read_columns("speed=dq [rpm], time=t") == DutyColumns("t", "", "dq [rpm]")
    for wrong in ("tork=x", "time", "time=", "time=a,time=b", ""):
        with pytest.raises(UsageError, match="--duty-columns"):
            read_columns(wrong)


def test_corner_points_far_apart_are_no_gap(tmp_path):
    rows = "".join(f"{t},{k % 7},1\n" for k, t in enumerate(np.cumsum(1.0 + np.arange(40) % 9)))
    assert read_duty(written(tmp_path, f"{HEAD}\n{rows}")).rows == 40


def test_the_template_is_a_duty(tmp_path):
    log = read_duty(written(tmp_path, duty_template()))
    assert log.cycle_time == 1.0
    assert log.figures.torque_peak == 6.0
    assert log.figures.energy_returned > 0.0 < log.figures.energy_delivered


def test_many_rows_take_little_memory(tmp_path):
    path = tmp_path / "day.csv"
    block = "".join(f"%d.{k:02d},{k},{50 - k}\n" for k in range(100))
    with path.open("w") as stream:
        stream.write(HEAD + "\n")
        for second in range(2_500):
            stream.write(block.replace("%d", str(second)))
    resource = pytest.importorskip("resource")
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    log = read_duty(path)
    cases = load_cases(log)
    more = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    assert log.rows == 250_000
    assert len(cases) <= 64
    assert more < 75_000  # kB; the file has 3 MB, its numbers 6
    path.write_text(path.read_text().replace("2499.98,98", "2499.98,9x8"))
    with pytest.raises(DesignError, match="line 250000: '9x8' in column 'torque"):
        read_duty(path)


# Load cases --------------------------------------------------------------------------------------


def gait(rows, seed):
    """Torque and speed of a few harmonics, as joints have them."""
    random = np.random.default_rng(seed)
    phase = np.linspace(0.0, 2.0 * math.pi, rows)

    def signal():
        size, shift = random.normal(size=6) / np.arange(1, 7), random.uniform(0, 7, 6)
        return size @ np.sin(np.outer(np.arange(1, 7), phase) + shift[:, None])

    return made(20.0 * signal() + 10.0 * random.normal(), 5.0 * signal())


def sums(torque, speed, weight):
    way = weight * np.abs(speed)
    power = weight * torque * speed
    return {
        "mean square": float(weight @ torque**2),
        "delivered": float(np.maximum(power, 0.0).sum()),
        "returned": float(np.maximum(-power, 0.0).sum()),
        "way": float(way.sum()),
        **{f"damage {p:.3g}": float(way @ np.abs(torque) ** p) for p in EXPONENTS},
    }


LOGS = {
    **{f"gait {k}": gait(500, k) for k in range(12)},
    "long gait": gait(20_000, 20),
    "few rows": made(np.array([1.0, 5.0, -2.0]), np.array([1.0, -3.0, 2.0]), [0.0, 0.1, 4.0]),
    "even over all": made(*np.random.default_rng(3).uniform(-1.0, 1.0, (2, 5000))),
    "constant": made(np.full(9, 7.0), np.full(9, 2.0)),
}


@pytest.mark.parametrize("name", LOGS)
def test_load_cases_do_the_damage_of_the_log_or_up_to_one_per_cent_more(name):
    log = LOGS[name]
    cases = np.array(load_cases(log))
    assert len(cases) <= 64
    assert cases[:, 2].sum() <= 1.0 + 1e-12
    exact, found = sums(log.torque, log.speed, log.weights / log.cycle_time), sums(*cases.T)
    for key in ("delivered", "returned", "way"):
        assert found[key] == pytest.approx(exact[key], rel=1e-9, abs=1e-12), key
    for key in ("mean square", *(f"damage {p:.3g}" for p in EXPONENTS[:-1])):
        assert exact[key] * (1.0 - 1e-9) <= found[key] <= 1.01 * exact[key], key
    # Far beyond the slopes that are kept it is still never less.
    assert found["damage 22"] >= exact["damage 22"] * (1.0 - 1e-9)


def test_noise_of_every_sense_is_still_never_less():
    random = np.random.default_rng(5)
    log = made(20.0 * random.normal(size=20_000), random.normal(size=20_000))
    cases = np.array(load_cases(log))
    exact, found = sums(log.torque, log.speed, log.weights), sums(*cases.T)
    assert len(cases) <= 64
    assert all(found[key] >= exact[key] * (1.0 - 1e-9) for key in exact)
    assert found["mean square"] < 1.05 * exact["mean square"]


def test_time_at_rest_is_left_out_and_torque_at_rest_is_not():
    log = made(np.array([5.0, 5.0, 0.0, 0.0]), np.zeros(4), [0.0, 1.0, 1.001, 3.0])
    cases = load_cases(log)
    assert sum(case.share for case in cases if case.torque) == pytest.approx(1.0 / 3.0, abs=2e-3)
    assert all(case.torque > 0.0 for case in cases)


def test_figures_of_a_triangle():
    time = np.linspace(0.0, 2.0, 20_001)
    log = made(10.0 * np.minimum(time, 2.0 - time), np.where(time < 1.0, 3.0, -3.0), time)
    found = log.figures
    assert found.torque_rms == pytest.approx(10.0 / math.sqrt(3.0), rel=1e-6)
    assert (found.speed_rms, found.speed_mean, found.speed_peak) == pytest.approx((3.0, 3.0, 3.0))
    assert (found.torque_peak, found.torque_peak_at) == (10.0, 1.0)
    assert found.energy_delivered == pytest.approx(15.0, rel=1e-3)
    assert found.energy_returned == pytest.approx(15.0, rel=1e-3)


# Designs -----------------------------------------------------------------------------------------


def test_a_design_names_its_duty_from_its_own_folder(tmp_path):
    folder = tmp_path / "legs"
    folder.mkdir()
    written(folder, "t [ms],torque [N*m],dq [deg/s]\n0,5,90\n500,20,30\n900,-5,-60\n")
    design = load_design(PAPER).replacing(
        {
            "requirements.duty_file": "knee.csv",
            "requirements.duty_columns": {"speed": "dq"},
        }
    )
    save_design(folder / "leg.toml", design)
    again = load_design(folder / "leg.toml")
    log = again.requirements.duty_log
    assert log.cycle_time == pytest.approx(0.9)
    assert again.requirements.load_cases
    # What is changed keeps its duty, and the hash knows it.
    other = again.replacing({"requirements.life": "10 h"})
    assert other.requirements.duty_log == log
    assert other.sha256 != again.sha256
    written(folder, "t [ms],torque [N*m],dq [deg/s]\n0,5,90\n500,21,30\n900,-5,-60\n")
    assert load_design(folder / "leg.toml").sha256 != again.sha256
    asked = load_requirements(folder / "leg.toml")
    assert Path(asked.duty_file) == folder / "knee.csv"
    assert load_requirements(folder / "leg.toml", {"duty_file": str(folder / "knee.csv"),
        "duty_columns": {"speed": "dq"}}).duty_log is not None  # fmt: skip


def test_a_duty_that_has_not_been_read_is_never_forgotten():
    design = Design.from_mapping(
        load_design(PAPER).replacing({"requirements.duty_file": "knee.csv"}).to_mapping()
    )
    with pytest.raises(DesignError, match="has not been read"):
        _ = design.requirements.load_cases
    with pytest.raises(DesignError, match="duty and duty_file are both given"):
        design.replacing({"requirements.duty": [{"torque": 1.0, "speed": 1.0, "share": 1.0}]})
    with pytest.raises(DesignError, match="duty_columns belong to a duty_file"):
        load_design(PAPER).replacing({"requirements.duty_columns": {"time": "t"}})


@pytest.fixture(scope="module")
def design():
    return load_design(PAPER)


def test_life_under_a_log_is_that_of_its_steps(design):
    """Two loads in a log of straight steps, and the same two stated."""
    time = np.array([0.0, 3.0, 3.0 + 1e-9, 4.0])
    torque, speed = np.array([20.0, 20.0, -30.0, -30.0]), np.array([5.0, 5.0, 2.0, 2.0])
    logged = design.under_duty(made(torque, speed, time), "made")
    steps = [
        {"torque": "20 N*m", "speed": "5 rad/s", "share": 0.75},
        {"torque": "-30 N*m", "speed": "2 rad/s", "share": 0.25},
    ]
    stated = design.replacing({"requirements.duty": steps})
    found, exact = (life(one, resolve(one).contact) for one in (logged, stated))
    assert len(found.duty) == len(exact.duty) == 2
    assert not found.assumed
    for one, other in zip(found.parts, exact.parts, strict=True):
        if other.damage_per_hour:
            assert one.damage_per_hour == pytest.approx(other.damage_per_hour, rel=1e-6)
    assert found.cam.set_hours == pytest.approx(exact.cam.set_hours, rel=1e-6)


def test_heat_of_a_log_is_that_of_its_rows(design):
    log = gait(200, 4)
    machine = resolve(design.under_duty(log, "made"))
    n, share = design.reducer.ratio, log.weights / log.cycle_time
    rows = [DutyCase(*row) for row in zip(log.torque, n * log.speed, share, strict=True)]
    steps, heats, mean = logged_heat(machine, log)
    exact = heat_of(machine, rows)
    assert mean.heat.fixed == pytest.approx(exact.heat.fixed, rel=1e-9)
    assert mean.current_squared == pytest.approx(exact.current_squared, rel=1e-9)
    assert mean.gearbox == pytest.approx(exact.gearbox, rel=1e-9)
    assert steps.sum() == pytest.approx(log.cycle_time)
    assert steps @ heats.fixed / log.cycle_time == pytest.approx(mean.heat.fixed, rel=1e-9)


@pytest.mark.deep
def test_the_winding_of_a_slow_cycle_is_hotter_than_its_mean(design):
    def found(cycle):
        time = np.linspace(0.0, cycle, 400)
        push = time < 0.1 * cycle
        log = made(np.where(push, 35.0, 2.0), np.where(push, 4.0, 1.0), time)
        return machine_temperatures(resolve(design.under_duty(log, "made")))

    quick, slow = found(0.5), found(900.0)
    assert quick.steady == pytest.approx(slow.steady, rel=1e-6)
    assert quick.hottest("winding") == pytest.approx(quick.steady[0], abs=0.2)
    assert slow.hottest("winding") > slow.steady[0] + 20.0
    peak, when = slow.cycle.winding
    assert when == pytest.approx(90.0, abs=3.0)
    rise = heat_checks(slow)[0]
    assert rise.value == pytest.approx(peak)
    assert slow.to_dict()["heat"]["cycle"]["winding_peak_degC"] == pytest.approx(peak)


def test_a_cycle_settles_where_many_cycles_end():
    """Against the network's own history through cycle after cycle, copper growing with heat."""
    network = ThermalNetwork(
        names=("winding", "housing"),
        capacity=np.array([40.0, 900.0]),
        conductance=np.array([[0.0, 1.5], [1.5, 0.0]]),
        to_ambient=np.array([0.0, 0.8]),
        ambient=25.0,
    )
    steps = np.array([20.0, 60.0, 40.0])
    fixed = np.array([[80.0, 3.0], [0.0, 0.0], [15.0, 8.0]])
    slope = np.array([[0.25, 0.0], [0.0, 0.0], [0.04, 0.0]])
    most = np.array([200.0, np.inf])
    # Heat that follows the temperature is taken at the ends of steps, so they are made short.
    parts = 400
    found = settled_cycle(
        network, np.repeat(steps / parts, parts),
        Heat(np.repeat(fixed, parts, axis=0), np.repeat(slope, parts, axis=0), most),
    )  # fmt: skip
    now = np.full(2, 25.0)
    for _ in range(80):
        for k, step in enumerate(steps):
            heat = Heat(fixed[k], slope[k], most)
            times = step * np.arange(1, 21) / 20
            now = network.history(heat, times, now)[-1]
    assert found[-1] == pytest.approx(now, abs=0.05)
    first = network.history(Heat(fixed[0], slope[0], most), np.arange(1, 21), now)[-1]
    assert found[parts - 1] == pytest.approx(first, abs=0.05)
    assert found[:, 0].max() == pytest.approx(first[0], abs=0.05)


# Motor and driver --------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def parameters(design):
    return actuator_parameters(resolve(design))


def test_rows_are_judged_as_steps_are(design, parameters):
    log = gait(300, 8)
    log = made(3.0 * log.torque, 2.0 * log.speed, log.time)
    found = duty_points(parameters, log)
    single = [
        judge(parameters, (-1.0 if t * w < 0.0 else 1.0) * abs(t), abs(w), lasting=False, hot=True)
        for t, w in zip(log.torque, log.speed, strict=True)
    ]
    outside = [not one.inside for one in single]
    assert 0 < found.outside == sum(outside) < log.rows
    ends = np.diff(np.concatenate([[0], outside, [0]]))
    assert found.stretches == (ends == 1).sum()
    currents = np.array([one.need.current for one in single])
    powers = currents * np.array([one.need.voltage for one in single])
    assert found.current_rms == pytest.approx(math.sqrt(log.weights @ currents**2))
    assert found.energy_taken == pytest.approx(log.weights @ np.maximum(powers, 0.0))
    assert found.energy_fed_back == pytest.approx(log.weights @ np.maximum(-powers, 0.0))
    worst = found.named[0]
    row = worst.line - log.first_line
    assert (worst.torque, worst.speed) == (log.torque[row], log.speed[row])
    assert set(worst.binding) == set(single[row].binding)
    asked = design.under_duty(log, "made").requirements
    named = [one for one in demands(parameters, asked) if one.name.startswith("duty, line")]
    assert [one.name for one in named] == [f"duty, line {one.line}" for one in found.named]
    assert not any(one.found.inside for one in named)
    assert f"line {worst.line} (" in found.told
    assert duty_heat(parameters, asked).current == pytest.approx(found.current_rms)


def test_what_is_asked_of_a_duty_is_its_own_torque() -> None:
    design = load_design(PAPER)
    assert duty_text(design.requirements) == ""
    log = made(np.array([18.0, -18.0, 18.0]), np.array([1.0, -2.0, 1.0]))
    asked = design.under_duty(log, "made").requirements
    told = "18\u202fN\u00b7m at most and 18\u202fN\u00b7m r.m.s."
    assert duty_text(asked) == told
    # Half of the time at 12 N m, the rest is rest.
    steps = (DutyPoint(torque="-12 N*m", speed="1 rad/s", share=0.5),)
    stated = design.requirements.model_copy(update={"duty": steps})
    assert duty_text(stated) == "12\u202fN\u00b7m at most and 8.485\u202fN\u00b7m r.m.s."


def test_a_gentle_duty_is_inside_and_says_how_near(parameters):
    log = made(np.array([5.0, 6.0, 5.0]), np.array([1.0, 2.0, 1.0]))
    found = duty_points(parameters, log)
    assert (found.outside, found.stretches, found.share_outside) == (0, 0, 0.0)
    assert "all 3 rows are inside" in found.told
    assert found.to_dict()["outside"] == []
