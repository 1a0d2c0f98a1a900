"""Ensembles of toleranced gearboxes: distributions, and which tolerance they come from."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cqdd_design.design import Design
from cqdd_design.errors import UsageError
from cqdd_design.gearbox.bodies.made import bodies_or_none
from cqdd_design.gearbox.checks.allowables import BINDING_SHARE
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.heat.expansion import AS_DRAWN, PartTemperatures, growth_of, heated
from cqdd_design.gearbox.tolerance.draws import GROUPS, draw_errors
from cqdd_design.gearbox.tolerance.evaluate import (
    OUTPUTS,
    BodyCompliance,
    EnsembleTables,
    body_compliance,
    ensemble_tables,
    evaluate_gearboxes,
    marked_angles,
    turn_angles,
)
from cqdd_design.gearbox.tolerance.limits import limits
from cqdd_design.gearbox.tolerance.sobol import SobolIndices, sobol_indices
from cqdd_design.geometry.contours import FloatArray

BLOCK = 125
"""Gearboxes worked at a time: about a third of a second on four cores."""
_SENSITIVITY_SHARE, _LEAST_BASE = 8, 16
"""The sensitivity's base sample is an eighth of the ensemble, because every tolerance needs it
once more; with fewer than this many gearboxes it would say nothing and is left out."""
_MOST_CONTACTS = 6_000_000
"""Contacts times angles that fit into memory comfortably: about half a gigabyte."""
_MOST_PAIRS = 30_000_000
"""Pairs of contacts of a disc times angles, likewise: a gigabyte."""

_BEYOND = {
    "unloaded_torque_Nm": f"bind: without load they take more than {BINDING_SHARE:.0%} of the "
    "continuous torque to turn",
    "ring_pressure_max_MPa": "press their ring harder at this torque than lasts the required hours",
    "cam_bearing_load_max_N": "load a cam bearing harder at this torque than lasts the required "
    "hours",
}

_PERCENTILES = {"p5": 5.0, "p50": 50.0, "p95": 95.0, "p99": 99.0}


@dataclass(frozen=True)
class Ensemble:
    """What is drawn and solved; two equal ensembles give the same numbers anywhere.

    Attributes
    ----------
    design : Design
        With its cam bearing named.
    bodies : Design or None
        Whose discs and ring yield; None where bodies are rigid.
    torque : float
        N m.
    angles : int
        Crank angles over the output turn.
    seed : int
    temperatures : PartTemperatures
    outputs : tuple of str
        What is found of every gearbox: `OUTPUTS`, or `LOADS` alone.
    """

    design: Design
    bodies: Design | None
    torque: float
    angles: int
    seed: int
    temperatures: PartTemperatures = AS_DRAWN
    outputs: tuple[str, ...] = OUTPUTS


@dataclass(frozen=True)
class Block:
    """Some gearboxes of an ensemble, with one tolerance perhaps from the second draw.

    Attributes
    ----------
    first, count : int
        Gearboxes by number.
    exchanged : tuple of str
        Tolerances from the second draw.
    """

    first: int
    count: int
    exchanged: tuple[str, ...] = ()


Mapper = Callable[[Ensemble, list[Block]], Iterable[tuple[int, FloatArray]]]
"""Works blocks in any order and yields (place of the block, its values)."""
Progress = Callable[[int, int], None]


@functools.lru_cache(maxsize=2)
def _tables(ensemble: Ensemble) -> EnsembleTables:
    warm = _warm(ensemble)
    # What the kernels know of pins off their holes are errors of position, see `work_block`.
    model = replace(warm, pin_reach=0.0)
    bodies = None
    if ensemble.bodies is not None:
        bodies = _yielding(ensemble.bodies, ensemble.torque, ensemble.angles)
    return ensemble_tables(model, ensemble.torque, ensemble.angles, bodies)


@functools.lru_cache(maxsize=2)
def _warm(ensemble: Ensemble) -> ContactModel:
    """The perfect gearbox."""
    drawn = ContactModel.from_design(ensemble.design)
    return heated(drawn, ensemble.design, ensemble.temperatures)


@functools.lru_cache(maxsize=1)
def _yielding(design: Design, torque: float, angles: int) -> BodyCompliance:
    """Other clearances of the same design share it."""
    model = ContactModel.from_design(design)
    bodies = bodies_or_none(design)
    assert bodies is not None, "`make_ensemble` leaves out bodies that cannot be meshed"
    return body_compliance(bodies, model, torque, angles)


def work_block(ensemble: Ensemble, block: Block) -> FloatArray:
    """Values (count, 9) of a block of gearboxes, in the order and units of its outputs."""
    tables = _tables(ensemble)
    errors = draw_errors(
        tables.model,
        ensemble.design.tolerances,
        ensemble.seed,
        block.first,
        block.count,
        dict.fromkeys(block.exchanged, 1),
    )
    warm = _warm(ensemble)
    angle = warm.hole_clocking + 2.0 * np.pi * np.arange(warm.pin_count) / warm.pin_count
    outward = warm.pin_reach * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    errors = errors._replace(pin_position=errors.pin_position + outward)
    return evaluate_gearboxes(tables, errors, outputs=ensemble.outputs)


def work_here(ensemble: Ensemble, blocks: list[Block]) -> Iterator[tuple[int, FloatArray]]:
    """Work blocks one after the other in this process, on all its cores."""
    for place, block in enumerate(blocks):
        yield place, work_block(ensemble, block)


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
    sensitivity : tuple of SobolIndices or None
        Of every output over `GROUPS`; None where it was not computed.
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
    sensitivity: tuple[SobolIndices, ...] | None
    base: int
    lost: int
    solves: int
    seconds: float
    interrupted: bool

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
        indices = self.sensitivity[self.ensemble.outputs.index(output)]
        rows = zip(GROUPS, indices.first.tolist(), indices.total.tolist(), strict=True)
        return sorted(rows, key=lambda row: -row[2])

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the figures leave out."""
        if self.interrupted:
            done = len(self.values)
            return (f"interrupted after {done} of {self.asked} gearboxes; these are kept.",)
        told = list(self.ensemble.temperatures.beyond(self.ensemble.design))
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
            for output, indices in zip(self.ensemble.outputs, self.sensitivity, strict=True)
        }


