"""The line of a third disc's loose cam, which nothing but press fit and bond keeps in its place."""

from __future__ import annotations

from cqdd_design.catalog.adhesives import ROTOR_COMPOUND
from cqdd_design.errors import CatalogError, ContactError, GeometryError
from cqdd_design.gearbox.checks.allowables import GREASE_MOST, bond_limit
from cqdd_design.gearbox.checks.remedies import lower_peak
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.machine import Machine
from cqdd_design.machine.cures import torques_that_hold
from cqdd_design.machine.loose_cam import LooseCam, loose_cam
from cqdd_design.machine.temperatures import MachineTemperatures
from cqdd_design.results import Check

CAM_JOINT = "CAM-JOINT"
_MEGA = 1e6
_SPARE = 0.985
"""Of a torque: at another peak torque losses are swept at other shares, and the bond is as warm to
a kelvin."""
_WIDER = "a cam bearing with a larger bore leaves a thicker core, a wider one a longer joint"


def cam_line(machine: Machine, warm: MachineTemperatures | None) -> Check | None:
    """The bond of the loose cam at the peak torque; None for a machine that has no such cam.

    The press fit is not counted: its zones may leave no interference, or 1 um, which is less than
    what smoothing of ground faces takes (DIN 7190-1).

    Parameters
    ----------
    warm : MachineTemperatures or None
        Where they are not known, the bond is as warm as grease may be.
    """
    try:
        cam = loose_cam(machine)
        if cam is None:
            return None
        now = _judged(machine, cam, warm, machine.design.requirements.peak_torque)
    except (CatalogError, ContactError, GeometryError) as error:
        return build_check(CAM_JOINT, None, None, error.message, "see why it is not known")
    if now.status != "fail" or not now.limit:
        return now
    asked = machine.design.requirements
    peak, lasting = asked.peak_torque, asked.continuous_torque
    held = torques_that_hold(lambda at: (_judged(machine, cam, warm, at),), peak, (now,))
    less = lower_peak(_SPARE * held[CAM_JOINT], lasting)
    return _judged(machine, cam, warm, peak, f"{_WIDER}; or {less}")


def cam_at(machine: Machine, warm: MachineTemperatures | None) -> tuple[Check, ...]:
    """The line without a search for a cure; none without such a cam. Errors as of `loose_cam`."""
    cam, peak = loose_cam(machine), machine.design.requirements.peak_torque
    return () if cam is None else (_judged(machine, cam, warm, peak),)


def _judged(
    machine: Machine,
    cam: LooseCam,
    warm: MachineTemperatures | None,
    peak: float,
    remedy: str = _WIDER,
) -> Check:
    """The line at an output torque, N m; ContactError where that has no equilibrium."""
    asked = machine.design.requirements.peak_torque
    loads = machine.peak_pack if peak == asked else machine.pack_at(peak)
    hot, guessed = GREASE_MOST, " (not known, what grease bears)"
    if warm is not None:
        hot, guessed = warm.hottest("shaft"), ""
    limit = bond_limit(ROTOR_COMPOUND, cam.material, hot)
    if not limit.value:
        remedy = (
            f"cool it: no strength of {ROTOR_COMPOUND.name} is known beyond "
            f"{ROTOR_COMPOUND.hottest:g} degC"
        )
    torque, lasting = cam.torque(loads), cam.torque(machine.life.pack)
    value = cam.shear(torque)
    fit = max(cam.least_interference, 0.0)
    return build_check(
        CAM_JOINT,
        value / _MEGA,
        limit.value / _MEGA,
        f"{torque:.3g} N*m of the third disc's force on its cam at {peak:g} N*m, on a core of "
        f"{1e3 * cam.diameter:.4g} mm, bonded over {1e3 * cam.length:.3g} mm at {hot:.0f} degC"
        f"{guessed}: {value / _MEGA:.2f} MPa, over the duty {cam.shear(lasting) / _MEGA:.2f} MPa; "
        f"the press fit, of {1e6 * fit:.0f} um at least, counts for nothing",
        remedy,
        basis=limit.basis,
    )
