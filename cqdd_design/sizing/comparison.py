"""The cycloid beside a compound planetary: the same loads, each with what limits it."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import Any

from cqdd_design.catalog import find_material, paper
from cqdd_design.design import Design
from cqdd_design.design.model import SCHEMA_VERSION
from cqdd_design.errors import ContactError, UsageError
from cqdd_design.gearbox import GearboxAnalysis
from cqdd_design.gearbox.bearing_life import load_for_life
from cqdd_design.gearbox.checks.allowables import LIFE_HOURS, STATIC_SAFETY, UNEVEN_SHARING
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.capacity import LOAD_OF_CHECK, LoadedContacts
from cqdd_design.planetary.claims import PaperCase
from cqdd_design.planetary.compare import PlanetaryComparison, compare_planetary
from cqdd_design.planetary.cycloid import CycloidLimit, LoadName
from cqdd_design.planetary.gear_material import GearMaterial, Quality, gear_material
from cqdd_design.planetary.kinematics import PlanetaryTeeth
from cqdd_design.planetary.settings import RatingSettings

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
    settings: RatingSettings | None = None,
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
    chosen = settings or RatingSettings()
    quality = chosen.material_quality
    steel, notes = _gear_steel(machine.design.reducer.disc_material, material, quality)
    asked = {"teeth": teeth, "module": module, "face_width": face_width, "planets": planets}
    given: dict[str, Any] = {name: value for name, value in asked.items() if value is not None}
    found = compare_planetary(
        steel,
        peak_torque=requirements.peak_torque,
        continuous_torque=requirements.continuous_torque,
        input_speed=requirements.input_speed,
        bore=machine.motor.bore_diameter,
        settings=chosen,
        cycloid=cycloid_limits(machine),
        paper=_papers_case(material, quality),
        **given,
    )
    return replace(found, warnings=(*notes, *found.warnings))


def _gear_steel(
    discs: str, asked: str | None, quality: Quality
) -> tuple[GearMaterial, tuple[str, ...]]:
    """Material of the gears; a disc material that ISO 6336-5 does not know is replaced."""
    if asked is not None:
        return gear_material(find_material(asked), quality), ()
    try:
        return gear_material(find_material(discs), quality), ()
    except UsageError as error:
        note = f"the planetary is rated in {DEFAULT_STEEL}, because {error.message}"
        return gear_material(find_material(DEFAULT_STEEL), quality), (note,)


@lru_cache(maxsize=8)
def _papers_case(material: str | None, quality: Quality) -> PaperCase:
    """The paper's actuator; its gears of the material asked for, else of its discs' steel."""
    machine = papers_machine()
    steel, _ = _gear_steel(machine.design.reducer.disc_material, material, quality)
    return PaperCase(
        steel,
        machine.design.requirements.input_speed,
        machine.motor.bore_diameter,
        cycloid_limits(machine),
    )


@lru_cache(maxsize=1)
def papers_machine() -> Machine:
    """The paper's actuator with the loads it was sized for, see `catalog.paper.CASE`."""
    nested: dict[str, Any] = {"schema_version": SCHEMA_VERSION}
    for key, value in paper.CASE.items():
        *tables, last = key.split(".")
        table = nested
        for name in tables:
            table = table.setdefault(name, {})
        table[last] = value
    return resolve(Design.from_mapping(nested, source=paper.SOURCE, si=True))


#: Strength checks that limit the torque of a cycloid: part, load, how the value grows with torque.
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
EQUILIBRIUM, RIGID = "contact equilibrium", f"rigid law x {UNEVEN_SHARING:g}"


def cycloid_limits(machine: Machine) -> tuple[CycloidLimit, ...]:
    """What limits the torque of a machine's gearbox, for the comparison.

    Values and capacities are those of the contact equilibrium of perfect parts over the period and
    both senses of torque; stresses of pins go with their force. Where the torques asked for have no
    equilibrium they are the checks', and say so.
    """
    rigid = _rigid_limits(machine.analysis)
    contacts = LoadedContacts(machine)
    try:
        return tuple(_by_equilibrium(machine.analysis, contacts, *one) for one in rigid)
    except ContactError:
        return tuple(limit for limit, _ in rigid)


def _rigid_limits(analysis: GearboxAnalysis) -> list[tuple[CycloidLimit, str]]:
    """The limits by the checks, each with the key of its force or pressure in the equilibrium."""
    requirements = analysis.design.requirements
    torque = {"peak": requirements.peak_torque, "continuous": requirements.continuous_torque}
    found = []
    for check in analysis.checks:
        if check.id in _TORQUE_LIMITS and check.limit > 0.0:
            part, at, exponent = _TORQUE_LIMITS[check.id]
            numbers = (torque[at], check.value, check.limit, check.unit, exponent, RIGID)
            limit_of_part = CycloidLimit(part, check.title, at, *numbers)
            found.append((limit_of_part, LOAD_OF_CHECK[check.id]))
    cam = analysis.cam_bearing
    if cam.bearing.static_rating and cam.bearing.dynamic_rating:
        bearable = load_for_life(cam.bearing.dynamic_rating, LIFE_HOURS, cam.speed, cam.exponent)
        static = cam.bearing.static_rating / STATIC_SAFETY
        rows: tuple[tuple[LoadName, str, float, float], ...] = (
            ("peak", f"C0/P = {STATIC_SAFETY:g}", cam.peak_load, static),
            ("continuous", f"L10h = {LIFE_HOURS:g} h", cam.continuous_load, float(bearable)),
        )
        for load, words, value, limit in rows:
            numbers = (torque[load], value, limit, "N", 1.0, RIGID)
            limit_of_cam = CycloidLimit("cam bearing", f"load for {words}", load, *numbers)
            found.append((limit_of_cam, LOAD_OF_CHECK["BEARING-STATIC"]))
    return found


def _by_equilibrium(
    analysis: GearboxAnalysis, contacts: LoadedContacts, rigid: CycloidLimit, key: str
) -> CycloidLimit:
    """A limit by the checks with the force or pressure of the equilibrium in its place."""
    unit = 1.0
    if key == "output_pin_force_max_N":
        load = analysis.rigid_peak if rigid.load == "peak" else analysis.rigid_continuous
        unit = rigid.value / (UNEVEN_SHARING * load.output_pin_force)
    return replace(
        rigid,
        value=unit * contacts.greatest(rigid.torque)[key],
        model=EQUILIBRIUM,
        solved_capacity=contacts.torque_at(key, rigid.limit / unit, rigid.torque),
    )
