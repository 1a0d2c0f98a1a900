"""The greatest peak torque that a machine stands, by the models that judge its lines.

External loads, the rotor's pull and preloads stay where the torque is less, and fewer teeth share
it: no line is in proportion to the torque.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace

from cqdd_design.errors import CatalogError, DesignError
from cqdd_design.gearbox.checks.bodies import body_checks
from cqdd_design.gearbox.checks.equilibrium import PeakLoads, peak_checks
from cqdd_design.machine import Machine
from cqdd_design.machine.body_analysis import stress_under
from cqdd_design.machine.carrying import LIMITS
from cqdd_design.machine.cures import ROUGHLY, torques_that_hold
from cqdd_design.results import Check
from cqdd_design.verdict.cam_line import CAM_JOINT, cam_at
from cqdd_design.verdict.evidence import Evidence
from cqdd_design.verdict.joint_lines import DOWELS, dowels
from cqdd_design.verdict.screw_lines import slips
from cqdd_design.verdict.shaft_lines import AT_PEAK, shaft_at_peak

_BODIES = ("LIGAMENT-STRESS", "ROOT-STRESS", "RING-STRESS")
_RUNNERS = ("SLEEVE-STATIC", "ROLLER-STATIC", "RING-PIN-BENDING-PEAK")
PEAK_LINES = (*AT_PEAK, *DOWELS, "SCREW-SLIP", CAM_JOINT, *_RUNNERS, *_BODIES)
"""Lines at the peak torque beside those of `LIMITS` and of the motor."""
_SURE = 2.0
"""Margin by proportion from which the stress of bodies, which takes long, is not looked at."""


Lines = tuple[Check, ...]


def standing_torque(
    evidence: Evidence, lines: Sequence[Check], most: float
) -> tuple[float, str] | None:
    """The greatest peak torque, N m, up to `most`, at which `PEAK_LINES` hold, and what gives way.

    Parameters
    ----------
    lines : sequence of Check
        Of the verdict.
    most : float
        N m, where the gearbox has an equilibrium.

    Returns
    -------
    float, str
        None where all hold there that are known.
    """
    machine = evidence.machine
    asked = machine.design.requirements.peak_torque
    known = {line.id: line for line in lines if line.known and line.id in PEAK_LINES}
    if not known:
        return None

    def quick(torque: float) -> Iterator[Check]:
        for chapter in (_gearbox, shaft, dowels, slips, bonded):
            with suppress(CatalogError, DesignError):
                loaded = machine.loaded(torque)
                yield from (one for one in chapter(loaded) if one.id in known)

    def bonded(loaded: Machine) -> Lines:
        return cam_at(loaded, evidence.temperatures)

    def shaft(loaded: Machine) -> Lines:
        return shaft_at_peak(loaded, machine.life.pack)

    found = _most(lambda torque: tuple(quick(torque)), asked, most)
    reached = most if found is None else found[0]
    bodies = [known[name] for name in _BODIES if name in known]
    if any(line.margin * asked < _SURE * reached for line in bodies):
        weaker = _most(lambda torque: _bodies(machine, torque, known), asked, reached)
        found = weaker or found
    return found


def _most(
    lines_at: Callable[[float], Lines], least: float, most: float
) -> tuple[float, str] | None:
    """The greatest torque up to `most` at which all lines hold, and the first beyond it.

    At `least` there are lines, if anywhere.
    """

    def weakest(torque: float) -> Lines:
        every = [one for one in lines_at(torque) if one.known]
        worst = min(every, key=lambda one: one.margin, default=None)
        return () if worst is None else (replace(worst, id="WEAKEST"),)

    now = weakest(most)
    if now and now[0].margin >= 1.0:
        return None
    # Beyond the end of the equilibrium there are no lines.
    start, now = (most, now) if now else (least, weakest(least))
    if not now:
        return None
    (torque,) = torques_that_hold(weakest, start, now, every=True, near=ROUGHLY).values()
    there = weakest(torque)[0] if torque else now[0]
    return torque, f"{there.title}{'' if torque else ', at no torque'}: {there.basis}"


def _gearbox(loaded: Machine) -> Lines:
    torque = loaded.design.requirements.peak_torque
    loads = PeakLoads.of(torque, loaded.loaded_contacts.greatest(torque))
    return tuple(one for one in peak_checks(loaded.analysis, loads) if one.id not in LIMITS)


def _bodies(machine: Machine, torque: float, known: Mapping[str, Check]) -> Lines:
    lowered = machine.under(peak=torque)
    checks = body_checks(lowered.design, stress_under(lowered))
    return tuple(one for one in checks if one.id in known and one.id in _BODIES)
