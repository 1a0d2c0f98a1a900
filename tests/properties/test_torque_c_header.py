"""The C header: compiled by the system's compiler, warning-free, and equal to numpy and torch."""

from __future__ import annotations

import ctypes
import os
import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from torque_networks import DT, PV, PVA, TAPS, features, joint, network
from torque_samples import actuator

from cqdd_design.errors import UsageError
from cqdd_design.exporting.estimators.c_header import c_name, export_c, header_text
from cqdd_design.torque.data.episodes import Episode
from cqdd_design.torque.features.matrix import feature_matrix
from cqdd_design.torque.features.physics import actuator_to_dict, driven_torque
from cqdd_design.torque.networks.predict import predict

#: By their names, each program once: "cc" is often another name of "gcc".
COMPILERS = list(
    {
        os.path.realpath(found): name
        for name in ("clang", "gcc", "cc")
        if (found := shutil.which(name))
    }.values()
)
compiled = pytest.mark.skipif(not COMPILERS, reason="no C compiler (cc, gcc, clang) on this system")
STRICT = ("-std=c99", "-Wall", "-Wextra", "-pedantic", "-Wconversion", "-Werror")
TOLERANCE = 1e-5
PHYSICS = (*PVA, "balance", "friction_sign", "ripple")


def library(artefact, folder: Path, *, compiler: str = "", flags: tuple[str, ...] = ("-O2",)):
    """Compile the header with wrappers that ctypes can call."""
    text = header_text(artefact, "net")
    signature = re.search(r"net_step\(net_state \*state, ([^)]*)\)", text)
    arguments = signature.group(1)
    names = ", ".join(part.split()[-1] for part in arguments.split(", "))
    (folder / "net.h").write_text(text)
    (folder / "net.c").write_text(
        '#include "net.h"\n'
        "static net_state state;\n"
        f"float step({arguments});\nvoid reset(void);\nint ready(void);\nfloat tangent(float x);\n"
        "void windows(const float *samples, long count, float *torque);\n"
        "float window(const float *samples);\n"
        f"float step({arguments}) {{ return net_step(&state, {names}); }}\n"
        "void reset(void) { net_init(&state); }\n"
        "int ready(void) { return net_ready(&state); }\n"
        "float tangent(float x) { return net_tanh(x); }\n"
        "float window(const float *samples) { return net_window(samples); }\n"
        "void windows(const float *samples, long count, float *torque)\n"
        "{ net_windows(samples, count, torque); }\n"
    )
    made = folder / "net.so"
    done = subprocess.run(
        [compiler or COMPILERS[0], *STRICT, *flags, "-shared", "-fPIC", "net.c", "-o", made, "-lm"],
        cwd=folder,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    found = ctypes.CDLL(str(made))
    kinds = [part.split()[0] for part in arguments.split(", ")]
    found.step.argtypes = [getattr(ctypes, f"c_{kind}") for kind in kinds]
    found.step.restype = found.window.restype = found.tangent.restype = ctypes.c_float
    found.tangent.argtypes = [ctypes.c_float]
    pointer = ctypes.POINTER(ctypes.c_float)
    found.window.argtypes = [pointer]
    found.windows.argtypes = [pointer, ctypes.c_long, pointer]
    found.reset()
    return found


def pointer_to(values: np.ndarray):
    return values.ctypes.data_as(ctypes.POINTER(ctypes.c_float))


@compiled
@pytest.mark.parametrize(
    "flags",
    [
        pytest.param(("-O0",), marks=pytest.mark.deep),
        ("-O3", "-march=native"),
        pytest.param(("-O2", "-ffp-contract=off"), marks=pytest.mark.deep),
    ],
)
def test_ten_thousand_steps_equal_numpy_and_the_acceleration_is_made_inside(tmp_path, flags):
    artefact = network()
    error, velocity = joint(10_000)
    net = library(artefact, tmp_path, flags=flags)
    found = np.array([net.step(*pair) for pair in zip(error, velocity, strict=True)])
    raw = features(artefact, error, velocity)
    wanted = predict(artefact, raw, engine="compiled")
    np.testing.assert_allclose(found, wanted, atol=TOLERANCE, rtol=0.0)
    judge = predict(artefact, raw[:2000], engine="plain")
    np.testing.assert_allclose(found[:2000], judge, atol=TOLERANCE, rtol=0.0)
    net.reset()
    assert net.step(error[0], velocity[0]) == found[0]


@compiled
def test_ten_thousand_steps_equal_torch(tmp_path):
    torch = pytest.importorskip("torch")
    from torque_networks import torch_torque

    torch.set_num_threads(1)
    artefact = network(seed=4)
    error, velocity = joint(10_000, seed=2)
    net = library(artefact, tmp_path, flags=("-O3", "-march=native"))
    found = np.array([net.step(*pair) for pair in zip(error, velocity, strict=True)])
    wanted = torch_torque(artefact, features(artefact, error, velocity), "streaming")
    np.testing.assert_allclose(found, wanted, atol=TOLERANCE, rtol=0.0)


@compiled
@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize(
    "artefact",
    [
        network(mode="window"),
        network(inputs=PV, layers=1, hidden=10, history=7, mode="window"),
        network("mlp", inputs=PV),
        network("mlp", activation="elu", layers=2, hidden=20),
        network("mlp", activation="relu", layers=1),
        network("mlp", activation="tanh", history=24, inputs=PV),
    ],
    ids=["gru", "odd sizes", "softsign", "elu", "relu", "tanh"],
)
def test_windows_equal_numpy_one_by_one_many_at_once_and_step_by_step(tmp_path, artefact, compiler):
    error, velocity = joint(300)
    raw = features(artefact, error, velocity)
    wanted = predict(artefact, raw, engine="plain")
    net = library(artefact, tmp_path, compiler=compiler)
    full = artefact.history - 1
    torques, ready = [], []
    for pair in zip(error, velocity, strict=True):
        torques.append(net.step(*pair))
        ready.append(net.ready())
    assert not any(ready[:full])
    assert all(ready[full:])
    assert not np.any(torques[:full])
    np.testing.assert_allclose(torques[full:], wanted[full:], atol=TOLERANCE, rtol=0.0)
    view = np.lib.stride_tricks.sliding_window_view(raw, artefact.history, axis=0)
    windows = np.ascontiguousarray(view.swapaxes(1, 2), np.float32)
    many = np.zeros(len(windows), np.float32)
    net.windows(pointer_to(windows), len(windows), pointer_to(many))
    one = [net.window(pointer_to(window)) for window in windows]
    np.testing.assert_allclose(many, wanted[full:], atol=TOLERANCE, rtol=0.0)
    np.testing.assert_allclose(one, wanted[full:], atol=TOLERANCE, rtol=0.0)


@compiled
def test_phases_are_made_of_the_position(tmp_path):
    names = (*PVA, "sin_11", "cos_110")
    artefact = network(inputs=names)
    error, velocity = joint(500)
    position = np.linspace(-3.0, 9.0, 500)
    columns = dict(zip(PVA, features(network(), error, velocity).T, strict=True))
    columns |= {"sin_11": np.sin(11 * position), "cos_110": np.cos(110 * position)}
    wanted = predict(artefact, np.column_stack([columns[one] for one in names]), engine="plain")
    net = library(artefact, tmp_path)
    inputs = zip(error, velocity, position, strict=True)
    found = np.array([net.step(*row) for row in inputs])
    np.testing.assert_allclose(found, wanted, atol=TOLERANCE, rtol=0.0)


def small_drive(way: float = -1.0):
    """An actuator that its supply and its current limit hold back in the swing below."""
    given = actuator()
    drive = replace(given.drive, supply_voltage=12.0, current_limit=30.0)
    return replace(given, drive=drive, gear=replace(given.gear, ratio=way * abs(given.gear.ratio)))


def physical(parameters, **given):
    """A drawn network that holds an actuator."""
    facts = {"actuator": actuator_to_dict(parameters)}
    return network(**{"inputs": PHYSICS, "facts": facts} | given)


def swing(samples: int = 800) -> Episode:
    """Hard swings over several turns; error and velocity are single-precision numbers."""
    error, velocity = (
        (scale * values).astype(np.float32).astype(np.float64)
        for scale, values in zip((5.0, 2.0), joint(samples), strict=True)
    )
    position = np.linspace(-7.0, 9.0, samples)
    columns = {"position": position, "target": position + error, "velocity": velocity}
    return Episode("swing", {}, DT, columns | {"torque": error, "current": error})


def stepped(net, episode: Episode, names: tuple[str, ...]) -> np.ndarray:
    """Torque of the header, step by step, from what a joint measures."""
    columns = dict(episode.columns)
    columns["position_error"] = columns["target"] - columns["position"]
    return np.array([net.step(*row) for row in zip(*(columns[one] for one in names), strict=True)])


def test_the_swing_meets_the_supply_and_the_current_limit():
    episode, parameters = swing(), small_drive()
    free = replace(parameters.drive, supply_voltage=1e4, current_limit=1e4)
    asked = driven_torque(replace(parameters, drive=free), episode)
    found = driven_torque(parameters, episode)
    most = 10.0 * 0.18 * 30.0
    for way in (-1.0, 1.0):
        at_current = np.isclose(way * found, most) & (way * asked > 1.1 * most)
        at_voltage = (np.abs(found) < 0.99 * most) & (way * (asked - found) > 1.0)
        assert at_current.sum() > 20
        assert at_voltage.sum() > 20


@compiled
@pytest.mark.parametrize(
    "way",
    [-1.0, pytest.param(1.0, marks=pytest.mark.deep)],
    ids=["against the motor", "with the motor"],
)
@pytest.mark.parametrize("mode", ["streaming", pytest.param("window", marks=pytest.mark.deep)])
def test_balance_friction_and_ripple_are_made_inside(tmp_path, mode, way):
    parameters, episode = small_drive(way), swing()
    artefact = physical(parameters, mode=mode, residual=True)
    raw = feature_matrix(episode, PHYSICS, differentiator=TAPS, physics=parameters)
    wanted = predict(artefact, raw, engine="plain")
    net = library(artefact, tmp_path, flags=("-O3", "-march=native", "-ffp-contract=fast"))
    found = stepped(net, episode, (*PV, "position"))
    full = artefact.history - 1 if mode == "window" else 0
    np.testing.assert_allclose(found[full:], wanted[full:], atol=TOLERANCE, rtol=0.0)
    assert not np.any(found[:full])
    for column in range(3, 6):
        other = raw.copy()
        other[:, column] = raw[:, column].mean()
        away = np.nanmax(np.abs(predict(artefact, other, engine="plain") - wanted))
        assert away > 1000.0 * TOLERANCE


@compiled
@pytest.mark.parametrize(
    ("inputs", "arguments", "functions"),
    [
        (("velocity", "friction_sign"), ("velocity",), ("friction_sign",)),
        (("acceleration", "balance"), PV, ("driven", "balance")),
        (
            ("ripple", "velocity", "acceleration", "sin_11"),
            ("velocity", "position_error", "position"),
            ("driven", "balance", "friction_sign", "ripple"),
        ),
    ],
)
def test_only_what_the_inputs_need_is_asked_for_and_made(tmp_path, inputs, arguments, functions):
    artefact = physical(small_drive(), family="mlp", inputs=inputs)
    text = header_text(artefact, "net")
    made = re.findall(r"net_(driven|balance|friction_sign|ripple)\(double", text)
    assert tuple(made) == functions
    signature = re.search(r"net_step\(net_state \*state, ([^)]*)\)", text).group(1)
    assert tuple(part.split()[-1] for part in signature.split(", ")) == arguments
    episode = swing(300)
    raw = feature_matrix(episode, inputs, differentiator=TAPS, physics=small_drive())
    wanted = predict(artefact, raw, engine="plain")
    full = artefact.history - 1
    found = stepped(library(artefact, tmp_path), episode, arguments)
    np.testing.assert_allclose(found[full:], wanted[full:], atol=TOLERANCE, rtol=0.0)


@compiled
def test_a_gearbox_without_harmonics_has_no_ripple(tmp_path):
    given = small_drive()
    none = {"error_orders": np.zeros(0, np.int64)} | {
        f"{of}_{wave}": np.zeros(0) for of in ("error", "stiffness") for wave in ("cosine", "sine")
    }
    parameters = replace(given, gear=replace(given.gear, **none))
    artefact, episode = physical(parameters, residual=True), swing(100)
    raw = feature_matrix(episode, PHYSICS, differentiator=TAPS, physics=parameters)
    assert not np.any(raw[:, -1])
    found = stepped(library(artefact, tmp_path), episode, (*PV, "position"))
    wanted = predict(artefact, raw, engine="plain")
    np.testing.assert_allclose(found, wanted, atol=TOLERANCE, rtol=0.0)


@pytest.mark.parametrize("name", ["balance", "friction_sign", "ripple"])
def test_physics_without_its_actuator_or_its_differentiator_is_refused(name):
    with pytest.raises(UsageError, match=rf"'{name}'.* actuator's parameters.* export to onnx"):
        header_text(network(inputs=(*PVA, name)), "net")
    if name != "friction_sign":
        with pytest.raises(UsageError, match=rf"'{name}'.* differentiator; export to onnx"):
            header_text(physical(actuator(), inputs=(*PV, name)), "net")


def test_the_comment_says_what_is_made_inside_and_of_which_actuator():
    text = header_text(physical(replace(actuator(), name="arm */ @name@\n2"), name="a/*b"), "net")
    told = text[: text.index("*/")]
    for part in (
        "actuator arm - -name-2 and",
        "balance",
        "friction_sign",
        "ripple",
        "Homed:",
        "-lm",
    ):
        assert part in told
    assert "@" not in text
    assert "/*" not in told[2:]
    plain = header_text(network(), "net")
    assert "math.h" not in plain
    assert "Homed" not in plain


@compiled
def test_the_tangent_is_good_to_a_millionth(tmp_path):
    net = library(network(), tmp_path)
    grid = np.linspace(-12.0, 12.0, 20_001).astype(np.float32)
    found = np.array([net.tangent(float(value)) for value in grid])
    assert np.abs(found - np.tanh(grid.astype(float))).max() < 1e-6
    assert np.isnan(net.tangent(float("nan")))
    assert net.tangent(float("-inf")) == pytest.approx(-1.0, abs=1e-6)


@compiled
def test_two_networks_live_in_one_program(tmp_path):
    for name, artefact in (("one", network()), ("two", network("mlp"))):
        export_c(artefact, tmp_path / name)
    (tmp_path / "both.c").write_text(
        '#include "one.h"\n#include "two.h"\n#include "one.h"\nint main(void) { one_state a; '
        "two_state b; one_init(&a); two_init(&b); return one_step(&a, 0.1f, 0.0f) == "
        "two_step(&b, 0.1f, 0.0f); }\n"
    )
    command = [COMPILERS[0], *STRICT, "both.c", "-o", "both"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert subprocess.run([tmp_path / "both"]).returncode == 0


def test_the_comment_says_where_the_network_holds():
    text = header_text(network(mode="window"), "net")
    told = text[: text.index("*/")]
    for part in ("0.005 s", "60 N m/rad", "2 N m s/rad", "-90 to 90 N m", "target less position"):
        assert part in told
    assert "with a delay" in told
    assert "10 ms" in told
    assert "@" not in text


def test_an_input_that_c_cannot_make_is_refused():
    with pytest.raises(UsageError, match="winding_temperature"):
        header_text(network(inputs=(*PV, "winding_temperature")), "net")


def test_names_are_identifiers():
    assert c_name("PVA gru-1") == "pva_gru_1"
    assert c_name("4x32") == "net_4x32"
