"""The cycloid beside a compound planetary: the same loads, each with what limits it."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import Any

from cqdd_design.catalog import find_material, paper
from cqdd_design.design import Design
from cqdd_design.design.model import SCHEMA_VERSION
from cqdd_design.errors import UsageError
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.carrying import torque_limits
from cqdd_design.planetary.claims import PaperCase
from cqdd_design.planetary.compare import PlanetaryComparison, compare_planetary
from cqdd_design.planetary.cycloid import CycloidLimit
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
        paper=_papers_case(machine, material, quality),
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


def _papers_case(machine: Machine, material: str | None, quality: Quality) -> PaperCase:
    """The paper's actuator; its gears of the material asked for, else of its discs' steel.

    Where the machine itself is that actuator, its own limits serve.
    """
    papers = papers_machine()
    same = machine.design.sha256 == papers.design.sha256
    return _case_of(machine if same else papers, material, quality)


@lru_cache(maxsize=8)
def _case_of(machine: Machine, material: str | None, quality: Quality) -> PaperCase:
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


def cycloid_limits(machine: Machine) -> tuple[CycloidLimit, ...]:
    """What limits the torque of a machine's gearbox, as the comparison takes it."""
    return tuple(
        CycloidLimit(
            part=one.row.part,
            title=one.title,
            load=one.row.load,
            torque=one.asked,
            value=one.value,
            limit=one.limit,
            unit=one.unit,
            torque_capacity=one.torque,
            model=one.model,
            reached=one.reached,
        )
        for one in torque_limits(machine)
    )
