"""Whether `size` keeps its word: its yes by every other command, over ratios and requirements.

    python benchmarks/sizing_yes.py [--ratios 4-40] [--seeds 0-59] [--figures 0-29] [--short]

A row for every ratio with nothing else asked, and for every seed a requirement drawn at random:
ratio, torques, speed, life, ring, length, air and motor. With `--figures` a row more for every seed
of its own: lighter torques, and one to four of what else can be asked for, as mass, stiffness or
loads from outside. Each is sized as by a user, in a process
of its own; of the file that is written `check`, `analyse`, `bench`, `tolerance` and `report` are
then asked (`--short`: `check` alone), and every line of their verdicts is compared, words and
numbers, these to nine digits: a motor's file may state in m what the design then states in mm.
Where `size` refuses, the row is its sentence, with the nearest requirements that it names.
Exit code 1 where a verdict is not yes, or any two commands differ.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cqdd_design.catalog.motors import Motor, motors
from cqdd_design.design import load_design
from cqdd_design.geometry.scale import largest_ring
from cqdd_design.sizing.motors import lacking

_LENGTHS = (
    "outer_diameter", "length", "bore_diameter", "gap_diameter", "stack_length", "rotor_length",
    "slot_depth",
)  # fmt: skip
_FIGURES = (
    ("mass", 0.6, 2.5, "kg"),
    ("reflected-inertia", 0.01, 0.4, "kg*m^2"),
    ("backlash", 4.0, 30.0, "arcmin"),
    ("lost-motion", 6.0, 40.0, "arcmin"),
    ("stiffness", 0.3, 8.0, "N*m/arcmin"),
    ("efficiency", 0.5, 0.95, ""),
    ("surface-temperature", 50.0, 110.0, "degC"),
    ("bore", 3.0, 10.0, "mm"),
    ("speed-at-peak", 0.3, 3.0, "rad/s"),
    ("shock-speed", 0.2, 3.0, "rad/s"),
    ("external-moment", 2.0, 40.0, "N*m"),
    ("external-axial", 50.0, 800.0, "N"),
    ("external-radial", 50.0, 800.0, "N"),
    ("voltage", 20.0, 60.0, "V"),
    ("current", 8.0, 60.0, "A"),
    ("life", 100.0, 20000.0, "h"),
    ("outer-diameter", 45.0, 80.0, "mm"),
    ("length", 10.0, 35.0, "mm"),
)
"""Options of `size`, with the range that they are drawn from and its unit."""
_REFUSED = 3
"""Exit code of a requirement that does not fit."""


@dataclass(frozen=True)
class Row:
    """What is asked for, as options of `size`, and the user's own motor."""

    name: str
    options: tuple[str, ...]
    motor: str = ""


def of_ratio(ratio: int) -> Row:
    """A ratio, and nothing else."""
    return Row(f"ratio {ratio}", ("--ratio", str(ratio)))


def of_seed(seed: int) -> Row:
    """A requirement within reach of hand-sized actuators, and now and then beyond.

    With a motor of the catalogue of which all is known, or one half of the time with a user's own,
    which is the first of those at another size.
    """
    draw = np.random.default_rng(seed)
    known = [one for one in motors().values() if not lacking(one)]
    like = known[draw.integers(len(known))]
    scale = float(draw.choice([1.0, draw.uniform(0.7, 1.5)]))
    ratio = int(draw.integers(5, 31))
    peak = min(float(draw.uniform(5.0, 45.0)), 0.5 * ratio * like.peak_torque) * scale**3
    ring = 1e3 * largest_ring(scale * like.bore_diameter) * draw.uniform(0.8, 1.0)
    asked = {
        "ratio": str(ratio),
        "peak-torque": f"{peak:.3g} N*m",
        "continuous-torque": f"{peak * draw.uniform(0.05, 0.25):.3g} N*m",
        "continuous-speed": f"{draw.choice([200, 300, 500, 800])} rpm",
        "life": f"{10.0 ** draw.uniform(2.0, 3.7):.0f} h",
        "outer-diameter": f"{ring:.0f} mm",
        "length": f"{scale * draw.choice([16, 20, 25, 30]):.0f} mm",
        "ambient": f"{draw.choice([15, 25, 35])} degC",
    }
    own = "" if scale == 1.0 else motor_file(like, scale)
    asked |= {"motor-file": "motor.toml"} if own else {"motor": like.name}
    return Row(
        f"seed {seed}", tuple(word for key in asked for word in (f"--{key}", asked[key])), own
    )


def of_figures(seed: int) -> Row:
    """Modest torques with one to four of the other requirements, some of them out of reach."""
    draw = np.random.default_rng(seed)
    known = [one for one in motors().values() if not lacking(one)]
    motor = known[draw.integers(len(known))]
    ratio = int(draw.integers(6, 26))
    peak = min(float(draw.uniform(4.0, 35.0)), 0.45 * ratio * motor.peak_torque)
    asked = {
        "ratio": str(ratio),
        "peak-torque": f"{peak:.3g} N*m",
        "continuous-torque": f"{peak * draw.uniform(0.05, 0.2):.3g} N*m",
        "continuous-speed": f"{draw.choice([150, 300, 500])} rpm",
        "ambient": f"{draw.choice([-10, 25, 40])} degC",
        "motor": motor.name,
    }
    for row in draw.permutation(len(_FIGURES))[: draw.integers(1, 5)]:
        key, least, most, unit = _FIGURES[row]
        # By the logarithm: from little to much.
        value = math.exp(draw.uniform(math.log(least), math.log(most)))
        asked[key] = f"{value:.2g} {unit}".rstrip()
    return Row(f"figures {seed}", tuple(word for key in asked for word in (f"--{key}", asked[key])))


