"""Toleranced gearboxes of a design over a whole output turn, here or on a cluster."""

from __future__ import annotations

from cqdd_design.design import Design
from cqdd_design.gearbox.heat.expansion import AS_DRAWN, PartTemperatures
from cqdd_design.gearbox.tolerance.ensemble import make_ensemble
from cqdd_design.gearbox.tolerance.run import Progress, ToleranceResult, run_ensemble
from cqdd_design.geometry.validate import validate_geometry
from cqdd_design.machine import resolve


def tolerance(
    design: Design,
    *,
    samples: int = 1000,
    torque: float | None = None,
    angles: int | None = None,
    seed: int = 0,
    temperature: float | None = None,
    scheduler: str | None = None,
    progress: Progress | None = None,
) -> ToleranceResult:
    """Draw gearboxes from the tolerances of a design and solve them.

    Parameters
    ----------
    design : Design
    samples : int
        Gearboxes.
    torque : float, optional
        At the output, N m; default the continuous one.
    angles : int, optional
        Crank angles over the output turn; default about 1000, two to eight a tooth.
    seed : int
        Of the draws.
    temperature : float, optional
        Of all parts, deg C; default 20, at which dimensions hold.
    scheduler : str, optional
        Address of the Dask scheduler to work on, such as ``tcp://HOST:8786``; default this machine.
    progress : callable, optional
        Told how many gearboxes are solved, and of how many.

    Raises
    ------
    GeometryError
        When holes of the discs break out, columns' too.
    DesignError
        When the thermal expansion of a part is not known.
    UsageError
        For a temperature outside the range that is worked with, when the angles do not fit into
        memory, or no scheduler answers.
    """
    parts = AS_DRAWN if temperature is None else PartTemperatures.even(temperature)
    machine = resolve(design)
    validate_geometry(machine.design, bore_diameter=machine.cam.outer_diameter)
    ensemble = make_ensemble(
        machine.design, torque=torque, angles=angles, seed=seed, temperatures=parts
    )
    if scheduler is None:
        return run_ensemble(ensemble, samples, progress=progress)
    from cqdd_design.sizing.distributed import dask_client, on_cluster

    with dask_client(scheduler) as client:
        return run_ensemble(ensemble, samples, mapper=on_cluster(client), progress=progress)
