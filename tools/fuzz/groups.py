"""The groups of the campaign: how each draws its cases, and how many there are by default."""

from __future__ import annotations

import functools
import json
import random
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from tools.fuzz import designs, files
from tools.fuzz.case import Case

PAPER = (files.REPOSITORY / "designs" / "cqdd-10.toml").read_bytes()
CALIBRATION = json.loads((files.REPOSITORY / "designs" / "cqdd-10-calibration.json").read_text())
_DATES = ("abc", "-1", "9" * 30, "1e9", "0", "1700000000")


@dataclass(frozen=True)
class Group:
    """A way to draw cases."""

    about: str
    draw: Callable[[random.Random], Case]
    cases: int


def _design(draw: random.Random) -> Case:
    text = designs.toml(designs.sensible(draw))
    if draw.random() < 0.3:
        text += designs.duty(draw, wrong=False)
    command = draw.choice(["check", "check", "check", "analyse", "compare"])
    return Case({"a.toml": text.encode()}, (command, "a.toml", "--json"))


def _values(draw: random.Random) -> Case:
    text = designs.with_strange_values(draw)
    return Case({"a.toml": text.encode()}, ("check", "a.toml", "--json"))


def _bytes(draw: random.Random) -> Case:
    name = draw.choice(["a.toml", "a.toml", "名.toml", "a b.toml", "a\x1bb.toml"])
    return Case({name: designs.broken_bytes(draw)}, ("check", name, "--json"))


def _units(draw: random.Random) -> Case:
    import cqdd_design.units as units

    known = [value for value in vars(units).values() if isinstance(value, units.Dimension)]
    texts = []
    for _ in range(50):
        parts = [draw.choice(["N", "m", "mm", "rad", "s", "kg", "rpm", "degC", "W", "K", "9", "x"])]
        for _ in range(draw.choice([0, 1, 1, 2, 3, 30])):
            parts += draw.choice(["*", "/", "**", "^", " ", "·", ".", "(", ")", "²", "-", "_"])
            parts += draw.choice(["m", "rad", "s", "2", "9", "1.4", "-1", "kg", "", "°", "%"])
        number = draw.choice(["1", "-1", "1e-3", "1e999", "nan", "1_0", "", "." * 9, "9" * 500])
        texts.append(f"{number} {''.join(parts)}{' ' * draw.choice([0, 1, 300_000])}")
    texts.append(
        "".join(
            chr(draw.choice([draw.randrange(1, 256), draw.randrange(0x3000)])) for _ in range(30)
        )
    )

    def call() -> None:
        from cqdd_design.errors import DesignError

        for text in texts:
            for dimension in draw.sample(known, 2):
                try:
                    if not np.isfinite(units.parse_quantity(text, dimension)):
                        raise AssertionError(f"{text[:60]!r} is not finite")
                except DesignError as error:
                    if len(error.message) > 300:
                        raise AssertionError(f"{text[:60]!r} has a long message") from error

    return Case(call=call)


def _motor(draw: random.Random) -> Case:
    from cqdd_design.design.motor import read_motor

    return Case({"m.toml": files.motor_file(draw)}, call=lambda: read_motor(Path("m.toml")))


def _map(draw: random.Random) -> Case:
    from cqdd_design.torque.data.log_files import read_map

    return Case({"m.toml": files.log_map(draw)}, call=lambda: read_map(Path("m.toml")))


def _calibration(draw: random.Random) -> Case:
    from cqdd_design.actuator.bench.calibration_file import read_calibration

    content = files.json_bytes(draw, CALIBRATION)
    return Case({"c.json": content}, call=lambda: read_calibration(Path("c.json"), ""))


def _tables(draw: random.Random) -> Case:
    from cqdd_design.actuator.bench.measured import read_measured
    from cqdd_design.actuator.reference import read_reference
    from cqdd_design.units import TORQUE

    if draw.random() < 0.5:
        return Case({"t.csv": files.measured(draw)}, call=lambda: read_measured(Path("t.csv")))
    return Case(
        {"t.csv": files.reference(draw)}, call=lambda: read_reference(Path("t.csv"), TORQUE)
    )


