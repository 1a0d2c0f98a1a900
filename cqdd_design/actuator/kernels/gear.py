"""Compiled gear mesh: dead zone, stiffness and kinematic error; :mod:`..twin.gear` in numpy."""

from __future__ import annotations

from typing import Any, NamedTuple

from cqdd_design.actuator.kernels.laws import look_up, part, spring

TINY_TURN, TINY_CLOSING = 1e-10, 1e-9
"""Steps of angle, rad, below which a difference quotient gives way to the derivative."""


class Mesh(NamedTuple):
    """State of the mesh at an instant; slopes count per interval of the table."""

    error: float
    error_slope: float
    share: float
    share_slope: float
    closing: float
    deflection: float
    elastic: float
    energy: float
    tangent: float


@part
def mesh_at(p: Any, table: Any, angle: float, out_angle: float) -> Any:
    """Mesh at angles of motor and output."""
    error, error_slope, share, share_slope = look_up(table, angle * p.per_turn)
    closing = angle / p.ratio + error - out_angle
    deflection, elastic, energy, tangent = spring(
        closing, p.half_backlash, p.error_torque, p.stiffness, p.stiffening
    )
    return Mesh(
        error, error_slope, share, share_slope, closing, deflection, elastic, energy, tangent
    )


class Contact(NamedTuple):
    """What the mesh does over a step.

    Attributes
    ----------
    torque, slope : float
        Mean torque on the output, and its slope over the closing.
    arm : float
        Lever by which the torque acts on the motor.
    varying : float
        Torque of the varying stiffness on the motor.
    cut : bool
        Whether the flank that gives way would have pulled, and lets go instead.
    push, push_slope : float
        What that flank gives before the cut, positive where it pushes, and its slope.
    change : float
        Of the closing.
    """

    torque: float
    slope: float
    arm: float
    varying: float
    cut: bool
    push: float
    push_slope: float
    change: float


@part
def meshed(
    p: Any, table: Any, begin: Any, angle: float, turn: float, out_turn: float, h: float
) -> Any:
    """Contact over a step from `begin` at motor angle `angle`, and the mesh at its end.

    With a gap every flank pushes or lets go, each for itself: a step that leaves one and meets the
    other has the push of both, so that the torque stays continuous over the closing.
    """
    new_error, new_slope, new_share, new_bend = look_up(table, (angle + turn) * p.per_turn)
    change = turn / p.ratio + (new_error - begin.error) - out_turn
    new_closing = begin.closing + change
    new_deflection, new_elastic, new_energy, new_tangent = spring(
        new_closing, p.half_backlash, p.error_torque, p.stiffness, p.stiffening
    )
    # The discrete gradient: mean torque times change is the energy gained.
    if abs(change) > TINY_CLOSING:
        mean = (new_energy - begin.energy) / change
        mean_slope = (new_elastic - mean) / change
    else:
        mean = 0.5 * (begin.elastic + new_elastic)
        mean_slope = 0.5 * new_tangent
    if abs(turn) > TINY_TURN:
        arm = 1.0 / p.ratio + (new_error - begin.error) / turn
        bend = (new_share - begin.share) / turn
    else:
        arm = 1.0 / p.ratio + begin.error_slope * (table.shape[0] * p.per_turn)
        bend = begin.share_slope * (table.shape[0] * p.per_turn)
    mid_share = 0.5 * (begin.share + new_share)
    torque = mid_share * mean + p.gear_damping * (new_deflection - begin.deflection) / h
    slope = mid_share * mean_slope
    if new_deflection != 0.0:
        slope += p.gear_damping / h
    # Without a gap both flanks touch, and the damper may pull.
    cut, push, push_slope = False, 1.0, 0.0
    if p.half_backlash > 0.0:
        if begin.deflection * new_deflection < 0.0:
            # Left is what pushed before, at E/|x|; met is the other flank.
            push = mid_share * begin.energy / abs(change)
            push_slope = -push / change
            push -= p.gear_damping * abs(begin.deflection) / h
            cut = push <= 0.0
            if cut:
                mean = new_energy / change
                torque = mid_share * mean + p.gear_damping * new_deflection / h
                slope = mid_share * (new_elastic - mean) / change + p.gear_damping / h
        else:
            way = 1.0 if mean > 0.0 else -1.0
            push, push_slope = way * torque, way * slope
            cut = torque * mean <= 0.0
            if cut:
                torque = slope = 0.0
    varying = 0.5 * (begin.energy + new_energy) * bend
    end = Mesh(
        new_error,
        new_slope,
        new_share,
        new_bend,
        new_closing,
        new_deflection,
        new_elastic,
        new_energy,
        new_tangent,
    )
    return Contact(torque, slope, arm, varying, cut, push, push_slope, change), end


@part
def passes_kink(p: Any, contact: Any, end: Any, closed: float) -> Any:
    """Whether a last correction of the closing leads contact to where its slopes do not hold."""
    touches = abs(end.closing) > p.half_backlash
    will_touch = abs(end.closing + closed) > p.half_backlash
    return touches != will_touch or contact.cut != (
        contact.push + contact.push_slope * closed <= 0.0
    )


class Last(NamedTuple):
    """The last evaluation of a step: mesh at its end, change of closing, turn, whether settled."""

    end: Any
    change: float
    turn: float
    settled: bool


@part
def mesh_ended(
    p: Any, table: Any, begin: Any, last: Any, new_angle: float, turn: float, out_turn: float
) -> Any:
    """Mesh at the end of the step, and its whole change of closing.

    From the last evaluation to the end first and second order do, where the iteration settled.
    """
    end, turned = last.end, turn - last.turn
    error, error_slope, share, share_slope = (
        end.error,
        end.error_slope,
        end.share,
        end.share_slope,
    )
    deflection, elastic, energy, tangent = end.deflection, end.elastic, end.energy, end.tangent
    if last.settled:
        error += error_slope * (table.shape[0] * p.per_turn) * turned
        share += share_slope * (table.shape[0] * p.per_turn) * turned
    else:
        error, error_slope, share, share_slope = look_up(table, new_angle * p.per_turn)
    # The error's difference is kept apart from the whole angle, whose rounding is larger.
    whole = turn / p.ratio + (error - begin.error) - out_turn
    closed = whole - last.change
    closing = begin.closing + whole
    if last.settled and deflection * (deflection + closed) > 0.0:
        deflection += closed
        energy += (elastic + 0.5 * tangent * closed) * closed
        elastic += tangent * closed
    else:
        deflection, elastic, energy, tangent = spring(
            closing, p.half_backlash, p.error_torque, p.stiffness, p.stiffening
        )
    found = Mesh(
        error, error_slope, share, share_slope, closing, deflection, elastic, energy, tangent
    )
    return found, whole


@part
def damped_in_mesh(
    p: Any, begin: Any, end: Any, change: float, cut: bool, h: float, damped: float
) -> Any:
    """Energy lost in the mesh, with that of a step: its damper's, and all that a cut flank held.

    Added here and not by the caller, as the product and the sum are rounded once.
    """
    if cut:
        if begin.deflection * end.deflection < 0.0:
            damped += p.gear_damping * end.deflection * change / h
            return damped + 0.5 * (begin.share + end.share) * begin.energy
        return damped - 0.5 * (begin.share + end.share) * (end.energy - begin.energy)
    return damped + p.gear_damping * (end.deflection - begin.deflection) * change / h
