"""The kernel's twin in plain numpy: the same equations, one step at a time, written to be read.

Every step solves for the mean speeds x (motor) and y (output) with the Newton iteration carried to
the end; dry friction is then asked whether it agrees with the motion it allows. The parts:
:mod:`.drive`, :mod:`.friction`, :mod:`.gear`, :mod:`.loads`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from cqdd_design.actuator.columns import LEDGER, MODES, TRACES, Constants, Signals, Steps
from cqdd_design.actuator.parameters import FloatArray
from cqdd_design.actuator.twin.drive import (
    PositionLoop,
    asked_of_winding,
    driven_current,
    ended_current,
    warmed,
)
from cqdd_design.actuator.twin.friction import FREE, STICK, agreed, begun, bristled, levels
from cqdd_design.actuator.twin.gear import damped_in_mesh, look_up, meshed, spring
from cqdd_design.actuator.twin.loads import (
    cogging,
    gravity_pull,
    stored_energy,
    wall_at,
    wall_push,
)

_ITERATIONS, _SWITCHES = 60, 6


@dataclass
class _Step:
    """Torques of one evaluation of a step."""

    left: float
    right: float
    matrix: FloatArray
    gear: float
    gear_slope: float
    arm: float
    cut: bool
    wall_rub: float
    end: dict[str, float]


class _Machine:
    """One actuator and its state."""

    def __init__(self, row: FloatArray, table: FloatArray, step: float) -> None:
        self.p = Constants(*map(float, row))
        self.table, self.h = table, step
        p = self.p
        self.s = {
            "angle": p.motor_angle,
            "speed": p.motor_speed,
            "out": p.output_angle,
            "out_speed": p.output_speed,
        }
        self.current = p.current
        self.heat = np.array([p.winding_temperature, p.housing_temperature])
        self.bristles = np.zeros(2)
        self.slowing = self.former = np.zeros(2)
        self.traced: dict[str, float] = {}
        self.transmitted = self.way = 0.0
        self.modes = [int(np.sign(self.s["speed"])), int(np.sign(self.s["out_speed"]))]
        self.s |= look_up(p, table, self.s["angle"])
        self.s["closing"] = self.s["angle"] / p.ratio + self.s["error"] - self.s["out"]
        self.s |= spring(p, self.s["closing"]) | wall_at(p, self.s["out"])

    def evaluate(self, x: float, y: float, given: dict[str, float]) -> _Step:
        """Balances of motor and output without dry friction at mean speeds x and y."""
        p, s, h = self.p, self.s, self.h
        mesh, end, cut = meshed(p, s, self.table, h * x, h * y, h)
        end |= wall_at(p, s["out"] + h * y)
        arm, gear, gear_slope = mesh["arm"], mesh["gear"], mesh["slope"]
        push, push_slope, wall_rub = wall_push(p, s, end, h, y)
        masses = 2.0 / h * np.array([p.motor_inertia, p.carried_inertia])
        left = given["drive"] - given["drive_slope"] * x - masses[0] * (x - s["speed"])
        cog = cogging(p, s["angle"], h * x)
        left += -given["b_motor"] * x - given["add_motor"] - cog - arm * gear
        left -= mesh["varying"]
        right = gear + given["external"] - masses[1] * (y - s["out_speed"])
        right += -given["b_output"] * y - given["add_output"] - gravity_pull(p, s["out"], h * y)
        right -= p.sensor_stiffness * (s["out"] + 0.5 * h * y) + p.sensor_damping * y
        right -= p.wall_side * (push + wall_rub)
        tie = arm * h * gear_slope
        matrix = np.array([[masses[0] + arm * tie, -tie], [-tie, masses[1] + h * gear_slope]])
        matrix[0, 0] += given["drive_slope"] + given["b_motor"]
        matrix[1, 1] += given["b_output"] + p.sensor_damping + push_slope
        matrix[1, 1] += 0.5 * h * p.sensor_stiffness
        return _Step(left, right, matrix, gear, gear_slope, arm, cut, wall_rub, end)

    def settle(
        self, x: float, y: float, given: dict[str, float], held: list[bool], dry: list[float]
    ) -> tuple[float, float, _Step]:
        """Mean speeds at which both balances hold, with some bodies held and dry friction given."""
        for _ in range(_ITERATIONS):
            found = self.evaluate(x, y, given)
            missing = np.array([found.left - dry[0], found.right - dry[1]])
            matrix = found.matrix.copy()
            for body in (0, 1):
                if held[body]:
                    matrix[body] = matrix[:, body] = 0.0
                    matrix[body, body], missing[body] = 1.0, 0.0
            dx, dy = np.linalg.solve(matrix, missing)
            x, y = x + float(dx), y + float(dy)
            if self.h * (abs(found.arm * dx - dy)) < 1e-13 and self.h * abs(dx) < 1e-12:
                break
        return x, y, self.evaluate(x, y, given)


def run_one(
    row: FloatArray,
    table: FloatArray,
    signals: Signals,
    steps: Steps,
    traces: Any,
    ledger: Any,
    place: int,
) -> None:
    """Step one actuator; arguments as for the kernel's."""
    h = steps.length
    m = _Machine(row, table, h)
    p = m.p
    mode, lugre, driven = MODES[int(p.mode)], bool(p.lugre), bool(p.driven)
    if driven:
        m.s["out_speed"] = float(signals.driven_speed[0])
    line: list[float] = [0.0] * int(p.delay_steps)
    loop = PositionLoop(p, mode)
    tally = dict.fromkeys(LEDGER, 0.0)
    tally["stored_before"] = stored_energy(p, m.s, m.current, m.bristles)

    def at(signal: FloatArray, k: int) -> float:
        return float(signal[k if len(signal) > 1 else 0])

    for k in range(steps.number):
        command = at(signals.reference, k)
        if mode in ("impedance", "position"):
            wanted = (command, at(signals.reference_rate, k), at(signals.feedforward, k))
            command = loop.act(h, m.s["angle"], m.s["speed"], wanted)
        line.append(asked_of_winding(p, mode, command))
        asked = line.pop(0)
        ahead = 2.0 * m.slowing - m.former
        given = {
            "guess": m.s["speed"] + 0.5 * h * float(ahead[0]),
            "b_motor": p.motor_viscous + p.iron_viscous,
            "b_output": p.output_viscous + p.load_viscous,
            "add_motor": 0.0,
            "add_output": 0.0,
            "external": at(signals.external, k),
        }
        out_guess = m.s["out_speed"] + 0.5 * h * float(ahead[1])
        electric = driven_current(p, h, m.current, m.heat, given["guess"], asked, mode)
        given |= {name: electric[name] for name in ("drive", "drive_slope")}
        toward = m.s["speed"] if m.s["speed"] != 0.0 else m.way
        dry_levels = levels(p, toward, m.transmitted, given["guess"], out_guess)
        relax = [0.0, 0.0]
        if lugre:
            damping = (p.motor_bristle_damping, 0.0)
            for body, name in enumerate(("motor", "output")):
                viscous, given[f"add_{name}"], relax[body] = bristled(
                    (p.motor_bristle, p.output_bristle)[body],
                    damping[body],
                    dry_levels[body],
                    h,
                    (given["guess"], out_guess)[body],
                    float(m.bristles[body]),
                )
                given[f"b_{name}"] += viscous
            dry_levels = [0.0, 0.0]
        next_speed = at(signals.driven_speed, k + 1)
        x, y, found, dry = _with_friction(m, given, out_guess, dry_levels, next_speed, driven)
        _finish(m, given, electric, x, y, found, dry, relax, dry_levels, tally, next_speed)
        if (k + 1) % steps.every == 0:
            m.traced["commanded_torque"] = command
            for name in TRACES:
                getattr(traces, name)[place, (k + 1) // steps.every - 1] = m.traced[name]
    tally["stored_after"] = stored_energy(p, m.s, m.current, m.bristles)
    tally["motor_friction"] -= 0.5 * p.motor_bristle * m.bristles[0] ** 2
    tally["output_friction"] -= 0.5 * p.output_bristle * m.bristles[1] ** 2
    for name in LEDGER:
        getattr(ledger, name)[place] = tally[name]


def _with_friction(
    m: _Machine,
    given: dict[str, float],
    out_guess: float,
    levels: list[float],
    next_speed: float,
    driven: bool,
) -> tuple[float, float, _Step, list[float]]:
    """Settle a step with the dry friction that agrees with it."""
    s = m.s
    speeds = (s["speed"], s["out_speed"])
    m.modes = [begun(m.modes[body], speeds[body]) for body in (0, 1)]
    rubs = [levels[0] > 0.0, levels[1] > 0.0 and not driven]
    x, y = given["guess"], 0.5 * (speeds[1] + next_speed) if driven else out_guess
    switches = 0
    while True:
        held = [rubs[body] and m.modes[body] == STICK for body in (0, 1)]
        dry = [
            m.modes[body] * levels[body] if rubs[body] and m.modes[body] in (-1, 1) else 0.0
            for body in (0, 1)
        ]
        if driven and levels[1] > 0.0:
            dry[1] = levels[1] * float(np.sign(y))
        if held[0]:
            x = 0.5 * speeds[0]
        if held[1]:
            y = 0.5 * speeds[1]
        x, y, found = m.settle(x, y, given, [held[0], held[1] or driven], dry)
        needed, switched = (found.left, found.right), False
        for body, mean in enumerate((x, y)):
            if not rubs[body] or switches >= _SWITCHES:
                continue
            mode = m.modes[body]
            if mode == STICK:
                dry[body] = needed[body]
            m.modes[body] = agreed(mode, dry[body], levels[body], speeds[body], mean)
            switched = switched or m.modes[body] != mode
        if not switched:
            for body in (0, 1):
                if held[body]:
                    dry[body] = needed[body]
            return x, y, found, dry
        switches += 1
        if switches == _SWITCHES:
            m.modes = [FREE if rubs[body] else m.modes[body] for body in (0, 1)]


def _finish(
    m: _Machine,
    given: dict[str, float],
    electric: dict[str, float],
    x: float,
    y: float,
    found: _Step,
    dry: list[float],
    relax: list[float],
    levels: list[float],
    tally: dict[str, float],
    next_speed: float,
) -> None:
    """Move to the end of the step, book its energies, record it."""
    p, s, h = m.p, m.s, m.h
    lugre, driven = bool(p.lugre), bool(p.driven)
    end, cut = found.end, found.cut
    change = h * x / p.ratio + (end["error"] - s["error"]) - h * y
    tally["gear_damping"] += damped_in_mesh(p, s, end, change, cut, h)
    viscous = p.motor_viscous + p.iron_viscous
    if lugre:
        m.bristles = (m.bristles + h * np.array([x, y])) / (1.0 + np.array(relax))
        m.bristles *= np.array([p.motor_bristle > 0.0, p.output_bristle > 0.0])
        dry = [
            (given["b_motor"] - viscous) * x + given["add_motor"],
            (given["b_output"] - p.output_viscous - p.load_viscous) * y + given["add_output"],
        ]
    new_speed, new_out = 2.0 * x - s["speed"], 2.0 * y - s["out_speed"]
    if not lugre and levels[0] > 0.0 and m.modes[0] == STICK:
        new_speed = 0.0
    if driven:
        new_out = next_speed
    elif not lugre and levels[1] > 0.0 and m.modes[1] == STICK:
        new_out = 0.0
    m.current, mean, voltage = ended_current(p, electric, h, m.current, x)
    copper = electric["resistance"] * mean**2
    iron_share = p.hysteresis / levels[0] if not lugre and levels[0] > 0.0 else 0.0
    iron = p.iron_viscous * x * x + iron_share * dry[0] * x
    rubbed = p.motor_viscous * x * x + (1.0 - iron_share) * dry[0] * x
    out_rubbed = p.output_viscous * y * y + dry[1] * y
    load = (p.sensor_damping + p.load_viscous) * y * y + found.wall_rub * p.wall_side * y
    # A driven output takes whatever is missing in its balance.
    external = given["external"]
    if driven:
        inertia = p.carried_inertia
        balance = found.right + 2.0 / h * inertia * (y - s["out_speed"]) - external
        external = inertia * (new_out - s["out_speed"]) / h - balance + (0 if lugre else dry[1])
    tally["electrical"] += voltage * mean * h
    tally["copper"] += copper * h
    tally["iron"] += iron * h
    tally["motor_friction"] += rubbed * h
    tally["output_friction"] += out_rubbed * h
    tally["load_damping"] += load * h
    tally["external"] += external * y * h
    tally["throughput"] += (abs(voltage * mean) + abs(external * y)) * h
    m.heat = warmed(p, m.heat, copper, iron + rubbed + out_rubbed)
    flange = found.gear - dry[1] - p.output_viscous * y
    flange -= p.output_inertia * (new_out - s["out_speed"]) / h
    m.former = m.slowing
    m.slowing = np.array([new_speed - s["speed"], new_out - s["out_speed"]]) / h
    m.way = dry[0] if dry[0] != 0.0 else m.way
    m.transmitted = found.gear
    closing = s["closing"] + change
    m.s = {"angle": s["angle"] + h * x, "out": s["out"] + h * y, "closing": closing}
    m.s |= {"speed": new_speed, "out_speed": new_out} | end
    m.traced = {
        "motor_angle": m.s["angle"],
        "motor_speed": new_speed,
        "output_angle": m.s["out"],
        "output_speed": new_out,
        "current": m.current,
        "voltage": voltage,
        "deflection": closing,
        "gear_torque": found.gear,
        "output_torque": flange,
        "motor_friction": dry[0] + p.motor_viscous * x,
        "output_friction": dry[1] + p.output_viscous * y,
        "winding_temperature": float(m.heat[0]),
        "housing_temperature": float(m.heat[1]),
    }


def run_sets(
    rows: FloatArray,
    tables: FloatArray,
    signals: Signals,
    steps: Steps,
    traces: Any,
    ledger: Any,
) -> None:
    """Step S actuators one after the other; see the kernel."""
    for i in range(len(rows)):
        own = Signals(*(signal[min(i, len(signal) - 1)] for signal in signals))
        run_one(rows[i], tables[i], own, steps, traces, ledger, i)
