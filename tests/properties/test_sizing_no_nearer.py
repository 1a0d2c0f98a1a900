"""What a refusal names: moved nearer to what was asked while whoever asks for that is served."""

from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cqdd_design.design import requirements_from_mapping
from cqdd_design.sizing import no_nearer
from cqdd_design.sizing.infeasible import SizingInfeasibleError
from cqdd_design.sizing.no_nearer import NEARER, STEPS, _alike, moved
from cqdd_design.sizing.ways import Torques, Ways

ASKED = {
    "ratio": 16,
    "peak_torque": "45 N*m",
    "continuous_torque": "6 N*m",
    "continuous_speed": "300 rpm",
    "outer_diameter": "50 mm",
    "length": "8 mm",
    "stiffness": "1.5 N*m/arcmin",
    "mass": "1.1 kg",
}
ARCMIN = 3437.746770784939
RPM = 0.10471975511965977


def ways(asked=None, **fits):
    """A refusal that names what fits, and nothing else."""
    asked = requirements_from_mapping(ASKED) if asked is None else asked
    nothing = {"torques": None, "speed": None, "figures": {}, "ratio": None, "space": {}}
    short = SizingInfeasibleError("it does not fit.", binding=("YIELD",), most_torque=None)
    return Ways(short, asked, **(nothing | fits))


def design(own):
    return SimpleNamespace(sizing=SimpleNamespace(design=SimpleNamespace(requirements=own)))


def found_where(fits, tried=None):
    def search(own):
        if tried is not None:
            tried.append(own)
        return design(own) if fits(own) else None

    return search


@given(
    fits=st.floats(1e-3, 1e3),
    far=st.floats(1.001, 3.0),
    spare=st.floats(1.0, 1.09),
    at_least=st.booleans(),
)
def test_what_is_told_was_found_and_2_percent_nearer_was_not(fits, far, spare, at_least):
    """Of what may be more as of what may be less; never beyond what was asked."""
    up = 1.0 if at_least else -1.0
    asked, bound = fits * far**up, fits * spare**up
    tried = {}

    def search(own):
        value = own["x"]
        assert (asked - value) * up >= 0.0
        assert value == asked or value == float(f"{value:.6g}")
        tried[value] = (bound - value) * up >= 0.0
        return value if tried[value] else None

    told, found = moved({"x": fits}, {"x": asked}, search)
    assert found is None if told["x"] == fits else tried[told["x"]] and found == told["x"]
    nearer = told["x"] * (1.0 + up * NEARER)
    if (asked - nearer) * up > 1e-5 * fits and len(tried) < STEPS:
        assert any(not fit and one == pytest.approx(nearer, rel=1e-5) for one, fit in tried.items())
    # What was asked for is known not to fit, and not asked again.
    assert asked not in tried
    assert len(tried) <= STEPS


def test_both_torques_are_moved_and_neither_beyond_what_was_asked():
    tried = []
    search = found_where(lambda own: own.peak_torque <= 45.0 and own.continuous_torque < 3.1, tried)
    told = no_nearer.no_nearer(ways(torques=Torques(44.5, 3.0)), search)
    assert told.torques == (45.0, 3.06)
    assert [(one.peak_torque, one.continuous_torque) for one in tried] == [
        (45.0, 3.06),
        (45.0, pytest.approx(3.1212)),
    ]
    # All else is as it was asked for.
    assert tried[0].length == pytest.approx(8e-3)
    assert told.words == ("peak_torque 45 N*m with continuous_torque 3.06 N*m",)


def test_a_torque_that_nobody_stated_is_what_is_found_with_the_other():
    asked = requirements_from_mapping(ASKED).deriving("continuous_torque")

    def search(own):
        assert own.derived == {"continuous_torque"}
        assert own.continuous_torque == asked.continuous_torque
        held = own.unchecked_copy({"continuous_torque": 2.5})
        return design(held) if own.peak_torque < 20.5 else None

    told = no_nearer.no_nearer(ways(asked, torques=Torques(20.0, 2.7)), search)
    assert told.torques == (20.4, 2.5)
    # Where nothing more fits, as before.
    told = no_nearer.no_nearer(ways(asked, torques=Torques(20.3, 2.7)), search)
    assert told.torques == (20.3, 2.7)


