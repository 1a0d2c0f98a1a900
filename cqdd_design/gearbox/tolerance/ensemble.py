"""Ensembles of toleranced gearboxes: what is drawn, and how a block of them is worked."""

from __future__ import annotations

import functools
import threading
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from cqdd_design.design import Design
from cqdd_design.errors import UsageError
from cqdd_design.gearbox.bodies.made import bodies_or_none
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.heat.expansion import AS_DRAWN, PartTemperatures, growth_of, heated
from cqdd_design.gearbox.tolerance.draws import draw_errors
from cqdd_design.gearbox.tolerance.evaluate import (
    OUTPUTS,
    BodyCompliance,
    EnsembleTables,
    body_compliance,
    ensemble_tables,
    evaluate_gearboxes,
    turn_angles,
)
from cqdd_design.geometry.contours import FloatArray

_MOST_CONTACTS = 6_000_000
"""Contacts times angles that fit into memory comfortably: about half a gigabyte."""
_MOST_PAIRS = 30_000_000
"""Pairs of contacts of a disc times angles, likewise: a gigabyte."""


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
        What is found of every gearbox: `OUTPUTS`, or `LOADS`, `RANKED` or `FREEDOM` alone.
    at_rest : bool
        Whether friction is that of a gearbox that stands, without films.
    """

    design: Design
    bodies: Design | None
    torque: float
    angles: int
    seed: int
    temperatures: PartTemperatures = AS_DRAWN
    outputs: tuple[str, ...] = OUTPUTS
    at_rest: bool = False


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


def _tables(ensemble: Ensemble) -> EnsembleTables:
    """Of all outputs, which share them."""
    return _of_all(replace(ensemble, outputs=OUTPUTS))


@functools.lru_cache(maxsize=2)
def _of_all(ensemble: Ensemble) -> EnsembleTables:
    rigid = _rigid(replace(ensemble, bodies=None))
    if ensemble.bodies is None:
        return rigid
    yielding = _yielding(ensemble.bodies, ensemble.torque, ensemble.angles, ensemble.at_rest)
    return rigid.yielding(yielding)


@functools.lru_cache(maxsize=2)
def _rigid(ensemble: Ensemble) -> EnsembleTables:
    """Of rigid bodies; those that yield differ from it by that alone."""
    # What the kernels know of pins off their holes are errors of position, see `work_block`.
    model = replace(_warm(ensemble), pin_reach=0.0)
    return ensemble_tables(
        model,
        ensemble.torque,
        ensemble.angles,
        outputs=ensemble.outputs,
        at_rest=ensemble.at_rest,
    )


@functools.lru_cache(maxsize=2)
def _warm(ensemble: Ensemble) -> ContactModel:
    """The perfect gearbox."""
    drawn = ContactModel.from_design(ensemble.design)
    return heated(drawn, ensemble.design, ensemble.temperatures)


def _yielding(design: Design, torque: float, angles: int, at_rest: bool) -> BodyCompliance:
    """Other clearances of the same design share it; threads that ask at once wait for one."""
    with _one_at_a_time:
        return _last_yielding(design, torque, angles, at_rest)


_one_at_a_time = threading.Lock()


@functools.lru_cache(maxsize=2)
def _last_yielding(design: Design, torque: float, angles: int, at_rest: bool) -> BodyCompliance:
    model = ContactModel.from_design(design)
    bodies = bodies_or_none(design)
    assert bodies is not None, "`make_ensemble` leaves out bodies that cannot be meshed"
    return body_compliance(bodies, model, torque, angles, at_rest=at_rest)


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
    warm = _warm(replace(ensemble, bodies=None, outputs=OUTPUTS))
    angle = warm.hole_clocking + 2.0 * np.pi * np.arange(warm.pin_count) / warm.pin_count
    outward = warm.pin_reach * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    errors = errors._replace(pin_position=errors.pin_position + outward)
    return evaluate_gearboxes(tables, errors, outputs=ensemble.outputs)


def work_here(ensemble: Ensemble, blocks: list[Block]) -> Iterator[tuple[int, FloatArray]]:
    """Work blocks one after the other in this process, on all its cores."""
    for place, block in enumerate(blocks):
        yield place, work_block(ensemble, block)


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
    at_rest: bool = False,
) -> Ensemble:
    """Complete an ensemble: continuous torque, and about 1000 angles over the turn.

    Under a duty the torque that stands for it, :attr:`.Requirements.equal_torque`.

    Discs and ring yield where they can be meshed, and are rigid where they cannot, which the result
    says.

    Parameters
    ----------
    bodies : Design, optional
        Whose discs and ring yield, where another one's are near enough; default the design's own.
    temperatures : PartTemperatures
        Of the parts of all gearboxes.
    outputs : tuple of str
        `OUTPUTS`, or `LOADS` or `FREEDOM` where nothing else is asked, in less time.
    rigid : bool
        Whether discs and ring do not yield although they could.
    at_rest : bool
        Whether friction is that of a gearbox that stands, without films.

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
    load = design.requirements.equal_torque if torque is None else torque
    yielding: Design | None = bodies or design
    pairs = wanted * contacts**2 / reducer.disc_count
    if rigid or pairs > _MOST_PAIRS or bodies_or_none(bodies or design) is None:
        yielding = None
    growth_of(design, temperatures)
    return Ensemble(design, yielding, load, wanted, seed, temperatures, outputs, at_rest)
