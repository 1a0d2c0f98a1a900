"""Record what every command gives on varied designs, and compare two recordings.

    python tools/outputs.py --record before.json --keep before
    python tools/outputs.py --record after.json --keep after --package ../other-checkout
    python tools/outputs.py --compare before.json after.json

A recording maps ``design/command/output`` to a SHA-256: exit code (as it is), standard output (a
JSON document or the text for a terminal), standard error and every file written. A change that
should move nothing is shown to move nothing so, and one that should moves only what it names.

Designs and commands stand in ``outputs_jobs.py``. Commands run as real processes with relative
paths, each job in a fresh folder, of which therefore nothing is in an output; what else differs
every time is blanked before hashing by the short table of ``outputs_blanks.py``.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path

from outputs_blanks import blanked
from outputs_inputs import INPUTS
from outputs_jobs import SIZED, WARMING, Job, design_names, job_list, written_design

REPOSITORY = Path(__file__).resolve().parents[1]
NETWORKS = REPOSITORY / "designs" / "cqdd-10-torque"
LONGEST = 7200.0
"""Of one command, s, on a busy machine; after that it hangs."""
NO_DESIGN = "none"
"""First part of the keys of commands that take no design, or several."""


def environment(package: Path) -> dict[str, str]:
    """The environment of every command: this checkout's package, and nothing that varies."""
    return os.environ | {
        "PYTHONPATH": str(package),
        "PYTHONHASHSEED": "0",
        "SOURCE_DATE_EPOCH": "1700000000",
        "COLUMNS": "100",
        "TERM": "dumb",
        "LC_ALL": "C.UTF-8",
    }