def motor_file(like: Motor, scale: float) -> str:
    """A motor at another size as a user would write it down, by the powers of the scale."""
    figures = {
        **dict.fromkeys(_LENGTHS, (1, "m")),
        **dict.fromkeys(
            ("rated_torque", "peak_torque", "coulomb", "cogging_amplitude"), (3, "N*m")
        ),
        **dict.fromkeys(("rated_current", "peak_current"), (2, "A")),
        "mass": (3, "kg"),
        "rotor_inertia": (5, "kg*m^2"),
        "viscous": (4, "N*m*s/rad"),
        "torque_constant": (1, "N*m/A"),
        "line_resistance": (-1, "ohm"),
        "line_inductance": (1, "H"),
    }
    lines = [
        f'name = "outrunner at {scale:.2f}"',
        f"pole_pairs = {like.pole_pairs}",
        f"slots = {like.slots}",
    ]
    for key, (power, unit) in figures.items():
        value = getattr(like, key) * scale**power
        lines.append(f'{key.removeprefix("line_")} = "{value:.6g} {unit}"')
    return "\n".join(lines) + "\n"


def told(folder: Path, command: str, *words: str) -> tuple[int, dict[str, object], str]:
    """Exit code, JSON document and standard error of a command."""
    done = subprocess.run(
        [sys.executable, "-m", "cqdd_design", command, *words, "--json"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    return done.returncode, json.loads(done.stdout or "{}"), done.stderr


def difference(folder: Path, design: str, sized: dict[str, object], *, short: bool) -> str:
    """The first thing that another command says otherwise; empty where none does."""
    own = _lines(sized)
    for command in ("check",) if short else ("check", "analyse", "bench", "report"):
        code, said, error = told(folder, command, design)
        if not said:
            return f"{command} ended with {code}: {error.strip()}"
        lines = _lines(said)
        # The share of gearboxes is a line of `analyse` only where another of them is asked for.
        for name in sorted(({*own, *lines}) - ({"YIELD"} if command == "analyse" else set())):
            if not _same(own.get(name), lines.get(name)):
                return f"{command} differs in {name}"
    if not short:
        _, said, _ = told(folder, "tolerance", design, "--samples", "256")
        drawn = said["results"]["backlash_arcmin"]["p95"]
        figures = {one["id"]: one["value"] for one in sized["results"]["verdict"]["headline"]}
        if abs(drawn / figures["backlash_p95"] - 1.0) > 1e-9:
            return "tolerance differs in the backlash"
    return ""


def _same(one: object, other: object) -> bool:
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_same(one[key], other[key]) for key in one)
    if isinstance(one, float) and isinstance(other, float):
        return math.isclose(one, other, rel_tol=1e-9, abs_tol=1e-12)
    return one == other


def _lines(document: dict[str, object]) -> dict[str, object]:
    return {one["id"]: one for one in document["checks"]}


def looked_at(row: Row, *, short: bool) -> tuple[str, bool]:
    """What is told of a row, and whether `size` kept its word."""
    began = time.perf_counter()
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        if row.motor:
            (folder / "motor.toml").write_text(row.motor, encoding="utf-8")
        code, sized, error = told(folder, "size", *row.options, "--out", "sized.toml")
        took = f"{time.perf_counter() - began:5.0f} s"
        if code == _REFUSED and not (folder / "sized.toml").exists():
            return f"{took}  refused: {error.strip().splitlines()[-1]}", True
        if code or sized["results"]["verdict"]["meets"] != "yes":
            return f"{took}  ended with {code}: {error.strip()}", False
        asked = load_design(folder / "sized.toml").requirements
        other = difference(folder, "sized.toml", sized, short=short)
        text = f"{took}  yes, {len(_lines(sized))} lines"
        torques = f"{asked.peak_torque:g} and {asked.continuous_torque:g} N*m"
        return f"{text}, {torques}; {other or 'all agree'}", not other


def numbers(text: str) -> Iterator[int]:
    """Of a list of numbers and ranges, as 4-7,12."""
    for part in filter(None, text.split(",")):
        first, _, last = part.partition("-")
        yield from range(int(first), int(last or first) + 1)


def main() -> None:
    """Print a row after another."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--ratios", default="4-40")
    parser.add_argument("--seeds", default="0-59")
    parser.add_argument("--figures", default="")
    parser.add_argument("--short", action="store_true")
    given = parser.parse_args()
    rows = [*map(of_ratio, numbers(given.ratios)), *map(of_seed, numbers(given.seeds))]
    rows += map(of_figures, numbers(given.figures))
    broken = 0
    for row in rows:
        text, kept = looked_at(row, short=given.short)
        broken += not kept
        print(f"{row.name:10s} {text}", flush=True)
        if not row.name.startswith("ratio"):
            print(f"           {' '.join(row.options)}", flush=True)
    print(f"{len(rows) - broken} of {len(rows)} kept")
    sys.exit(broken > 0)


if __name__ == "__main__":
    main()
