"""``cqdd-design export``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from cqdd_design.cli import completion
from cqdd_design.cli.options import Calibrated, Force, NamedMotor, OwnMotor, option, parse_positive
from cqdd_design.cli.session import Output, read_design, read_specimen
from cqdd_design.exporting.kinds import kinds_for, read_kinds, stages


def export(
    out: Output,
    design: Annotated[
        list[Path],
        typer.Argument(
            metavar="DESIGN...",
            help="Design files (TOML); several at once.",
            autocompletion=completion.designs,
        ),
    ],
    to: Annotated[
        str,
        option(
            "LIST",
            f"Kinds: {kinds_for('makers')}; {kinds_for('simulators')} for simulators.",
            autocompletion=completion.export_kinds,
        ),
    ] = "dxf,step",
    folder: Annotated[
        Path | None, option("DIR", "Where to; default exports/NAME.", "--out")
    ] = None,
    dxf_version: Annotated[str, option("R12|R2000|R2010", "Dialect of DXF.")] = "R2000",
    dxf_style: Annotated[
        str, option("polyline|entities", "Contours closed, or as lines and arcs end to end.")
    ] = "polyline",
    step_schema: Annotated[str, option("AP214|AP242", "Protocol of STEP.")] = "AP214",
    gcode_dialect: Annotated[
        str, option("iso|sodick", "G-code: offsets D set on the control, or H set in it.")
    ] = "iso",
    passes: Annotated[
        int, option("N", "Of the wire in G-code, the rough cut and up to 3 skim cuts.")
    ] = 4,
    tab_length: Annotated[
        str | None, option("Q", 'Left uncut in G-code until held; default "3 mm".')
    ] = None,
    prices: Annotated[
        Path | None,
        option("FILE.csv", "Prices for the bill: designation, price, currency, vendor."),
    ] = None,
    workers: Annotated[
        int | None, option("N", "Designs at a time; default one for each core.", min=1)
    ] = None,
    seed: Annotated[
        int | None,
        option(
            "N", "Gearbox of simulators drawn from the tolerances; default perfect parts.", min=0
        ),
    ] = None,
    calibration: Calibrated = None,
    motor: NamedMotor = None,
    motor_file: OwnMotor = None,
    force: Force = False,
) -> int:
    """Files for makers (DXF, EDM, STEP, ...) and simulators."""
    from cqdd_design.exporting import ExportOptions
    from cqdd_design.exporting.bill.prices import read_prices
    from cqdd_design.exporting.options import DEFAULTS, refuse_unread
    from cqdd_design.roads.export import export as write
    from cqdd_design.roads.export import left_out
    from cqdd_design.units import LENGTH

    kinds = read_kinds(to)
    tab = parse_positive("--tab-length", tab_length, LENGTH)
    options = ExportOptions(
        dxf_version=dxf_version.upper(),
        dxf_style=dxf_style.lower(),
        step_schema=step_schema.upper(),
        gcode_dialect=gcode_dialect.lower(),
        passes=passes,
        tab_length=DEFAULTS.tab_length if tab is None else tab,
    )
    refuse_unread(kinds, options, prices=prices, seed=seed, calibration=calibration)
    if prices is not None:
        options = replace(options, prices=read_prices(prices))
    if len(design) > 1:
        more = options.arguments()
        more += [] if seed is None else ["--seed", str(seed)]
        more += [] if calibration is None else ["--calibration", str(calibration)]
        more += [] if motor is None else ["--motor", motor]
        more += [] if motor_file is None else ["--motor-file", str(motor_file)]
        return _several(out, design, kinds, folder, more, workers=workers, force=force)
    loaded = read_design(out, design[0], motor, motor_file)
    specimen = read_specimen(out, loaded, calibration=calibration, seed=seed)
    files = write(
        loaded,
        kinds,
        folder,
        specimen=specimen,
        force=force,
        options=options,
        progress=out.stages(stages(kinds)),
    )
    out.wrote(files)
    out.warn(*left_out(loaded, kinds, specimen=specimen))
    out.document({"kinds": list(kinds)}, design=loaded, files=files)
    return 0


def _several(
    out: Output,
    designs: list[Path],
    kinds: tuple[str, ...],
    folder: Path | None,
    options: list[str],
    *,
    workers: int | None,
    force: bool,
) -> int:
    """Each design in a process of its own; the exit code of the first that failed."""
    from cqdd_design.exporting.many import export_many

    arguments = ["--to", ",".join(kinds), *options]
    arguments += ["--force"] if force else []
    found = export_many(
        designs, arguments, folder, workers=workers, progress=out.counting("designs")
    )
    for one in found:
        out.warn(*(f"{one.path}: {told}" for told in one.warnings))
        if one.error:
            out.warn(f"{one.path}: {one.error}")
        else:
            out.say(f"{one.path}: {len(one.files)} files")
    files = [file for one in found for file in one.files]
    out.document({"kinds": list(kinds), "designs": [one.to_dict() for one in found]}, files=files)
    return next((one.exit_code for one in found if one.exit_code), 0)
