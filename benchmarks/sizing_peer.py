"""Sizing beside cycloidgen's search, on five requirements that both can state, in the same run.

    python benchmarks/sizing_peer.py --cycloidgen PYTHON [--write]

Both get ratio, torque, speed at the input, hardened 4140 discs, aluminium housing, wire EDM, and
look for the lightest ("small and light" there). Ours takes the torque as peak and as what lasts
1000 h, within its default ring of 72 mm and pack of 20 mm; theirs as its one output torque within
120 by 60 mm, which every one of its designs here needs. Each search is a process of its own, first
unmeasured, then timed, one after the other.

Mass is the whole gearbox as each draws it: housing, bearings and carrier included, motor, encoder
and its cover left out. Torque density is the torque asked for over that mass.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from processes import REPOSITORY, machine, write_section

PEER = REPOSITORY / "benchmarks" / "cycloidgen_sizing.py"
INPUT_SPEED = 300
"""rpm; at it the parts of all five stay below what their grease takes."""
ASKED = ((8, 4.0), (10, 5.0), (10, 8.0), (15, 6.0), (20, 8.0))
"""Ratio, torque (N m)."""
NOT_GEARBOX = ("motor", "cover and encoder")


def _ours(ratio: int, torque: float, folder: str, *extra: str) -> tuple[float, dict[str, object]]:
    words = ["size", "--ratio", str(ratio), "--json", "--force", "--out", "ours.toml", *extra]
    for name in ("--peak-torque", "--continuous-torque"):
        words += [name, f"{torque:g} N*m"]
    words += ["--continuous-speed", f"{INPUT_SPEED} rpm"]
    began = time.perf_counter()
    document = _run(words, folder)
    return time.perf_counter() - began, document


def _run(words: list[str], folder: str) -> dict[str, object]:
    done = subprocess.run(
        [sys.executable, "-m", "cqdd_design", *words],
        cwd=folder,
        env=None,
        capture_output=True,
        text=True,
        check=False,
    )
    if not done.stdout:
        raise SystemExit(done.stderr)
    return json.loads(done.stdout)["results"]


def _gearbox_mass(folder: str) -> float:
    """Mass of what was sized, without the motor and what belongs to it, kg."""
    groups = _run(["inertia", "ours.toml", "--json"], folder)["group_mass_kg"]
    return sum(mass for name, mass in groups.items() if name not in NOT_GEARBOX)


def _theirs(python: str, ratio: int, torque: float) -> dict[str, float]:
    done = subprocess.run(
        [python, str(PEER), str(ratio), str(torque), str(INPUT_SPEED)],
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(done.stdout)


def rows(python: str) -> list[str]:
    """A row for every requirement."""
    found = []
    for ratio, torque in ASKED:
        with tempfile.TemporaryDirectory() as folder:
            _ours(ratio, torque, folder)
            screen, _ = _ours(ratio, torque, folder, "--quick")
            whole, document = _ours(ratio, torque, folder)
            mass = _gearbox_mass(folder)
        _theirs(python, ratio, torque)
        peer = _theirs(python, ratio, torque)
        found.append(
            f"| {ratio} | {torque:g} | {document['verdict']['meets']} | {screen:.1f} "
            f"| {whole:.1f} | {peer['seconds']:.1f} | {peer['seconds'] / whole:.1f} "
            f"| {1e3 * mass:.0f} | {peer['mass_g']:.0f} | {torque / mass:.1f} "
            f"| {1e3 * torque / peer['mass_g']:.1f} | {peer['mass_g'] / (1e3 * mass):.2f} |"
        )
        print(found[-1], file=sys.stderr, flush=True)
    return found


def main() -> None:
    """Read the arguments, measure, and write or print the section."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--cycloidgen", metavar="PYTHON", required=True)
    parser.add_argument("--write", action="store_true", help="write docs/benchmarks.md")
    asked = parser.parse_args()
    text = "\n".join(
        [
            "Written by `python benchmarks/sizing_peer.py --cycloidgen PYTHON --write`, in one",
            "run, compiled, second run of each; mass is the whole gearbox without motor and",
            "encoder. Seconds are of whole processes. Ours end with the whole verdict (256",
            "gearboxes of their tolerances, heat, life, motor); theirs with its own checks of",
            "rigid parts at the drawn size, and its quick effort. The screen alone is `--quick`,",
            "no verdict.",
            "",
            *machine(),
            "",
            "| ratio | N·m | our verdict | screen s | ours s | theirs s | time, theirs over ours "
            "| ours g | theirs g | ours N·m/kg | theirs N·m/kg "
            "| torque density, ours over theirs |",
            "|---|---|---|---|---|---|---|---|---|---|---|---|",
            *rows(asked.cycloidgen),
            "",
        ]
    )
    if asked.write:
        write_section("sizing", Path(__file__).name, "## Sizing beside cycloidgen 8.0.0", text)
    else:
        sys.stdout.write(text)


if __name__ == "__main__":
    main()
