"""``cqdd-design torque import``."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cqdd_design.cli.options import Force, option, parse_option, parse_positive, quantity_option
from cqdd_design.cli.session import Output
from cqdd_design.cli.torque_generate import folder_line, summary_lines
from cqdd_design.environment import output_folder
from cqdd_design.errors import UsageError

if TYPE_CHECKING:
    from cqdd_design.torque.data.log_files import LogMap


def _pairs_of(example: str, text: str) -> Any:
    return typer.Option(metavar="A=B,...", help=f'{text} "{example}".')


def import_log(
    out: Output,
    logs: Annotated[list[Path], typer.Argument(metavar="LOG...", help="CSV, TSV or Parquet.")],
    position_gain: Annotated[
        str, quantity_option('Of the joint\'s controller, such as "60 N*m/rad".')
    ],
    velocity_gain: Annotated[
        str, quantity_option('Of the joint\'s controller, such as "2 N*m*s/rad".')
    ],
    map_file: Annotated[
        Path | None,
        option(
            "FILE",
            "TOML with tables columns, units, constants, group, groups, facts; the options "
            "below go before it.",
            "--map",
        ),
    ] = None,
    columns: Annotated[
        str | None,
        _pairs_of(
            "position=q,target=q_des,velocity=dq,torque=tau", "Quantities and the log's columns:"
        ),
    ] = None,
    units: Annotated[
        str | None, _pairs_of("position=deg,time=ms", "Units of the log, SI where left out:")
    ] = None,
    group: Annotated[
        str | None, _pairs_of("mass=1.14,wall=0", "Configuration of all these logs:")
    ] = None,
    current_to_torque: Annotated[
        float | None, option("N*m/A", "Joint torque over current, signed, without a torque.")
    ] = None,
    dt: Annotated[
        str | None, quantity_option('Sample time of logs without a time column, such as "1 ms".')
    ] = None,
    rate: Annotated[str, quantity_option("Of the episodes.")] = "200 Hz",
    torque_limit: Annotated[
        str | None,
        quantity_option("Most that the joint can be asked for; default the most recorded."),
    ] = None,
    cut: Annotated[
        str | None,
        quantity_option(
            'Cut records into pieces, such as "10 s", each a configuration of its own; for records '
            "in which the motion changes."
        ),
    ] = None,
    folder: Annotated[
        Path | None, option("DIR", "Default exports/torque-logs, its own output.", "--out")
    ] = None,
    force: Force = False,
) -> None:
    """Import logs of a real joint: the same files as `torque generate` writes."""
    from cqdd_design.actuator.recording import require_pyarrow
    from cqdd_design.files import refuse_overwrite
    from cqdd_design.torque.data.episodes import write_data
    from cqdd_design.torque.data.generate import describe
    from cqdd_design.torque.data.logs import import_logs
    from cqdd_design.units import DAMPING_GAIN, FREQUENCY, STIFFNESS_GAIN, TIME, TORQUE

    require_pyarrow()
    if folder is not None:
        refuse_overwrite(folder / "manifest.json", force=force)
    data, found = import_logs(
        logs,
        _mapped(map_file, columns, units, group, current_to_torque),
        position_gain=parse_option("--position-gain", position_gain, STIFFNESS_GAIN) or 0.0,
        velocity_gain=parse_option("--velocity-gain", velocity_gain, DAMPING_GAIN) or 0.0,
        rate=parse_positive("--rate", rate, FREQUENCY) or 0.0,
        dt=parse_positive("--dt", dt, TIME),
        torque_limit=parse_positive("--torque-limit", torque_limit, TORQUE),
        cut=parse_positive("--cut", cut, TIME),
    )
    target = folder or output_folder("exports") / "torque-logs"
    files = write_data(data, target, force=force or folder is None)
    for gap in found.gaps:
        out.warn(
            f"{gap.log}: nothing for {gap.seconds:.4g} s from {gap.begin:.4g} s on; the record is "
            "split there."
        )
    if found.dropped:
        out.warn(f"{found.dropped} pieces are too short, and are left out.")
    out.warn(*found.warnings)
    told = describe(data)
    out.say(*summary_lines(told))
    out.say(*folder_line(target, files))
    out.document({**told, **found.to_dict()}, files=[files[-1]])


def _mapped(
    path: Path | None,
    columns: str | None,
    units: str | None,
    group: str | None,
    current_to_torque: float | None,
) -> LogMap:
    """The map file with the options before it."""
    from cqdd_design.torque.data.log_files import LogMap, read_map

    named, measured = _pairs("--columns", columns), _pairs("--units", units)
    configured = {key: _value(text) for key, text in _pairs("--group", group).items()}
    if path is None:
        return LogMap(named, measured, current_to_torque, configured)
    given: dict[str, dict[str, Any]] = {"columns": named, "units": measured, "group": configured}
    if current_to_torque is not None:
        given["constants"] = {"current_to_torque": current_to_torque}
    return read_map(path, given)


def _pairs(option: str, text: str | None) -> dict[str, str]:
    found: dict[str, str] = {}
    for part in (text or "").split(","):
        if not part.strip():
            continue
        key, equals, value = (one.strip() for one in part.partition("="))
        if not (key and equals and value):
            raise UsageError(f"{option} '{part.strip()}' is not of the form A=B.")
        if key in found:
            raise UsageError(f"{option} names {key} twice.")
        found[key] = value
    return found


def _value(text: str) -> float | str:
    try:
        value = float(text)
    except ValueError:
        return text
    return value if math.isfinite(value) else text
