"""Life of a gearbox under the duty of its requirements."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cqdd_design.catalog.bearings import Bearing, find_bearing
from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.gearbox import allowables, kinematics, output_pins
from cqdd_design.gearbox.bearings import basic_rating_life_hours, life_exponent
from cqdd_design.gearbox.cam_bearing import rolling_element, with_chosen_bearing
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.states import nominal_states
from cqdd_design.gearbox.contact.sweep import ContactSweep, contact_sweep, perfect_angles
from cqdd_design.gearbox.life import fatigue
from cqdd_design.gearbox.life.cycles import disc_cycles, ring_tooth_cycles

FloatArray = NDArray[np.float64]

ANGLES = 120
_ENDLESS_HOURS = 1e9
"""Lives beyond this, a hundred thousand years, are given as none: the curves mean nothing there."""
WEIBULL_BALL, WEIBULL_ROLLER = 10.0 / 9.0, 9.0 / 8.0
"""Slopes of the scatter of bearing lives (ISO 281:2007; Lundberg and Palmgren 1947, 1952)."""


@dataclass(frozen=True)
class DutyCase:
    """One load case: output torque (N m, signed), output speed (rad/s, size), share of time."""

    torque: float
    speed: float
    share: float


@dataclass(frozen=True)
class PartLife:
    """Fatigue life of one place.

    Attributes
    ----------
    part : str
        What is judged.
    stress : float
        Greatest pressure or stress over the duty, Pa.
    limit : float
        Fatigue limit at the knee of the curve, Pa; zero where none is known.
    basis : str
        Where the limit comes from.
    cycles_per_output_turn : int
    damage_per_hour : float or None
        None where no limit is known.
    hours : float or None
        None when it does not end, or when no limit is known.
    reserve : float or None
        Factor on the stress at which the part lasts just the required hours.
    """

    part: str
    stress: float
    limit: float
    basis: str
    cycles_per_output_turn: int
    damage_per_hour: float | None
    hours: float | None
    reserve: float | None

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form."""
        return {
            "part": self.part,
            "stress_max_MPa": self.stress / 1e6,
            "limit_MPa": self.limit / 1e6,
            "limit_basis": self.basis,
            "cycles_per_output_turn": self.cycles_per_output_turn,
            "damage_per_hour": self.damage_per_hour,
            "life_hours": self.hours,
            "stress_reserve_at_required_life": self.reserve,
        }


@dataclass(frozen=True)
class CamLife:
    """Life of the cam bearings on their load as it varies.

    Attributes
    ----------
    designation : str
    equivalent_load : tuple of float
        Of every disc's bearing over the period and the duty, N.
    hours : tuple of float or None
        L10h of each; None without a rating or without motion.
    set_hours : float or None
        L10h of all of them together.
    hours_at_greatest : float or None
        At the greatest load of the duty, as the check takes it.
    """

    designation: str
    equivalent_load: tuple[float, ...]
    hours: tuple[float, ...] | None
    set_hours: float | None
    hours_at_greatest: float | None

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form."""
        return {
            "designation": self.designation,
            "equivalent_load_N": list(self.equivalent_load),
            "L10h": None if self.hours is None else list(self.hours),
            "set_L10h": self.set_hours,
            "L10h_at_greatest_load": self.hours_at_greatest,
        }


@dataclass(frozen=True)
class LifeResult:
    """Life under a duty.

    Attributes
    ----------
    duty : tuple of DutyCase
    assumed : bool
        Whether the requirements give none and the continuous torque at the input speed is taken.
    required_hours : float
    parts : tuple of PartLife
        Contact fatigue of ring, discs, holes and pins, and bending of the pins.
    cam : CamLife
    """

    duty: tuple[DutyCase, ...]
    assumed: bool
    required_hours: float
    parts: tuple[PartLife, ...]
    cam: CamLife

    @property
    def warnings(self) -> tuple[str, ...]:
        """Parts without a known limit, and those that do not last."""
        found = [
            f"no fatigue limit is known for the {part.part} ({part.basis}): its life is not given."
            for part in self.parts
            if part.limit <= 0.0
        ]
        found += [
            f"the {part.part} would last {part.hours:.3g} h under this duty, less than the "
            f"{self.required_hours:g} h required."
            for part in self.parts
            if part.hours is not None and part.hours < self.required_hours
        ]
        return tuple(found)

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form (``life``)."""
        return {
            "duty": [
                {
                    "torque_Nm": case.torque,
                    "output_speed_rad_per_s": case.speed,
                    "share": case.share,
                }
                for case in self.duty
            ],
            "duty_assumed": self.assumed,
            "required_hours": self.required_hours,
            "parts": [part.to_dict() for part in self.parts],
            "cam_bearings": self.cam.to_dict(),
        }


