"""Bodies of a machine: parts, mass properties, and balance for one, two and three discs.

By default everything is a closed form or the catalogue's, so no CAD kernel is needed; the same
figures from meshes come with ``source=mass_properties``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from cqdd_design.errors import GeometryError
from cqdd_design.gearbox.balance import StackBalance, stack_balance
from cqdd_design.machine.machine import Machine
from cqdd_design.solids.inertia import (
    GearboxInertia,
    MassSource,
    closed_form,
    crank_properties,
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
        Of the crank with one, two and three such discs, shaft included, at the required input
        speed; counterweights only with the design's own number. A number of discs with which the
        machine cannot be built is left out.
    """

    parts: tuple[Part, ...]
    inertia: GearboxInertia
    balance: Mapping[int, StackBalance]


def weigh(machine: Machine, source: MassSource = closed_form) -> Bodies:
    """Weigh the parts of a machine, and balance its crank for one, two and three discs.

    Parameters
    ----------
    source : callable
        Mass properties of one piece; those of the other numbers of discs are closed forms.

    Raises
    ------
    GeometryError
        When the parts cannot exist or cannot be put together, which a design that fails its
        checks may well do.
    """
    design, reducer, parts = machine.design, machine.design.reducer, machine.parts
    meshed = source is not closed_form
    inertia = gearbox_inertia(design, machine.motor, parts, source) if meshed else machine.inertia
    balance = {}
    for count in DISC_COUNTS:
        if count == reducer.disc_count:
            crank = crank_properties(design, parts, source)
        else:
            variant = machine.changed(
                {"reducer.disc_count": count, "reducer.balance.counterweights": False}
            )
            try:
                crank = crank_properties(variant.design, variant.parts, closed_form)
            except GeometryError:
                continue
        balance[count] = stack_balance(
            inertia.orbiting_mass,
            reducer.eccentricity,
            reducer.disc_thickness,
            reducer.disc_spacing,
            count,
            design.requirements.input_speed,
            (crank,),
        )
    return Bodies(parts, inertia, balance)


def weigh_if_possible(machine: Machine) -> tuple[Bodies | None, tuple[str, ...]]:
    """The bodies in closed form, or nothing and the sentence that says why not."""
    try:
        return weigh(machine), ()
    except GeometryError as error:
        return None, (f"No bill of materials, masses or inertia: {error.message}",)
