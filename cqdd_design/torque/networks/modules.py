"""The estimators as torch modules, and their weights to and from an artefact.

torch is imported inside the functions. A network here is what is trained: it sees scaled features
and tells the scaled torque; scaling stands in the artefact.
"""

from __future__ import annotations

import importlib
import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from cqdd_design.errors import DependencyError, UsageError, did_you_mean
from cqdd_design.torque.networks.artefact import ACTIVATIONS, Artefact, Family, WeightArray

PV = ("position_error", "velocity")
PVA = (*PV, "acceleration")
CORRECTED = (*PVA, "balance", "friction_sign")


@dataclass(frozen=True)
class Model:
    """One architecture.

    Attributes
    ----------
    family : {"gru", "mlp"}
    inputs : tuple of str
        Features but the gearbox's phases.
    activation : str
        Of an MLP; empty for a GRU.
    phase : bool
        Whether the gearbox's phases are inputs besides.
    residual : bool
        Whether it corrects the feature ``balance``.
    searched : bool
        Whether activation, learning rate and weight decay are searched.
    """

    name: str
    family: Family
    inputs: tuple[str, ...]
    layers: int
    hidden: int
    history: int
    activation: str = ""
    phase: bool = False
    residual: bool = False
    searched: bool = False

    @property
    def needs_actuator(self) -> bool:
        """Whether the actuator's parameters are needed to train it."""
        return self.phase or self.residual


_GRU: Any = {"family": "gru", "layers": 4, "hidden": 32, "history": 30}
_MLP: Any = {"family": "mlp", "layers": 3, "hidden": 32, "activation": "softsign"}

# The first four are the paper's; mlp-acceleration shows what that input alone brings, and the
# last three know the actuator: its balance, the phases of its gearbox, or both.
MODELS: Mapping[str, Model] = {
    model.name: model
    for model in (
        Model("pva-gru", inputs=PVA, **_GRU),
        Model("pv-gru", inputs=PV, **_GRU),
        Model("mlp", inputs=PV, history=24, searched=True, **_MLP),
        Model("mlp-baseline", inputs=PV, history=3, **_MLP),
        Model("mlp-acceleration", inputs=PVA, history=24, searched=True, **_MLP),
        Model("physics-gru", inputs=CORRECTED, residual=True, **_GRU),
        Model("phase-gru", inputs=PVA, phase=True, **_GRU),
        Model("physics-phase-gru", inputs=(*CORRECTED, "ripple"), residual=True, **_GRU),
    )
}


def find_model(name: str) -> Model:
    """A model by name.

    Raises
    ------
    UsageError
        With the nearest names, for an unknown one.
    """
    if name not in MODELS:
        raise UsageError(
            f"there is no model '{name}'{did_you_mean(name, MODELS)}; there are "
            f"{', '.join(MODELS)}."
        )
    return MODELS[name]


def require_torch() -> Any:
    """Import torch.

    Raises
    ------
    DependencyError
        When it is missing; the message says what to install.
    """
    try:
        return importlib.import_module("torch")
    except ImportError as error:
        raise DependencyError(
            "training needs the Python package torch, which is missing or broken "
            f'({error}); run `pip install "cqdd-design[torque]"`. Trained networks run without it.'
        ) from error


class Network:
    """A model's trainable part.

    Parameters
    ----------
    features : int
        Inputs of one sample, phases included.
    seed : int
        Of the weights; torch's own initialisation, its global generator left as it was.
    activation : str, optional
        Of an MLP, instead of the model's.
    """

    def __init__(
        self, model: Model, features: int, seed: int, *, activation: str = "", device: str = "cpu"
    ) -> None:
        torch = require_torch()
        self.model, self.features = model, features
        self.activation = (activation or model.activation) if model.family == "mlp" else ""
        if self.activation and self.activation not in ACTIVATIONS:
            raise UsageError(
                f"there is no activation '{self.activation}'"
                f"{did_you_mean(self.activation, ACTIVATIONS)}; there are {', '.join(ACTIVATIONS)}."
            )
        with torch.random.fork_rng(devices=[]):
            torch.manual_seed(seed)
            if model.family == "gru":
                self._gru = torch.nn.GRU(features, model.hidden, model.layers, batch_first=True)
                self._layers = [torch.nn.Linear(model.hidden, 1)]
            else:
                sizes = [features * model.history, *[model.hidden] * model.layers, 1]
                self._gru = None
                self._layers = [
                    torch.nn.Linear(inside, outside)
                    for inside, outside in itertools.pairwise(sizes)
                ]
        for module in self.modules:
            module.to(device)
        self._act = getattr(torch.nn.functional, self.activation or "relu")

    @property
    def modules(self) -> list[Any]:
        """The torch modules."""
        return [*([] if self._gru is None else [self._gru]), *self._layers]

    @property
    def tensors(self) -> dict[str, Any]:
        """Trained tensors under the names of `Artefact.weights`."""
        if self._gru is not None:
            (head,) = self._layers
            return dict(self._gru.named_parameters()) | {
                "head_weight": head.weight,
                "head_bias": head.bias,
            }
        named = {}
        for k, layer in enumerate(self._layers):
            named[f"weight_{k}"], named[f"bias_{k}"] = layer.weight, layer.bias
        return named

    def last(self, x: Any) -> Any:
        """Scaled torque (B,) at the end of windows (B, history, F), oldest sample first."""
        if self._gru is not None:
            if not x.is_cuda and require_torch().is_grad_enabled():
                from cqdd_design.torque.networks.wavefront import last_state

                top = last_state(x, list(self._gru.parameters()))
                return self._layers[0](top).squeeze(1)
            states, _ = self._gru(x)
            return self._layers[0](states[:, -1]).squeeze(1)
        y = x.flip(1).flatten(1)
        for layer in self._layers[:-1]:
            y = self._act(layer(y))
        return self._layers[-1](y).squeeze(1)

    def every(self, x: Any, state: Any) -> tuple[Any, Any]:
        """Scaled torque (B, T) at every sample of sequences (B, T, F), and the state after.

        Raises
        ------
        UsageError
            For a network without a state.
        """
        if self._gru is None:
            raise UsageError(f"{self.model.name} keeps no state; train it with --mode window.")
        states, state = self._gru(x, state)
        return self._layers[0](states).squeeze(2), state

    def weights(self) -> dict[str, WeightArray]:
        """Copies of the trained numbers, exact."""
        return {
            name: tensor.detach().cpu().numpy().astype(np.float32, copy=True)
            for name, tensor in self.tensors.items()
        }

    def load(self, weights: Mapping[str, WeightArray]) -> None:
        """Take the numbers of an artefact, exactly.

        Raises
        ------
        UsageError
            When they are those of another network.
        """
        torch = require_torch()
        own = self.tensors
        fits = set(own) == set(weights) and all(
            tuple(own[name].shape) == weights[name].shape for name in own
        )
        if not fits:
            raise UsageError(f"these weights are not those of {self.model.name}.")
        with torch.no_grad():
            for name, tensor in own.items():
                tensor.copy_(torch.from_numpy(np.array(weights[name], np.float32)))


def network_of(artefact: Artefact) -> Network:
    """The torch network of an artefact: scaled features in, scaled torque out."""
    same = {key: value for key, value in vars(artefact).items() if key in Model.__annotations__}
    network = Network(Model(**same), len(artefact.inputs), 0)
    network.load(artefact.weights)
    return network
