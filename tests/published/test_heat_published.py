"""Heat to still air against worked examples; the thermal network against closed forms.

Incropera, DeWitt, Bergman and Lavine 2007, Fundamentals of Heat and Mass Transfer, 6th edition:
examples 9.2 (upright glass, Ra 1.813e9, Pr 0.690, Nu 147) and 9.4 (lying pipe, Ra 5.073e6, Pr
0.697, Nu 23.3 with rounded powers), air at 300 and 400 K from table A.4. Nodes: the exponentials of
any textbook on linear systems.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from cqdd_design.errors import DesignError
from cqdd_design.gearbox.heat.joints import (
    FILL,
    GREASE_CONDUCTIVITY,
    LINER,
    LINER_CONDUCTIVITY,
    RESIN_CONDUCTIVITY,
    ROUGHNESS,
    bearing_conductance,
    film_conductance,
    winding_conductance,
)
from cqdd_design.gearbox.heat.network import Heat, ThermalNetwork
from cqdd_design.gearbox.heat.surfaces import (
    Surface,
    air,
    annulus_conductance,
    nusselt_cylinder,
    nusselt_plate,
    outside_conductance,
)


def test_nusselt_numbers_of_worked_examples() -> None:
    assert nusselt_plate(1.813e9, 0.690) == pytest.approx(147.0, abs=0.5)
    assert nusselt_cylinder(5.073e6, 0.697) == pytest.approx(23.3, rel=0.01)


@pytest.mark.parametrize(
    ("kelvin", "conductivity", "viscosity"),
    [(300.0, 26.3e-3, 15.89e-6), (400.0, 33.8e-3, 26.41e-6)],
)
def test_air_by_its_table(kelvin: float, conductivity: float, viscosity: float) -> None:
    assert air(kelvin - 273.15) == pytest.approx((conductivity, viscosity), rel=0.02)


def test_a_black_surface_that_is_hardly_warm_radiates_four_sigma_cubed() -> None:
    grey, black = (
        outside_conductance(Surface(0, "plate", 0.1, 1.0, e), 25.01, 25.0) for e in (0.0, 1.0)
    )
    assert black - grey == pytest.approx(4.0 * 5.670374e-8 * 298.155**3, rel=1e-4)


def test_film_between_cylinders_is_its_integral() -> None:
    x = np.linspace(-2e-3, 2e-3, 200_001)
    gap = 5e-6 + ROUGHNESS + x**2 / (2.0 * 4e-3)
    exact = GREASE_CONDUCTIVITY * 8e-3 * np.trapezoid(1.0 / gap, x)
    assert float(film_conductance(5e-6, 4e-3, 2e-3, 8e-3)) == pytest.approx(exact, rel=1e-6)


def test_bearing_by_kylander() -> None:
    # 0.45 (0.12 - 0.026) (33 - 0.026 x 100) K/W
    assert 1.0 / bearing_conductance(0.026, 100.0) == pytest.approx(0.45 * 0.094 * 30.4)


def test_annulus_by_its_logarithm() -> None:
    assert annulus_conductance(2.0, 1.0, math.e, 3.0) == pytest.approx(12.0 * math.pi)


def one_node(resistance: float = 2.0, capacity: float = 50.0) -> ThermalNetwork:
    return ThermalNetwork(
        ("body",), np.array([capacity]), np.zeros((1, 1)), np.array([1.0 / resistance]), 25.0
    )


def two_nodes() -> ThermalNetwork:
    between = np.array([[0.0, 2.0], [2.0, 0.0]])
    return ThermalNetwork(
        ("winding", "housing"), np.array([40.0, 900.0]), between, np.array([0.0, 0.8]), 25.0
    )


def test_one_node_is_an_exponential() -> None:
    network, times = one_node(), np.array([1.0, 30.0, 100.0, 900.0])
    exact = 25.0 + 60.0 * (1.0 - np.exp(-times / 100.0))
    found = network.history(Heat.constant([30.0]), times)[:, 0]
    assert found == pytest.approx(exact, rel=1e-9)
    assert network.steady(Heat.constant([30.0]))[0] == pytest.approx(85.0, rel=1e-12)


def test_a_node_whose_heat_grows_is_an_exponential_too() -> None:
    # C T' = a + s T - G (T - T_a): rate (G - s)/C.
    heat = Heat(np.array([10.0]), np.array([0.1]), np.array([1e3]))
    end = (10.0 + 0.5 * 25.0) / 0.4
    assert one_node().steady(heat)[0] == pytest.approx(end, rel=1e-12)
    found = one_node().history(heat, [40.0])[0, 0]
    assert found == pytest.approx(end + (25.0 - end) * math.exp(-0.4 / 50.0 * 40.0), rel=1e-6)


def test_two_nodes_are_two_exponentials() -> None:
    network, heat = two_nodes(), np.array([20.0, 5.0])
    steady = network.steady(Heat.constant(heat))
    # Winding over housing by 20 W x 0.5 K/W, housing over air by 25 W x 1.25 K/W.
    assert steady == pytest.approx([25.0 + 31.25 + 10.0, 25.0 + 31.25], rel=1e-12)
    matrix = np.array([[-2.0 / 40.0, 2.0 / 40.0], [2.0 / 900.0, -2.8 / 900.0]])
    half, product = 0.5 * np.trace(matrix), np.linalg.det(matrix)
    slow, fast = (half + s * math.sqrt(half**2 - product) for s in (1.0, -1.0))
    for t in (3.0, 50.0, 700.0):
        # Sylvester: exp(A t) from the two rates.
        one = np.eye(2)
        exponential = (
            math.exp(slow * t) * (matrix - fast * one) - math.exp(fast * t) * (matrix - slow * one)
        ) / (slow - fast)
        exact = steady + exponential @ (25.0 - steady)
        found = network.history(Heat.constant(heat), [t])[0]
        assert found == pytest.approx(exact, rel=1e-6)


def test_a_network_without_air_is_refused() -> None:
    with pytest.raises(DesignError, match="without a way to the air"):
        ThermalNetwork(("a",), np.array([1.0]), np.zeros((1, 1)), np.zeros(1), 25.0)


def test_a_winding_is_as_much_warmer_as_its_coils_mean_is() -> None:
    """A slab that heats evenly, cooled on one side: T = (w x - x^2/2) q/k, integrated."""
    slots, depth, middle, length = 36, 9e-3, 45e-3, 20e-3
    across = RESIN_CONDUCTIVITY * (1.0 + FILL) / (1.0 - FILL)
    coil = 0.25 * 2.0 * math.pi * middle / slots
    x = (np.arange(2000) + 0.5) / 2000.0 * coil
    mean = float(np.mean(coil * x - 0.5 * x**2)) / across / coil
    walls = 2.0 * slots * depth * length
    wanted = walls / (LINER / LINER_CONDUCTIVITY + mean)
    assert winding_conductance(slots, depth, middle, length) == pytest.approx(wanted, rel=1e-6)
