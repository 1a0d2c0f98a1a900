"""The motor against a locked output, against closed forms of a spring with play and friction."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.actuator.bench.locked import (
    LockedOutput,
    friction_line,
    locked_output,
)
from cqdd_design.actuator.bench.readings import read_friction, read_loop
from cqdd_design.actuator.parameters import MotorParameters
from cqdd_design.design import load_design
from cqdd_design.errors import UsageError
from cqdd_design.machine import Machine, resolve

PLAY, STIFFNESS, SHARE, DRAG, RATIO = 4e-3, 800.0, 0.2, 1.5, 13
FREE = MotorParameters(0.17, 0.14, 1e-4, 5e-4, 21, 4.0, 12.0)
MOTOR = replace(FREE, coulomb=0.07, hysteresis=0.03, viscous=7e-4, iron_loss=1e-4)


@pytest.fixture(scope="module")
def spring() -> LockedOutput:
    """A linear spring behind a play, with friction of its own and a share of the load."""
    torque = np.linspace(0.0, 40.0, 9)
    angle = 0.5 * PLAY + torque / STIFFNESS
    up, down = torque * (1.0 + SHARE) + DRAG, torque * (1.0 - SHARE) - DRAG
    return LockedOutput(RATIO, PLAY, DRAG, torque, angle, up, angle, down)


@pytest.fixture(scope="module")
def machine() -> Machine:
    return resolve(load_design(Path(__file__).parents[2] / "designs" / "printed-13.toml"))


def test_a_loop_reads_the_spring_and_its_friction(spring: LockedOutput) -> None:
    """Branches k (1 + c); width at zero torque the play and twice f/((1 - c) k)."""
    found = spring.read(25.0)
    assert found.peak == pytest.approx(25.0)
    assert found.stiffness == pytest.approx(STIFFNESS * (1.0 + SHARE), rel=1e-3)
    assert found.play == pytest.approx(PLAY + 2.0 * DRAG / ((1.0 - SHARE) * STIFFNESS), rel=2e-3)


def test_a_loop_loses_what_friction_takes(spring: LockedOutput) -> None:
    """Work of friction over a cycle: 2 f over the play, 2 f and 2 c T over every stretch of load.

    Where the motor stands still nothing is lost; above it moves from 0 to T_1 while rising and from
    T_2 back while falling, up(T_1) the peak and x of both the same.
    """
    peak = 25.0
    top = (peak - DRAG) / (1.0 + SHARE)
    rising = DRAG * top / STIFFNESS + SHARE * top**2 / (2.0 * STIFFNESS)
    by_hand = 2.0 * (2.0 * rising + DRAG * PLAY)
    assert spring.read(peak).lost == pytest.approx(by_hand, rel=5e-3)


def test_a_loop_to_the_end_of_its_branches_is_the_same_both_ways(spring: LockedOutput) -> None:
    """There the motor gives way at far less torque than it was driven with."""
    peak = spring.most
    torque, angle = spring.cycle(peak)
    top, bottom = int(np.argmax(torque)), int(np.argmin(torque))
    assert angle[top] == pytest.approx(spring.driving[-1], rel=1e-6)
    assert angle[bottom] == pytest.approx(-spring.driving[-1], rel=1e-6)
    assert spring.read(peak).stiffness == pytest.approx(STIFFNESS * (1.0 + SHARE), rel=1e-3)


def test_a_small_torque_moves_nothing(spring: LockedOutput) -> None:
    """Below the drag the motor stands; within the play it goes from stop to stop."""
    below = spring.follow(0.99 * DRAG * np.array([1.0, -1.0, 1.0]))
    assert below == pytest.approx(0.0, abs=1e-9)
    across = spring.follow(1.01 * DRAG * np.array([1.0, -1.0]))
    assert across[0] - across[1] == pytest.approx(PLAY, rel=0.02)


def test_the_motor_stands_while_torque_falls(spring: LockedOutput) -> None:
    """From up(T) to down(T) nothing moves."""
    top = (25.0 - DRAG) / (1.0 + SHARE)
    back = top * (1.0 - SHARE) - DRAG
    found = spring.follow(np.array([25.0, back + 0.01, back - 1.0]))
    assert found[1] == found[0]
    assert found[2] == pytest.approx(found[0] - 1.0 / ((1.0 - SHARE) * STIFFNESS), rel=1e-6)


def test_more_torque_than_was_solved_is_refused(spring: LockedOutput) -> None:
    with pytest.raises(UsageError, match=r"solved up to 49\.5 N\*m"):
        spring.read(60.0)


def test_a_printed_machine_turns_back_from_a_locked_output(machine: Machine) -> None:
    """Branches rise, the one that gives way lies below, and the motor's drag counts n times."""
    found = locked_output(machine, 6.0, MOTOR)
    assert np.all(np.diff(found.up) > 0.0)
    assert np.all(found.up - found.down[: len(found.up)] >= 2.0 * found.drag - 1e-12)
    assert found.driven[-1] >= found.driving[-1]
    assert np.all(np.diff(found.driving) > 0.0)
    without = locked_output(machine, 6.0, FREE)
    assert found.drag - without.drag == pytest.approx(13 * 0.1)
    assert found.driving == pytest.approx(without.driving)


