"""Logs: what a file says comes back in SI at one rate, and every wrong one is refused by name."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from cqdd_design.errors import UsageError
from cqdd_design.torque.data.log_checks import check_signals, velocity_factor
from cqdd_design.torque.data.log_files import LogMap, read_columns, read_map
from cqdd_design.torque.data.logs import import_logs
from cqdd_design.torque.data.splits import audit, split
from cqdd_design.torque.networks.modules import MODELS

NAMES = {"time": "t", "position": "q", "target": "q_des", "velocity": "dq", "torque": "tau"}
SI = LogMap(NAMES)
GAINS = {"position_gain": 60.0, "velocity_gain": 2.0}


def motion(seconds=3.0, rate=1000.0, frequency=0.8, phase=0.0):
    """A joint that follows a sine a little late, and the torque of its gains."""
    t = np.arange(round(seconds * rate)) / rate
    w = 2.0 * math.pi * frequency
    q, dq = np.sin(w * t + phase), w * np.cos(w * t + phase)
    target = q + 0.2 * np.sin(w * t + phase + 1.0)
    return {"t": t, "q": q, "q_des": target, "dq": dq, "tau": 60.0 * (target - q) - 2.0 * dq}


def write(path, columns, delimiter=","):
    rows = np.column_stack(list(columns.values()))
    lines = [delimiter.join(columns)] + [delimiter.join(f"{v:.12g}" for v in row) for row in rows]
    path.write_text("\n".join(lines) + "\n", "utf-8")
    return path


def imported(path, mapped=SI, **options):
    data, tally = import_logs([path], mapped, **{**GAINS, **options})
    return SimpleNamespace(data=data, **vars(tally))


# What is right ----------------------------------------------------------------------------------


@pytest.mark.parametrize(("suffix", "delimiter"), [("csv", ","), ("csv", ";"), ("tsv", "\t")])
def test_a_log_comes_back_at_200_hz_delayed_alike(tmp_path, suffix, delimiter):
    truth = motion()
    found = imported(write(tmp_path / f"run.{suffix}", truth, delimiter))
    (one,) = found.data.episodes
    assert found.data.dt == pytest.approx(0.005)
    assert len(one) == 600
    assert one.group["log"] == "run"
    assert not found.warnings
    delay = found.data.facts["filter_delay_s"]
    late = one.time[50:] - delay
    for column, name in (("position", "q"), ("target", "q_des"), ("torque", "tau")):
        expected = np.interp(late, truth["t"], truth[name])
        scale = np.abs(truth[name]).max()
        np.testing.assert_allclose(one.columns[column][50:], expected, atol=0.01 * scale)
    assert found.data.torque_range[1] == pytest.approx(np.abs(one.columns["torque"]).max())


def test_parquet_is_read_as_csv_is(tmp_path):
    pyarrow = pytest.importorskip("pyarrow")
    from pyarrow import parquet

    truth = motion()
    parquet.write_table(pyarrow.table(truth), tmp_path / "run.parquet")
    one = imported(tmp_path / "run.parquet").data.episodes[0]
    other = imported(write(tmp_path / "run.csv", truth)).data.episodes[0]
    np.testing.assert_allclose(one.columns["torque"], other.columns["torque"], atol=1e-8)


def test_a_log_at_the_rate_wanted_is_left_as_it_is(tmp_path):
    truth = motion(rate=200.0)
    found = imported(write(tmp_path / "run.csv", truth))
    np.testing.assert_allclose(found.data.episodes[0].columns["torque"], truth["tau"], atol=1e-9)
    assert found.data.facts["filtered_logs"] == []


def test_what_lies_above_half_the_rate_does_not_fold_down(tmp_path):
    truth = motion()
    noise = 20.0 * np.sin(2.0 * math.pi * 480.0 * truth["t"])  # would fold to 80 Hz
    clean = imported(write(tmp_path / "a.csv", truth)).data.episodes[0].columns["torque"]
    dirty = imported(write(tmp_path / "b.csv", {**truth, "tau": truth["tau"] + noise}))
    # The analogue filter lets 1/(1 + 6^2) of it through, the digital one less.
    assert np.abs(dirty.data.episodes[0].columns["torque"] - clean).max() < 20.0 / 37.0


def test_units_and_an_offset_in_time_change_nothing(tmp_path):
    truth = motion()
    plain = imported(write(tmp_path / "a.csv", truth)).data.episodes[0]
    turned = {
        "t": 1e3 * truth["t"] + 5e5,
        "q": np.degrees(truth["q"]),
        "q_des": np.degrees(truth["q_des"]),
        "dq": truth["dq"] * 30.0 / math.pi,
        "tau": 1e3 * truth["tau"],
    }
    units = {
        "time": "ms",
        "position": "deg",
        "target": "deg",
        "velocity": "rpm",
        "torque": "mN*m",
    }
    other = imported(write(tmp_path / "b.csv", turned), LogMap(NAMES, units)).data.episodes[0]
    for name in ("position", "velocity", "torque"):
        np.testing.assert_allclose(other.columns[name], plain.columns[name], atol=1e-6)


def test_current_times_a_constant_is_the_torque(tmp_path):
    truth = motion()
    current = {**{k: v for k, v in truth.items() if k != "tau"}, "i": truth["tau"] / -1.7}
    names = {k: v for k, v in NAMES.items() if k != "torque"} | {"current": "i"}
    found = imported(write(tmp_path / "a.csv", current), LogMap(names, current_to_torque=-1.7))
    plain = imported(write(tmp_path / "b.csv", truth)).data.episodes[0]
    one = found.data.episodes[0]
    np.testing.assert_allclose(one.columns["torque"], plain.columns["torque"], atol=1e-6)
    assert "current" in one.columns
    assert found.data.facts["torque_from"] == "current"


def test_a_sample_time_stands_in_for_a_time_column(tmp_path):
    truth = motion()
    names = {k: v for k, v in NAMES.items() if k != "time"}
    found = imported(write(tmp_path / "a.csv", truth), LogMap(names), dt=0.001)
    assert len(found.data.episodes[0]) == 600
    with pytest.raises(UsageError, match="--dt"):
        imported(tmp_path / "a.csv", LogMap(names))


def test_jitter_of_the_samples_is_taken_out(tmp_path):
    truth = motion()
    t = truth["t"] + np.random.default_rng(0).uniform(-2e-4, 2e-4, len(truth["t"]))
    w = 2.0 * math.pi * 0.8
    q, dq = np.sin(w * t), w * np.cos(w * t)
    shaken = {"t": t, "q": q, "q_des": q, "dq": dq, "tau": 10.0 * q}
    one = imported(write(tmp_path / "a.csv", shaken)).data.episodes[0]
    late = one.time[50:] + t[0] - 0.08 / 20.0 * 0.994718
    np.testing.assert_allclose(one.columns["position"][50:], np.sin(w * late), atol=1e-3)


def test_missing_time_splits_the_record_and_short_pieces_are_counted(tmp_path):
    truth = motion(6.0)
    keep = np.ones(6000, bool)
    keep[2000:2300] = False  # a gap
    keep[2400:2500] = False  # leaves 0.1 s between
    keep[4000:4001] = False  # one sample: no gap
    found = imported(write(tmp_path / "a.csv", {k: v[keep] for k, v in truth.items()}))
    assert [len(one) for one in found.data.episodes] == [400, 700]
    assert [round(gap.begin, 3) for gap in found.gaps] == [1.999, 2.399]
    assert found.gaps[0].seconds == pytest.approx(0.301)
    assert found.dropped == 1
    assert [one.group["first"] for one in found.data.episodes] == [0, 500]
    assert {one.group["record"] for one in found.data.episodes} == {"a"}
    assert found.data.facts["dropped_pieces"] == 1


def test_cut_records_split_without_a_leak(tmp_path):
    found = imported(write(tmp_path / "a.csv", motion(22.0, frequency=0.7713)), cut=2.0)
    data = found.data
    assert [len(one) for one in data.episodes] == [400] * 8 + [400]
    chosen = split(data, "trajectory", 0)
    audit(data, chosen, 30)
    with pytest.raises(UsageError, match="samples apart"):
        audit(data, chosen, 150)
    whole = imported(tmp_path / "a.csv").data
    with pytest.raises(UsageError, match="too few"):
        split(whole, "trajectory", 0)


def test_no_window_of_any_network_reaches_over_a_cut_at_a_low_rate(tmp_path):
    history = max(model.history for model in MODELS.values())
    truth = motion(60.0, rate=100.0, frequency=0.7713)
    data = imported(write(tmp_path / "a.csv", truth), cut=4.0, rate=20.0).data
    assert len(data.episodes) > 8
    audit(data, split(data, "trajectory", 0), history)


def test_a_motion_that_repeats_itself_is_no_matter_for_cutting(tmp_path):
    """Pieces of 2 s every 2.5 s of a noiseless sine of 0.8 Hz are copies of each other."""
    data = imported(write(tmp_path / "a.csv", motion(22.0)), cut=2.0).data
    with pytest.raises(UsageError, match=r"leak: .* share \d+ readings"):
        audit(data, split(data, "trajectory", 0), 30)


def test_flags_hold_wherever_they_were_up(tmp_path):
    truth = motion()
    touching = np.zeros(3000)
    touching[1502] = 1.0
    path = write(tmp_path / "a.csv", {**truth, "touch": touching})
    one = imported(path, LogMap({**NAMES, "wall": "touch"})).data.episodes[0]
    assert np.flatnonzero(one.flag("wall")).tolist() == [301]
    slow = {name: values[::5] for name, values in truth.items()}
    slow["touch"] = (np.arange(600) == 100).astype(float)
    path = write(tmp_path / "b.csv", slow)
    one = imported(path, LogMap({**NAMES, "wall": "touch"})).data.episodes[0]
    assert np.flatnonzero(one.flag("wall")).tolist() == [100]


def test_groups_and_facts_of_the_map_file_reach_the_splits(tmp_path):
    lines = ["[columns]"] + [f'{k} = "{v}"' for k, v in NAMES.items()]
    lines += ["[group]", "wall = 0", "[facts]", "held_mass_kg = 1.71"]
    paths = []
    for i in range(6):
        paths.append(write(tmp_path / f"run {i}.csv", motion(1.0, phase=0.3 * i)))
        lines += [f'[groups."run {i}"]', f"mass = {1.71 if i == 0 else 1.14}"]
    (tmp_path / "map.toml").write_text("\n".join(lines), "utf-8")
    data, _ = import_logs(paths, read_map(tmp_path / "map.toml"), **GAINS)
    assert [one.name for one in data.episodes] == [f"run-{i}-000" for i in range(6)]
    chosen = split(data, "mass", 0)
    audit(data, chosen, 30)
    assert chosen.test == ("run-0-000",)


# What is wrong ----------------------------------------------------------------------------------


def spoiled(**changes):
    return {**motion(), **changes}


@pytest.mark.parametrize(
    ("columns", "told"),
    [
        (spoiled(q=np.degrees(motion()["q"])), r"position reaches 57.* --units position=deg"),
        (spoiled(dq=np.degrees(motion()["dq"])), r"57\.\d+ times .*velocity=deg/s"),
        (spoiled(dq=motion()["dq"] * 30.0 / math.pi), r"9\.5\d+ times .*velocity=rpm"),
        (spoiled(dq=-motion()["dq"]), r"-1(\.0*)? times .*opposite sign"),
        (spoiled(dq=-10.0 * motion()["dq"]), r"-10 times .*motor's side"),
        (spoiled(t=1e3 * motion()["t"]), r"time is in ms, give --units time=ms"),
        ({**motion(9.0), "t": motion(9.0)["t"] / 10}, r"0\.1\d* times .*wrong sample time"),
        (spoiled(t=motion()["t"][::-1]), r"line 3: time .* does not rise"),
    ],
)
def test_wrong_units_and_sample_times_are_refused_with_the_factor(tmp_path, columns, told):
    with pytest.raises(UsageError, match=told):
        imported(write(tmp_path / "a.csv", columns))


def test_a_sample_time_that_contradicts_the_log_is_refused(tmp_path):
    path = write(tmp_path / "a.csv", motion())
    with pytest.raises(UsageError, match=r"0\.001 s apart, not 0\.002 s"):
        imported(path, dt=0.002)
    names = {k: v for k, v in NAMES.items() if k != "time"}
    with pytest.raises(UsageError, match=r"velocity is 4 times"):
        imported(path, LogMap(names), dt=0.004)
    with pytest.raises(UsageError, match="no sample time of a joint"):
        imported(path, LogMap(names), dt=10.0)
    with pytest.raises(UsageError, match="above 0"):
        imported(path, LogMap(names), dt=-0.001)


def test_a_slow_log_is_not_blown_up(tmp_path):
    path = write(tmp_path / "a.csv", motion(rate=100.0))
    with pytest.raises(UsageError, match='use --rate "100 Hz"'):
        imported(path)
    assert len(imported(path, rate=100.0).data.episodes[0]) == 300


def test_doubts_are_told_and_the_log_is_kept(tmp_path):
    truth = motion()
    turned = imported(write(tmp_path / "a.csv", {**truth, "tau": -truth["tau"]}))
    assert any("opposite sign" in text for text in turned.warnings)
    milli = imported(write(tmp_path / "b.csv", {**truth, "tau": 1e3 * truth["tau"]}))
    assert any("times what the gains ask" in text for text in milli.warnings)
    still = imported(write(tmp_path / "e.csv", {**truth, "tau": np.zeros(3000)}))
    assert any("torque stays at 0 N*m while the joint moves" in text for text in still.warnings)
    slow = imported(write(tmp_path / "c.csv", {**truth, "dq": 0.8 * truth["dq"]}))
    assert any("0.8 times the derivative" in text for text in slow.warnings)
    noise = np.random.default_rng(0).normal(size=3000)
    noisy = imported(write(tmp_path / "d.csv", {**truth, "dq": noise}))
    assert any("not the derivative" in text for text in noisy.warnings)


@pytest.mark.parametrize(
    ("factor", "told"),
    [
        (math.pi / 180.0, "units position=deg"),
        (180.0 / math.pi, "units velocity=deg/s"),
        (30.0 / math.pi, "units velocity=rpm"),
        (1000.0, "too long"),
        (1e-3, "too short"),
        (-1.0, "opposite sign"),
        (5.0, "other units"),
    ],
)
def test_a_factor_of_the_velocity_names_what_makes_it(factor, told):
    t = np.arange(3000) / 1000.0
    columns = {"position": np.sin(5.0 * t), "velocity": factor * 5.0 * np.cos(5.0 * t)}
    columns |= {"target": columns["position"], "torque": np.zeros(3000)}
    with pytest.raises(UsageError, match=told):
        check_signals("a.csv", columns, 1e-3, **GAINS)


@pytest.mark.parametrize("factor", [1.0, 57.3, -2.0])
def test_the_factor_is_found_through_an_encoder_s_counts(factor):
    t = np.arange(2000) / 1000.0
    count = 2.0 * math.pi / 2**14
    q = np.round(np.sin(5.0 * t) / count) * count
    found = velocity_factor(q, factor * 5.0 * np.cos(5.0 * t), 1e-3)
    assert found is not None
    assert found[0] == pytest.approx(factor, rel=0.01)
    assert found[1] > 0.99
    assert velocity_factor(np.zeros(100), np.zeros(100), 1e-3) is None
    assert velocity_factor(np.zeros(2), np.zeros(2), 1e-3) is None


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("t,q,q_des,dq,tau\n0,0,0,0,0\n0.001,0,nan,0,0\n0.002,0,0,0,0\n", "line 3: q_des is nan"),
        ("t,q,q_des,dq,tau\n0,0,0,0,0\n0.001,0,inf,0,0\n", "line 3: q_des is inf"),
        ("t,q,q_des,dq,tau\n0,0,0,0,x\n", "line 2: tau 'x' is no number"),
        ("t,q,q_des,dq,tau\n0,0,0,0,0\n0.001,0\n", "line 3: q_des is missing"),
        ("t,q,q_des,dq,torque\n0,0,0,0,0\n", "no column 'tau'.*It has t, q"),
        ("t,q,q_des,dq,tau,q\n0,0,0,0,0,0\n", "two columns 'q'"),
        ("t,q,q_des,dq,tau\n", "no samples"),
        ("", "is empty"),
        ("t,q,q_des,dq,tau\n0,0,0,0,0\n", "needs 3 at least"),
        ("t,q,q_des,dq,tau\n0,0,0,0,0\n.001,0,0,0,0\n.002,0,0,0,0\n", "no piece of 0.5 s"),
    ],
)
def test_broken_files_are_refused_by_line(tmp_path, text, told):
    (tmp_path / "a.csv").write_text(text, "utf-8")
    with pytest.raises(UsageError, match=told):
        imported(tmp_path / "a.csv")


def test_blank_lines_at_the_end_are_no_samples(tmp_path):
    (tmp_path / "a.csv").write_text("t,q\n0,1\n1,2\n\n\n", "utf-8")
    assert read_columns(tmp_path / "a.csv", ["q"])["q"].tolist() == [1.0, 2.0]


@pytest.mark.parametrize("suffix", ["pkl", "pickle", "pt", "npy"])
def test_pickles_are_never_read(tmp_path, suffix):
    path = tmp_path / f"a.{suffix}"
    path.write_bytes(b"cos\nsystem\n(S'touch pwned'\ntR.")
    with pytest.raises(UsageError, match="may hold code"):
        imported(path)


def test_other_files_are_refused(tmp_path):
    with pytest.raises(UsageError, match="no log that can be read"):
        imported(tmp_path / "a.mat")
    with pytest.raises(UsageError, match="cannot read"):
        imported(tmp_path / "none.csv")
    (tmp_path / "b.csv").write_bytes(b"\xff\xfe\x00\x01")
    with pytest.raises(UsageError, match="cannot read"):
        imported(tmp_path / "b.csv")
    pytest.importorskip("pyarrow")
    (tmp_path / "c.parquet").write_bytes(b"nothing")
    with pytest.raises(UsageError, match="cannot read"):
        imported(tmp_path / "c.parquet")


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"position_gain": -60.0}, "position gain of -60"),
        ({"velocity_gain": -2.0}, "velocity gain of -2"),
        ({"velocity_gain": math.nan}, "velocity gain of nan"),
        ({"position_gain": 0.0}, "follows no target"),
        ({"rate": 0.0}, "rate of 0"),
        ({"cut": 0.1}, "pieces of 0.1 s"),
        ({"torque_limit": -1.0}, "torque limit"),
    ],
)
def test_numbers_that_make_no_sense_are_refused(tmp_path, options, told):
    path = write(tmp_path / "a.csv", motion())
    with pytest.raises(UsageError, match=told):
        imported(path, **options)


def test_two_logs_of_one_name_and_groups_of_none_are_refused(tmp_path):
    (tmp_path / "x").mkdir()
    paths = [write(tmp_path / "a.csv", motion()), write(tmp_path / "x" / "a.csv", motion())]
    with pytest.raises(UsageError, match="two logs"):
        import_logs(paths, SI, **GAINS)
    with pytest.raises(UsageError, match="group for 'b'"):
        imported(paths[0], LogMap(NAMES, groups={"b": {"mass": 1.0}}))
    with pytest.raises(UsageError, match="no log"):
        import_logs([], SI, **GAINS)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"columns": {"position": "q"}}, "target, velocity, torque"),
        ({"columns": {**NAMES, "positon": "q"}}, "did you mean 'position'"),
        ({"columns": {**NAMES}, "units": {"torqe": "N*m"}}, "did you mean 'torque'"),
        ({"columns": {**NAMES}, "units": {"wall": "N"}}, "is a flag"),
        ({"columns": {**NAMES}, "units": {"current": "A"}}, "no column"),
        (
            {"columns": {"position": "q", "target": "r", "velocity": "v", "current": "i"}},
            "--current-to-torque",
        ),
        ({"columns": NAMES, "current_to_torque": 0.0}, "must not be 0"),
    ],
)
def test_maps_that_cannot_be_followed_are_refused(given, told):
    with pytest.raises(UsageError, match=told):
        LogMap(**given)


def test_a_unit_of_another_kind_is_refused():
    with pytest.raises(UsageError, match="unit of position"):
        LogMap(NAMES, {"position": "mm"}).factor("position")
    assert LogMap(NAMES, {"position": "deg"}).factor("position") == pytest.approx(math.pi / 180.0)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("[colums]\nq = 1", "'colums' is no table; did you mean 'columns'"),
        ("columns = 3", "must be a table"),
        ("[columns]\nposition = 3", "columns.position must be text"),
        ("[constants]\ngain = 3", "no gain"),
        ("[constants]\ncurrent_to_torque = 'x'", "must be a number"),
        ("[groups]\na = 3", "must be a table"),
        ("[group]\nmass = true", "group.mass must be"),
        ("[columns", "is not valid TOML"),
    ],
)
def test_broken_map_files_are_refused(tmp_path, text, told):
    (tmp_path / "map.toml").write_text(text, "utf-8")
    with pytest.raises(UsageError, match=told):
        read_map(tmp_path / "map.toml")


def test_a_map_file_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(UsageError, match="cannot read"):
        read_map(tmp_path / "map.toml")


def test_a_limit_below_what_the_logs_hold_is_told(tmp_path):
    path = write(tmp_path / "run.csv", motion(rate=200.0))
    most = imported(path).data.torque_range[1]
    assert not imported(path, torque_limit=most).warnings
    found = imported(path, torque_limit=0.5 * most)
    assert found.data.torque_range == (-0.5 * most, 0.5 * most)
    (said,) = found.warnings
    share = np.mean(np.abs(found.data.episodes[0].columns["torque"]) > 0.5 * most)
    assert f"reach {most:.4g} N*m" in said
    assert f"{100.0 * share:.2g} % of the samples" in said
