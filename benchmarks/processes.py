"""Time whole processes of cqdd-design, and of cycloidgen beside them, and write the page.

    python benchmarks/processes.py [--runs 5] [--cycloidgen PYTHON] [--write]

Every command is a process of its own, from the start of the interpreter to its end, in an empty
folder. Each runs once unmeasured, so kernels are compiled, and files and byte code are in the
system's cache (warm); then the commands take turns, so that a slow minute of the machine meets all
of them, and the median of the runs counts. What a design's bodies, gearboxes and pictures cost is
kept by the first run; rows of a new design begin with nothing kept every time. Limits are goals,
not assertions: run this by hand on a machine that does nothing else.

`--cycloidgen` names the Python of an environment in which cycloidgen is installed::

    python3 -m venv /tmp/cycloidgen && /tmp/cycloidgen/bin/pip install cycloidgen==8.0.0
    python benchmarks/processes.py --cycloidgen /tmp/cycloidgen/bin/python --write

`--long` adds what takes minutes, each run once: a search over all motors, and the first command
after an installation, whose kernels are not compiled.

`--write` puts the result into docs/benchmarks.md; without it the page goes to standard output.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
PAGE = REPOSITORY / "docs" / "benchmarks.md"
CONTACT_HEADING = "## The contact engine"
DESIGN = REPOSITORY / "designs" / "cqdd-10.toml"
SEARCH = Path(__file__).resolve().parent / "cycloidgen_search.py"
_VERDICT_NO = 4
PACKAGES = ("numpy", "pydantic", "typer", "ezdxf", "cadquery", "trimesh")


@dataclass(frozen=True)
class Command:
    """A process to time.

    Attributes
    ----------
    name : str
        Key of ratios.
    shown : str
        As a user would type it.
    arguments : tuple of str
        The process.
    limit : float or None
        Goal, s.
    """

    name: str
    shown: str
    arguments: tuple[str, ...]
    limit: float | None = None
    new: bool = False
    """Whether nothing of an earlier run is kept."""
    first: bool = False
    """Whether no kernel is compiled either."""
    once: bool = False
    """Whether it runs once, however many runs are asked for."""


@dataclass(frozen=True)
class Timing:
    """Measured times of a command, s, and what its last run printed."""

    command: Command
    seconds: tuple[float, ...]
    output: str

    @property
    def median(self) -> float:
        """Median of the runs, s."""
        return statistics.median(self.seconds)


def our_commands() -> list[Command]:
    """Return the commands of this package that have a goal."""
    kinds = "dxf,edm,gcode,step,stl,3mf,glb,svg,sheets,bom,mjcf,urdf,card,bam"

    def ours(name: str, line: str, limit: float, *extra: str, new: bool = False) -> Command:
        shown = line.replace(str(DESIGN), "designs/cqdd-10.toml")
        start = (sys.executable, "-m", "cqdd_design")
        words = (*start, *line.split(), *extra)
        return Command(name, f"cqdd-design {shown}", words, limit, new)

    imported = (sys.executable, "-c", "import cqdd_design")
    return [
        Command("nothing", 'python -c "pass"', (sys.executable, "-c", "pass")),
        Command("import", 'python -c "import cqdd_design"', imported, 0.05),
        ours("help", "--help", 0.2),
        ours("screen", "size --quick --ratio 10", 2.0, "--json"),
        ours("size", "size --ratio 10", 12.0, "--json"),
        ours("new size", "size --ratio 10", 12.0, "--json", new=True),
        ours("check", f"check {DESIGN}", 4.0),
        ours("new check", f"check {DESIGN}", 6.0, new=True),
        ours("dxf", f"export {DESIGN} --to dxf", 1.0),
        ours("wire", f"export {DESIGN} --to edm,gcode", 3.0),
        ours("full", f"export {DESIGN} --to {kinds}", 25.0),
        ours("report", f"report {DESIGN}", 15.0),
        ours("new report", f"report {DESIGN}", 15.0, new=True),
    ]


def long_commands() -> list[Command]:
    """Return the commands that take minutes, or leave the processor to nothing else."""
    start = (sys.executable, "-m", "cqdd_design")
    motors = "size --motor any --ratio 10 --peak-torque 30N*m"
    analysis = "analyse designs/cqdd-10.toml"
    return [
        Command(
            "any motor",
            f"cqdd-design {motors}",
            (*start, *motors.split(), "--json"),
            90.0,
            new=True,
            once=True,
        ),
        Command(
            "first",
            f"cqdd-design {analysis}",
            (*start, "analyse", str(DESIGN)),
            20.0,
            new=True,
            first=True,
            once=True,
        ),
    ]


def their_commands(python: str) -> list[Command]:
    """Return the commands of cycloidgen that do the same kind of work."""
    export = "-m cycloidgen --ratio 10 --only drawings,data,solids --out out"
    return [
        Command("their full", f"python {export}", (python, *export.split())),
        Command(
            "their search",
            'optimise(Requirements(ratio=10, ...), effort="quick")',
            (python, str(SEARCH)),
        ),
    ]


def run_once(command: Command, kept: str) -> tuple[float, str]:
    """Run a command in an empty folder; return its wall-clock time (s) and standard output.

    Parameters
    ----------
    kept : str
        Folder of what runs keep, but for commands of a new design.
    """
    path = os.pathsep.join(p for p in (str(REPOSITORY), os.environ.get("PYTHONPATH")) if p)
    theirs = command.name.startswith("their")
    environment = {**os.environ, "PYTHONPATH": "" if theirs else path}
    # As after an installation: whoever forbids byte code to be kept would measure its making.
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as empty:
        environment["CQDD_DESIGN_CACHE"] = empty if command.new else kept
        if command.first:
            environment["NUMBA_CACHE_DIR"] = empty
        begin = time.perf_counter()
        done = subprocess.run(
            command.arguments,
            cwd=folder,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )
        seconds = time.perf_counter() - begin
    if done.returncode not in {0, _VERDICT_NO}:
        raise SystemExit(f"{command.shown} ended with {done.returncode}:\n{done.stderr}")
    return seconds, done.stdout


def measure(commands: Sequence[Command], runs: int) -> list[Timing]:
    """Run every command once unmeasured and then `runs` times in turn; some only once."""
    seconds: dict[str, list[float]] = {command.name: [] for command in commands}
    outputs: dict[str, str] = {}
    with tempfile.TemporaryDirectory() as kept:
        for turn in range(runs + 1):
            for command in commands:
                if command.once and turn != 1:
                    continue
                taken, outputs[command.name] = run_once(command, kept)
                if turn > 0:
                    seconds[command.name].append(taken)
                print(f"{turn}/{runs} {taken:7.2f} s  {command.shown}", file=sys.stderr)
    return [Timing(c, tuple(seconds[c.name]), outputs[c.name]) for c in commands]


def fit_times(runs: int = 20) -> list[str]:
    """Time the fit of arcs to the exact curves, in this process; the lines of a table."""
    from cqdd_design.design import load_design
    from cqdd_design.geometry.disc import disc_contour
    from cqdd_design.geometry.ring import ring_contour

    kinds = {
        "disc": ("solid", lambda design: disc_contour(design, 0, bore_diameter=28e-3)),
        "solid ring": ("solid", ring_contour),
        "conjugate ring": ("conjugate", ring_contour),
    }
    rows = ["| contour, at 0.5 µm | arcs | fit | goal |", "|---|---|---|---|"]
    for name, (ring, fitted) in kinds.items():
        taken = []
        for run in range(runs):
            # Another design every time: fits are remembered.
            tolerance = 0.5e-6 * (1.0 + 1e-6 * run)
            design = load_design(DESIGN).replacing(
                {"reducer.ring_type": ring, "edm.profile_tolerance": tolerance}
            )
            begin = time.perf_counter()
            shape = fitted(design)
            taken.append(time.perf_counter() - begin)
        arcs = max(len(c) for c in (shape.outer, *shape.holes) if hasattr(c, "bulges"))
        rows.append(f"| {name} | {arcs} | {statistics.median(taken) * 1e3:.1f} ms | under 20 ms |")
    return rows


def machine() -> list[str]:
    """Return what the times depend on, one line each."""
    versions = [f"{name} {metadata.version(name)}" for name in PACKAGES]
    return [
        f"- {_processor()}, {os.cpu_count()} cores; {platform.system()} {platform.machine()}",
        f"- Python {platform.python_version()}, {', '.join(versions)}",
    ]


def _processor() -> str:
    information = Path("/proc/cpuinfo")
    if information.exists():
        for line in information.read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or "unknown processor"


def write_section(name: str, script: str, heading: str, text: str) -> None:
    """Put a script's text between its markers in the page; the first time at its end."""
    begin, end = f"<!-- {name}: written by {script} -->", f"<!-- end of {name} -->"
    old = PAGE.read_text(encoding="utf-8")
    if begin not in old:
        old += f"\n{heading}\n\n{begin}\n{end}\n"
    before, _, rest = old.partition(begin)
    after = rest.partition(end)[2]
    PAGE.write_text(f"{before}{begin}\n\n{text}\n{end}{after}", encoding="utf-8")


