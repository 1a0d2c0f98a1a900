"""Whether what a refusal of `size` names fits, and what is 2 % nearer to what was asked does not.

    python benchmarks/sizing_nearest.py [--seeds 14,22,35] [--figures 0-9]

The seeds and figures are those of `sizing_yes.py`. Each is sized as by a user, in a process of its
own; of a refusal every requirement that it names is sized as by a user too, and then, by the same
search without the ways out that a refusal looks for, what lies 2 % nearer to what was asked: more
torque or speed, a smaller ring or length, mass, stiffness and the like as they were asked for, and
nothing beyond. Exit code 1 where what is named does not fit, or what is nearer does: then the
refusal could have named that.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from sizing_yes import Row, numbers, of_figures, of_seed

from cqdd_design.design import requirements_from_mapping
from cqdd_design.design.motor import read_motor
from cqdd_design.design.motor_row import row_over
from cqdd_design.errors import InfeasibleError
from cqdd_design.sizing.verified import size_to_verdict

NEARER = 0.02
"""Share of a requirement."""
_ROUNDING = 1e-9


class Way(NamedTuple):
    """What a refusal names in one direction, and what lies nearer; as options of `size`."""

    words: str
    named: dict[str, str]
    nearer: dict[str, str]


def asked_of(row: Row) -> dict[str, str]:
    """The options of a row, without their dashes."""
    words = [one.removeprefix("--") for one in row.options]
    return dict(zip(words[::2], words[1::2], strict=True))


def ways(asked: dict[str, str], told: dict[str, Any]) -> Iterator[Way]:
    """Every requirement that a refusal names, by its JSON."""
    peak, lasting = told["most_peak_torque_Nm"], told["most_continuous_torque_Nm"]
    if peak is not None and lasting is not None:
        limits = (_number(asked[f"{key}-torque"]) for key in ("peak", "continuous"))
        more = [
            min((1.0 + NEARER) * fits, most)
            for fits, most in zip((peak, lasting), limits, strict=True)
        ]
        yield Way(
            f"{peak:g} and {lasting:g} N*m", _torques(peak, lasting), _torques(more[0], more[1])
        )
    for key in ("outer-diameter", "length"):
        needed = told[f"{key.replace('-', '_')}_needed_mm"]
        if needed is not None:
            less = max((1.0 - NEARER) * needed, _number(asked[key]))
            yield Way(f"{key} {needed:g} mm", {key: f"{needed} mm"}, {key: f"{less:.6g} mm"})
    speed = told.get("most_continuous_speed_rpm")
    if speed is not None:
        key, most = "continuous-speed", _number(asked["continuous-speed"])
        more = min((1.0 + NEARER) * speed, most)
        yield Way(f"{key} {speed:g} rpm", {key: f"{speed:g} rpm"}, {key: f"{more:.6g} rpm"})
    if told["ratio_needed"] is not None:
        ratio = int(told["ratio_needed"])
        nearer = ratio - 1 if ratio > int(asked["ratio"]) else ratio + 1
        yield Way(f"ratio {ratio}", {"ratio": str(ratio)}, {"ratio": str(nearer)})
    figures = told.get("requirements_that_fit")
    if figures is not None:
        named = {key.replace("_", "-"): text for key, text in figures.items()}
        words = ", ".join(f"{key} {text}" for key, text in named.items())
        yield Way(words, named, {key: _nearer(named[key], asked[key]) for key in named})


def _nearer(named: str, asked: str) -> str:
    """A figure 2 % nearer to what was asked for, or that."""
    value, unit = _number(named), named.partition(" ")[2]
    step = value * (1.0 - NEARER if value > _number(asked) else 1.0 + NEARER)
    ends = sorted((value, _number(asked)))
    return f"{min(max(step, ends[0]), ends[1]):.6g} {unit}".rstrip()


def _torques(peak: float, lasting: float) -> dict[str, str]:
    return {"peak-torque": f"{peak:.6g} N*m", "continuous-torque": f"{lasting:.6g} N*m"}


def _number(text: str) -> float:
    return float(text.split()[0])


def sized(folder: Path, asked: dict[str, str]) -> dict[str, object]:
    """The JSON document of `size`."""
    words = [word for key in asked for word in (f"--{key}", asked[key])]
    words += ["--out", "x.toml", "--force", "--json", "--quiet"]
    done = subprocess.run(
        [sys.executable, "-m", "cqdd_design", "size", *words],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    return json.loads(done.stdout)


def fits(folder: Path, asked: dict[str, str]) -> bool:
    """Whether the search of `size` finds a design, without the ways out of a refusal."""
    own = {"motor-file", "ambient"}
    mapping: dict[str, Any] = {key.replace("-", "_"): asked[key] for key in asked if key not in own}
    mapping["ratio"] = int(asked["ratio"])
    if "efficiency" in asked:
        mapping["efficiency"] = float(asked["efficiency"])
    requirements = requirements_from_mapping(mapping)
    row = None
    if "motor-file" in asked:
        requirements = requirements.unchecked_copy({"motor": requirements.motor})
        row = row_over(requirements.motor, read_motor(folder / asked["motor-file"]))
    try:
        size_to_verdict(requirements, motor=row, ambient=_number(asked["ambient"]))
    except InfeasibleError:
        return False
    return True


def looked_at(row: Row) -> Iterator[tuple[str, bool]]:
    """What is told of a row, a line after another, and whether the refusal kept its word."""
    asked, began = asked_of(row), time.perf_counter()
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        if row.motor:
            (folder / "motor.toml").write_text(row.motor, encoding="utf-8")
        document = sized(folder, asked)
        took = time.perf_counter() - began
        error = document.get("error")
        if error is None:
            yield f"{took:5.0f} s  fits", True
            return
        yield f"{took:5.0f} s  refused: {error['message']}", error["code"] == 3
        for way in ways(asked, error["details"]):
            again = sized(folder, asked | way.named)
            kept = again.get("error") is None and again["results"]["verdict"]["meets"] == "yes"
            changed = asked | way.nearer
            same = all(
                abs(_number(changed[key]) - _number(asked[key])) <= _ROUNDING for key in way.nearer
            )
            closer = not same and fits(folder, changed)
            nearer = ", ".join(way.nearer.values())
            yield (
                f"{'':7s}{way.words}: {'fits' if kept else 'DOES NOT FIT'}; {nearer}: "
                f"{'FITS TOO' if closer else 'does not fit'}",
                kept and not closer,
            )


def main() -> None:
    """Print a line after another."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--seeds", default="14,22,35,43,44,48,53,56")
    parser.add_argument("--figures", default="")
    given = parser.parse_args()
    broken = 0
    rows = [*map(of_seed, numbers(given.seeds)), *map(of_figures, numbers(given.figures))]
    for row in rows:
        for text, kept in looked_at(row):
            broken += not kept
            print(f"{row.name:10s} {text}", flush=True)
    print(f"{broken} that do not keep their word")
    sys.exit(broken > 0)


if __name__ == "__main__":
    main()