def _log(draw: random.Random) -> Case:
    given = {f"log{draw.choice([*(8 * ['.csv']), '.tsv', '.parquet', '.pkl'])}": files.log(draw)}
    arguments = ["torque", "import", *given, "--position-gain", "60 N*m/rad"]
    arguments += ["--velocity-gain", draw.choice([*(14 * ["2 N*m*s/rad"]), "2 N*m", "-1"])]
    if draw.random() < 0.15:
        given["map.toml"] = files.log_map(draw)
        arguments += ["--map", "map.toml"]
    if draw.random() < 0.95:
        arguments += ["--columns", "time=time,position=q,target=q_des,velocity=dq,torque=tau"]
    if draw.random() < 0.1:
        unit = draw.choice(
            ["position=deg", "torque=N*mm", "torque=9**9**9", "x=y", "position", "="]
        )
        arguments += ["--units", unit]
    for option, values in (
        ("--dt", ["0.01 s", "0 s", "1e-12 s", "1e9 s", "x"]),
        ("--rate", ["100 Hz", "0 Hz", "1e12 Hz", "x"]),
        ("--cut", ["1 Hz", "1e9 Hz", "-1 Hz"]),
        ("--torque-limit", ["10 N*m", "-1 N*m", "1e300 N*m"]),
        ("--current-to-torque", ["1", "nan", "0", "x"]),
    ):
        if draw.random() < 0.04:
            arguments += [option, draw.choice(values)]
    return Case(given, (*arguments, "--out", "data", "--json"))


@functools.cache
def _network(place: Path) -> tuple[dict[str, Any], Any]:
    from cqdd_design.files import read_arrays

    return read_arrays(place, 10**9, "a network")


def _archive(draw: random.Random) -> Case:
    from cqdd_design.torque.networks.artefact import read_artefact
    from cqdd_design.torque.training.checkpoint import read_checkpoint

    arrays, content = _network(draw.choice(files.NETWORKS[:6]))
    reader: Callable[[Path], object] = draw.choice((read_artefact, read_checkpoint))
    if reader is read_checkpoint:
        groups = ("weights", "first_moment", "second_moment", "best")
        arrays = {f"{group}:{name}": one for group in groups for name, one in arrays.items()}
        row = {"epoch": 1, "training_rmse_Nm": 1.0, "validation_rmse_Nm": 1.0, "seconds": 1.0}
        content = {
            **{"format": "cqdd-design torque checkpoint 1", "identity": {"model": "a"}},
            **{"epoch": 1, "step": 1, "best_rmse": 1.0, "log": [row], "facts": {"updates": 1}},
            "random_state": {"seed": 0, "epoch": 1},
        }
    made = files.archive(draw, arrays, content)
    return Case({"a.npz": made}, call=lambda: reader(Path("a.npz")))


def _network_command(draw: random.Random) -> Case:
    arrays, content = _network(draw.choice(files.NETWORKS[:6]))
    made = files.archive(draw, arrays, content)
    if draw.random() < 0.5:
        made = files.damaged(draw, draw.choice(files.NETWORKS[:6]).read_bytes())
    return Case({"a.npz": made}, ("torque", "export", "a.npz", "--to", "c", "--out", "o", "--json"))


def _manifest(draw: random.Random) -> Case:
    from cqdd_design.torque.data.episodes import read_data

    content = {
        **{"format": "cqdd-design torque data 1", "dt_s": 0.01, "torque_range_Nm": [-9.0, 9.0]},
        **{"position_gain_Nm_per_rad": 60.0, "velocity_gain_Nms_per_rad": 2.0},
        "facts": {"held_mass_kg": 1.0, "pendulum": {**dict.fromkeys(_PENDULUM, 1.0), "wall": None}},
        "episodes": [{"name": "a", "samples": 3, "group": {"mass": 1}}],
    }
    episode = files.damaged(draw, _parquet())
    given = {"d/manifest.json": files.json_bytes(draw, content), "d/episodes/a.parquet": episode}
    return Case(given, call=lambda: read_data(Path("d")))


_PENDULUM = ("gravity", "bar_gravity_moment", "bar_inertia", "hanging_angle", "viscous")


@functools.cache
def _parquet() -> bytes:
    import io

    import pyarrow
    from pyarrow import parquet

    names = ("position", "target", "velocity", "torque")
    made = io.BytesIO()
    parquet.write_table(pyarrow.table({name: np.linspace(0, 1, 50) for name in names}), made)
    return made.getvalue()


