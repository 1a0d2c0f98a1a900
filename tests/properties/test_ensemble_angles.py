"""Crank angles of an ensemble: how many, which of them serve backlash and what binds."""

import numpy as np
import pytest

from cqdd_design.gearbox.tolerance.ensemble import _MOST_PAIRS
from cqdd_design.gearbox.tolerance.evaluate import (
    PER_TOOTH,
    marked_angles,
    thinned_angles,
    turn_angles,
)


@pytest.mark.parametrize("lobes", [4, 6, 8, 9, 10, 11, 13, 18, 24, 30, 40, 60])
def test_the_turn_has_about_a_thousand_angles_and_every_phase_of_the_teeth_is_marked(lobes):
    teeth = lobes * (lobes + 1)
    angles = turn_angles(lobes)
    to_a_tooth, rest = divmod(angles, teeth)
    assert rest == 0
    assert PER_TOOTH[1] <= to_a_tooth <= PER_TOOTH[0]
    assert to_a_tooth == PER_TOOTH[0] or (to_a_tooth + 1) * teeth > 1000
    marked = np.flatnonzero(marked_angles(lobes, angles))
    # Half as many again, or fewer, than two hundred; never the eighty that missed what binds.
    assert min(angles, 130) <= marked.size <= 340
    assert set(marked % to_a_tooth) == set(range(to_a_tooth))


def test_two_hundred_is_enough_angles_for_any_number():
    for count in (8, 100, 880, 1234, 10_000):
        marked = np.flatnonzero(marked_angles(10, count))
        assert marked[0] == 0
        assert min(count, 130) <= marked.size <= 340


def test_elastic_bodies_of_many_teeth_fit_into_memory():
    """Ratio 40 with two discs and 12 pins; eight angles to a tooth did not."""
    pairs = 2 * (41 + 12) ** 2
    assert turn_angles(40) * pairs <= _MOST_PAIRS < 8 * 40 * 41 * pairs


@pytest.mark.parametrize("lobes", [4, 6, 8, 10, 11, 13, 24, 40])
def test_backlash_and_stiffness_are_of_fewer_angles_that_see_every_phase_of_the_teeth(lobes):
    angles = turn_angles(lobes)
    marked = np.flatnonzero(marked_angles(lobes, angles))
    thinned = marked[thinned_angles(marked.size)]
    assert min(marked.size, 59) <= thinned.size <= 130
    to_a_tooth = angles // (lobes * (lobes + 1))
    seen = np.bincount(thinned % to_a_tooth, minlength=to_a_tooth)
    # As often as all others, but for a third or what few angles cannot help.
    assert seen.min() > 0.66 * seen.mean() - 1.0
    for few in (1, 2, 59, 60, 61):
        assert thinned_angles(few).sum() == min(few, 60)
        assert thinned_angles(few)[0]