def duty_cases(design: Design) -> tuple[tuple[DutyCase, ...], bool]:
    """Load cases of a design, and whether they are assumed."""
    asked = design.requirements
    if asked.duty:
        cases = tuple(DutyCase(p.torque, abs(p.speed), p.share) for p in asked.duty)
        return cases, False
    speed = asked.input_speed / design.reducer.ratio
    return (DutyCase(asked.continuous_torque, speed, 1.0),), True


def life(design: Design, model: ContactModel) -> LifeResult:
    """Life of contacts, output pins and cam bearings under the duty of the requirements.

    Parameters
    ----------
    design : Design
    model : ContactModel
        Of the same design.

    Raises
    ------
    ContactError
        When a load case has no equilibrium.

    Notes
    -----
    Each sense of torque loads its own flanks, so contact damage counts per sense and the worse
    one is given. Output pins bend in both: one sense pulsates, a duty of both senses is held to
    the reversed limit. Perfect parts are assumed; forces are those of the contact equilibrium.
    """
    design = with_chosen_bearing(design)
    cases, assumed = duty_cases(design)
    states = nominal_states(model, perfect_angles(model, ANGLES))
    sweeps = [contact_sweep(model, case.torque, states=states) for case in cases]
    return LifeResult(
        duty=cases,
        assumed=assumed,
        required_hours=allowables.LIFE_HOURS,
        parts=(*_contacts(design, cases, sweeps), _pin_bending(design, cases, sweeps)),
        cam=_cam_life(design, cases, sweeps),
    )


def _turns_per_hour(cases: tuple[DutyCase, ...]) -> FloatArray:
    return np.array([case.share * case.speed * 3600.0 / (2.0 * math.pi) for case in cases])


def _judged(
    part: str,
    stress: FloatArray,
    turns: FloatArray,
    cycles: int,
    limit: allowables.Allowable,
    to_failure: fatigue.CyclesToFailure | None,
) -> PartLife:
    greatest = float(stress.max(initial=0.0))
    if to_failure is None:
        return PartLife(part, greatest, 0.0, limit.basis, cycles, None, None, None)
    rate = fatigue.damage_rate(stress, cycles * turns, to_failure)
    hours = 1.0 / rate if rate > 1.0 / _ENDLESS_HOURS else None
    reserve = fatigue.stress_reserve(stress, cycles * turns, to_failure, allowables.LIFE_HOURS)
    return PartLife(part, greatest, limit.value, limit.basis, cycles, rate, hours, reserve)


def _contacts(
    design: Design, cases: tuple[DutyCase, ...], sweeps: list[ContactSweep]
) -> list[PartLife]:
    reducer, n = design.reducer, design.reducer.ratio
    turns = _turns_per_hour(cases)
    ring = np.array([float(sweep.ring_pressure.max()) for sweep in sweeps])
    pin = np.array([float(sweep.pin_pressure.max()) for sweep in sweeps])
    sense = np.array([math.copysign(1.0, case.torque) for case in cases])
    found = []
    for part, pressure, cycles, material in (
        ("ring teeth", ring, ring_tooth_cycles(n), reducer.ring_material),
        ("disc flanks", ring, disc_cycles(n), reducer.disc_material),
        ("disc holes", pin, disc_cycles(n), reducer.disc_material),
        ("output pins, contact", pin, disc_cycles(n), reducer.output_pins.material),
    ):
        limit = allowables.contact_limit_fatigue(find_material(material))
        by_sense = [
            _contact_life(part, np.where(sense == way, pressure, 0.0), turns, cycles, limit)
            for way in (1.0, -1.0)
        ]
        found.append(max(by_sense, key=lambda one: (one.damage_per_hour or 0.0, one.stress)))
    return found


