"""The `Design`: everything a design file says, resolved, immutable, SI inside."""

from __future__ import annotations

import hashlib
import html
import json
from collections.abc import Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, Literal

from pydantic import PrivateAttr, ValidationError, model_validator

from cqdd_design.catalog.motors import Motor
from cqdd_design.design.actuator import Drive, Edm, Environment, Housing, Tolerances
from cqdd_design.design.contradictions import defaults_it_does_not_have, too_cold_a_surface
from cqdd_design.design.fields import FrozenModel
from cqdd_design.design.motor import SUPPLY, MotorFile, MotorTable
from cqdd_design.design.motor_row import IN_DESIGN, motor_row, own_table
from cqdd_design.design.printing import Printing
from cqdd_design.design.problems import describe_problems
from cqdd_design.design.reducer import Reducer
from cqdd_design.design.requirements import Requirements
from cqdd_design.design.tables import delete_key, dump, insert_key, leaves, leaves_of
from cqdd_design.errors import DesignError, is_unprintable, shown
from cqdd_design.files import refuse_extremes
from cqdd_design.units import CURRENT, LENGTH, VOLTAGE, format_quantity

if TYPE_CHECKING:
    from cqdd_design.design.duty_log import DutyColumns, DutyLog

SCHEMA_VERSION: Literal[1] = 1
#: Bytes of a name; file names add theirs, and 255 is the most that file systems take.
_LONGEST_NAME = 200


