"""Bodies of a machine: parts, mass properties, and balance for one, two and three discs.

By default everything is a closed form or the catalogue's, so no CAD kernel is needed; mass
properties of the parts from meshes come with ``source=mass_properties``. The balance is that of
`Machine.balance`, the checks' own, whatever the source.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from cqdd_design.errors import GeometryError
from cqdd_design.gearbox.balance import StackBalance
from cqdd_design.machine.machine import Machine
from cqdd_design.solids.inertia import (
    GearboxInertia,
    MassSource,
    closed_form,
    gearbox_inertia,
)
from cqdd_design.solids.part import Part

DISC_COUNTS = (1, 2, 3)


@dataclass(frozen=True)
class Bodies:
    """The bodies of a gearbox.

    Attributes
    ----------
    inertia : GearboxInertia
        Mass properties of `parts`, in their order.
    balance : mapping of int to StackBalance
        Of the crank with one, two and three such discs, eccentrics included, at the required
        input speed; counterweights only with the design's own number. A number of discs with
        which the machine cannot be built is left out.
    """

    parts: tuple[Part, ...]
    inertia: GearboxInertia
    balance: Mapping[int, StackBalance]


def weigh(machine: Machine, source: MassSource = closed_form) -> Bodies:
    """Weigh the parts of a machine, and balance its crank for one, two and three discs.

    Parameters
    ----------
    source : callable
        Mass properties of one piece.

    Raises
    ------
    GeometryError
        When the parts cannot exist or cannot be put together, which a design that fails its
        checks may well do.
    """
    design, parts = machine.design, machine.parts
    meshed = source is not closed_form
    inertia = gearbox_inertia(design, machine.motor, parts, source) if meshed else machine.inertia
    balance = {}
    for count in DISC_COUNTS:
        stack = machine
        if count != design.reducer.disc_count:
            stack = machine.changed(
                {"reducer.disc_count": count, "reducer.balance.counterweights": False}
            )
            if not _can_be_built(stack):
                continue
        balance[count] = stack.balance
    return Bodies(parts, inertia, balance)


def _can_be_built(machine: Machine) -> bool:
    try:
        return bool(machine.parts)
    except GeometryError:
        return False


def weigh_if_possible(machine: Machine) -> tuple[Bodies | None, tuple[str, ...]]:
    """The bodies in closed form, or nothing and the sentence that says why not."""
    try:
        return weigh(machine), ()
    except GeometryError as error:
        return None, (f"No bill of materials, masses or inertia: {error.message}",)
