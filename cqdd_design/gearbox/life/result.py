"""What the life of a gearbox is said to be."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from cqdd_design.gearbox.life.cam import CamLife
from cqdd_design.gearbox.life.runners import RunnerLife
from cqdd_design.terms import life_text

if TYPE_CHECKING:
    from cqdd_design.gearbox.contact.rubbing import PowerSense
    from cqdd_design.gearbox.pack_loads import PackLoads


@dataclass(frozen=True)
class DutyCase:
    """One load case.

    Attributes
    ----------
    torque, speed : float
        At the output, N m with its sign and rad/s without.
    share : float
        Of the time.
    driven : bool
        Whether the output drives the motor: its torque and speed oppose each other.
    """

    torque: float
    speed: float
    share: float
    driven: bool = False

    @property
    def power_sense(self) -> PowerSense:
        """Which way power goes; at a standstill as when the motor drives."""
        return "backdrive" if self.driven else "drive"


@dataclass(frozen=True)
class CaseLoads:
    """Greatest loads over the period in one load case.

    Attributes
    ----------
    ring_force : float
        Of one tooth on a disc, N.
    ring_pressure, pin_pressure : float
        Hertz pressure of flank on tooth and of pin in hole, Pa.
    pin_bending : float
        Bending stress of an output pin, Pa.
    cam_load : float
        N.
    turns_per_hour : float
        Output turns in an hour of the duty, the share of time in them.
    """

    ring_force: float
    ring_pressure: float
    pin_pressure: float
    pin_bending: float
    cam_load: float
    turns_per_hour: float

    def to_dict(self) -> dict[str, float]:
        """Return the JSON form."""
        return {
            "ring_force_max_N": self.ring_force,
            "ring_pressure_max_MPa": self.ring_pressure / 1e6,
            "output_pressure_max_MPa": self.pin_pressure / 1e6,
            "pin_bending_max_MPa": self.pin_bending / 1e6,
            "cam_bearing_load_max_N": self.cam_load,
            "output_turns_per_hour": self.turns_per_hour,
        }


@dataclass(frozen=True)
class PartLife:
    """Fatigue life of one part at its worst place.

    Attributes
    ----------
    part : str
        What is judged.
    place : str
        Where it is worst; empty where nothing is loaded.
    stress : float
        Greatest pressure over the duty, Pa. For bending the one pulsating stress (with both
        senses of torque: the reversed amplitude) as harmful on Goodman's line as the worst cycle.
    limit : float
        Fatigue limit of such stresses at the knee of the curve, Pa; zero where none is known.
    basis : str
        Where the limit comes from.
    cycles_per_output_turn : int
        Load cycles of the part in the zone of one disc.
    damage_per_hour : float or None
        None where no limit is known.
    hours, output_turns : float or None
        Life; None when it does not end, or when no limit is known.
    reserve : float or None
        Factor on all stresses at which the part lasts just the required hours; None without a
        limit or without cycles.
    """

    part: str
    place: str
    stress: float
    limit: float
    basis: str
    cycles_per_output_turn: int
    damage_per_hour: float | None
    hours: float | None
    output_turns: float | None
    reserve: float | None

    def lasts(self, hours: float) -> bool:
        """Whether the part lives so long; never where no limit is known."""
        return self.limit > 0.0 and (self.hours is None or self.hours >= hours)

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form."""
        return {
            "part": self.part,
            "worst_place": self.place,
            "stress_max_MPa": self.stress / 1e6,
            "limit_MPa": self.limit / 1e6,
            "limit_basis": self.basis,
            "cycles_per_output_turn": self.cycles_per_output_turn,
            "damage_per_hour": self.damage_per_hour,
            "life_hours": self.hours,
            "life_output_turns": self.output_turns,
            "stress_reserve_at_required_life": self.reserve,
        }


@dataclass(frozen=True)
class LifeResult:
    """Life under a duty.

    Attributes
    ----------
    loads : tuple of CaseLoads
        Of the same cases.
    assumed : bool
        Whether the requirements give none and the continuous torque at the input speed is taken.
    required_hours : float
    parts : tuple of PartLife
        Contact fatigue of ring, discs, holes and pins, and bending of the pins.
    notes : tuple of str
        What of it stands outside its source.
    pack : PackLoads
        What the cases put on shaft and carrier.
    runners : tuple of RunnerLife
        Of sleeves and rollers, where there are any.
    """

    duty: tuple[DutyCase, ...]
    loads: tuple[CaseLoads, ...]
    assumed: bool
    required_hours: float
    parts: tuple[PartLife, ...]
    cam: CamLife
    notes: tuple[str, ...]
    pack: PackLoads
    runners: tuple[RunnerLife, ...] = ()

    @property
    def warnings(self) -> tuple[str, ...]:
        """Parts without a known limit, those that do not last, and lives without support."""
        found = [
            f"no fatigue limit is known for the {part.part} ({part.basis}): its life is not given."
            for part in self.parts
            if part.limit <= 0.0
        ]
        found += [
            f"the {part.part} would last {life_text(part.hours, 3)} under this duty, less than the "
            f"{self.required_hours:g} h required."
            for part in self.parts
            if part.hours is not None and part.hours < self.required_hours
        ]
        if self.cam.set_hours is not None and self.cam.set_hours < self.required_hours:
            found.append(
                f"the cam bearings {self.cam.designation} would together last "
                f"{life_text(self.cam.set_hours, 3)} under this duty (L10), less than the "
                f"{self.required_hours:g} h required."
            )
        if self.cam.hours is None:
            found.append(
                f"no life is given for the cam bearings {self.cam.designation}: the catalogue has "
                "no dynamic rating or the duty never turns."
            )
        found += [
            self._shortfall(one) for one in self.runners if not one.lasts(self.required_hours)
        ]
        return (*found, *self.notes)

    def _shortfall(self, runner: RunnerLife) -> str:
        """What is short or unknown of sleeves or rollers."""
        if runner.set_hours is not None and not runner.unknown:
            return (
                f"the {runner.name} on {runner.designation} would together last "
                f"{life_text(runner.set_hours, 3)} under this duty (L10), less than the "
                f"{self.required_hours:g} h required."
            )
        pv = runner.pressure_velocity
        bears = "" if pv is None else f"; they bear p v = {pv / 1e6:.3g} MPa m/s"
        return f"no life is given for the {runner.name} on their pins: {runner.unknown}{bears}."

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form (``life``)."""
        return {
            "duty": [
                {
                    "torque_Nm": case.torque,
                    "output_speed_rad_per_s": case.speed,
                    "share": case.share,
                    **loads.to_dict(),
                }
                for case, loads in zip(self.duty, self.loads, strict=True)
            ],
            "duty_assumed": self.assumed,
            "required_hours": self.required_hours,
            "parts": [part.to_dict() for part in self.parts],
            "cam_bearings": self.cam.to_dict(),
            **{runner.name: runner.to_dict() for runner in self.runners},
        }
