"""Figures that fit in place of those that are asked for: searched, and as near as they come."""

from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cqdd_design.design import requirements_from_mapping
from cqdd_design.gearbox.checks.state import build_check
from cqdd_design.sizing import looser, nearest
from cqdd_design.sizing.infeasible import SizingInfeasibleError
from cqdd_design.sizing.motor_reach import MotorShortError
from cqdd_design.sizing.ratios import other_ratio
from cqdd_design.sizing.refusals import short_of
from cqdd_design.sizing.verified import new_hunt

ASKED = {
    "ratio": 10,
    "peak_torque": "20 N*m",
    "continuous_torque": "2 N*m",
    "stiffness": "1.5 N*m/arcmin",
    "mass": "1.1 kg",
}
ARCMIN = 3437.746770784939
LINES = {"stiffness": "STIFFNESS", "mass": "MASS"}


def new(**other):
    asked = requirements_from_mapping({**ASKED, **other})
    return new_hunt(asked, lambda _: None, None, None, "mass")


def line(key, value, limit):
    factor = ARCMIN if key == "stiffness" else 1.0
    return build_check(LINES[key], value / factor, limit / factor, "", "")


class World:
    """Designs up to some stiffness (N m/arcmin) and down to some mass (kg), a little beyond."""

    def __init__(self, stiffness, mass, spare=1.0):
        self.stiffness, self.mass, self.spare = stiffness, mass, spare
        self.tried = []

    def __call__(self, own):
        stiff, mass = own.stiffness / ARCMIN, own.mass
        self.tried.append((stiff, mass))
        has = {
            "stiffness": min(self.spare * stiff, self.stiffness),
            "mass": max(mass / self.spare, self.mass),
        }
        lines = [line("stiffness", has["stiffness"], stiff), line("mass", has["mass"], mass)]
        short = [one for one in lines if one.status == "fail"]
        if short:
            return None, short_of(short, None)
        return SimpleNamespace(verdict=SimpleNamespace(lines=lines)), None


def refusal(stiffness=None, mass=None):
    values = {"stiffness": stiffness, "mass": mass}
    asked = {"stiffness": 1.5, "mass": 1.1}
    return short_of([line(k, v, asked[k]) for k, v in values.items() if v is not None], None)


def told(looser):
    assert looser.figures
    return {k: v / ARCMIN if k == "stiffness" else v for k, v in looser.figures.items()}


def test_what_the_nearest_design_has_is_tried_first():
    world = World(1.3271, 0.5)
    figures = told(looser.looser_figures(new(), refusal(stiffness=1.3271), world))
    assert figures == {"stiffness": pytest.approx(1.32)}
    assert world.tried[0] == (pytest.approx(1.32), 1.1)
    # Nearer ones are tried and found to be too much; the mass stays as it is asked for.
    assert all(stiff >= 1.32 - 1e-9 and mass == 1.1 for stiff, mass in world.tried)


@given(
    most=st.floats(0.1, 1.49),
    least=st.floats(1.11, 4.0),
    spare=st.floats(1.0, 1.3),
    off=st.floats(0.5, 1.3),
)
def test_figures_that_are_told_were_found_and_little_nearer_ones_were_not(most, least, spare, off):
    """Whether or not the design that came nearest is one that a search finds again."""
    world = World(most, least, spare)
    figures = looser.looser_figures(new(), refusal(most * off, least / off), world)
    figures = told(figures)
    assert world(SimpleNamespace(stiffness=figures["stiffness"] * ARCMIN, mass=figures["mass"]))[0]
    assert (pytest.approx(figures["stiffness"]), pytest.approx(figures["mass"])) in world.tried
    assert len(world.tried) <= 3 + looser.TRIES + 1
    # Rounded to three digits and searched for within a fiftieth, unless the searches end before.
    for key, bound in (("stiffness", most), ("mass", least)):
        ratio = max(figures[key] / bound, bound / figures[key])
        assert ratio < 1.032 or len(world.tried) >= 2 + looser.TRIES


def test_a_figure_that_nothing_changes_does_not_keep_the_other_away():
    """A rotor is as heavy as it is; the stiffness that was asked for may be had beside it."""
    world = World(1.45, 2.0, spare=1.01)
    figures = told(looser.looser_figures(new(), refusal(0.9, 2.0), world))
    assert 2.0 <= figures["mass"] <= 2.02
    assert 1.3 < figures["stiffness"] <= 1.45


