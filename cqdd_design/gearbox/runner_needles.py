"""Needle cages under sleeves and rollers, rated as the checks rate."""

from __future__ import annotations

from cqdd_design.design import Design
from cqdd_design.gearbox.cam_bearing import BearingResult, rate
from cqdd_design.gearbox.checks.allowables import UNEVEN_SHARING
from cqdd_design.gearbox.loads import RigidMaxima
from cqdd_design.gearbox.rolling_contacts import greatest_roller_turn, sleeve_turn
from cqdd_design.geometry.runners import Runner, pin_runner, ring_runner


def sleeve_needles(
    design: Design, peak: RigidMaxima, continuous: RigidMaxima
) -> BearingResult | None:
    """Rate the needle cage of one sleeve on an output pin; None where there are none.

    The greatest force of a pin on a disc by the rigid law counts as its constant load, with the
    factor for uneven sharing.
    """
    runner, reducer = pin_runner(design), design.reducer
    if runner is None or runner.cage is None:
        return None
    turn = float(sleeve_turn(reducer.ratio, reducer.eccentricity, runner.diameter))
    return _rated(design, runner, (peak.output_pin_force, continuous.output_pin_force), turn)


def roller_needles(
    design: Design, peak: RigidMaxima, continuous: RigidMaxima
) -> BearingResult | None:
    """Rate the needle cage of one roller on a ring pin; None where there are none.

    As :func:`sleeve_needles`, at the fastest turn of a roller over the period.
    """
    runner, reducer = ring_runner(design), design.reducer
    if runner is None or runner.cage is None:
        return None
    turn = greatest_roller_turn(
        reducer.ratio, reducer.ring_pitch_radius, reducer.eccentricity, runner.diameter
    )
    return _rated(design, runner, (peak.ring_force, continuous.ring_force), turn)


def _rated(
    design: Design, runner: Runner, forces: tuple[float, float], turn: float
) -> BearingResult | None:
    if runner.cage is None:
        return None
    peak, continuous = (UNEVEN_SHARING * force / runner.rows for force in forces)
    return rate(runner.cage, peak, continuous, turn * design.requirements.held_speed)
