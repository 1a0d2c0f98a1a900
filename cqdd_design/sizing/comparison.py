"""The cycloid beside a compound planetary: the same loads, each with what limits it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from cqdd_design.catalog import find_material
from cqdd_design.errors import UsageError
from cqdd_design.gearbox import GearboxAnalysis
from cqdd_design.gearbox.bearing_life import load_for_life
from cqdd_design.gearbox.checks.allowables import LIFE_HOURS, STATIC_SAFETY
from cqdd_design.machine import Machine
from cqdd_design.planetary.compare import PlanetaryComparison, compare_planetary
from cqdd_design.planetary.cycloid import CycloidLimit, LoadName
from cqdd_design.planetary.gear_material import GearMaterial, gear_material
from cqdd_design.planetary.kinematics import PlanetaryTeeth

#: Of the gears where the discs are of no gear steel.
DEFAULT_STEEL = "AISI 4140 Q&T 540C"


def compare_with_planetary(
    machine: Machine,
    *,
    teeth: PlanetaryTeeth | None = None,
    module: float | None = None,
    face_width: float | None = None,
    material: str | None = None,
    planets: int | None = None,
) -> PlanetaryComparison:
    """A compound planetary for the loads of a machine, beside its own limits.

    Parameters
    ----------
    machine : Machine
        For its torques, speed, motor and limits.
    teeth : PlanetaryTeeth, optional
        Default: the paper's 12, 36, 22 and 70.
    module, face_width : float, optional
        m; default 1 mm and 12 mm, the paper's.
    material : str, optional
        Of all gears, a catalogue name; default that of the design's discs, or
        `DEFAULT_STEEL` where they are of no steel that ISO 6336-5 rates.
    planets : int, optional
        The number looked at in detail; default the most that fit and assemble.
    """
    requirements = machine.design.requirements
    steel, notes = _gear_steel(machine.design.reducer.disc_material, material)
    asked = {"teeth": teeth, "module": module, "face_width": face_width, "planets": planets}
    given: dict[str, Any] = {name: value for name, value in asked.items() if value is not None}
    found = compare_planetary(
        steel,
        peak_torque=requirements.peak_torque,
        continuous_torque=requirements.continuous_torque,
        input_speed=requirements.input_speed,
        bore=machine.motor.bore_diameter,
        cycloid=cycloid_limits(machine.analysis),
        **given,
    )
    return replace(found, warnings=(*notes, *found.warnings))


def _gear_steel(discs: str, asked: str | None) -> tuple[GearMaterial, tuple[str, ...]]:
    """Material of the gears; a disc material that ISO 6336-5 does not know is replaced."""
    if asked is not None:
        return gear_material(find_material(asked)), ()
    try:
        return gear_material(find_material(discs)), ()
    except UsageError as error:
        note = f"the planetary is rated in {DEFAULT_STEEL}, because {error.message}"
        return gear_material(find_material(DEFAULT_STEEL)), (note,)


#: Strength checks that limit the torque of a cycloid: part, and how the value grows with torque.
_TORQUE_LIMITS: dict[str, tuple[str, LoadName, float]] = {
    "CONTACT-RING-PEAK": ("ring teeth", "peak", 0.5),
    "CONTACT-RING-CONTINUOUS": ("ring teeth", "continuous", 0.5),
    "CONTACT-PIN-PEAK": ("output pins", "peak", 0.5),
    "CONTACT-PIN-CONTINUOUS": ("output pins", "continuous", 0.5),
    "PIN-SHEAR-PEAK": ("output pins", "peak", 1.0),
    "PIN-BENDING-PEAK": ("output pins", "peak", 1.0),
    "PIN-BENDING-CONTINUOUS": ("output pins", "continuous", 1.0),
    "PIN-BEARING-PEAK": ("output pins", "peak", 1.0),
}


def cycloid_limits(analysis: GearboxAnalysis) -> tuple[CycloidLimit, ...]:
    """The strength checks of a gearbox as limits of its torque, for the comparison."""
    requirements = analysis.design.requirements
    torque = {"peak": requirements.peak_torque, "continuous": requirements.continuous_torque}
    found = []
    for check in analysis.checks:
        if check.id in _TORQUE_LIMITS and check.limit > 0.0:
            part, at, exponent = _TORQUE_LIMITS[check.id]
            numbers = (torque[at], check.value, check.limit, check.unit, exponent)
            found.append(CycloidLimit(part, check.title, at, *numbers))
    cam = analysis.cam_bearing
    if cam.bearing.static_rating and cam.bearing.dynamic_rating:
        bearable = load_for_life(cam.bearing.dynamic_rating, LIFE_HOURS, cam.speed, cam.exponent)
        static = cam.bearing.static_rating / STATIC_SAFETY
        rows: tuple[tuple[LoadName, str, float, float], ...] = (
            ("peak", f"C0/P = {STATIC_SAFETY:g}", cam.peak_load, static),
            ("continuous", f"L10h = {LIFE_HOURS:g} h", cam.continuous_load, float(bearable)),
        )
        found += [
            CycloidLimit("cam bearing", f"load for {words}", load, torque[load], value, limit, "N")
            for load, words, value, limit in rows
        ]
    return tuple(found)
