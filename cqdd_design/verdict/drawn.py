"""The line of toleranced gearboxes: how many of them meet what perfect parts meet."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cqdd_design.errors import DesignError
from cqdd_design.gearbox.checks import allowables
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.gearbox.heat.expansion import AS_DRAWN
from cqdd_design.gearbox.tolerance.ensemble import make_ensemble
from cqdd_design.gearbox.tolerance.evaluate import FREEDOM, LOADS, OUTPUTS, PER_TOOTH, RANKED
from cqdd_design.gearbox.tolerance.remembered import work_remembered
from cqdd_design.gearbox.tolerance.run import ToleranceResult, run_ensemble
from cqdd_design.machine import Machine
from cqdd_design.machine.temperatures import MachineTemperatures
from cqdd_design.results import Check

_ARCMIN = math.degrees(1.0) * 60.0
_LEAST = " at least clearance"
TIGHT, SOFT = f"bind{_LEAST}", f"stiffness{_LEAST}"
"""What gearboxes fail by in the state that leaves them least."""
_RING = ("CONTACT-RING-PEAK", "CONTACT-RING-CONTINUOUS")
_CAM = ("BEARING-STATIC", "BEARING-LIFE")


class Drawn(NamedTuple):
    """The same toleranced gearboxes over a whole output turn, under two torques, and warm."""

    continuous: ToleranceResult
    peak: ToleranceResult
    """The greatest loads alone."""
    warm: ToleranceResult | None = None
    """At the continuous torque in the state that leaves least clearance; None where warmth and
    cold take none, or temperatures are not known."""

    @property
    def every(self) -> tuple[ToleranceResult, ...]:
        """Those that there are."""
        return tuple(one for one in self if one is not None)


def drawn_gearboxes(
    machine: Machine,
    samples: int,
    *,
    sensitivity: bool,
    rigid: bool = False,
    warm: Callable[[], MachineTemperatures | None] = lambda: None,
) -> Drawn:
    """Toleranced gearboxes at the continuous torque, or what stands for the duty, and at the peak.

    Where warmth or a cold start take clearance, in that state too.

    Parameters
    ----------
    samples : int
        Gearboxes.
    sensitivity : bool
        Whether to rank the tolerances too, at the continuous torque, which takes twice as many;
        by `RANKED` alone.
    rigid : bool
        Whether discs and ring do not yield, for a look that has to be quick.
    warm : callable
        How warm the parts get, asked for last.

    Raises
    ------
    ContactError, UsageError
        As :func:`.ensemble.run_ensemble`.
    """
    ratio = machine.design.reducer.ratio
    peak = machine.design.requirements.peak_torque
    # Greatest loads alone need the fewest angles.
    fewest = PER_TOOTH[1] * ratio * (ratio + 1)
    at_peak = make_ensemble(
        machine.design, angles=fewest, torque=peak, outputs=LOADS, rigid=rigid, at_rest=True
    )
    lasting = make_ensemble(machine.design, rigid=rigid)
    # Side by side: the tables of one are made while the gearboxes of the other are worked.
    with ThreadPoolExecutor(1) as beside:
        peaks = beside.submit(
            run_ensemble, at_peak, samples, mapper=work_remembered, sensitivity=False
        )
        try:
            steady = run_ensemble(
                lasting, samples, mapper=work_remembered, sensitivity=sensitivity, ranked=RANKED
            )
        finally:
            # What is wrong at the peak is told first.
            found_at_peak = peaks.result()
    found = Drawn(steady, found_at_peak, _warm(machine, samples, rigid, warm()))
    if any(one.interrupted for one in found.every):
        raise KeyboardInterrupt
    return found


def _warm(
    machine: Machine, samples: int, rigid: bool, known: MachineTemperatures | None
) -> ToleranceResult | None:
    """The gearboxes where they have least clearance."""
    try:
        parts = AS_DRAWN if known is None else known.least_free
    except DesignError:
        # How some part grows is not known, which THERMAL-CLEARANCE says.
        return None
    if parts == AS_DRAWN:
        return None
    # What is looked for there: whether they turn, and are as stiff as asked.
    asked = FREEDOM if machine.design.requirements.stiffness is None else OUTPUTS
    tight = make_ensemble(machine.design, temperatures=parts, outputs=asked, rigid=rigid)
    return run_ensemble(tight, samples, mapper=work_remembered, sensitivity=False)


@dataclass(frozen=True)
class Allowed:
    """What a toleranced gearbox may reach at the ring (MPa) and at a cam bearing (N).

    At the continuous torque, as much more than perfect parts as these have in reserve over the
    life; at the peak torque, the limits of perfect parts.
    """

    lasting_pressure: float
    lasting_load: float
    peak_pressure: float
    peak_load: float

    @classmethod
    def of(cls, machine: Machine, lines: Sequence[Check]) -> Allowed | None:
        """From the lines of perfect parts; None where one that is needed is not known."""
        by_id = {line.id: line for line in lines}
        if not all(check in by_id and by_id[check].known for check in (*_RING, *_CAM)):
            return None
        perfect = machine.running_contacts.greatest(machine.design.requirements.equal_torque)
        cam = machine.analysis.cam_bearing
        pressure = by_id["CONTACT-RING-CONTINUOUS"].margin
        load = by_id["BEARING-LIFE"].margin ** (1.0 / cam.exponent)
        return cls(
            lasting_pressure=pressure * perfect["ring_pressure_max_MPa"],
            lasting_load=load * perfect["cam_bearing_load_max_N"],
            peak_pressure=by_id["CONTACT-RING-PEAK"].compared[1],
            peak_load=(cam.bearing.static_rating or 0.0) / allowables.STATIC_SAFETY,
        )


def used(allowed: Allowed, drawn: Drawn) -> dict[str, NDArray[np.float64]]:
    """Pressure and cam load of every gearbox over what is allowed, by the line it stands for."""
    lasts, bears = drawn.continuous.columns, drawn.peak.columns
    return {
        "CONTACT-RING-CONTINUOUS": lasts["ring_pressure_max_MPa"] / allowed.lasting_pressure,
        "BEARING-LIFE": lasts["cam_bearing_load_max_N"] / allowed.lasting_load,
        "CONTACT-RING-PEAK": bears["ring_pressure_max_MPa"] / allowed.peak_pressure,
        "BEARING-STATIC": bears["cam_bearing_load_max_N"] / allowed.peak_load,
    }


_WORDS = {
    "CONTACT-RING-CONTINUOUS": "ring pressure over the life",
    "BEARING-LIFE": "cam load over the life",
    "CONTACT-RING-PEAK": "ring pressure at the peak",
    "BEARING-STATIC": "cam load at the peak",
}


def good_gearboxes(
    machine: Machine, drawn: Drawn, lines: Sequence[Check]
) -> tuple[NDArray[np.intp], dict[str, int]] | None:
    """Which gearboxes meet everything, by number, and how many fail each thing.

    Parameters
    ----------
    lines : sequence of Check
        Of perfect parts.

    Returns
    -------
    array of int, dict
        None where a line that is needed is not known.
    """
    allowed = Allowed.of(machine, lines)
    if allowed is None:
        return None
    asked, lasts = machine.design.requirements, drawn.continuous.columns
    most = allowables.BINDING_SHARE * asked.continuous_torque
    fails = {"bind": (drawn.continuous, lasts["unloaded_torque_Nm"] > most)}
    if asked.backlash is not None:
        wide = lasts["backlash_arcmin"] > asked.backlash * _ARCMIN
        fails["backlash"] = (drawn.continuous, wide)
    if asked.stiffness is not None:
        soft = lasts["stiffness_Nm_per_arcmin"] < asked.stiffness / _ARCMIN
        fails["stiffness"] = (drawn.continuous, soft)
        if drawn.warm is not None:
            soft = drawn.warm.columns["stiffness_Nm_per_arcmin"] < asked.stiffness / _ARCMIN
            fails[SOFT] = (drawn.warm, soft)
    if drawn.warm is not None:
        fails[TIGHT] = (drawn.warm, drawn.warm.columns["unloaded_torque_Nm"] > most)
    for check, share in used(allowed, drawn).items():
        at_peak = check in {"CONTACT-RING-PEAK", "BEARING-STATIC"}
        fails[_WORDS[check]] = (drawn.peak if at_peak else drawn.continuous, share > 1.0)
    good = functools.reduce(np.intersect1d, [one.numbers for one in drawn.every])
    for ensemble, beyond in fails.values():
        good = np.setdiff1d(good, ensemble.numbers[beyond])
    return good, {name: int(beyond.sum()) for name, (_, beyond) in fails.items()}


def drawn_cam_hours(machine: Machine, drawn: Drawn | None, lines: Sequence[Check]) -> float | None:
    """Hours that the cam bearings of the share that has to be good (`yield_share`) last at least.

    By their greatest load over the turn against that of perfect parts; None where that is not
    known.
    """
    allowed = (
        Allowed.of(machine, lines) if drawn is not None and len(drawn.continuous.values) else None
    )
    if drawn is None or allowed is None:
        return None
    load = used(allowed, drawn)["BEARING-LIFE"]
    worst = float(np.quantile(load, machine.design.requirements.yield_share))
    return float(machine.life.required_hours / worst**machine.analysis.cam_bearing.exponent)


def yield_line(machine: Machine, drawn: Drawn | None, why: str, lines: Sequence[Check]) -> Check:
    """The line ``YIELD``; `why` says why nothing was drawn."""
    limit = 100.0 * machine.design.requirements.yield_share
    cure = "see what is not known of pressure and cam load"
    if drawn is None:
        return build_check("YIELD", None, limit, why, "see why none could be drawn")
    solved = min(len(one.values) for one in drawn.every)
    found = good_gearboxes(machine, drawn, lines) if solved else None
    if found is None:
        return build_check("YIELD", None, limit, "limits of drawn gearboxes are not known", cure)
    good, fails = found
    count = len(drawn.continuous.values) + drawn.continuous.lost
    told = [f"{number} {name}" for name, number in fails.items() if number]
    told += [
        f"{one.lost} jam at {one.ensemble.torque:g} N*m" + (_LEAST if one is drawn.warm else "")
        for one in drawn.every
        if one.lost
    ]
    if drawn.warm is not None:
        parts = drawn.warm.ensemble.temperatures
        told.append(
            f"least clearance with discs at {parts.disc:g} degC and carrier at {parts.carrier:g} "
            "degC"
        )
    worst = max(fails, key=lambda name: fails[name])
    cases = machine.design.requirements.load_cases
    less = {
        "life": f"{'a gentler duty' if cases else 'less continuous torque'}, or a shorter life",
        "peak": "less peak torque",
    }
    last = worst.rpartition(" ")[2]
    return build_check(
        "YIELD",
        100.0 * len(good) / count,
        limit,
        f"{len(good)} of {count} gearboxes" + (f"; {', '.join(told)}" if told else ""),
        _CURES[worst.partition(" ")[0]] + (f"; or ask for {less[last]}" if last in less else ""),
    )


_CURES = {
    "bind": "give modification.equidistant and hole_clearance some um more, or closer [tolerances]",
    "ring": "closer [tolerances] of teeth and profile, or more reserve of pressure (thicker discs, "
    "harder material)",
    "cam": "closer [tolerances], more clearance, or a larger cam bearing where it has room",
    "backlash": "smaller clearances with closer [tolerances]",
    "stiffness": "smaller clearances, or thicker or more output_pins",
}
