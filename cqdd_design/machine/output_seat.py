"""What its seats and temperatures leave of the output bearing's clearance."""

from __future__ import annotations

from typing import NamedTuple

from cqdd_design.catalog.bearings import BEARING_MATERIAL, Bearing
from cqdd_design.catalog.internal_clearance import Clearance, clearances
from cqdd_design.catalog.materials import find_material
from cqdd_design.errors import CatalogError
from cqdd_design.gearbox.heat.expansion import REFERENCE
from cqdd_design.gearbox.seated import Seated, Wall, seated_clearance
from cqdd_design.machine.heat_nodes import by_node
from cqdd_design.machine.machine import Machine
from cqdd_design.machine.temperatures import MachineTemperatures
from cqdd_design.solids.features import zones


class SeatedState(NamedTuple):
    """The output bearing in one state.

    Attributes
    ----------
    carrier, housing : float
        Temperatures of its rings, deg C.
    seated : Seated
    """

    carrier: float
    housing: float
    seated: Seated


def ordered_clearance(bearing: Bearing, plate: str) -> Clearance:
    """The class to order: the tightest, on a plate that grows more than its ring the loosest.

    Parameters
    ----------
    plate : str
        Name of the plate's material.

    Raises
    ------
    CatalogError
        Where none is known, or how the plate grows.
    """
    every = clearances(bearing)
    if not every:
        raise CatalogError(f"clearances of a {bearing.designation} are not in the catalogue")
    return every[-1 if grows_more(plate) else 0]


def grows_more(plate: str) -> bool:
    """Whether a plate grows more with heat than the steel ring on it.

    Raises
    ------
    CatalogError
        Where that is not known.
    """
    mine, rings = find_material(plate).expansion, find_material(BEARING_MATERIAL).expansion
    if mine is None or rings is None:
        raise CatalogError(f"how '{plate}' grows with heat is not in the catalogue")
    return mine > rings


def seated_states(
    machine: Machine, warm: MachineTemperatures | None, plate_material: str = ""
) -> tuple[SeatedState, ...]:
    """As fitted, at the coldest start, and settled where temperatures are known.

    Parameters
    ----------
    plate_material : str
        Of the carrier plate, where it is to be another than that of the design.

    Raises
    ------
    CatalogError
        Where clearances, limits or expansions are not known.
    GeometryError
        When the machine cannot be laid out.
    """
    layout, design = machine.layout, machine.design
    row = layout.carrier.output.bearing
    plate = find_material(plate_material or design.carrier_material)
    cover = find_material(design.housing.material)
    chosen = ordered_clearance(row, plate.name)
    coldest = design.environment.coldest
    rings = [(REFERENCE, REFERENCE), (coldest, coldest)]
    if warm is not None:
        warmed = map(by_node, warm.states)
        rings += [(state["carrier"], state["housing"]) for state in warmed]
    return tuple(
        SeatedState(
            inner,
            outer,
            seated_clearance(
                row,
                chosen,
                Wall(zones.OUTPUT_JOURNAL, layout.shaft.support.lip_radius, plate, inner),
                Wall(zones.HOUSED, layout.housing.cover_hub_radius, cover, outer),
            ),
        )
        for inner, outer in rings
    )
