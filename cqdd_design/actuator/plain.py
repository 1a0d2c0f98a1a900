"""The kernel's twin in plain numpy: the same equations, one step at a time, written to be read.

Every step solves for the mean speeds x (motor) and y (output) with the Newton iteration carried to
the end; dry friction is then asked whether it agrees with the motion it allows.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from cqdd_design.actuator.columns import LEDGER, MODES, PARAMETERS, TRACES
from cqdd_design.actuator.motor import COPPER_COEFFICIENT, MAGNET_COEFFICIENT
from cqdd_design.actuator.parameters import FloatArray

_ITERATIONS, _SWITCHES = 60, 6
_STICK, _FREE = 0, 2


@dataclass
class _Step:
    """Torques of one evaluation of a step."""

    left: float
    right: float
    matrix: FloatArray
    gear: float
    gear_slope: float
    arm: float
    clipped: bool
    wall_rub: float
    end: dict[str, float]


class _Machine:
    """One actuator and its state."""

    def __init__(self, row: FloatArray, table: FloatArray, step: float) -> None:
        self.p: dict[str, float] = dict(zip(PARAMETERS, map(float, row), strict=True))
        self.table, self.h = table, step
        self.n = abs(self.p["ratio"])
        p = self.p
        self.s = {
            "angle": p["motor_angle"],
            "speed": p["motor_speed"],
            "out": p["output_angle"],
            "out_speed": p["output_speed"],
        }
        self.current = p["current"]
        self.heat = np.array([p["winding_temperature"], p["housing_temperature"]])
        self.bristles = np.zeros(2)
        self.slowing = self.former = np.zeros(2)
        self.traced: dict[str, float] = {}
        self.transmitted = self.way = 0.0
        self.modes = [int(np.sign(self.s["speed"])), int(np.sign(self.s["out_speed"]))]
        self.s |= self._look_up(self.s["angle"])
        self.s["closing"] = self.s["angle"] / p["ratio"] + self.s["error"] - self.s["out"]
        self.s |= self._spring(self.s["closing"]) | self._wall(self.s["out"])

    def _look_up(self, angle: float) -> dict[str, float]:
        count = len(self.table)
        place = (angle / (2.0 * math.pi * self.n)) % 1.0 * count
        low = int(place) % count
        x = place - int(place)
        basis = np.array([(1 + 2 * x) * (1 - x) ** 2, x * (1 - x) ** 2, x * x * (3 - 2 * x)])
        basis = np.append(basis, x * x * (x - 1))
        slope = np.array([6 * x * (x - 1), (x - 1) * (3 * x - 1), 6 * x * (1 - x), x * (3 * x - 2)])
        near = np.concatenate([self.table[low], self.table[(low + 1) % count]])
        per = count / (2.0 * math.pi * self.n)
        error, share = near[[0, 1, 4, 5]], near[[2, 3, 6, 7]]
        return {
            "error": float(basis @ error),
            "error_slope": float(slope @ error) * per,
            "share": float(basis @ share),
            "share_slope": float(slope @ share) * per,
        }

    def _spring(self, closing: float) -> dict[str, float]:
        gap, power = self.p["half_backlash"], self.p["stiffening"]
        beyond = math.copysign(max(abs(closing) - gap, 0.0), closing)
        k, reference = self.p["stiffness"], self.p["error_torque"]
        torque = math.copysign(reference * (k * abs(beyond) / reference) ** power, beyond)
        secant = torque / beyond if beyond else (k if power == 1.0 and abs(closing) > gap else 0.0)
        return {
            "deflection": beyond,
            "elastic": torque,
            "energy": torque * beyond / (power + 1.0),
            "tangent": power * secant,
        }

    def _wall(self, out: float) -> dict[str, float]:
        depth = self.p["wall_side"] * (out - self.p["wall_angle"])
        push = self.p["wall_stiffness"] * max(depth, 0.0) ** self.p["wall_exponent"]
        energy = push * max(depth, 0.0) / (self.p["wall_exponent"] + 1.0)
        return {"depth": depth, "push": push, "wall_energy": energy}

    def stored(self) -> float:
        """Energy in the machine, J."""
        p, s = self.p, self.s
        found = 0.5 * p["inductance"] * self.current**2 + 0.5 * p["motor_inertia"] * s["speed"] ** 2
        found += 0.5 * (p["output_inertia"] + p["load_inertia"]) * s["out_speed"] ** 2
        found += s["share"] * s["energy"] + s["wall_energy"]
        found += -p["gravity_moment"] * math.cos(s["out"])
        found += 0.5 * p["sensor_stiffness"] * s["out"] ** 2 + self.bristle_energy()
        if p["cogging_amplitude"] > 0.0:
            ripple = math.cos(p["cogging_order"] * s["angle"])
            found -= p["cogging_amplitude"] / p["cogging_order"] * ripple
        return found

    def bristle_energy(self) -> float:
        """Energy in the bristles of LuGre friction, J."""
        stiff = np.array([self.p["motor_bristle"], self.p["output_bristle"]])
        return float(0.5 * stiff @ self.bristles**2)

    def evaluate(self, x: float, y: float, given: dict[str, float]) -> _Step:
        """Balances of motor and output without dry friction at mean speeds x and y."""
        p, s, h = self.p, self.s, self.h
        turn = h * x
        end = self._look_up(s["angle"] + turn)
        change = turn / p["ratio"] + (end["error"] - s["error"]) - h * y
        end |= self._spring(s["closing"] + change) | self._wall(s["out"] + h * y)
        if abs(change) > 1e-9:
            mean = (end["energy"] - s["energy"]) / change
            slope = (end["elastic"] - mean) / change
        else:
            mean, slope = 0.5 * (s["elastic"] + end["elastic"]), 0.5 * end["tangent"]
        arm = 1.0 / p["ratio"] + s["error_slope"]
        bend = s["share_slope"]
        if abs(turn) > 1e-10:
            arm = 1.0 / p["ratio"] + (end["error"] - s["error"]) / turn
            bend = (end["share"] - s["share"]) / turn
        share = 0.5 * (s["share"] + end["share"])
        gear = share * mean + p["gear_damping"] * (end["deflection"] - s["deflection"]) / h
        gear_slope = share * slope + (p["gear_damping"] / h if end["deflection"] else 0.0)
        clipped = p["half_backlash"] > 0.0 and gear * mean <= 0.0
        if clipped:
            gear = gear_slope = 0.0
        half = 0.5 * p["cogging_order"] * turn
        cog = p["cogging_amplitude"] * math.sin(p["cogging_order"] * s["angle"] + half)
        cog *= float(np.sinc(half / math.pi))
        pull = p["gravity_moment"] * math.sin(s["out"] + 0.5 * h * y)
        pull *= float(np.sinc(0.5 * h * y / math.pi))
        deeper = p["wall_side"] * h * y
        push, push_slope = 0.5 * (s["push"] + end["push"]), 0.0
        if abs(deeper) > 1e-9:
            push = (end["wall_energy"] - s["wall_energy"]) / deeper
            push_slope = h * (end["push"] - push) / deeper
        rub = p["wall_damping"] * p["wall_side"] * y
        wall_rub = push * max(rub, -1.0)
        slope_kept = rub >= -1.0
        push_slope = push_slope * (1.0 + rub) + push * p["wall_damping"] if slope_kept else 0.0
        masses = 2.0 / h * np.array([p["motor_inertia"], p["output_inertia"] + p["load_inertia"]])
        left = given["drive"] - given["drive_slope"] * x - masses[0] * (x - s["speed"])
        left += -given["b_motor"] * x - given["add_motor"] - cog - arm * gear
        left -= 0.5 * (s["energy"] + end["energy"]) * bend
        right = gear + given["external"] - masses[1] * (y - s["out_speed"])
        right += -given["b_output"] * y - given["add_output"] - pull
        right -= p["sensor_stiffness"] * (s["out"] + 0.5 * h * y) + p["sensor_damping"] * y
        right -= p["wall_side"] * (push + wall_rub)
        tie = arm * h * gear_slope
        matrix = np.array([[masses[0] + arm * tie, -tie], [-tie, masses[1] + h * gear_slope]])
        matrix[0, 0] += given["drive_slope"] + given["b_motor"]
        matrix[1, 1] += given["b_output"] + p["sensor_damping"] + push_slope
        matrix[1, 1] += 0.5 * h * p["sensor_stiffness"]
        return _Step(left, right, matrix, gear, gear_slope, arm, clipped, wall_rub, end)

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


def _drive(
    m: _Machine, given: dict[str, float], asked: float, mode: str, limit: float
) -> dict[str, float]:
    """Torque of the motor over its mean speed, and how the current is set."""
    p, h = m.p, m.h
    resistance = p["resistance"] * (
        1.0 + COPPER_COEFFICIENT * (float(m.heat[0]) - p["reference_temperature"])
    )
    constant = p["torque_constant"] * (
        1.0 - MAGNET_COEFFICIENT * (float(m.heat[1]) - p["reference_temperature"])
    )
    reluctance = 2.0 * p["inductance"] / h
    back = constant * given["guess"]
    electric = {"resistance": resistance, "constant": constant, "reluctance": reluctance}
    mean, voltage, regulated = 0.0, 0.0, False
    if mode == "voltage":
        voltage = float(np.clip(asked, -p["supply_voltage"], p["supply_voltage"]))
        mean = (reluctance * m.current + voltage - back) / (reluctance + resistance)
        if abs(mean) > limit:
            bounded, regulated = math.copysign(limit, mean), True
            ending = m.current + (bounded - m.current) * (1.0 - p["current_decay"])
            mean = 0.5 * (m.current + ending) if p["inductance"] else bounded
    elif mode != "open":
        asked = float(np.clip(asked, -limit, limit))
        ending = asked + (m.current - asked) * p["current_decay"]
        mean = 0.5 * (m.current + ending)
        voltage = p["inductance"] * (ending - m.current) / h + resistance * mean + back
        regulated = abs(voltage) <= p["supply_voltage"]
        if not regulated:
            voltage = math.copysign(p["supply_voltage"], voltage)
    whole = reluctance + resistance
    drive, slope = constant * mean, 0.0
    if mode != "open" and not regulated:
        drive = constant * (reluctance * m.current + voltage) / whole
        slope = constant**2 / whole
    electric |= {"mean": mean, "voltage": voltage, "regulated": float(regulated)}
    return electric | {"drive": drive, "drive_slope": slope}


def run_one(
    row: FloatArray,
    table: FloatArray,
    signals: tuple[FloatArray, ...],
    step: float,
    steps: int,
    every: int,
    traces: FloatArray,
    ledger: FloatArray,
) -> None:
    """Step one actuator; arguments as for the kernel's."""
    m = _Machine(row, table, step)
    p, h, n = m.p, step, m.n
    mode, lugre, driven = MODES[int(p["mode"])], bool(p["lugre"]), bool(p["driven"])
    if driven:
        m.s["out_speed"] = float(signals[4][0])
    line: list[float] = [0.0] * int(p["delay_steps"])
    command = integral = count = 0.0
    elapsed, first = 1.0, True
    tally = dict.fromkeys(LEDGER, 0.0)
    tally["stored_before"] = m.stored()
    own_viscous = p["motor_viscous"]

    def at(which: int, k: int) -> float:
        return float(signals[which][k if len(signals[which]) > 1 else 0])

    for k in range(steps):
        command = at(0, k) if mode not in ("impedance", "position") else command
        if mode in ("impedance", "position"):
            elapsed += h / p["control_step"]
            if elapsed >= 1.0 - 1e-9 or first:
                seen, rate = m.s["angle"], m.s["speed"] / p["ratio"]
                if p["encoder_count"]:
                    mark = 2.0 * math.pi / p["encoder_count"]
                    seen = math.floor(seen / mark + 0.5) * mark
                former, count = count, seen / p["ratio"]
                if p["encoder_count"]:
                    rate = 0.0 if first else (count - former) / p["control_step"]
                behind = at(0, k) - count
                command = p["position_gain"] * behind + at(2, k)
                if mode == "impedance":
                    command += p["velocity_gain"] * (at(1, k) - rate)
                else:
                    most = p["current_limit"] * p["torque_constant"] * n
                    integral += p["integral_gain"] * behind * p["control_step"]
                    integral = float(np.clip(integral, -most, most))
                    command += integral - p["velocity_gain"] * rate
                elapsed = 0.0 if first else elapsed - 1.0
                first = False
        asked = command
        if mode not in ("open", "voltage", "current"):
            asked = command / (p["ratio"] * p["torque_constant"])
        line.append(asked)
        asked = line.pop(0)
        over = np.clip((m.heat[0] - p["derating_begins"]) / p["derating_span"], 0.0, 1.0)
        held_current = min(p["held_current"], p["current_limit"])
        limit = float(p["current_limit"] + over * (held_current - p["current_limit"]))
        ahead = 2.0 * m.slowing - m.former
        given = {
            "guess": m.s["speed"] + 0.5 * h * float(ahead[0]),
            "b_motor": own_viscous + p["iron_viscous"],
            "b_output": p["output_viscous"] + p["load_viscous"],
            "add_motor": 0.0,
            "add_output": 0.0,
            "external": at(3, k),
        }
        out_guess = m.s["out_speed"] + 0.5 * h * float(ahead[1])
        electric = _drive(m, given, asked, mode, limit)
        given |= {name: electric[name] for name in ("drive", "drive_slope")}
        levels = _levels(m, given["guess"], out_guess)
        relax = [0.0, 0.0]
        if lugre:
            damping = (p["motor_bristle_damping"], 0.0)
            for body, name in enumerate(("motor", "output")):
                sigma = p[f"{name}_bristle"]
                if not sigma:
                    continue
                fast = abs((given["guess"], out_guess)[body])
                level = max(levels[body], 1e-12)
                relax[body] = h * sigma * fast / level
                damper = min(damping[body], 4.0 * level / fast) if fast else damping[body]
                z = float(m.bristles[body])
                given[f"b_{name}"] += (sigma * h + damper) / (1.0 + relax[body])
                given[f"add_{name}"] = (sigma - damper * relax[body] / h) * z / (1.0 + relax[body])
        dry_levels = [0.0, 0.0] if lugre else levels
        x, y, found, dry = _with_friction(m, given, out_guess, dry_levels, at(4, k + 1), driven)
        _finish(m, given, electric, x, y, found, dry, relax, levels, tally, at(4, k + 1))
        if (k + 1) % every == 0:
            place = (k + 1) // every - 1
            m.traced["commanded_torque"] = command
            traces[:, place] = [m.traced[name] for name in TRACES]
    tally["stored_after"] = m.stored()
    tally["motor_friction"] -= 0.5 * p["motor_bristle"] * m.bristles[0] ** 2
    tally["output_friction"] -= 0.5 * p["output_bristle"] * m.bristles[1] ** 2
    ledger[:] = [tally[name] for name in LEDGER]


