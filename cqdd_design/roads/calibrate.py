"""Fit what no drawing tells of a design's actuator to measured rows, and predict the others."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from cqdd_design.actuator.bench.calibrate import Calibration, chosen
from cqdd_design.actuator.bench.calibrate import calibrate as fit
from cqdd_design.actuator.bench.run import VOLTAGE
from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.specimen import AS_DRAWN, Specimen
from cqdd_design.catalog.paper import METRICS, is_papers_actuator
from cqdd_design.design import Design
from cqdd_design.errors import UsageError
from cqdd_design.machine.carrying import carried_torque
from cqdd_design.roads.bench import drawn_actuators
from cqdd_design.roads.telling import Progress, silent

#: The rows that the unknowns of the paper's actuator are fitted to: its cooling and its cogging.
#: With the motor's measured drag no friction of a gearbox, not even none, gives its efficiency.
PAPER_ROWS = ("continuous_torque", "backdrive_static")


def calibrate(
    design: Design,
    measured: Mapping[str, float] | None = None,
    specimen: Specimen = AS_DRAWN,
    *,
    to: tuple[str, ...] = (),
    unknowns: tuple[str, ...] = (),
    voltage: float | None = None,
    rig_stiffness: float | None = None,
    progress: Progress = silent,
) -> Calibration:
    """Fit what no drawing tells of a design's actuator to measured rows, and predict the others.

    Parameters
    ----------
    measured : mapping of str to float, optional
        Measurements in the bench's units; default the paper's, of its own actuator only, fitted
        to continuous torque and static backdrive torque.
    specimen : Specimen
        Its motor and its gearbox.
    to, unknowns : tuple of str
        Rows to fit to, and what to fit; see `actuator.bench.calibrate.calibrate`.
    voltage : float, optional
        Supply of the dynamic rows, V; default the paper's 24 V.
    rig_stiffness : float, optional
        Of what holds the output, N m/rad; see `run_bench`.
    progress : callable
        Told what begins.

    Raises
    ------
    UsageError
        Without measured rows for a design that is not the paper's, and as `calibrate` says.
    """
    if measured is None:
        if not is_papers_actuator(design):
            raise UsageError(
                f"there are no measured values of {design.name}; give them with --measured FILE "
                "(columns name,value,unit)."
            )
        measured = {name: figure.value for name, figure in METRICS.items()}
        to = to or PAPER_ROWS
    # A wrong name is refused before anything is built.
    chosen(measured, to, unknowns, rig_known=rig_stiffness is not None)
    machine = specimen.machine(design)
    drawn, told = ([], ()) if specimen.seed is not None else drawn_actuators(machine, specimen)
    found = fit(
        actuator_parameters(machine, specimen),
        measured,
        to=to,
        unknowns=unknowns,
        voltage=VOLTAGE if voltage is None else voltage,
        rated_current=machine.motor.rated_current,
        drawn=drawn,
        gearbox=carried_torque(machine),
        rig_stiffness=rig_stiffness,
        progress=progress,
    )
    after = replace(found.after, warnings=(*found.after.warnings, *told))
    return replace(found, after=after)
