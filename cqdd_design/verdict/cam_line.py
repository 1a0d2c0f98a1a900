"""Lines of a third disc's loose cam, which nothing but its bond keeps in its place."""

from __future__ import annotations

from cqdd_design.catalog.adhesives import ROTOR_COMPOUND
from cqdd_design.errors import CatalogError, ContactError, GeometryError
from cqdd_design.gearbox.checks.allowables import GREASE_MOST, bond_limit, shaft_limit_peak
from cqdd_design.gearbox.checks.remedies import lower_peak
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.machine import Machine
from cqdd_design.machine.cures import torques_that_hold
from cqdd_design.machine.loose_cam import LooseCam, loose_cam
from cqdd_design.machine.temperatures import MachineTemperatures
from cqdd_design.results import Check

CAM_JOINT, CAM_WALL = "CAM-JOINT", "SHAFT-CAM-WALL"
_MEGA = 1e6
_THICKER = "a cam bearing with a larger bore, or less eccentricity, leaves a thicker core and wall"
_SPARE = 0.985
"""Of a torque: at another peak torque losses are swept at other shares, and the bond is as warm to
a kelvin."""
_WIDER = "a cam bearing with a larger bore leaves a thicker core, a wider one a longer joint"


def cam_lines(machine: Machine, warm: MachineTemperatures | None) -> tuple[Check, ...]:
    """Bond and wall of the loose cam; none for a machine that has no such cam."""
    bond = cam_line(machine, warm)
    return () if bond is None else (_wall(machine), bond)


def _wall(machine: Machine) -> Check:
    """The thin side of the cam in its tightest fit, with its disc's force at the peak torque."""
    try:
        cam = loose_cam(machine)
        assert cam is not None
        pressed, push = cam.pressed(), cam.push(machine.peak_pack)
    except (CatalogError, ContactError, GeometryError) as error:
        return build_check(CAM_WALL, None, None, error.message, "see why it is not known")
    limit = shaft_limit_peak(cam.material)
    return build_check(
        CAM_WALL,
        pressed.mises(push) / _MEGA,
        limit.value / _MEGA,
        f"wall of {1e3 * cam.wall:.3g} mm round a core of {1e3 * cam.diameter:.4g} mm at "
        f"{1e6 * cam.most_interference:.0f} um, the most that its zones allow: "
        f"{pressed.hoop / _MEGA:.0f} MPa round it and {pressed.across / _MEGA:.0f} across, of the "
        f"disc's force {push / _MEGA:.1f} more; the lobe grows by {1e6 * pressed.growth:.1f} um "
        f"and is {1e6 * pressed.out_of_round:.1f} um out of round",
        _THICKER,
        basis=limit.basis,
    )


def cam_line(machine: Machine, warm: MachineTemperatures | None) -> Check | None:
    """The bond of the loose cam at the peak torque; None for a machine that has no such cam.

    The press fit is not counted: its zones may leave a play of 11 um.

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
    return build_check(
        CAM_JOINT,
        value / _MEGA,
        limit.value / _MEGA,
        f"{torque:.3g} N*m of the third disc's force on its cam at {peak:g} N*m, on a core of "
        f"{1e3 * cam.diameter:.4g} mm, bonded over {1e3 * cam.length:.3g} mm at {hot:.0f} degC"
        f"{guessed}: {value / _MEGA:.2f} MPa, over the duty {cam.shear(lasting) / _MEGA:.2f} MPa; "
        f"the press fit counts for nothing: its zones may leave {_least(cam)}",
        remedy,
        basis=limit.basis,
    )


def _least(cam: LooseCam) -> str:
    """The loosest fit in words."""
    least = 1e6 * cam.least_interference
    return f"{-least:.0f} um of play" if least < 0.0 else f"{least:.0f} um of interference"
