"""The comparison table of Zhu et al., arXiv:2410.16591: peak torque over mass, recomputed."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from published_rows import Row, label, published_rows

from cqdd_design.actuator.comparison import (
    ComparedActuator,
    compare_actuators,
    published_actuators,
)
from cqdd_design.errors import CatalogError


def test_torque_densities_are_recomputed_and_the_wrong_one_is_named() -> None:
    found = {one.name: one for one in published_actuators()}
    assert found["Lee et al."].torque_density == pytest.approx(155.32 / 1.85)
    assert "83.96 N*m/kg, printed 83.7 N*m/kg" in found["Lee et al."].remark
    assert found["C-QDD (paper)"].torque_density == pytest.approx(64.214, abs=1e-3)
    assert found["C-QDD (paper)"].remark == ""
    assert found["PULSE115-60"].remark == ""
    # 32 N m over 0.670 kg is 47.76, which rounds up.
    assert "47.76" in found["BEAR"].remark


@pytest.mark.parametrize("row", published_rows("torque density"), ids=label)
def test_printed_torque_density_is_not_torque_over_mass(
    row: Row, compared: Callable[..., None]
) -> None:
    def ours() -> float:
        return next(
            one for one in published_actuators() if one.name == row["inputs"]
        ).torque_density

    compared(row, ours, ComparedActuator.torque_density)


def test_present_design_and_catalogue_join_the_table() -> None:
    own = ComparedActuator("mine", "cycloid", "bench", 10.0, 88.0, 1.77)
    table = compare_actuators(own, ["CubeMars AK10-9 V2 KV60"])
    assert [one.name for one in table[-2:]] == ["mine", "CubeMars AK10-9 V2 KV60"]
    assert table[-1].torque_density == pytest.approx(48.0 / 0.96)
    assert table[-2].to_dict()["torque_density_Nm_per_kg"] == pytest.approx(88.0 / 1.77)
    with pytest.raises(CatalogError, match="geared actuator"):
        compare_actuators(more=["CubeMars RO100 KV55"])
