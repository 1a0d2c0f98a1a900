"""Motors ranked before any verdict: torque, speed and a gearbox in the bore, by closed forms."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

from cqdd_design.catalog.motors import Motor
from cqdd_design.design import Requirements
from cqdd_design.errors import InfeasibleError
from cqdd_design.gearbox.checks.allowables import REDUCER_EFFICIENCY
from cqdd_design.gearbox.film.mixed import BOUNDARY_FRICTION
from cqdd_design.geometry.scale import largest_ring
from cqdd_design.sizing.frame import Goal, search_frame
from cqdd_design.sizing.goals import tied, untied
from cqdd_design.sizing.motor_reach import reach
from cqdd_design.sizing.result import SizedDesign
from cqdd_design.sizing.search import Search
from cqdd_design.sizing.spaces import FITS, Space, spaces
from cqdd_design.sizing.stage_tables import stage_tables

RANKED = MappingProxyType(
    {
        "mass": "mass of motor and gearbox",
        "inertia": "inertia of rotor and gearbox at the crank",
        "backlash": "backlash of the gearbox",
        "efficiency": "losses of gearbox, winding and drag at the continuous torque",
        "size": "volume round motor and gearbox",
    }
)
"""What motors are ranked by for a goal, in words."""
_UNITS = MappingProxyType(
    {"mass": "kg", "inertia": "kgm2", "backlash": "rad", "efficiency": "share", "size": "m3"}
)
_RPM = 30.0 / math.pi


@dataclass(frozen=True)
class Ranked:
    """A motor with what the screen says of it.

    Attributes
    ----------
    value : float or None
        What the motors are ranked by, see `RANKED`: kg, kg m^2, rad, losses over the work at the
        output, or m^3; None where the motor does not pass.
    unit : str
        Of `value`.
    mass : float or None
        Of the motor and the gearbox's parts, kg; None likewise.
    reach : float
        Share that is reached of what is asked, where it falls short; else 1.
    binding : tuple of str
        Identifier of the check that falls short.
    why : str
        Why it does not pass; empty where it does.
    explained : bool
        Whether sizing with this motor would say what gearbox it can have: not where the motor
        itself falls short.
    """

    motor: Motor
    value: float | None
    unit: str
    mass: float | None
    reach: float
    binding: tuple[str, ...]
    why: str
    explained: bool

    def to_dict(self) -> dict[str, object]:
        """The JSON form."""
        return {
            "motor": self.motor.name,
            "passes": not self.why,
            "value": self.value,
            "unit": self.unit,
            "mass_kg": self.mass,
            "taken_over": self.motor.taken_over.split(),
            "why": self.why or None,
        }


@dataclass(frozen=True)
class _Gearbox:
    """The best gearbox by closed forms in a ring, or how far the strongest reaches."""

    sized: SizedDesign | None
    reach: float


def screened(
    requirements: Requirements,
    rows: Iterable[Motor],
    *,
    every_space: bool,
    ambient: float | None,
    goal: Goal,
) -> tuple[Ranked, ...]:
    """Motors that may do, best first, then the others, the closest first.

    A motor passes that has the torque at the output by its figures and an efficiency above what
    losses leave, turns as fast as is asked for without load and with magnets as warm as the winding
    may be (so that no motor is lost here which a closer model would pass), and has a bore into
    which a gearbox goes that closed forms bear out.

    Parameters
    ----------
    requirements : Requirements
        Torques, speed and space; their motor is not looked at.
    rows : iterable of Motor
        With their constant, resistance, peak torque, bore, rotor inertia, mass and drag.
    every_space : bool
        Whether the discs and steels that sizing to the verdict tries are looked at; else those of
        the requirements.
    ambient : float or None
        Of the air, deg C.
    goal : Goal
        Ranked by it with the motor's own share, see `with_motor`.
    """
    gearboxes: dict[float, _Gearbox] = {}
    found = []
    for motor in rows:
        short = _short(requirements, motor, ambient)
        if short is not None:
            found.append(short)
            continue
        ring = _ring(requirements, motor)
        if ring not in gearboxes:
            # Nothing else of a motor reaches a search: rows with room for the same ring share it.
            asked = requirements.unchecked_copy({"motor": motor.name})
            tried = tuple(spaces(asked, FITS[0])) if every_space else (_own_space(asked),)
            gearboxes[ring] = _best(asked, motor, tried, ambient, goal)
        found.append(_ranked(requirements, motor, gearboxes[ring], goal, ring))
    # Stable: among equals the catalogue's order holds.
    return tuple(
        sorted(
            found,
            key=lambda one: (
                (0, tied(one.value, one.mass))
                if one.value is not None and one.mass is not None
                else (1, -one.reach)
            ),
        )
    )


def with_motor(goal: Goal, sized: SizedDesign, requirements: Requirements, motor: Motor) -> float:
    """What a goal makes small, with the motor's own share of it.

    Mass, and inertia at the crank: motor or rotor and gearbox (kg, kg m^2). Backlash: the gearbox
    alone (rad). Losses: boundary friction of teeth and pins, copper and drag of the motor at the
    continuous torque and its speed, over the work at the output. Size: the motor's cylinder, longer
    where the pack of discs in its bore is (m^3).
    """
    objective, reducer = sized.objective, sized.design.reducer
    alone = untied(goal, objective.score, objective.mass)
    if goal == "mass":
        return alone + (motor.mass or 0.0)
    if goal == "inertia":
        return alone + (motor.rotor_inertia or 0.0)
    if goal == "backlash":
        return alone
    if goal == "size":
        length = max(motor.length or motor.rotor_length or 0.0, reducer.pack_length)
        return 0.25 * math.pi * (motor.outer_diameter or 0.0) ** 2 * length
    return losses_share(requirements, motor, BOUNDARY_FRICTION * alone)


def losses_share(requirements: Requirements, motor: Motor, friction: float) -> float:
    """Losses of gearbox and motor over the work at the output, at the continuous torque.

    Parameters
    ----------
    friction : float
        Losses of the gearbox over that work.
    """
    speed, n = requirements.held_speed, requirements.ratio
    drag = (motor.coulomb or 0.0) + (motor.hysteresis or 0.0)
    drag += speed * ((motor.viscous or 0.0) + (motor.iron_loss or 0.0))
    torque = requirements.continuous_torque * (1.0 + friction) / n + drag
    current = torque / (motor.torque_constant or math.inf)
    copper = (motor.line_resistance or 0.0) * current**2
    return friction + (copper + drag * speed) * n / (requirements.continuous_torque * speed)


def _short(requirements: Requirements, motor: Motor, ambient: float | None) -> Ranked | None:
    """What a motor falls short of by its own figures, whatever the gearbox; None where nothing."""
    most = reach(requirements, motor, ambient)
    shaft, speed, voltage = most.torque, most.speed, most.voltage
    torque = shaft * requirements.ratio * REDUCER_EFFICIENCY
    peak, fast = requirements.peak_torque, requirements.input_speed
    if torque < peak:
        return _refused(
            motor,
            torque / peak,
            "MOTOR-PEAK",
            f"at most {torque:.4g} of {peak:g} N*m at the output, with {shaft:.4g} N*m at the "
            f"shaft and an efficiency of {REDUCER_EFFICIENCY:g}, above what losses leave",
        )
    if speed < fast:
        return _refused(
            motor,
            speed / fast,
            "MOTOR-SPEED",
            f"at most {speed * _RPM:.0f} of {fast * _RPM:.0f} rpm on {voltage:g} V, warm and "
            "without load",
        )
    return None


def _refused(
    motor: Motor, reach: float, binding: str, why: str, *, explained: bool = False
) -> Ranked:
    return Ranked(motor, None, "", None, reach, (binding,), why, explained)


def _ring(requirements: Requirements, motor: Motor) -> float:
    """Largest ring, m: what is asked for, or what goes into the bore."""
    bore = motor.bore_diameter
    return min(requirements.outer_diameter, math.inf if bore is None else largest_ring(bore))


def _own_space(requirements: Requirements) -> Space:
    """The discs and steels that requirements state or assume."""
    asked = requirements
    return Space(asked.disc_count, asked.disc_material, asked.ring_material, FITS[0])


def _best(
    requirements: Requirements,
    motor: Motor,
    tried: Sequence[Space],
    ambient: float | None,
    goal: Goal,
) -> _Gearbox:
    """The best gearbox of some spaces."""
    tables, best = stage_tables(requirements.ratio), _Gearbox(None, 0.0)
    for space in tried:
        try:
            frame = search_frame(space.of(requirements), motor, ambient, space.fit, goal)
        except InfeasibleError:
            continue
        search = Search.of(frame, tables)
        most = search.most_reserve()
        if most is None:
            continue
        best = replace(best, reach=max(best.reach, float(most.reserve[0])))
        found = search.lightest(most)
        if found is not None and (
            best.sized is None or found[0].objective.score < best.sized.objective.score
        ):
            best = replace(best, sized=found[0])
    return best


def _ranked(
    requirements: Requirements, motor: Motor, gearbox: _Gearbox, goal: Goal, ring: float
) -> Ranked:
    sized = gearbox.sized
    if sized is None:
        peak = requirements.peak_torque
        most = min(gearbox.reach, 1.0)
        carried = f"carries {peak:g} N*m" if most > 0.0 else "fits at any torque"
        why = f"by closed forms no gearbox of a ring up to {1e3 * ring:.4g} mm {carried}"
        why += f"; the most is about {most * peak:.3g} N*m" if 0.0 < most < 1.0 else ""
        return _refused(motor, most, "MOTOR-BORE", why, explained=True)
    return Ranked(
        motor=motor,
        value=with_motor(goal, sized, requirements, motor),
        unit=_UNITS[goal],
        mass=sized.objective.mass + (motor.mass or 0.0),
        reach=1.0,
        binding=(),
        why="",
        explained=True,
    )
