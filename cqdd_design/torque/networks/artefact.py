"""A trained estimator on disk: weights, scaling, validity and history in one file, no pickle.

``NAME.npz`` holds one float32 array for each weight and one JSON text ``metadata``. It is read with
``allow_pickle=False`` and checked, so a file from elsewhere can do no more than be refused.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from cqdd_design.errors import UsageError, shown
from cqdd_design.files import WrittenFile, read_arrays, write_with
from cqdd_design.torque.features.acceleration import Differentiator
from cqdd_design.torque.stored import NETWORK, require

FORMAT = "cqdd-design torque network 1"
_MOST_BYTES = 256_000_000
_WHAT = (
    "a torque network of this program (an .npz without pickles, which are never read); "
    "`cqdd-design torque train` writes one"
)
Family = Literal["gru", "mlp"]
Mode = Literal["window", "streaming"]
ACTIVATIONS = ("relu", "tanh", "softsign", "elu")
"""Of an MLP; the compiled kernel takes a place in this row."""

WeightArray = NDArray[np.float32]


@dataclass(frozen=True)
class Validity:
    """Where a network holds.

    Attributes
    ----------
    dt : float
        Sample time, s.
    position_gain, velocity_gain : float
        Of the joint's controller, N m/rad and N m s/rad.
    torque_range : tuple of float
        N m.
    """

    dt: float
    position_gain: float
    velocity_gain: float
    torque_range: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Artefact:
    """A trained estimator.

    Attributes
    ----------
    name : str
        Of the model: ``pva-gru``, ``mlp-baseline``, ...
    family : {"gru", "mlp"}
    inputs : tuple of str
        Features of one sample, in order: ``position_error`` (target less position, rad),
        ``velocity`` (rad/s), ``acceleration`` (rad/s^2, from the differentiator), ``sin_K`` and
        ``cos_K`` of K times the homed output position, and with the actuator's parameters
        ``balance`` (N m, of everything but dry friction), ``friction_sign`` and ``ripple`` (N m,
        of the gearbox at the homed position).
    history : int
        Samples in a window, the newest last for a GRU; an MLP's input is the window flattened,
        newest sample first, features of one sample side by side.
    mode : {"window", "streaming"}
        How it was trained and is to be run: from a zero state over each window, or one step at a
        time with the state kept.
    activation : str
        Of an MLP: ``relu``, ``tanh``, ``softsign`` or ``elu``; empty for a GRU.
    input_mean, input_std : tuple of float
        Of each feature over the training episodes; the network sees (x - mean)/std.
    torque_mean, torque_std : float
        The network's output times std plus mean is N m.
    residual : bool
        Whether the feature ``balance`` (N m) is added to the network's torque.
    differentiator : Differentiator or None
        Where ``acceleration`` is an input.
    weights : mapping of str to array
        float32 under torch's names. GRU: ``weight_ih_lK`` (3H, I), ``weight_hh_lK`` (3H, H),
        ``bias_ih_lK``, ``bias_hh_lK`` (3H,) for layer K, gates reset, update, new; ``head_weight``
        (1, H), ``head_bias`` (1,). MLP: ``weight_K`` (out, in), ``bias_K`` (out,) for
        K = 0..layers, the last the head.
    facts : mapping
        How it was made: command, seed, hash of data and design, metrics; JSON.
    """

    name: str
    family: Family
    inputs: tuple[str, ...]
    history: int
    mode: Mode
    layers: int
    hidden: int
    activation: str
    input_mean: tuple[float, ...]
    input_std: tuple[float, ...]
    torque_mean: float
    torque_std: float
    residual: bool
    validity: Validity
    differentiator: Differentiator | None
    weights: Mapping[str, WeightArray]
    facts: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Refuse an estimator whose parts do not fit."""
        for name, shape in expected_shapes(self).items():
            found = self.weights.get(name)
            if found is None or found.shape != shape or found.dtype != np.float32:
                told = "missing" if found is None else f"{found.dtype} {found.shape}"
                raise UsageError(f"{self.name}: weight {name} is {told}, not float32 {shape}.")
            if not np.all(np.isfinite(found)):
                raise UsageError(f"{self.name}: weight {name} is not finite; train it anew.")
        if len(self.weights) != len(expected_shapes(self)):
            raise UsageError(f"{self.name}: weights that belong to no layer.")
        if len(self.input_mean) != len(self.inputs) or len(self.input_std) != len(self.inputs):
            raise UsageError(f"{self.name}: scaling of {len(self.input_mean)} inputs.")
        if not (min(self.input_std) > 0.0 and self.torque_std > 0.0):
            raise UsageError(f"{self.name}: a scale of 0; the data do not move.")
        if ("acceleration" in self.inputs) != (self.differentiator is not None):
            raise UsageError(f"{self.name}: acceleration needs its differentiator, and only it.")
        if self.residual and "balance" not in self.inputs:
            raise UsageError(f"{self.name}: a residual needs the input 'balance'.")

    @property
    def parameters(self) -> int:
        """Trained numbers."""
        return sum(values.size for values in self.weights.values())

    def require(self, dt: float, position_gain: float, velocity_gain: float) -> None:
        """Refuse other gains or another sample time than the network was trained for.

        Raises
        ------
        UsageError
        """
        own = self.validity
        for what, given, trained, unit in (
            ("sample time", dt, own.dt, "s"),
            ("position gain", position_gain, own.position_gain, "N m/rad"),
            ("velocity gain", velocity_gain, own.velocity_gain, "N m s/rad"),
        ):
            if not math.isclose(given, trained, rel_tol=1e-6, abs_tol=1e-12):
                raise UsageError(
                    f"{self.name} was trained for a {what} of {trained:g} {unit}, not {given:g}; "
                    "use that, or train a network on data of the other."
                )


