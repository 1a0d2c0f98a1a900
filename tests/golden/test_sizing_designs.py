"""Sized designs at tight tolerance: change them only with a reason.

Regenerate the numbers with ``cqdd-design size --ratio 10 --json`` and the options of each test.
"""

import pytest
from shared_outputs import sized

from cqdd_design.design import Requirements
from cqdd_design.sizing import SizingInfeasibleError, size


def test_ratio_10_with_the_defaults():
    result = sized(ratio=10)
    reducer, pins = result.design.reducer, result.design.reducer.output_pins
    assert (pins.count, pins.diameter, reducer.cam_bearing.designation) == (10, 4e-3, "16003")
    assert reducer.ring.outer_diameter == pytest.approx(71.1e-3)
    assert result.objective.torque_reserve == pytest.approx(1.0526, abs=1e-3)
    assert result.objective.mass == pytest.approx(0.3723, abs=2e-4)
    masses = [one.objective.mass for one in result.alternatives]
    assert masses == pytest.approx([0.3625, 0.3895, 0.4373], abs=2e-4)
    reserves = [one.objective.torque_reserve for one in result.alternatives]
    assert reserves == pytest.approx([1.007, 1.092, 1.128], abs=2e-3)


def test_ratio_10_carries_what_is_known_to_be_possible():
    """12 pins of 4 mm on 23.6 mm, R 34.4, e 1.56, r 4.2, b 9 and a 6904 carry 1.07 times 90 N m."""
    best = sized(ratio=10).alternatives[-1]
    assert best.objective.torque_reserve > 1.07


SENTENCE = (
    "90 N*m at ratio 10 does not fit: in a 40 mm ring the most is 4.89 N*m; the cam bearing "
    "binds; 90 N*m at ratio 10 needs a 69 mm ring. Lower peak_torque to 4.89 N*m and "
    "continuous_torque to 1.85 N*m, or raise outer_diameter to 69 mm."
)


@pytest.mark.parametrize(
    ("given", "most", "lasting", "ring", "binding"),
    [
        ({"outer_diameter": "40 mm"}, 4.89, 1.85, 69, ("BEARING-STATIC",)),
        pytest.param(
            {"peak_torque": "120 N*m"},
            101.0,
            38.3,
            None,
            ("CONTACT-RING-PEAK", "BEARING-STATIC"),
            marks=pytest.mark.deep,
        ),
        pytest.param(
            {"peak_torque": "120 N*m", "continuous_torque": "40 N*m"},
            106.0,
            35.3,
            None,
            ("BEARING-STATIC", "CONTACT-RING-PEAK"),
            marks=pytest.mark.deep,
        ),
    ],
)
def test_what_does_not_fit_and_what_would(given, most, lasting, ring, binding):
    with pytest.raises(SizingInfeasibleError) as caught:
        size(Requirements(ratio=10, **given))
    error = caught.value
    if ring:
        assert str(error) == SENTENCE
    assert error.most_torque == most
    needed = error.to_dict()["outer_diameter_needed_mm"]
    assert needed == ring
    assert error.binding == binding
    assert error.to_dict() == {
        "binding": list(binding),
        "most_peak_torque_Nm": most,
        "most_continuous_torque_Nm": lasting,
        "outer_diameter_needed_mm": ring,
        "length_needed_mm": None,
        "ratio_needed": None,
    }