def _levels(m: _Machine, guess: float, out_guess: float) -> list[float]:
    """Dry friction to be had at motor and output, N m."""
    p, s, n = m.p, m.s, m.n
    toward = s["speed"] if s["speed"] != 0.0 else m.way
    forward = toward * m.transmitted * p["ratio"] > 0.0
    load = p["load_forward"] if forward else p["load_backward"]
    rises = []
    for fast in (guess / p["stribeck_speed"], out_guess * n / p["stribeck_speed"]):
        rises.append(1.0 + (p["stribeck_extra"] * math.exp(-(fast**2)) if abs(fast) < 6 else 0.0))
    level = (p["motor_coulomb"] + load * abs(m.transmitted) / n) * rises[0] + p["hysteresis"]
    return [level, p["output_coulomb"] * rises[1]]


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
    for body in (0, 1):
        if m.modes[body] == _FREE or (m.modes[body] == _STICK and speeds[body] != 0.0):
            m.modes[body] = 1 if speeds[body] > 0.0 else -1
    rubs = [levels[0] > 0.0, levels[1] > 0.0 and not driven]
    x, y = given["guess"], 0.5 * (speeds[1] + next_speed) if driven else out_guess
    switches = 0
    while True:
        held = [rubs[body] and m.modes[body] == _STICK for body in (0, 1)]
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
            mode, former = m.modes[body], speeds[body]
            if mode == _STICK:
                dry[body] = needed[body]
                if abs(needed[body]) > levels[body]:
                    m.modes[body] = 1 if needed[body] > 0.0 else -1
                elif needed[body] * former < 0.0:
                    m.modes[body] = _FREE
            elif mode != _FREE:
                if mode * former < 0.0:
                    m.modes[body] = _FREE if mode * mean < 0.0 else mode
                elif mode * (2.0 * mean - former) < 0.0:
                    m.modes[body] = _STICK
            switched = switched or m.modes[body] != mode
        if not switched:
            for body in (0, 1):
                if held[body]:
                    dry[body] = needed[body]
            return x, y, found, dry
        switches += 1
        if switches == _SWITCHES:
            m.modes = [_FREE if rubs[body] else m.modes[body] for body in (0, 1)]


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
    lugre, driven = bool(p["lugre"]), bool(p["driven"])
    end, clipped = found.end, found.clipped
    change = h * x / p["ratio"] + (end["error"] - s["error"]) - h * y
    if clipped:
        mean_share = 0.5 * (s["share"] + end["share"])
        tally["gear_damping"] -= mean_share * (end["energy"] - s["energy"])
    else:
        beyond = end["deflection"] - s["deflection"]
        tally["gear_damping"] += p["gear_damping"] * beyond * change / h
    viscous = p["motor_viscous"] + p["iron_viscous"]
    if lugre:
        m.bristles = (m.bristles + h * np.array([x, y])) / (1.0 + np.array(relax))
        m.bristles *= np.array([p["motor_bristle"] > 0.0, p["output_bristle"] > 0.0])
        dry = [
            (given["b_motor"] - viscous) * x + given["add_motor"],
            (given["b_output"] - p["output_viscous"] - p["load_viscous"]) * y + given["add_output"],
        ]
    new_speed, new_out = 2.0 * x - s["speed"], 2.0 * y - s["out_speed"]
    if not lugre and levels[0] > 0.0 and m.modes[0] == _STICK:
        new_speed = 0.0
    if driven:
        new_out = next_speed
    elif not lugre and levels[1] > 0.0 and m.modes[1] == _STICK:
        new_out = 0.0
    mean, voltage = electric["mean"], electric["voltage"]
    if p["mode"]:
        whole = electric["reluctance"] + electric["resistance"]
        if not electric["regulated"]:
            mean = electric["reluctance"] * m.current + voltage - electric["constant"] * x
            mean /= whole
        new = 2.0 * mean - m.current
        if p["inductance"] == 0.0 and not (electric["regulated"] and p["mode"] >= 2):
            new = mean
        if electric["regulated"]:
            voltage = p["inductance"] * (new - m.current) / h + electric["resistance"] * mean
            voltage += electric["constant"] * x
        m.current = new
    copper = electric["resistance"] * mean**2
    iron_share = p["hysteresis"] / levels[0] if not lugre and levels[0] > 0.0 else 0.0
    iron = p["iron_viscous"] * x * x + iron_share * dry[0] * x
    rubbed = p["motor_viscous"] * x * x + (1.0 - iron_share) * dry[0] * x
    out_rubbed = p["output_viscous"] * y * y + dry[1] * y
    load = (p["sensor_damping"] + p["load_viscous"]) * y * y + found.wall_rub * p["wall_side"] * y
    # A driven output takes whatever is missing in its balance.
    external = given["external"]
    if driven:
        inertia = p["output_inertia"] + p["load_inertia"]
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
    heats = np.array([copper, iron + rubbed + out_rubbed + p["cooling"]])
    kept = np.array(
        [
            [p["winding_kept"], p["winding_from_housing"]],
            [p["housing_from_winding"], p["housing_kept"]],
        ]
    )
    heated = np.array(
        [
            [p["winding_heated"], p["winding_by_housing_heat"]],
            [p["housing_by_winding_heat"], p["housing_heated"]],
        ]
    )
    m.heat = kept @ m.heat + heated @ heats
    flange = found.gear - dry[1] - p["output_viscous"] * y
    flange -= p["output_inertia"] * (new_out - s["out_speed"]) / h
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
        "motor_friction": dry[0] + p["motor_viscous"] * x,
        "output_friction": dry[1] + p["output_viscous"] * y,
        "winding_temperature": float(m.heat[0]),
        "housing_temperature": float(m.heat[1]),
    }


def run_sets(
    rows: FloatArray,
    tables: FloatArray,
    reference: FloatArray,
    reference_rate: FloatArray,
    feedforward: FloatArray,
    external: FloatArray,
    driven_speed: FloatArray,
    step: float,
    steps: int,
    every: int,
    traces: FloatArray,
    ledgers: FloatArray,
) -> None:
    """Step S actuators one after the other; see the kernel."""
    signals: tuple[Any, ...] = (reference, reference_rate, feedforward, external, driven_speed)
    for i in range(len(rows)):
        own = tuple(signal[min(i, len(signal) - 1)] for signal in signals)
        run_one(rows[i], tables[i], own, step, steps, every, traces[i], ledgers[i])
