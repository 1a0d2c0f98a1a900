"""Where no two discs push one pin, blocks of one disc each give what the whole system gives."""

from __future__ import annotations

import numpy as np
import pytest

from cqdd_design.gearbox.contact.compliant_apart_kernel import assemble_apart, eliminate_apart
from cqdd_design.gearbox.contact.compliant_kernel import (
    assemble,
    discs_meet,
    eliminate,
    yielding_work,
)
from cqdd_design.gearbox.contact.kernel_values import (
    Compliance,
    Contacts,
    Springs,
    YieldingWork,
)

TEETH, CONTACTS = 7, 11
TOUCHING = {
    1: [[0, 2, 3, 8, 9]],
    2: [[0, 1, 4, 7, 10], [2, 5, 6, 8]],
    3: [[0, 9], [1, 2, 3, 5, 6], [4, 7, 8]],
}


def solved(discs: int, bed: float, *, apart: bool) -> tuple[YieldingWork, float]:
    """A Newton step of a state that is drawn, by blocks or by the whole system."""
    draw = np.random.default_rng(discs)
    work = yielding_work(discs, CONTACTS)
    shape = (discs, CONTACTS)
    work.push[:] = draw.normal(size=(*shape, 4))
    work.stiff[:] = draw.uniform(0.5, 2.0, shape)
    work.lack[:] = draw.normal(size=shape)
    work.gradient[:] = draw.normal(size=work.gradient.size)
    work.change[:] = 0.0
    work.first[0] = 0
    for d, some in enumerate(TOUCHING[discs]):
        work.touching[d, : len(some)] = some
        work.first[d + 1] = work.first[d] + len(some)
    contacts = Contacts(
        draw.normal(size=(*shape, 3)),
        draw.normal(size=shape),
        np.ones(shape),
        draw.normal(size=(discs, 2)),
        np.full(discs, 1e-3),
    )
    bodies = 0.05 * draw.normal(size=(*shape, CONTACTS))
    compliance = Compliance(0.1 * np.eye(discs), draw.uniform(0.2, 0.8, discs), 3.0, bodies)
    springs = Springs(TEETH, 0, 0, 0.0, 0.0, np.zeros(discs), 2.0, 1.5, bed)
    u = draw.normal(size=4 + 3 * discs)
    assert not discs_meet(work.touching, work.first, TEETH)
    fixed = 0 if bed > 0.0 else 2
    if apart:
        assemble_apart(contacts, springs, compliance, u, 1e-9, work)
        return work, eliminate_apart(work, fixed)
    assemble(contacts, springs, compliance, u, 1e-9, work)
    return work, eliminate(work, fixed)


@pytest.mark.parametrize("bed", [0.0, 4.0])
@pytest.mark.parametrize("discs", [1, 2, 3])
def test_blocks_are_the_whole_system_to_the_bit(discs: int, bed: float) -> None:
    blocks, turn = solved(discs, bed, apart=True)
    whole, same_turn = solved(discs, bed, apart=False)
    np.testing.assert_array_equal(blocks.step, whole.step)
    np.testing.assert_array_equal(blocks.change, whole.change)
    assert turn == same_turn
    assert np.abs(blocks.step[2:]).min() > 0.0
    assert np.count_nonzero(blocks.change) == whole.first[-1]