def _contact_life(
    part: str, pressure: FloatArray, turns: FloatArray, cycles: int, limit: allowables.Allowable
) -> PartLife:
    def to_failure(stress: FloatArray) -> FloatArray:
        return fatigue.contact_cycles(stress, limit.value)

    known = to_failure if limit.value > 0.0 else None
    return _judged(part, pressure, turns, cycles, limit, known)


def _pin_bending(
    design: Design, cases: tuple[DutyCase, ...], sweeps: list[ContactSweep]
) -> PartLife:
    reducer, pins = design.reducer, design.reducer.output_pins
    material = find_material(pins.material)
    arm = output_pins.bending_arm(
        reducer.disc_count, reducer.disc_thickness, reducer.disc_spacing, pins.support
    )
    force = np.array([float(sweep.pin_force.max()) for sweep in sweeps])
    stress = output_pins.bending_stress(force, arm, pins.diameter)
    senses = [case.torque for case in cases if case.share > 0.0]
    reverses = min(senses) < 0.0 < max(senses)
    limit = allowables.pin_bending_limit_continuous(material, duty_reverses=reverses)
    ultimate = material.ultimate_strength
    words = "output pins, bending reversed" if reverses else "output pins, bending"

    def to_failure(values: FloatArray) -> FloatArray:
        assert ultimate is not None
        return fatigue.pin_cycles(values, limit.value, ultimate)

    known = to_failure if limit.value > 0.0 and ultimate is not None else None
    cycles = disc_cycles(reducer.ratio)
    return _judged(words, stress, _turns_per_hour(cases), cycles, limit, known)


def equivalent_load(
    loads: FloatArray, shares: FloatArray, speeds: FloatArray, exponent: float
) -> FloatArray:
    """Constant load of the same life as loads that vary over period and duty.

    Parameters
    ----------
    loads : array (C, A, D)
        Of C cases at A even angles on D bearings, N.
    shares, speeds : array (C,)
        Share of time and speed of every case; only their products matter.
    exponent : float
        p.

    Returns
    -------
    array (D,)
        (sum share speed mean(P^p)/sum share speed)^(1/p), N; zero without motion (ISO 281:2007).
    """
    weight = shares * speeds
    if weight.sum() <= 0.0:
        return np.zeros(loads.shape[-1])
    mean = np.mean(loads**exponent, axis=1)
    return np.asarray((weight @ mean / weight.sum()) ** (1.0 / exponent))


def _cam_life(design: Design, cases: tuple[DutyCase, ...], sweeps: list[ContactSweep]) -> CamLife:
    bearing: Bearing = find_bearing(design.reducer.cam_bearing.designation)
    element = rolling_element(bearing)
    exponent = life_exponent(element)
    shares = np.array([case.share for case in cases])
    # The output's speed times n is the crank's; the bearing turns (1 + 1/n) times that.
    n = design.reducer.ratio
    speeds = np.array(
        [float(kinematics.cam_bearing_speed_ring_fixed(n, n * case.speed)) for case in cases]
    )
    loads = np.stack([sweep.cam_load for sweep in sweeps])
    equal = equivalent_load(loads, shares, speeds, exponent)
    speed = float(shares @ speeds)
    if bearing.dynamic_rating is None or speed <= 0.0 or equal.min() <= 0.0:
        return CamLife(bearing.designation, tuple(equal.tolist()), None, None, None)
    hours = basic_rating_life_hours(bearing.dynamic_rating, equal, speed, exponent)
    slope = WEIBULL_BALL if element == "ball" else WEIBULL_ROLLER
    together = float(np.sum(hours**-slope) ** (-1.0 / slope))
    greatest = basic_rating_life_hours(bearing.dynamic_rating, loads.max(), speed, exponent)
    return CamLife(
        bearing.designation,
        tuple(equal.tolist()),
        tuple(hours.tolist()),
        together,
        float(greatest),
    )
