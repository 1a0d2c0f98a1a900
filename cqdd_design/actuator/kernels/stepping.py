"""Compiled time stepping of one actuator, and of many.

Every step is an implicit midpoint step in which each spring gives the mean torque that its stored
energy over the step stands for (a discrete gradient), so that energy is kept to what the Newton
iteration leaves, whatever the step, through backlash, stops and varying stiffness. Coulomb friction
acts as the torque that would stop the body within the step, as far as there is friction: it takes
energy or none, never gives any. Equations in docs/actuator-model.md;
:mod:`..twin.stepping` is the same in numpy. The parts: :mod:`.drive`, :mod:`.friction`,
:mod:`.gear`, :mod:`.loads`; what goes from one to the other by name: :mod:`..columns`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba.np.unsafe.ndarray import to_fixed_tuple

from cqdd_design.actuator.columns import Constants, Ledger, Signals
from cqdd_design.actuator.kernels.drive import (
    Control,
    asked_of_winding,
    commanded,
    driven_current,
    ended_current,
    warmed,
)
from cqdd_design.actuator.kernels.friction import FREE, STICK, agreed, begun, rubbing
from cqdd_design.actuator.kernels.gear import (
    Last,
    damped_in_mesh,
    mesh_at,
    mesh_ended,
    meshed,
    passes_kink,
)
from cqdd_design.actuator.kernels.laws import FAST, at, part
from cqdd_design.actuator.kernels.loads import (
    Motion,
    cogging,
    gravity_pull,
    stored_energy,
    wall_at,
    wall_push,
)
from cqdd_design.files.kernel_cache import numba

COUNT = len(Constants._fields)
_tuple_of: Any = to_fixed_tuple
SETTLED, MOTOR_SETTLED = 1e-8, 1e-7
"""Newton steps, rad at the output and at the motor, after which the next would change nothing,
as they converge by squares: not so where contact begins or lets go within the step."""
SETTLED_AT_KINK = 1e-13
"""The same there, rad at the output."""
MOST_ITERATIONS, MOST_SWITCHES = 40, 6


class Begin(NamedTuple):
    """What a step begins with: motion, mesh and wall then, and what acts over it.

    `mode` and `output_mode` are stick, slip or free; `external` is the torque from outside,
    `next_speed` the speed at the end of a driven output.
    """

    motion: Any
    mesh: Any
    wall: Any
    electric: Any
    rub: Any
    mode: int
    output_mode: int
    external: float
    guess: float
    out_guess: float
    next_speed: float


class Solved(NamedTuple):
    """Mean speeds x and y of motor and output in a step, and the torques that go with them."""

    x: float
    y: float
    torque: float
    friction: float
    output_friction: float
    pull: float
    pushed: float
    wall_rub: float
    mode: int
    output_mode: int
    cut: bool
    last: Any


@part
def solved(p: Any, table: Any, h: float, begin: Any) -> Any:
    """Solve a step by Newton's method for its mean speeds.

    With T the mesh's mean torque, J the inertias and w, v the speeds the step begins with::

        0 = tau(x) - 2 J_m/h (x - w) - b_m x - cogging - arm T - varying - friction
        0 = T + external - 2 J_o/h (y - v) - b_o y - sensor - gravity - wall - friction

    T closes by h (arm x - y). Dry friction is given while a body slips and what is missing while it
    sticks; once the speeds settle it is asked whether it agrees with the motion it allowed.
    """
    motion, rub, electric = begin.motion, begin.rub, begin.electric
    speed, out_speed, driven = motion.speed, motion.out_speed, p.driven != 0.0
    mode, output_mode = begin.mode, begin.output_mode
    rubs_motor, rubs_output = rub.level != 0.0, rub.output_level != 0.0 and not driven
    x, y = begin.guess, begin.out_guess
    if driven:
        y = 0.5 * (out_speed + begin.next_speed)
    switches, settled, cut, end = 0, False, False, begin.mesh
    d_motor, d_output = 2.0 * p.motor_inertia / h, 2.0 * p.carried_inertia / h
    friction, output_friction, torque, change, turn = 0.0, 0.0, 0.0, 0.0, 0.0
    wall_rub, pushed, pull = 0.0, 0.0, 0.0
    for iteration in range(MOST_ITERATIONS):
        if rubs_motor and mode == STICK:
            x = 0.5 * speed
        if rubs_output and output_mode == STICK:
            y = 0.5 * out_speed
        turn = h * x
        contact, end = meshed(p, table, begin.mesh, motion.angle, turn, h * y, h)
        torque, torque_slope, arm = contact.torque, contact.slope, contact.arm
        cut, change = contact.cut, contact.change
        cog = cogging(p, motion.angle, turn)
        pull = gravity_pull(p, motion.out_angle, h, y)
        push_mean, push_slope, wall_rub = wall_push(p, begin.wall, h, y)
        pushed = p.wall_side * (push_mean + wall_rub)
        # Balance without dry friction.
        left = (
            electric.torque
            - electric.slope * x
            - d_motor * (x - speed)
            - rub.viscous * x
            - rub.held
            - cog
            - arm * torque
            - contact.varying
        )
        right = (
            torque
            + begin.external
            - d_output * (y - out_speed)
            - rub.output_viscous * y
            - rub.output_held
            - p.sensor_stiffness * (motion.out_angle + 0.5 * h * y)
            - p.sensor_damping * y
            - pull
            - pushed
        )
        friction, output_friction = 0.0, 0.0
        if rubs_motor:
            if mode == STICK:
                friction = left
            elif mode != FREE:
                friction = mode * rub.level
        if rubs_output:
            if output_mode == STICK:
                output_friction = right
            elif output_mode != FREE:
                output_friction = output_mode * rub.output_level
        elif driven and rub.output_level > 0.0:
            output_friction = rub.output_level * (1.0 if y > 0.0 else (-1.0 if y < 0.0 else 0.0))
        coupling = arm * h * torque_slope
        a11 = d_motor + electric.slope + rub.viscous + arm * coupling
        a22 = d_output + rub.output_viscous + p.sensor_damping + push_slope
        a22 += h * (0.5 * p.sensor_stiffness + torque_slope)
        dx = dy = 0.0
        held_motor = rubs_motor and mode == STICK
        held_output = driven or (rubs_output and output_mode == STICK)
        if not held_motor and not held_output:
            first_row, second_row = left - friction, right - output_friction
            scale = 1.0 / (a11 * a22 - coupling * coupling)
            dx = (a22 * first_row + coupling * second_row) * scale
            dy = (coupling * first_row + a11 * second_row) * scale
        elif not held_motor:
            dx = (left - friction) / a11
        elif not held_output:
            dy = (right - output_friction) / a22
        if iteration > 20:
            dx *= 0.5
            dy *= 0.5
        x += dx
        y += dy
        torque += torque_slope * h * (arm * dx - dy)
        closed = h * (arm * dx - dy)
        near = abs(closed) < SETTLED and h * abs(dx) < MOTOR_SETTLED
        if near and (abs(closed) < SETTLED_AT_KINK or not passes_kink(p, contact, end, closed)):
            # Do the frictions agree with the motion they allow? What a held body needs moves with
            # the other one's last correction.
            former, output_former = mode, output_mode
            if rubs_motor and switches < MOST_SWITCHES:
                if mode == STICK:
                    friction = left + arm * torque_slope * h * dy
                mode = agreed(mode, friction, rub.level, speed, x)
            if rubs_output and switches < MOST_SWITCHES:
                if output_mode == STICK:
                    output_friction = right + torque_slope * h * arm * dx
                output_mode = agreed(output_mode, output_friction, rub.output_level, out_speed, y)
            if mode == former and output_mode == output_former:
                settled = True
                break
            switches += 1
            if switches == MOST_SWITCHES:
                if rubs_motor:
                    mode = FREE
                if rub.output_level != 0.0:
                    output_mode = FREE
    last = Last(end, change, turn, settled)
    return Solved(
        x,
        y,
        torque,
        friction,
        output_friction,
        pull,
        pushed,
        wall_rub,
        mode,
        output_mode,
        cut,
        last,
    )


@part
def moved(p: Any, h: float, begin: Any, found: Any) -> Any:
    """Motion at the end of a step: what sticks stands still."""
    motion, rub, driven = begin.motion, begin.rub, p.driven != 0.0
    speed = 2.0 * found.x - motion.speed
    if rub.level != 0.0 and found.mode == STICK:
        speed = 0.0
    out_speed = 2.0 * found.y - motion.out_speed
    if driven:
        out_speed = begin.next_speed
    elif rub.output_level != 0.0 and found.output_mode == STICK:
        out_speed = 0.0
    return Motion(motion.angle + h * found.x, speed, motion.out_angle + h * found.y, out_speed)


@part
def rubbed(p: Any, h: float, begin: Any, found: Any, bristles: Any) -> Any:
    """Friction of motor and output in a step, N m, and the bristles at its end."""
    rub, friction, output_friction = begin.rub, found.friction, found.output_friction
    z, output_z = bristles
    if p.lugre != 0.0:
        if p.motor_bristle > 0.0:
            z = (z + h * found.x) / (1.0 + rub.relax)
            friction = (rub.viscous - (p.motor_viscous + p.iron_viscous)) * found.x + rub.held
        if p.output_bristle > 0.0:
            output_z = (output_z + h * found.y) / (1.0 + rub.output_relax)
            output_friction = (
                rub.output_viscous - p.output_viscous - p.load_viscous
            ) * found.y + rub.output_held
    return friction, output_friction, (z, output_z)


@part
def driven_torque(p: Any, h: float, begin: Any, found: Any) -> Any:
    """Torque that a driven output takes from outside: whatever is missing in its balance."""
    motion, rub, y = begin.motion, begin.rub, found.y
    return (
        p.carried_inertia * (begin.next_speed - motion.out_speed) / h
        + rub.output_viscous * y
        + rub.output_held
        + (0.0 if p.lugre != 0.0 else found.output_friction)
        + p.sensor_stiffness * (motion.out_angle + 0.5 * h * y)
        + p.sensor_damping * y
        + found.pull
        + found.pushed
        - found.torque
    )


@numba.njit(cache=True, error_model="numpy", fastmath=FAST)
def run_one(
    row: Any, table: Any, signals: Any, steps: Any, traces: Any, ledger: Any, place: int
) -> None:
    """Step one actuator.

    Parameters
    ----------
    row : array
        `columns.Constants`.
    table : array (M, 4)
        See `laws.look_up`.
    signals : Signals
        Of one row each.
    steps : Steps
    traces, ledger : Traces, Ledger
        Whose row `place` is filled.
    """
    p = Constants(*_tuple_of(row, COUNT))
    h, i = steps.length, place
    motion = Motion(p.motor_angle, p.motor_speed, p.output_angle, p.output_speed)
    mode, output_mode = begun(STICK, motion.speed), begun(STICK, motion.out_speed)
    if p.driven != 0.0:
        motion = Motion(motion.angle, motion.speed, motion.out_angle, signals.driven_speed[0])
    current, winding, housing = p.current, p.winding_temperature, p.housing_temperature
    delay = int(p.delay_steps)
    line, slot = np.zeros(delay + 1), 0
    control, bristles = Control(0.0, 0.0, 0.0, -1.0), (0.0, 0.0)
    # Accelerations of the last step and of the one before it.
    rise, output_rise, former, output_former = 0.0, 0.0, 0.0, 0.0
    transmitted, way = 0.0, 0.0
    mesh, wall = mesh_at(p, table, motion.angle, motion.out_angle), wall_at(p, motion.out_angle)
    before = stored_energy(p, motion, current, mesh, wall.energy, 0.0)
    sums = Ledger(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, before, 0.0, 0.0)

    for k in range(steps.number):
        control = commanded(p, control, signals, k, h, motion.angle, motion.speed)
        line[slot] = asked_of_winding(p, control.command)
        slot = slot + 1 if slot < delay else 0
        guess = motion.speed + 0.5 * h * (2.0 * rise - former)
        out_guess = motion.out_speed + 0.5 * h * (2.0 * output_rise - output_former)
        electric = driven_current(p, h, line[slot], current, winding, housing, guess)
        toward = way if motion.speed == 0.0 else motion.speed
        rub = rubbing(p, bristles, h, toward, transmitted, guess, out_guess)
        if p.lugre == 0.0:
            mode, output_mode = begun(mode, motion.speed), begun(output_mode, motion.out_speed)
        next_speed = at(signals.driven_speed, k + 1) if p.driven != 0.0 else 0.0
        external = at(signals.external, k)
        begin = Begin(
            motion, mesh, wall, electric, rub, mode, output_mode, external, guess, out_guess,
            next_speed,
        )  # fmt: skip
        found = solved(p, table, h, begin)
        mode, output_mode = found.mode, found.output_mode
        # --- new state -----------------------------------------------------------------------
        ended = moved(p, h, begin, found)
        turn, out_turn = h * found.x, h * found.y
        end, change = mesh_ended(p, table, mesh, found.last, ended.angle, turn, out_turn)
        friction, output_friction, bristles = rubbed(p, h, begin, found, bristles)
        if p.driven != 0.0:
            external = driven_torque(p, h, begin, found)
        current, mean_current, voltage = ended_current(p, electric, h, current, found.x)
        # --- ledger and heat -----------------------------------------------------------------
        x, y = found.x, found.y
        power_in, power_copper = (
            voltage * mean_current,
            electric.resistance * mean_current * mean_current,
        )
        rubbed_dry = friction * x * h
        share_iron = 0.0
        if rub.level > 0.0:
            share_iron = p.hysteresis / rub.level
        iron = p.iron_viscous * x * x * h + share_iron * rubbed_dry
        own_viscous = p.motor_viscous + p.iron_viscous - p.iron_viscous
        rub_now = own_viscous * x * x * h + (1.0 - share_iron) * rubbed_dry
        out_rub = p.output_viscous * y * y * h + output_friction * y * h
        on_load = (p.sensor_damping + p.load_viscous) * y * y * h
        sums = Ledger(
            sums.electrical + power_in * h,
            sums.copper + power_copper * h,
            sums.iron + iron,
            sums.motor_friction + rub_now,
            sums.output_friction + out_rub,
            damped_in_mesh(p, mesh, end, change, found.cut, h, sums.gear_damping),
            sums.load_damping + (on_load + found.wall_rub * p.wall_side * y * h),
            sums.external + external * y * h,
            sums.throughput + (abs(power_in) + abs(external * y)) * h,
            before,
            0.0,
            sums.unsettled + (0.0 if found.last.settled else 1.0),
        )
        winding, housing = warmed(p, winding, housing, power_copper, (iron + rub_now + out_rub) / h)
        former, output_former = rise, output_rise
        rise = (ended.speed - motion.speed) / h
        output_rise = (ended.out_speed - motion.out_speed) / h
        way = friction if friction != 0.0 else way
        transmitted = found.torque
        flange = found.torque - output_friction - p.output_viscous * y
        flange -= p.output_inertia * (ended.out_speed - motion.out_speed) / h
        motion, mesh = ended, end
        if p.wall_stiffness > 0.0:
            wall = wall_at(p, motion.out_angle)
        if (k + 1) % steps.every == 0:
            record = (k + 1) // steps.every - 1
            traces.motor_angle[i, record] = motion.angle
            traces.motor_speed[i, record] = motion.speed
            traces.output_angle[i, record] = motion.out_angle
            traces.output_speed[i, record] = motion.out_speed
            traces.current[i, record] = current
            traces.voltage[i, record] = voltage
            traces.deflection[i, record] = mesh.closing
            traces.gear_torque[i, record] = found.torque
            traces.output_torque[i, record] = flange
            traces.motor_friction[i, record] = friction + own_viscous * x
            traces.output_friction[i, record] = output_friction + p.output_viscous * y
            traces.commanded_torque[i, record] = control.command
            traces.winding_temperature[i, record] = winding
            traces.housing_temperature[i, record] = housing

    z, output_z = bristles
    kept = 0.5 * p.motor_bristle * z * z
    output_kept = 0.5 * p.output_bristle * output_z * output_z
    ledger.electrical[i] = sums.electrical
    ledger.copper[i] = sums.copper
    ledger.iron[i] = sums.iron
    ledger.motor_friction[i] = sums.motor_friction - kept
    ledger.output_friction[i] = sums.output_friction - output_kept
    ledger.gear_damping[i] = sums.gear_damping
    ledger.load_damping[i] = sums.load_damping
    ledger.external[i] = sums.external
    ledger.throughput[i] = sums.throughput
    ledger.stored_before[i] = before
    ledger.stored_after[i] = stored_energy(
        p, motion, current, mesh, wall.energy, kept + output_kept
    )
    ledger.unsettled[i] = sums.unsettled


@numba.njit(cache=True, error_model="numpy", nogil=True)
def run_sets(
    rows: Any,
    tables: Any,
    signals: Any,
    steps: Any,
    traces: Any,
    ledger: Any,
    first: int,
    last: int,
) -> None:
    """Step the actuators from `first` to before `last`, each alone.

    Every signal has one row for all actuators or one for each; see :func:`run_one`. Threads that
    take ranges of their own meet nowhere, so that numbers do not depend on how many there are.
    """
    for i in range(first, last):
        own = Signals(
            signals.reference[min(i, signals.reference.shape[0] - 1)],
            signals.reference_rate[min(i, signals.reference_rate.shape[0] - 1)],
            signals.feedforward[min(i, signals.feedforward.shape[0] - 1)],
            signals.external[min(i, signals.external.shape[0] - 1)],
            signals.driven_speed[min(i, signals.driven_speed.shape[0] - 1)],
        )
        run_one(rows[i], tables[i], own, steps, traces, ledger, i)
