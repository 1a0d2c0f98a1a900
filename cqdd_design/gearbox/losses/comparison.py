"""The gearbox's own losses beside what was measured on the whole actuator. Nothing is fitted."""

from __future__ import annotations

import numpy as np

from cqdd_design.catalog.paper import METRICS
from cqdd_design.gearbox.losses.model import LossModel

MEASURED_EFFICIENCY = METRICS["efficiency_peak"].value
"""Peak, electrical to mechanical."""
MEASURED_STATIC = METRICS["backdrive_static"].value
MEASURED_DYNAMIC = METRICS["backdrive_dynamic"].value
"""Backdrive torques at the output, N m."""


def against_measured(
    model: LossModel, input_speed: float, peak_torque: float
) -> list[dict[str, object]]:
    """Compare with the measured actuator of the paper.

    Parameters
    ----------
    model : LossModel
        Of the paper's design.
    input_speed : float
        rad/s.
    peak_torque : float
        Largest torque over which the peak of the efficiency is sought, N m.

    Returns
    -------
    list of dict
        `quantity`, `measured`, `gearbox`, `unit`, `note`. The measured values hold motor, drive
        and seals too: a gearbox below the measured efficiency therefore shows that something
        assumed (coefficients, dimensions, stiffness of the cam bearing) loses too much.
    """
    grid = model.efficiency_map([input_speed], np.linspace(0.01, 1.0, 100) * peak_torque)
    at = int(grid.forward[0].argmax())
    best = float(grid.forward[0, at])
    found = model.backdrive()
    verdict = (
        "below the whole actuator: the assumed coefficients or dimensions lose too much"
        if best < MEASURED_EFFICIENCY
        else "leaves the rest to motor and drive"
    )
    rows: list[dict[str, object]] = [
        {
            "quantity": "efficiency_peak",
            "measured": MEASURED_EFFICIENCY,
            "gearbox": best,
            "unit": "1",
            "note": f"gearbox alone, at {grid.torque[at]:.3g} N*m; {verdict}",
        }
    ]
    for name, measured, ours in (
        ("backdrive_static", MEASURED_STATIC, found.static_torque),
        ("backdrive_dynamic", MEASURED_DYNAMIC, found.dynamic_torque),
    ):
        share = (
            "the gearbox's own friction holds any torque"
            if ours is None
            else f"the gearbox's own friction is {100.0 * ours / measured:.0f} % of it"
        )
        rows.append(
            {
                "quantity": name,
                "measured": measured,
                "gearbox": ours,
                "unit": "N*m",
                "note": f"{share}; motor cogging, seals and preloads are not in it",
            }
        )
    return rows
