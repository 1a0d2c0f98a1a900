"""``cqdd-design report``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

from cqdd_design.cli.fitting import on_screen
from cqdd_design.cli.options import (
    BenchSeed,
    Calibrated,
    DesignFile,
    Duty,
    DutyColumnNames,
    Force,
    NamedMotor,
    OwnMotor,
    option,
)
from cqdd_design.cli.session import Output, read_design, read_specimen
from cqdd_design.library.inputs import under_duty


def report(
    out: Output,
    design: DesignFile,
    target: Annotated[
        Path | None, option("FILE", "Where to; default reports/NAME.html or NAME.pdf.", "--out")
    ] = None,
    format: Annotated[
        str | None,
        option(
            "html|pdf",
            "The page, or its print by a browser (Chromium); default as --out ends, or html.",
            "--format",
        ),
    ] = None,
    seed: BenchSeed = None,
    calibration: Calibrated = None,
    motor: NamedMotor = None,
    motor_file: OwnMotor = None,
    duty: Duty = None,
    duty_columns: DutyColumnNames = None,
    force: Force = False,
) -> None:
    """One self-contained file for the design review: HTML, or PDF through a browser."""
    from cqdd_design.roads.drawer import waiting_drawer

    with waiting_drawer() as drawer:
        from cqdd_design.cli.tables import headline_table
        from cqdd_design.roads.report import REPORT_STAGES, report_form, write_report

        chosen = report_form(format, target)
        loaded = under_duty(read_design(out, design, motor, motor_file), duty, duty_columns)
        out.compile_ahead(loaded, simulation=True, ensembles=True)
        written = write_report(
            loaded,
            target,
            specimen=read_specimen(out, loaded, calibration=calibration, seed=seed),
            source=design,
            form=chosen,
            force=force,
            drawer=drawer,
            progress=out.stages(REPORT_STAGES),
        )
    judged = written.verdict
    out.wrote([written.file])
    out.say(headline_table(judged), "", on_screen(judged.sentence, sys.stdout))
    out.warn(*judged.warnings)
    out.document(written.to_dict(), design=loaded, checks=judged.lines, files=[written.file])