@pytest.mark.parametrize(
    ("fits", "told", "value"),
    [
        # Lighter designs than were told, and stiffer ones.
        ({"figures": {"mass": 1.35}}, {"figures": {"mass": 1.323}}, lambda own: own.mass >= 1.31),
        (
            {"figures": {"stiffness": 1.32 * ARCMIN}},
            {"figures": {"stiffness": pytest.approx(1.3464 * ARCMIN)}},
            lambda own: own.stiffness <= 1.35 * ARCMIN,
        ),
        (
            {"space": {"length": 0.0145}},
            {"space": {"length": 0.01421}},
            lambda own: own.length > 14e-3,
        ),
        (
            {"space": {"outer_diameter": 0.0725}},
            {"space": {"outer_diameter": pytest.approx(0.07105)}},
            lambda own: own.outer_diameter > 70e-3,
        ),
        ({"speed": 200.0}, {"speed": 204.0}, lambda own: own.continuous_speed < 205.0 * RPM),
        ({"ratio": 20}, {"ratio": 18}, lambda own: own.ratio > 17),
        ({"ratio": 12}, {"ratio": 13}, lambda own: own.ratio < 14),
        ({"ratio": 17}, {"ratio": 17}, lambda own: own.ratio != 16),
    ],
)
def test_each_direction_is_moved_by_itself(fits, told, value):
    tried = []
    end = no_nearer.no_nearer(ways(**fits), found_where(value, tried))
    assert {key: getattr(end, key) for key in told} == told
    asked = requirements_from_mapping(ASKED)
    (key,) = fits
    names = {"speed": "continuous_speed", "ratio": "ratio"}
    moves = names[key] if key in names else next(iter(fits[key]))
    for own in tried:
        assert own == asked.unchecked_copy({moves: getattr(own, moves)})
        assert moves in own.model_fields_set


def test_a_refusal_is_moved_before_it_is_told(monkeypatch):
    """Found by a search for any design: 543 rpm; whoever asked for 553.86 was given a design."""
    asked, said, sought = requirements_from_mapping(ASKED), [], []

    def refused(requirements, progress, *, motor, ambient, goal):
        assert (motor, ambient, goal) == (None, 30.0, "inertia")
        raise ways(speed=200.0).told()

    def search(own, *, motor, ambient, goal):
        assert (motor, ambient, goal) == (None, 30.0, "inertia")
        sought.append(own.continuous_speed / RPM)
        if sought[-1] > 205.0:
            raise SizingInfeasibleError("no.", binding=("YIELD",), most_torque=None)
        return design(own)

    monkeypatch.setattr(no_nearer, "size_or_nearest", refused)
    monkeypatch.setattr(no_nearer, "size_to_verdict", search)
    with pytest.raises(SizingInfeasibleError) as caught:
        no_nearer.size_or_refuse(asked, said.append, ambient=30.0, goal="inertia")
    assert caught.value.message == (
        "it does not fit. What fits, by the whole verdict: continuous_speed 204 rpm."
    )
    assert caught.value.to_dict()["most_continuous_speed_rpm"] == 204.0
    assert sought == [pytest.approx(204.0), pytest.approx(208.08)]
    # What is known is told before the searches, which take minutes.
    assert said == [
        "What fits at least: continuous_speed 200 rpm.",
        "looking whether anything a little nearer fits",
    ]


def test_where_nothing_fits_nothing_is_looked_for(monkeypatch):
    def refused(*_, **__):
        raise ways().told()

    monkeypatch.setattr(no_nearer, "size_or_nearest", refused)
    said = []
    with pytest.raises(SizingInfeasibleError, match=r"^it does not fit\.$"):
        no_nearer.size_or_refuse(requirements_from_mapping(ASKED), said.append)
    assert said == []


@pytest.mark.parametrize(
    ("change", "alike"),
    [
        ({}, True),
        ({"peak_torque": "44.97 N*m"}, True),
        ({"peak_torque": "45.03 N*m"}, True),
        # At ratio 16 10.2 N m were in vain, and 10.17 and 10.58 were not.
        ({"peak_torque": "44.87 N*m"}, False),
        ({"peak_torque": "46.7 N*m"}, False),
        ({"peak_torque": "60 N*m", "length": "7 mm"}, False),
        ({"continuous_torque": "5.98 N*m"}, False),
        ({"length": "8.02 mm"}, False),
        ({"outer_diameter": "51 mm"}, False),
        # Anything else may be easier.
        ({"ratio": 17}, False),
        ({"stiffness": "1.6 N*m/arcmin"}, False),
    ],
)
def test_a_search_is_the_same_with_the_same_torques_space_and_all_else(change, alike):
    other = requirements_from_mapping(ASKED)
    assert _alike(requirements_from_mapping(ASKED | change), other) is alike


def test_any_design_is_not_searched_for_again_where_that_was_in_vain(monkeypatch):
    """Nor the strongest: in a refusal of five minutes that took one."""
    asked, sought = requirements_from_mapping(ASKED), []
    vain = asked.unchecked_copy({"peak_torque": 21.22})
    torques = Torques(20.0, 6.0)

    def refused(*_, **__):
        raise Ways(**(vars(ways(torques=torques)) | {"in_vain": (vain,)})).told()

    def search(own, *, motor, ambient, goal, best_alone=False):
        sought.append((own.peak_torque, best_alone))
        if own.peak_torque > 21.0:
            raise SizingInfeasibleError("no.", binding=("YIELD",), most_torque=None)
        return design(own)

    monkeypatch.setattr(no_nearer, "size_or_nearest", refused)
    monkeypatch.setattr(no_nearer, "size_to_verdict", search)
    with pytest.raises(SizingInfeasibleError) as caught:
        no_nearer.size_or_refuse(asked)
    assert caught.value.to_dict()["most_peak_torque_Nm"] == pytest.approx(20.808)
    assert sought == [
        (pytest.approx(20.4), False),
        (pytest.approx(20.808), False),
        (pytest.approx(21.2242, abs=1e-3), True),
    ]
