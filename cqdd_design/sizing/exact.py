"""What closed forms are short of: torque reserves of a design by the contact equilibrium."""

from __future__ import annotations

from collections.abc import Iterable

from cqdd_design.gearbox.checks.equilibrium import PeakLoads, lasting_checks, peak_checks
from cqdd_design.machine import Machine
from cqdd_design.results import Check
from cqdd_design.sizing.finish import LOAD_CHECKS, torque_reserve


def exact_checks(machine: Machine) -> tuple[Check, ...]:
    """Load lines of a machine with rigid discs and ring.

    Elastic ones press their teeth a few per cent less, and a new geometry's finite elements take
    longer than everything else here.

    Raises
    ------
    ContactError
        When the gearbox has no equilibrium at a load.
    """
    return yielding_checks(machine.rigid)


def yielding_checks(machine: Machine) -> tuple[Check, ...]:
    """As `exact_checks`, with discs and ring that yield: the verdict's own.

    Raises
    ------
    ContactError
        When the gearbox has no equilibrium at a load.
    """
    peak, state = machine.design.requirements.peak_torque, machine.analysis
    loads = PeakLoads.of(peak, machine.loaded_contacts.greatest(peak))
    return (*peak_checks(state, loads), *lasting_checks(state, machine.life))


def shortfalls(machine: Machine, checks: Iterable[Check]) -> dict[str, float]:
    """Torque reserve by closed forms over that by the equilibrium, by load check.

    Parameters
    ----------
    checks : iterable of Check
        Of the equilibrium, from `exact_checks`.
    """
    exact = {one.id: one for one in checks if one.known}
    return {
        one.id: torque_reserve(one, machine.design) / torque_reserve(exact[one.id], machine.design)
        for one in machine.analysis.checks
        if one.id in LOAD_CHECKS and one.id in exact
    }
