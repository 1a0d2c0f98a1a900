"""What mere chance finds, sizing does not refuse."""

import re

import numpy as np
import pytest
from brute_search import Space, strongest

from cqdd_design.catalog import find_motor
from cqdd_design.design import requirements_from_mapping
from cqdd_design.errors import DesignError
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.kinds import lightest
from cqdd_design.sizing.nearest import size_or_nearest
from cqdd_design.sizing.refusals import nothing
from cqdd_design.sizing.spaces import FITS
from cqdd_design.sizing.stage_tables import stage_tables

SMALL = {"ratio": 10, "peak_torque": "30 N*m", "outer_diameter": "45 mm", "length": "10 mm"}
SOFT, HARD = "AISI 4140 Q&T 540C", "AISI 52100 / 100Cr6 hardened"
SPACES = [
    Space(16, 50e-3, 18e-3, 2, SOFT, 20.0, 2.0, 500.0),
    Space(6, 60e-3, 14e-3, 2, SOFT, 20.0, 3.0, 2000.0),
    Space(24, 72e-3, 30e-3, 3, HARD, 80.0, 8.0, 1000.0),
]


@pytest.mark.deep
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("space", SPACES, ids=lambda one: f"ratio {one.ratio}")
def test_what_chance_finds_is_not_refused(space):
    strong = strongest(space, seed=1)
    assert strong is not None
    # Chance has found something worth the name: half of what was guessed, at least.
    assert strong.space.peak_torque > 0.5 * space.peak_torque
    asked = strong.space.times(0.99)
    requirements = requirements_from_mapping(asked.requirements)
    hunt = Hunt(requirements, None, None, lambda _: None, stage_tables(asked.ratio), "mass")
    with np.errstate(all="ignore"):
        found = lightest(hunt)
    assert found is not None
    design = found.sized.design
    assert design.requirements.peak_torque == pytest.approx(asked.peak_torque)
    assert design.reducer.pack_length <= space.length + 1e-9
    assert design.reducer.ring.outer_diameter <= space.outer_diameter + 1e-9


def refused(**asked):
    requirements = requirements_from_mapping({**SMALL, **asked})
    return nothing(Hunt(requirements, None, None, lambda _: None, stage_tables(10), "mass"))


@pytest.mark.parametrize(
    ("learnt", "words", "binding"),
    [
        ({"least_bore": 17e-3}, "with the cam bearing that they", "GEO-LIGAMENT-BORE"),
        (
            {"least_bore": 20e-3, "fit": FITS[-1]},
            "with the clearance and cam bearing that",
            "SHAFT",
        ),
        ({"least_bore": 12e-3}, "with the cam bearing that they", "BEARING"),
    ],
)
def test_what_was_learnt_for_some_torques_is_not_said_of_any(learnt, words, binding):
    """At ratio 16 in 50 mm "no gearbox at any torque" stood beside 10.8 N m that fit."""
    requirements = requirements_from_mapping(SMALL)
    hunt = Hunt(requirements, None, None, lambda _: None, stage_tables(10), "mass", **learnt)
    refusal = nothing(hunt)
    assert "at any torque" not in refusal.message
    assert words in refusal.message
    assert refusal.message.startswith("30 N*m at ratio 10, 11.4 N*m of it for ever, do not fit in")
    assert refusal.binding[0].startswith(binding)
    # Of any gearbox it is said where there is none whatever is asked.
    assert (
        "10 fits in a 29 mm ring and 10 mm of length at any torque"
        in refused(outer_diameter="29 mm").message
    )


def test_a_motor_of_which_too_little_is_known_is_refused_before_a_search() -> None:
    """What is not known of it keeps every verdict from a yes, and is named."""
    said: list[str] = []
    asked = requirements_from_mapping({"ratio": 10})
    with pytest.raises(DesignError, match="not known of it are drag") as caught:
        size_or_nearest(asked, said.append, motor=find_motor("CubeMars RI100 KV105"))
    assert "--quick" in caught.value.message
    assert said == []


def test_a_refusal_speaks_of_what_was_asked():
    """Under a duty of its torques, and of no continuous one, of which nobody asks anything."""
    stated = refused(continuous_torque="3 N*m")
    peak, lasting = re.search(
        r"about ([\d.]+) and ([\d.]+) N\*m are carried", stated.message
    ).groups()
    assert stated.message.startswith("30 N*m at ratio 10, 3 N*m of it for ever, do not fit in")
    assert float(lasting) == pytest.approx(0.1 * float(peak), rel=0.1)
    under = refused(duty=[{"torque": "20 N*m", "speed": "2 rad/s", "share": 0.5}])
    assert under.message.startswith("30 N*m at ratio 10, and the duty, do not fit in a 45 mm ring")
    share = float(re.search(r"about (\d+) % of these torques are carried", under.message)[1])
    assert under.most_torque == pytest.approx(0.3 * share, rel=0.04)
    assert 1.0 < share < 100.0
    assert "for ever" not in under.message
