"""Build wheel and source distribution, check both, and run the wheel alone in a new environment.

    python tools/package.py [--pages]     needs the packages `build` and `twine`

The wheel is built from the source distribution, so that nothing of the working tree gets in beside
it. Commands run in an empty folder, without the tree on their path: what they need has to be in the
wheel. `--pages` runs there, as a reader would, every command and every snippet of the README and of
the tutorials, some minutes' worth, and says how long each took. Any failure is exit code 1.
"""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
import tempfile
import time
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
EXAMPLE = "cqdd-design new --example cqdd-10 --out designs/cqdd-10.toml"
"""What the README says that writes the design which its commands read."""
TUTORIALS = ("first-gearbox", "gait-to-knee", "simulator", "edm-shop", "printed")
"""In the order in which they build on each other."""
NO = {"cqdd-design check printed-13.toml"}
"""Commands whose verdict is no, as their pages say."""


def run(*command: str | Path, folder: Path = TOP, wanted: int = 0) -> None:
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
    if done.returncode != wanted:
        sys.exit(f"{' '.join(map(str, command))} ended with {done.returncode}:\n{done.stdout}")


def blocks(page: Path, language: str) -> list[str]:
    """Blocks of code of a page."""
    text = page.read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL)


def follow(page: Path, programs: Path, folder: Path) -> None:
    """Do in a folder what a page shows: write its tables, run its commands, then its snippets.

    With the packages that it says a snippet needs.
    """
    for table in blocks(page, "csv"):
        if name := re.match(r"# ([\w-]+\.csv)\b", table):
            (folder / name[1]).write_text(table, encoding="utf-8")
    lines = "".join(blocks(page, "console")).splitlines()
    commands = [line.removeprefix("$ ") for line in lines if line.startswith("$ ")]
    if page.name == "README.md":
        commands.insert(0, EXAMPLE)
    for command in commands:
        began = time.perf_counter()
        program, *arguments = shlex.split(command, comments=True)
        run(programs / program, *arguments, folder=folder, wanted=4 if command in NO else 0)
        took = time.perf_counter() - began
        print(f"{took:6.1f} s  {command.split('  #')[0].rstrip()}", flush=True)
    for package in re.findall(r"`pip install ([\w-]+)`", page.read_text(encoding="utf-8")):
        run(programs / "python", "-m", "pip", "install", "-c", TOP / "constraints.txt", package)
    for snippet in blocks(page, "python"):
        run(programs / "python", "-c", snippet, folder=folder)


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
        if "--pages" in sys.argv[1:]:
            readme, tutorials = folder / "readme", folder / "tutorials"
            readme.mkdir()
            tutorials.mkdir()
            follow(TOP / "README.md", programs, readme)
            for name in TUTORIALS:
                follow(TOP / "docs" / f"tutorial-{name}.md", programs, tutorials)
        sizes = ", ".join(f"{one.name} {one.stat().st_size / 1e6:.1f} MB" for one in built)
        print(f"built, checked, installed alone and run: {sizes}")


if __name__ == "__main__":
    main()
