"""The line of toleranced gearboxes: how many of them meet what perfect parts meet."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cqdd_design.catalog.materials import find_material
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
_ARCMIN = math.degrees(1.0) * 60.0
_PER_TOOTH = 8, 2
"""Crank angles for each tooth, at the continuous torque and at the peak: greatest loads alone."""
_RING = ("CONTACT-RING-PEAK", "CONTACT-RING-CONTINUOUS")
_CAM = ("BEARING-STATIC", "BEARING-LIFE")


class Drawn(NamedTuple):
    """The same toleranced gearboxes over a whole output turn, under two torques."""

    continuous: ToleranceResult
    peak: ToleranceResult


def drawn_gearboxes(machine: Machine, samples: int, *, sensitivity: bool) -> Drawn:
    """Toleranced gearboxes at the continuous and at the peak torque.

    Parameters
    ----------
    samples : int
        Gearboxes; fewer of designs with many teeth, but not below `LEAST_SAMPLES`.
    sensitivity : bool
        Whether to rank the tolerances too, at the continuous torque, which takes twice as many.

    Raises
    ------
    ContactError, UsageError
        As :func:`.ensemble.run_ensemble`.
    """
    ratio = machine.design.reducer.ratio
    # Eight angles a tooth as in `tolerance`, down to two where there are many teeth.
    most, least = _PER_TOOTH
    per_tooth = min(max(_ANGLES // (ratio * (ratio + 1)), least), most)
    angles = per_tooth * ratio * (ratio + 1)
    fitting = samples * _ANGLES // max(angles, _ANGLES)
    count = max(fitting, min(samples, LEAST_SAMPLES))
    peak = machine.design.requirements.peak_torque
    found = Drawn(
        run_ensemble(make_ensemble(machine.design, angles=angles), count, sensitivity=sensitivity),
        run_ensemble(
            make_ensemble(machine.design, angles=least * ratio * (ratio + 1), torque=peak),
            count,
            sensitivity=False,
        ),
    )
    if any(one.interrupted for one in found):
        raise KeyboardInterrupt
    return found


def good_gearboxes(
    machine: Machine, drawn: Drawn, lines: Sequence[Check]
) -> tuple[NDArray[np.intp], dict[str, int]] | None:
    """Which gearboxes meet everything, by number, and how many fail each thing.

    At the peak torque pressure and cam load stand against the limits of the lines of perfect
    parts. Over the life they may exceed those of perfect parts at the continuous torque by as much
    as these lines have in reserve.

    Parameters
    ----------
    lines : sequence of Check
        Of perfect parts.

    Returns
    -------
    array of int, dict
        None where a line that is needed is not known.
    """
    by_id = {line.id: line for line in lines}
    if not all(check in by_id and by_id[check].known for check in (*_RING, *_CAM)):
        return None
    torque = machine.design.requirements.continuous_torque
    perfect = machine.loaded_contacts.greatest(torque)
    cam = machine.analysis.cam_bearing
    pressure = by_id["CONTACT-RING-CONTINUOUS"].margin
    load = by_id["BEARING-LIFE"].margin ** (1.0 / cam.exponent)
    static = (cam.bearing.static_rating or 0.0) / allowables.STATIC_SAFETY
    _, yields = by_id["CONTACT-RING-PEAK"].compared
    lasts, bears = _columns(drawn.continuous), _columns(drawn.peak)
    fails = {
        "bind": lasts["unloaded_torque_Nm"] > allowables.BINDING_SHARE * torque,
        "ring pressure over the life": lasts["ring_pressure_max_MPa"]
        > pressure * perfect["ring_pressure_max_MPa"],
        "cam load over the life": lasts["cam_bearing_load_max_N"]
        > load * perfect["cam_bearing_load_max_N"],
    }
    asked = machine.design.requirements
    if asked.backlash is not None:
        fails["backlash"] = lasts["backlash_arcmin"] > asked.backlash * _ARCMIN
    if asked.stiffness is not None:
        fails["stiffness"] = lasts["stiffness_Nm_per_arcmin"] < asked.stiffness / _ARCMIN
    at_peak = {
        "ring pressure at the peak": bears["ring_pressure_max_MPa"] > yields,
        "cam load at the peak": bears["cam_bearing_load_max_N"] > static,
    }
    good = np.intersect1d(
        drawn.continuous.numbers[~np.any(list(fails.values()), axis=0)],
        drawn.peak.numbers[~np.any(list(at_peak.values()), axis=0)],
    )
    return good, {name: int(beyond.sum()) for name, beyond in (fails | at_peak).items()}


def loads_at_peak(machine: Machine, drawn: Drawn, share: float) -> dict[str, float]:
    """What a share of the gearboxes has at most at the peak torque, over the limits, by check.

    Pressure at the ring, and load of the cam bearing.
    """
    cam, reducer = machine.analysis.cam_bearing, machine.design.reducer
    steels = (find_material(reducer.disc_material), find_material(reducer.ring_material))
    yields = allowables.weaker(*(allowables.contact_limit_static(one) for one in steels)).value
    static = (cam.bearing.static_rating or 0.0) / allowables.STATIC_SAFETY
    found = _columns(drawn.peak)
    return {
        "CONTACT-RING-PEAK": float(np.quantile(found["ring_pressure_max_MPa"], share))
        / (yields / 1e6),
        "BEARING-STATIC": float(np.quantile(found["cam_bearing_load_max_N"], share)) / static,
    }


def _columns(drawn: ToleranceResult) -> dict[str, NDArray[np.float64]]:
    return dict(zip(OUTPUTS, drawn.values.T, strict=True))


def yield_line(machine: Machine, drawn: Drawn | None, why: str, lines: Sequence[Check]) -> Check:
    """The line ``YIELD``; `why` says why nothing was drawn."""
    limit = 100.0 * machine.design.requirements.yield_share
    cure = "see what is not known of pressure and cam load"
    if drawn is None:
        return build_check("YIELD", None, limit, why, "see why none could be drawn")
    solved = min(len(one.values) for one in drawn)
    found = good_gearboxes(machine, drawn, lines) if solved else None
    if found is None:
        return build_check("YIELD", None, limit, "limits of drawn gearboxes are not known", cure)
    good, fails = found
    count = len(drawn.continuous.values) + drawn.continuous.lost
    told = [f"{number} {name}" for name, number in fails.items() if number]
    told += [f"{one.lost} jam at {one.ensemble.torque:g} N*m" for one in drawn if one.lost]
    worst = max(fails, key=lambda name: fails[name])
    return build_check(
        "YIELD",
        100.0 * len(good) / count,
        limit,
        f"{len(good)} of {count} gearboxes" + (f"; {', '.join(told)}" if told else ""),
        _CURES[worst.partition(" ")[0]],
    )


_CURES = {
    "bind": "give modification.equidistant and hole_clearance some um more, or closer [tolerances]",
    "ring": "closer [tolerances] of teeth and profile, or more reserve of pressure (thicker discs, "
    "harder material)",
    "cam": "closer [tolerances], more clearance, or a larger cam bearing",
    "backlash": "smaller clearances with closer [tolerances]",
    "stiffness": "smaller clearances, or thicker or more output_pins",
}
