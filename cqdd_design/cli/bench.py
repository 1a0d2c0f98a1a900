"""``cqdd-design bench``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cqdd_design.cli import completion
from cqdd_design.cli.fitting import on_screen
from cqdd_design.cli.options import (
    BenchSeed,
    BenchSupply,
    Calibrated,
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
from cqdd_design.cli.tables import folded, headline_table, number, table, told
from cqdd_design.terms import measurement

if TYPE_CHECKING:
    from collections.abc import Sequence

    from cqdd_design.actuator.bench import BenchResult
    from cqdd_design.actuator.comparison import ComparedActuator


_OTHERWISE = (
    "Measurements follow the protocols of the paper, these figures the requirements: "
    "continuous torque, standing, is of an output at rest, the continuous torque above is held for "
    "ever at its speed; the former and stall torque are met while the current rises, which loosens "
    "some friction that MOTOR-CONTINUOUS and MOTOR-PEAK count; greatest efficiency is of motor "
    "and gearbox at their best point; backlash is the mean of a few drawn gearboxes, or of the one "
    "that is measured, and not what 95 % stay below."
)


def bench(
    out: Output,
    design: DesignFile,
    only: Annotated[
        str | None,
        option(
            "NAMES",
            "Measurements, separated by commas.",
            autocompletion=completion.measurements,
        ),
    ] = None,
    voltage: BenchSupply = None,
    rig_stiffness: RigStiffness = None,
    seed: BenchSeed = None,
    calibration: Calibrated = None,
    motor: NamedMotor = None,
    motor_file: OwnMotor = None,
    beside: Annotated[
        str | None,
        option(
            "NAMES",
            "Geared actuators of the catalogue to compare with, by semicolons.",
            autocompletion=completion.geared_actuators,
        ),
    ] = None,
    folder: Annotated[
        Path | None, option("DIR", "Write every trace there, as npz.", "--out")
    ] = None,
    force: Force = False,
) -> None:
    """The actuator's data sheet, measured on a virtual bench."""
    from cqdd_design.actuator.bench import METRICS
    from cqdd_design.roads.bench import data_sheet, write_traces
    from cqdd_design.units import STIFFNESS_GAIN, VOLTAGE

    names = None if only is None else parse_names(only)
    asked = parse_positive("--voltage", voltage, VOLTAGE)
    others = tuple(name.strip() for name in (beside or "").split(";") if name.strip())
    loaded = read_design(out, design, motor, motor_file)
    specimen = read_specimen(out, loaded, calibration=calibration, seed=seed)
    out.compile_ahead(loaded, simulation=True, ensembles=True)
    found = data_sheet(
        loaded,
        specimen,
        only=names,
        voltage=asked,
        rig_stiffness=parse_positive("--rig-stiffness", rig_stiffness, STIFFNESS_GAIN),
        beside=others,
        progress=out.stages(len(names or METRICS)),
    )
    result, judged = found.result, found.verdict
    files = () if folder is None else write_traces(result, folder, force=force)
    out.say(*_lines(result))
    if others or names is None:
        out.say("", *_comparison(found.actuators))
    if judged is not None:
        told = on_screen(judged.sentence, sys.stdout)
        out.say("", headline_table(judged), "", *folded(_OTHERWISE), "", told)
    out.wrote(files)
    out.warn(*result.warnings)
    out.document(found.to_dict(), design=loaded, checks=found.lines, files=files)


def _lines(result: BenchResult) -> list[str]:
    head = ["measurement", "value", "spread", "unit"]
    head += ["paper", "off %"] if result.beside_paper else []
    rows = []
    for metric in result.metrics:
        row = [
            measurement(metric.name),
            "-" if metric.known is None else number(metric.value),
            "" if metric.spread is None else number(metric.spread, 2),
            metric.unit,
        ]
        paper = result.paper(metric.name)
        if paper is not None:
            told_off = metric.known is not None and metric.relation != "not comparable"
            off = f"{round(100.0 * (metric.value / paper - 1.0), 1) + 0.0:+.1f}" if told_off else ""
            row += [number(paper), off]
        elif result.beside_paper:
            row += ["", ""]
        rows.append([*row, metric.relation])
    lines = [
        table(
            rows,
            head=[*head, "row is"],
            right=(1, 2, 4, 5) if result.beside_paper else (1, 2),
        ),
        "",
        *folded(
            f"{len(rows)} measurements in {number(result.seconds)} s; dynamic rows at "
            f"{result.voltage:g} V. Protocols, and names for --only, stand in --json."
        ),
    ]
    remarks = [(measurement(one.name), one.remark) for one in result.metrics if one.remark]
    lines += ["", told(remarks), ""] if remarks else []
    return [
        *lines,
        *folded(
            "given: an input, an identity, or from clearances that the design assumes; "
            "calibrated: fitted to a measured value; predicted: neither. "
            "`cqdd-design calibrate` fits friction and cooling."
        ),
    ]


def _comparison(actuators: Sequence[ComparedActuator]) -> list[str]:
    rows = [
        [
            one.name,
            one.gearing,
            "" if one.ratio is None else number(one.ratio),
            number(one.peak_torque),
            number(one.mass),
            f"{one.torque_density:.2f}",
            "" if one.efficiency is None else f"{100.0 * one.efficiency:.1f}",
        ]
        for one in actuators
    ]
    head = ["actuator", "gearing", "ratio", "peak N*m", "kg", "N*m/kg", "efficiency %"]
    remarks = [one.remark for one in actuators if one.remark]
    return [
        table(rows, head=head, right=(2, 3, 4, 5, 6)),
        *(line for one in remarks for line in folded(one)),
    ]
