"""A calibration on disk: the unknowns as fitted, and the design and rows they come from."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cqdd_design.actuator.bench.calibrate import Calibration
from cqdd_design.actuator.bench.metric import METRICS
from cqdd_design.actuator.bench.unknowns import UNKNOWNS, Fit
from cqdd_design.actuator.fitted_under import FittedUnder
from cqdd_design.errors import UsageError, did_you_mean, shown
from cqdd_design.files import WrittenFile, parse_json, read_text_file, write_atomically

_MOST_BYTES = 1_000_000
FORMAT = "cqdd-design calibration 1"


def write_calibration(calibration: Calibration, design_sha256: str, path: Path) -> WrittenFile:
    """Write a calibration as JSON for ``--calibration``."""
    content = {
        "format": FORMAT,
        "name": calibration.parameters.name,
        "design_sha256": design_sha256,
        **calibration.to_dict(),
    }
    return write_atomically(path, json.dumps(content, indent=2, allow_nan=False) + "\n", "json")


def read_calibration(path: Path, design_sha256: str) -> tuple[Fit, str]:
    """Factors and values of the unknowns with the rows they were fitted to, and a warning.

    The warning says where they come from another design; else it is empty.

    Raises
    ------
    UsageError
        When the file cannot be read or is not a calibration.
    """
    content = _content(path)
    unknowns = content.get("unknowns")
    if content.get("format") != FORMAT or not isinstance(unknowns, dict):
        raise UsageError(
            f"{path} is not a calibration ('{FORMAT}'); `cqdd-design calibrate` writes one."
        )
    factors = {}
    for name, entry in unknowns.items():
        if name not in UNKNOWNS:
            raise UsageError(f"{path}: '{name}' is no unknown{did_you_mean(name, UNKNOWNS)}.")
        unit = UNKNOWNS[name].unit
        what = "value" if unit else "factor"
        factor = entry.get(what) if isinstance(entry, dict) else None
        # An int of 400 digits is a number in JSON, but compares with the greatest float.
        if not isinstance(factor, float | int) or not 0.0 < factor <= sys.float_info.max:
            raise UsageError(f"{path}: the {what} of {name} must be a number above 0.")
        # Earlier files have "N m" for what is "N*m".
        if unit and str(entry.get("unit")).replace(" ", "*") != unit:
            raise UsageError(
                f"{path}: the unit of {name} is {shown(entry.get('unit'))}; it must be '{unit}'."
            )
        factors[name] = float(factor)
    warning, under = "", _under(path, content)
    if under is None:
        warning = (
            f"{path} does not say at which supply and in which air it was measured; whether rows "
            "fitted to it agree is told as if that were here. `calibrate` writes it anew."
        )
    other = content.get("design_sha256") != design_sha256
    if other:
        warning = (
            f"{path} was fitted to another design ({content.get('name')}) or an earlier state of "
            "this one; its factors are applied all the same."
        )
    found = Fit(factors, _fitted(path, content, factors), under)
    return (found.fitted_to(f"another design ({content.get('name')})") if other else found), warning


def _under(path: Path, content: Mapping[str, Any]) -> FittedUnder | None:
    """What a calibration was measured under; None where an earlier version left it out."""
    found = content.get("measured_under")
    if found is None:
        return None
    try:
        voltage, ambient = float(found["voltage_V"]), float(found["ambient_degC"])
        rig, seed = found["rig_stiffness_Nm_per_rad"], found["gearbox_seed"]
        rig, seed = rig if rig is None else float(rig), seed if seed is None else int(seed)
    except (KeyError, TypeError, ValueError, OverflowError):
        raise UsageError(
            f"{path}: measured_under must have voltage_V, ambient_degC, rig_stiffness_Nm_per_rad "
            "and gearbox_seed, the last two a number or null."
        ) from None
    return FittedUnder(voltage, ambient, rig, seed)


def _fitted(
    path: Path, content: Mapping[str, Any], factors: Mapping[str, float]
) -> tuple[str, ...]:
    """Rows of a calibration that it was fitted to; those that tell its factors without any rows."""
    rows = content.get("rows", {})
    if not isinstance(rows, dict):
        raise UsageError(f"{path}: its rows are no table of measurements by name.")
    found = tuple(
        name
        for name, row in rows.items()
        if name in METRICS and isinstance(row, dict) and row.get("relation") == "calibrated"
    )
    told = (UNKNOWNS[name].told_by for name in factors)
    return found or tuple(row for row in told if row)


def _content(path: Path) -> dict[str, Any]:
    found = parse_json(read_text_file(path, _MOST_BYTES), path)
    return found if isinstance(found, dict) else {}