class Design(FrozenModel):
    """A complete actuator design.

    Attribute names are the keys of the file; every quantity is an SI float, so
    ``design.reducer.eccentricity`` is in metres. Keys that the file left out hold their defaults
    and are listed by `assumed`.

    Examples
    --------
    >>> import cqdd_design as cq
    >>> design = cq.load("cqdd-10")
    >>> design.reducer.ring_pitch_radius, design.requirements.peak_torque  # m, N m
    (0.032, 120.0)
    """

    schema_version: Literal[1] = SCHEMA_VERSION
    name: str = "unnamed"
    requirements: Requirements
    reducer: Reducer
    motor: MotorTable = MotorTable()
    drive: Drive = Drive()
    housing: Housing = Housing()
    environment: Environment = Environment()
    tolerances: Tolerances = Tolerances()
    edm: Edm = Edm()
    printing: Printing | None = None

    if TYPE_CHECKING:  # what is an attribute's float is given with its unit

        def __init__(self, **tables: Any) -> None: ...

    _assumed: tuple[str, ...] = PrivateAttr(default=())
    _motor_place: str = PrivateAttr(default=IN_DESIGN)
    _file: str = PrivateAttr(default="")

    def __repr__(self) -> str:
        """Its name and what one would say of it first; `to_mapping` has the rest."""
        ratio, ring, discs, motor = self._told
        return f"Design {self.name}: ratio {ratio}, ring {ring}, {discs} of disc, {motor}"

    __str__ = __repr__

    def _repr_html_(self) -> str:
        """What a notebook shows of it: the same in a table."""
        rows = zip(("Ratio", "Ring", "Discs", "Motor"), self._told, strict=True)
        cells = "".join(
            f"<tr><th>{head}</th><td>{html.escape(value)}</td></tr>" for head, value in rows
        )
        return f"<table><caption>{html.escape(self.name)}</caption>{cells}</table>"

    @property
    def _told(self) -> tuple[str, str, str, str]:
        """Ratio, ring, discs and motor, as one would say them."""
        reducer = self.reducer
        lengths = (reducer.ring.outer_diameter, reducer.disc_thickness)
        ring, disc = (format_quantity(one, LENGTH) for one in lengths)
        discs = f"{reducer.disc_count} x {disc}"
        return str(reducer.ratio), ring, discs, self.motor.name

    @model_validator(mode="before")
    @classmethod
    def _said_once(cls, data: Any) -> Any:
        """What one table says holds in another that is silent: ratio, supply and current."""
        if not isinstance(data, dict):
            return data
        filled = dict(data)
        reducer = filled.get("reducer")
        requirements = filled.get("requirements", {})
        if isinstance(reducer, dict) and isinstance(requirements, dict) and "ratio" in reducer:
            filled["requirements"] = {"ratio": reducer["ratio"], **requirements}
        motor = filled.get("motor", {})
        if isinstance(motor, dict) and isinstance(requirements, dict):
            stated = {key: requirements[own] for key, own in SUPPLY.items() if own in requirements}
            if stated:
                filled["motor"] = {**stated, **motor}
        return filled

    @model_validator(mode="after")
    def _consistent(self) -> Design:
        if self.motor.thermal_resistance is not None and self.drive.thermal_resistance > 0.0:
            raise ValueError(
                "motor.thermal_resistance and drive.thermal_resistance both say how the winding is "
                "cooled; keep one of them"
            )
        if self.requirements.ratio != self.reducer.ratio:
            raise ValueError(
                f"requirements.ratio {self.requirements.ratio} is not reducer.ratio "
                f"{self.reducer.ratio}; make them equal or leave requirements.ratio out"
            )
        self._refuse_contradictions()
        if not _is_part_of_file_names(self.name):
            raise ValueError(
                f"name {self.name[:_LONGEST_NAME]!a} becomes part of file names; "
                f"use letters, digits, blanks, '-' and '_', {_LONGEST_NAME} bytes at most"
            )
        return self

    def _refuse_contradictions(self) -> None:
        """Refuse requirements that other tables contradict."""
        asked, ambient = self.requirements, self.environment.ambient
        for key, own in SUPPLY.items():
            dimension = VOLTAGE if own == "voltage" else CURRENT
            there, most = getattr(self.motor, key), getattr(asked, own)
            if most is not None and there > most * (1.0 + 1e-12):
                raise ValueError(
                    f"motor.{key} {format_quantity(there, dimension)} is above requirements.{own} "
                    f"{format_quantity(most, dimension)}; make them equal or leave motor.{key} out"
                )
        if cold := too_cold_a_surface(asked, ambient):
            raise ValueError(cold)

    @classmethod
    def from_mapping(
        cls, data: Mapping[str, Any], *, source: str = "design", si: bool = False, file: str = ""
    ) -> Design:
        """Validate a nested mapping with the keys of a design file.

        Parameters
        ----------
        data : mapping
            Nested tables; quantities as unit strings, or as SI floats when `si` is true.
        source : str
            What to call the input in messages (a file name).
        si : bool
            Accept SI floats for quantities.
        file : str
            Name without ending of the design's own file, if it is in one; see `file_name`.

        Returns
        -------
        Design
            Resolved, with `assumed` naming every key that was left to its default.

        Raises
        ------
        DesignError
            One sentence a problem: key, value, range and nearest fix.
        """
        _refuse_no_mapping(data, source)
        refuse_extremes(data, source, wrong=DesignError)
        try:
            design = cls.model_validate(dict(data), context={"si": si})
        except ValidationError as error:
            raise describe_problems(error, cls, source) from None
        given = set(leaves(data))
        if design.motor.data or design.motor.based_on:
            # Whoever gives a motor's data asks for that motor.
            given.add("motor.name")
        below = tuple(f"{key}." for key in given)
        design._assumed = tuple(
            key for key in design.dotted_keys() if key not in given and not key.startswith(below)
        )
        if file := _in_file_names(file):
            design._file = "" if file == design.name else file
        return design

    @property
    def file_name(self) -> str:
        """What its files are called: as the one that it was read from, or else by its name.

        A copy of a design may still have the other's name in it, but no files of the other's.
        """
        return self._file or self.name

    @property
    def assumed(self) -> tuple[str, ...]:
        """Dotted keys left to their defaults, in file order."""
        return self._assumed

    @property
    def carrier_material(self) -> str:
        """What plate and cap of the carrier are of: the housing's material unless stated."""
        stated = self.reducer.carrier.material
        return self.housing.material if stated == "auto" else stated

    @property
    def motor_row(self) -> Motor:
        """The motor that ``[motor]`` means, as a row of the catalogue; see `design.motor_row`."""
        return motor_row(self.motor, self._motor_place)

    def with_motor(self, name: str | None = None, motor: MotorFile | None = None) -> Design:
        """The design with another motor in its ``[motor]`` table, behind the same driver.

        A motor file goes over what the design says of its motor, and that over the catalogue's row;
        see `motor_row.own_table`.

        Parameters
        ----------
        name : str, optional
            Of a motor of the catalogue, instead of the design's and of all that it says of it.
        motor : MotorFile, optional
            What a file says of the motor.

        Raises
        ------
        DesignError
            Where the catalogue has no such bare motor, or the data make no motor.
        """
        if name is not None:
            found = self._with_motor_table({"name": name})
            found._motor_place = IN_DESIGN
            return found if motor is None else found._with_motor_file(motor, named=True)
        return self if motor is None else self._with_motor_file(motor)

    def _with_motor_file(self, motor: MotorFile, *, named: bool = False) -> Design:
        found = self._with_motor_table(
            own_table(self.motor, motor, named=named),
            *(("drive.thermal_resistance",) if motor.thermal_resistance is not None else ()),
        )
        found._motor_place = f"file: {motor.place}"
        return found

    def _with_motor_table(self, keys: Mapping[str, Any], *without: str) -> Design:
        """The design with these keys of its motor, SI, and some others left to their defaults."""
        mapping = self.to_mapping()
        for key in (*self.assumed, *without):
            delete_key(mapping, key)
        table = mapping.pop("motor", {})
        driver = {key: table[key] for key in ("voltage", "current_limit") if key in table}
        return self._rebuilt(mapping | {"motor": {**keys, **driver}})

    def leaving(self, *keys: str) -> Design:
        """A design in which dotted keys are left to their defaults."""
        mapping = self.to_mapping()
        for key in (*self.assumed, *keys):
            delete_key(mapping, key)
        return self._rebuilt(mapping)

    def _defaults_it_does_not_have(self) -> list[str]:
        return defaults_it_does_not_have(self.requirements, self.reducer, self.motor)

    def dotted_keys(self) -> tuple[str, ...]:
        """All dotted keys of the resolved design, in file order."""
        without = {f"requirements.{key}" for key in self._defaults_it_does_not_have()}
        return tuple(key for key in leaves_of(self) if key not in without)

    def to_mapping(self) -> dict[str, Any]:
        """The design as nested tables with unit strings, every key present that has a value.

        But for requirements that nobody stated and whose part the design has another of: in a file
        they would ask for what it is not.
        """
        mapping = dump(self)
        for key in self._defaults_it_does_not_have():
            mapping["requirements"].pop(key)
        return mapping

    def replacing(self, changes: Mapping[str, Any]) -> Design:
        """A design in which the given dotted keys have new values (SI floats or unit strings).

        Keys that were assumed before stay assumed unless they are among the changes.
        """
        _refuse_no_mapping(changes, self.name)
        mapping = self.to_mapping()
        for key in self.assumed:
            delete_key(mapping, key)
        for key, value in changes.items():
            insert_key(mapping, key, value)
        return self._rebuilt(mapping)

    def _rebuilt(self, mapping: Mapping[str, Any]) -> Design:
        """The design of other values, with what this one read from files that it still names."""
        changed = Design.from_mapping(mapping, source=self.name, si=True)
        changed._motor_place = self._motor_place
        if changed.name == self.name:
            changed._file = self._file
        asked, new = self.requirements, changed.requirements
        if (new.duty_file, new.duty_columns) != (asked.duty_file, asked.duty_columns):
            return changed
        return changed.with_duty_log(asked.duty_log)

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Design:
        """A copy, checked like a file; keys of the tables that it replaces count as given."""
        changed = super().model_copy(update=update, deep=deep)
        changed._assumed = tuple(
            key for key in self._assumed if key.partition(".")[0] not in (update or {})
        )
        return changed

    def with_duty_log(self, log: DutyLog | None) -> Design:
        """The same design with what its duty's file says."""
        changed = self.unchecked_copy({"requirements": self.requirements.with_duty_log(log)})
        changed._assumed, changed._motor_place = self._assumed, self._motor_place
        changed._file = self._file
        return changed

    def under_duty(self, log: DutyLog, file: str, columns: DutyColumns | None = None) -> Design:
        """The design under another duty, which comes from a file, in place of its own."""
        mapping = self.to_mapping()
        for key in self.assumed:
            delete_key(mapping, key)
        for key in ("duty", "duty_file", "duty_columns"):
            mapping["requirements"].pop(key, None)
        mapping["requirements"] |= duty_keys(file, columns)
        return self._rebuilt(mapping).with_duty_log(log)

    def turning_at(self, speed: float) -> Design:
        """The design whose input turns at a speed (rad/s), under whatever torque."""
        asked = self.requirements
        changes: dict[str, float] = {"requirements.input_speed": speed}
        if asked.continuous_speed is not None:
            changes["requirements.continuous_speed"] = speed
        if asked.speed_at_peak is not None:
            changes["requirements.speed_at_peak"] = min(asked.speed_at_peak, speed / asked.ratio)
        return self.replacing(changes)

    def under_torque(self, torque: float) -> Design:
        """The design with one torque (N m) for peak, continuous torque and duty."""
        mapping = self.to_mapping()
        for key in self.assumed:
            delete_key(mapping, key)
        asked = mapping.setdefault("requirements", {})
        for key in ("duty", "duty_file", "duty_columns"):
            asked.pop(key, None)
        asked |= {"peak_torque": torque, "continuous_torque": torque}
        return Design.from_mapping(mapping, source=self.name, si=True)

    @property
    def sha256(self) -> str:
        """Hash of the resolved design: equal designs, equal hash, whatever the file looks like."""
        log = self.requirements.duty_log
        mapping = dump(self) | ({} if log is None else {"duty_digest": log.digest})
        text = json.dumps(mapping, sort_keys=True, ensure_ascii=False)
        return hashlib.sha256(text.encode()).hexdigest()


