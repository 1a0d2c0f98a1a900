"""Figures in the text of pages are those that the code gives now."""

import re
from pathlib import Path

import pytest

import cqdd_design as cq
from cqdd_design.machine import resolve
from cqdd_design.machine.contact_analysis import analyse_contact

DOCS = Path(__file__).resolve().parents[2] / "docs"
DESIGNS = ("plain-10", "knee-8", "efficient-10", "three-discs-9", "wrist-15")


def page(name: str) -> str:
    return " ".join((DOCS / f"{name}.md").read_text(encoding="utf-8").split())


def found(text: str, name: str) -> list[float]:
    """The numbers of the one place of a page that reads so; ``#`` stands for a number."""
    pattern = re.escape(text).replace(r"\#", r"(-?\d+(?:\.\d+)?)")
    (numbers,) = re.findall(pattern, page(name))
    return [float(one) for one in ([numbers] if isinstance(numbers, str) else numbers)]


def results(design: str | Path, **asked: object) -> dict:
    return cq.analyse(design, **{"angles": 24} | asked).to_dict()["results"]


@pytest.mark.deep
def test_perfect_parts_ripple_as_the_ensemble_and_the_equilibrium_say():
    """Beside the rows of ensembles stands what the same model says of perfect parts."""
    backlash, ripple = found("| perfect parts | # | # | |", "contact-model")
    (half,) = found("Perfect parts have \u00b1# N\u00b7m", "contact-model")
    missing, whole = found("not at all (# N\u00b7m of the # N\u00b7m of ripple", "contact-model")
    told = results("cqdd-10", torque="40 N*m", angles=360)["precision"]
    assert backlash == pytest.approx(told["backlash_arcmin"], abs=0.05)
    assert missing == pytest.approx(abs(ripple - told["torque_ripple_pp_Nm"]), abs=0.006)
    assert ripple == pytest.approx(told["torque_ripple_pp_Nm"], abs=0.03)
    assert half == pytest.approx(0.5 * ripple, abs=0.006)
    assert whole == pytest.approx(ripple, abs=0.05)
    # Nearly all of it is friction's.
    still = results("cqdd-10", torque="40 N*m", friction="off")["precision"]
    assert still["torque_ripple_pp_Nm"] < 0.1 * ripple


@pytest.mark.deep
def test_what_the_disc_of_s_gives_is_as_told():
    told = results("reference-s")["bodies"]["tooth_compliance"]
    numbers = found(
        "design S has # nm/N (# to # by place) on its bearing, between # (# to #) with the bore "
        "held round and # (# to #) with the bore free",
        "contact-model",
    )
    ends = ("mean_nm_per_N", "least_nm_per_N", "greatest_nm_per_N")
    places = ("on_bearing", "bore_round", "bore_free")
    assert numbers == pytest.approx([told[p][k] for p in places for k in ends], abs=0.06)


@pytest.mark.deep
def test_heat_takes_the_backlash_of_s_as_told():
    numbers = found(
        "Reference design S: #' at # \u00b0C, #' at # \u00b0C, #' at # \u00b0C, where pins overlap "
        "by # \u00b5m",
        "theory",
    )
    for told, warmth in zip(numbers[0:6:2], numbers[1:6:2], strict=True):
        precision = results("reference-s", temperature=f"{warmth:g} degC")["precision"]
        assert told == pytest.approx(precision["backlash_arcmin"], abs=0.051 if told < 2 else 0.006)
    assert numbers[6] == pytest.approx(precision["preload_overlap_um"], abs=0.051)


@pytest.mark.deep
def test_teeth_carry_so_much_more_than_the_rigid_law_says():
    peak, most_at_peak, going, most_going = found(
        "usual clearances # to # times the rigid ones at the peak torque and # to # times at the "
        "continuous torque",
        "assumptions",
    )
    shares: dict[str, list[float]] = {"peak_torque": [], "continuous_torque": []}
    for one in (
        *(DOCS / "gallery" / f"{name}.toml" for name in DESIGNS),
        "cqdd-10",
        "printed-13",
        "reference-s",
    ):
        design = cq.load(one)
        for name, kept in shares.items():
            machine = resolve(design.under_torque(getattr(design.requirements, name)))
            told = analyse_contact(machine, angles=24).to_dict()["contact"]["ring_force_max_N"]
            kept.append(told / machine.analyse(angles=24).to_dict()["rigid"]["ring_force_max_N"])
    ends = [end(kept) for kept in shares.values() for end in (min, max)]
    assert [peak, most_at_peak, going, most_going] == pytest.approx(ends, abs=0.06)