def page(timings: Sequence[Timing], runs: int) -> str:
    """Return the page of results."""
    by_name = {timing.command.name: timing for timing in timings}
    lines = [
        "# Benchmarks",
        "",
        "Whole processes, from the start of the interpreter to its end, by the wall clock, with",
        f"warm caches: one unmeasured run, then the median of {runs} runs in turn. Written by",
        "`python benchmarks/processes.py --cycloidgen PYTHON --write`; nothing in the tests "
        "depends on it.",
        "",
        *machine(),
        "",
        "| command | median | least | most | goal |",
        "|---|---|---|---|---|",
        *(_row(timing) for timing in timings),
        "",
        *fit_times(),
        "",
        *_remarks(by_name),
    ]
    return "\n".join(lines) + "\n"


def _row(timing: Timing) -> str:
    goal = "" if timing.command.limit is None else f"under {timing.command.limit:g} s"
    low, high = min(timing.seconds), max(timing.seconds)
    new = ", nothing kept" if timing.command.new else ""
    if timing.command.first:
        new = ", after an installation: no kernel compiled"
    if timing.command.once:
        new += "; one run"
    return (
        f"| `{timing.command.shown}`{new} | {timing.median:.2f} s | {low:.2f} s | {high:.2f} s "
        f"| {goal} |"
    )


