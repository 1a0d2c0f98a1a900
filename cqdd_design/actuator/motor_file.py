"""A motor of one's own from a TOML file, where the catalogue has none or has it otherwise.

What the file leaves out is that of the design's catalogue motor::

    name = "rewound RO100"
    torque_constant = "0.1504 N*m/A"     # or speed_constant = "55 rpm/V"
    convention = "torque_per_peak"       # of the torque constant; default "dc"
    resistance = "71.5 mohm"
    measured_between = "phase"           # or "line", the default: resistance and inductance
    coulomb = "0.1 N*m"                  # what the motor alone takes to turn, at its shaft
    viscous = "8.5e-4 N*m*s/rad"
    cogging_amplitude = "0.055 N*m"      # half of peak to peak
    cogging_order = 252                  # periods in a turn: lcm of slots and poles
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any

from cqdd_design.actuator.motor import torque_constant_from
from cqdd_design.catalog.motors import CONVENTIONS, DRAG, Motor
from cqdd_design.errors import DesignError, did_you_mean, is_unprintable, shown
from cqdd_design.files import parse_toml, read_text_file
from cqdd_design.units import (
    CURRENT,
    DAMPING_GAIN,
    INDUCTANCE,
    INERTIA,
    MASS,
    RESISTANCE,
    SPEED_CONSTANT,
    TORQUE,
    TORQUE_CONSTANT,
    Dimension,
    parse_quantity,
)

_MOST_BYTES = 1_000_000
_MOST_WHOLE = 100_000

#: Key to its dimension, and whether it may be 0.
QUANTITIES: Mapping[str, tuple[Dimension, bool]] = MappingProxyType(
    {
        "torque_constant": (TORQUE_CONSTANT, False),
        "speed_constant": (SPEED_CONSTANT, False),
        "resistance": (RESISTANCE, False),
        "inductance": (INDUCTANCE, True),
        "rotor_inertia": (INERTIA, True),
        "mass": (MASS, False),
        "rated_torque": (TORQUE, False),
        "peak_torque": (TORQUE, False),
        "rated_current": (CURRENT, False),
        "coulomb": (TORQUE, True),
        "viscous": (DAMPING_GAIN, True),
        "cogging_amplitude": (TORQUE, True),
        "hysteresis": (TORQUE, True),
        "iron_loss": (DAMPING_GAIN, True),
    }
)
WHOLE = ("pole_pairs", "cogging_order")
WORDS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {"convention": tuple(CONVENTIONS), "measured_between": ("line", "phase")}
)
_OF_ROW = {
    "speed_constant": "speed_constant",
    "resistance": "line_resistance",
    "inductance": "line_inductance",
    "rotor_inertia": "rotor_inertia",
    "mass": "mass",
    "rated_torque": "rated_torque",
    "peak_torque": "peak_torque",
    "rated_current": "rated_current",
    "pole_pairs": "pole_pairs",
    **{key: key for key in (*DRAG, "cogging_amplitude", "cogging_order")},
}


@dataclass(frozen=True)
class MotorFile:
    """What a file says of a motor.

    Attributes
    ----------
    values : mapping of str to float
        SI, in the conventions inside: K of the DC machine under ``speed_constant`` as 1/K, line to
        line.
    place : str
        The file.
    """

    name: str
    values: Mapping[str, float] = field(default_factory=dict)
    place: str = ""

    def row(self, catalogue: Motor) -> Motor:
        """The catalogue's motor with what the file says instead."""
        told = {
            _OF_ROW[key]: int(value) if key in WHOLE else value
            for key, value in self.values.items()
            if key in _OF_ROW
        }
        source = f"motor file {self.place}, over the catalogue's {catalogue.name}"
        given: dict[str, Any] = {**told, "name": self.name, "source": source}
        if told.keys() & set(DRAG):
            # Whoever measured the drag measured all of it: the catalogue's part comes not on top.
            given |= {key: told.get(key, 0.0) for key in DRAG}
            given["drag_source"] = source
        kept = [name for name in catalogue.taken_over.split() if name not in given]
        given["taken_over"] = " ".join(kept)
        # A file with the electrical data is that of a bare motor.
        if {"speed_constant", "line_resistance"} <= set(told):
            given["torque_at"] = "motor"
        found = dataclasses.replace(catalogue, **given)
        _refuse_heavy_rotor(found, self.place)
        return found

    def origins(self) -> dict[str, str]:
        """Where each value comes from, by its dotted name in `ActuatorParameters`."""
        names = {"speed_constant": "torque_constant"}
        found = {
            f"motor.{names.get(key, key)}": f"file: {self.place}"
            for key in self.values
            if key not in ("mass", "rated_current")
        }
        if self.values.keys() & set(DRAG):
            left = f"file: {self.place}, which gives the drag without it"
            found = {f"motor.{key}": left for key in DRAG} | found
        return found


