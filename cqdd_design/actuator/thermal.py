"""Winding and housing as two thermal nodes: exact steps, steady state, continuous current.

Copper loss grows with the winding's temperature, but linearly, so that under a constant current
the network stays linear and its response is exact::

    C_w dT_w/dt = i^2 R0 (1 + a (T_w - T_0)) - (T_w - T_h)/R_wh
    C_h dT_h/dt = P_h + (T_w - T_h)/R_wh - (T_h - T_a)/R_ha
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.actuator.motor import resistance_at
from cqdd_design.actuator.parameters import (
    FloatArray,
    MotorParameters,
    ThermalParameters,
)
from cqdd_design.catalog.motors import COPPER_COEFFICIENT
from cqdd_design.errors import DesignError


def runaway_current(motor: MotorParameters, thermal: ThermalParameters) -> float:
    """Current above which the winding heats without end, since its loss grows faster, A."""
    total = thermal.winding_to_housing + thermal.housing_to_ambient
    return math.sqrt(1.0 / (COPPER_COEFFICIENT * motor.resistance * total))


def continuous_current(motor: MotorParameters, thermal: ThermalParameters) -> float:
    """Current whose heat the network carries off for ever at the winding's limit, A.

    i^2 R(T_max) (R_wh + R_ha) = T_max - T_ambient, nothing else heating the housing.
    """
    total = thermal.winding_to_housing + thermal.housing_to_ambient
    rise = thermal.most - thermal.ambient
    return math.sqrt(rise / (total * float(resistance_at(motor, thermal.most))))


def system(
    motor: MotorParameters, thermal: ThermalParameters, current: float, housing_heat: float = 0.0
) -> tuple[FloatArray, FloatArray]:
    """Matrix (2, 2) and forcing (2,) of dT/dt = A T + b for winding and housing, K/s."""
    to_ambient = 1.0 / thermal.housing_to_ambient
    slope = current**2 * motor.resistance * COPPER_COEFFICIENT
    base = current**2 * motor.resistance * (1.0 - COPPER_COEFFICIENT * motor.reference_temperature)
    winding, housing = thermal.winding_capacity, thermal.housing_capacity
    forcing = np.array([base / winding, (housing_heat + to_ambient * thermal.ambient) / housing])
    return network(thermal, slope), forcing


def network(thermal: ThermalParameters, slope: float = 0.0) -> FloatArray:
    """Matrix (2, 2) of the nodes, 1/s; `slope` is the winding's heat over its temperature, W/K."""
    to_housing, to_ambient = 1.0 / thermal.winding_to_housing, 1.0 / thermal.housing_to_ambient
    winding, housing = thermal.winding_capacity, thermal.housing_capacity
    return np.array(
        [
            [(slope - to_housing) / winding, to_housing / winding],
            [to_housing / housing, -(to_housing + to_ambient) / housing],
        ]
    )


def single_node(thermal: ThermalParameters) -> tuple[float, float]:
    """Resistance, K/W, and time constant, s, of one node for the two.

    It has the same steady temperature of the winding and the slower of the two time constants;
    what it lacks is the quick first rise of the winding over the housing.
    """
    rates = -np.linalg.eigvals(network(thermal)).real
    return thermal.winding_to_housing + thermal.housing_to_ambient, float(1.0 / rates.min())


def steady_state(
    motor: MotorParameters, thermal: ThermalParameters, current: float, housing_heat: float = 0.0
) -> tuple[float, float]:
    """Temperatures of winding and housing that a constant current ends at, deg C.

    Raises
    ------
    DesignError
        At or above the current of thermal runaway.
    """
    limit = runaway_current(motor, thermal)
    if not abs(current) < limit:
        raise DesignError(
            f"{abs(current):g} A heat the winding without end; this network holds currents below "
            f"{limit:.4g} A."
        )
    matrix, forcing = system(motor, thermal, current, housing_heat)
    winding, housing = np.linalg.solve(matrix, -forcing)
    return float(winding), float(housing)


def response(
    motor: MotorParameters,
    thermal: ThermalParameters,
    current: float,
    times: ArrayLike,
    *,
    housing_heat: float = 0.0,
) -> FloatArray:
    """Exact temperatures (N, 2) of winding and housing, deg C, after times (N,), s, from ambient.

    The current (A) and the further heat in the housing (W) stay the same all the time.
    """
    t = np.atleast_1d(np.asarray(times, dtype=float))
    first = np.array((thermal.ambient, thermal.ambient))
    matrix, forcing = system(motor, thermal, current, housing_heat)
    stepping, adding = transition(matrix, t)
    return np.asarray(stepping @ first + adding @ forcing)


def transition(matrix: FloatArray, times: FloatArray) -> tuple[FloatArray, FloatArray]:
    """exp(A t) and the integral of exp(A s) from 0 to t, both (N, 2, 2), for a network's A.

    Its eigenvalues are real and distinct: the coupling of the two nodes has one sign.
    """
    half_trace = 0.5 * (matrix[0, 0] + matrix[1, 1])
    half_gap = math.sqrt((0.5 * (matrix[0, 0] - matrix[1, 1])) ** 2 + matrix[0, 1] * matrix[1, 0])
    values = np.array([half_trace - half_gap, half_trace + half_gap])
    one = np.eye(2)
    # Projectors on the two modes.
    upper = (matrix - values[0] * one) / (values[1] - values[0])
    modes = np.stack([one - upper, upper])
    # A winding that runs away is far beyond every limit before numbers end.
    exponent = np.minimum(np.multiply.outer(np.asarray(times, dtype=float), values), 600.0)
    safe = np.where(values == 0.0, 1.0, values)
    growth = np.where(values == 0.0, np.asarray(times)[..., None], np.expm1(exponent) / safe)
    stepping = np.einsum("...m,mij->...ij", np.exp(exponent), modes)
    return np.asarray(stepping), np.asarray(np.einsum("...m,mij->...ij", growth, modes))
