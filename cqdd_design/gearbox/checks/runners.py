"""Checks of what turns on pins: walls, needles and their raceways, and the pins under rollers."""

from __future__ import annotations

import math
from typing import NamedTuple

from cqdd_design.catalog.materials import find_material
from cqdd_design.gearbox import output_pins
from cqdd_design.gearbox.bearing_life import load_for_life
from cqdd_design.gearbox.cam_bearing import BearingResult
from cqdd_design.gearbox.carrier import slender_bending_arm
from cqdd_design.gearbox.checks import allowables
from cqdd_design.gearbox.checks.allowables import UNEVEN_SHARING, Allowable
from cqdd_design.gearbox.checks.remedies import lower_screened, thicker_ring_pin
from cqdd_design.gearbox.checks.state import GearboxState, build_check
from cqdd_design.gearbox.loads import RigidMaxima
from cqdd_design.gearbox.pin_beam import HELD
from cqdd_design.geometry.runners import Runner, pin_runner, ring_runner
from cqdd_design.results import Check
from cqdd_design.terms import life_text


class _Seat(NamedTuple):
    """Sleeves or rollers: the checks' first word, keys of size and steel, and what to enlarge."""

    prefix: str
    size: str
    steel: str
    larger: str


_SLEEVES = _Seat(
    "SLEEVE", "output_pins.sleeve_diameter", "output_pins.material", "larger output_pins, or more"
)
_ROLLERS = _Seat("ROLLER", "ring.roller_diameter", "ring_material", "a larger ring_pin_diameter")


def runner_checks(state: GearboxState) -> tuple[Check, ...]:
    """All checks of sleeves and rollers, none where there are none."""
    design = state.design
    rollers = ring_runner(design)
    return (
        *_wall(_SLEEVES, pin_runner(design)),
        *_needles(state, _SLEEVES, state.sleeves, design.reducer.output_pins.material),
        *_wall(_ROLLERS, rollers),
        *_needles(state, _ROLLERS, state.rollers, design.reducer.ring_material),
        *(() if rollers is None else _ring_pins(state)),
    )


def _wall(seat: _Seat, runner: Runner | None) -> tuple[Check, ...]:
    if runner is None:
        return ()
    enough = runner.bore + 2.0 * allowables.SLEEVE_WALL
    return (
        build_check(
            f"GEO-{seat.prefix}-WALL",
            runner.wall * 1e3,
            allowables.SLEEVE_WALL * 1e3,
            f"({runner.diameter * 1e3:g} mm - {runner.bore * 1e3:g} mm)/2 = "
            f"{runner.wall * 1e3:.4g} mm",
            f"raise {seat.size} to {enough * 1e3:g} mm",
        ),
    )


def _needles(
    state: GearboxState, seat: _Seat, found: BearingResult | None, steel: str
) -> tuple[Check, ...]:
    """Check the needles inside sleeves or rollers, where there are any."""
    if found is None:
        return ()
    requirements, cage, material = state.design.requirements, found.bearing, find_material(steel)
    static, dynamic = cage.static_rating or 0.0, cage.dynamic_rating or 0.0
    safety, life = found.static_safety or 0.0, found.life_hours or 0.0
    hours = requirements.life_hours
    at_life = float(load_for_life(dynamic, hours, found.speed, found.exponent))
    share = at_life / found.continuous_load
    return (
        build_check(
            f"{seat.prefix}-STATIC",
            safety,
            allowables.STATIC_SAFETY,
            f"{cage.designation}: {static:.0f} N/{found.peak_load:.1f} N = {safety:.3f}",
            f"use {seat.larger}; or "
            + lower_screened(state, state.rigid_peak, safety / allowables.STATIC_SAFETY),
        ),
        build_check(
            f"{seat.prefix}-LIFE",
            life,
            hours,
            f"{cage.designation}: 1e6 ({dynamic:.0f} N/{found.continuous_load:.1f} N)^"
            f"{found.exponent:.3g}/(60 x {found.speed * 30.0 / math.pi:.0f} rpm) = "
            f"{life_text(life)}",
            f"use {seat.larger}; or " + lower_screened(state, state.rigid_continuous, share),
        ),
        build_check(
            f"{seat.prefix}-RACEWAY",
            material.rockwell_hardness or 0.0,
            allowables.HARDENED_HRC,
            f"{material.name}: {material.hardness or 'no hardness given'}",
            f"make {seat.steel} 'AISI 52100 / 100Cr6 hardened', or use no needles",
        ),
    )


def _ring_pins(state: GearboxState) -> tuple[Check, ...]:
    """Check the bending of the pins that rollers leave free between housing and clamp."""
    reducer = state.design.reducer
    material, diameter = find_material(reducer.ring_material), reducer.ring_pin_diameter
    stack = reducer.disc_count, reducer.disc_thickness, reducer.disc_spacing
    arm = float(slender_bending_arm(*stack, HELD["both"], 4.0))
    # A pin of the ring is pushed outward, and by the one disc that passes.
    continuous = allowables.pin_bending_limit_continuous(material, duty_reverses=False)

    def one(check_id: str, load: RigidMaxima, allowed: Allowable) -> Check:
        force = UNEVEN_SHARING * load.ring_force
        stress = float(output_pins.bending_stress(force, arm, diameter))
        remedy = lower_screened(state, load, allowed.value / stress)
        if allowed.value > 0.0:
            thicker = diameter * (stress / allowed.value) ** (1.0 / 3.0)
            remedy = f"{thicker_ring_pin(reducer, thicker)}, or {remedy}"
        return build_check(
            check_id,
            stress / 1e6,
            allowed.value / 1e6,
            f"32 x {force:.1f} N x {arm * 1e3:.4f} mm/(pi ({diameter * 1e3:g} mm)^3) = "
            f"{stress / 1e6:.1f} MPa at {load.torque:g} N*m",
            remedy,
            basis=allowed.basis,
        )

    peak = allowables.pin_limit_peak(material)
    return (
        one("RING-PIN-BENDING-PEAK", state.rigid_peak, peak),
        one(
            "RING-PIN-BENDING-CONTINUOUS",
            state.rigid_continuous,
            continuous,
        ),
    )
