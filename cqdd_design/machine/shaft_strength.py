"""Strength of a machine's eccentric shaft, and what its bearings and the output's carry."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from cqdd_design.catalog.bearings import shaft_material
from cqdd_design.catalog.materials import Material, find_material
from cqdd_design.errors import CatalogError
from cqdd_design.gearbox.checks.allowables import shaft_limit_fatigue
from cqdd_design.gearbox.pack_loads import PackLoads
from cqdd_design.gearbox.shaft_strength import Step, StepStress, step_stress
from cqdd_design.geometry.contours import Circle, ComplexArray, FloatArray
from cqdd_design.machine.machine import Machine
from cqdd_design.machine.shaft import disc_heights, knife_edges
from cqdd_design.solids.features.kinds import Undercut
from cqdd_design.solids.features.rotating import shaft_features
from cqdd_design.solids.layers import Layer
from cqdd_design.solids.layout import PackLayout, ShaftLayout
from cqdd_design.solids.rotating import eccentric_shaft

_BETWEEN = 12
"""Angles between a force that turns and one that stands still."""


@dataclass(frozen=True)
class ShaftStrength:
    """The worst steps of a shaft.

    Attributes
    ----------
    material : Material
        Of the shaft.
    static : StepStress
        Where the peak torque stresses it most.
    lasting : StepStress
        Where the duty has least reserve.
    limit : float
        Reversed stress that this place bears for ever, Pa; 0 where none is known.
    basis : str
        Where it comes from.
    """

    material: Material
    static: StepStress
    lasting: StepStress
    limit: float
    basis: str


def shaft_strength(machine: Machine, peak: PackLoads, duty: PackLoads) -> ShaftStrength:
    """Judge every change of section of the shaft that carries the eccentrics.

    Parameters
    ----------
    peak, duty : PackLoads
        At the peak torque, both senses; in every case of the duty.

    Raises
    ------
    GeometryError
        When the machine cannot be laid out.
    CatalogError
        When the shaft's material has no strength in the catalogue.
    """
    pack, shaft = machine.layout.pack, machine.layout.shaft
    material = find_material(shaft_material(pack.cam.bearing))
    ultimate = material.ultimate_strength
    if ultimate is None:
        raise CatalogError(f"the catalogue has no ultimate strength of '{material.name}'.")
    steps = shaft_steps(pack, shaft)
    at, edges = disc_heights(pack), knife_edges(shaft)
    static = [
        step_stress(one, *section_loads(peak, one.height, at, edges), ultimate) for one in steps
    ]
    lasting = [
        step_stress(one, *section_loads(duty, one.height, at, edges), ultimate) for one in steps
    ]
    limits = [shaft_limit_fatigue(material, 2.0 * one.radius) for one in steps]
    worst = max(
        range(len(steps)),
        key=lambda i: lasting[i].reversed_amplitude / max(limits[i].value, 1.0),
    )
    return ShaftStrength(
        material=material,
        static=max(static, key=lambda one: one.static),
        lasting=lasting[worst],
        limit=limits[worst].value,
        basis=limits[worst].basis,
    )


def shaft_steps(pack: PackLayout, shaft: ShaftLayout) -> tuple[Step, ...]:
    """Changes of section from the lower journal to the upper, and the seat of a loose cam.

    An undercut leaves less than its cylinder, with its own fillet; where there is none, the fillet
    is as large as the bearing's corner allows.
    """
    layers = eccentric_shaft(pack, shaft).layers
    reliefs = {
        round(one.height, 9): one
        for one in shaft_features(pack, shaft, None, 0.0)
        if isinstance(one, Undercut)
    }
    last, found = len(layers) - 2, []
    for place, (below, above) in enumerate(pairwise(layers)):
        thin, thick = sorted((below, above), key=lambda one: _outside(one).radius)
        at_seat = place in (0, last)
        bearing = shaft.support.bearing if at_seat else pack.cam.bearing
        name = "shoulder of the lower bearing" if place == 0 else "shoulder of the upper bearing"
        relief = reliefs.get(round(above.bottom, 9))
        found.append(
            Step(
                name if at_seat else f"edge of an eccentric, {1e3 * above.bottom:.1f} mm up",
                above.bottom,
                _outside(thin).radius - (relief.depth if relief else 0.0),
                shaft.bore_radius,
                _outside(thick).radius + float(np.hypot(*_outside(thick).centre)),
                relief.radius if relief else bearing.largest_fillet,
            )
        )
    if pack.disc_count > 2:
        height = pack.cam_top(1)
        core = shaft.shoulder_radius
        found.append(
            Step("seat of the loose cam", height, core, shaft.bore_radius, shaft.web_radius, 0.0)
        )
    return tuple(found)


def _outside(layer: Layer) -> Circle:
    assert isinstance(layer.shape.outer, Circle)
    return layer.shape.outer


def section_loads(
    loads: PackLoads, height: float, at: FloatArray, edges: tuple[float, float]
) -> tuple[ComplexArray, FloatArray]:
    """Bending moment (C, A) in the shaft's own frame and torque (C, A) at a height (m), N m.

    The motor drives the lower end: what the discs above a section take passes through it.
    """
    arms = np.maximum(height - at, 0.0)
    lower, _ = carried_shares(at, edges)
    moment = loads.turning @ (lower * (height - edges[0]) - arms)
    return np.asarray(moment), np.asarray(loads.torque @ (at > height))


def carried_shares(at: FloatArray, edges: tuple[float, float]) -> tuple[FloatArray, FloatArray]:
    """Shares (D,) of every disc's force that the lower and the upper bearing carry."""
    upper = (at - edges[0]) / (edges[1] - edges[0])
    return 1.0 - upper, upper


def support_loads(machine: Machine, loads: PackLoads) -> FloatArray:
    """Sizes of what the discs put on the lower and the upper support bearing, (C, A, 2), N.

    Raises
    ------
    GeometryError
        When the machine cannot be laid out.
    """
    layout = machine.layout
    shares = carried_shares(disc_heights(layout.pack), knife_edges(layout.shaft))
    return np.abs(loads.on_shaft @ np.column_stack(shares))


def with_still_force(turning: FloatArray, still: FloatArray) -> FloatArray:
    """Sizes of forces that turn with the crank, and others that stand still, together, N.

    Both meet at every angle alike, so that angles A of the first stand for all of a turn.

    Parameters
    ----------
    turning : array (C, A, B)
        Sizes on B bearings, N.
    still : array (B,)
        N.

    Returns
    -------
    array (C, A * 12, B)
        At twelve even angles between the two.

    Examples
    --------
    >>> both = with_still_force(np.full((1, 1, 1), 300.0), np.array([100.0]))
    >>> round(float(both.max()), 9), round(float(np.mean(both**2)) ** 0.5, 1)
    (400.0, 316.2)
    """
    towards = np.exp(2j * np.pi * np.arange(_BETWEEN) / _BETWEEN)[:, None]
    both = np.abs(turning[:, :, None, :] + towards * still)
    return np.asarray(both.reshape(len(turning), -1, len(still)))
