"""The motor that a design means: its own data over the catalogue's row, a file's over both."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

from cqdd_design.catalog.motors import DRAG, Motor, find_bare_motor
from cqdd_design.design.motor import NAMELESS, MotorFile, MotorTable, not_inside
from cqdd_design.errors import DesignError

IN_DESIGN = "design: its [motor]"
"""Where a value comes from that a design states of its motor."""
_GROUPS = (
    ("torque_constant", "convention", "speed_constant"),
    ("mass", "rotor_mass", "stator_mass"),
    DRAG,
)
"""Keys of which one replaces all: they say one thing in other words, or together."""


def motor_row(table: MotorTable, place: str = IN_DESIGN) -> Motor:
    """The motor that a table means: the catalogue's row with what the table says instead.

    Parameters
    ----------
    place : str
        Where the table's data stand, in words after their kind: "file: motor.toml".

    Raises
    ------
    DesignError
        When its rotor has more inertia than the whole motor can have, or its diameters do not lie
        inside one another.
    """
    told = table.row_values
    base = find_bare_motor(table.base) if table.base else None
    if not told and base is not None and base.name == table.name:
        return base
    stated, measured = tuple(told), not told.keys().isdisjoint(DRAG)
    if measured:
        # Whoever measured the drag measured all of it: the catalogue's part comes not on top.
        told |= {key: told.get(key, 0.0) for key in DRAG}
    drag = "" if base is None else base.drag_source
    kept = [] if base is None else [name for name in base.taken_over.split() if name not in stated]
    found = dataclasses.replace(
        base or _UNKNOWN,
        **told,
        name=table.name,
        stated=stated,
        stated_in=place,
        based_on="" if base is None else base.name,
        taken_over=" ".join(kept),
        source=place if base is None else f"{place}, over the catalogue's {base.name}",
        drag_source=place if measured else drag,
    )
    wrong = not_inside(found)
    if wrong:
        raise DesignError(f"motor {found.name}: {wrong}.")
    _refuse_heavy_rotor(found)
    return found


def own_table(table: MotorTable, motor: MotorFile, *, named: bool = False) -> dict[str, Any]:
    """The keys of a design's motor when a motor file is read over it, in SI, without the driver's.

    A file that names its row of the catalogue, or gives constant and resistance, stands for itself.
    Any other says what is otherwise about the motor that the design has, key by key.

    Parameters
    ----------
    named : bool
        Whether the table's motor was asked for together with the file: then the file is always
        read over it.

    Raises
    ------
    DesignError
        Where the file and who asks for the table's motor name two of the catalogue's.
    """
    name = motor.name or NAMELESS
    if named and motor.base not in ("", table.base):
        raise DesignError(
            f"{motor.place} is about '{motor.base}', and '{table.base}' is asked for beside it; "
            "keep one of them."
        )
    if motor.base or (motor.stands_alone and not named):
        base = {} if motor.based_on is None else {"based_on": motor.based_on}
        return {"name": name, **base, **motor.data}
    base = {"based_on": table.base} if table.base else {}
    return {"name": name, **base, **_over(table, motor)}


def _over(table: MotorTable, motor: MotorFile) -> dict[str, Any]:
    """The data of a table with those of a file instead, key by key."""
    below, above = table.data, motor.data
    for group in _GROUPS:
        if not above.keys().isdisjoint(group):
            below = {key: value for key, value in below.items() if key not in group}
    if not above.keys().isdisjoint(("resistance", "inductance")):
        # In the words of the file, line or phase, what is left of the table's.
        of_row, halved = table.row_values, 0.5 if motor.measured_between == "phase" else 1.0
        below.pop("measured_between", None)
        for name in ("resistance", "inductance"):
            if name in below:
                below[name] = halved * of_row[f"line_{name}"]
    return below | above


def row_over(name: str, motor: MotorFile, *, named: bool = False) -> Motor:
    """The motor that a file makes of a catalogue's motor; see `own_table` and `motor_row`."""
    keys = own_table(MotorTable(name=name), motor, named=named)
    return motor_row(MotorTable.model_validate(keys, context={"si": True}), f"file: {motor.place}")


_NOTHING: dict[str, Any] = {
    field.name: "" if field.type == "str" else None
    for field in dataclasses.fields(Motor)
    if field.default is dataclasses.MISSING
}
_IRON = 7900.0
"""Density of solid iron, kg/m^3, above that of magnets."""
_UNKNOWN = Motor(**(_NOTHING | {"kind": "own", "torque_at": "motor"}))
"""A motor of which nothing is known."""


def _refuse_heavy_rotor(motor: Motor) -> None:
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
