"""Kernels compiled before they are needed are the ones that are called, and none else."""

import subprocess
import sys
from pathlib import Path

import numba
import numpy as np
import pytest
from actuator_samples import paper_actuator

from cqdd_design.actuator.scenario import Scenario
from cqdd_design.actuator.simulate import simulate
from cqdd_design.design import Requirements, load_design
from cqdd_design.files import kernel_part
from cqdd_design.gearbox.bodies.point_load import Places, Plate, displacement_of
from cqdd_design.gearbox.bodies.point_load_kernel import displacements
from cqdd_design.gearbox.tolerance.ensemble import make_ensemble
from cqdd_design.gearbox.tolerance.run import run_ensemble
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.contact_analysis import analyse_contact
from cqdd_design.roads.kernels import (
    ENSEMBLES,
    GEARBOX,
    SIMULATION,
    SIZING,
    compile_kernels,
    missing,
    signature,
)
from cqdd_design.sizing.frame import search_frame
from cqdd_design.sizing.search import Search

PAPER = Path(__file__).parents[2] / "designs" / "cqdd-10.toml"

AHEAD = """
from cqdd_design.roads.kernels import GEARBOX, compile_kernels, missing
told = []
before = missing()
compile_kernels([*GEARBOX[-2:]], lambda *done: told.append(done))
after = missing()
print(len(before), [one.name for one in before if one not in after], told)
"""


def test_what_is_compiled_ahead_is_what_commands_call() -> None:
    design = load_design(PAPER)
    analyse_contact(resolve(design), angles=44)
    simulate([paper_actuator()], Scenario(), 1e-3, 1e-5)
    run_ensemble(make_ensemble(design, angles=44), 2)
    Search.of(search_frame(Requirements(ratio=10))).most_reserve()
    for kernel in (*GEARBOX, *SIMULATION, *ENSEMBLES, *SIZING):
        assert signature(kernel) in kernel.compiled().signatures, kernel.name
    assert missing(simulation=True, ensembles=True, sizing=True) == []


def test_a_part_is_plain_python_to_python() -> None:
    @kernel_part.part(forceinline=True)
    def twice(x: float) -> float:
        return 2.0 * x

    assert twice(3.0) == 6.0


@pytest.mark.parametrize("versions", [("0.", "1."), ("none",)], ids=["waiting", "numba's way"])
def test_a_kernel_runs_its_parts_whatever_numba_does_with_them(versions, monkeypatch) -> None:
    monkeypatch.setattr(kernel_part, "_TRIED", versions)

    @kernel_part.part(forceinline=True)
    def ratio(x: float, y: float) -> float:
        return x / y

    @kernel_part.part()
    def summed(values: np.ndarray, y: float) -> float:
        total = 0.0
        for one in values:
            total += ratio(one, y)
        return total

    @numba.njit(error_model="numpy")
    def kernel(values: np.ndarray, y: float) -> float:
        return 3.0 * summed(values, y)

    values = np.array([1.0, 2.0, 4.0])
    assert kernel(values, 2.0) == 10.5 == 3.0 * summed(values, 2.0)
    assert kernel(values, 0.0) == np.inf


def test_bodies_are_made_while_kernels_are_compiled(monkeypatch) -> None:
    design, made = load_design(PAPER), []
    monkeypatch.setattr(Machine, "bodies", property(lambda machine: made.append(machine.given)))
    compile_kernels([], lambda done, total: None, design)
    compile_kernels([], lambda done, total: None)
    assert made == [design]


def test_a_view_compiles_no_kernel_anew() -> None:
    places = Places(*(np.array([x, 1j * x]) for x in (1.0, -1.0, -2.0)))
    plate, points = Plate(2e11, 0.3, 5e-3), np.array([0.3 + 0.1j, 0.2 - 0.4j])
    rows = np.array([[0, 1], [1, 0]])
    whole = displacement_of(np.ascontiguousarray(rows[:, :1]), points, places, plate)
    before = len(displacements.signatures)
    assert np.array_equal(displacement_of(rows[:, :1], points, places, plate), whole)
    assert len(displacements.signatures) == before


@pytest.mark.deep
def test_processes_fill_the_cache_of_a_new_installation(tmp_path, monkeypatch) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    done = subprocess.run(
        [sys.executable, "-c", AHEAD], capture_output=True, text=True, check=True, timeout=300
    )
    assert done.stdout.strip() == f"{len(GEARBOX)} ['add_bearing', 'add_contacts'] [(0, 2), (2, 2)]"
