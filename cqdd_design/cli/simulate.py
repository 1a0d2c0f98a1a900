"""``cqdd-design simulate``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cqdd_design.cli.options import (
    Calibrated,
    DesignFile,
    Force,
    NamedMotor,
    OwnMotor,
    Supply,
    option,
    quantity_option,
)
from cqdd_design.cli.session import Output, read_design, read_specimen
from cqdd_design.cli.tables import folded, number, table
from cqdd_design.library.scenario_words import COMMANDS, FRICTION, LOADS, SIGNALS, Choices

if TYPE_CHECKING:
    from cqdd_design.actuator.recording import Recording

_MOST_SAMPLES = 10_000


def _choice(known: Sequence[str], text: str) -> Any:
    return option("|".join(known), text)


def simulate(
    out: Output,
    design: DesignFile,
    load: Annotated[str, _choice(LOADS, "What the output carries.")] = "free",
    load_inertia: Annotated[
        str | None,
        quantity_option('Of an inertia, default "0.05 kg*m^2"; of a pendulum\'s arm, default 0.'),
    ] = None,
    load_damping: Annotated[
        str | None, quantity_option("Viscous, of inertia and pendulum; default 0 N*m*s/rad.")
    ] = None,
    mass: Annotated[str | None, quantity_option('Of the pendulum; default "2.28 kg".')] = None,
    arm: Annotated[str | None, quantity_option('Of the pendulum; default "0.5 m".')] = None,
    wall_angle: Annotated[
        str | None, quantity_option('Where a wall stops the pendulum; default "0.5 rad".')
    ] = None,
    wall_stiffness: Annotated[
        str | None, quantity_option('Of the wall; default "2000 N*m/rad".')
    ] = None,
    output_speed: Annotated[
        str | None, quantity_option('Of an output driven from outside; default "1 rad/s".')
    ] = None,
    sensor_stiffness: Annotated[
        str | None,
        quantity_option('Of the torque sensor that locks the output; default "50000 N*m/rad".'),
    ] = None,
    start_angle: Annotated[
        str | None,
        quantity_option("Of the output, but a locked one; default 0, where a pendulum hangs."),
    ] = None,
    command: Annotated[
        str, _choice(COMMANDS, "What the drive is told; open: no current.")
    ] = "torque",
    signal: Annotated[
        str | None,
        _choice(SIGNALS, "Of the command over time; default what the options say, or constant."),
    ] = None,
    amplitude: Annotated[
        str | None,
        quantity_option(
            "Of the command, or its constant, or the ramp's rise; default the continuous torque, "
            'a quarter of the current limit, half of the supply, or "0.5 rad".'
        ),
    ] = None,
    offset: Annotated[
        str | None,
        quantity_option("What a sine or chirp swings about, where a ramp starts; default 0."),
    ] = None,
    frequency: Annotated[
        str | None,
        quantity_option('Of a sine, default "0.8 Hz"; first of a chirp, default "0.5 Hz".'),
    ] = None,
    end_frequency: Annotated[str | None, quantity_option('Of a chirp; default "50 Hz".')] = None,
    reference: Annotated[
        Path | None, option("CSV", "Command over time: columns as time [s],torque [N m].")
    ] = None,
    position_gain: Annotated[
        str | None,
        quantity_option("Of impedance and position control; default that of the design."),
    ] = None,
    velocity_gain: Annotated[
        str | None,
        quantity_option("Of impedance and position control; default that of the design."),
    ] = None,
    duration: Annotated[
        str | None, quantity_option('Default "5 s"; of a reference file, its last time.')
    ] = None,
    step: Annotated[
        str | None, quantity_option('As in "20 us"; default one that the stiffness surely stands.')
    ] = None,
    rate: Annotated[str, quantity_option("Of the record.")] = "1 kHz",
    voltage: Supply = None,
    seed: Annotated[
        int | None,
        option(
            "N",
            "Draw the gearbox from the tolerances; default perfect parts.",
            min=0,
            max=2**64 - 1,
        ),
    ] = None,
    samples: Annotated[
        int | None,
        option(
            "N",
            "Gearboxes to draw, seeds from --seed (default 0) on; column `set` numbers them.",
            min=1,
            max=_MOST_SAMPLES,
        ),
    ] = None,
    friction: Annotated[str, _choice(FRICTION, "Model of dry friction.")] = "clip",
    calibration: Calibrated = None,
    motor: NamedMotor = None,
    motor_file: OwnMotor = None,
    target: Annotated[
        Path | None,
        option("FILE", "As .npz or .parquet; default exports/NAME-simulation.npz.", "--out"),
    ] = None,
    force: Force = False,
) -> None:
    """Run the actuator in time; every trace as npz or Parquet."""
    from cqdd_design.roads.simulate import simulate as simulated
    from cqdd_design.roads.simulate import simulation_kind, write_simulation

    chosen = Choices(
        given={
            "--load-inertia": load_inertia,
            "--load-damping": load_damping,
            "--mass": mass,
            "--arm": arm,
            "--wall-angle": wall_angle,
            "--wall-stiffness": wall_stiffness,
            "--output-speed": output_speed,
            "--sensor-stiffness": sensor_stiffness,
            "--start-angle": start_angle,
            "--amplitude": amplitude,
            "--offset": offset,
            "--frequency": frequency,
            "--end-frequency": end_frequency,
            "--reference": None if reference is None else str(reference),
            "--position-gain": position_gain,
            "--velocity-gain": velocity_gain,
            "--duration": duration,
            "--step": step,
            "--rate": rate,
            "--voltage": voltage,
        }
    )
    simulation_kind(target, force=force)
    loaded = read_design(out, design, motor, motor_file)
    asked = chosen.run(loaded, load=load, command=command, signal=signal, friction=friction)
    out.warn(*asked.warnings)
    specimen = read_specimen(out, loaded, calibration=calibration, seed=seed)
    out.compile_ahead(loaded, simulation=True)
    result = simulated(
        loaded,
        asked.scenario,
        specimen,
        duration=asked.duration,
        rate=asked.rate,
        step=asked.step,
        voltage=asked.voltage,
        samples=samples,
        options=asked.options,
        progress=out.counting("gearboxes") if samples else None,
    )
    file = write_simulation(result, loaded.file_name, target, force=force)
    out.say(*_lines(result))
    out.wrote([file])
    out.warn(*result.warnings)
    out.document(result.to_dict(), design=loaded, files=[file])


def _lines(result: Recording) -> list[str]:
    from cqdd_design.actuator.columns import SUMMARY

    sets = result.summary()
    rows = []
    for key, title, unit in SUMMARY:
        values = [one[key] for one in sets]
        cells = [min(values), sum(values) / len(values), max(values)] if len(sets) > 1 else values
        rows.append([title, *map(number, cells), unit])
    if result.too_coarse:
        for row in rows:
            if row[0].endswith((", peak", ", r.m.s.")):
                row[0] += " of the records"
    head = ["", "least", "mean", "most", "unit"] if len(sets) > 1 else ["", "value", "unit"]
    count = len(result.simulation.time)
    drawn = f"{len(result.seeds)} drawn from the tolerances" if result.seeds else "perfect parts"
    return [
        *folded(
            f"{result.options['--load']} load, {result.options['--command']} command, {drawn}: "
            f"{count} records at {number(result.rate)} Hz, steps of "
            f"{number(1e6 * result.simulation.step)} us"
        ),
        "",
        table(rows, head=head, right=tuple(range(1, len(head) - 1))),
        "",
    ]
