"""Rows of the virtual test bench for the paper's actuator with perfect parts, held tightly.

They are not published: friction, cooling and drive are ours. After a change that is meant to move
them, regenerate with ``PYTHONPATH=tests/oracles python tests/golden/test_bench_golden.py`` and
review the difference of the JSON.
"""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from shared_outputs import measure_paper_bench, paper_bench

FILE = Path(__file__).with_suffix(".json")


def test_rows_of_the_papers_bench() -> None:
    found = {metric.name: metric.known for metric in paper_bench()[1].metrics}
    wanted = json.loads(FILE.read_text(encoding="utf-8"))
    none = {name for name, value in wanted.items() if value is None}
    assert {name for name, value in found.items() if value is None} == none
    assert {name: found[name] for name in found if name not in none} == pytest.approx(
        {name: wanted[name] for name in wanted if name not in none}, rel=1e-4
    )


if __name__ == "__main__":
    rows = {metric.name: metric.known for metric in measure_paper_bench()[1].metrics}
    FILE.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
