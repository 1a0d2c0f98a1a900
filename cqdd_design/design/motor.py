"""A motor in a design file's ``[motor]`` table, or in a file of its own: the same keys, one reader.

A table that gives a torque (or speed) constant and a resistance describes a motor of its own: what
it leaves out is not known. With ``based_on``, or under a name of the catalogue, the catalogue's row
gives the rest::

    name = "rewound RO100"
    based_on = "CubeMars RO100 KV55"
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
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import PrivateAttr, ValidationError, model_validator

from cqdd_design.catalog.motors import (
    Motor,
    find_bare_motor,
    find_motor,
    motors,
    torque_constant_from,
)
from cqdd_design.design.fields import FreeText, FrozenModel, MotorName, Whole, default
from cqdd_design.design.motor_sizes import not_inside
from cqdd_design.design.problems import describe_problems
from cqdd_design.errors import CatalogError, DesignError, shown
from cqdd_design.files import parse_toml, read_text_file, refuse_extremes
from cqdd_design.units import (
    CURRENT,
    DAMPING_GAIN,
    INDUCTANCE,
    INERTIA,
    LENGTH,
    MASS,
    RESISTANCE,
    SPEED_CONSTANT,
    TEMPERATURE,
    THERMAL_RESISTANCE,
    TORQUE,
    TORQUE_CONSTANT,
    VOLTAGE,
    QuantityIn,
    format_quantity,
)

DEFAULT_MOTOR = "CubeMars RO100 KV55"
NAMELESS = "motor of the design"
"""Of a motor of one's own that is given no name."""
_MOST_BYTES = 1_000_000

Convention = Literal[
    "dc",
    "torque_per_peak",
    "torque_per_rms",
    "emf_line_peak",
    "emf_line_rms",
    "emf_phase_peak",
    "emf_phase_rms",
]


SUPPLY = {"voltage": "voltage", "current_limit": "current"}
"""Keys of a driver under ``motor``, and the requirements that say the same."""


