"""What ISO 6336 leaves to the designer, with a stated default and its reason for each."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from cqdd_design.errors import DesignError, UsageError, did_you_mean, shown
from cqdd_design.files import parse_toml, read_text_file
from cqdd_design.planetary.gear_material import QUALITIES, Quality
from cqdd_design.planetary.iso6336.influence import MESH_LOAD_TABLES
from cqdd_design.planetary.profile_shift import ProfileShifts
from cqdd_design.units import (
    LENGTH,
    SMALL_LENGTH,
    VISCOSITY,
    Dimension,
    read_quantity,
    real_number,
    whole_number,
)

_LARGEST_FILE = 100_000


@dataclass(frozen=True)
class RatingSettings:
    """What ISO 6336 leaves to the designer.

    Attributes
    ----------
    material_quality : {"ML", "MQ", "ME"}
        Of ISO 6336-5. MQ is what an experienced maker reaches at ordinary cost.
    application_factor : float
        K_A. 1: peak and continuous torque are stated apart, as for the cycloid.
    mesh_load_table : str
        K_gamma by number of planets, a key of `influence.MESH_LOAD_TABLES`.
    dynamic_factor, face_load_factor, transverse_load_factor : float or None
        K_v, K_Hbeta, K_Halpha where stated; None computes them by methods B, C and B. A stated
        factor holds for the root as well (K_Fbeta follows from K_Hbeta by 7.6).
    accuracy_class : int
        ISO 1328-1 class. 5, ground: the care the paper spends on its +-2 um cycloid.
    crowned : bool
        Flanks crowned by half the mounting misalignment, as planets should be.
    lubricant_viscosity : float
        nu_40 in m^2/s. 150 mm^2/s, the base oil of a common NLGI 2 gear grease.
    flank_roughness, root_roughness : float
        R_z in m. 3 um for ground or finely eroded flanks; 10 um, the test gears', for the root.
    life_hours : float
        Life at the continuous torque and full input speed. 1000 h, as asked of the cam bearing.
    peak_cycles : float
        Load cycles of every tooth at peak torque. 1e4: still static strength in ISO 6336-3, as the
        cycloid's peak limits are static.
    least_contact_safety, least_bending_safety : float
        S_H 1.0 and S_F 1.2, the margins the cycloid's contact and pins must keep.
    shifts : ProfileShifts or None
        None for :func:`profile_shift.default_shifts`.
    ring_tip_diameter : float or None
        As made, m; None for the rack's, shortened to what clears the planet's root.

    Raises
    ------
    UsageError
        A setting outside the range that the formulas hold for.
    """

    material_quality: Quality = "MQ"
    application_factor: float = 1.0
    mesh_load_table: str = "iso"
    dynamic_factor: float | None = None
    face_load_factor: float | None = None
    transverse_load_factor: float | None = None
    accuracy_class: int = 5
    crowned: bool = True
    lubricant_viscosity: float = 150e-6
    flank_roughness: float = 3e-6
    root_roughness: float = 10e-6
    life_hours: float = 1000.0
    peak_cycles: float = 1e4
    least_contact_safety: float = 1.0
    least_bending_safety: float = 1.2
    shifts: ProfileShifts | None = None
    ring_tip_diameter: float | None = None

    def __post_init__(self) -> None:
        """Refuse settings outside the ranges the formulas hold for."""
        for name, row in SETTINGS.items():
            value = getattr(self, name)
            if row.most > 0.0 and value is not None and not row.least <= value <= row.most:
                raise UsageError(
                    f"settings: {name} = {row.text(value)} is outside {row.text(row.least)} to "
                    f"{row.text(row.most)}; {row.text(row.usual)} is usual."
                )

    @classmethod
    def nominal(cls) -> RatingSettings:
        """All load factors K = 1: the stress of a perfect gear, for comparison by hand."""
        return cls(
            mesh_load_table="equal",
            dynamic_factor=1.0,
            face_load_factor=1.0,
            transverse_load_factor=1.0,
        )

    @property
    def label(self) -> str:
        """The load factors in words, as answers quote them."""
        parts = [f"K_A {self.application_factor:g}"]
        equal = self.mesh_load_table == "equal"
        parts.append("K_gamma 1" if equal else f"K_gamma by table '{self.mesh_load_table}'")
        for name, value, method in (
            ("K_v", self.dynamic_factor, "B"),
            ("K_Hbeta", self.face_load_factor, "C"),
            ("K_Halpha", self.transverse_load_factor, "B"),
        ):
            parts.append(f"{name} {value:g}" if value is not None else f"{name} method {method}")
        if None in (self.dynamic_factor, self.face_load_factor, self.transverse_load_factor):
            crowning = "crowned" if self.crowned else "not crowned"
            parts.append(f"class {self.accuracy_class}, {crowning}")
        return ", ".join(parts)

    def rows(self) -> tuple[tuple[str, str, bool], ...]:
        """Name, value with its unit and whether it is the default, of every setting."""
        usual = RatingSettings()
        return tuple(
            (
                name,
                " ".join(part for part in (row.text(getattr(self, name)), row.unit) if part),
                getattr(self, name) == getattr(usual, name),
            )
            for name, row in SETTINGS.items()
        )

    def to_dict(self) -> dict[str, object]:
        """Every setting, units in the names; null is what the standard or the teeth give."""
        found: dict[str, object] = {}
        for name, row in SETTINGS.items():
            value = getattr(self, name)
            if isinstance(value, ProfileShifts):
                value = dict(vars(value))
            elif row.dimension is not None and value is not None:
                value = value / row.dimension.si_factor
            found[name + row.suffix] = value
        return found


class Setting(NamedTuple):
    """How one setting is written, and its range.

    `usual` is what the message of a refusal offers; without `most` there is no range. `unit` is
    that of a number which is written without one, because its name says it.
    """

    least: float = 0.0
    most: float = 0.0
    usual: float = 0.0
    dimension: Dimension | None = None
    suffix: str = ""
    choices: tuple[str, ...] = ()
    kind: type = float
    missing: str = ""
    unit: str = ""

    def text(self, value: Any) -> str:
        """A value as people read it."""
        if value is None:
            return self.missing
        if isinstance(value, ProfileShifts):
            return ", ".join(f"{shift:g}" for shift in vars(value).values())
        if isinstance(value, bool):
            return "yes" if value else "no"
        if isinstance(value, str):
            return value
        if self.dimension is not None:
            return f"{value / self.dimension.si_factor:.10g} {self.dimension.unit}"
        return f"{value:g}"

    def read(self, name: str, value: Any) -> Any:
        """The value of a file or option, SI; a `UsageError` says how it is written."""
        if self.dimension is not None:
            try:
                return read_quantity(value, self.dimension)
            except DesignError as error:
                raise UsageError(f"{name}: {error.message.rstrip('.')}.") from None
        if self.kind is ProfileShifts:
            return _shifts(name, value)
        number = whole_number(value) if self.kind is int else real_number(value)
        if self.kind in (float, int) and number is not None:
            return number
        if isinstance(value, str) and self.choices and value not in self.choices:
            hint = did_you_mean(value, self.choices) or "."
            raise UsageError(f"{name} = {shown(value)} is none of {', '.join(self.choices)}{hint}")
        if self.kind in (str, bool) and isinstance(value, self.kind):
            return value
        words = {float: "a number", int: "a whole number", str: "a name in quotes"}
        example = self.text(self.usual) if self.most else (*self.choices, "true")[0]
        raise UsageError(
            f"{name} = {shown(value)} is not {words.get(self.kind, 'true or false')}, such as "
            f"{example}."
        )


#: Every setting by its name in files; the options of `compare` are the same with dashes.
SETTINGS: Mapping[str, Setting] = {
    "material_quality": Setting(choices=QUALITIES, kind=str),
    "application_factor": Setting(0.1, 10.0, 1.0),
    "mesh_load_table": Setting(choices=tuple(MESH_LOAD_TABLES), kind=str),
    "dynamic_factor": Setting(1.0, 10.0, 1.05, missing="by method B"),
    "face_load_factor": Setting(1.0, 10.0, 1.25, missing="by method C"),
    "transverse_load_factor": Setting(1.0, 10.0, 1.0, missing="by method B"),
    "accuracy_class": Setting(1, 11, 5, kind=int),
    "crowned": Setting(kind=bool),
    "lubricant_viscosity": Setting(1e-6, 1e-1, 150e-6, VISCOSITY, "_mm2_per_s"),
    "flank_roughness": Setting(0.1e-6, 100e-6, 3e-6, SMALL_LENGTH, "_um"),
    "root_roughness": Setting(0.1e-6, 100e-6, 10e-6, SMALL_LENGTH, "_um"),
    "life_hours": Setting(1e-3, 1e7, 1000.0, unit="h"),
    "peak_cycles": Setting(1.0, 1e12, 1e4),
    "least_contact_safety": Setting(0.1, 10.0, 1.0),
    "least_bending_safety": Setting(0.1, 10.0, 1.2),
    "shifts": Setting(kind=ProfileShifts, missing="least without undercut"),
    "ring_tip_diameter": Setting(
        1e-3, 1.0, 68.22e-3, LENGTH, "_mm", missing="clears the planet's root"
    ),
}


def _shifts(name: str, value: Any) -> ProfileShifts:
    """Four numbers as a list, or as text with commas."""
    parts = value.split(",") if isinstance(value, str) else value
    try:
        numbers = [float(part) for part in parts]
    except (TypeError, ValueError):
        numbers = []
    if len(numbers) != 4 or not all(-2.0 <= number <= 2.0 for number in numbers):
        raise UsageError(
            f"{name} = {shown(value)} must be four profile shifts from -2 to 2, of sun, planet at "
            "the sun, planet at the ring and ring, such as 0.3, -0.3, 0, 0."
        )
    return ProfileShifts(*numbers)


def _setting(key: str, place: str) -> Setting:
    """How the setting of a key is written; an unknown key is refused with the nearest."""
    if key not in SETTINGS:
        hint = did_you_mean(str(key), SETTINGS) or f"; its keys are {', '.join(SETTINGS)}."
        raise UsageError(f"{place}: {shown(key)} is no setting{hint}")
    return SETTINGS[key]


def read_settings(path: Path | None, changes: Mapping[str, Any] | None = None) -> RatingSettings:
    """The settings of a TOML file, with changes on top.

    Parameters
    ----------
    path : Path or None
        Keys are those of :data:`SETTINGS`, quantities with their unit; None for the defaults.
    changes : mapping, optional
        Written like the file's.

    Raises
    ------
    UsageError
        No such file, an unknown key, a value that is none.
    """
    found: dict[str, Any] = {}
    if path is not None:
        content = parse_toml(read_text_file(path, _LARGEST_FILE, wrong=UsageError), path)
        for key, value in content.items():
            found[key] = _setting(key, f"{path}").read(f"{path}: {key}", value)
    for key, value in (changes or {}).items():
        found[key] = _setting(key, "settings").read("--" + key.replace("_", "-"), value)
    return dataclasses.replace(RatingSettings(), **found)
