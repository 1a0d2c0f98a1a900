"""Pendulum data of a design's actuator, generated and written."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cqdd_design.actuator.recording import require_pyarrow
from cqdd_design.actuator.specimen import AS_DRAWN, Specimen
from cqdd_design.design import Design
from cqdd_design.environment import output_folder
from cqdd_design.files import WrittenFile, refuse_overwrite
from cqdd_design.roads.telling import silent
from cqdd_design.torque.data.episodes import write_data
from cqdd_design.torque.data.generate import Request, Tell, describe
from cqdd_design.torque.data.generate import generate as run


@dataclass(frozen=True)
class GeneratedData:
    """A data set on disk.

    Attributes
    ----------
    folder : Path
        Where it lies.
    files : tuple of WrittenFile
        Episodes, and the manifest last.
    facts : mapping
        What is in it (``results`` of ``torque generate``).
    warnings : tuple of str
        What cannot be relied on.
    """

    folder: Path
    files: tuple[WrittenFile, ...]
    facts: Mapping[str, Any]
    warnings: tuple[str, ...]


def generate(
    design: Design,
    request: Request,
    folder: Path | None = None,
    *,
    specimen: Specimen = AS_DRAWN,
    force: bool = False,
    tell: Tell = silent,
    progress: Callable[[int, int], None] | None = None,
) -> GeneratedData:
    """Generate pendulum data on the simulated actuator, as Parquet with a JSON manifest.

    Parameters
    ----------
    design : Design
    request : Request
        What to generate.
    folder : Path, optional
        Where to; default ``exports/NAME-torque``, whose files are this function's own.
    specimen : Specimen
        Which actuator is meant.
    force : bool
        Replace existing files in a named folder.
    tell, progress : callable
        Told what begins, and how many episodes are done of how many.

    Raises
    ------
    DependencyError
        Without pyarrow.
    UsageError
        When the folder holds data and `force` is not set, or cannot be written.
    """
    require_pyarrow()
    if folder is not None:
        refuse_overwrite(folder / "manifest.json", force=force)
    data, warnings = run(
        specimen.machine(design), request, specimen=specimen, tell=tell, progress=progress
    )
    target = folder or output_folder("exports") / f"{design.file_name}-torque"
    files = write_data(data, target, force=force or folder is None)
    facts = describe(data)
    told = _limits_met(facts)
    if told:
        warnings = (*warnings, told)
    facts |= {key: data.facts[key] for key in ("infeasible", "beyond_gearbox")}
    return GeneratedData(target, files, facts, warnings)


def _limits_met(facts: Mapping[str, Any]) -> str:
    """A sentence on targets that no drive can follow, and on drives that saturate; else empty."""
    told = []
    if facts["episodes_infeasible"]:
        of = f"{facts['episodes_infeasible']} of {facts['episodes']} targets"
        told.append(f"{of} cannot be followed exactly by this actuator")
    if facts["episodes_saturated"]:
        of = f"{facts['episodes_saturated']} of {facts['episodes']} episodes"
        what = "it" if told else "the drive"
        told.append(f"{of} saturate {what}, {facts['saturated_share']:.1%} of all samples")
    return f"{', and '.join(told)}; they are kept and flagged." if told else ""
