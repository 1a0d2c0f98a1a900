"""From a grid point to a checked design: nothing leaves sizing without the full analysis."""

from __future__ import annotations

from typing import Any

import numpy as np

from cqdd_design.catalog.bearings import find_bearing
from cqdd_design.design import Design, Requirements
from cqdd_design.design.tables import dump
from cqdd_design.errors import DesignError
from cqdd_design.gearbox.bearing_life import life_exponent
from cqdd_design.gearbox.cam_bearing import rolling_element
from cqdd_design.machine import resolve
from cqdd_design.results import Check
from cqdd_design.sizing.points import Evaluator, Points
from cqdd_design.sizing.reserves import CAM_CHECKS, NEEDLE_CHECKS, PIN_CHECKS, RING_CHECKS
from cqdd_design.sizing.result import Objective, SizedDesign

LOAD_CHECKS = (*RING_CHECKS, *PIN_CHECKS, *NEEDLE_CHECKS, *CAM_CHECKS)
_DIGITS = 9


def finish(evaluator: Evaluator, points: Points, row: int, suffix: str = "") -> SizedDesign | None:
    """Build and analyse the design of one point.

    Returns
    -------
    SizedDesign or None
        None when the full analysis finds a shape or load limit violated after all: the search
        reads the loads from tables that are good to about 1e-3. Checks of a motor the requirements
        ask for are left to the caller, because no size would change them.
    """
    try:
        design = design_of(evaluator, points, row, suffix)
        machine = resolve(design, evaluator.frame.motor)
        analysis = machine.analysis
    except DesignError:
        return None
    checks, warnings = analysis.checks, analysis.warnings
    if any(c.status == "fail" and not c.id.startswith("MOTOR-") for c in checks):
        return None
    least = min((torque_reserve(check, design), check.id) for check in checks if is_load(check))
    margin = next(check.margin for check in checks if check.id == least[1])
    rotor_known = evaluator.frame.rotor_inertia is not None
    if not rotor_known:
        motor = evaluator.frame.motor.name
        warnings += (
            f"the rotor inertia of '{motor}' is not known, and so the reflected inertia is not "
            "either.",
        )
    objective = Objective(
        score=float(points.objective[row]),
        goal=evaluator.frame.goal,
        mass=float(points.mass[row]),
        gearbox_inertia=float(points.gearbox_inertia[row]),
        reflected_inertia=float(points.reflected_inertia[row]) if rotor_known else None,
        torque_reserve=least[0],
        binding=least[1],
        least_margin=margin,
    )
    return SizedDesign(design, checks, warnings, objective, machine)


def is_load(check: Check) -> bool:
    """Whether a check's value grows with the torque."""
    return check.id in LOAD_CHECKS


def torque_reserve(check: Check, design: Design) -> float:
    """Factor by which both torques could grow until a load check is on its limit."""
    if check.id.startswith("CONTACT-"):
        return check.margin**2
    if check.id == "BEARING-LIFE":
        bearing = find_bearing(design.reducer.cam_bearing.designation)
        return float(check.margin ** (1.0 / life_exponent(rolling_element(bearing))))
    if check.id == "SLEEVE-LIFE":
        return float(check.margin ** (1.0 / life_exponent("roller")))
    return check.margin


def design_of(evaluator: Evaluator, points: Points, row: int, suffix: str = "") -> Design:
    """The design of one point; every value the search does not choose keeps its default."""
    frame, requirements = evaluator.frame, evaluator.frame.requirements
    throw, tooth, _, thickness = points.steps[row] * evaluator.grid.steps
    size = frame.pin_sizes[points.pin_size[row]]
    pins: dict[str, Any] = {
        "count": int(points.pin_count[row]),
        "diameter": _clean(size.diameter),
        "circle_radius": _clean(points.pin_circle[row]),
        "material": requirements.pin_material,
    }
    if size.cages:
        pins |= {"sleeve_diameter": _clean(size.sleeve_diameter), "sleeve": "needle"}
    if size.hole_clearance != frame.default_fit.hole_clearance:
        pins["hole_clearance"] = _clean(size.hole_clearance)
    mapping: dict[str, Any] = {
        "name": f"sized-{requirements.ratio}{suffix}",
        "requirements": _requirements_given(requirements),
        "reducer": {
            "ratio": requirements.ratio,
            "ring_pitch_radius": _clean(points.pitch_radius[row]),
            "eccentricity": _clean(throw),
            "ring_pin_diameter": _clean(2.0 * tooth),
            "disc_count": requirements.disc_count,
            "disc_thickness": _clean(thickness),
            "disc_material": requirements.disc_material,
            "ring_material": requirements.ring_material,
            "output_pins": pins,
            # Stated, since forces hang on it: no room is searched for columns.
            "carrier": {"joint": "clamped"} | frame.carrier_stated,
            "cam_bearing": {"designation": frame.bearings[points.bearing[row]].designation},
            "ring": {"outer_diameter": _clean(2.0 * points.outer_radius[row])},
        },
    }
    if frame.equidistant != frame.default_fit.equidistant:
        mapping["reducer"]["modification"] = {"equidistant": _clean(frame.equidistant)}
    if frame.ambient is not None:
        mapping["environment"] = {"ambient": frame.ambient}
    if "motor" in requirements.model_fields_set:
        mapping["motor"] = {"name": requirements.motor}
    design = Design.from_mapping(mapping, source="sizing", si=True)
    # As its file will say it: units round some last digits.
    return design.with_duty_log(requirements.duty_log).replacing({})


def _clean(length: float | np.floating[Any]) -> float:
    """A length in m without the dust of binary fractions."""
    return round(float(length), _DIGITS)


def _requirements_given(requirements: Requirements) -> dict[str, Any]:
    """The requirements that were stated; the rest keeps counting as assumed.

    Torques equal to what would be derived anyway count as derived.
    """
    stated, fields = dump(requirements), Requirements.model_fields
    peak, continuous = "peak_torque", "continuous_torque"
    given = {fields[name].alias or name for name in requirements.model_fields_set}
    given |= {peak, continuous}
    by_ratio = Requirements.model_validate({"ratio": requirements.ratio})
    by_peak = Requirements.model_validate({"ratio": requirements.ratio, peak: stated[peak]})
    derived = {peak: dump(by_ratio)[peak], continuous: dump(by_peak)[continuous]}
    return {
        key: value for key, value in stated.items() if key in given and value != derived.get(key)
    }