class MotorData(FrozenModel):
    """What may be said of a motor; every key may be left out.

    Conventions are those of a data sheet: `row_values` has them as the catalogue counts.
    """

    name: FreeText = ""
    based_on: MotorName | None = None
    kind: Literal["outrunner", "inrunner"] | None = None
    torque_constant: (
        Annotated[
            float,
            QuantityIn(TORQUE_CONSTANT, "0.00001 N*m/A", "1000 N*m/A", "K, or the EMF over speed"),
        ]
        | None
    ) = None
    convention: Convention | None = None
    speed_constant: (
        Annotated[
            float,
            QuantityIn(SPEED_CONSTANT, "0.01 rpm/V", "1000000 rpm/V", "KV, instead of K"),
        ]
        | None
    ) = None
    resistance: (
        Annotated[
            float,
            QuantityIn(RESISTANCE, "0.00001 ohm", "10000 ohm", "of the winding at 25 degC"),
        ]
        | None
    ) = None
    inductance: (
        Annotated[float, QuantityIn(INDUCTANCE, "0 uH", "10000000 uH", "of the winding")] | None
    ) = None
    measured_between: Literal["line", "phase"] | None = None
    pole_pairs: Annotated[int, Whole(1, 1000, "of the rotor")] | None = None
    slots: Annotated[int, Whole(1, 1000, "of the stator")] | None = None
    rotor_inertia: (
        Annotated[
            float,
            QuantityIn(INERTIA, "1e-9 kg*m^2", "10 kg*m^2", "rotor with its bell, if it is known"),
        ]
        | None
    ) = None
    mass: Annotated[float, QuantityIn(MASS, "0.001 kg", "1000 kg", "rotor and stator")] | None = (
        None
    )
    rotor_mass: (
        Annotated[float, QuantityIn(MASS, "0.001 kg", "1000 kg", "with its bell; instead of mass")]
        | None
    ) = None
    stator_mass: (
        Annotated[
            float, QuantityIn(MASS, "0.001 kg", "1000 kg", "with its winding; instead of mass")
        ]
        | None
    ) = None
    rated_torque: (
        Annotated[float, QuantityIn(TORQUE, "0.1 mN*m", "100000 N*m", "for ever, by its maker")]
        | None
    ) = None
    peak_torque: (
        Annotated[float, QuantityIn(TORQUE, "0.1 mN*m", "100000 N*m", "for seconds, by its maker")]
        | None
    ) = None
    rated_current: (
        Annotated[float, QuantityIn(CURRENT, "0.01 A", "10000 A", "at the rated torque")] | None
    ) = None
    peak_current: (
        Annotated[float, QuantityIn(CURRENT, "0.01 A", "10000 A", "at the peak torque")] | None
    ) = None
    coulomb: (
        Annotated[
            float,
            QuantityIn(TORQUE, "0 N*m", "1000 N*m", "drag of the motor alone, whatever its speed"),
        ]
        | None
    ) = None
    viscous: (
        Annotated[
            float,
            QuantityIn(DAMPING_GAIN, "0 N*m*s/rad", "100 N*m*s/rad", "drag that grows with speed"),
        ]
        | None
    ) = None
    hysteresis: (
        Annotated[
            float,
            QuantityIn(TORQUE, "0 N*m", "1000 N*m", "of the iron, where coulomb leaves it out"),
        ]
        | None
    ) = None
    iron_loss: (
        Annotated[
            float,
            QuantityIn(
                DAMPING_GAIN,
                "0 N*m*s/rad",
                "100 N*m*s/rad",
                "eddies, where viscous leaves them out",
            ),
        ]
        | None
    ) = None
    cogging_amplitude: (
        Annotated[float, QuantityIn(TORQUE, "0 N*m", "1000 N*m", "half of peak to peak")] | None
    ) = None
    cogging_order: (
        Annotated[int, Whole(1, 100_000, "periods in a turn: lcm of slots and poles")] | None
    ) = None
    thermal_resistance: (
        Annotated[
            float,
            QuantityIn(
                THERMAL_RESISTANCE,
                "0.001 K/W",
                "1000 K/W",
                "winding to ambient as built in, where drive.thermal_resistance does not say",
            ),
        ]
        | None
    ) = None
    winding_limit: (
        Annotated[float, QuantityIn(TEMPERATURE, "40 degC", "300 degC", "wire, bond and magnets")]
        | None
    ) = None
    outer_diameter: (
        Annotated[float, QuantityIn(LENGTH, "1 mm", "3000 mm", "of the rotor's bell")] | None
    ) = None
    length: Annotated[float, QuantityIn(LENGTH, "1 mm", "3000 mm", "of the whole motor")] | None = (
        None
    )
    bore_diameter: (
        Annotated[float, QuantityIn(LENGTH, "0.5 mm", "3000 mm", "of the stator, for the gearbox")]
        | None
    ) = None
    hollow_diameter: (
        Annotated[float, QuantityIn(LENGTH, "0.5 mm", "3000 mm", "through rotor or shaft")] | None
    ) = None
    gap_diameter: (
        Annotated[float, QuantityIn(LENGTH, "1 mm", "3000 mm", "of the air gap")] | None
    ) = None
    stack_length: (
        Annotated[float, QuantityIn(LENGTH, "0.5 mm", "3000 mm", "of the laminations")] | None
    ) = None
    rotor_length: (
        Annotated[float, QuantityIn(LENGTH, "0.5 mm", "3000 mm", "of the ring of magnets")] | None
    ) = None
    slot_depth: (
        Annotated[float, QuantityIn(LENGTH, "0.5 mm", "1000 mm", "of the stator's slots")] | None
    ) = None

    @model_validator(mode="after")
    def _says_one_thing(self) -> MotorData:
        if self.torque_constant is not None and self.speed_constant is not None:
            raise ValueError(
                f"torque_constant {format_quantity(self.torque_constant, TORQUE_CONSTANT)} and "
                f"speed_constant {format_quantity(self.speed_constant, SPEED_CONSTANT)} say the "
                "same; keep one of them"
            )
        if self.convention is not None and self.torque_constant is None:
            raise ValueError("convention is of a torque_constant, which is missing; add it")
        if self.measured_between is not None and self.resistance is self.inductance is None:
            raise ValueError(
                "measured_between is of a resistance and an inductance, which are missing; add one"
            )
        parts = (self.rotor_mass, self.stator_mass)
        if self.mass is not None and parts != (None, None):
            raise ValueError("mass is that of rotor and stator; keep it, or keep both of them")
        if (self.rotor_mass is None) != (self.stator_mass is None):
            raise ValueError("rotor_mass and stator_mass add up to the mass; give both, or mass")
        told = not_inside(vars(self))
        if told:
            raise ValueError(told)
        return self

    @model_validator(mode="after")
    def _one_base(self) -> MotorData:
        """Call a motor of the catalogue by its name there; refuse two of them."""
        name = _name_in_catalogue(self.name)
        if name and self.based_on is not None and name != self.based_on:
            raise ValueError(
                f"name '{name}' is a motor of the catalogue and based_on '{self.based_on}' is "
                "another; leave based_on out, or choose a name of your own"
            )
        return self.unchecked_copy({"name": name}) if name and name != self.name else self

    @property
    def base(self) -> str:
        """The catalogue's row that gives what is left out; empty where nothing does."""
        if self.based_on is not None:
            return self.based_on
        return self.name if self.name in motors() else ""

    @property
    def data(self) -> dict[str, Any]:
        """What is given of the motor, in the words of its keys but SI: all but its names."""
        found = {name: getattr(self, name) for name in MotorData.model_fields}
        return {
            name: value
            for name, value in found.items()
            if value is not None and name not in ("name", "based_on")
        }

    @property
    def stands_alone(self) -> bool:
        """Whether a torque (or speed) constant and a resistance are given: a motor of its own."""
        constant = self.torque_constant is not None or self.speed_constant is not None
        return constant and self.resistance is not None

    @property
    def row_values(self) -> dict[str, Any]:
        """Fields of a catalogue's row that are given: K of the DC machine, values line to line."""
        found = self.data
        told = {name: found[name] for name in _SAME if name in found}
        if self.torque_constant is not None:
            constant = torque_constant_from(self.torque_constant, self.convention or "dc")
            told["speed_constant"] = 1.0 / constant
        doubled = 2.0 if self.measured_between == "phase" else 1.0
        for name in ("resistance", "inductance"):
            if name in found:
                told[f"line_{name}"] = doubled * found[name]
        if self.rotor_mass is not None and self.stator_mass is not None:
            told["mass"] = self.rotor_mass + self.stator_mass
            told["rotor_mass"] = self.rotor_mass
        return told


