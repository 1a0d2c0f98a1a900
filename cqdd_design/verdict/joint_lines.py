"""Lines of the joints that carry the torque: dowels."""

from __future__ import annotations

from cqdd_design.errors import CatalogError, ContactError, GeometryError
from cqdd_design.gearbox.checks.allowables import Allowable, dowel_limit_shear
from cqdd_design.gearbox.checks.remedies import lower_torque
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.machine import Machine
from cqdd_design.machine.dowels import LoadedDowels, loaded_dowels
from cqdd_design.results import Check

_MEGA = 1e6
_DOWELS = ("DOWEL-SHEAR", "DOWEL-BEARING")


def joint_lines(machine: Machine) -> tuple[Check, ...]:
    """Dowels of ring and output at the peak torque."""
    try:
        found = loaded_dowels(machine)
        lacking = _lacking(machine)
    except (CatalogError, ContactError, GeometryError) as error:
        return tuple(
            build_check(one, None, None, error.message, "see why it is not known")
            for one in _DOWELS
        )
    if lacking:
        remedy = "raise ring.outer_diameter, or lower output_pins.diameter"
        return tuple(build_check(one, None, None, lacking, remedy) for one in _DOWELS)
    torque = machine.design.requirements.peak_torque
    shear, press = (
        [(one, one.stress.shear, dowel_limit_shear()) for one in found],
        [(one, one.stress.pressure, one.seat) for one in found],
    )
    return (
        _dowel("DOWEL-SHEAR", shear, torque, "larger dowels ask for a thicker ring"),
        _dowel("DOWEL-BEARING", press, torque, "take a stronger housing.material or a larger ring"),
    )


def _lacking(machine: Machine) -> str:
    """What has no dowel, in words."""
    layout = machine.layout
    if not layout.dowels.radius:
        return "no dowel goes between the ring and its seat: nothing but the clamp holds it"
    if not layout.carrier.flange_dowels.count:
        return "no dowel goes into the output's face between the pins and the shaft's bearing"
    return ""


def _dowel(
    name: str, every: list[tuple[LoadedDowels, float, Allowable]], torque: float, cure: str
) -> Check:
    """The line of the dowels with least reserve, the others beside it."""
    told = "; ".join(
        f"{one.place}: {one.size}, {value / _MEGA:.3g} of {limit.value / _MEGA:.3g} MPa under "
        f"{one.torque:.4g} N*m"
        for one, value, limit in every
    )
    _, value, limit = min(every, key=lambda row: row[2].value / row[1])
    return build_check(
        name,
        value / _MEGA,
        limit.value / _MEGA if limit.value else None,
        told,
        f"{cure}; or {lower_torque(torque, limit.value / value)}",
        basis=limit.basis,
    )
