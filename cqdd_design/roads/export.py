"""Files of a design for makers and simulators."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from cqdd_design.actuator.specimen import AS_DRAWN, Specimen
from cqdd_design.catalog.printing import printed_materials
from cqdd_design.design import Design
from cqdd_design.exporting import ExportOptions
from cqdd_design.exporting import export as write
from cqdd_design.exporting.kinds import KINDS, ExportKind, read_kinds
from cqdd_design.exporting.options import DEFAULTS
from cqdd_design.files import WrittenFile
from cqdd_design.machine.overload import overload
from cqdd_design.roads.telling import Progress, silent

_BY_WIRE = ("edm", "gcode")


def export(
    design: Design,
    kinds: str | Iterable[str],
    folder: Path | None = None,
    *,
    specimen: Specimen = AS_DRAWN,
    force: bool = False,
    options: ExportOptions = DEFAULTS,
    progress: Progress = silent,
) -> tuple[WrittenFile, ...]:
    """Write the files of a design; see `exporting.export`."""
    machine = specimen.machine(design)
    with _kernels_beside(kinds) as before:
        return write(
            machine,
            kinds,
            folder,
            force=force,
            progress=progress,
            before=before,
            options=options,
            specimen=specimen,
        )


@contextmanager
def _kernels_beside(kinds: str | Iterable[str]) -> Iterator[Callable[[ExportKind], None] | None]:
    """Compile on the first use what simulators' files call, while makers' are written."""
    if not any(_simulates(KINDS[kind]) for kind in read_kinds(kinds)):
        yield None
        return
    from cqdd_design.roads.kernels import compiling, missing

    kernels = missing(simulation=True)
    if not kernels:
        yield None
        return
    with compiling(kernels) as wait:
        yield lambda kind: wait() if _simulates(kind) else None


def _simulates(kind: ExportKind) -> bool:
    return kind.reader == "simulators"


def left_out(
    design: Design, kinds: str | Iterable[str], *, specimen: Specimen = AS_DRAWN
) -> tuple[str, ...]:
    """Sentences on what files do not show, as a motor that cannot be drawn, or do not make.

    And on what simulators are allowed that the gearbox does not carry.
    """
    return (
        *_undrawn(design, kinds, specimen),
        *_uncut(design, kinds),
        *_not_carried(design, kinds, specimen),
    )


def _undrawn(design: Design, kinds: str | Iterable[str], specimen: Specimen) -> tuple[str, ...]:
    solid = [kind for kind in read_kinds(kinds) if KINDS[kind].needs_solids]
    if not solid:
        return ()
    missing = specimen.machine(design).layout.motor_missing
    if not missing:
        return ()
    return (
        f"the motor is not drawn: {missing}. Its stator, rotor, bell and cover and the encoder are "
        f"not in {', '.join(solid)}.",
    )


def _not_carried(design: Design, kinds: str | Iterable[str], specimen: Specimen) -> tuple[str, ...]:
    """Of the effort that simulators' files allow, which is what motor and drive give."""
    simulated = [kind for kind in read_kinds(kinds) if _simulates(KINDS[kind])]
    if not simulated:
        return ()
    from cqdd_design.actuator.build import actuator_parameters
    from cqdd_design.exporting.simulators.stated import effort_limit, overload_remark

    machine = specimen.machine(design)
    most = effort_limit(actuator_parameters(machine, specimen))
    told = overload_remark(overload(machine, most))
    return (f"{', '.join(simulated)}: {told[0].lower()}{told[1:]}",) if told else ()


def _uncut(design: Design, kinds: str | Iterable[str]) -> tuple[str, ...]:
    """Plastics among what a wire is to cut."""
    cut = [kind for kind in read_kinds(kinds) if kind in _BY_WIRE]
    reducer = design.reducer
    plastic = [
        f"{part} ({material})"
        for part, material in (("discs", reducer.disc_material), ("ring", reducer.ring_material))
        if material in printed_materials()
    ]
    if not (cut and plastic):
        return ()
    return (
        f"{', '.join(cut)}: no wire cuts {' and '.join(plastic)}, which do not conduct; what is "
        "printed or moulded is in --to print.",
    )
