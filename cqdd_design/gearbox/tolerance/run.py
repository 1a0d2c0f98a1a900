"""Running an ensemble of gearboxes: distributions, and which tolerance they come from."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cqdd_design.errors import UsageError
from cqdd_design.gearbox.checks.allowables import BINDING_SHARE
from cqdd_design.gearbox.tolerance.draws import GROUPS
from cqdd_design.gearbox.tolerance.ensemble import Block, Ensemble, Mapper, work_here
from cqdd_design.gearbox.tolerance.evaluate import FREEDOM, OUTPUTS, marked_angles, thinned_angles
from cqdd_design.gearbox.tolerance.limits import limits
from cqdd_design.gearbox.tolerance.sobol import SobolIndices, sobol_indices
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.results import read_only

Progress = Callable[[int, int], None]

BLOCK = 125
"""Gearboxes worked at a time: about a third of a second on four cores."""
FIRST = 32
"""Those worked before the rest of the first block: whoever looks at so few has a part of it."""
_SENSITIVITY_SHARE, _LEAST_BASE = 8, 16
"""The sensitivity's base sample is an eighth of the ensemble, because every tolerance needs it
once more; with fewer than this many gearboxes it would say nothing and is left out."""

_BEYOND = {
    "unloaded_torque_Nm": f"bind: without load they take more than {BINDING_SHARE:.0%} of the "
    "continuous torque to turn",
    "ring_pressure_max_MPa": "press their ring harder at this torque than lasts the required hours",
    "cam_bearing_load_max_N": "load a cam bearing harder at this torque than lasts the required "
    "hours",
}

_PERCENTILES = {"p5": 5.0, "p50": 50.0, "p95": 95.0, "p99": 99.0}


@dataclass(frozen=True, eq=False)
class ToleranceResult:
    """Distributions of toleranced gearboxes.

    Attributes
    ----------
    asked : int
        Gearboxes asked for.
    values : array (S, 9)
        Of every gearbox that was solved, in the order and units of the ensemble's outputs.
    numbers : array (S,)
        Which of the drawn gearboxes these are.
    sensitivity : dict of SobolIndices or None
        By output, over `GROUPS`; None where it was not computed.
    base : int
        Size of the sensitivity's base sample.
    lost : int
        Gearboxes without an equilibrium at some angle, of those that were worked.
    solves : int
        Equilibria under load.
    seconds : float
    interrupted : bool
        Whether it was stopped before the end; `values` then holds what was done.
    """

    ensemble: Ensemble
    asked: int
    values: FloatArray
    numbers: NDArray[np.intp]
    sensitivity: dict[str, SobolIndices] | None
    base: int
    lost: int
    solves: int
    seconds: float
    interrupted: bool

    def __post_init__(self) -> None:
        """Let nobody change what statistics are of."""
        object.__setattr__(self, "values", read_only(self.values))
        object.__setattr__(self, "numbers", read_only(self.numbers))

    def first(self, count: int) -> ToleranceResult:
        """The same result of the first `count` gearboxes alone."""
        some = self.numbers < count
        numbers = self.numbers[some]
        return replace(
            self, asked=count, values=self.values[some], numbers=numbers, lost=count - len(numbers)
        )

    def statistics(self) -> dict[str, dict[str, float]]:
        """Mean, standard deviation and percentiles of every output."""
        return {name: _distribution(column) for name, column in self.columns.items()}

    @property
    def columns(self) -> dict[str, FloatArray]:
        """The values (S,) of every gearbox that was solved, by output."""
        return dict(zip(self.ensemble.outputs, self.values.T, strict=True))

    @property
    def limits(self) -> dict[str, float]:
        """Limits by output, of those that have one."""
        return limits(self.ensemble.design)

    def beyond(self) -> dict[str, float]:
        """Share of the gearboxes that are beyond a limit, by output."""
        found = self.columns
        return {
            name: float(np.mean(found[name] > limit))
            for name, limit in self.limits.items()
            if name in found
        }

    def pressure_reserve(self) -> dict[str, float] | None:
        """Pressure that lasts the required hours over the greatest one; None where not known.

        Percentiles of gearboxes from the least reserve up; below 1 a ring does not last.
        """
        name = "ring_pressure_max_MPa"
        if name not in self.limits or not len(self.values):
            return None
        reserve = self.limits[name] / self.columns[name]
        return _distribution(reserve)

    def ranking(self, output: str) -> list[tuple[str, float, float]]:
        """Tolerances with their first-order and total shares of one output, largest total first."""
        if self.sensitivity is None:
            return []
        indices = self.sensitivity[output]
        rows = zip(GROUPS, indices.first.tolist(), indices.total.tolist(), strict=True)
        return sorted(rows, key=lambda row: -row[2])

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the figures leave out."""
        if self.interrupted:
            done = len(self.values)
            return (f"interrupted after {done} of {self.asked} gearboxes; these are kept.",)
        told = list(self.ensemble.temperatures.beyond(self.ensemble.design))
        teeth = self.ensemble.design.reducer.ratio * (self.ensemble.design.reducer.ratio + 1)
        if self.ensemble.angles < teeth:
            told.append(
                f"{self.ensemble.angles} angles are fewer than one a tooth ({teeth}): forces, "
                f"ripple and the share that binds come out too low; take --angles {2 * teeth}."
            )
        if self.lost:
            told.append(
                f"for {self.lost} of {self.asked} gearboxes no forces were found that carry the "
                "torque at every angle while the contacts slide: they jam, or are beyond the "
                "solver. The figures are of the others."
            )
        if self.ensemble.bodies is None:
            told.append(
                "discs and ring count as rigid, because they cannot be meshed or have too many "
                "contacts for memory; that makes too much of what part errors do."
            )
        beyond = self.beyond()
        for name, words in _BEYOND.items():
            if beyond.get(name, 0.0) > 0.0:
                told.append(f"{beyond[name]:.1%} of the gearboxes {words}.")
        if self.sensitivity is None:
            least = _LEAST_BASE * _SENSITIVITY_SHARE
            told.append(f"no sensitivity: it needs at least {least} gearboxes.")
        return tuple(told)

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form (``results`` of ``tolerance``)."""
        body: dict[str, object] = dict(self.statistics()) if len(self.values) else {}
        for name, key in (
            ("sensitivity", "first"),
            ("sensitivity_total", "total"),
            ("sensitivity_first_half_width", "first_half_width"),
            ("sensitivity_total_half_width", "total_half_width"),
        ):
            body[name] = self._by_output(key)
        return body | {
            "samples": len(self.values),
            "samples_asked": self.asked,
            "samples_without_equilibrium": self.lost,
            "sensitivity_base": self.base,
            "angles": self.ensemble.angles,
            "torque_Nm": self.ensemble.torque,
            "temperatures_degC": vars(self.ensemble.temperatures),
            "friction": "drive",
            "bodies": "rigid" if self.ensemble.bodies is None else "elastic",
            "limits": self.limits,
            "share_beyond_limit": self.beyond() if len(self.values) else None,
            "pressure_reserve": self.pressure_reserve(),
            "seed": self.ensemble.seed,
            "solves": self.solves,
            "seconds": self.seconds,
            "interrupted": self.interrupted,
        }

    def _by_output(self, key: str) -> dict[str, dict[str, float]] | None:
        if self.sensitivity is None:
            return None
        return {
            output: dict(zip(GROUPS, getattr(indices, key).tolist(), strict=True))
            for output, indices in self.sensitivity.items()
        }


def _distribution(values: FloatArray) -> dict[str, float]:
    spread = float(values.std(ddof=1)) if len(values) > 1 else 0.0
    return {"mean": float(values.mean()), "std": spread} | {
        key: float(np.percentile(values, share)) for key, share in _PERCENTILES.items()
    }


def run_ensemble(
    ensemble: Ensemble,
    samples: int = 1000,
    *,
    mapper: Mapper = work_here,
    progress: Progress | None = None,
    sensitivity: bool = True,
    ranked: tuple[str, ...] = OUTPUTS,
) -> ToleranceResult:
    """Draw and solve an ensemble.

    Parameters
    ----------
    ensemble : Ensemble
        From :func:`make_ensemble`.
    samples : int
        Gearboxes, 1 or more.
    mapper : callable
        Who works the blocks; default this process.
    progress : callable, optional
        Told how many gearboxes are done, of how many.
    sensitivity : bool
        Whether to rank the tolerances too, on a base sample of an eighth of the gearboxes.
    ranked : tuple of str
        By which outputs: `OUTPUTS`, or `RANKED` alone.

    Returns
    -------
    ToleranceResult
        Also after Ctrl-C, with the gearboxes that were done.

    Raises
    ------
    UsageError
        For less than one gearbox.
    ContactError
        When a gearbox has no equilibrium.
    """
    if samples < 1:
        raise UsageError(f"{samples} gearboxes are no ensemble; ask for at least 1.")
    base = samples // _SENSITIVITY_SHARE if sensitivity else 0
    base = base if base >= _LEAST_BASE else 0
    blocks, others = _blocks(samples, ()), []
    for exchanged in [GROUPS, *((name,) for name in GROUPS)] if base else []:
        others += _blocks(base, tuple(exchanged))
    total = sum(block.count for block in (*blocks, *others))
    found: list[FloatArray | None] = [None] * len(blocks)
    again: list[FloatArray | None] = [None] * len(others)
    done, solves, interrupted = 0, 0, False
    began = time.perf_counter()
    try:
        for one, these, into in (
            (ensemble, blocks, found),
            (replace(ensemble, outputs=ranked), others, again),
        ):
            for place, values in mapper(one, these) if these else ():
                into[place] = values
                done += len(values)
                solves += len(values) * _solves(one)
                if progress is not None:
                    progress(done, total)
    except KeyboardInterrupt:
        interrupted = True
    values = np.concatenate(
        [v for v in found if v is not None] or [np.empty((0, len(ensemble.outputs)))]
    )
    indices = None
    if base and not interrupted:
        columns = [ensemble.outputs.index(name) for name in ranked]
        indices = dict(zip(ranked, _sensitivity(values[:base, columns], again, base), strict=True))
    jams = np.isnan(values).any(axis=1)
    return ToleranceResult(
        ensemble=ensemble,
        asked=samples,
        values=values[~jams],
        numbers=np.flatnonzero(~jams),
        sensitivity=indices,
        base=base,
        lost=int(jams.sum()),
        solves=solves,
        seconds=time.perf_counter() - began,
        interrupted=interrupted,
    )


def _solves(ensemble: Ensemble) -> int:
    """Equilibria under load of one gearbox, at most."""
    marked = int(marked_angles(ensemble.design.reducer.ratio, ensemble.angles).sum())
    if ensemble.outputs == FREEDOM:
        return marked
    wound = int(thinned_angles(marked).sum()) if ensemble.outputs == OUTPUTS else 0
    return ensemble.angles + wound


def _blocks(count: int, exchanged: tuple[str, ...]) -> list[Block]:
    few = () if exchanged else (FIRST,)
    begins = [one for one in (0, *few, *range(BLOCK, count, BLOCK)) if one < count]
    ends = [*begins[1:], count]
    return [Block(b, e - b, exchanged) for b, e in zip(begins, ends, strict=True)]


def _sensitivity(
    a: FloatArray, found: list[FloatArray | None], base: int
) -> tuple[SobolIndices, ...]:
    """Indices of every output from the blocks of B and of every AB_i."""
    rest = np.concatenate([values for values in found if values is not None])
    outputs = a.shape[1]
    several = rest.reshape(1 + len(GROUPS), base, outputs)
    known = ~(np.isnan(a).any(axis=1) | np.isnan(several).any(axis=(0, 2)))
    a, several = a[known], several[:, known]
    return tuple(
        sobol_indices(a[:, k], several[0, :, k], several[1:, :, k]) for k in range(outputs)
    )
