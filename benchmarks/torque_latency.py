"""Time torque estimators: torch, TorchScript, onnxruntime, numba and C in the same run.

    python benchmarks/torque_latency.py [--write] [--model NETWORK.npz]

One thread, one joint. Three numbers that are not each other: one streaming step with its state
kept, one window of 30 samples from a zero state, and the share of one window when 16,000 are run at
once. Without a model the weights are drawn: the time does not depend on them. The engines take
turns, so that a slow minute of the machine meets all of them. C is the header that `torque export
--to c` writes, compiled by the system's compiler; inside its loop each step feeds on the last.
`--write` puts the result into docs/benchmarks.md. Run it by hand on a machine that does nothing
else.
"""

from __future__ import annotations

import argparse
import ctypes
import io
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np
from processes import machine, write_section

from cqdd_design.exporting.estimators.c_header import header_text
from cqdd_design.exporting.estimators.newton import newton_model
from cqdd_design.exporting.estimators.onnx import streaming_model, window_model
from cqdd_design.torque.features.acceleration import Differentiator
from cqdd_design.torque.networks import gru_kernel
from cqdd_design.torque.networks.artefact import Artefact, Validity, expected_shapes, read_artefact
from cqdd_design.torque.networks.folded import folded_gru
from cqdd_design.torque.networks.predict import Streaming

HEADING = "## Torque estimation"
PACKAGES = ("numpy", "numba", "torch", "onnxruntime")
FLAGS = ("-O3", "-march=native", "-ffp-contract=fast")
WINDOWS, ROUNDS = 16_000, 5
GOAL = 8.0
PAPER = 1.49

SOURCE = r"""
#define _POSIX_C_SOURCE 200809L
#include <time.h>
#include "net.h"
static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec;
}
static net_state state;
float step(float error, float velocity) { return net_step(&state, error, velocity); }
float window(const float *samples) { return net_window(samples); }
void windows(const float *samples, long count, float *torque)
{
    net_windows(samples, count, torque);
}
float timed_steps(double *us, long count)
{
    float torque = 0.0f;
    long i;
    int j;
    for (i = 0; i < count; i++) {
        const double began = now();
        for (j = 0; j < 50; j++)
            torque = net_step(&state, 0.1f + 1e-3f * torque, 1e-2f * (float)j);
        us[i] = (now() - began) / 50.0;
    }
    return torque;
}
float timed_windows(const float *samples, double *us, long count)
{
    float torque = 0.0f;
    long i;
    for (i = 0; i < count; i++) {
        const double began = now();
        torque += net_window(samples + i * NET_HISTORY * NET_FEATURES);
        us[i] = now() - began;
    }
    return torque;
}
"""


def drawn_network() -> Artefact:
    """The paper's PVA-GRU with drawn weights: 4 layers of 32, 3 inputs, history 30."""
    from types import SimpleNamespace

    sizes: dict[str, Any] = {
        "name": "pva-gru",
        "family": "gru",
        "inputs": ("position_error", "velocity", "acceleration"),
        "history": 30,
        "mode": "streaming",
        "layers": 4,
        "hidden": 32,
        "activation": "",
        "input_mean": (0.0, 0.0, 0.0),
        "input_std": (0.2, 3.0, 40.0),
        "torque_mean": 0.0,
        "torque_std": 15.0,
        "residual": False,
        "validity": Validity(0.005, 60.0, 2.0, (-90.0, 90.0)),
        "differentiator": Differentiator((40.0, 20.0, 0.0, -20.0, -40.0), 0.01),
    }
    rng = np.random.default_rng(0)
    weights = {
        name: rng.uniform(-0.18, 0.18, shape).astype(np.float32)
        for name, shape in expected_shapes(SimpleNamespace(**sizes)).items()  # type: ignore[arg-type]
    }
    return Artefact(**sizes, weights=weights)


def multiply_adds(artefact: Artefact) -> int:
    """Of one step of a GRU with its head."""
    return sum(values.size for values in artefact.weights.values() if values.ndim == 2)


Timed = dict[str, list[float]]


def turns(calls: dict[str, Callable[[], Any]], count: int, batch: int = 1) -> Timed:
    """Microseconds of single calls (or of one of `batch` calls) of each engine, in turns."""
    found: Timed = {name: [] for name in calls}
    for call in calls.values():
        for _ in range(50):
            call()
    for _ in range(ROUNDS):
        for name, call in calls.items():
            for _ in range(count // ROUNDS):
                began = time.perf_counter_ns()
                call()
                found[name].append(1e-3 * (time.perf_counter_ns() - began) / batch)
    return found


def compiled_c(artefact: Artefact, folder: Path) -> Any:
    """The header, compiled."""
    (folder / "net.h").write_text(header_text(artefact, "net"))
    (folder / "net.c").write_text(SOURCE)
    made = folder / "net.so"
    subprocess.run(
        ["cc", *FLAGS, "-shared", "-fPIC", "net.c", "-o", made, "-lm"], cwd=folder, check=True
    )
    library = ctypes.CDLL(str(made))
    library.step.argtypes = [ctypes.c_float, ctypes.c_float]
    for name in ("step", "window", "timed_steps", "timed_windows"):
        getattr(library, name).restype = ctypes.c_float
    library.window.argtypes = [ctypes.c_void_p]
    library.windows.argtypes = [ctypes.c_void_p, ctypes.c_long, ctypes.c_void_p]
    library.timed_steps.argtypes = [ctypes.c_void_p, ctypes.c_long]
    library.timed_windows.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_long]
    return library


