"""``cqdd-design torque generate``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cqdd_design.cli.options import (
    Calibrated,
    DesignFile,
    Force,
    NamedMotor,
    OwnMotor,
    Supply,
    count_option,
    option,
    parse_option,
    parse_positive,
    quantity_option,
)
from cqdd_design.cli.session import Output, read_design, read_specimen
from cqdd_design.cli.tables import number, table

if TYPE_CHECKING:
    from collections.abc import Mapping

    from cqdd_design.files import WrittenFile


def generate(
    out: Output,
    design: DesignFile,
    folder: Annotated[
        Path | None, option("DIR", "Default exports/NAME-torque, its own output.", "--out")
    ] = None,
    episodes: Annotated[int, count_option("On the gearbox of training.")] = 320,
    seconds: Annotated[float, option("S", "Of each episode.")] = 10.0,
    gearbox: Annotated[int, count_option("Seed of the one gearbox of training.", 0)] = 1,
    unit_gearboxes: Annotated[
        int, count_option("Further gearboxes, for the unit-to-unit test alone.", 0)
    ] = 4,
    held_mass: Annotated[
        str,
        quantity_option(
            'A mass that only the test set "mass" contains; "none" leaves the set out.'
        ),
    ] = "1.71 kg",
    seed: Annotated[int, count_option("Of experiments and sensor noise.", 0)] = 0,
    voltage: Supply = None,
    position_gain: Annotated[
        str | None, quantity_option("Of the joint's controller; default that of the design.")
    ] = None,
    velocity_gain: Annotated[
        str | None, quantity_option("Of the joint's controller; default that of the design.")
    ] = None,
    calibration: Calibrated = None,
    motor: NamedMotor = None,
    motor_file: OwnMotor = None,
    force: Force = False,
) -> None:
    """Generate pendulum data on the simulated actuator, as Parquet with a JSON manifest."""
    from cqdd_design.roads.torque_data import generate as generated
    from cqdd_design.torque.data.generate import Request
    from cqdd_design.units import DAMPING_GAIN, MASS, STIFFNESS_GAIN, VOLTAGE

    held = None if held_mass == "none" else parse_positive("--held-mass", held_mass, MASS)
    request = Request(
        episodes=episodes,
        seconds=seconds,
        gearbox=gearbox,
        unit_gearboxes=unit_gearboxes,
        held_mass=held,
        seed=seed,
        voltage=parse_positive("--voltage", voltage, VOLTAGE),
        position_gain=parse_option("--position-gain", position_gain, STIFFNESS_GAIN),
        velocity_gain=parse_option("--velocity-gain", velocity_gain, DAMPING_GAIN),
    )
    loaded = read_design(out, design, motor, motor_file)
    specimen = read_specimen(out, loaded, calibration=calibration)
    out.compile_ahead(loaded, simulation=True)
    found = generated(
        loaded,
        request,
        folder,
        specimen=specimen,
        force=force,
        tell=out.note,
        progress=out.counting("episodes"),
    )
    out.warn(*found.warnings)
    out.say(*summary_lines(found.facts))
    out.say(*folder_line(found.folder, found.files))
    out.document(found.facts, design=loaded, files=[found.files[-1]])


def summary_lines(found: Mapping[str, Any]) -> list[str]:
    """The data set for people."""
    low, high = found["band_Hz"]
    band, ripple = found["torque_in_band_Nm"], found["gearbox_ripple_Nm"]
    rows = [
        ["episodes", f"{found['episodes']}", ""],
        ["samples", f"{found['samples']:,}", ""],
        ["time", number(found["seconds"]), "s"],
        ["sample time", number(1e3 * found["dt_s"]), "ms"],
        ["torque, r.m.s.", number(found["torque_Nm_rms"]), "N*m"],
        ["torque, least", number(found["torque_Nm_least"]), "N*m"],
        ["torque, most", number(found["torque_Nm_most"]), "N*m"],
        [
            f"torque within {low:g} to {high:g} Hz, amplitude",
            "" if band is None else number(band),
            "N*m",
        ],
        ["  of it by the gearbox's errors", "" if ripple is None else number(ripple), "N*m"],
        ["samples at the wall", number(100.0 * found["wall_share"]), "%"],
        ["samples saturated", number(100.0 * found["saturated_share"]), "%"],
        ["episodes that saturate", f"{found['episodes_saturated']}", ""],
        ["position gain", number(found["position_gain_Nm_per_rad"]), "N*m/rad"],
        ["velocity gain", number(found["velocity_gain_Nms_per_rad"]), "N*m*s/rad"],
    ]
    return [table(rows, head=["", "value", "unit"], right=(1,)), ""]


def folder_line(folder: Path, files: tuple[WrittenFile, ...]) -> list[str]:
    """One line for a folder of many files."""
    size = sum(file.bytes for file in files)
    return [f"wrote {folder} (manifest.json and {len(files) - 1} episodes, {size:,} bytes)"]
