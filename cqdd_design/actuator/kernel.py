"""Compiled time stepping of one actuator, and of many in parallel.

Every step is an implicit midpoint step in which each spring gives the mean torque that its stored
energy over the step stands for (a discrete gradient), so that energy is kept to what the Newton
iteration leaves, whatever the step, through backlash, stops and varying stiffness. Coulomb friction
acts as the torque that would stop the body within the step, as far as there is friction: it takes
energy or none, never gives any. Equations in docs/actuator-model.md; :mod:`.plain` is the same in
numpy.
"""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np

from cqdd_design.actuator.columns import LEDGER, PARAMETERS, TRACES
from cqdd_design.actuator.kernel_laws import FAST, look_up, spring
from cqdd_design.actuator.kernel_laws import wall as wall_law

COPPER, MAGNET = 0.0039, 0.0011
TINY_TURN, TINY_CLOSING = 1e-10, 1e-9
"""Steps of angle, rad, below which a difference quotient gives way to the derivative."""
SETTLED, MOTOR_SETTLED = 1e-8, 1e-7
"""Newton steps, rad at the output and at the motor, after which the next would change nothing."""
MOST_ITERATIONS, MOST_SWITCHES = 40, 6
STICK, FREE = 0, 2

WIDTH, KEPT, ENTRIES = len(PARAMETERS), len(TRACES), len(LEDGER)


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
    p : array (WIDTH,)
        In the order of `columns.PARAMETERS`.
    table : array (M, 4)
        See :func:`.look_up`.
    reference, reference_rate, feedforward, external : array (N,) or (1,)
        At the middle of every step, or constant.
    driven_speed : array (N + 1,) or (1,)
        Speed of a driven output at the ends of the steps.
    step, steps, every
        s; number; steps a record.
    traces : array (KEPT, records)
    ledger : array (ENTRIES,)
    """
    ratio, constant0, resistance0, inductance = p[0], p[1], p[2], p[3]
    motor_inertia, cogging, cogging_order = p[4], p[5], p[6]
    iron_viscous, hysteresis, at_reference = p[7], p[8], p[9]
    supply, current_limit, decay, control_step = p[10], p[11], p[12], p[13]
    encoder, kp, kd, ki = p[14], p[15], p[16], p[17]
    held, derating_begins, derating_span = p[18], p[19], p[20]
    motor_coulomb, output_coulomb = p[21], p[22]
    motor_viscous, output_viscous = p[23] + iron_viscous, p[24]
    extra, stribeck, load_forward, load_backward = p[25], p[26], p[27], p[28]
    bristle, bristle_damping, output_bristle = p[29], p[30], p[31]
    flange_inertia, output_inertia = p[32], p[32] + p[33]
    load_viscous, sensor, sensor_damping, gravity = p[34], p[35], p[36], p[37]
    wall_angle, wall_stiffness, wall_exponent = p[38], p[39], p[40]
    wall_damping, wall_side = p[41], p[42]
    error_torque, stiffness, power = p[43], p[44], p[45]
    gear_damping, half_gap = p[46], p[47]
    delay, mode, lugre, driven = int(p[57]), int(p[58]), p[59] != 0.0, p[60] != 0.0
    angle, speed, out_angle, out_speed = p[61], p[62], p[63], p[64]
    current, winding, housing = p[65], p[66], p[67]

    h, n = step, abs(ratio)
    per_turn = 1.0 / (2.0 * math.pi * n)
    many, many_rate = reference.shape[0] > 1, reference_rate.shape[0] > 1
    many_forward, many_external = feedforward.shape[0] > 1, external.shape[0] > 1
    many_driven = driven_speed.shape[0] > 1
    intervals = table.shape[0] * per_turn
    line = np.zeros(delay + 1)
    place = 0
    command, count_now, count_before = 0.0, 0.0, 0.0
    integral, elapsed, first = 0.0, 1.0, True
    z, output_z = 0.0, 0.0
    acceleration, output_acceleration, former, output_former = 0.0, 0.0, 0.0, 0.0
    transmitted, way = 0.0, 0.0
    mode_motor = STICK if speed == 0.0 else (1 if speed > 0.0 else -1)
    mode_output = STICK if out_speed == 0.0 else (1 if out_speed > 0.0 else -1)
    if driven:
        out_speed = driven_speed[0]
    error, error_slope, share, share_slope = look_up(table, angle * per_turn)
    closing = angle / ratio + error - out_angle
    deflection, elastic, energy, _ = spring(closing, half_gap, error_torque, stiffness, power)
    electrical, copper, iron, rubbed, output_rubbed = 0.0, 0.0, 0.0, 0.0, 0.0
    damped, load_damped, external_work, throughput, unsettled = 0.0, 0.0, 0.0, 0.0, 0.0
    depth = wall_side * (out_angle - wall_angle)
    push, wall_energy = wall_law(depth, wall_stiffness, wall_exponent)

    before = 0.5 * inductance * current * current
    before += 0.5 * motor_inertia * speed * speed
    before += 0.5 * output_inertia * out_speed * out_speed + share * energy + wall_energy
    before -= gravity * math.cos(out_angle)
    before += 0.5 * sensor * out_angle * out_angle
    if cogging > 0.0:
        before -= cogging / cogging_order * math.cos(cogging_order * angle)
    ledger[9] = before

    for k in range(steps):
        # --- command -------------------------------------------------------------------------
        wanted = reference[k if many else 0]
        if mode >= 4:
            elapsed += h / control_step
            if elapsed >= 1.0 - 1e-9 or first:
                seen = angle
                if encoder > 0.0:
                    seen = math.floor(angle * encoder / (2.0 * math.pi) + 0.5)
                    seen *= 2.0 * math.pi / encoder
                count_before, count_now = count_now, seen / ratio
                if first:
                    count_before = count_now
                rate = speed / ratio
                if encoder > 0.0:
                    rate = (count_now - count_before) / control_step
                behind = wanted - count_now
                if mode == 4:
                    behind_rate = reference_rate[k if many_rate else 0] - rate
                    command = kp * behind + kd * behind_rate
                else:
                    integral += ki * behind * control_step
                    most = current_limit * constant0 * n
                    integral = min(max(integral, -most), most)
                    command = kp * behind - kd * rate + integral
                command += feedforward[k if many_forward else 0]
                elapsed = elapsed - 1.0 if not first else 0.0
                first = False
        else:
            command = wanted
        # --- current and voltage -------------------------------------------------------------
        resistance = resistance0 * (1.0 + COPPER * (winding - at_reference))
        constant = constant0 * (1.0 - MAGNET * (housing - at_reference))
        limit = current_limit
        if winding > derating_begins:
            over = min((winding - derating_begins) / derating_span, 1.0)
            limit = current_limit + over * (min(held, current_limit) - current_limit)
        guess = speed + 0.5 * h * (2.0 * acceleration - former)
        back = constant * guess
        regulated, mean_current, voltage = False, 0.0, 0.0
        reluctance = 2.0 * inductance / h
        if mode == 1:
            line[place] = command
            place = place + 1 if place < delay else 0
            voltage = min(max(line[place], -supply), supply)
            mean_current = (reluctance * current + voltage - back) / (reluctance + resistance)
            if abs(mean_current) > limit:
                bounded = math.copysign(limit, mean_current)
                ending = (
                    bounded if inductance == 0.0 else current + (bounded - current) * (1.0 - decay)
                )
                mean_current = bounded if inductance == 0.0 else 0.5 * (current + ending)
                regulated = True
        elif mode >= 2:
            asked = command if mode == 2 else command / (ratio * constant0)
            line[place] = asked
            place = place + 1 if place < delay else 0
            asked = min(max(line[place], -limit), limit)
            ending = asked + (current - asked) * decay
            mean_current = 0.5 * (current + ending)
            voltage = inductance * (ending - current) / h + resistance * mean_current + back
            regulated = abs(voltage) <= supply
            if not regulated:
                voltage = math.copysign(supply, voltage)
        if mode == 0:
            drive, drive_slope, mean_current = 0.0, 0.0, 0.0
        elif regulated:
            drive, drive_slope = constant * mean_current, 0.0
        else:
            drive = constant * (reluctance * current + voltage) / (reluctance + resistance)
            drive_slope = constant * constant / (reluctance + resistance)
        # --- friction to be had --------------------------------------------------------------
        toward = way if speed == 0.0 else speed
        load_share = load_forward if toward * transmitted * ratio > 0.0 else load_backward
        rise = 1.0
        if extra > 0.0:
            fast = guess / stribeck
            if abs(fast) < 6.0:
                rise += extra * math.exp(-fast * fast)
        motor_level = (motor_coulomb + load_share * abs(transmitted) / n) * rise + hysteresis
        out_guess = out_speed + 0.5 * h * (2.0 * output_acceleration - output_former)
        output_level = output_coulomb
        if extra > 0.0:
            fast = out_guess * n / stribeck
            if abs(fast) < 6.0:
                output_level *= 1.0 + extra * math.exp(-fast * fast)
        b_motor, b_output = motor_viscous, output_viscous + load_viscous
        add_motor, add_output = 0.0, 0.0
        relax = output_relax = 0.0
        if lugre:
            if bristle > 0.0:
                level = max(motor_level, 1e-12)
                relax = h * bristle * abs(guess) / level
                damper = bristle_damping
                if abs(guess) * damper > 4.0 * level:
                    damper = 4.0 * level / abs(guess)
                b_motor += (bristle * h + damper) / (1.0 + relax)
                add_motor = (bristle - damper * relax / h) * z / (1.0 + relax)
            if output_bristle > 0.0:
                level = max(output_level, 1e-12)
                output_relax = h * output_bristle * abs(out_guess) / level
                b_output += output_bristle * h / (1.0 + output_relax)
                add_output = output_bristle * output_z / (1.0 + output_relax)
            motor_level = output_level = 0.0
        else:
            if mode_motor == FREE or (mode_motor == STICK and speed != 0.0):
                mode_motor = 1 if speed > 0.0 else -1
            if mode_output == FREE or (mode_output == STICK and out_speed != 0.0):
                mode_output = 1 if out_speed > 0.0 else -1
        slip_motor = motor_level == 0.0
        slip_output = output_level == 0.0
        # --- Newton iteration on the mean speeds x and y -------------------------------------
        torque_out = external[k if many_external else 0]
        x, y = guess, out_guess
        next_speed = 0.0
        if driven:
            next_speed = driven_speed[k + 1 if many_driven else 0]
            y = 0.5 * (out_speed + next_speed)
        d_motor, d_output = 2.0 * motor_inertia / h, 2.0 * output_inertia / h
        switches, settled = 0, False
        friction, output_friction, torque = 0.0, 0.0, 0.0
        push_mean, wall_rub, cog = 0.0, 0.0, 0.0
        clipped = False
        for iteration in range(MOST_ITERATIONS):
            if not slip_motor and mode_motor == STICK:
                x = 0.5 * speed
            if not (slip_output or driven) and mode_output == STICK:
                y = 0.5 * out_speed
            turn = h * x
            new_error, new_slope, new_share, new_bend = look_up(table, (angle + turn) * per_turn)
            change = turn / ratio + (new_error - error) - h * y
            new_closing = closing + change
            new_deflection, new_elastic, new_energy, new_tangent = spring(
                new_closing, half_gap, error_torque, stiffness, power
            )
            if abs(change) > TINY_CLOSING:
                mean = (new_energy - energy) / change
                mean_slope = (new_elastic - mean) / change
            else:
                mean = 0.5 * (elastic + new_elastic)
                mean_slope = 0.5 * new_tangent
            if abs(turn) > TINY_TURN:
                arm = 1.0 / ratio + (new_error - error) / turn
                bend = (new_share - share) / turn
            else:
                arm = 1.0 / ratio + error_slope * intervals
                bend = share_slope * intervals
            mid_share = 0.5 * (share + new_share)
            torque = mid_share * mean + gear_damping * (new_deflection - deflection) / h
            torque_slope = mid_share * mean_slope
            if new_deflection != 0.0:
                torque_slope += gear_damping / h
            # Without a gap both flanks touch, and the damper may pull.
            clipped = half_gap > 0.0 and torque * mean <= 0.0
            if clipped:
                torque = torque_slope = 0.0
            varying = 0.5 * (energy + new_energy) * bend
            cog = 0.0
            if cogging > 0.0:
                half = 0.5 * cogging_order * turn
                half *= half
                cog = 1.0 - half / 6.0 * (1.0 - half / 20.0 * (1.0 - half / 42.0))
                cog *= cogging * math.sin(cogging_order * (angle + 0.5 * turn))
            pull = 0.0
            if gravity != 0.0:
                half = 0.25 * h * h * y * y
                pull = gravity * math.sin(out_angle + 0.5 * h * y)
                pull *= 1.0 - half / 6.0 * (1.0 - half / 20.0)
            push_mean, push_slope, wall_rub = 0.0, 0.0, 0.0
            if wall_stiffness > 0.0:
                deeper = wall_side * h * y
                if depth > 0.0 or depth + deeper > 0.0:
                    new_push, new_wall = wall_law(depth + deeper, wall_stiffness, wall_exponent)
                    if abs(deeper) > TINY_CLOSING:
                        push_mean = (new_wall - wall_energy) / deeper
                        push_slope = h * (new_push - push_mean) / deeper
                    else:
                        push_mean = 0.5 * (push + new_push)
                    rub = wall_damping * wall_side * y
                    if rub < -1.0:
                        wall_rub, push_slope = -push_mean, 0.0
                    else:
                        wall_rub = push_mean * rub
                        push_slope = push_slope * (1.0 + rub) + push_mean * wall_damping
            push_total = wall_side * (push_mean + wall_rub)
            # Balance without dry friction.
            left = (
                drive
                - drive_slope * x
                - d_motor * (x - speed)
                - b_motor * x
                - add_motor
                - cog
                - arm * torque
                - varying
            )
            right = (
                torque
                + torque_out
                - d_output * (y - out_speed)
                - b_output * y
                - add_output
                - sensor * (out_angle + 0.5 * h * y)
                - sensor_damping * y
                - pull
                - push_total
            )
            friction = 0.0
            if not slip_motor:
                if mode_motor == STICK:
                    friction = left
                elif mode_motor != FREE:
                    friction = mode_motor * motor_level
            output_friction = 0.0
            if not (slip_output or driven):
                if mode_output == STICK:
                    output_friction = right
                elif mode_output != FREE:
                    output_friction = mode_output * output_level
            elif driven and output_level > 0.0:
                output_friction = output_level * (1.0 if y > 0.0 else (-1.0 if y < 0.0 else 0.0))
            coupling = arm * h * torque_slope
            a11 = d_motor + drive_slope + b_motor + arm * coupling
            a22 = d_output + b_output + sensor_damping + push_slope
            a22 += h * (0.5 * sensor + torque_slope)
            dx = dy = 0.0
            held_motor = not slip_motor and mode_motor == STICK
            held_output = driven or (not slip_output and mode_output == STICK)
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
            if h * abs(arm * dx - dy) < SETTLED and h * abs(dx) < MOTOR_SETTLED:
                # Do the frictions agree with the motion they allow?
                switched = False
                if not slip_motor and switches < MOST_SWITCHES:
                    if mode_motor == STICK:
                        # What the held body needs moves with the other one's last correction.
                        friction = left + arm * torque_slope * h * dy
                        if abs(friction) > motor_level:
                            mode_motor = 1 if friction > 0.0 else -1
                            switched = True
                        elif friction * speed < 0.0:
                            mode_motor = FREE
                            switched = True
                    elif mode_motor != FREE:
                        if mode_motor * speed < 0.0:
                            if mode_motor * x < 0.0:
                                mode_motor = FREE
                                switched = True
                        elif mode_motor * (2.0 * x - speed) < 0.0:
                            mode_motor = STICK
                            switched = True
                if not (slip_output or driven) and switches < MOST_SWITCHES:
                    if mode_output == STICK:
                        output_friction = right + torque_slope * h * arm * dx
                        if abs(output_friction) > output_level:
                            mode_output = 1 if output_friction > 0.0 else -1
                            switched = True
                        elif output_friction * out_speed < 0.0:
                            mode_output = FREE
                            switched = True
                    elif mode_output != FREE:
                        if mode_output * out_speed < 0.0:
                            if mode_output * y < 0.0:
                                mode_output = FREE
                                switched = True
                        elif mode_output * (2.0 * y - out_speed) < 0.0:
                            mode_output = STICK
                            switched = True
                if not switched:
                    settled = True
                    break
                switches += 1
                if switches == MOST_SWITCHES:
                    if not slip_motor:
                        mode_motor = FREE
                    if not slip_output:
                        mode_output = FREE
        if not settled:
            unsettled += 1.0
        # --- new state -----------------------------------------------------------------------
        # From the last evaluation to the end is less than SETTLED: first and second order do.
        turned = h * x - turn
        turn = h * x
        new_angle = angle + turn
        if settled:
            new_error += new_slope * intervals * turned
            new_share += new_bend * intervals * turned
        else:
            new_error, new_slope, new_share, new_bend = look_up(table, new_angle * per_turn)
        new_out_angle = out_angle + h * y
        # The error's difference is kept apart from the whole angle, whose rounding is larger.
        closed = change
        change = turn / ratio + (new_error - error) - h * y
        closed = change - closed
        new_closing = closing + change
        if settled and new_deflection * (new_deflection + closed) > 0.0:
            new_deflection += closed
            new_energy += (new_elastic + 0.5 * new_tangent * closed) * closed
            new_elastic += new_tangent * closed
        else:
            new_deflection, new_elastic, new_energy, new_tangent = spring(
                new_closing, half_gap, error_torque, stiffness, power
            )
        if clipped:
            damped -= 0.5 * (share + new_share) * (new_energy - energy)
        else:
            damped += gear_damping * (new_deflection - deflection) * change / h
        new_speed = 2.0 * x - speed
        if not slip_motor and mode_motor == STICK:
            new_speed = 0.0
        new_out_speed = 2.0 * y - out_speed
        if driven:
            new_out_speed = next_speed
        elif not slip_output and mode_output == STICK:
            new_out_speed = 0.0
        if lugre:
            if bristle > 0.0:
                z = (z + h * x) / (1.0 + relax)
                friction = (b_motor - motor_viscous) * x + add_motor
            if output_bristle > 0.0:
                output_z = (output_z + h * y) / (1.0 + output_relax)
                output_friction = (b_output - output_viscous - load_viscous) * y + add_output
        # --- current, ledger, heat -----------------------------------------------------------
        if mode != 0:
            if not regulated:
                mean_current = (reluctance * current + voltage - constant * x) / (
                    reluctance + resistance
                )
            new_current = 2.0 * mean_current - current
            if inductance == 0.0 and not (regulated and mode >= 2):
                new_current = mean_current
            if regulated:
                voltage = (
                    inductance * (new_current - current) / h
                    + resistance * mean_current
                    + constant * x
                )
            current = new_current
        power_in = voltage * mean_current
        power_copper = resistance * mean_current * mean_current
        dry = friction * x * h
        share_iron = 0.0
        if not lugre and motor_level > 0.0:
            share_iron = hysteresis / motor_level
        iron_now = iron_viscous * x * x * h + share_iron * dry
        rub_now = (motor_viscous - iron_viscous) * x * x * h + (1.0 - share_iron) * dry
        out_rub = output_viscous * y * y * h + output_friction * y * h
        wall_now = wall_rub * wall_side * y * h
        electrical += power_in * h
        copper += power_copper * h
        iron += iron_now
        rubbed += rub_now
        output_rubbed += out_rub
        load_damped += (sensor_damping + load_viscous) * y * y * h + wall_now
        if driven:
            torque_out = (
                output_inertia * (new_out_speed - out_speed) / h
                + b_output * y
                + add_output
                + (0.0 if lugre else output_friction)
                + sensor * (out_angle + 0.5 * h * y)
                + sensor_damping * y
                + pull
                + push_total
                - torque
            )
        external_work += torque_out * y * h
        throughput += (abs(power_in) + abs(torque_out * y)) * h
        heat_winding = power_copper
        heat_housing = (iron_now + rub_now + out_rub) / h + p[56]
        warmer = p[48] * winding + p[49] * housing + p[52] * heat_winding + p[53] * heat_housing
        housing = p[50] * winding + p[51] * housing + p[54] * heat_winding + p[55] * heat_housing
        winding = warmer

        given = torque - output_friction - output_viscous * y
        given -= flange_inertia * (new_out_speed - out_speed) / h
        former, output_former = acceleration, output_acceleration
        acceleration = (new_speed - speed) / h
        output_acceleration = (new_out_speed - out_speed) / h
        way = friction if friction != 0.0 else way
        transmitted = torque
        angle, speed = new_angle, new_speed
        out_angle, out_speed = new_out_angle, new_out_speed
        error, error_slope, share, share_slope = new_error, new_slope, new_share, new_bend
        closing, deflection, elastic, energy = new_closing, new_deflection, new_elastic, new_energy
        if wall_stiffness > 0.0:
            depth = wall_side * (out_angle - wall_angle)
            push, wall_energy = wall_law(depth, wall_stiffness, wall_exponent)
        if (k + 1) % every == 0:
            at = (k + 1) // every - 1
            traces[0, at] = angle
            traces[1, at] = speed
            traces[2, at] = out_angle
            traces[3, at] = out_speed
            traces[4, at] = current
            traces[5, at] = voltage
            traces[6, at] = closing
            traces[7, at] = torque
            traces[8, at] = given
            traces[9, at] = friction + (motor_viscous - iron_viscous) * x
            traces[10, at] = output_friction + output_viscous * y
            traces[11, at] = command
            traces[12, at] = winding
            traces[13, at] = housing
    after = 0.5 * inductance * current * current + 0.5 * motor_inertia * speed * speed
    after += 0.5 * output_inertia * out_speed * out_speed + share * energy + wall_energy
    after -= gravity * math.cos(out_angle)
    after += 0.5 * sensor * out_angle * out_angle
    after += 0.5 * bristle * z * z + 0.5 * output_bristle * output_z * output_z
    if cogging > 0.0:
        after -= cogging / cogging_order * math.cos(cogging_order * angle)
    ledger[0] = electrical
    ledger[1] = copper
    ledger[2] = iron
    ledger[3] = rubbed - 0.5 * bristle * z * z
    ledger[4] = output_rubbed - 0.5 * output_bristle * output_z * output_z
    ledger[5] = damped
    ledger[6] = load_damped
    ledger[7] = external_work
    ledger[8] = throughput
    ledger[10] = after
    ledger[11] = unsettled


@numba.njit(cache=True, error_model="numpy", parallel=True)
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
) -> None:
    """Step S actuators, each alone: their numbers do not depend on the number of threads.

    Every signal has one row for all actuators or one for each; see :func:`run_one`.
    """
    count = rows.shape[0]
    for i in numba.prange(count):
        own = np.int64(i)
        run_one(
            rows[i],
            tables[i],
            reference[min(own, reference.shape[0] - 1)],
            reference_rate[min(own, reference_rate.shape[0] - 1)],
            feedforward[min(own, feedforward.shape[0] - 1)],
            external[min(own, external.shape[0] - 1)],
            driven_speed[min(own, driven_speed.shape[0] - 1)],
            step,
            steps,
            every,
            traces[i],
            ledgers[i],
        )
