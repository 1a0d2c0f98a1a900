"""The planetary comparison's own numbers, pinned at tight tolerance.

Regenerate with ``python tests/golden/test_planetary_compare.py`` and review the diff of the JSON:
every moved number is a change of a formula, a default or a material that users will see.
"""

from __future__ import annotations

import functools
import json
import math
from pathlib import Path
from typing import Any

import pytest

from cqdd_design.catalog import find_material
from cqdd_design.planetary.compare import PlanetaryComparison, compare_planetary
from cqdd_design.planetary.gear_material import gear_material
from cqdd_design.planetary.kinematics import PlanetaryTeeth

FILE = Path(__file__).parent / "data" / "planetary_compare.json"


@functools.lru_cache(maxsize=1)
def computed() -> dict[str, Any]:
    """The paper's gear set in two materials, and a simple planetary, at 1286 rpm."""
    loads = {
        "peak_torque": 120.0,
        "continuous_torque": 40.0,
        "input_speed": 1286.0 * math.pi / 30.0,
        "bore": 76e-3,
    }
    through = gear_material(find_material("AISI 4140 Q&T 540C"))
    case = gear_material(find_material("SCM415/16MnCr5 case hardened"))
    simple = PlanetaryTeeth(20, 40, 40, 100)
    found = {
        "paper_4140": compare_planetary(through, **loads),
        "paper_case_hardened": compare_planetary(case, **loads),
        "simple_4140": compare_planetary(through, teeth=simple, module=0.8e-3, **loads),
    }
    return {name: _excerpt(comparison) for name, comparison in found.items()}


def _excerpt(comparison: PlanetaryComparison) -> dict[str, Any]:
    """The whole JSON but for rows and texts that repeat what others show."""
    planetary = comparison.to_dict()["planetary"]
    rows = [row for row in planetary["by_planets"] if row["planets"] in (1, 3, 6)]
    return {
        "planetary": {**planetary, "by_planets": rows},
        "claims": [[claim.ours, claim.holds] for claim in comparison.claims],
        "six_needed": sum(setting.six_needed for setting in comparison.claim_settings),
        "surface_failures": sum(setting.surface_failure for setting in comparison.claim_settings),
        "warnings": list(comparison.warnings),
    }


def flat(value: Any, path: str = "") -> dict[str, Any]:
    """Every leaf of a JSON document by its path."""
    if isinstance(value, dict):
        items = [(f"{path}.{key}", item) for key, item in value.items()]
    elif isinstance(value, list):
        items = [(f"{path}[{index}]", item) for index, item in enumerate(value)]
    else:
        return {path: value}
    return {leaf: found for key, item in items for leaf, found in flat(item, key).items()}


@pytest.mark.parametrize("case", ["paper_4140", "paper_case_hardened", "simple_4140"])
def test_numbers_have_not_moved(case):
    pinned = flat(json.loads(FILE.read_text(encoding="utf-8"))[case])
    found = flat(json.loads(json.dumps(computed()[case], allow_nan=False)))
    assert list(found) == list(pinned)
    for path, value in pinned.items():
        if isinstance(value, float):
            assert found[path] == pytest.approx(value, rel=1e-9, abs=1e-12), path
        else:
            assert found[path] == value, path


if __name__ == "__main__":
    FILE.parent.mkdir(exist_ok=True)
    FILE.write_text(json.dumps(computed(), indent=1) + "\n", encoding="utf-8")
