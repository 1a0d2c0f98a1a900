"""Masses, volumes and reflected inertia of the paper's gearbox, held tightly, in closed form.

They are not published: the layout around the discs is ours. After a change that is meant to move
them, regenerate with ``python tests/golden/test_solids_golden.py`` and review the difference of
the JSON.
"""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cqdd_design.design import load_design
from cqdd_design.machine import resolve

FILE = Path(__file__).with_suffix(".json")
DESIGN = Path(__file__).parents[2] / "designs" / "cqdd-10.toml"


def measure() -> dict[str, dict[str, float]]:
    """Numbers of every part, and of the whole."""
    design = load_design(DESIGN)
    found = resolve(design).inertia
    rows = {
        row.name: {
            "count": row.count,
            "volume_mm3": row.exact_volume * 1e9,
            "mass_g": row.properties.mass * 1e3,
            "centre_z_mm": row.properties.centre[2] * 1e3,
            "polar_kgmm2": row.properties.inertia[2, 2] * 1e6,
            "reflected_kgmm2": row.reflected * 1e6,
        }
        for row in found.parts
    }
    rows["total"] = {
        "mass_g": found.total.mass * 1e3,
        "centre_z_mm": found.total.centre[2] * 1e3,
        "reflected_kgmm2": found.reflected_input * 1e6,
    }
    return rows


def test_numbers_have_not_moved() -> None:
    expected = json.loads(FILE.read_text(encoding="utf-8"))
    found = measure()
    assert found.keys() == expected.keys()
    for name, values in found.items():
        assert values == pytest.approx(expected[name], rel=1e-9, abs=1e-12), name


if __name__ == "__main__":
    FILE.write_text(json.dumps(measure(), indent=1) + "\n", encoding="utf-8")
