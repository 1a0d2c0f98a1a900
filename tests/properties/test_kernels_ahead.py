"""Kernels compiled before they are needed are the ones that are called, and none else."""

import subprocess
import sys
from pathlib import Path

import pytest
from actuator_samples import paper_actuator

from cqdd_design.actuator.scenario import Scenario
from cqdd_design.actuator.simulate import simulate
from cqdd_design.design import load_design
from cqdd_design.files.kernel_part import part
from cqdd_design.machine import resolve
from cqdd_design.machine.contact_analysis import analyse_contact
from cqdd_design.roads.kernels import GEARBOX, SIMULATION, missing, signature

PAPER = Path(__file__).parents[2] / "designs" / "cqdd-10.toml"

AHEAD = """
from cqdd_design.roads.kernels import GEARBOX, compile_kernels, missing
told = []
before = missing()
compile_kernels([GEARBOX[-1]], lambda *done: told.append(done))
after = missing()
print(len(before), [one.name for one in before if one not in after], told)
"""


def test_what_is_compiled_ahead_is_what_commands_call() -> None:
    analyse_contact(resolve(load_design(PAPER)), angles=44)
    simulate([paper_actuator()], Scenario(), 1e-3, 1e-5)
    for kernel in (*GEARBOX, *SIMULATION):
        assert signature(kernel) in kernel.compiled().signatures, kernel.name
    assert missing(simulation=True) == []


def test_a_part_is_plain_python_to_python() -> None:
    @part(forceinline=True)
    def twice(x: float) -> float:
        return 2.0 * x

    assert twice(3.0) == 6.0


@pytest.mark.deep
def test_processes_fill_the_cache_of_a_new_installation(tmp_path, monkeypatch) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    done = subprocess.run(
        [sys.executable, "-c", AHEAD], capture_output=True, text=True, check=True, timeout=300
    )
    assert done.stdout.strip() == f"{len(GEARBOX)} ['add_contacts'] [(0, 1), (1, 1)]"
