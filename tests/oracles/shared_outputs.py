"""Costly outputs, made once in a run of the tests and shared by all its workers.

Whichever worker asks first makes a value and leaves it, pickled, in the folder that all workers of
the run have in common; a lock makes the others wait for it meanwhile.
"""

from __future__ import annotations

import hashlib
import os
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from cqdd_design.actuator.bench import BenchResult, run_bench
from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.catalog.paper import is_papers_actuator
from cqdd_design.design import Design, Requirements, load_design
from cqdd_design.machine import resolve
from cqdd_design.machine.weighing import weigh_if_possible
from cqdd_design.report import ReportInput, read_comments
from cqdd_design.roads.telling import provenance
from cqdd_design.sizing import SizingResult, size
from cqdd_design.sizing.comparison import compare_with_planetary, cycloid_limits
from cqdd_design.verdict import judge

try:
    import fcntl
except ImportError:  # on Windows each worker that asks meanwhile makes the value itself
    fcntl = None  # type: ignore[assignment]

PAPER_FILE = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"

Made = TypeVar("Made")


def shared(name: str, make: Callable[[], Made]) -> Made:
    """What `make` returns, made by the first of all workers that asks for `name`."""
    root = Path(os.environ["CQDD_TEST_RUNS"])
    place = root / f"shared-{name}.pickle"
    with (root / f"shared-{name}.lock").open("w") as lock:
        if fcntl is not None:
            fcntl.flock(lock, fcntl.LOCK_EX)
        if not place.exists():
            unfinished = place.with_suffix(f".{os.getpid()}.part")
            unfinished.write_bytes(pickle.dumps(make()))
            unfinished.replace(place)
        found: Made = pickle.loads(place.read_bytes())
    return found


def report_input(design: Design, file: Path | None = None) -> ReportInput:
    """What a report is made from, without toleranced gearboxes and the costly chapters."""
    machine = resolve(design)
    bodies, notes = weigh_if_possible(machine)
    return ReportInput(
        machine=machine,
        gearbox=machine.analysis,
        planetary=compare_with_planetary(machine) if is_papers_actuator(design) else None,
        limits=cycloid_limits(machine),
        provenance=provenance(design),
        verdict=judge(machine, samples=0),
        comments={} if file is None else read_comments(file),
        bodies=bodies,
        notes=notes,
    )


def paper_input() -> ReportInput:
    """That of the paper's design."""
    return shared("paper-input", lambda: report_input(load_design(PAPER_FILE), PAPER_FILE))


def paper_bench() -> tuple[ActuatorParameters, BenchResult]:
    """The paper's actuator, and what the test bench measures of it."""
    return shared("paper-bench", measure_paper_bench)


def measure_paper_bench() -> tuple[ActuatorParameters, BenchResult]:
    """The same, measured anew."""
    actuator = actuator_parameters(resolve(load_design(PAPER_FILE)))
    return actuator, run_bench(actuator, rated_current=20.0, beside_paper=True)


def sized(**given: Any) -> SizingResult:
    """The search for a design of these requirements, all else at its default."""
    asked = sorted(given.items())
    name = hashlib.sha256(repr(asked).encode()).hexdigest()[:16]
    return shared(f"sized-{name}", lambda: size(Requirements(**given)))
