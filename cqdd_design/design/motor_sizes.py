"""Sizes and inertias that no motor can have."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from typing import Any

from cqdd_design.catalog.motors import Motor
from cqdd_design.errors import DesignError
from cqdd_design.units import LENGTH, format_quantity

_IRON = 7900.0
"""Density of solid iron, kg/m^3, above that of magnets."""


def not_inside(motor: Mapping[str, Any]) -> str:
    """What is wrong with sizes (m, by key) that must lie in one another; empty of sound ones."""
    inrunner = "inrunner" in (motor["kind"] or "")
    outside = ("bore_diameter", "gap_diameter", "outer_diameter")
    chains: list[tuple[str, ...]] = [("hollow_diameter", *outside[1:]) if inrunner else outside]
    chains += [("stack_length", "length"), ("rotor_length", "length")]
    for names in chains:
        known = [(name, value) for name in names if (value := motor[name]) is not None]
        for (inner, less), (outer, more) in itertools.pairwise(known):
            if less > more or (less == more and len(names) > 2):
                return (
                    f"{inner} {format_quantity(less, LENGTH)} is not inside {outer} "
                    f"{format_quantity(more, LENGTH)}; check both"
                )
    inner, outer = ("gap_diameter", "outer_diameter") if inrunner else outside[:2]
    less, more, depth = (motor[name] for name in (inner, outer, "slot_depth"))
    if less is None or more is None or depth is None or 2.0 * depth < more - less:
        return ""
    return (
        f"slot_depth {format_quantity(depth, LENGTH)} does not fit between {inner} "
        f"{format_quantity(less, LENGTH)} and {outer} {format_quantity(more, LENGTH)}, which leave "
        f"{format_quantity(0.5 * (more - less), LENGTH)}; check them"
    )


def refuse_heavy_rotor(motor: Motor) -> None:
    """Refuse a rotor with more inertia than the whole motor as a thin ring, or of solid iron."""
    _refuse_dense_rotor(motor)
    if motor.rotor_inertia is None or motor.mass is None or motor.outer_diameter is None:
        return
    most = motor.mass * (0.5 * motor.outer_diameter) ** 2
    if motor.rotor_inertia > most:
        raise DesignError(
            f"motor {motor.name}: rotor_inertia {motor.rotor_inertia:.4g} kg m^2 is more than "
            f"{motor.mass:g} kg within {1e3 * motor.outer_diameter:.4g} mm can have, {most:.3g} "
            "kg m^2; check both."
        )


def _refuse_dense_rotor(motor: Motor) -> None:
    """Refuse an inrunner's rotor that its sizes have no room for."""
    inner, outer, long = motor.hollow_diameter, motor.gap_diameter, motor.rotor_length
    if not (motor.is_inrunner and inner and outer and long and motor.rotor_inertia):
        return
    # J = pi/32 rho l (D^4 - d^4)
    most = math.pi / 32.0 * _IRON * long * (outer**4 - inner**4)
    if motor.rotor_inertia > most:
        raise DesignError(
            f"motor {motor.name}: rotor_inertia {motor.rotor_inertia:.4g} kg m^2 is more than iron "
            f"between {1e3 * inner:.4g} and {1e3 * outer:.4g} mm over {1e3 * long:.4g} mm has, "
            f"{most:.3g} kg m^2; check hollow_diameter, gap_diameter and rotor_length too."
        )
