"""Requirements held against the rest of a design: what one asks for and the other has."""

from __future__ import annotations

from typing import Any

from cqdd_design.design.motor import MotorTable
from cqdd_design.design.reducer import Reducer
from cqdd_design.design.requirements import Requirements
from cqdd_design.errors import shown
from cqdd_design.units import TEMPERATURE, format_quantity


def too_cold_a_surface(asked: Requirements, ambient: float) -> str:
    """What is wrong with a surface that is to be as cold as the air (deg C); empty of any other."""
    wanted = asked.surface_temperature
    if wanted is None or wanted > ambient:
        return ""
    return (
        f"requirements.surface_temperature {format_quantity(wanted, TEMPERATURE)} is not above "
        f"environment.ambient {format_quantity(ambient, TEMPERATURE)}: nothing that loses heat is "
        "as cold as the air; raise it or lower ambient"
    )


def _other_parts(
    asked: Requirements, reducer: Reducer, motor: MotorTable
) -> dict[str, tuple[str, Any]]:
    """Requirements whose part the design has another of, stated or not: where, and which."""
    has: dict[str, tuple[str, Any]] = {
        "motor": ("motor.name", motor.base or motor.name),
        "disc_count": ("reducer.disc_count", reducer.disc_count),
        "disc_material": ("reducer.disc_material", reducer.disc_material),
        "ring_material": ("reducer.ring_material", reducer.ring_material),
        "pin_material": ("reducer.output_pins.material", reducer.output_pins.material),
    }
    return {key: part for key, part in has.items() if getattr(asked, key) != part[1]}


def parts_not_asked_for(
    asked: Requirements, reducer: Reducer, motor: MotorTable
) -> tuple[str, ...]:
    """A sentence on every part that stated requirements name and the design has another of.

    Each without its last stop. Requirements that were left out hold their defaults for `size` and
    ask a design for nothing.
    """
    return tuple(
        f"requirements.{key} {shown(getattr(asked, key))} is not {place} {shown(there)}; make them "
        f"equal or leave requirements.{key} out"
        for key, (place, there) in _other_parts(asked, reducer, motor).items()
        if key in asked.model_fields_set
    )


def defaults_it_does_not_have(
    asked: Requirements, reducer: Reducer, motor: MotorTable
) -> list[str]:
    """Requirements that nobody stated and whose default is another part than the design has."""
    others = _other_parts(asked, reducer, motor)
    return [key for key in others if key not in asked.model_fields_set]
