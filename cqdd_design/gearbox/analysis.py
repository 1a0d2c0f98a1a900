"""One call from a design to its geometry, rigid-law loads, strengths, ratings and checks."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cqdd_design.catalog.lubricants import RUNNING_TEMPERATURE, find_lubricant
from cqdd_design.catalog.motors import Motor
from cqdd_design.design import Design
from cqdd_design.gearbox.balance import StackBalance
from cqdd_design.gearbox.cam_bearing import cam_bearing
from cqdd_design.gearbox.checks.allowables import HARDENED_HRC
from cqdd_design.gearbox.checks.drive import drive_checks
from cqdd_design.gearbox.checks.loads import load_checks
from cqdd_design.gearbox.checks.runners import runner_checks
from cqdd_design.gearbox.checks.shape import shape_checks
from cqdd_design.gearbox.checks.state import GearboxState
from cqdd_design.gearbox.geometry_summary import summarise_geometry
from cqdd_design.gearbox.loads import RigidMaxima, RigidSeries, rigid_maxima, rigid_series
from cqdd_design.gearbox.pin_strength import pin_strength
from cqdd_design.gearbox.runner_needles import roller_needles, sleeve_needles
from cqdd_design.gearbox.stages import Stages
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.validate import validate_geometry
from cqdd_design.results import Check

DEFAULT_ANGLES = 360
"""Points of the curves over one crank turn."""


@dataclass(frozen=True)
class GearboxAnalysis(GearboxState):
    """What closed forms say about a gearbox; complete when it exists.

    Attributes
    ----------
    rigid : RigidMaxima
        Raw maxima at the peak torque, or at the one asked for.
    series : RigidSeries
        Curves over one crank turn at the torque of `rigid`, acting on the carrier.
    checks : tuple of Check
        At the torques of the requirements.
    warnings : tuple of str
        What could not be checked, and why.
    """

    rigid: RigidMaxima
    series: RigidSeries
    checks: tuple[Check, ...]
    warnings: tuple[str, ...]

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form: ``geometry``, ``rigid``, ``output_pins``, ``bearings`` and more."""
        return {
            "geometry": self.geometry.to_dict(),
            "rigid": self.rigid.to_dict(),
            "rigid_continuous": self.rigid_continuous.to_dict(),
            "rigid_series": self.series.to_dict(),
            "output_pins": self.output_pins.to_dict(),
            "bearings": {
                "cam": self.cam_bearing.to_dict(),
                **({} if self.sleeves is None else {"sleeves": self.sleeves.to_dict()}),
                **({} if self.rollers is None else {"rollers": self.rollers.to_dict()}),
            },
            "balance": self.balance.to_dict(),
        }


def analyse_gearbox(
    design: Design,
    motor: Motor,
    balance: StackBalance,
    *,
    torque: float | None = None,
    angles: int = DEFAULT_ANGLES,
) -> GearboxAnalysis:
    """Analyse a design by closed forms: no contact equilibrium, no meshes.

    Parameters
    ----------
    design : Design
        With a named cam bearing.
    motor : Motor
        Which the checks judge.
    balance : StackBalance
        Of the crank with all that turns with it, at the required input speed.
    torque : float, optional
        Output torque of `rigid` and `series`, N m; the required peak torque where left out.
        Pins, bearing and checks always use the torques of the requirements.
    angles : int
        Points of the curves over one crank turn, at least 8. Maxima do not depend on it.

    Raises
    ------
    GeometryError
        When disc, ring or holes cannot exist.
    """
    requirements = design.requirements
    CycloidDisc.from_design(design)
    stages = Stages.from_design(design)
    peak = rigid_maxima(stages, requirements.peak_torque)
    continuous = peak.at(requirements.continuous_torque)
    cam = cam_bearing(design, peak.cam_bearing_load)
    bearing = cam.bearing
    validate_geometry(design, bore_diameter=bearing.outer_diameter)
    geometry = summarise_geometry(design, bearing)
    state = GearboxState(
        design=design,
        motor=motor,
        stages=stages,
        geometry=geometry,
        rigid_peak=peak,
        rigid_continuous=continuous,
        output_pins=pin_strength(design, peak, continuous),
        cam_bearing=cam,
        sleeves=sleeve_needles(design, peak, continuous),
        rollers=roller_needles(design, peak, continuous),
        balance=balance,
    )
    drive, warnings = drive_checks(state)
    shown = peak if torque is None else peak.at(torque)
    crank = 2.0 * np.pi * np.arange(max(angles, 8)) / max(angles, 8)
    return GearboxAnalysis(
        **vars(state),
        rigid=shown,
        # The rigid law's sense is the drive's; a torque on the carrier loads the other flanks.
        series=replace(rigid_series(stages, -shown.torque, crank), torque=shown.torque),
        checks=(*shape_checks(state), *load_checks(state), *runner_checks(state), *drive),
        warnings=(
            *_valley_warning(state),
            *_raceway_warning(state),
            *_cold_warning(design),
            *warnings,
        ),
    )


def _valley_warning(state: GearboxState) -> tuple[str, ...]:
    if state.geometry.has_concave_valleys:
        return ()
    return (
        "the disc has no concave valley (eccentricity too small for its lobes), so it has no "
        "least concave radius and its wire was not checked.",
    )


def _raceway_warning(state: GearboxState) -> tuple[str, ...]:
    """Needles run on the eccentric itself, whose material the design file does not name."""
    bearing = state.cam_bearing.bearing
    if bearing.kind not in {"needle", "needle cage"} or bearing.raceway_diameter is not None:
        return ()
    return (
        f"cam bearing '{bearing.designation}' runs on the eccentric itself: harden the shaft to "
        f"{HARDENED_HRC:g} HRC and grind it, or the ratings do not hold.",
    )


COLD_AIR = 10.0
"""Below which the lubricant is several times as thick as its losses count it, deg C."""


def _cold_warning(design: Design) -> tuple[str, ...]:
    """Air, and a start, in which the lubricant drags as no line judges it."""
    lubricant = find_lubricant(design.reducer.friction.lubricant)
    coldest, air = design.environment.coldest, design.environment.ambient
    told = []
    if lubricant.coldest <= air < COLD_AIR:
        thick = lubricant.viscosity_at(air) / lubricant.viscosity_at(RUNNING_TEMPERATURE)
        told.append(
            f"environment.ambient {air:g} degC: there the oil of {lubricant.name} is {thick:.0f} "
            f"times as thick as at {RUNNING_TEMPERATURE:g} degC, at which efficiency and the lines "
            "of the motor count it. Until it has warmed up the gearbox drags more, and less torque "
            f"and speed are reached; `analyse --temperature '{air:g} degC'` tells what it loses "
            "then."
        )
    if coldest < lubricant.coldest:
        told.append(
            f"environment.coldest {coldest:g} degC is below the {lubricant.coldest:g} degC down to "
            f"which {lubricant.name} works: how it drags there is judged by no line; choose "
            "another reducer.friction.lubricant, or warm the machine before it starts."
        )
    return tuple(told)
