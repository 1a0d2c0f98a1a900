"""Needle cages under the sleeves of the output pins, rated as the checks rate."""

from __future__ import annotations

from cqdd_design.design import Design
from cqdd_design.gearbox.cam_bearing import BearingResult, rate
from cqdd_design.gearbox.checks.allowables import UNEVEN_SHARING
from cqdd_design.gearbox.output_pins import sleeve_turn
from cqdd_design.geometry.runners import pin_runner


def sleeve_needles(
    design: Design, peak_force: float, continuous_force: float
) -> BearingResult | None:
    """Rate the needle cage of one sleeve; None where there are none.

    Parameters
    ----------
    peak_force, continuous_force : float
        Greatest force of a pin on a disc at peak and at continuous torque by the rigid law, N. It
        counts as the cage's constant load, with the factor for uneven sharing.
    """
    runner = pin_runner(design)
    if runner is None or runner.cage is None:
        return None
    ratio, throw = design.reducer.ratio, design.reducer.eccentricity
    turn = float(sleeve_turn(ratio, throw, runner.diameter))
    return rate(
        runner.cage,
        UNEVEN_SHARING * peak_force,
        UNEVEN_SHARING * continuous_force,
        turn * design.requirements.input_speed,
    )
