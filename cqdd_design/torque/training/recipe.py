"""How a network is trained: what can be chosen, and how it went."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import get_args

from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.errors import UsageError
from cqdd_design.torque.networks.artefact import Mode
from cqdd_design.torque.training.schedule import Reading, peak_rate

MODES: tuple[Mode, ...] = get_args(Mode)


@dataclass(frozen=True)
class Recipe:
    """What can be chosen.

    Attributes
    ----------
    epochs : int
        The paper does not say how many.
    batch : int
        Windows in a step; the paper's is 64. When streaming, a quarter of it in sequences.
    stride : int
        Every how many-th window is trained on in an epoch; the next epoch begins one sample later.
    mode : {"window", "streaming"}
        From a zero state over each window, as the paper; or with the state kept along the episode,
        the gradient cut every `CHUNK` samples.
    reading : {"max", "initial", "ours"}
        Of the paper's learning rate, or our own rate; see `schedule`.
    patience : int
        Epochs without a better validation RMSE after which training stops; 0 never stops.
    points, order : int
        Of the differentiator.
    orders : int
        Of the gearbox's, where its phases are inputs.
    threads : int
        Of the CPU. Such small networks are not faster with two, and more threads than free cores
        slow them down a hundredfold; train several seeds side by side instead.
    """

    epochs: int = 20
    batch: int = 64
    stride: int = 2
    mode: Mode = "window"
    reading: Reading = "initial"
    patience: int = 8
    points: int = 5
    order: int = 2
    orders: int = 4
    threads: int = 1

    def __post_init__(self) -> None:
        """Refuse what trains nothing."""
        limits = {
            "epochs": (1, 10_000),
            "batch": (1, 65_536),
            "stride": (1, 1000),
            "patience": (0, 10_000),
            "orders": (1, 64),
            "threads": (1, 256),
        }
        for name, (least, most) in limits.items():
            value = getattr(self, name)
            if not least <= value <= most:
                raise UsageError(f"{name} {value} is not within {least} to {most}.")
        if self.mode not in MODES:
            raise UsageError(f"there is no mode '{self.mode}'; there are {' and '.join(MODES)}.")
        peak_rate(self.reading)


@dataclass(frozen=True)
class Choice:
    """What is searched for the tuned MLP, and what the others have by the recipe.

    Attributes
    ----------
    activation : str
        Empty for a GRU.
    peak : float
        Of the learning rate.
    weight_decay : float
        Decoupled (Loshchilov and Hutter 2019); 0 is Adam.
    """

    activation: str
    peak: float
    weight_decay: float = 0.0


@dataclass(frozen=True, eq=False)
class Order:
    """One training.

    Attributes
    ----------
    model : str
        Of `modules.MODELS`.
    seed : int
        Of weights and order; on one CPU with one number of threads the result is the same to the
        last bit.
    actuator : ActuatorParameters or None
        For models that need one; stored in the artefact's facts under the data's gains.
    choice : Choice or None
        For a searched model, instead of the search; see `search`.
    device : str
        ``auto``, ``cpu`` or ``cuda``.
    """

    model: str
    seed: int = 0
    recipe: Recipe = field(default_factory=Recipe)
    actuator: ActuatorParameters | None = None
    choice: Choice | None = None
    device: str = "auto"

    def __post_init__(self) -> None:
        """Refuse a seed that numpy and torch do not both take."""
        if not 0 <= self.seed < 2**63:
            raise UsageError(f"seed {self.seed} is not within 0 to 2^63 - 1.")


@dataclass(frozen=True)
class EpochResult:
    """How an epoch went; RMSE in N m, best the least validation RMSE by then."""

    epoch: int
    epochs: int
    training_rmse: float
    validation_rmse: float
    best_rmse: float
    seconds: float

    @property
    def line(self) -> str:
        """For a log."""
        return (
            f"epoch {self.epoch} of {self.epochs}: RMSE {self.training_rmse:.3f} N*m in training, "
            f"{self.validation_rmse:.3f} in validation (best {self.best_rmse:.3f}), "
            f"{self.seconds:.1f} s"
        )

    @property
    def left(self) -> float:
        """Seconds that the epochs after it take at most, as long as it each."""
        return self.seconds * (self.epochs - self.epoch)


Progress = Callable[[EpochResult], None]
