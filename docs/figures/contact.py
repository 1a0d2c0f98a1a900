"""Figures of contact-model.md: who carries, through which gap, and what the carrier does."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import numpy as np

from cqdd_design.design import load_design
from cqdd_design.gearbox import rigid
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.states import nominal_states
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.geometry import kinematics
from cqdd_design.report.ink.axes import Axis, Legend, Panel, linear_axis
from cqdd_design.report.ink.numbers import decimals
from cqdd_design.report.ink.svg import Figure, Words, rectangle, text

_DESIGN = Path(__file__).parents[2] / "designs" / "cqdd-10.toml"
_ARCMIN = math.radians(1.0 / 60.0)
_TORQUE = 40.0
_WIDTH, _LEFT, _PANEL_WIDTH = 720.0, 62.0, 636.0


@cache
def _paper() -> ContactModel:
    return ContactModel.from_design(load_design(_DESIGN))


def teeth() -> Figure:
    """Force of every ring tooth by the rigid law and in equilibrium, and how far it is pressed."""
    model = _paper()
    n = model.lobe_count
    turn = contact_sweep(model, -_TORQUE, perfect_angles(model))
    at = int(turn.ring_force[:, 0].max(axis=1).argmax())
    angle, force = turn.crank_angle[at : at + 1], turn.ring_force[at, 0]
    radius, share = model.disc.ring_pitch_radius, 0.5 * _TORQUE
    law = rigid.ring_forces(n, radius, model.eccentricity, share, angle)[0]
    states = nominal_states(model, angle)
    moved = turn.disc_displacement[at, 0] * np.array([1.0, 1.0, states.length])
    pressed = 1e6 * (-states.rows[0, 0, : n + 1] @ moved - states.gaps[0, 0, : n + 1])
    numbers = Axis(0.4, n + 1.6, tuple(float(k) for k in range(1, n + 2)), "ring tooth")
    upper, lower = (
        Panel(f"teeth-{name}", numbers, axis, _LEFT, top, _PANEL_WIDTH, high)
        for name, axis, top, high in (
            (
                "force",
                linear_axis(0.0, float(max(force.max(), law.max())), "force, N"),
                40.0,
                170.0,
            ),
            (
                "closing",
                linear_axis(float(pressed.min()), float(pressed.max()), "approach δ, µm"),
                232.0,
                170.0,
            ),
        )
    )
    body = [*upper.frame(names=False), *lower.frame(), lower.across(0.0, "axis")]
    for k in range(n + 1):
        body += _bar(upper, k + 1.0, float(force[k]), "share-bar")
        body += _bar(upper, k + 1.0, float(law[k]), "bar-outline")
        body += _bar(lower, k + 1.0, float(pressed[k]), "share-bar")
    for x, class_, name in (
        (_LEFT, "bar-outline", "rigid law, half of the torque on each disc"),
        (_LEFT + 300.0, "share-bar", "equilibrium with gaps and elasticity"),
    ):
        body += [rectangle(x, 8.0, 22.0, 12.0, class_), text((x + 30.0, 18.0), name, "legend")]
    degrees = decimals(math.degrees(float(angle[0])), 1)
    words = Words(
        "contact-teeth",
        "Load of every ring tooth",
        f"At {_TORQUE:g} newton metres and a crank angle of {degrees} degrees the rigid law loads "
        f"{int((law > 0.0).sum())} teeth of a disc; with gaps and elasticity "
        f"{int((force > 0.0).sum())} carry, the busiest {force.max():.0f} instead of "
        f"{law.max():.0f} newtons. Below zero a tooth stands clear by so much.",
    )
    return words.figure(_WIDTH, lower.bottom + 43.0, body)


def _bar(panel: Panel, at: float, value: float, class_: str) -> list[str]:
    """A bar from zero, up or down, over a number of the abscissa; none of nothing."""
    if value == 0.0:
        return []
    left, top = panel.place(at - 0.3, max(value, 0.0))
    right, bottom = panel.place(at + 0.3, min(value, 0.0))
    return [rectangle(left, top, right - left, bottom - top, class_)]


def error() -> Figure:
    """How far the carrier is from its nominal angle over a period, at three torques."""
    model = _paper()
    period = kinematics.mesh_period(model.lobe_count, model.pin_count)
    angle = np.linspace(0.0, 2.0 * period, 481)
    curves = []
    for torque, class_ in ((5.0, "series-1"), (40.0, "series-2"), (120.0, "series-3")):
        lag = contact_sweep(model, torque, angle).carrier_angle_error / _ARCMIN
        curves.append((f"{torque:g} N·m", class_, lag - lag.mean()))
    most = 1.1 * max(float(np.abs(one).max()) for _, _, one in curves)
    panel = Panel(
        "error-panel",
        linear_axis(0.0, math.degrees(2.0 * period), "crank angle, °", most=8, tight=True),
        linear_axis(-most, most, "carrier, arcmin from its mean", most=6),
        _LEFT,
        36.0,
        _PANEL_WIDTH,
        220.0,
    )
    degrees = np.degrees(angle)
    body = panel.frame()
    body += [panel.curve(degrees, lag, class_) for _, class_, lag in curves]
    body.append(panel.upright(math.degrees(period)))
    end = panel.place(math.degrees(period), panel.y.high)
    body.append(text((end[0] + 6.0, end[1] + 12.0), "period", "limit-label"))
    body.append(Legend([(name, class_) for name, class_, _ in curves], right=_WIDTH).render())
    swings = ", ".join(f"{np.ptp(lag):.3f}' at {name}" for name, _, lag in curves)
    words = Words(
        "contact-error",
        "Transmission error over two periods",
        f"The carrier's angle about its mean over two periods of {math.degrees(period):.2f} "
        f"degrees; peak to peak {swings}.",
    )
    return words.figure(_WIDTH, panel.bottom + 43.0, body)