@pytest.mark.parametrize("other", ["MOTOR-CONTINUOUS", "CONTACT-RING-PEAK"])
def test_beside_anything_else_that_is_short_no_figures_are_looked_for(other):
    short = SizingInfeasibleError("no.", binding=("MASS", other), most_torque=None)
    assert looser.looser_figures(new(), short, None) == looser.Looser({})
    assert looser.looser_figures(new(), refusal(), None) == looser.Looser({})


def test_what_is_short_with_any_figure_is_told_instead(monkeypatch):
    hot = SizingInfeasibleError("no.", binding=("SURFACE-TEMPERATURE",), most_torque=None)
    answer = looser.looser_figures(new(), refusal(1.2), lambda _: (None, hot))
    assert answer == ({}, ("stiffness",), ("SURFACE-TEMPERATURE",))
    monkeypatch.setattr(
        nearest, "_less_torque", lambda hunt, error: nearest._Way(hunt, None, error)
    )
    monkeypatch.setattr(nearest, "_limits", lambda _: iter(()))
    monkeypatch.setattr(nearest, "looser_figures", lambda *_: answer)
    error = nearest._with_ways(refusal(1.2), new())
    assert error.message.endswith(
        "With any stiffness it is still short of temperature of housing and cover."
    )
    assert "requirements_that_fit" not in error.to_dict()


def test_figures_are_told_as_a_file_has_them():
    figures = {"stiffness": 1.32 * ARCMIN, "reflected_inertia": 0.0899, "efficiency": 0.875}
    words = looser.in_words(figures)
    assert words == {
        "stiffness": "1.32 N*m/arcmin",
        "reflected_inertia": "0.0899 kg*m^2",
        "efficiency": "0.875",
    }
    read = requirements_from_mapping({**ASKED, **words, "efficiency": 0.875})
    assert read.stiffness == pytest.approx(figures["stiffness"], rel=1e-9)


@pytest.mark.parametrize("free", [False, True])
def test_a_refusal_names_them(monkeypatch, free):
    monkeypatch.setattr(
        nearest, "_less_torque", lambda hunt, error: nearest._Way(hunt, None, error)
    )
    monkeypatch.setattr(nearest, "_limits", lambda _: iter(()))
    world = World(1.3271, 1.2345)
    first = refusal(1.3271, 1.2345)

    def searched(hunt, stated):
        if not world.tried and not hunt.any_will_do:
            raise first
        found, error = world(hunt.requirements)
        if error is not None:
            raise error
        return found

    monkeypatch.setattr(nearest, "searched", searched)
    said = []
    asked = requirements_from_mapping(ASKED)
    if free:
        asked = asked.deriving("peak_torque", "continuous_torque")
    with pytest.raises(SizingInfeasibleError) as caught:
        nearest.size_or_nearest(asked, said.append)
    # What is short is told before the figures are looked for, whatever else was stated.
    assert said.index("looking for the figures that fit") > said.index(first.message)
    assert "What fits, by the whole verdict: stiffness 1.32 N*m/arcmin with mass 1.24 kg." in (
        caught.value.message
    )
    fits = {"stiffness": "1.32 N*m/arcmin", "mass": "1.24 kg"}
    assert caught.value.to_dict()["requirements_that_fit"] == fits
    assert "requirements_that_fit" not in first.to_dict()


@pytest.mark.parametrize(
    ("most", "fits", "told", "tried"),
    [
        (6, {6}, (6, 6, ()), [6]),
        (6, {5}, (5, 6, ()), [6, 5]),
        (6, {4}, (None, 6, ("YIELD",)), [6, 5]),
        (4, set(), (None, 4, ("YIELD",)), [4]),
        (3, set(), (None, 3, ()), []),
    ],
)
def test_the_greatest_ratio_of_a_rotor_that_is_felt_too_much(most, fits, told, tried):
    seen = []

    def search(ratio):
        seen.append(ratio)
        return ratio in fits, () if ratio in fits else ("YIELD",)

    short = MotorShortError("no.", ("REFLECTED-INERTIA",), 8.0, 0.0, most)
    assert tuple(other_ratio(new(), short, search)) == told
    assert seen == tried
