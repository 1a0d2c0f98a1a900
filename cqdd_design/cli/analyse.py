"""``cqdd-design analyse``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from cqdd_design.cli.options import DesignFile, parse_positive
from cqdd_design.cli.session import Output
from cqdd_design.cli.tables import number, table

if TYPE_CHECKING:
    from cqdd_design.gearbox import GearboxAnalysis


def analyse(
    out: Output,
    design: DesignFile,
    torque: Annotated[
        str | None, typer.Option(metavar="Q", help='Output torque of the loads, as in "40 N*m".')
    ] = None,
    angles: Annotated[
        int, typer.Option(metavar="N", min=8, max=100_000, help="Crank angles of the curves.")
    ] = 360,
    speed: Annotated[
        str | None, typer.Option(metavar="Q", help='Input speed, as in "1286 rpm".')
    ] = None,
) -> None:
    """Loads, pressures, output pins, bearing and balance."""
    from cqdd_design.cli.tables import verdict
    from cqdd_design.design import load_design
    from cqdd_design.gearbox import analyse_gearbox
    from cqdd_design.units import SPEED, TORQUE

    asked_torque = parse_positive("--torque", torque, TORQUE)
    asked_speed = parse_positive("--speed", speed, SPEED)
    loaded = load_design(design)
    if asked_speed is not None:
        loaded = loaded.replacing({"requirements.input_speed": asked_speed})
    analysis = analyse_gearbox(loaded, torque=asked_torque, angles=angles)
    out.say(*_lines(analysis), "", f"checks: {verdict(analysis.checks)} (see `check`)")
    for sentence in analysis.warnings:
        out.warn(sentence)
    out.document(analysis.to_dict(), design=loaded, checks=analysis.checks)


def _lines(analysis: GearboxAnalysis) -> list[str]:
    lines = []
    results = analysis.to_dict()
    titles = {
        "geometry": "geometry",
        "rigid": f"rigid loads at {number(analysis.rigid.torque)} N*m",
        "output_pins": "output pins",
        "bearings": "cam bearing",
        "balance": "balance",
    }
    for key, title in titles.items():
        values = results[key]
        assert isinstance(values, dict)
        flat = values["cam"] if key == "bearings" else values
        rows = [[f"  {name}", _shown(value)] for name, value in flat.items()]
        lines += [title, table(rows), ""]
    return lines[:-1]


def _shown(value: object) -> str:
    if isinstance(value, float):
        return number(value)
    return "-" if value is None else str(value)
