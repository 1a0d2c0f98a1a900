"""What clearances cost and save: small ensembles over profile offset and hole clearance."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from cqdd_design.design import Design
from cqdd_design.errors import ContactError, DesignError
from cqdd_design.gearbox.tolerance.ensemble import make_ensemble
from cqdd_design.gearbox.tolerance.evaluate import OUTPUTS
from cqdd_design.gearbox.tolerance.limits import lasting_hours
from cqdd_design.gearbox.tolerance.remembered import work_remembered
from cqdd_design.gearbox.tolerance.run import ToleranceResult, run_ensemble

EQUIDISTANTS = (0.0, 3e-6, 6e-6, 10e-6)
"""Offsets of the flank that are tried beside the design's own, m."""
HOLE_SHARES = (0.5, 1.0, 1.5)
"""Hole clearances that are tried, over the design's own."""


@dataclass(frozen=True)
class ClearancePoint:
    """Toleranced gearboxes of a design with other clearances.

    Attributes
    ----------
    equidistant, hole_clearance : float
        m.
    own : bool
        Whether they are the design's.
    backlash : float
        Mean, arcmin.
    stiffness : float
        Mean, N m/arcmin.
    binding : float
        Share of the gearboxes that bind.
    reserve : float or None
        Median pressure that lasts the required hours over the greatest one; None where the
        materials' limits are not known.
    hours : float or None
        Of disc and ring at the median of the greatest pressures, at the continuous torque and the
        input speed.
    missing : str
        Why there are no figures, where a gearbox has no equilibrium.
    """

    equidistant: float
    hole_clearance: float
    own: bool
    backlash: float = 0.0
    stiffness: float = 0.0
    binding: float = 0.0
    reserve: float | None = None
    hours: float | None = None
    missing: str = ""


def clearance_study(
    design: Design,
    samples: int = 24,
    angles: int | None = None,
    seed: int = 0,
    known: ToleranceResult | None = None,
) -> tuple[ClearancePoint, ...]:
    """Ensembles over :data:`EQUIDISTANTS`, for every hole clearance of :data:`HOLE_SHARES` in turn.

    Parameters
    ----------
    design : Design
        With its cam bearing named.
    samples : int
        Gearboxes at every point, the same draws everywhere.
    angles : int, optional
        Crank angles over the output turn; default :func:`.evaluate.turn_angles`.
    known : ToleranceResult, optional
        As many gearboxes or more of the design's own clearances, which are then not worked again.
    """
    offset = design.reducer.modification.equidistant
    hole = design.reducer.output_pins.hole_clearance
    offsets = sorted({*EQUIDISTANTS, offset})
    places = [(one, share * hole) for share in HOLE_SHARES for one in offsets]
    draws = samples, angles, seed
    # Two at a time: the tables of one are made while the gearboxes of the other are worked.
    with ThreadPoolExecutor(2) as pool:
        return tuple(pool.map(lambda at: _point(design, at[0], at[1], draws, known), places))


def _point(
    design: Design,
    equidistant: float,
    hole: float,
    draws: tuple[int, int | None, int],
    known: ToleranceResult | None,
) -> ClearancePoint:
    samples, angles, seed = draws
    reducer = design.reducer
    own = (equidistant, hole) == (
        reducer.modification.equidistant,
        reducer.output_pins.hole_clearance,
    )
    try:
        changed = design
        if not own:
            changed = design.replacing(
                {
                    "reducer.modification.equidistant": equidistant,
                    "reducer.output_pins.hole_clearance": hole,
                }
            )
        ensemble = make_ensemble(changed, angles=angles, seed=seed, bodies=design)
        found = known.first(samples) if known and known.ensemble == ensemble else None
        if found is None or found.lost == samples:
            found = run_ensemble(ensemble, samples, mapper=work_remembered, sensitivity=False)
    except (ContactError, DesignError) as error:
        return ClearancePoint(equidistant, hole, own, missing=error.message)
    values = dict(zip(OUTPUTS, found.values.T, strict=True))
    reserve = found.pressure_reserve()
    pressure = float(np.median(values["ring_pressure_max_MPa"])) * 1e6
    return ClearancePoint(
        equidistant=equidistant,
        hole_clearance=hole,
        own=own,
        backlash=float(values["backlash_arcmin"].mean()),
        stiffness=float(values["stiffness_Nm_per_arcmin"].mean()),
        binding=found.beyond()["unloaded_torque_Nm"],
        reserve=None if reserve is None else reserve["p50"],
        hours=lasting_hours(changed, pressure),
    )
