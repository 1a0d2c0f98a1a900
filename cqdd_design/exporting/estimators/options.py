"""What every export of a torque estimator shares: packages, metadata, and what a client can feed.

A client gives a network what its own code computes: position error and velocity of the joint, most
of them nothing else. What the network needs beyond is made inside where that is possible (the
acceleration, from velocities that the client keeps or that ride in the network's state), and else
refused with the form that works.
"""

from __future__ import annotations

import importlib
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from cqdd_design.errors import CqddError, DependencyError, ReadBackError, UsageError
from cqdd_design.files import WrittenFile, parse_json, read_text_file, write_atomically
from cqdd_design.torque.features.matrix import PHYSICAL
from cqdd_design.torque.networks.meaning import meaning

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from cqdd_design.torque.networks.artefact import Artefact, Mode

TOLERANCE = 1e-5
"""Largest difference between a file read back and the estimator, N m at 15 N m of scale."""
SIGNS = (
    "position_error is target less position; all quantities in the joint's frame, so that a "
    "positive error asks for a positive torque"
)


@dataclass(frozen=True)
class Refusal:
    """A kind that could not be written, and why."""

    kind: str
    error: CqddError


@dataclass(frozen=True)
class Export:
    """What was written, what its user must know, and which of several kinds could not be."""

    files: tuple[WrittenFile, ...]
    warnings: tuple[str, ...] = ()
    refused: tuple[Refusal, ...] = ()


def require(name: str) -> Any:
    """Import a package of the extra ``torque``.

    Raises
    ------
    DependencyError
        When it is missing; the message says what to install.
    """
    try:
        return importlib.import_module(name)
    except ImportError as error:
        package = name.partition(".")[0]
        raise DependencyError(
            f"this export needs the Python package {package}, which is missing or broken "
            f'({error}); run `pip install "cqdd-design[torque]"`.'
        ) from error


def metadata(artefact: Artefact, mode: Mode) -> dict[str, Any]:
    """What must travel with the weights: inputs, units, signs, and where the network holds."""
    valid = artefact.validity
    taps = artefact.differentiator
    return {
        "name": artefact.name,
        "inputs": list(artefact.inputs),
        "history": artefact.history,
        "trained_mode": artefact.mode,
        "mode": mode,
        "sample_dt_s": valid.dt,
        "position_gain_Nm_per_rad": valid.position_gain,
        "velocity_gain_Nms_per_rad": valid.velocity_gain,
        **meaning(artefact).to_dict(),
        "signs": SIGNS,
        "acceleration_taps_per_s": list(taps.taps) if taps else None,
        "acceleration_delay_s": taps.delay if taps else None,
        "residual_added": artefact.residual,
        "parameters": artefact.parameters,
        "facts": dict(artefact.facts),
    }


def joint_settings(artefact: Artefact, names: Mapping[str, str]) -> dict[str, float]:
    """A client's fields of the driven joint, by what they hold; empty where it is unknown.

    Parameters
    ----------
    names : mapping of str to str
        The client's fields, each with one of `Meaning.joint`.
    """
    known = meaning(artefact).joint or {}
    return {name: known[of] for name, of in names.items() if of in known}


def write_settings(path: Path, content: dict[str, Any]) -> WrittenFile:
    """Write what a user enters into the client's configuration, and where the network holds."""
    text = json.dumps(content, indent=1, allow_nan=False) + "\n"
    return write_atomically(path, text, "settings")


def require_settings(path: Path, dt: float, position_gain: float, velocity_gain: float) -> None:
    """Refuse to run an exported network at another sample time or with other gains.

    Parameters
    ----------
    path : Path
        The JSON file beside the network.
    dt, position_gain, velocity_gain : float
        Of the simulation, s, N m/rad and N m s/rad.

    Raises
    ------
    UsageError
    """
    given = (
        ("sample time", "sample_dt_s", dt),
        ("position gain", "position_gain_Nm_per_rad", position_gain),
        ("velocity gain", "velocity_gain_Nms_per_rad", velocity_gain),
    )
    try:
        content = parse_json(read_text_file(path, 1_000_000), path)
        trained = [float(content[key]) for _, key, _ in given]
    except (ValueError, KeyError, TypeError) as error:
        raise UsageError(f"{path} holds no settings of an exported torque network.") from error
    for (name, _, value), known in zip(given, trained, strict=True):
        if not math.isclose(value, known, rel_tol=1e-6, abs_tol=1e-12):
            raise UsageError(
                f"{path.name}: the network holds for a {name} of {known:g}, not {value:g} "
                "(SI); use that, or train a network on data of the other."
            )


def require_inputs(artefact: Artefact, client: str, *, made: tuple[str, ...] = ()) -> None:
    """Refuse an estimator whose inputs a client neither gives nor lets the network make.

    Parameters
    ----------
    client : str
        Its name, for the message.
    made : tuple of str
        What can be had beside position error and velocity.

    Raises
    ------
    UsageError
    """
    known = ("position_error", "velocity", *made)
    for name in artefact.inputs:
        if name in known:
            continue
        if name in PHYSICAL:
            why = "cannot make it, for want of the actuator's parameters"
        elif name.startswith(("sin_", "cos_")):
            why = "gives no absolute, homed position, on which that input depends"
        else:
            why = f"gives {', '.join(known)} only"
        raise UsageError(
            f"{artefact.name} has the input '{name}', but {client} {why}; export it --to onnx or "
            "--to c, or train pv-gru, pva-gru or mlp."
        )


def streaming_warning(artefact: Artefact, client: str) -> tuple[str, ...]:
    """A sentence where a client keeps the state of a network that was trained on windows."""
    if artefact.mode == "streaming":
        return ()
    return (
        f"{artefact.name} was trained on windows of {artefact.history} samples from a zero state, "
        f"and {client} keeps the state for ever: its torque drifts from that of the evaluation. "
        "`torque evaluate` measures the drift.",
    )


def probe(artefact: Artefact, samples: int, seed: int = 0) -> NDArray[np.float64]:
    """Raw features (samples, F) that move as the training's did, another way in every sample."""
    drawn = np.random.default_rng(seed).standard_normal((samples, len(artefact.inputs)))
    return np.asarray(artefact.input_mean + drawn * artefact.input_std, np.float64)


def require_close(
    artefact: Artefact, path: Path, found: NDArray[Any], wanted: NDArray[np.float64]
) -> None:
    """Refuse a file that does not read back as the estimator.

    Raises
    ------
    ReadBackError
    """
    scale = max(1.0, artefact.torque_std / 15.0)
    worst = float(np.max(np.abs(np.asarray(found, np.float64).ravel() - wanted)))
    if not worst <= 10.0 * TOLERANCE * scale:
        raise ReadBackError(
            f"{path} reads back {worst:.2e} N*m away from {artefact.name}; this is a fault of the "
            "export."
        )
