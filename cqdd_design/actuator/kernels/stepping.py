"""Compiled time stepping of one actuator, and of many.

Every step is an implicit midpoint step in which each spring gives the mean torque that its stored
energy over the step stands for (a discrete gradient), so that energy is kept to what the Newton
iteration leaves, whatever the step, through backlash, stops and varying stiffness. Coulomb friction
acts as the torque that would stop the body within the step, as far as there is friction: it takes
energy or none, never gives any. Equations in docs/actuator-model.md;
:mod:`..twin.stepping` is the same in numpy. The parts: :mod:`.drive`, :mod:`.friction`,
:mod:`.gear`, :mod:`.loads`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cqdd_design.actuator.kernels.drive import (
    Control,
    asked_of_winding,
    commanded,
    drive_of,
    driven_current,
    ended_current,
    warmed,
)
from cqdd_design.actuator.kernels.friction import (
    FREE,
    STICK,
    agreed,
    begun,
    bristled,
    friction_of,
    levels,
)
from cqdd_design.actuator.kernels.gear import (
    damped_in_mesh,
    gear_of,
    mesh_at,
    mesh_ended,
    meshed,
    passes_kink,
)
from cqdd_design.actuator.kernels.laws import FAST, at
from cqdd_design.actuator.kernels.loads import (
    cogging,
    gravity_pull,
    load_of,
    stored_energy,
    wall_at,
    wall_push,
)
from cqdd_design.files.kernel_cache import numba

SETTLED, MOTOR_SETTLED = 1e-8, 1e-7
"""Newton steps, rad at the output and at the motor, after which the next would change nothing,
as they converge by squares: not so where contact begins or lets go within the step."""
SETTLED_AT_KINK = 1e-13
"""The same there, rad at the output."""
MOST_ITERATIONS, MOST_SWITCHES = 40, 6


@numba.njit(cache=True, error_model="numpy", fastmath=FAST)
def run_one(
    p: Any,
    table: Any,
    reference: Any,
    reference_rate: Any,
    feedforward: Any,
    external: Any,
    driven_speed: Any,
    step: float,
    steps: int,
    every: int,
    traces: Any,
    ledger: Any,
) -> None:
    """Step one actuator.

    Parameters
    ----------
    p : array
        In the order of `columns.PARAMETERS`.
    table : array (M, 4)
        See `kernel_laws.look_up`.
    reference, reference_rate, feedforward, external : array (N,) or (1,)
        At the middle of every step, or constant.
    driven_speed : array (N + 1,) or (1,)
        Speed of a driven output at the ends of the steps.
    step, steps, every
        s; number; steps a record.
    traces : array (T, records)
        In the order of `columns.TRACES`.
    ledger : array
        In the order of `columns.LEDGER`.
    """
    drive, dry, gear, load = drive_of(p), friction_of(p), gear_of(p, table), load_of(p)
    h, ratio, inductance = step, gear.ratio, drive.inductance
    iron_viscous, hysteresis, flange_inertia = p[7], p[8], p[32]
    motor_viscous, output_viscous = p[23] + iron_viscous, p[24]
    lugre, driven = p[59] != 0.0, p[60] != 0.0
    angle, speed, out_angle, out_speed = p[61], p[62], p[63], p[64]
    current, winding, housing = p[65], p[66], p[67]

    delay = int(p[57])
    line, place = np.zeros(delay + 1), 0
    control = Control(0.0, 0.0, 0.0, -1.0)
    z, output_z = 0.0, 0.0
    acceleration, output_acceleration, former, output_former = 0.0, 0.0, 0.0, 0.0
    transmitted, way = 0.0, 0.0
    mode_motor, mode_output = begun(STICK, speed), begun(STICK, out_speed)
    if driven:
        out_speed = driven_speed[0]
    mesh = mesh_at(gear, table, angle, out_angle)
    depth, push, wall_energy = wall_at(load, out_angle)
    electrical, copper, iron, rubbed, output_rubbed = 0.0, 0.0, 0.0, 0.0, 0.0
    damped, load_damped, external_work, throughput, unsettled = 0.0, 0.0, 0.0, 0.0, 0.0
    ledger[9] = stored_energy(
        load,
        angle,
        speed,
        out_angle,
        out_speed,
        0.5 * inductance * current * current,
        mesh.share * mesh.energy,
        wall_energy,
        0.0,
    )

    for k in range(steps):
        # --- torque of the motor -------------------------------------------------------------
        control = commanded(
            drive, control, h, angle, speed, reference, reference_rate, feedforward, k
        )
        line[place] = asked_of_winding(drive, control.command)
        place = place + 1 if place < delay else 0
        guess = speed + 0.5 * h * (2.0 * acceleration - former)
        out_guess = out_speed + 0.5 * h * (2.0 * output_acceleration - output_former)
        electric = driven_current(drive, h, line[place], current, winding, housing, guess)
        # --- friction to be had --------------------------------------------------------------
        toward = way if speed == 0.0 else speed
        motor_level, output_level = levels(dry, ratio, toward, transmitted, guess, out_guess)
        b_motor, b_output = motor_viscous, output_viscous + load.viscous
        add_motor, add_output, relax, output_relax = 0.0, 0.0, 0.0, 0.0
        if lugre:
            b_motor, add_motor, relax = bristled(
                dry.motor_bristle, dry.motor_bristle_damping, motor_level, h, guess, z, b_motor
            )
            b_output, add_output, output_relax = bristled(
                dry.output_bristle, 0.0, output_level, h, out_guess, output_z, b_output
            )
            motor_level = output_level = 0.0
        else:
            mode_motor, mode_output = begun(mode_motor, speed), begun(mode_output, out_speed)
        rubs_motor, rubs_output = motor_level != 0.0, output_level != 0.0 and not driven
        # --- Newton iteration on the mean speeds x and y -------------------------------------
        torque_out = at(external, k)
        x, y, next_speed = guess, out_guess, 0.0
        if driven:
            next_speed = at(driven_speed, k + 1)
            y = 0.5 * (out_speed + next_speed)
        switches, settled, cut, end = 0, False, False, mesh
        d_motor, d_output = 2.0 * load.motor_inertia / h, 2.0 * load.inertia / h
        friction, output_friction, torque, change, turn = 0.0, 0.0, 0.0, 0.0, 0.0
        wall_rub, pushed, pull = 0.0, 0.0, 0.0
        for iteration in range(MOST_ITERATIONS):
            if rubs_motor and mode_motor == STICK:
                x = 0.5 * speed
            if rubs_output and mode_output == STICK:
                y = 0.5 * out_speed
            turn = h * x
            contact, end = meshed(gear, table, mesh, angle, turn, h * y, h)
            torque, torque_slope, arm = contact.torque, contact.slope, contact.arm
            cut, change = contact.cut, contact.change
            cog = cogging(load, angle, turn)
            pull = gravity_pull(load, out_angle, h, y)
            push_mean, push_slope, wall_rub = wall_push(load, depth, push, wall_energy, h, y)
            pushed = load.wall_side * (push_mean + wall_rub)
            # Balance without dry friction.
            left = (
                electric.torque
                - electric.slope * x
                - d_motor * (x - speed)
                - b_motor * x
                - add_motor
                - cog
                - arm * torque
                - contact.varying
            )
            right = (
                torque
                + torque_out
                - d_output * (y - out_speed)
                - b_output * y
                - add_output
                - load.sensor_stiffness * (out_angle + 0.5 * h * y)
                - load.sensor_damping * y
                - pull
                - pushed
            )
            friction, output_friction = 0.0, 0.0
            if rubs_motor:
                if mode_motor == STICK:
                    friction = left
                elif mode_motor != FREE:
                    friction = mode_motor * motor_level
            if rubs_output:
                if mode_output == STICK:
                    output_friction = right
                elif mode_output != FREE:
                    output_friction = mode_output * output_level
            elif driven and output_level > 0.0:
                output_friction = output_level * (1.0 if y > 0.0 else (-1.0 if y < 0.0 else 0.0))
            coupling = arm * h * torque_slope
            a11 = d_motor + electric.slope + b_motor + arm * coupling
            a22 = d_output + b_output + load.sensor_damping + push_slope
            a22 += h * (0.5 * load.sensor_stiffness + torque_slope)
            dx = dy = 0.0
            held_motor = rubs_motor and mode_motor == STICK
            held_output = driven or (rubs_output and mode_output == STICK)
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
            if near and (
                abs(closed) < SETTLED_AT_KINK or not passes_kink(gear, contact, end, closed)
            ):
                # Do the frictions agree with the motion they allow? What a held body needs moves
                # with the other one's last correction.
                former_motor, former_output = mode_motor, mode_output
                if rubs_motor and switches < MOST_SWITCHES:
                    if mode_motor == STICK:
                        friction = left + arm * torque_slope * h * dy
                    mode_motor = agreed(mode_motor, friction, motor_level, speed, x)
                if rubs_output and switches < MOST_SWITCHES:
                    if mode_output == STICK:
                        output_friction = right + torque_slope * h * arm * dx
                    mode_output = agreed(mode_output, output_friction, output_level, out_speed, y)
                if mode_motor == former_motor and mode_output == former_output:
                    settled = True
                    break
                switches += 1
                if switches == MOST_SWITCHES:
                    if rubs_motor:
                        mode_motor = FREE
                    if output_level != 0.0:
                        mode_output = FREE
        if not settled:
            unsettled += 1.0
        # --- new state -----------------------------------------------------------------------
        # From the last evaluation to the end is less than SETTLED.
        turned = h * x - turn
        turn = h * x
        new_angle, new_out_angle = angle + turn, out_angle + h * y
        end, change = mesh_ended(
            gear, table, mesh, end, new_angle, turn, turned, change, h * y, settled
        )
        damped = damped_in_mesh(gear, mesh, end, change, cut, h, damped)
        new_speed = 2.0 * x - speed
        if rubs_motor and mode_motor == STICK:
            new_speed = 0.0
        new_out_speed = 2.0 * y - out_speed
        if driven:
            new_out_speed = next_speed
        elif rubs_output and mode_output == STICK:
            new_out_speed = 0.0
        dry_at_output = output_friction
        if lugre:
            if dry.motor_bristle > 0.0:
                z = (z + h * x) / (1.0 + relax)
                friction = (b_motor - motor_viscous) * x + add_motor
            if dry.output_bristle > 0.0:
                output_z = (output_z + h * y) / (1.0 + output_relax)
                output_friction = (b_output - output_viscous - load.viscous) * y + add_output
            dry_at_output = 0.0
        # --- current, ledger, heat -----------------------------------------------------------
        current, mean_current, voltage = ended_current(drive, electric, h, current, x)
        power_in = voltage * mean_current
        power_copper = electric.resistance * mean_current * mean_current
        rubbed_dry = friction * x * h
        share_iron = 0.0
        if not lugre and motor_level > 0.0:
            share_iron = hysteresis / motor_level
        iron_now = iron_viscous * x * x * h + share_iron * rubbed_dry
        rub_now = (motor_viscous - iron_viscous) * x * x * h + (1.0 - share_iron) * rubbed_dry
        out_rub = output_viscous * y * y * h + output_friction * y * h
        electrical += power_in * h
        copper += power_copper * h
        iron += iron_now
        rubbed += rub_now
        output_rubbed += out_rub
        wall_now = wall_rub * load.wall_side * y * h
        load_damped += (load.sensor_damping + load.viscous) * y * y * h + wall_now
        if driven:
            torque_out = (
                load.inertia * (new_out_speed - out_speed) / h
                + b_output * y
                + add_output
                + dry_at_output
                + load.sensor_stiffness * (out_angle + 0.5 * h * y)
                + load.sensor_damping * y
                + pull
                + pushed
                - torque
            )
        external_work += torque_out * y * h
        throughput += (abs(power_in) + abs(torque_out * y)) * h
        winding, housing = warmed(
            p, winding, housing, power_copper, (iron_now + rub_now + out_rub) / h
        )

        given = torque - output_friction - output_viscous * y
        given -= flange_inertia * (new_out_speed - out_speed) / h
        former, output_former = acceleration, output_acceleration
        acceleration = (new_speed - speed) / h
        output_acceleration = (new_out_speed - out_speed) / h
        way = friction if friction != 0.0 else way
        transmitted = torque
        angle, speed, out_angle, out_speed = new_angle, new_speed, new_out_angle, new_out_speed
        mesh = end
        if load.wall_stiffness > 0.0:
            depth, push, wall_energy = wall_at(load, out_angle)
        if (k + 1) % every == 0:
            record = (k + 1) // every - 1
            traces[0, record] = angle
            traces[1, record] = speed
            traces[2, record] = out_angle
            traces[3, record] = out_speed
            traces[4, record] = current
            traces[5, record] = voltage
            traces[6, record] = mesh.closing
            traces[7, record] = torque
            traces[8, record] = given
            traces[9, record] = friction + (motor_viscous - iron_viscous) * x
            traces[10, record] = output_friction + output_viscous * y
            traces[11, record] = control.command
            traces[12, record] = winding
            traces[13, record] = housing
    bristle = 0.5 * dry.motor_bristle * z * z
    output_bristle = 0.5 * dry.output_bristle * output_z * output_z
    ledger[0] = electrical
    ledger[1] = copper
    ledger[2] = iron
    ledger[3] = rubbed - bristle
    ledger[4] = output_rubbed - output_bristle
    ledger[5] = damped
    ledger[6] = load_damped
    ledger[7] = external_work
    ledger[8] = throughput
    ledger[10] = stored_energy(
        load,
        angle,
        speed,
        out_angle,
        out_speed,
        0.5 * inductance * current * current,
        mesh.share * mesh.energy,
        wall_energy,
        bristle + output_bristle,
    )
    ledger[11] = unsettled


@numba.njit(cache=True, error_model="numpy", nogil=True)
def run_sets(
    rows: Any,
    tables: Any,
    reference: Any,
    reference_rate: Any,
    feedforward: Any,
    external: Any,
    driven_speed: Any,
    step: float,
    steps: int,
    every: int,
    traces: Any,
    ledgers: Any,
    first: int,
    last: int,
) -> None:
    """Step the actuators from `first` to before `last`, each alone.

    Every signal has one row for all actuators or one for each; see :func:`run_one`. Threads that
    take ranges of their own meet nowhere, so that numbers do not depend on how many there are.
    """
    for i in range(first, last):
        run_one(
            rows[i],
            tables[i],
            reference[min(i, reference.shape[0] - 1)],
            reference_rate[min(i, reference_rate.shape[0] - 1)],
            feedforward[min(i, feedforward.shape[0] - 1)],
            external[min(i, external.shape[0] - 1)],
            driven_speed[min(i, driven_speed.shape[0] - 1)],
            step,
            steps,
            every,
            traces[i],
            ledgers[i],
        )
