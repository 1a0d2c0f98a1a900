"""Everything the checks read, in one frozen value, and how one check is put together."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from cqdd_design.catalog.motors import Motor
from cqdd_design.design import Design
from cqdd_design.gearbox.balance import StackBalance
from cqdd_design.gearbox.cam_bearing import BearingResult
from cqdd_design.gearbox.checks.guide import CHECK_GUIDE
from cqdd_design.gearbox.geometry_summary import GeometrySummary
from cqdd_design.gearbox.loads import RigidMaxima
from cqdd_design.gearbox.pin_strength import PinStrength
from cqdd_design.gearbox.stages import Stages
from cqdd_design.results import Check


@dataclass(frozen=True)
class GearboxState:
    """What the checks judge.

    Attributes
    ----------
    rigid_peak, rigid_continuous : RigidMaxima
        Raw maxima at the peak and at the continuous torque of the requirements.
    output_pins : PinStrength
        At the same torques.
    sleeves, rollers : BearingResult or None
        Needle cage of one sleeve on an output pin, and of one roller on a ring pin.
    balance : StackBalance
        Of everything that goes round with the crank, at the required input speed.
    """

    design: Design
    motor: Motor
    stages: Stages
    geometry: GeometrySummary
    rigid_peak: RigidMaxima
    rigid_continuous: RigidMaxima
    output_pins: PinStrength
    cam_bearing: BearingResult
    sleeves: BearingResult | None
    rollers: BearingResult | None
    balance: StackBalance


def build_check(
    check_id: str,
    value: float | None,
    limit: float | None,
    substituted: str,
    remedy: str,
    *,
    severity: Literal["fail", "warn"] | None = None,
    basis: str = "",
    model: str = "",
) -> Check:
    """One check from its guide and this design's numbers.

    Parameters
    ----------
    check_id : str
        Key of the guide.
    value, limit : float or None
        In the guide's unit; None where not known, for reasons that `substituted` gives.
    substituted : str
        The rule with numbers.
    remedy : str
        What would make it pass; shown only where it does not.
    severity : {"fail", "warn"}, optional
        Overrides the guide's.
    basis : str
        Origin of a limit that depends on a material; joins the source.
    model : str
        What the value comes from; default what the guide says.
    """
    guide = CHECK_GUIDE[check_id]
    check = Check(
        id=check_id,
        title=guide.title,
        value=value,
        limit=limit,
        unit=guide.unit,
        sense=guide.sense,
        formula=guide.formula,
        substituted=substituted,
        why=guide.why,
        remedy=remedy,
        source=f"{guide.source}; limit: {basis}" if basis else guide.source,
        severity=severity or guide.severity,
        basis=model or guide.basis,
    )
    if not check.satisfied:
        return check
    return replace(check, remedy="met; nothing to change")
