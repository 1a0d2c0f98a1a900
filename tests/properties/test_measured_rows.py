"""Tables of measurements with rows that no machine can have end in a sentence."""

from __future__ import annotations

from pathlib import Path

import pytest

from cqdd_design.actuator.bench.measured import read_measured
from cqdd_design.catalog.paper import METRICS
from cqdd_design.errors import UsageError


def table(folder: Path, *rows: str) -> Path:
    path = folder / "rows.csv"
    path.write_text("\n".join(["name,value,unit", *rows]) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (("efficiency_peak,82.3,",), r"efficiency_peak of 8230 % gives more power than it takes"),
        (("efficiency_peak,103,%",), r"of 103 % gives more power"),
        (
            ("continuous_torque,90,N*m", "peak_torque,37,N*m"),
            r"continuous_torque of 90 N\*m is more than peak_torque of 37",
        ),
        (("stall_torque,8,N*m", "continuous_torque,9,N*m"), r"more than stall_torque of 8"),
        (("torque_ripple,5,N*m", "peak_torque,4,N*m"), r"ripple is a part of the torque"),
        (
            ("torque_density,80,N*m/kg", "peak_torque,89.9,N*m", "mass,1.4,kg"),
            r"89\.9 N\*m/1\.4 kg = 64\.21; leave it out",
        ),
    ],
)
def test_impossible_rows_are_refused(tmp_path: Path, rows: tuple[str, ...], words: str) -> None:
    with pytest.raises(UsageError, match=words):
        read_measured(table(tmp_path, *rows))


def test_the_papers_own_rows_are_possible(tmp_path: Path) -> None:
    """All of them, in their units, and the unit of the file."""
    from cqdd_design.actuator.bench.metric import METRICS as UNITS

    rows = [f"{name},{figure.value},{UNITS[name]}" for name, figure in METRICS.items()]
    assert set(read_measured(table(tmp_path, *rows))) == set(METRICS)


def test_efficiency_of_one_is_the_limit(tmp_path: Path) -> None:
    assert read_measured(table(tmp_path, "efficiency_peak,100,%")) == {"efficiency_peak": 1.0}
