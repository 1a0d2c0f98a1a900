"""What closes a machine to dust and keeps its grease in, and what does not."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cqdd_design.machine.machine import Machine

if TYPE_CHECKING:
    from cqdd_design.solids.layout import GapSeal


def bearing_seals(machine: Machine) -> str:
    """How support and output bearings are ordered."""
    if machine.design.reducer.friction.seals == "contact":
        return "with contact seals on both sides"
    return "open, not sealed"


def sealing(machine: Machine) -> str:
    """What is sealed and how, in two sentences.

    Raises
    ------
    GeometryError
        When the machine cannot be laid out.
    """
    housing = machine.layout.housing
    gaps = (
        f"a gap of {_told(housing.output_seal)} between bearing nut and cover, and one of "
        f"{_told(housing.shaft_seal)} between shaft and housing"
    )
    if machine.design.reducer.friction.seals == "contact":
        return (
            "Sealed by its bearings: shaft and output bearings have contact seals on both sides, "
            f"whose drag is counted; outside them stand gap seals without friction, {gaps}. The "
            "flanges' faces have no seal."
        )
    return (
        f"Gap seals, without friction: {gaps}, keep grease in and coarse dust out. Nothing keeps "
        "fine dust and water out: sealed bearings (reducer.friction.seals) would, and the "
        "flanges' faces have no seal."
    )


def _told(seal: GapSeal) -> str:
    return f"{1e3 * seal.gap:.2g} mm, {1e3 * seal.length:.2g} mm long,"
