"""Turned bodies against the tables of Roark's Formulas for Stress and Strain, and by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cqdd_design.catalog.threads import coarse_thread
from cqdd_design.gearbox import wall_stress as stress

# Young and Budynas 2002, table 11.2, case 21: b/a and beta, sigma = beta M/(a t^2), nu 0.3.
TRUNNION = (
    (0.10, 9.36), (0.15, 6.08), (0.20, 4.41), (0.25, 3.37), (0.30, 2.66),
    (0.40, 1.73), (0.50, 1.146), (0.60, 0.749), (0.70, 0.467), (0.80, 0.262),
)  # fmt: skip


@pytest.mark.parametrize(("share", "beta"), TRUNNION)
def test_a_tilted_hub_stresses_its_plate_as_tabled(share: float, beta: float) -> None:
    edge, thick, moment = 30e-3, 2.5e-3, 4.0
    found = stress.tilted_plate_stress(share * edge, edge, thick, moment)
    assert found * edge * thick**2 / moment == pytest.approx(beta, rel=2e-3)


def test_a_pushed_hub_stresses_its_plate_as_its_deflection_bends() -> None:
    """By the plate's equation in finite differences: clamped outside, guided at the hub."""
    hub, edge, push = 0.4, 1.0, 1.0
    r = np.linspace(hub, edge, 4001)
    # D d/dr(1/r d/dr(r w')) = -F/(2 pi r): one integration of the slope's equation by parts.
    first = -push / (2.0 * math.pi) * np.log(r)
    inner = np.concatenate(
        [[0.0], np.cumsum(0.5 * np.diff(r) * ((first * r)[1:] + (first * r)[:-1]))]
    )
    # r w' = inner + c (r^2 - hub^2)/2, zero at both ends.
    free = 0.5 * (r**2 - hub**2)
    slope = (inner - inner[-1] / free[-1] * free) / r
    bent = abs(float(np.gradient(slope, r, edge_order=2)[0]))
    assert stress.pushed_plate_stress(hub, edge, 1.0, push) == pytest.approx(6.0 * bent, rel=1e-4)


def test_plates_without_width_bear_nothing() -> None:
    assert stress.tilted_plate_stress(5e-3, 5e-3, 1e-3, 9.0) == 0.0
    assert stress.pushed_plate_stress(5e-3, 4e-3, 1e-3, 9.0) == 0.0


def test_tubes_bend_and_twist_by_hand() -> None:
    """40 x 36 mm: W = pi/32 (D^4 - d^4)/D = 2161 mm^3; 10 N m bend to 4.63 MPa."""
    bent = stress.tube_stress(20e-3, 18e-3, 10.0, 0.0)
    assert bent / 1e6 == pytest.approx(4.628, rel=1e-3)
    # Torsion has half of that in shear, and von Mises sqrt(3) of the half.
    twisted = stress.tube_stress(20e-3, 18e-3, 0.0, 10.0)
    assert twisted == pytest.approx(0.5 * math.sqrt(3.0) * bent)
    assert stress.tube_stress(20e-3, 18e-3, 10.0, 10.0) == pytest.approx(math.hypot(bent, twisted))


def test_lips_rings_and_seats_by_hand() -> None:
    """60 mm: 300 N are 1.59 N/mm; 9 N m are 3.18 N/mm where they are greatest."""
    none, force, moment = np.zeros(1), np.array([300.0]), np.array([9.0])
    assert float(stress.line_load(60e-3, force, none)[0]) == pytest.approx(1591.5, rel=1e-4)
    assert float(stress.line_load(60e-3, none, moment)[0]) == pytest.approx(3183.1, rel=1e-4)
    # A cosine of that height over the ring has the moment.
    around = np.linspace(0.0, 2.0 * np.pi, 721)[:-1]
    spread = float(stress.line_load(60e-3, none, moment)[0]) * np.cos(around)
    arm = 30e-3 * np.cos(around)
    assert float((spread * arm).sum() * 30e-3 * 2.0 * np.pi / 720) == pytest.approx(9.0)
    assert stress.lip_stress(2000.0, 1e-3, 2e-3) / 1e6 == pytest.approx(3.0)
    assert stress.seat_pressure(400.0, 20e-3, 5e-3) / 1e6 == pytest.approx(4.0)
    assert stress.disc_shear(30.0, 20e-3, 5e-3) / 1e6 == pytest.approx(4.135, rel=1e-3)


def test_a_socket_balances_what_its_pin_brings() -> None:
    """Pressure that runs straight from mouth to bottom has the force and, about the mouth, M."""
    force, moment, d, long = 120.0, 0.7, 5e-3, 7e-3
    most = float(stress.socket_pressure(np.array([force]), np.array([moment]), d, long)[0])
    deep = np.linspace(0.0, long, 20001)
    # p = most at the mouth, falling by a slope that balances the force.
    slope = 2.0 * (most * long - force / d) / long**2
    pressed = d * (most - slope * deep)
    step = deep[1]
    assert float(np.trapezoid(pressed, dx=step)) == pytest.approx(force, rel=1e-6)
    assert float(np.trapezoid(-pressed * deep, dx=step)) == pytest.approx(moment, rel=1e-4)


def test_threads_shear_over_their_height() -> None:
    """M10, 10 mm in: pi d m' (1/2 + (d - d_2) tan 30/P) is 232 mm^2."""
    thread = coarse_thread(10e-3)
    shear = 1000.0 / (math.pi * 10e-3 * (10e-3 - 0.8 * 1.5e-3) * 0.875)
    assert stress.thread_stress(thread, 10e-3, 1000.0) == pytest.approx(
        math.sqrt(3.0) * shear, rel=2e-3
    )