def sessions(artefact: Artefact) -> tuple[Any, Any, Any]:
    """Sessions of onnxruntime: streaming, streaming with separate states, window."""
    import onnxruntime

    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    made = (streaming_model(artefact), newton_model(artefact), window_model(artefact))
    providers = ["CPUExecutionProvider"]
    return tuple(onnxruntime.InferenceSession(one, options, providers=providers) for one in made)  # type: ignore[return-value]


def bound(session: Any, inputs: dict[str, Any]) -> Callable[[], Any]:
    """A call by IOBinding, inputs and outputs in place."""
    import onnxruntime

    binding = session.io_binding()
    for name, values in inputs.items():
        binding.bind_ortvalue_input(name, onnxruntime.OrtValue.ortvalue_from_numpy(values))
    for one in session.get_outputs():
        binding.bind_output(one.name)
    return lambda: session.run_with_iobinding(binding)


def modules(artefact: Artefact) -> tuple[Any, Any]:
    """The GRU with its head in eager torch, and as TorchScript."""
    import torch

    torch.set_num_threads(1)

    class Estimator(torch.nn.Module):
        def __init__(self) -> None:
            super().__init__()
            sizes = (len(artefact.inputs), artefact.hidden, artefact.layers)
            self.gru = torch.nn.GRU(*sizes, batch_first=True)
            self.head = torch.nn.Linear(artefact.hidden, 1)

        def forward(self, x: Any, h: Any) -> Any:
            sequence, h = self.gru(x, h)
            return self.head(sequence[:, -1]), h

    module = Estimator().eval()
    with torch.no_grad():
        for name, parameter in module.named_parameters():
            parameter.copy_(
                torch.tensor(artefact.weights[name.removeprefix("gru.").replace("head.", "head_")])
            )
        example = (torch.zeros(1, 1, 3), torch.zeros(artefact.layers, 1, artefact.hidden))
        buffer = io.BytesIO()
        torch.jit.save(torch.jit.trace(module, example), buffer)
    return module, torch.jit.freeze(torch.jit.load(io.BytesIO(buffer.getvalue())).eval())


def measure(artefact: Artefact, folder: Path) -> tuple[Timed, Timed, dict[str, float]]:
    """Microseconds of steps and of windows by engine, and of one window of many."""
    import torch

    layers, width, history = artefact.layers, artefact.hidden, artefact.history
    rng = np.random.default_rng(1)
    samples = rng.standard_normal((WINDOWS, history, 3)).astype(np.float32)
    samples *= np.float32(artefact.input_std)
    sample = np.ascontiguousarray(samples[0, :1])
    one = np.ascontiguousarray(samples[:1])
    zero = np.zeros((layers, 1, width), np.float32)
    library = compiled_c(artefact, folder)
    eager, script = modules(artefact)
    streaming, separate, window = sessions(artefact)
    apart = {f"initial_h_{k}": zero[:1] for k in range(layers)} | {"features": sample[None]}
    weights = folded_gru(artefact).flat
    state = np.zeros((layers, width), np.float32)
    kept = Streaming(artefact, "streaming")
    whole = Streaming(artefact, "window")
    row = sample[0]
    x, h, w = torch.tensor(sample[None]), torch.tensor(zero), torch.tensor(one)
    many = np.ascontiguousarray(samples[:50, 0])
    into = np.zeros(50, np.float32)

    with torch.inference_mode():
        steps = turns(
            {
                "torch, eager": lambda: eager(x, h),
                "TorchScript": lambda: script(x, h),
                "onnxruntime, run": lambda: streaming.run(
                    None, {"features": sample, "hidden": zero}
                ),
                "onnxruntime, IOBinding": bound(streaming, {"features": sample, "hidden": zero}),
                "onnxruntime, IOBinding, states apart": bound(separate, apart),
                "numba, from Python": lambda: kept.step(row),
                "C, through ctypes": lambda: library.step(0.1, 0.2),
            },
            5000,
        )
        steps |= turns(
            {"numba, in a compiled loop": lambda: gru_kernel.steps(weights, many, state, into)},
            5000,
            batch=50,
        )
        inside = np.zeros(5000)
        library.timed_steps(inside.ctypes.data, len(inside))
        steps["C, in a compiled loop"] = list(inside[500:])
        for _ in range(history):
            whole.step(row)
        windows = turns(
            {
                "torch, eager": lambda: eager(w, h),
                "TorchScript": lambda: script(w, h),
                "onnxruntime, run": lambda: window.run(None, {"window": one}),
                "onnxruntime, IOBinding": bound(window, {"window": one}),
                "numba, from Python": lambda: whole.step(row),
                "C, through ctypes": lambda: library.window(one.ctypes.data),
            },
            1000,
        )
        library.timed_windows(samples.ctypes.data, inside.ctypes.data, 2000)
        windows["C, in a compiled loop"] = list(inside[200:2000])
        torque = np.zeros(WINDOWS, np.float32)
        states = torch.zeros(layers, WINDOWS, width)
        batches = torch.tensor(samples)
        runs: dict[str, Callable[[], Any]] = {
            "torch, eager": lambda: eager(batches, states),
            "TorchScript": lambda: script(batches, states),
            "onnxruntime, run": lambda: window.run(None, {"window": samples}),
            "onnxruntime, run, 512 at once": lambda: [
                window.run(None, {"window": samples[k : k + 512]}) for k in range(0, WINDOWS, 512)
            ],
            "numba": lambda: gru_kernel.windows(weights, samples, layers, width, torque),
            "C": lambda: library.windows(samples.ctypes.data, WINDOWS, torque.ctypes.data),
        }
        shares: dict[str, list[float]] = {name: [] for name in runs}
        for _ in range(1 + 3):
            for name, run in runs.items():
                began = time.perf_counter()
                run()
                shares[name].append(1e6 * (time.perf_counter() - began) / WINDOWS)
    # The median of three, the first run left out.
    return steps, windows, {name: float(np.median(each[1:])) for name, each in shares.items()}


