"""Lines of what plastics hold for long beside discs and ring: pins, housing, screws in them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from cqdd_design.catalog.materials import DESIGN_STRAIN, Material, find_material
from cqdd_design.errors import CatalogError, ContactError, GeometryError
from cqdd_design.gearbox.checks.allowables import SLIP_SAFETY
from cqdd_design.gearbox.checks.equilibrium import lasting_checks, lower_duty
from cqdd_design.gearbox.checks.remedies import lower_shares, lower_to
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.machine import Machine
from cqdd_design.machine.cures import ROUGHLY, SEARCHED_CASES, torques_that_hold
from cqdd_design.machine.held_stress import HeldStress, held_stresses
from cqdd_design.machine.screws import ScrewJoint, screw_joints
from cqdd_design.results import Check

_METAL = "take a metal"
_EXTERNAL = ("external_moment", "external_axial", "external_radial")
_MEGA = 1e6
_ENDLESS = 1e3
"""Safety of a joint that nothing parts."""


def creep_lines(machine: Machine, lines: Iterable[Check]) -> tuple[Check, ...]:
    """A line for each kind of plastic part; none of a machine of metal.

    Parameters
    ----------
    lines : iterable of Check
        Among them PIN-BENDING-CONTINUOUS, whose stress plastic pins hold.
    """
    found: list[Check] = []
    pins = find_material(machine.design.reducer.output_pins.material)
    if pins.is_plastic:
        found.append(_pins_cured(machine, pins, lines))
    housing = find_material(machine.design.housing.material)
    if housing.is_plastic:
        found += [_housing_cured(machine, housing), _screws(machine, housing)]
    return tuple(found)


def _pins_cured(machine: Machine, plastic: Material, lines: Iterable[Check]) -> Check:
    """With what of the duty's torques the pins would hold."""
    line = _pins(plastic, lines)
    # Of a plastic whose creep is not known a lower torque leaves that unknown.
    if line.status != "fail" or plastic.creep_modulus is None:
        return line

    def at(share: float) -> tuple[Check]:
        lived = machine.under(duty_share=share).life
        return (_pins(plastic, lasting_checks(machine.analysis, lived)),)

    shares: dict[str, float] = {}
    try:
        lived = machine.life
    except ContactError:
        return line
    if len(lived.duty) <= SEARCHED_CASES:
        shares = torques_that_hold(at, 1.0, (line,), near=ROUGHLY)
    lower = lower_duty(lived, shares.get(line.id))
    return replace(line, remedy=f"{line.remedy}, or {lower}")


def _pins(plastic: Material, lines: Iterable[Check]) -> Check:
    name, limit = "PIN-CREEP", 100.0 * DESIGN_STRAIN
    bent = next((one for one in lines if one.id == "PIN-BENDING-CONTINUOUS"), None)
    if bent is None or bent.value is None:
        return build_check(
            name, None, limit, "the bending of the pins is not known", "see PIN-BENDING-CONTINUOUS"
        )
    modulus = plastic.creep_modulus or plastic.youngs_modulus
    strain = _MEGA * bent.value / modulus
    known = plastic.creep_modulus is not None or strain > DESIGN_STRAIN
    held = "after 1000 h at 23 degC" if plastic.creep_modulus else "at once; its creep is not known"
    told = f"{bent.value:.1f} MPa in pins of {plastic.name}: {100.0 * strain:.2g} % {held}"
    return build_check(
        name,
        100.0 * strain if known else None,
        limit,
        told,
        f"{_METAL} for output_pins.material",
        basis=plastic.creep_source or f"modulus of {plastic.name}, without its creep",
    )


def _housing_cured(machine: Machine, plastic: Material) -> Check:
    """With the continuous torque, or share of a duty, at which all hold, where there is one."""
    line, asked = _housing(machine, plastic), machine.design.requirements
    if line.status != "fail" or plastic.creep_modulus is None:
        return line
    cures = torques_that_hold(
        lambda share: (_housing(machine.under(duty_share=share), plastic),),
        1.0,
        (line,),
        near=ROUGHLY,
    )
    share, whose = cures[line.id], "torques of the duty"
    less = lower_shares(share)
    if not asked.load_cases:
        whose = "continuous torque"
        less = lower_to(share * asked.continuous_torque, whose)
    if not share and any(getattr(asked, one) for one in _EXTERNAL):
        less = f"lower the {whose} and the external loads"
    return replace(line, remedy=f"{line.remedy}, or {less}")


def _housing(machine: Machine, plastic: Material) -> Check:
    """The most strained place of housing, covers and carrier, by what the plastic is known to do.

    Without a modulus of creep the strain that the load makes at once still tells what is too much.
    """
    name, limit = "HOUSING-CREEP", 100.0 * DESIGN_STRAIN
    try:
        # A carrier may be of metal in a housing that is not.
        own = {part.name for part in machine.parts if part.material == plastic.name}
        places = [one for one in held_stresses(machine) if one.part in own]
    except (CatalogError, ContactError, GeometryError) as error:
        return build_check(name, None, limit, error.message, "see why it is not known")
    modulus = plastic.creep_modulus or plastic.youngs_modulus
    first, second, *_ = sorted(places, key=lambda one: one.stress, reverse=True)
    strain = first.stress / modulus
    known = plastic.creep_modulus is not None or strain > DESIGN_STRAIN
    held = "after 1000 h at 23 degC" if plastic.creep_modulus else "at once; its creep is not known"
    return build_check(
        name,
        100.0 * strain if known else None,
        limit,
        f"{_place(first)} ({first.told}) in {plastic.name}: {100.0 * strain:.2g} % {held}; "
        f"next {_place(second)}; {len(places)} places looked at",
        f"{_METAL} for housing.material"
        if known
        else f"{_METAL} for housing.material, or a plastic whose creep the catalogue has "
        "(see cqdd-design catalog materials)",
        basis=plastic.creep_source or f"modulus of {plastic.name}, without its creep",
    )


def _place(one: HeldStress) -> str:
    return f"{one.part}, {one.place}: {one.stress / _MEGA:.4g} MPa"


def _screws(machine: Machine, plastic: Material) -> Check:
    """Joints whose head or thread is in plastic; the worst of those that carry something."""
    name, remedy = "SCREW-CREEP", f"{_METAL} for housing.material"
    if plastic.creep_modulus is None:
        return build_check(
            name, None, SLIP_SAFETY,
            f"what screws keep of their preload is not known: {plastic.name} has no creep in the "
            "catalogue",
            f"{remedy} or a plastic whose creep it has (see cqdd-design catalog materials), and "
            "until then tighten screws again",
        )  # fmt: skip
    try:
        every = [one for one in screw_joints(machine) if one.clamping.in_plastic is not None]
    except (CatalogError, ContactError, GeometryError) as error:
        return build_check(name, None, SLIP_SAFETY, error.message, "see why it is not known")
    safe = [(one, held) for one in every if (held := one.held_safety) is not None]
    least = min(held for _, held in safe)
    return build_check(
        name,
        min(least, _ENDLESS),
        SLIP_SAFETY,
        "; ".join(_told(one) for one, _ in safe),
        f"{remedy}, or more and larger screws by a larger ring.outer_diameter",
        basis=plastic.creep_source,
    )


def _told(one: ScrewJoint) -> str:
    kept, new = one.clamping.held_preload or 0.0, one.clamping.least_preload
    return f"{one.place}: {kept:.0f} N of {new:.0f} N are left"
