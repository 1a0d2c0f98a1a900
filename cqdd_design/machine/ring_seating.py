"""How the ring is put into its seat, and what the clamp leaves it along the axis."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from cqdd_design.catalog.adhesives import RING_COMPOUND, ROTOR_COMPOUND
from cqdd_design.catalog.fits import fit_limits
from cqdd_design.catalog.materials import find_material
from cqdd_design.catalog.printing import printed_materials
from cqdd_design.errors import CatalogError
from cqdd_design.solids.axial import ring_stack
from cqdd_design.solids.features import zones

if TYPE_CHECKING:
    from cqdd_design.machine.machine import Machine

_MM = 1e3
_ROOM = 20e-6
"""By which the warm seat is wider than the widest ring, m: it drops in."""
_DRAWN, _STEP, _WARMEST = 20.0, 10.0, 120.0
"""deg C: at which sizes hold (ISO 1), to which the warmth is rounded up, and that an oven gives
without harm to a heat-treated aluminium (artificial ageing begins above it)."""


def ring_seating(machine: Machine) -> str:
    """In sentences: warmth, compound, guide, and the play to measure.

    Raises
    ------
    GeometryError
        When the machine cannot be laid out.
    """
    pack, dowels = machine.layout.pack, machine.layout.dowels
    seat = f"\u00d8{2.0 * _MM * pack.ring_radius:.5g} {zones.RING_SEAT}/{zones.RING_OUTSIDE}"
    how = f"pressed into its seat ({seat})"
    warm = _warmth(machine)
    if warm is not None:
        how = (
            f"dropped into its seat ({seat}) with the housing at {warm:.0f} degC, where the "
            f"tightest fit has {_MM * _ROOM:g} mm of play"
        )
    guide = ", guided by a dowel in one pair of their grooves" if dowels.radius else ""
    held = " until it lies on its ledge"
    if is_bonded(machine):
        held += (
            f"; {RING_COMPOUND} round it, which can be pressed apart again, holds it where a warm "
            "housing grows more than it does"
        )
    least, most = (_MM * one for one in ring_stack(machine.parts).play)
    return (
        f"Ring: {how}{guide}{held}. The clamp rests on the housing all round and leaves it "
        f"{least:.2f} to {most:.2f} mm: depth from the housing's face to the ring, less the length "
        "of the clamp's spigot. A ring that stands proud would bend the clamp's flange."
    )


def is_bonded(machine: Machine) -> bool:
    """Whether a compound holds the ring: in metal that grows more than it does, when warm."""
    housing = find_material(machine.design.housing.material)
    ring = find_material(machine.design.reducer.ring_material)
    if not min(ROTOR_COMPOUND.share_on(one) for one in (housing, ring)):
        return False
    if housing.expansion is None or ring.expansion is None:
        return True
    return housing.expansion > ring.expansion


def _warmth(machine: Machine) -> float | None:
    """Of the housing, deg C; None where it is of plastic, would be too warm, or no fit is known."""
    material = machine.design.housing.material
    growth, diameter = find_material(material).expansion, 2.0 * machine.layout.pack.ring_radius
    if growth is None or material in printed_materials():
        return None
    try:
        shaft, hole = (fit_limits(z, diameter) for z in (zones.RING_OUTSIDE, zones.RING_SEAT))
    except CatalogError:
        return None
    tightest = shaft.upper - hole.lower
    above = (tightest + _ROOM) / (growth * diameter)
    warm = math.ceil((_DRAWN + above) / _STEP) * _STEP
    return warm if warm <= _WARMEST else None
