"""Drawn gearboxes kept on disk are those that would be worked."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.design import load_design
from cqdd_design.files import package_state as state
from cqdd_design.files.package_state import package_state
from cqdd_design.gearbox.heat.expansion import PartTemperatures
from cqdd_design.gearbox.tolerance import remembered
from cqdd_design.gearbox.tolerance.ensemble import Block, make_ensemble, work_block, work_here
from cqdd_design.gearbox.tolerance.evaluate import LOADS
from cqdd_design.gearbox.tolerance.remembered import work_remembered
from cqdd_design.gearbox.tolerance.run import BLOCK, FIRST, run_ensemble

DESIGN = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"
ELSEWHERE = {
    "name": "another",
    "motor.voltage": 24.0,
    "requirements.motor": "CubeMars RO100 KV55",
    "drive.encoder_bits": 12,
    "edm.wire_diameter": 0.2e-3,
}
"""Of a design, that no gearbox knows."""
BLOCKS = [Block(0, 3), Block(3, 2), Block(0, 2, ("pin_diameter",))]


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("CQDD_DESIGN_CACHE", str(tmp_path))
    return tmp_path / "gearboxes"


def ensemble(**changed):
    design = load_design(DESIGN).replacing(changed)
    return make_ensemble(design, angles=110)


def test_what_is_kept_is_what_would_be_worked(monkeypatch: pytest.MonkeyPatch) -> None:
    one = ensemble()
    worked = dict(work_here(one, BLOCKS))
    elsewhere = dict(work_here(ensemble(**ELSEWHERE), BLOCKS))
    first = dict(remembered.work_remembered(one, BLOCKS))
    monkeypatch.setattr(remembered, "work_block", lambda *_: pytest.fail("was worked again"))
    again = dict(remembered.work_remembered(one, BLOCKS))
    named = dict(remembered.work_remembered(ensemble(**ELSEWHERE), BLOCKS))
    for place, values in worked.items():
        for other in (first, again, named, elsewhere):
            assert np.array_equal(values, other[place], equal_nan=True)


def test_everything_that_moves_them_has_an_entry_of_its_own(own_cache: Path, monkeypatch) -> None:
    one, block = ensemble(), [Block(0, 2)]
    others = [
        dataclasses.replace(one, torque=one.torque * (1.0 + 1e-15)),
        dataclasses.replace(one, angles=111),
        dataclasses.replace(one, seed=1),
        dataclasses.replace(one, outputs=LOADS),
        dataclasses.replace(one, bodies=None),
        dataclasses.replace(one, temperatures=PartTemperatures.even(40.0)),
        ensemble(**{"tolerances.pin_diameter": 1e-6}),
        ensemble(**{"reducer.eccentricity": 1.5000001e-3}),
    ]
    monkeypatch.setattr(remembered, "work_block", lambda *_: np.zeros((2, 9)))
    for count, each in enumerate((one, *others), 1):
        list(remembered.work_remembered(each, block))
        assert len(list(own_cache.iterdir())) == count
    list(remembered.work_remembered(one, [Block(2, 2)]))
    monkeypatch.setattr(remembered, "package_state", lambda: "of another state of the package")
    list(remembered.work_remembered(one, block))
    assert len(list(own_cache.iterdir())) == len(others) + 3


def test_a_spoilt_entry_is_worked_anew(own_cache: Path) -> None:
    one, block = ensemble(), [Block(0, 2)]
    list(remembered.work_remembered(one, block))
    (entry,) = own_cache.iterdir()
    entry.write_bytes(entry.read_bytes()[:-8] + b"01234567")
    ((_, values),) = remembered.work_remembered(one, block)
    assert np.array_equal(values, work_block(one, block[0]))


def test_the_code_of_another_state_is_another(tmp_path: Path, monkeypatch) -> None:
    package = tmp_path / "package"
    package.mkdir()
    source = package / "__init__.py"
    source.write_text("a = 1\n")
    monkeypatch.setattr(state, "__file__", str(package / "files" / "package_state.py"))
    before = package_state.__wrapped__()
    (package / "kernel.nbi").write_text("compiled")
    assert package_state.__wrapped__() == before
    (package / "data.csv").write_text("1")
    assert package_state.__wrapped__() != before


def test_what_a_look_has_worked_the_verdict_does_not_work_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    one, worked = dataclasses.replace(ensemble(), outputs=LOADS), []

    def counted(which, block: Block):
        worked.append((block.first, block.count))
        return work_block(which, block)

    whole = work_block(one, Block(0, BLOCK + 3))
    monkeypatch.setattr(remembered, "work_block", counted)
    for samples in (FIRST, BLOCK, BLOCK + 3):
        found = run_ensemble(one, samples, mapper=work_remembered, sensitivity=False)
        assert np.array_equal(found.values, whole[:samples])
    assert worked == [(0, FIRST), (FIRST, BLOCK - FIRST), (BLOCK, 3)]