def table(artefact: Artefact, folder: Path) -> list[str]:
    """Markdown of what was measured."""
    steps, windows, shares = measure(artefact, folder)
    lines = [
        "| one thread, batch 1, \u00b5s | streaming step, p50 | p99 | window of 30, p50 | p99 |",
        "|---|---|---|---|---|",
    ]
    for name, values in steps.items():
        cells = [f"{np.percentile(values, q):.2f}" for q in (50, 99)]
        other = windows.get(name)
        cells += [f"{np.percentile(other, q):.1f}" for q in (50, 99)] if other else ["", ""]
        lines.append(f"| {name} | {' | '.join(cells)} |")
    lines += ["", f"| {WINDOWS:,} windows at once, one thread | \u00b5s a window |", "|---|---|"]
    lines += [f"| {name} | {value:.1f} |" for name, value in shares.items()]
    median = {name: float(np.median(values)) for name, values in steps.items()}
    best = min(value for name, value in median.items() if "onnx" in name)
    theirs = min(value for name, value in shares.items() if "onnx" in name)
    factors = ", ".join(
        f"{name} {best / median[name]:.1f}" for name in median if name.startswith(("numba", "C,"))
    )
    count = multiply_adds(artefact)
    return [
        *lines,
        "",
        f"Streaming step, onnxruntime's best over ours (goal {GOAL:g}): {factors}. Throughput, "
        f"ours over onnxruntime's best (goal at most 1): numba {shares['numba'] / theirs:.2f}, C "
        f"{shares['C'] / theirs:.2f}.",
        "",
        f"A step is {count / 1e3:.1f} thousand multiply-adds, a window of {artefact.history} "
        f"{2e-6 * count * artefact.history:.2f} MFLOP. The paper's {PAPER} \u00b5s a prediction "
        f"would be {2e-3 * count * artefact.history / PAPER:.0f} GFLOP/s if each ran its window "
        f"alone, more than one core does; it can be one streaming step "
        f"({2e-3 * count / PAPER:.0f} GFLOP/s), or the share of one window in a large batch.",
    ]


def main() -> None:
    """Measure and show, or write into the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--model", type=Path)
    asked = parser.parse_args()
    if not shutil.which("cc"):
        parser.error("there is no C compiler `cc`")
    artefact = read_artefact(asked.model) if asked.model else drawn_network()
    with tempfile.TemporaryDirectory() as folder:
        found = table(artefact, Path(folder))
    versions = ", ".join(f"{name} {metadata.version(name)}" for name in PACKAGES)
    compiler = subprocess.run(["cc", "--version"], capture_output=True, text=True).stdout
    lines = [
        "Written by `python benchmarks/torque_latency.py --write`, in one run, after compilation:",
        f"GRU of {artefact.layers} layers of {artefact.hidden}, {len(artefact.inputs)} inputs, "
        "float32, scaling and the state's keeping included in ours.",
        "",
        *machine()[:1],
        f"- {versions}",
        f"- {compiler.splitlines()[0]}, {' '.join(FLAGS)}",
        "",
        *found,
    ]
    text = "\n".join(lines) + "\n"
    if asked.write:
        write_section("torque", "torque_latency.py", HEADING, text)
    else:
        print(text)


if __name__ == "__main__":
    main()