def _distribution(values: FloatArray) -> dict[str, float]:
    spread = float(values.std(ddof=1)) if len(values) > 1 else 0.0
    return {"mean": float(values.mean()), "std": spread} | {
        key: float(np.percentile(values, share)) for key, share in _PERCENTILES.items()
    }


def make_ensemble(
    design: Design,
    *,
    torque: float | None = None,
    angles: int | None = None,
    seed: int = 0,
    bodies: Design | None = None,
    temperatures: PartTemperatures = AS_DRAWN,
    outputs: tuple[str, ...] = OUTPUTS,
    rigid: bool = False,
) -> Ensemble:
    """Complete an ensemble: continuous torque, and about 1000 angles over the turn.

    Discs and ring yield where they can be meshed, and are rigid where they cannot, which the result
    says.

    Parameters
    ----------
    bodies : Design, optional
        Whose discs and ring yield, where another one's are near enough; default the design's own.
    temperatures : PartTemperatures
        Of the parts of all gearboxes.
    outputs : tuple of str
        `OUTPUTS`, or `LOADS` where nothing else is asked, which takes a quarter of the time.
    rigid : bool
        Whether discs and ring do not yield although they could.

    Raises
    ------
    DesignError
        When the thermal expansion of a part is not known.
    UsageError
        When the angles do not fit into memory.
    """
    reducer = design.reducer
    wanted = turn_angles(reducer.ratio) if angles is None else angles
    contacts = reducer.disc_count * (reducer.ratio + 1 + reducer.output_pins.count)
    if wanted * contacts > _MOST_CONTACTS:
        raise UsageError(
            f"{wanted} angles on {contacts} contacts are too many for memory; take at most "
            f"--angles {_MOST_CONTACTS // contacts}."
        )
    load = design.requirements.continuous_torque if torque is None else torque
    yielding: Design | None = bodies or design
    pairs = wanted * contacts**2 / reducer.disc_count
    if rigid or pairs > _MOST_PAIRS or bodies_or_none(bodies or design) is None:
        yielding = None
    growth_of(design, temperatures)
    return Ensemble(design, yielding, load, wanted, seed, temperatures, outputs)


def run_ensemble(
    ensemble: Ensemble,
    samples: int = 1000,
    *,
    mapper: Mapper = work_here,
    progress: Progress | None = None,
    sensitivity: bool = True,
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
    extra = [GROUPS, *((name,) for name in GROUPS)] if base else []
    blocks = _blocks(samples, ())
    for exchanged in extra:
        blocks += _blocks(base, tuple(exchanged))
    total = sum(block.count for block in blocks)
    found: list[FloatArray | None] = [None] * len(blocks)
    done, interrupted = 0, False
    began = time.perf_counter()
    try:
        for place, values in mapper(ensemble, blocks):
            found[place] = values
            done += len(values)
            if progress is not None:
                progress(done, total)
    except KeyboardInterrupt:
        interrupted = True
    main = len(_blocks(samples, ()))
    values = np.concatenate(
        [v for v in found[:main] if v is not None] or [np.empty((0, len(ensemble.outputs)))]
    )
    indices = None
    if base and not interrupted:
        indices = _sensitivity(values[:base], found[main:], base)
    coarse = 0
    if ensemble.outputs == OUTPUTS:
        coarse = int(marked_angles(ensemble.design.reducer.ratio, ensemble.angles).sum())
    jams = np.isnan(values).any(axis=1)
    return ToleranceResult(
        ensemble=ensemble,
        asked=samples,
        values=values[~jams],
        numbers=np.flatnonzero(~jams),
        sensitivity=indices,
        base=base,
        lost=int(jams.sum()),
        solves=done * (ensemble.angles + coarse),
        seconds=time.perf_counter() - began,
        interrupted=interrupted,
    )


def _blocks(count: int, exchanged: tuple[str, ...]) -> list[Block]:
    return [Block(first, min(BLOCK, count - first), exchanged) for first in range(0, count, BLOCK)]


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
