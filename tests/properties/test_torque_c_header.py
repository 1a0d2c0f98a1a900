"""The C header: compiled by the system's compiler, warning-free, and equal to numpy and torch."""

from __future__ import annotations

import ctypes
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from torque_networks import PV, PVA, features, joint, motion, network

from cqdd_design.errors import UsageError
from cqdd_design.exporting.c_header import c_name, header_text, write_c_header
from cqdd_design.torque.predict import predict

COMPILERS = [name for name in ("cc", "gcc", "clang") if shutil.which(name)]
compiled = pytest.mark.skipif(not COMPILERS, reason="no C compiler (cc, gcc, clang) on this system")
STRICT = ("-std=c99", "-Wall", "-Wextra", "-pedantic", "-Wconversion", "-Werror")
TOLERANCE = 1e-5


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
    "flags", [("-O0",), ("-O3", "-march=native"), ("-O2", "-ffp-contract=off")]
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
def test_phases_are_made_of_the_position_and_a_residual_of_the_physics(tmp_path):
    names = (*PVA, "sin_11", "cos_110", "physics")
    artefact = network(inputs=names, residual=True)
    error, velocity = joint(500)
    position = np.linspace(-3.0, 9.0, 500)
    columns = dict(zip(PVA, features(network(), error, velocity).T, strict=True))
    columns |= {"sin_11": np.sin(11 * position), "cos_110": np.cos(110 * position)}
    columns["physics"] = motion(network(inputs=("physics",)), 500)[:, 0]
    wanted = predict(artefact, np.column_stack([columns[one] for one in names]), engine="plain")
    net = library(artefact, tmp_path)
    inputs = zip(error, velocity, columns["physics"], position, strict=True)
    found = np.array([net.step(*row) for row in inputs])
    np.testing.assert_allclose(found, wanted, atol=TOLERANCE, rtol=0.0)


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
        write_c_header(artefact, tmp_path / f"{name}.h")
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