def expected_shapes(artefact: Artefact) -> dict[str, tuple[int, ...]]:
    """Names and shapes of the weights that an estimator's sizes ask for."""
    width, features = artefact.hidden, len(artefact.inputs)
    shapes: dict[str, tuple[int, ...]] = {}
    if artefact.family == "gru":
        for layer in range(artefact.layers):
            inside = features if layer == 0 else width
            shapes[f"weight_ih_l{layer}"] = (3 * width, inside)
            shapes[f"weight_hh_l{layer}"] = (3 * width, width)
            shapes[f"bias_ih_l{layer}"] = shapes[f"bias_hh_l{layer}"] = (3 * width,)
        return shapes | {"head_weight": (1, width), "head_bias": (1,)}
    inside = features * artefact.history
    for layer in range(artefact.layers + 1):
        outside = 1 if layer == artefact.layers else width
        shapes[f"weight_{layer}"], shapes[f"bias_{layer}"] = (outside, inside), (outside,)
        inside = width
    return shapes


def write_artefact(artefact: Artefact, path: Path) -> WrittenFile:
    """Write an estimator as ``.npz``."""
    own = {item.name: getattr(artefact, item.name) for item in fields(artefact)}
    del own["weights"]
    own["validity"] = asdict(artefact.validity)
    own["differentiator"] = artefact.differentiator and asdict(artefact.differentiator)
    own["facts"] = dict(artefact.facts)
    text = json.dumps({"format": FORMAT, **own}, allow_nan=False)

    def write(place: Path) -> None:
        with place.open("wb") as stream:
            np.savez(stream, allow_pickle=False, metadata=np.array(text), **artefact.weights)

    return write_with(path, "npz", write)


def read_artefact(path: Path) -> Artefact:
    """Read an estimator.

    Raises
    ------
    UsageError
        For a file that is none: missing, a pickle or another file, of another version, or broken.
    """
    arrays, content = read_arrays(path, _MOST_BYTES, _WHAT)
    told = content.pop("format", None) if isinstance(content, dict) else None
    if told is None:
        raise UsageError(f"{path} is not {_WHAT}.")
    if told != FORMAT:
        raise UsageError(f"{path} is {shown(told)}, not '{FORMAT}'; train it anew.")
    require(NETWORK, content, str(path), "train it anew")
    taps, valid = content.pop("differentiator"), content.pop("validity")
    low, high = valid.pop("torque_range")
    own: dict[str, Any] = {
        key: tuple(value) if isinstance(value, list) else value for key, value in content.items()
    }
    return Artefact(
        **own,
        validity=Validity(**valid, torque_range=(low, high)),
        differentiator=taps and Differentiator(tuple(taps["taps"]), taps["delay"]),
        weights=arrays,
    )
