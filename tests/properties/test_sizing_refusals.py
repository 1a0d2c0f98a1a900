"""What mere chance finds, sizing does not refuse."""

import numpy as np
import pytest
from brute_search import Space, strongest

from cqdd_design.design import requirements_from_mapping
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.kinds import lightest
from cqdd_design.sizing.stage_tables import stage_tables

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