#: Commands with options that cost little, and what may be said to each.
_OPTIONS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "check a.toml": ("--angles", "--motor", "--motor-file"),
        "analyse a.toml": ("--torque", "--angles", "--speed", "--contact-law"),
        "compare a.toml": ("--teeth", "--module", "--face-width", "--material", "--planets"),
        "inertia a.toml": ("--speed",),
        "export a.toml --to bom": ("--out", "--to", "--dxf-version", "--seed", "--tab-length"),
        "export a.toml --to dxf": ("--out", "--dxf-style", "--workers", "--calibration"),
        "size": ("--ratio", "--peak-torque", "--discs", "--motor", "--requirements", "--out"),
        "bench a.toml --only nonsense": ("--voltage", "--seed", "--beside", "--calibration"),
        "simulate a.toml --duration x": ("--load", "--mass", "--command", "--signal", "--rate"),
        "calibrate a.toml --unknowns x": ("--measured", "--voltage", "--seed", "--motor-file"),
        "tolerance a.toml --samples 0": ("--angles", "--seed", "--torque"),
        "torque generate a.toml --seconds x": ("--episodes", "--seed", "--voltage", "--out"),
        "torque train --data none": ("--model", "--seed", "--epochs", "--split", "--batch"),
        "torque evaluate --data none": ("--model", "--set", "--draws", "--report"),
        "explain": ("DXF", "CONTACT-PRESSURE", ""),
        "catalog": ("motors", "bearings", "materials", "x"),
        "new motor": ("--out", "--example"),
        "new": ("design", "requirements", "x"),
        "schema": (),
        "report nothing.toml": ("--out",),
    }
)
_ANSWERS = (
    *("1", "0", "-1", "1.5", "nan", "inf", "1e999", "9" * 400, "", "a", "10 N*m", "1 mm", "5 rpm"),
    *("1 9**9**9**9*N*m", "../x", "/dev/zero", "/dev/null/x", "a.toml", "none", "\x1b[2J", "é"),
    *("12,36,22,70", "1,2", ",", "dxf,dxf", "dxf,x", "R12", "2", "3", "10", "1 m^1.4", "-5 N*m"),
)


def _options(draw: random.Random) -> Case:
    command, options = draw.choice(sorted(_OPTIONS.items()))
    arguments = command.split()
    for _ in range(draw.randint(0, 4)):
        word = draw.choice([*options, *options, "--json", "--quiet", "--force", "--nonsense"])
        arguments.append(word)
        if word not in {"--json", "--quiet", "--force"}:
            arguments.append(draw.choice(_ANSWERS))
    environment = {"SOURCE_DATE_EPOCH": draw.choice(_DATES)} if draw.random() < 0.1 else {}
    return Case({"a.toml": PAPER}, tuple(arguments), environment=environment)


#: Commands that take seconds, with options that keep them short.
_DEAR = (
    *("report a.toml", "export a.toml --to step", "export a.toml --to stl,urdf,mjcf,usd"),
    *("export a.toml --to dxf,gcode,svg,bom", "inertia a.toml", "tolerance a.toml --samples 20"),
    "simulate a.toml --duration 0.02s --load free --command torque",
    *(
        "bench a.toml --only static",
        "size --ratio 12 --peak-torque 20N*m",
        "check a.toml --assembly",
    ),
)


def _dear(draw: random.Random) -> Case:
    arguments = [
        word.replace("0.02s", "0.02 s").replace("20N", "20 N")
        for word in draw.choice(_DEAR).split()
    ]
    values = designs.sensible(draw)
    if draw.random() < 0.3:
        values["reducer.eccentricity"] = f'"{draw.uniform(0.1, 5.0):.3g} mm"'
    return Case({"a.toml": designs.toml(values).encode()}, (*arguments, "--json"))


GROUPS: Mapping[str, Group] = MappingProxyType(
    {
        "designs": Group("designs that may well exist, through check and its kin", _design, 1200),
        "values": Group("designs with wrong values, keys and tables", _values, 1200),
        "bytes": Group("design files cut, flipped, in other codings, very large", _bytes, 800),
        "units": Group("unit strings, 51 a case", _units, 100),
        "motors": Group("motor files", _motor, 500),
        "maps": Group("maps of logs", _map, 500),
        "calibrations": Group("calibrations", _calibration, 500),
        "tables": Group("tables of measurements and references", _tables, 600),
        "logs": Group("logs through torque import", _log, 400),
        "archives": Group("networks, checkpoints and packed data", _archive, 800),
        "networks": Group("networks through torque export", _network_command, 200),
        "manifests": Group("data sets", _manifest, 400),
        "options": Group("options of every command", _options, 600),
        "dear": Group("reports, solids, simulations of designs that may well exist", _dear, 40),
    }
)
