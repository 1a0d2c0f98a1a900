"""Finite elements of elastic bodies against closed forms of elasticity."""

from __future__ import annotations

import numpy as np
import pytest

from cqdd_design.gearbox.bodies.elements import Elements, elements
from cqdd_design.gearbox.bodies.influence import Loads, influence
from cqdd_design.gearbox.bodies.loops import Loop, circle
from cqdd_design.gearbox.bodies.mesh import mesh
from cqdd_design.gearbox.bodies.point_load import DEPTH, Places, Plate

PLATE = Plate(206e9, 0.3, 8e-3)
NOWHERE = Places(np.empty(0, complex), np.empty(0, complex), np.empty(0, complex))


def body(*loops: Loop, side: float) -> tuple[Elements, tuple[Loop, ...]]:
    return elements(mesh(loops, side, "the body"), loops, PLATE), loops


def under(made: Elements, loops: tuple[Loop, ...], tractions: np.ndarray) -> np.ndarray:
    """Displacements of the body under tractions (Q,) along its edges."""
    loads = Loads(NOWHERE, np.arange(len(tractions)), tractions[:, None], np.eye(1))
    moved = np.zeros(made.stiffness.shape[0])
    moved[made.edges.unknowns] = influence(made, loops, PLATE, loads, made.rigid()).fields[:, 0]
    return moved


def test_thick_ring_under_pressure_yields_as_lame_says() -> None:
    a, b, p = 17.5e-3, 30e-3, 40e6
    made, loops = body(Loop(circle(0j, b), 1), Loop(circle(0j, a), -1), side=3e-3)
    edges = made.edges
    push = np.where(edges.loop == 1, -p * PLATE.thickness * edges.normal, 0.0)
    moved = made.edges.trace @ under(made, loops, push)
    out = (moved[: len(push)] + 1j * moved[len(push) :]) * np.exp(-1j * np.angle(edges.point))
    inner, outer = edges.loop == 1, edges.loop == 0
    lame = p * a * a / (b * b - a * a)
    grown = lame / PLATE.modulus
    # The rest of the body's rotation and shift is even round the edge and has no mean.
    assert out[inner].real.mean() == pytest.approx(
        grown * a * (1.0 - PLATE.poisson + (1.0 + PLATE.poisson) * b * b / (a * a)), rel=1e-2
    )
    assert out[outer].real.mean() == pytest.approx(grown * 2.0 * b, rel=1e-2)
    u = np.arange(16) / 16
    hoop = PLATE.modulus * (
        made.strain(loops, np.zeros(16, dtype=int), u) @ under(made, loops, push)
    )
    assert hoop == pytest.approx(np.full(16, 2.0 * lame), rel=1e-2)


def test_hole_in_a_pulled_plate_triples_the_stress() -> None:
    a, b, pull = 1e-3, 40e-3, 10e6
    made, loops = body(Loop(circle(0j, b), 1), Loop(circle(0j, a), -1), side=6e-3)
    edges = made.edges
    along_x = np.where(edges.loop == 0, pull * PLATE.thickness * edges.normal.real + 0j, 0.0)
    moved = under(made, loops, along_x)
    angle = np.arange(24) / 24
    stress = PLATE.modulus * (made.strain(loops, np.ones(24, dtype=int), angle) @ moved)
    kirsch = pull * (1.0 - 2.0 * np.cos(4.0 * np.pi * angle))
    assert stress.max() == pytest.approx(3.0 * pull, rel=1e-2)
    assert stress == pytest.approx(kirsch, abs=4e-2 * pull)


@pytest.mark.parametrize("side", [4e-3, 2e-3])
def test_disc_between_two_forces_shortens_as_timoshenko_says(side: float) -> None:
    """Two half-plane fields and an even tension (Timoshenko and Goodier 1970, section 41)."""
    R = 20e-3
    made, loops = body(Loop(circle(0j, R), 1), side=side)
    at = R * np.exp(1j * np.array([0.3, 0.3 + np.pi]))
    places = Places(at, -at / R, np.full(2, np.nan + 0j))
    loads = Loads(places, np.empty(0, int), np.empty((0, 0), complex), np.empty((0, 4)))
    # Of both places, the loads along the normal.
    shortening = influence(made, loops, PLATE, loads, made.rigid()).matrix[::2, ::2].sum()
    unit = 4.0 / (np.pi * PLATE.modulus * PLATE.thickness)
    assert shortening == pytest.approx(
        unit * (np.log(2.0 * R / DEPTH) - 0.5 * (1.0 - PLATE.poisson)), rel=5e-3
    )