def _refuse_heavy_rotor(motor: Motor, place: str) -> None:
    """Refuse a rotor with more inertia than the whole motor would have as a thin ring."""
    if motor.rotor_inertia is None or motor.mass is None or motor.outer_diameter is None:
        return
    most = motor.mass * (0.5 * motor.outer_diameter) ** 2
    if motor.rotor_inertia > most:
        raise DesignError(
            f"{place}: rotor_inertia {motor.rotor_inertia:.4g} kg m^2 is more than "
            f"{motor.mass:g} kg within {1e3 * motor.outer_diameter:.4g} mm can have, {most:.3g} "
            "kg m^2; check both."
        )


def read_motor(path: Path) -> MotorFile:
    """Read a motor file.

    Raises
    ------
    UsageError
        When it cannot be read.
    DesignError
        When it is not TOML, has an unknown key, a value without or with another unit, one that no
        motor has, or a torque constant and a speed constant.
    """
    content = parse_toml(read_text_file(path, _MOST_BYTES), path, wrong=DesignError)
    known = ("name", *QUANTITIES, *WHOLE, *WORDS)
    for key in content:
        if key not in known:
            raise DesignError(
                f"{path}: '{key}' is not a key of a motor{did_you_mean(key, known) or '.'} "
                f"There are {', '.join(known)}."
            )
    words = {key: _word(path, key, content.get(key, known[0])) for key, known in WORDS.items()}
    values = {key: _number(path, key, content[key]) for key in QUANTITIES if key in content}
    values |= {key: _whole(path, key, content[key]) for key in WHOLE if key in content}
    if "torque_constant" in values:
        if "speed_constant" in values:
            raise DesignError(
                f"{path}: torque_constant and speed_constant say the same; keep one of them."
            )
        constant = torque_constant_from(values.pop("torque_constant"), words["convention"])
        values["speed_constant"] = 1.0 / constant
    elif "convention" in content:
        raise DesignError(f"{path}: convention is of a torque_constant, which is missing; add it.")
    if words["measured_between"] == "phase":
        for key in ("resistance", "inductance"):
            if key in values:
                values[key] *= 2.0
    return MotorFile(_name(path, content.get("name", path.stem)), values, path.name)


def _name(path: Path, value: object) -> str:
    if not isinstance(value, str) or not 0 < len(value) <= 100 or any(map(is_unprintable, value)):
        raise DesignError(
            f"{path}: name {shown(value)} must be text of at most 100 characters, none of them a "
            "control or direction character."
        )
    return value


def _word(path: Path, key: str, value: object) -> str:
    if value not in WORDS[key]:
        raise DesignError(f"{path}: {key} {shown(value)} is none of {', '.join(WORDS[key])}.")
    return str(value)


def _whole(path: Path, key: str, value: object) -> int:
    if not isinstance(value, int) or isinstance(value, bool) or not 1 <= value <= _MOST_WHOLE:
        raise DesignError(
            f"{path}: {key} {shown(value)} must be a whole number from 1 to {_MOST_WHOLE}."
        )
    return value


def _number(path: Path, key: str, value: object) -> float:
    dimension, zero = QUANTITIES[key]
    if not isinstance(value, str):
        raise DesignError(
            f"{path}: {key} = {shown(value)} has no unit; write it like "
            f"{key} = {dimension.example(0.1)}."
        )
    try:
        found = parse_quantity(value, dimension)
    except DesignError as error:
        raise DesignError(f"{path}: {key}: {error.message.rstrip('.')}.") from error
    if found < 0.0 or (found == 0.0 and not zero) or not math.isfinite(found):
        limit = "0 or more" if zero else "above 0"
        raise DesignError(f"{path}: {key} {value} must be {limit}; no motor has that.")
    return found
