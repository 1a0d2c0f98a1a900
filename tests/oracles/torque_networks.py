"""Estimators of drawn weights, and motions to feed them."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from cqdd_design.torque.features.acceleration import Differentiator
from cqdd_design.torque.networks.artefact import Artefact, Validity, expected_shapes

PV = ("position_error", "velocity")
PVA = (*PV, "acceleration")
DT = 0.005
TAPS = Differentiator(tuple(0.2 * (2.0 - k) / (2.0 * DT) for k in range(5)), 2.0 * DT)
"""Slope of the least-squares line through the last five velocities."""


def network(
    family: str = "gru",
    mode: str = "streaming",
    inputs: tuple[str, ...] = PVA,
    *,
    seed: int = 0,
    **given: Any,
) -> Artefact:
    """Weights drawn as torch draws them, and some larger; scales as of the pendulum."""
    rng = np.random.default_rng(seed)
    scales = {"position_error": 0.2, "velocity": 3.0, "acceleration": 40.0, "balance": 12.0}
    fields: dict[str, Any] = {
        "name": f"drawn-{family}",
        "family": family,
        "inputs": inputs,
        "history": 30 if family == "gru" else 8,
        "mode": mode if family == "gru" else "window",
        "layers": 4 if family == "gru" else 3,
        "hidden": 32,
        "activation": "" if family == "gru" else "softsign",
        "input_mean": tuple(rng.normal(0.0, 0.05, len(inputs))),
        "input_std": tuple(scales.get(name, 0.7) for name in inputs),
        "torque_mean": 0.4,
        "torque_std": 15.0,
        "residual": False,
        "validity": Validity(DT, 60.0, 2.0, (-90.0, 90.0)),
        "differentiator": TAPS if "acceleration" in inputs else None,
    } | given
    weights = {}
    for name, shape in expected_shapes(SimpleNamespace(**fields)).items():
        fan = fields["hidden"] if family == "gru" or len(shape) == 1 else shape[1]
        weights[name] = rng.uniform(-1.5, 1.5, shape).astype(np.float32) / np.float32(fan**0.5)
    return Artefact(**fields, weights=weights)


def motion(artefact: Artefact, samples: int, seed: int = 1) -> np.ndarray:
    """Raw features (samples, F): smooth, of the size of the training's, and unlike each other."""
    rng = np.random.default_rng(seed)
    time = DT * np.arange(samples)[:, None]
    count = len(artefact.inputs)
    waves = np.sin(2.0 * np.pi * rng.uniform(0.3, 4.0, count) * time + rng.uniform(0, 6, count))
    noise = 0.2 * rng.standard_normal((samples, count))
    return np.asarray(artefact.input_mean + (waves + noise) * artefact.input_std)


def joint(samples: int, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Position error and velocity of a joint that swings."""
    rng = np.random.default_rng(seed)
    time = DT * np.arange(samples)
    error = 0.2 * np.sin(5.0 * time + seed) + 0.02 * rng.standard_normal(samples)
    velocity = 3.0 * np.sin(7.0 * time + 0.3 * seed) + 0.3 * rng.standard_normal(samples)
    return error, velocity


def features(artefact: Artefact, error: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Raw features of position error and velocity, the acceleration made as in the training."""
    columns = {"position_error": error, "velocity": velocity}
    if artefact.differentiator:
        taps = np.array(artefact.differentiator.taps)
        past = np.concatenate([np.full(len(taps) - 1, velocity[0]), velocity])
        columns["acceleration"] = np.convolve(past, taps, mode="valid")
    return np.column_stack([columns[name] for name in artefact.inputs])


def torch_torque(artefact: Artefact, raw: np.ndarray, mode: str) -> np.ndarray:
    """Torque of each sample by torch, float32, from the weights under torch's own names."""
    import torch

    scaled = torch.tensor((raw - artefact.input_mean) / artefact.input_std, dtype=torch.float32)
    with torch.no_grad():
        if artefact.family == "gru":
            model = torch.nn.GRU(
                len(artefact.inputs), artefact.hidden, artefact.layers, batch_first=True
            )
            model.load_state_dict(
                {k: torch.tensor(v) for k, v in artefact.weights.items() if "head" not in k}
            )
            weight, bias = (
                torch.tensor(artefact.weights[f"head_{name}"]) for name in ("weight", "bias")
            )
            if mode == "streaming":
                found = model(scaled[None])[0][0]
            else:
                windows = scaled.unfold(0, artefact.history, 1).transpose(1, 2)
                found = model(windows)[0][:, -1]
            found = torch.nn.functional.linear(found, weight, bias)[:, 0]
        else:
            kinds = {"relu": torch.relu, "tanh": torch.tanh, "elu": torch.nn.functional.elu}
            kind = kinds.get(artefact.activation, torch.nn.functional.softsign)
            windows = scaled.unfold(0, artefact.history, 1).transpose(1, 2)
            found = windows.flip(1).flatten(1)
            for layer in range(artefact.layers + 1):
                weight, bias = (
                    torch.tensor(artefact.weights[f"{name}_{layer}"]) for name in ("weight", "bias")
                )
                found = torch.nn.functional.linear(found, weight, bias)
                found = kind(found) if layer < artefact.layers else found[:, 0]
    torque = found.numpy().astype(float) * artefact.torque_std + artefact.torque_mean
    if mode == "window":
        torque = np.concatenate([np.full(artefact.history - 1, np.nan), torque])
    if artefact.residual:
        torque = torque + raw[:, artefact.inputs.index("balance")]
    return torque
