"""The paper's own scores, of its hardware: to stand beside ours, never to be read against them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class PaperRow:
    """A model in the paper's Table II, measured on its hardware.

    Attributes
    ----------
    model : str
        By our name of it.
    title : str
    rmse : float
        N m.
    variance : float
        Printed there in N m; N^2 m^2 by its meaning.
    cycle_time : float
        us.
    """

    model: str
    title: str
    rmse: float
    variance: float
    cycle_time: float

    @property
    def bias(self) -> float | None:
        """Size of the bias that the other two imply, N m; None where they contradict."""
        square = self.rmse**2 - self.variance
        return square**0.5 if square >= 0.0 else None

    def cells(self, none: str) -> list[str]:
        """Title, RMSE, bias, variance and cycle time as text; `none` where there is no bias."""
        numbers = (self.rmse, self.bias, self.variance, self.cycle_time)
        return [self.title, *(none if one is None else f"{one:.2f}" for one in numbers)]


PAPER_SOURCE = "C-QDD paper, Table II and section IV-A (hardware)"
PAPER: tuple[PaperRow, ...] = (
    PaperRow("pva-gru", "PVA-GRU", 0.97, 0.92, 1.49),
    PaperRow("pv-gru", "PV-GRU", 1.00, 0.85, 3.10),
    PaperRow("mlp", "MLP (tuned)", 1.71, 2.90, 0.72),
    PaperRow("mlp-baseline", "MLP (baseline)", 2.46, 3.62, 0.22),
)
