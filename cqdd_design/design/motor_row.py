"""The motor that a design means: its own data over the catalogue's row, a file's over both."""

from __future__ import annotations

import dataclasses
from typing import Any

from cqdd_design.catalog.motors import DRAG, Motor, find_bare_motor
from cqdd_design.design.motor import NAMELESS, MotorFile, MotorTable
from cqdd_design.design.motor_sizes import not_inside, refuse_heavy_rotor
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
    wrong = not_inside(vars(found))
    if wrong:
        raise DesignError(f"motor {found.name}: {wrong}.")
    refuse_heavy_rotor(found)
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
_UNKNOWN = Motor(**(_NOTHING | {"kind": "own", "torque_at": "motor"}))
"""A motor of which nothing is known."""