def run_command(
    arguments: Sequence[str], folder: Path, package: Path
) -> tuple[str, dict[str, bytes]]:
    """Exit code, standard output and standard error of one command."""
    try:
        done = subprocess.run(
            [sys.executable, "-m", "cqdd_design", *arguments],
            cwd=folder,
            env=environment(package),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=LONGEST,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return "timeout", {}
    return str(done.returncode), {"stdout": done.stdout, "stderr": done.stderr}


def files_below(folder: Path) -> dict[str, bytes]:
    """Every file by its relative path."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def run_job(job: Job, package: Path, designs: Mapping[str, str]) -> dict[str, bytes]:
    """Every output of a job, by its key: its steps run one after another in one fresh folder."""
    found: dict[str, bytes] = {}
    with tempfile.TemporaryDirectory(prefix="outputs-") as place:
        folder = Path(place)
        (folder / "designs").mkdir()
        for name, text in designs.items():
            (folder / "designs" / f"{name}.toml").write_text(text, "utf-8")
        for name, text in INPUTS.items():
            (folder / name).write_text(text, "utf-8")
        for name in job.networks:
            (folder / "networks" / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(NETWORKS / f"{name}.npz", folder / "networks" / f"{name}.npz")
        before = files_below(folder)
        for step in job.steps:
            prefix = f"{job.design or NO_DESIGN}/{step.name}"
            given = [a.replace("DESIGN", f"designs/{job.design}.toml") for a in step.arguments]
            code, streams = run_command(given, folder, package)
            found[f"{prefix}/exit"] = code.encode()
            after = files_below(folder)
            written = {f"files/{n}": c for n, c in after.items() if before.get(n) != c}
            for output, content in (streams | written).items():
                found[f"{prefix}/{output}"] = blanked(step.name, output, content)
            before = after
    return found


def prepared_designs(package: Path, wanted: Sequence[str]) -> dict[str, str]:
    """The text of every design wanted; the sized ones are made now, by the package."""
    designs = {name: written_design(REPOSITORY, name) for name in wanted if name not in SIZED}
    with tempfile.TemporaryDirectory(prefix="outputs-") as place:
        for name in (name for name in wanted if name in SIZED):
            path = Path(place) / f"{name}.toml"
            code, streams = run_command(
                ["size", *SIZED[name], "--out", path.name], path.parent, package
            )
            if code != "0":
                sys.exit(f"{name}: size ended with {code}: {streams['stderr'].decode()}")
            designs[name] = path.read_text("utf-8")
    return designs


def require_package(package: Path) -> None:
    """Stop unless the commands would run the package of this folder."""
    told = subprocess.run(
        [sys.executable, "-c", "import cqdd_design; print(cqdd_design.__file__)"],
        cwd=tempfile.gettempdir(),
        env=environment(package),
        capture_output=True,
        text=True,
        check=False,
    ).stdout.strip()
    if not told or not Path(told).resolve().is_relative_to(package):
        sys.exit(f"{package} holds no package cqdd_design (it would be {told or 'none'})")


def record(
    package: Path, jobs: Sequence[Job], designs: Mapping[str, str], workers: int, keep: Path | None
) -> dict[str, str]:
    """Run the jobs and return the recording."""
    recording: dict[str, str] = {}
    with ThreadPoolExecutor(workers) as pool:

        def timed(job: Job) -> tuple[float, dict[str, bytes]]:
            began = time.monotonic()
            found = run_job(job, package, {name: designs[name] for name in job.needs})
            return time.monotonic() - began, found

        running = {pool.submit(timed, job): job for job in jobs}
        for number, done in enumerate(as_completed(running), 1):
            seconds, found = done.result()
            job = running[done]
            title = f"{job.design or NO_DESIGN}/{job.steps[0].name}"
            print(f"[{number}/{len(jobs)}] {title} {seconds:.1f} s", file=sys.stderr, flush=True)
            for key, content in found.items():
                is_code = key.endswith("/exit")
                recording[key] = (
                    content.decode() if is_code else hashlib.sha256(content).hexdigest()
                )
                if is_code and content in (b"1", b"timeout"):
                    print(f"  {key} is {content.decode()}", file=sys.stderr)
                if keep and not is_code:
                    (keep / key).parent.mkdir(parents=True, exist_ok=True)
                    (keep / key).write_bytes(content)
    return recording


def differences(before: Mapping[str, str], after: Mapping[str, str]) -> list[str]:
    """One line for every key that moved, went missing or is new."""
    lines = []
    for key in sorted(before.keys() | after.keys()):
        old, new = before.get(key), after.get(key)
        if old == new:
            continue
        if new is None:
            lines.append(f"missing  {key}")
        elif old is None:
            lines.append(f"new      {key}")
        else:
            codes = f": {old} before, {new} now" if key.endswith("/exit") else ""
            lines.append(f"moved    {key}{codes}")
    return lines


def selected(key: str, commands: Sequence[str], designs: Sequence[str]) -> bool:
    """Whether a key belongs to these commands and designs; none named: all."""
    design, step, _ = key.split("/", 2)
    return (not designs or design in designs) and (not commands or step.split("-")[0] in commands)


def names(text: str) -> list[str]:
    """The names between commas."""
    return [name.strip() for name in text.split(",") if name.strip()]


def parsed() -> argparse.Namespace:
    """The options."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument(
        "--record", type=Path, metavar="FILE", help="run everything, write the hashes"
    )
    what.add_argument("--compare", type=Path, nargs=2, metavar="FILE", help="exit 1 if they differ")
    what.add_argument("--list", action="store_true", help="show what --record would run")
    parser.add_argument("--only", type=names, default=[], metavar="COMMAND,...")
    parser.add_argument("--designs", type=names, default=[], metavar="NAME,...")
    parser.add_argument("--jobs", type=int, default=2, metavar="N", help="processes at a time")
    parser.add_argument("--keep", type=Path, metavar="DIR", help="write what was hashed there")
    parser.add_argument("--package", type=Path, default=REPOSITORY, metavar="DIR", help="checkout")
    options = parser.parse_args()
    known = [*design_names(), NO_DESIGN]
    for name in options.designs:
        if name not in known:
            parser.error(f"no design {name}; there are {', '.join(known)}")
    commands = sorted({job.command for job in job_list()})
    for name in options.only:
        if name not in commands:
            parser.error(f"no command {name}; there are {', '.join(commands)}")
    return options


def main() -> int:
    """Run the tool; return its exit code."""
    options = parsed()
    if options.compare:
        before, after = (
            {
                key: value
                for key, value in json.loads(path.read_text("utf-8")).items()
                if selected(key, options.only, options.designs)
            }
            for path in options.compare
        )
        lines = differences(before, after)
        print("\n".join([*lines, f"{len(lines)} of {len(before | after)} outputs differ"]))
        return 1 if lines else 0

    jobs = [
        job
        for job in job_list()
        if (not options.designs or (job.design or NO_DESIGN) in options.designs)
        and (not options.only or job.command in options.only)
    ]
    if options.list:
        for job in jobs:
            for step in job.steps:
                print(f"{job.design or NO_DESIGN}/{step.name}:", *step.arguments)
        return 0

    package = options.package.resolve()
    require_package(package)
    began = time.monotonic()
    wanted = [name for name in design_names() if any(name in job.needs for job in jobs)]
    designs = prepared_designs(package, wanted)
    if any(job.design for job in jobs):
        run_job(WARMING, package, {"paper": written_design(REPOSITORY, "paper")})
    recording = record(package, jobs, designs, options.jobs, options.keep)
    text = json.dumps(recording, indent=1, sort_keys=True) + "\n"
    options.record.write_text(text, "utf-8")
    print(
        f"{len(recording)} outputs of {len(jobs)} jobs in {time.monotonic() - began:.0f} s",
        file=sys.stderr,
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
