"""Into a rigid stop: what torque the gearbox takes when its output is stopped at a speed.

The output stops at once; rotor, crank and discs run on and wind the gearbox up. Their energy is
``J w^2/2`` with their inertia J at the output; that of the output's own side goes into the stop.
A linear spring k that takes it all peaks at ``w sqrt(k J)``; the transmission's own stiffens,
``T = T0 (d/d0)^p``, which far beyond T0, the continuous torque, is an extrapolation. Backlash adds
nothing where the motor gives no torque; where its torque is left in, it works over the backlash and
the windup. By energy nothing is lost; the simulation integrates the same against a held output,
with friction and damping.

Forces and pressures are those of the contact equilibrium at the peak torque, quasi-static and
elastic: what yields first takes less. Stop, shaft, housing and carrier are rigid, all of which say
too much rather than too little.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.density import torques_of_drive
from cqdd_design.actuator.packing import safe_step
from cqdd_design.actuator.parameters import ActuatorParameters, GearParameters
from cqdd_design.actuator.scenario import Command, Constant, Load, Scenario, Start
from cqdd_design.actuator.simulate import simulate
from cqdd_design.actuator.specimen import AS_DRAWN, Specimen
from cqdd_design.errors import ContactError, CqddError
from cqdd_design.machine import Machine
from cqdd_design.machine.capacity import LoadedContacts
from cqdd_design.machine.carrying import OUT_OF_REACH, compared_limits

_PLACES = 12
"""Of a motor turn at which the output meets the stop in the simulation."""
METHODS: Mapping[str, str] = {
    "by_secant": "speed times sqrt(k J), secant stiffness at the continuous torque",
    "by_energy": "energy, stiffening law, motor without torque",
    "by_energy_motor_in": "energy, stiffening law, motor's torque left in",
    "by_simulation": "simulated, motor without torque",
    "by_simulation_motor_in": "simulated, motor's torque left in",
}
"""How a stop is worked out, and what that is called."""


@dataclass(frozen=True)
class Loaded:
    """A static limit, and what stands against it at a torque, in `unit`."""

    check: str
    title: str
    value: float
    limit: float
    unit: str

    @property
    def share(self) -> float:
        """Value over limit."""
        return self.value / self.limit

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form."""
        return dict(vars(self))


@dataclass(frozen=True, eq=False)
class Stop:
    """One way to a peak torque.

    Attributes
    ----------
    torque : float or None
        At the output, N m; None where no contact equilibrium carries it.
    forces : mapping of str to float
        Greatest forces and pressures of the equilibrium at it, by their JSON keys.
    limits : tuple of Loaded
        Static limits beside them, the most exceeded first.
    missing : str
        Why there are none; else empty.
    """

    torque: float | None
    forces: Mapping[str, float] = field(default_factory=dict)
    limits: tuple[Loaded, ...] = ()
    missing: str = ""

    @property
    def told(self) -> str:
        """What it does to the gearbox, or why that is not known."""
        if self.torque is None:
            return self.missing
        head = f"{self.torque:.3g} N*m"
        if not self.limits:
            return f"{head}; no static limit is known"
        if over := [one for one in self.limits if one.share > 1.0]:
            parts = "; ".join(f"{one.title} at {one.share:.3g} times its limit" for one in over)
            return f"{head}, beyond static limits: {parts}"
        first = self.limits[0]
        return f"{head}, within static limits: {first.title} at {first.share:.3g} of its limit"

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form."""
        return {
            "torque_Nm": self.torque,
            "forces": dict(self.forces) if self.forces else None,
            "static_limits": [one.to_dict() for one in self.limits],
            "told": self.told,
        }


@dataclass(frozen=True, eq=False)
class Shock:
    """A stop from one speed.

    Attributes
    ----------
    speed : float
        Of the output before it, rad/s.
    inertia : float
        Of what runs on, at the output, kg m^2.
    stops : mapping of str to Stop
        By the keys of `METHODS`.
    """

    speed: float
    inertia: float
    stops: Mapping[str, Stop]

    @property
    def energy(self) -> float:
        """What the gearbox has to take, J."""
        return 0.5 * self.inertia * self.speed**2

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form."""
        return {
            "speed_rad_per_s": self.speed,
            "inertia_kgm2": self.inertia,
            "energy_J": self.energy,
            **{name: one.to_dict() for name, one in self.stops.items()},
        }