def _refuse_no_mapping(given: object, source: str) -> None:
    if not isinstance(given, Mapping):
        raise DesignError(
            f"{source}: {shown(given)} is no mapping of keys to values, such as "
            '{"reducer.eccentricity": "1.2 mm"} or tables of a design file.'
        )


def _in_file_names(name: str) -> str:
    """A file's name with signs that not every system takes replaced; empty where that is none."""
    kept = "".join("_" if c in '/\\:*?"<>|' or is_unprintable(c) else c for c in name)
    return kept if _is_part_of_file_names(kept) else ""


def _is_part_of_file_names(name: str) -> bool:
    """Whether files of every system can be called so, with what is put behind it."""
    return (
        bool(name.strip(" ."))
        and len(name.encode("utf-8", "replace")) <= _LONGEST_NAME
        and not any(c in '/\\:*?"<>|' or is_unprintable(c) for c in name)
    )


def duty_keys(file: str, columns: DutyColumns | None = None) -> dict[str, Any]:
    """The keys of requirements that name the file of a duty, and its columns where given."""
    named = {key: text for key, text in asdict(columns).items() if text} if columns else {}
    return {"duty_file": file} | ({"duty_columns": named} if named else {})


def supply_taken_over(design: Design) -> dict[str, str]:
    """Keys of the motor's supply that follow from a requirement where left out, and from which."""
    return {
        f"motor.{key}": f"requirements.{own}"
        for key, own in SUPPLY.items()
        if getattr(design.requirements, own) is not None
    }
