"""Lines of the motor's rotor on the shaft's stub: its air gap, and the stub under its pull."""

from __future__ import annotations

import math

from cqdd_design.errors import CatalogError, ContactError, DesignError, GeometryError
from cqdd_design.gearbox.checks.allowables import AIR_GAP_SHARE, shaft_limit_fatigue
from cqdd_design.gearbox.checks.equilibrium import DUTY_MODEL
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.machine import Machine
from cqdd_design.machine.rotor_overhang import (
    BUILT_OFF,
    RotorOverhang,
    rotor_overhang,
    stub_stress,
)
from cqdd_design.results import Check

_MEGA = 1e6
_GAP, _STUB = "SHAFT-ROTOR-GAP", "SHAFT-STUB"
_THICKER = (
    "a cam bearing with a larger bore brings a thicker stub in larger bearings; or take a motor "
    "that stands round the gearbox, whose rotor hangs less far out"
)


def rotor_lines(machine: Machine) -> tuple[Check, Check]:
    """How near the rotor comes to its stator, and what its pull adds at the stub's shoulder."""
    try:
        found = rotor_overhang(machine)
    except (CatalogError, DesignError, GeometryError) as error:
        return _unknown(_GAP, error.message), _unknown(_STUB, error.message)
    return _gap(found), _stub(machine, found)


def _unknown(name: str, why: str) -> Check:
    remedy = (
        "name a motor whose sizes are known; where bushes carry the shaft, a cam bearing with a "
        "larger bore leaves room for bearings"
    )
    return build_check(name, None, None, why, remedy)


def _gap(found: RotorOverhang) -> Check:
    still = found.settled
    built = (
        f"built {1e6 * found.off_centre:.3g} um off, a share of {BUILT_OFF:g} of its gap of "
        f"{1e3 * found.gap:.3g} mm; {found.mass:.3g} kg, {1e3 * found.arm:.3g} mm beyond the "
        "bearing's middle"
    )
    if math.isinf(still.deflection):
        return build_check(
            _GAP, 100.0, 100.0 * AIR_GAP_SHARE,
            f"the pull on the rotor grows faster than what carries it gives way: {built}", _THICKER,
        )  # fmt: skip
    taken = (found.off_centre + still.deflection) / found.gap
    return build_check(
        _GAP,
        100.0 * taken,
        100.0 * AIR_GAP_SHARE,
        f"{still.force:.0f} N of pull, weight and unbalance move it by "
        f"{1e6 * still.deflection:.3g} um; {built}",
        _THICKER,
    )


def _stub(machine: Machine, found: RotorOverhang) -> Check:
    if math.isinf(found.settled.force):
        return _unknown(_STUB, f"the rotor's pull is not held, see {_GAP}")
    try:
        stress = stub_stress(machine, machine.life.pack, found)
    except (CatalogError, ContactError, GeometryError) as error:
        return _unknown(_STUB, error.message)
    limit = shaft_limit_fatigue(stress.material, stress.diameter)
    return build_check(
        _STUB,
        (stress.lasting + stress.rotor) / _MEGA,
        limit.value / _MEGA if limit.value else None,
        f"{stress.lasting / _MEGA:.1f} MPa of the duty and {stress.rotor / _MEGA:.2f} MPa of "
        f"{found.settled.force:.0f} N on the rotor, at the shoulder of the lower bearing, of "
        f"{1e3 * stress.diameter:.3g} mm",
        _THICKER,
        basis=limit.basis,
        model=DUTY_MODEL,
    )
