"""``cqdd-design calibrate``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cqdd_design.cli import completion
from cqdd_design.cli.options import (
    BenchSeed,
    BenchSupply,
    DesignFile,
    Force,
    NamedMotor,
    OwnMotor,
    RigStiffness,
    option,
    parse_names,
    parse_positive,
)
from cqdd_design.cli.session import Output, read_design, read_specimen
from cqdd_design.cli.tables import folded, number, table
from cqdd_design.environment import output_folder
from cqdd_design.terms import measurement

if TYPE_CHECKING:
    from cqdd_design.actuator.bench.calibrate import Calibration


def calibrate(
    out: Output,
    design: DesignFile,
    measured: Annotated[
        Path | None,
        option(
            "FILE",
            "CSV with the columns name,value,unit; default the paper's table, for its own "
            "actuator.",
        ),
    ] = None,
    to: Annotated[
        str | None,
        option(
            "ROWS",
            "Measured rows to fit to, by commas; the others are predicted.",
            autocompletion=completion.measurements,
        ),
    ] = None,
    unknowns: Annotated[
        str | None,
        option(
            "NAMES",
            "What to fit: thermal_resistance, motor_cogging, motor_coulomb, motor_viscous, "
            "friction_load, current_loop, rig_stiffness, tolerance_scale; default what the rows "
            "decide.",
            autocompletion=completion.unknowns,
        ),
    ] = None,
    voltage: BenchSupply = None,
    rig_stiffness: RigStiffness = None,
    seed: BenchSeed = None,
    motor: NamedMotor = None,
    motor_file: OwnMotor = None,
    path: Annotated[
        Path | None,
        option("FILE", "Default exports/NAME-calibration.json, its own output.", "--out"),
    ] = None,
    force: Force = False,
) -> None:
    """Fit friction and cooling to measured rows; predict the rest."""
    from cqdd_design.actuator.bench.calibration_file import write_calibration
    from cqdd_design.actuator.bench.measured import read_measured
    from cqdd_design.files import kind_by_ending, refuse_overwrite
    from cqdd_design.roads.calibrate import calibrate as fitted
    from cqdd_design.units import STIFFNESS_GAIN, VOLTAGE

    supply = parse_positive("--voltage", voltage, VOLTAGE)
    rows = None if measured is None else read_measured(measured)
    loaded = read_design(out, design, motor, motor_file)
    if path is not None:
        kind_by_ending(path, ("json",), "calibration")
        refuse_overwrite(path, force=force)
    out.compile_ahead(loaded, simulation=True)
    found = fitted(
        loaded,
        rows,
        read_specimen(out, loaded, seed=seed),
        to=parse_names(to),
        unknowns=parse_names(unknowns),
        voltage=supply,
        rig_stiffness=parse_positive("--rig-stiffness", rig_stiffness, STIFFNESS_GAIN),
        progress=out.stages(3),
    )
    target = path or output_folder("exports") / f"{loaded.file_name}-calibration.json"
    file = write_calibration(found, loaded.sha256, target)
    out.say(*_lines(found))
    out.wrote([file])
    out.warn(*found.after.warnings)
    out.document(found.to_dict(), design=loaded, files=[file])


def _lines(found: Calibration) -> list[str]:
    from cqdd_design.actuator.bench.unknowns import UNKNOWNS

    rows, under = [], found.factors.under
    for row in found.rows:
        rows.append(
            [
                measurement(row.name),
                row.unit,
                "" if row.measured is None else number(row.measured),
                "-" if row.before is None else number(row.before),
                "-" if row.after is None else number(row.after),
                "" if row.off is None else f"{round(100.0 * row.off, 1) + 0.0:+.1f}",
                row.relation,
            ]
        )
    head = ["measurement", "unit", "measured", "computed", "calibrated", "off %", "agreement is"]
    fitted = [
        [
            name,
            UNKNOWNS[name].told(value),
            "{:.3g} to {:.3g}".format(*found.ranges[name]),
            "at an end of its range" if name in found.at_an_end else "",
        ]
        for name, value in found.factors.items()
    ]
    good = [measurement(row.name) for row in found.within]
    told = (
        f"{len(good)} of {len(found.predicted)} predicted rows are within 20 % (efficiency: "
        f"5 points): {'; '.join(good) or 'none'}."
        if found.predicted
        else "No measured row is left to tell how well the others are predicted."
    )
    lines = [
        table(rows, head=head, right=(2, 3, 4, 5)),
        "",
        table(fitted, head=["unknown", "is", "within", ""]),
        "",
        *folded(told),
        *([] if under is None else folded(f"Measured under {under.told}.")),
    ]
    return lines
