"""The catalogues as tables with units in their column names, for listing and showing."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping
from typing import Any

from cqdd_design.catalog.bearings import bearings
from cqdd_design.catalog.circlips import circlips
from cqdd_design.catalog.finishes import finishes, rubbing_limits
from cqdd_design.catalog.fits import fit_zones
from cqdd_design.catalog.lock_nuts import lock_nuts
from cqdd_design.catalog.lubricants import lubricants
from cqdd_design.catalog.materials import materials
from cqdd_design.catalog.motors import motors
from cqdd_design.catalog.screws import shoulder_screws
from cqdd_design.errors import CatalogError, nearest_names

Row = Mapping[str, Any]

#: Suffix and factor from SI of every field that has a unit.
_UNITS = {
    "youngs_modulus": ("GPa", 1e-9),
    "yield_strength": ("MPa", 1e-6),
    "ultimate_strength": ("MPa", 1e-6),
    "fatigue_strength": ("MPa", 1e-6),
    "pulsating_strength": ("MPa", 1e-6),
    "creep_modulus": ("GPa", 1e-9),
    "contact_allowable": ("MPa", 1e-6),
    "density": ("kg_m3", 1.0),
    "expansion": ("um_mK", 1e6),
    "conductivity": ("W_mK", 1.0),
    "specific_heat": ("J_kgK", 1.0),
    "service_limit": ("degC", 1.0),
    "speed_constant": ("rpm_V", 30.0 / 3.141592653589793),
    "no_load_speed": ("rpm", 30.0 / 3.141592653589793),
    "torque_constant_printed": ("Nm_A", 1.0),
    "line_resistance": ("ohm", 1.0),
    "line_inductance": ("uH", 1e6),
    "rotor_inertia": ("kgm2", 1.0),
    "rated_voltage": ("V", 1.0),
    "no_load_current": ("A", 1.0),
    "coulomb": ("Nm", 1.0),
    "viscous": ("Nms_rad", 1.0),
    "hysteresis": ("Nm", 1.0),
    "iron_loss": ("Nms_rad", 1.0),
    "cogging_amplitude": ("Nm", 1.0),
    "thermal_resistance": ("K_W", 1.0),
    "winding_limit": ("degC", 1.0),
    "mass": ("kg", 1.0),
    "rated_torque": ("Nm", 1.0),
    "peak_torque": ("Nm", 1.0),
    "rated_current": ("A", 1.0),
    "peak_current": ("A", 1.0),
    "dynamic_rating": ("N", 1.0),
    "static_rating": ("N", 1.0),
    "lower": ("um", 1e6),
    "upper": ("um", 1e6),
    "over": ("mm", 1e3),
    "up_to": ("mm", 1e3),
    "viscosity": ("mm2_s", 1e6),
    "hot_viscosity": ("mm2_s", 1e6),
    "pressure_coefficient": ("1_GPa", 1e9),
    "hot_pressure_coefficient": ("1_GPa", 1e9),
    "coldest": ("degC", 1.0),
    "hottest": ("degC", 1.0),
    "mean_roughness": ("um", 1e6),
    "rms_roughness": ("um", 1e6),
    "limit": ("MPa_m_s", 1e-6),
}
_LENGTH_ENDINGS = ("diameter", "diameter_max", "diameter_min", "length", "width", "height", "depth")
_LENGTHS = {"socket_size", "chamfer"}
_OF_DESIGNS = {"stated", "stated_in", "based_on"}
"""Fields of a motor that a design describes; no row of a catalogue has them."""

#: The columns of a listing, after the name; showing a row gives all of its columns.
COLUMNS = {
    "materials": ("yield_strength_MPa", "ultimate_strength_MPa", "hardness"),
    "motors": (
        "peak_torque_Nm",
        "rated_torque_Nm",
        "speed",
        "bore_diameter_mm",
        "rotor_inertia_kgm2",
        "mass_kg",
        "missing",
    ),
    "bearings": (
        "bore_diameter_mm",
        "outer_diameter_mm",
        "width_mm",
        "dynamic_rating_N",
        "static_rating_N",
    ),
    "screws": ("thread", "shoulder_diameter_mm", "head_diameter_mm", "standard_lengths"),
    "fits": ("lower_um", "upper_um", "source"),
    "lubricants": ("viscosity_mm2_s", "hot_viscosity_mm2_s", "coldest_degC", "hottest_degC"),
    "finishes": ("mean_roughness_um", "rms_roughness_um", "source"),
    "rubbing": ("limit_MPa_m_s", "source"),
    "circlips": ("groove_diameter_mm", "lug_height_mm", "beam_width_mm", "free_diameter_mm"),
    "nuts": ("thread_diameter_mm", "pitch_length_mm", "outer_diameter_mm", "width_mm", "mass_kg"),
}


def catalogues() -> dict[str, dict[str, Row]]:
    """Every row of every catalogue: kind, then name, then column.

    Returns
    -------
    dict
        Columns carry their unit in their name (``bore_diameter_mm``); a value that the source
        does not give is None.
    """
    fits = {
        f"{limits.zone} {limits.over * 1e3:g}-{limits.up_to * 1e3:g} mm": limits
        for rows in fit_zones().values()
        for limits in rows
    }
    return {
        "materials": _rows(materials()),
        "motors": {
            name: {
                **_row(motor),
                "speed": motor.speed_told,
                "missing": ", ".join(motor.missing)
                if motor.torque_at == "motor"
                else "geared: no motor of a reducer",
            }
            for name, motor in motors().items()
        },
        "bearings": _rows(bearings()),
        "screws": _rows(shoulder_screws()),
        "fits": _rows(fits),
        "lubricants": _rows(lubricants()),
        "finishes": _rows(finishes()),
        "rubbing": _rows(rubbing_limits()),
        "circlips": _rows(circlips()),
        "nuts": _rows(lock_nuts()),
    }


def look_up(name: str) -> tuple[str, dict[str, Row]]:
    """A whole catalogue by its kind, one row by its name, or the rows whose names begin so.

    Parameters
    ----------
    name : str
        ``"bearings"``, ``"6902"``, ``"bearings 6902"``, ``"AISI 4140"``; case and runs of blanks
        do not matter.

    Returns
    -------
    kind : str
    rows : dict
        Name to row; one of them when the name is exact.

    Raises
    ------
    CatalogError
        With the nearest names, when nothing is called so.

    Examples
    --------
    >>> kind, rows = look_up("6902")
    >>> kind, rows["6902"]["bore_diameter_mm"]
    ('bearings', 15.0)
    """
    wanted = _folded(name)
    every = catalogues()
    for kind, rows in every.items():
        if wanted in {kind, kind.removesuffix("s"), f"shoulder {kind}"}:
            return kind, rows
    first, _, rest = name.strip().partition(" ")
    if rest and first.lower() in every:
        every, name, wanted = {first.lower(): every[first.lower()]}, rest.strip(), _folded(rest)
    for kind, rows in every.items():
        for key, row in rows.items():
            if _folded(key) == wanted:
                return kind, {key: row}
    # As typed first: H7 is a hole and h7 a shaft.
    for begins in (
        lambda key: key.startswith(f"{name} "),
        lambda key: _folded(key).startswith(f"{wanted} "),
    ):
        for kind, rows in every.items():
            begun = {key: row for key, row in rows.items() if begins(key)}
            if begun:
                return kind, begun
    names: Iterable[str] = [*every, *(key for rows in every.values() for key in rows)]
    near = nearest_names(name, names)
    hint = "; the nearest are " + ", ".join(f"'{n}'" for n in near) if near else ""
    raise CatalogError(
        f"no catalogue has '{name}'{hint}; the catalogues are {', '.join(catalogues())}."
    )


def _rows(table: Mapping[str, Any]) -> dict[str, Row]:
    return {name: _row(record) for name, record in table.items()}


def _row(record: Any) -> Row:
    row: dict[str, Any] = {}
    for field in dataclasses.fields(record):
        if field.name in _OF_DESIGNS:
            continue
        value = getattr(record, field.name)
        unit, factor = _unit(field.name)
        if unit and value is not None:
            # Twelve digits, as in design files: 0.015 * 1e3 is 15, not 15.000000000000002.
            value = float(f"{value * factor:.12g}")
        row[f"{field.name}_{unit}" if unit else field.name] = value
    return row


def _unit(field: str) -> tuple[str, float]:
    if field in _UNITS:
        return _UNITS[field]
    if field in _LENGTHS or field.endswith(_LENGTH_ENDINGS):
        return "mm", 1e3
    return "", 1.0


def _folded(text: str) -> str:
    return " ".join(text.lower().split())