def test_what_carries_the_cam_softens_the_loop(machine: Machine) -> None:
    """By the energy of its own spring: (cam force)^2 over the torque, at least."""
    rigid = machine.changed({"reducer.cam_bearing.support_stiffness": "0 N/um"})
    soft, hard = (locked_output(one, 6.0, MOTOR) for one in (machine, rigid))
    assert hard.torque[-1] / (hard.driving[-1] - hard.driving[0]) > 1.5 * (
        soft.torque[-1] / (soft.driving[-1] - soft.driving[0])
    )


def test_a_support_is_in_series_with_the_cam_bearing(machine: Machine) -> None:
    model = machine.contact
    load = 50e3 * model.contact_length
    alone = (load / model.cam.stiffness) ** (1.0 / model.cam.exponent) / load
    assert 1.0 / model.carried_cam.stiffness == pytest.approx(alone + 1.0 / 7.4e6)
    assert replace(model, cam_support=0.0).carried_cam is model.cam


def test_friction_without_load_is_the_gearboxs_and_n_times_the_motors(machine: Machine) -> None:
    line = friction_line(machine, 4.0 * np.pi, MOTOR)
    bare = friction_line(machine, 4.0 * np.pi, FREE)
    assert line.coulomb - bare.coulomb == pytest.approx(13 * 0.1)
    assert line.viscous - bare.viscous == pytest.approx(13**2 * 8e-4)
    assert line.viscous_per_turn == pytest.approx(2.0 * np.pi * line.viscous)


WAVE = np.concatenate([np.linspace(0, 1, 30), np.linspace(1, -1, 60), np.linspace(-1, 0, 30)])


@pytest.mark.parametrize(
    ("command", "torque", "angle", "words"),
    [
        (WAVE, WAVE[:-1], WAVE, "of one length"),
        (WAVE, np.where(WAVE > 0.99, np.nan, WAVE), WAVE, "torque is nan in sample 29"),
        (-WAVE, -WAVE, WAVE, "up to a peak, down to a negative one"),
        (np.abs(WAVE), WAVE, WAVE, "up to a peak, down to a negative one"),
        (WAVE, 0.0 * WAVE, WAVE, "without torque has no stiffness"),
        (WAVE, WAVE, -WAVE, "must have one sign"),
        (WAVE[::10], WAVE[::10], WAVE[::10], "its slope needs 8"),
    ],
)
def test_a_record_that_is_no_loop_is_refused(
    command: np.ndarray, torque: np.ndarray, angle: np.ndarray, words: str
) -> None:
    with pytest.raises(UsageError, match=words):
        read_loop(command, torque, angle)


def test_friction_that_drives_or_lacks_a_sense_is_refused() -> None:
    speed = np.linspace(-2.0, 2.0, 80)
    with pytest.raises(UsageError, match="friction would drive"):
        read_friction(speed, -np.sign(speed), 0.1)
    with pytest.raises(UsageError, match="of either sense"):
        read_friction(np.abs(speed), np.sign(speed), 0.1)