def _remarks(timings: dict[str, Timing]) -> list[str]:
    screened = json.loads(timings["screen"].output)["results"]["candidates_screened"]
    lines = [f"The screen of `size` looks at {screened:,} candidates before it refines the best."]
    if "their full" not in timings:
        return lines
    theirs = json.loads(timings["their search"].output)
    full = timings["their full"].median / timings["full"].median
    found, looked = timings["their search"].median, f"{theirs['evaluations']:,} candidates"
    searches = {"screen": "screen alone", "size": "with its verdict", "new size": "nothing kept"}
    return [
        *lines,
        "",
        f"## Beside cycloidgen {theirs['version']}, in the same run",
        "",
        "| work | cqdd-design | cycloidgen | ratio |",
        "|---|---|---|---|",
        f"| full export | {timings['full'].median:.2f} s | {timings['their full'].median:.2f} s "
        f"| {full:.1f} |",
        *(
            f"| search for a design, {words} | {timings[name].median:.2f} s | {found:.2f} s, "
            f"{looked} | {found / timings[name].median:.2f} |"
            for name, words in searches.items()
        ),
        "",
        "The full exports are not the same files: theirs holds drawings, data, solids and a PDF",
        "report of its own gearbox; ours what the command above names. Their search takes the same",
        f"ratio, speed, steel and process at {theirs['torque_Nm']:g} N·m, where it finds designs.",
    ]


def main() -> None:
    """Read the arguments, measure, and write or print the page."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--runs", type=int, default=5, help="measured runs of each command")
    parser.add_argument("--cycloidgen", metavar="PYTHON", help="Python that has cycloidgen")
    parser.add_argument("--long", action="store_true", help="what takes minutes too, once each")
    parser.add_argument("--write", action="store_true", help="write docs/benchmarks.md")
    options = parser.parse_args()
    commands = our_commands() + (long_commands() if options.long else [])
    if options.cycloidgen:
        commands += their_commands(options.cycloidgen)
    text = page(measure(commands, max(1, options.runs)), max(1, options.runs))
    if options.write:
        # The contact engine's section is written by contact_solves.py.
        _, heading, rest = PAGE.read_text(encoding="utf-8").partition(CONTACT_HEADING)
        PAGE.write_text(f"{text}\n{heading}{rest}" if heading else text, encoding="utf-8")
    else:
        sys.stdout.write(text)


if __name__ == "__main__":
    main()
