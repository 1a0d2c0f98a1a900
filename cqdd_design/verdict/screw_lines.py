"""Lines of the screwed joints: slip, preload, threads, keys."""

from __future__ import annotations

from dataclasses import replace

from cqdd_design.catalog.tightening import TIGHTENED, torque_words
from cqdd_design.design.requirements import EXTERNAL_LOADS
from cqdd_design.errors import CatalogError, ContactError, GeometryError
from cqdd_design.gearbox.checks.allowables import SLIP_SAFETY, THREAD_SAFETY, screw_limit
from cqdd_design.gearbox.checks.guide_row import NETWORK
from cqdd_design.gearbox.checks.remedies import lower_outside, lower_peak
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.machine import Machine
from cqdd_design.machine.cures import ROUGHLY, torques_that_hold
from cqdd_design.machine.heat_nodes import Node
from cqdd_design.machine.screws import ScrewJoint, screw_joints
from cqdd_design.machine.temperatures import MachineTemperatures
from cqdd_design.results import Check

_MEGA = 1e6
_ENDLESS = 1e3
"""Safety of a joint that nothing parts."""
_CLAMPED: tuple[Node, ...] = ("cover", "housing", "ring", "carrier")
"""What screws hold together: the warmest counts."""
_LINES = ("SCREW-SLIP", "SCREW-PRELOAD", "SCREW-THREAD")


def screw_lines(
    machine: Machine, temperatures: MachineTemperatures | None = None
) -> tuple[Check, ...]:
    """Every screwed joint at the peak torque and the external loads of the requirements.

    Parameters
    ----------
    temperatures : MachineTemperatures, optional
        Where they are not known, screws are judged as they are tightened.
    """
    warm = TIGHTENED if temperatures is None else max(map(temperatures.hottest, _CLAMPED))
    return (*_loaded(machine, warm), _tools(machine))


def _loaded(machine: Machine, warm: float) -> tuple[Check, ...]:
    try:
        every = screw_joints(machine)
    except (CatalogError, ContactError, GeometryError) as error:
        return tuple(
            build_check(one, None, None, error.message, "see why it is not known") for one in _LINES
        )
    return (_cured(machine, _slip(every)), _preload(every, warm), _thread(every))


def _cured(machine: Machine, slip: Check) -> Check:
    """With the peak torque and the external loads at which nothing slips, where there are."""
    asked = machine.design.requirements
    cures = torques_that_hold(
        lambda torque: slips(machine.under(peak=torque)),
        asked.peak_torque,
        (slip,),
        near=ROUGHLY,
    )
    said, torque = [slip.remedy], cures.get(slip.id, 0.0)
    if torque:
        said.append(lower_peak(torque, asked.continuous_torque))
    if not machine.stiff and any(getattr(asked, key) for key in EXTERNAL_LOADS):
        shares = torques_that_hold(
            lambda share: (_slip(screw_joints(machine.under_outside(share))),),
            1.0,
            (slip,),
            near=ROUGHLY,
        )
        if shares.get(slip.id):
            said.append(lower_outside(asked, shares[slip.id]))
    return replace(slip, remedy="; or ".join(said))


def slips(machine: Machine) -> tuple[Check]:
    """SCREW-SLIP at the peak torque; errors as of `screw_joints`."""
    return (_slip(screw_joints(machine)),)


def _slip(every: tuple[ScrewJoint, ...]) -> Check:
    loaded = [one for one in every if one.across > 0.0 or one.along > 0.0]
    worst = min(loaded, key=lambda one: one.slip_safety)
    told = "; ".join(
        f"{one.place}: {one.count} x {one.clamping.least_preload:.0f} N left, {one.across:.0f} N "
        f"across and {one.along:.0f} N along each, safety {min(one.slip_safety, _ENDLESS):.3g}"
        for one in loaded
    )
    return build_check(
        "SCREW-SLIP",
        min(worst.slip_safety, _ENDLESS),
        SLIP_SAFETY,
        told,
        f"{worst.place}: {worst.cure}",
    )


def _preload(every: tuple[ScrewJoint, ...], warm: float) -> Check:
    """As they are tightened, and where joints are warm, whichever is nearer to its limit."""
    tight = [(one.clamping.stress, screw_limit(one.clamping.screw), one) for one in every]
    used = [
        (one.clamping.working_stress(warm), screw_limit(one.clamping.screw, 1.0), one)
        for one in every
    ]
    stress, allowed, worst = max((*tight, *used), key=lambda row: row[0] / max(row[1].value, 1.0))
    hottest = (stress, allowed, worst) in used
    told = "; ".join(
        f"{one.place}: {one.count} {one.screw} at {_torque(one)}, {one.clamping.preload:.0f} N"
        for one in ((worst,) if hottest else every)
    )
    return build_check(
        "SCREW-PRELOAD",
        stress / _MEGA,
        allowed.value / _MEGA if allowed.value else None,
        f"{told}, in use at {warm:.0f} degC" if hottest else told,
        _COOLER if hottest else "take screws of a known strength",
        basis=allowed.basis,
        model=NETWORK if hottest else "",
    )


_COOLER = (
    "keep the joint cooler, see THERMAL-RISE, or take a metal that grows less under the screws"
)


def _torque(one: ScrewJoint) -> str:
    """That is stated for it, in words."""
    torque = one.clamping.torque
    return f"{torque_words(torque)} N*m" if torque > 0.0 else "no torque"


def _thread(every: tuple[ScrewJoint, ...]) -> Check:
    judged = [(one, safe) for one in every if (safe := one.stripping_safety) is not None]
    worst, least = min(judged, key=lambda row: row[1])
    told = "; ".join(
        f"{one.place}: {1e3 * one.clamping.engaged:.3g} mm in thread, safety {safe:.3g}"
        for one, safe in judged
    )
    return build_check(
        "SCREW-THREAD",
        least,
        THREAD_SAFETY,
        told,
        f"{worst.place}: take a housing.material of known strength",
    )


def _tools(machine: Machine) -> Check:
    """Whether keys reach the screws in the order in which the machine is put together."""
    try:
        found, whole = machine.tool_access
    except (CatalogError, GeometryError) as error:
        return build_check("SCREW-TOOL-ACCESS", None, 0.0, error.message, "see why there is none")
    lacking = [one for one in found if not one.reaches]
    told = "; ".join(one.told for one in lacking or found)
    if not whole:
        told = f"there is no order in which every part reaches its place; {told}"
    return build_check(
        "SCREW-TOOL-ACCESS",
        float(len(lacking) + (not whole)),
        0.0,
        told,
        f"move the {lacking[0].screw}s out from under the {lacking[0].blocked_by[0]}"
        if lacking and lacking[0].blocked_by
        else "take a longer key than the standard's, or a wider opening",
    )
