"""Life of a gearbox under the duty of its requirements."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.gearbox.cam_bearing import cam_bearing
from cqdd_design.gearbox.checks import allowables
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.rubbing import ContactFriction, FrictionChoice
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.states import nominal_states
from cqdd_design.gearbox.contact.sweep import contact_sweep
from cqdd_design.gearbox.life import contacts, cycles, fatigue, pins
from cqdd_design.gearbox.life.cam import CamLife, cam_life
from cqdd_design.gearbox.life.contacts import Pressures
from cqdd_design.gearbox.life.result import CaseLoads, DutyCase, LifeResult, PartLife
from cqdd_design.gearbox.life.runners import RunnerDuty, RunnerLife, roller_life, sleeve_life
from cqdd_design.gearbox.loads import rigid_maxima
from cqdd_design.gearbox.pack_loads import PackLoads
from cqdd_design.gearbox.stages import Stages
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.contours import FloatArray

_ENDLESS_HOURS = 1e9
"""Lives beyond this, a hundred thousand years, are given as none: the curves mean nothing there."""


@dataclass(frozen=True, eq=False)
class _Duty:
    """Load cases with their solved sweeps."""

    design: Design
    cases: tuple[DutyCase, ...]
    sweeps: list[ContactSweep]

    @property
    def turns(self) -> FloatArray:
        """Output turns an hour of every case, its share of time in them, (C,)."""
        return np.array([c.share * c.speed * 3600.0 / (2.0 * math.pi) for c in self.cases])


def duty_cases(design: Design) -> tuple[tuple[DutyCase, ...], bool]:
    """Load cases of a design, and whether they are assumed."""
    asked = design.requirements
    steps = asked.load_cases
    if steps:
        cases = tuple(
            DutyCase(p.torque, abs(p.speed), p.share, p.torque * p.speed < 0.0) for p in steps
        )
        return cases, False
    speed = asked.held_speed / design.reducer.ratio
    return (DutyCase(asked.continuous_torque, speed, 1.0),), True


def life(
    design: Design, model: ContactModel, *, friction: bool = True, share: float = 1.0
) -> LifeResult:
    """Life of contacts, output pins and cam bearings under the duty of the requirements.

    Parameters
    ----------
    model : ContactModel
        Of the same design.
    friction : bool
        Whether teeth and pins rub: the crank drives where torque and speed of a case agree, and
        where it stands still, and is driven where they oppose each other.
    share : float
        Of the duty's torques that counts.

    Raises
    ------
    ContactError
        When a load case has no equilibrium.

    Notes
    -----
    Every place of a flank, tooth, hole and pin sums the damage of its own pressures over the
    duty; the worst place is given. Perfect parts are assumed; forces are those of the contact
    equilibrium. The contact of pin and hole is that of bare pins and of sleeves that stand still:
    a sleeve that turns spreads its load over its rim. What turns inside it is judged on its own.
    """
    stated, assumed = duty_cases(design)
    cases = tuple(replace(case, torque=share * case.torque) for case in stated)
    asked = design.requirements
    angles = cycles.crank_angles(model.lobe_count, model.pin_count)
    states = nominal_states(model, angles)

    def key(case: DutyCase) -> tuple[float, FrictionChoice, float]:
        # Cases of other speeds have other films, and where there are none the same forces.
        speed = case.speed * model.lobe_count if any(model.by_film) else 0.0
        return case.torque, case.power_sense if friction else "off", speed

    solved = {
        (torque, choice, speed): contact_sweep(
            model, torque, states=states, friction=ContactFriction.of(model, choice, speed)
        )
        for torque, choice, speed in dict.fromkeys(key(case) for case in cases)
    }
    duty = _Duty(design, cases, [solved[key(case)] for case in cases])
    bending, stresses = _pin_bending(duty)
    parts = (*_contacts(duty), bending)
    return LifeResult(
        duty=cases,
        loads=tuple(
            CaseLoads(
                ring_force=float(sweep.ring_force.max()),
                ring_pressure=float(sweep.ring_pressure.max()),
                pin_pressure=float(sweep.pin_pressure.max()),
                pin_bending=float(np.abs(stress).max()),
                cam_load=float(sweep.cam_load.max()),
                turns_per_hour=float(turns),
            )
            for sweep, stress, turns in zip(duty.sweeps, stresses, duty.turns, strict=True)
        ),
        assumed=assumed,
        required_hours=asked.life_hours,
        parts=parts,
        cam=_cam(duty),
        notes=_notes(parts),
        pack=PackLoads.of(duty.sweeps),
        runners=_runners(duty),
    )


def _notes(parts: tuple[PartLife, ...]) -> tuple[str, ...]:
    begins = float(fatigue.contact_cycle_factor(fatigue.CURVE_BEGINS))
    return tuple(
        f"the pressure on the {part.part} reaches {part.stress / 1e6:.0f} MPa, above "
        f"{begins * part.limit / 1e6:.0f} MPa where the pitting curve of AGMA 2101-D04 begins; "
        "yield decides there, and its life is an extrapolation."
        for part in parts[:-1]
        if part.limit > 0.0 and part.stress > begins * part.limit
    )


def _part(
    name: str,
    place: str,
    stress: float,
    limit: allowables.Allowable,
    cycle_count: int,
    rate: float,
    reserve: float | None,
    turns_per_hour: float,
) -> PartLife:
    hours = 1.0 / rate if rate > 1.0 / _ENDLESS_HOURS else None
    return PartLife(
        part=name,
        place=place,
        stress=stress,
        limit=limit.value,
        basis=limit.basis,
        cycles_per_output_turn=cycle_count,
        damage_per_hour=rate,
        hours=hours,
        output_turns=None if hours is None else hours * turns_per_hour,
        reserve=reserve,
    )


def _unknown(name: str, stress: float, limit: allowables.Allowable, cycle_count: int) -> PartLife:
    return PartLife(name, "", stress, 0.0, limit.basis, cycle_count, None, None, None, None)


def _contacts(duty: _Duty) -> list[PartLife]:
    reducer, n, sweeps = duty.design.reducer, duty.design.reducer.ratio, duty.sweeps
    flank = contacts.moving_contact([sweep.ring_pressure for sweep in sweeps], n)
    hole = contacts.moving_contact([sweep.pin_pressure for sweep in sweeps], n)
    tooth = contacts.tooth_contact(sweeps)
    once, again = cycles.ring_tooth_cycles(n), cycles.disc_cycles(n)
    first, model = sweeps[0], sweeps[0].model
    flank_at, hole_at = partial(contacts.flank_place, first), partial(contacts.hole_place, first)
    tooth_at = partial(contacts.tooth_place, model, tooth.values.shape[2])
    rows: tuple[tuple[str, Pressures, int, str, Callable[[int], str]], ...] = (
        ("ring teeth", tooth, once, reducer.ring_material, tooth_at),
        ("disc flanks", flank, again, reducer.disc_material, flank_at),
        ("disc holes", hole, again, reducer.disc_material, hole_at),
        ("output pins, contact", hole, again, reducer.output_pins.material, hole_at),
    )
    hours = duty.design.requirements.life_hours
    return [_contact(duty.turns, hours, *row) for row in rows]


def _contact(
    turns: FloatArray,
    hours: float,
    name: str,
    pressures: Pressures,
    cycle_count: int,
    material: str,
    words: Callable[[int], str],
) -> PartLife:
    limit = allowables.contact_limit_fatigue(find_material(material))
    greatest = float(pressures.values.max())
    if limit.value <= 0.0:
        return _unknown(name, greatest, limit, cycle_count)
    damage = pressures.damage(turns, limit.value)
    reserve = pressures.reserve(turns, limit.value, hours)
    worst = int(damage.argmax())
    place = "" if reserve is None else words(worst)
    return _part(
        name,
        place,
        greatest,
        limit,
        cycle_count,
        float(damage[worst]),
        reserve,
        float(turns.sum()),
    )


def _pin_bending(duty: _Duty) -> tuple[PartLife, list[NDArray[np.complex128]]]:
    """Bending of the output pins, and its stress vectors in every load case."""
    reducer, cases = duty.design.reducer, duty.cases
    material = find_material(reducer.output_pins.material)
    stresses = [pins.bending_histories(sweep) for sweep in duty.sweeps]
    senses = [case.torque for case in cases if case.share > 0.0]
    reverses = min(senses) < 0.0 < max(senses)
    limit = allowables.pin_bending_limit_continuous(material, duty_reverses=reverses)
    endurance = allowables.pin_bending_limit_continuous(material, duty_reverses=True).value
    ultimate = material.ultimate_strength
    name = "output pins, bending reversed" if reverses else "output pins, bending"
    count = cycles.disc_cycles(reducer.ratio)
    if ultimate is None or limit.value <= 0.0:
        greatest = max(float(np.abs(stress).max()) for stress in stresses)
        return _unknown(name, greatest, limit, count), stresses
    fibres = pins.worst_fibres(
        stresses,
        [case.torque for case in cases],
        count * duty.turns,
        [case.share > 0.0 and case.speed == 0.0 and case.torque != 0.0 for case in cases],
        ultimate,
    )
    swings = [fibre.reversed_amplitude(ultimate) for fibre in fibres]
    rates = [fibre.damage(endurance, ultimate) for fibre in fibres]
    swing = max(swings, default=0.0)
    place, reserve = "", None
    if swing > 0.0:
        hours = duty.design.requirements.life_hours
        worst = fibres[max(range(len(fibres)), key=lambda k: (rates[k], swings[k]))]
        places = ["at the plate", *(f"at disc {d + 1}" for d in range(reducer.disc_count))]
        place = [*places, "at the cap"][worst.section]
        reserve = min(
            fatigue.largest_factor(partial(one.damage, endurance, ultimate), hours)
            for one in fibres
        )
    if math.isinf(swing):
        # A mean beyond the ultimate strength, which no reversed stress stands for.
        stress = max(float(np.abs(one).max()) for one in stresses)
    else:
        stress = swing if reverses else fatigue.goodman_pulsating(swing, ultimate)
    rate = max(rates, default=0.0)
    part = _part(name, place, stress, limit, count, rate, reserve, float(duty.turns.sum()))
    return part, stresses


def _runners(duty: _Duty) -> tuple[RunnerLife, ...]:
    """Lives of sleeves and rollers, where there are any."""
    shares, speeds = np.array([(case.share, case.speed) for case in duty.cases]).T
    turning = RunnerDuty(duty.design, duty.sweeps, shares, speeds)
    found = (sleeve_life(turning), roller_life(turning))
    return tuple(one for one in found if one is not None)


def _cam(duty: _Duty) -> CamLife:
    design, n = duty.design, duty.design.reducer.ratio
    stages = Stages.from_design(design)
    peak = rigid_maxima(stages, design.requirements.peak_torque).cam_bearing_load
    checked = cam_bearing(design, peak)
    # The output's speed times n is the crank's; the bearing turns (1 + 1/n) times that.
    speeds = np.array(
        [float(kinematics.cam_bearing_speed_ring_fixed(n, n * case.speed)) for case in duty.cases]
    )
    return cam_life(
        checked.bearing,
        np.stack([sweep.cam_load for sweep in duty.sweeps]),
        np.array([case.share for case in duty.cases]),
        speeds,
        checked.life_hours,
    )
