"""Build wheel and source distribution, check both, and run the wheel alone in a new environment.

    python tools/package.py            needs the packages `build` and `twine`

The wheel is built from the source distribution, so that nothing of the working tree gets in beside
it. Commands run in an empty folder, without the tree on their path: what they need has to be in the
wheel. Any failure is exit code 1.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
COMMANDS = (
    "--version",
    "doctor",
    "catalog motors",
    "new --example cqdd-10 --out cqdd-10.toml",
    "size --ratio 10 --quick",
    "inertia cqdd-10.toml",
    "export cqdd-10.toml --to dxf,svg --out files",
)
"""What does without compiled kernels, and between them reads every folder of data."""


def run(*command: str | Path, folder: Path = TOP) -> None:
    """Run a command without the tree on Python's path; leave with its words where it fails."""
    clean = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
    done = subprocess.run(
        [str(one) for one in command],
        cwd=folder,
        env=clean,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))} ended with {done.returncode}:\n{done.stdout}")


def main() -> None:
    """Build, check, install, run."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        files = folder / "dist"
        run(sys.executable, "-m", "build", "--outdir", files)
        built = sorted(files.iterdir())
        run(sys.executable, "-m", "twine", "check", "--strict", *built)
        environment, empty = folder / "environment", folder / "empty"
        venv.create(environment, with_pip=True)
        empty.mkdir()
        programs = environment / ("Scripts" if os.name == "nt" else "bin")
        wheel = next(one for one in built if one.suffix == ".whl")
        run(programs / "python", "-m", "pip", "install", "-c", TOP / "constraints.txt", wheel)
        for command in COMMANDS:
            run(programs / "cqdd-design", *command.split(), folder=empty)
        sizes = ", ".join(f"{one.name} {one.stat().st_size / 1e6:.1f} MB" for one in built)
        print(f"built, checked, installed alone and run: {sizes}")


if __name__ == "__main__":
    main()
