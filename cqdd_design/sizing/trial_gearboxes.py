"""A few toleranced gearboxes of a design that a search looks at, quicker than a verdict's."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from cqdd_design.gearbox.tolerance.evaluate import OUTPUTS
from cqdd_design.gearbox.tolerance.run import FIRST, ToleranceResult
from cqdd_design.machine import Machine
from cqdd_design.machine.temperatures import known_temperatures
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.plates import needs_steel
from cqdd_design.verdict.drawn import Drawn, drawn_gearboxes

TRIAL_SAMPLES = FIRST
_ALIKE = 1.25
"""Ratio of the thickness of discs, or of torques, up to which they are taken to yield alike."""


@contextmanager
def drawing_ahead(machine: Machine) -> Iterator[None]:
    """Draw the first gearboxes of `last_look` beside other looks: they are kept for it.

    What is wrong with them it finds and tells itself.
    """
    with ThreadPoolExecutor(1) as beside:
        beside.submit(drawn_gearboxes, machine, TRIAL_SAMPLES, sensitivity=False)
        yield


def drawn_alike(hunt: Hunt, machine: Machine) -> Drawn:
    """A few gearboxes, whose discs and ring yield as they did at another design of the hunt.

    The finite elements of a new geometry cost more than all else here, and what yielding changes,
    as a share, is alike for designs of one hunt with discs of about the same thickness and for
    about the same torques.
    """
    rigid_machine = machine.rigid
    # A carrier that becomes one of steel takes no clearance.
    steel = needs_steel(rigid_machine)
    warm = partial(known_temperatures, rigid_machine) if not steel else _unknown
    new = hunt.yielding is None or not _yield_alike(hunt.yielding_at, _yielding_at(machine))
    with ThreadPoolExecutor(1) as beside:
        if new:
            # They are asked for next, and rigid gearboxes leave Python to them.
            beside.submit(getattr, machine, "bodies")
        rigid = drawn_gearboxes(machine, TRIAL_SAMPLES, sensitivity=False, rigid=True, warm=warm)
    hunt.rigid = machine, tuple(map(_high, rigid[:2]))
    if new:
        found = drawn_gearboxes(machine, TRIAL_SAMPLES, sensitivity=False, warm=warm)
        calibrate(hunt, machine, found)
        return found
    assert hunt.yielding is not None
    shares = list(hunt.yielding)
    if rigid.warm is not None:
        # Warm gearboxes yield as those do that are under the same torque.
        columns = [OUTPUTS.index(name) for name in rigid.warm.ensemble.outputs]
        shares.append(hunt.yielding[0][columns])
    both = zip(rigid.every, shares, strict=True)
    return Drawn(*(replace(one, values=one.values * share) for one, share in both))


def _unknown() -> None:
    """Temperatures that are not asked for."""


def _yielding_at(machine: Machine) -> tuple[float, ...]:
    """What of a design decides most of how its bodies yield: thickness of its discs, m, torques."""
    asked = machine.design.requirements
    return machine.design.reducer.disc_thickness, asked.peak_torque, asked.continuous_torque


def _yield_alike(one: tuple[float, ...], other: tuple[float, ...]) -> bool:
    ratios = (mine / theirs for mine, theirs in zip(one, other, strict=True))
    return all(1.0 / _ALIKE <= ratio <= _ALIKE for ratio in ratios)


def calibrate(hunt: Hunt, machine: Machine, drawn: Drawn) -> None:
    """Note what yielding discs and ring change, where a machine was looked at without them too.

    Nothing of what none of the rigid ones has, such as a torque that turns free ones unloaded.
    """
    if hunt.rigid is None or hunt.rigid[0].design != machine.design:
        return
    hunt.yielding_at = _yielding_at(machine)
    hunt.yielding = tuple(
        np.where(other, _high(one), 1.0) / np.where(other, other, 1.0)
        for one, other in zip(drawn[:2], hunt.rigid[1], strict=True)
    )


def _high(result: ToleranceResult) -> NDArray[np.float64]:
    """What 95 % of the gearboxes stay below, of every output."""
    return np.quantile(result.values, 0.95, axis=0)
