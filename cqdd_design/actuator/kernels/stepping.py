"""Compiled time stepping of one actuator, and of many.

Every step is an implicit midpoint step in which each spring gives the mean torque that its stored
energy over the step stands for (a discrete gradient), so that energy is kept to what the Newton
iteration leaves, whatever the step, through backlash, stops and varying stiffness. Coulomb friction
acts as the torque that would stop the body within the step, as far as there is friction: it takes
energy or none, never gives any. Equations in docs/actuator-model.md;
`tests/oracles/actuator_twin` is the same in numpy. The parts: :mod:`.drive`, :mod:`.friction`,
:mod:`.gear`, :mod:`.loads`, :mod:`.accounts`; what goes between them by name: :mod:`..columns`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba.np.unsafe.ndarray import to_fixed_tuple

from cqdd_design.actuator.columns import Constants, Ledger, Signals
from cqdd_design.actuator.kernels.accounts import Outcome, closed, heated, recorded, tallied
from cqdd_design.actuator.kernels.drive import (
    Control,
    Wanted,
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
from cqdd_design.actuator.kernels.laws import at, part
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

    T closes by h (arm x - y). The motor's own drag is part of b_m and of its friction. Dry friction
    is given while a body slips and what is missing while it sticks; once the speeds settle it is
    asked whether it agrees with the motion it allowed.
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
        cog, cog_slope = cogging(p, motion.angle, turn)
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
        a11 = d_motor + electric.slope + rub.viscous + h * cog_slope + arm * coupling
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


class State(NamedTuple):
    """What one step leaves to the next.

    `warmth` holds the temperatures of winding and housing, `rises` the accelerations of motor and
    output in the step and `former` those in the one before it; `torque` is the mesh's, and `way`
    the motor's last dry friction.
    """

    motion: Any
    mesh: Any
    wall: Any
    current: float
    warmth: Any
    bristles: Any
    mode: int
    output_mode: int
    rises: Any
    former: Any
    torque: float
    way: float


@part
def at_start(p: Any, table: Any, driven_speed: Any) -> Any:
    """State at the beginning of a run."""
    motion = Motion(p.motor_angle, p.motor_speed, p.output_angle, p.output_speed)
    mode, output_mode = begun(STICK, motion.speed), begun(STICK, motion.out_speed)
    if p.driven != 0.0:
        motion = Motion(motion.angle, motion.speed, motion.out_angle, driven_speed[0])
    mesh, wall = mesh_at(p, table, motion.angle, motion.out_angle), wall_at(p, motion.out_angle)
    none, warmth = (0.0, 0.0), (p.winding_temperature, p.housing_temperature)
    return State(
        motion, mesh, wall, p.current, warmth, none, mode, output_mode, none, none, 0.0, 0.0
    )


@part
def step_begun(
    p: Any, h: float, state: Any, asked: float, external: float, next_speed: float
) -> Any:
    """What a step begins with; mean speeds are guessed from the last two accelerations."""
    motion = state.motion
    guess = motion.speed + 0.5 * h * (2.0 * state.rises[0] - state.former[0])
    out_guess = motion.out_speed + 0.5 * h * (2.0 * state.rises[1] - state.former[1])
    winding, housing = state.warmth
    electric = driven_current(p, h, asked, state.current, winding, housing, guess)
    toward = state.way if motion.speed == 0.0 else motion.speed
    rub = rubbing(p, state.bristles, h, toward, state.torque, guess, out_guess)
    mode, output_mode = state.mode, state.output_mode
    if p.lugre == 0.0:
        mode, output_mode = begun(mode, motion.speed), begun(output_mode, motion.out_speed)
    return Begin(
        motion, state.mesh, state.wall, electric, rub, mode, output_mode, external, guess,
        out_guess, next_speed,
    )  # fmt: skip


@part
def run_one(
    row: Any, table: Any, signals: Any, steps: Any, traces: Any, ledger: Any, i: int
) -> None:
    """Step one actuator: a row of `columns.Constants`, its table (M, 4), signals of one row each.

    Row `i` of every array of `traces` and `ledger` is filled; see `laws.look_up` for the table.
    """
    p, h = Constants(*_tuple_of(row, COUNT)), steps.length
    # Taken apart here: in the loop every reach into a tuple of arrays would count its references.
    reference, reference_rate, feedforward, external_torque, driven_speed = signals
    delay = int(p.delay_steps)
    line, slot = np.zeros(delay + 1), 0
    control, state = Control(0.0, 0.0, 0.0, -1.0), at_start(p, table, driven_speed)
    stored = stored_energy(p, state.motion, state.current, state.mesh, state.wall.energy, 0.0)
    sums = Ledger(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, stored, 0.0, 0.0)
    for k in range(steps.number):
        wanted = Wanted(at(reference, k), at(reference_rate, k), at(feedforward, k))
        control = commanded(p, control, wanted, h, state.motion.angle, state.motion.speed)
        line[slot] = asked_of_winding(p, control.command)
        slot = slot + 1 if slot < delay else 0
        next_speed = at(driven_speed, k + 1) if p.driven != 0.0 else 0.0
        begin = step_begun(p, h, state, line[slot], at(external_torque, k), next_speed)
        found = solved(p, table, h, begin)
        motion = moved(p, h, begin, found)
        turn, out_turn = h * found.x, h * found.y
        mesh, change = mesh_ended(p, table, begin.mesh, found.last, motion.angle, turn, out_turn)
        friction, output_friction, bristles = rubbed(p, h, begin, found, state.bristles)
        external = driven_torque(p, h, begin, found) if p.driven != 0.0 else begin.external
        current, mean_current, voltage = ended_current(p, begin.electric, h, state.current, found.x)
        out = Outcome(friction, output_friction, external, mean_current, voltage)
        heat = heated(p, h, begin, found, out)
        damped = damped_in_mesh(p, begin.mesh, mesh, change, found.cut, h, sums.gear_damping)
        sums = tallied(p, h, sums, begin, found, out, heat, damped)
        rubbing_heat = (heat.iron + heat.rubbed + heat.output_rubbed) / h
        gained = motion.speed - begin.motion.speed, motion.out_speed - begin.motion.out_speed
        state = State(
            motion,
            mesh,
            wall_at(p, motion.out_angle) if p.wall_stiffness > 0.0 else state.wall,
            current,
            warmed(p, state.warmth, heat.copper, rubbing_heat),
            bristles,
            found.mode,
            found.output_mode,
            (gained[0] / h, gained[1] / h),
            state.rises,
            found.torque,
            friction if friction != 0.0 else state.way,
        )
        if (k + 1) % steps.every == 0:
            record = (k + 1) // steps.every - 1
            traces.commanded_torque[i, record] = control.command
            recorded(p, h, state, begin, found, out, traces, i, record)
    closed(p, state, sums, ledger, i)


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