_SAME = tuple(
    field.name
    for field in dataclasses.fields(Motor)
    if field.name in MotorData.model_fields and field.name != "name"
)
"""Keys that are fields of a catalogue's row."""


class MotorTable(MotorData):
    """The motor and what its driver allows it."""

    name: FreeText = DEFAULT_MOTOR
    voltage: Annotated[float, QuantityIn(VOLTAGE, "1 V", "1000 V", "supply of the driver")] = (
        default("48 V")
    )
    current_limit: Annotated[
        float, QuantityIn(CURRENT, "0.01 A", "2000 A", "limit of the driver")
    ] = default("50.5 A")

    @model_validator(mode="after")
    def _one_motor(self) -> MotorTable:
        """See that the motor is known from its own data or from the catalogue's."""
        if "name" not in self.model_fields_set:
            if self.based_on is None and not self.stands_alone:
                return self
            return self.unchecked_copy({"name": self.based_on or NAMELESS})
        if self.base:
            name = self.base
        elif self.stands_alone:
            return self
        else:
            name = self.name
        try:
            find_bare_motor(name)
        except DesignError as error:
            raise ValueError(f"name: {error.message}") from None
        except CatalogError as error:
            raise ValueError(
                f"name: {error.message.removesuffix('.')}; a motor of your own gives "
                "torque_constant (or speed_constant) and resistance, or names the catalogue's that "
                "it is based_on"
            ) from None
        return self


class MotorFile(MotorData):
    """A motor of a file of its own, called like the file unless it gives a name."""

    _place: str = PrivateAttr(default="")

    @property
    def place(self) -> str:
        """The file's name."""
        return self._place

    @classmethod
    def from_mapping(
        cls, data: Mapping[str, Any], *, source: str = "motor", place: str = "", si: bool = False
    ) -> MotorFile:
        """Validate a mapping of the keys of a motor file; a `DesignError` says what is wrong."""
        refuse_extremes(data, source, wrong=DesignError)
        try:
            found = cls.model_validate(dict(data), context={"si": si})
        except ValidationError as error:
            raise describe_problems(error, cls, source) from None
        found._place = place or source
        return found


def read_motor(path: Path) -> MotorFile:
    """Read a motor file: the keys alone, or under ``[motor]`` as in a design.

    Raises
    ------
    UsageError
        When it cannot be read.
    DesignError
        When it is not TOML, has an unknown key, a value without or with another unit, one that no
        motor has, or a torque constant and a speed constant.
    """
    content = parse_toml(read_text_file(path, _MOST_BYTES), path, wrong=DesignError)
    table = content.get("motor")
    if isinstance(table, dict):
        others = ", ".join(shown(key) for key in content if key != "motor")
        if others:
            raise DesignError(
                f"{path} is no motor file: beside [motor] it has {others}. A motor file has the "
                "keys of a motor alone, with or without [motor] above them."
            )
        content = dict(table)
    if drivers := " or ".join(key for key in SUPPLY if key in content):
        raise DesignError(
            f"{path}: no motor file has {drivers}; the driver's supply and limit stand in [motor] "
            "of the design."
        )
    content.setdefault("name", path.stem)
    return MotorFile.from_mapping(content, source=str(path), place=path.name)


def motor_of_requirements(table: object, source: Path) -> tuple[str, MotorFile | None]:
    """The motor of the file whose requirements are read: its base, and what it says of it.

    Parameters
    ----------
    table : object
        What stands under ``motor`` in the file, the driver's keys among it.

    Returns
    -------
    base : str
        Name in the catalogue; empty where the table names none.
    motor : MotorFile or None
        None where the table says no more than a name.
    """
    if not isinstance(table, Mapping):
        return "", None
    keys = {key: value for key, value in table.items() if key not in SUPPLY}
    found = MotorFile.from_mapping(keys, source=f"{source}: motor", place=source.name)
    return found.base, found if found.data else None


def supply_of_requirements(table: object) -> dict[str, Any]:
    """What the driver's keys under ``motor`` ask for, as keys of requirements."""
    if not isinstance(table, Mapping):
        return {}
    return {own: table[key] for key, own in SUPPLY.items() if key in table}


def _name_in_catalogue(name: str) -> str:
    """The catalogue's spelling of a name, a geared actuator's too; empty where it has none."""
    try:
        return find_motor(name).name
    except CatalogError:
        return ""
