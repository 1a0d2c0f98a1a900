"""The line of toleranced gearboxes: how many of them meet what perfect parts meet."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cqdd_design.gearbox.checks import allowables
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.gearbox.tolerance.ensemble import ToleranceResult, make_ensemble, run_ensemble
from cqdd_design.gearbox.tolerance.evaluate import OUTPUTS
from cqdd_design.machine import Machine
from cqdd_design.results import Check

LEAST_SAMPLES = 128
"""Gearboxes drawn of a design with many teeth, whose turn takes many angles."""
_ANGLES = 1000
"""About so many crank angles of the output turn for each gearbox."""
_AT_RING = ("CONTACT-RING-PEAK", "CONTACT-RING-CONTINUOUS")
_AT_CAM = ("BEARING-STATIC", "BEARING-LIFE")


def drawn_gearboxes(machine: Machine, samples: int, *, sensitivity: bool) -> ToleranceResult:
    """Toleranced gearboxes at the continuous torque, over a whole output turn.

    Parameters
    ----------
    samples : int
        Gearboxes; fewer of designs with many teeth, but not below `LEAST_SAMPLES`.
    sensitivity : bool
        Whether to rank the tolerances too, which takes twice as many.

    Raises
    ------
    ContactError, UsageError
        As :func:`.ensemble.run_ensemble`.
    """
    ratio = machine.design.reducer.ratio
    # Eight angles a tooth as in `tolerance`, down to two where there are many teeth.
    per_tooth = min(max(_ANGLES // (ratio * (ratio + 1)), 2), 8)
    angles = per_tooth * ratio * (ratio + 1)
    fitting = samples * _ANGLES // max(angles, _ANGLES)
    found = run_ensemble(
        make_ensemble(machine.design, angles=angles),
        max(fitting, min(samples, LEAST_SAMPLES)),
        sensitivity=sensitivity,
    )
    if found.interrupted:
        raise KeyboardInterrupt
    return found


def good_gearboxes(
    machine: Machine, drawn: ToleranceResult, lines: Sequence[Check]
) -> tuple[NDArray[np.bool_], dict[str, float]] | None:
    """Which gearboxes meet everything, and the share that fails each thing.

    Pressure and cam load of a gearbox may exceed those of perfect parts at the same torque by as
    much as the lines of perfect parts have in reserve.

    Parameters
    ----------
    lines : sequence of Check
        Of perfect parts.

    Returns
    -------
    array of bool (S,), dict
        None where a line that is needed is not known.
    """
    by_id = {line.id: line for line in lines}
    if not all(check in by_id and by_id[check].known for check in (*_AT_RING, *_AT_CAM)):
        return None
    torque = machine.design.requirements.continuous_torque
    perfect = machine.loaded_contacts.greatest(torque)
    exponent = machine.analysis.cam_bearing.exponent
    pressure = min(by_id[check].margin for check in _AT_RING)
    load = min(by_id["BEARING-STATIC"].margin, by_id["BEARING-LIFE"].margin ** (1.0 / exponent))

    def column(name: str) -> NDArray[np.float64]:
        return drawn.values[:, OUTPUTS.index(name)]

    fails = {
        "bind": column("unloaded_torque_Nm") > allowables.BINDING_SHARE * torque,
        "ring pressure": column("ring_pressure_max_MPa")
        > pressure * perfect["ring_pressure_max_MPa"],
        "cam load": column("cam_bearing_load_max_N") > load * perfect["cam_bearing_load_max_N"],
    }
    good = ~np.any(list(fails.values()), axis=0)
    shares = {name: float(np.mean(beyond)) for name, beyond in fails.items()}
    return good, shares


def yield_line(
    machine: Machine, drawn: ToleranceResult | None, why: str, lines: Sequence[Check]
) -> Check:
    """The line ``YIELD``; `why` says why nothing was drawn."""
    limit = 100.0 * allowables.YIELD_LEAST
    cure = "see what is not known of pressure and cam load"
    if drawn is None:
        return build_check("YIELD", None, limit, why, "see why none could be drawn")
    found = good_gearboxes(machine, drawn, lines) if len(drawn.values) else None
    if found is None:
        return build_check("YIELD", None, limit, "limits of drawn gearboxes are not known", cure)
    good, shares = found
    count = len(good) + drawn.lost
    share = float(good.sum()) / count
    told = ", ".join(f"{100.0 * one:.1f} % {name}" for name, one in shares.items() if one > 0.0)
    jams = f"; {drawn.lost} jam" if drawn.lost else ""
    worst = max(shares, key=lambda name: shares[name])
    cures = {
        "bind": "give modification.equidistant and hole_clearance some um more, or closer "
        "[tolerances]",
        "ring pressure": "closer [tolerances] of teeth and profile, or more reserve of pressure "
        "(thicker discs, harder material)",
        "cam load": "closer [tolerances], or a larger cam bearing",
    }
    return build_check(
        "YIELD",
        100.0 * share,
        limit,
        f"{int(good.sum())} of {count} gearboxes at {drawn.ensemble.torque:g} N*m"
        + (f": {told}" if told else "")
        + jams,
        cures[worst],
    )