def stop_torque(gear: GearParameters, energy: float, motor: float = 0.0) -> float:
    """Peak torque of the transmission's spring that takes some energy, N m at the output.

    A spring ``T = T0 (d/d0)^p`` stores ``T d/(p + 1)`` at the windup d; the motor's torque M works
    over the backlash b and the windup::

        T d/(p + 1) = energy + M (b + d)

    Parameters
    ----------
    energy : float
        J, zero or more.
    motor : float
        M, N m at the output, zero or more.
    """
    power, first = gear.stiffening, gear.error_torque
    whole = first / gear.stiffness

    def torque(windup: float) -> float:
        return float(first * (windup / whole) ** power)

    def missing(windup: float) -> float:
        taken = torque(windup) * windup / (power + 1.0)
        return taken - energy - motor * (gear.backlash + windup)

    if energy <= 0.0 and motor <= 0.0:
        return 0.0
    least = most = whole
    while missing(least) >= 0.0:
        least *= 0.5
    while missing(most) < 0.0:
        most *= 2.0
    # Halved to rounding: a general root finder takes longer to import than all the rest to compute.
    while most - least > 1e-13 * most:
        middle = 0.5 * (least + most)
        least, most = (middle, most) if missing(middle) < 0.0 else (least, middle)
    return torque(most)


def simulated_torque(parameters: ActuatorParameters, speed: float, current: float = 0.0) -> float:
    """Greatest torque of the gearbox in time, its output held still from a speed on, N m.

    Over places of a motor turn, from the middle of the backlash; the motor's phases are open, or
    carry a current (A, positive towards the stop) as far as the supply drives it.
    """
    gear = parameters.gear
    given = math.copysign(current, gear.ratio)
    command = Command("current", Constant(given)) if current else Command("open")
    turn, held = 2.0 * math.pi / abs(gear.ratio), Load.driven(Constant(0.0))
    scenes = [
        Scenario(
            command,
            held,
            Start(turn * place / _PLACES, motor_speed=gear.ratio * speed, current=given),
        )
        for place in range(_PLACES)
    ]
    step = 0.2 * safe_step(parameters, *scenes)
    swing = math.sqrt(gear.ratio**2 * parameters.motor_side_inertia / gear.stiffness)
    run = simulate(parameters, scenes, gear.backlash / speed + 5.0 * swing, step)
    return float(np.abs(run.gear_torque).max())


def _peak_of_drive(parameters: ActuatorParameters) -> float:
    motor, ratio = parameters.motor, abs(parameters.gear.ratio)
    return min(
        torques_of_drive(motor, parameters.drive, ratio, parameters.thermal.ambient).values()
    )


def peak_current(parameters: ActuatorParameters) -> float:
    """Of the motor for the greatest torque that it and its driver give at rest, A."""
    constant = parameters.motor.torque_constant * abs(parameters.gear.ratio)
    return _peak_of_drive(parameters) / constant


def shock(machine: Machine, parameters: ActuatorParameters, speed: float) -> Shock:
    """Stop the output of a machine's actuator at a speed (rad/s, above zero)."""
    gear = parameters.gear
    inertia = parameters.motor_side_inertia * gear.ratio**2
    energy = 0.5 * inertia * speed**2
    peak = _peak_of_drive(parameters)
    current = peak_current(parameters)
    torques = (
        speed * math.sqrt(gear.stiffness * inertia),
        stop_torque(gear, energy),
        stop_torque(gear, energy, peak),
        simulated_torque(parameters, speed),
        simulated_torque(parameters, speed, current),
    )
    contacts = LoadedContacts(machine.contact)
    stops = (_stop(machine, contacts, torque) for torque in torques)
    return Shock(speed, inertia, dict(zip(METHODS, stops, strict=True)))


def _stop(machine: Machine, contacts: LoadedContacts, torque: float) -> Stop:
    try:
        forces = contacts.greatest(torque)
    except ContactError:
        return Stop(
            None,
            missing=f"no contact equilibrium carries what this asks for: {OUT_OF_REACH}",
        )
    beside = (
        Loaded(one.check, one.row.words, one.per_key * forces[one.row.key], one.limit, one.unit)
        for one in compared_limits(machine)
        if one.row.load == "peak"
    )
    return Stop(torque, forces, tuple(sorted(beside, key=lambda each: -each.share)))


def shocks(machine: Machine, specimen: Specimen = AS_DRAWN) -> tuple[dict[str, Shock], str]:
    """Stops at the rated speed and at the one that the requirements give; or why there are none."""
    asked = machine.design.requirements
    speeds = {"rated": asked.input_speed / machine.design.reducer.ratio}
    if asked.shock_speed > 0.0:
        speeds["given"] = asked.shock_speed
    try:
        parameters = actuator_parameters(machine, specimen)
        return {name: shock(machine, parameters, speed) for name, speed in speeds.items()}, ""
    except CqddError as error:
        return {}, f"no torque of a stop: {error.message}"
