"""Compiled: one Newton step of contacts with bodies that yield, where no two discs push one pin.

Then discs share the carrier alone, and the system of :mod:`.compliant_kernel` falls into one block
for each of them. A row of a block begins with eight columns whose places are always the same, and
rows are taken four columns at a time, which processors do at once; entries left of a pivot, which
nobody reads again, go with the rest. What is done to every number, and in which order, is what
:func:`.compliant_kernel.eliminate` does to it.
"""

from __future__ import annotations

from typing import Any

from cqdd_design.files.kernel_part import part
from cqdd_design.gearbox.contact.compliant_kernel import add_cam, carrier_motion, swap_for_pivot
from cqdd_design.gearbox.contact.kernel_values import Compliance, Contacts, Springs, YieldingWork

_SIDE, _CARRIER, _FORCES = 3, 4, 8
"""Columns of a block: three motions of the disc, right-hand side, four of the carrier, forces."""
_CARRIER_ROW, _FORCE_ROW = 3, 7
"""Rows of a block: three motions of the disc, four of the carrier, forces."""


@part(borrows=True, forceinline=True)
def _end(touch: int) -> int:
    """Columns of a block with so many forces, in whole fours."""
    return _FORCES + 4 * ((touch + 3) // 4)


@part(borrows=True, forceinline=True)
def assemble_apart(
    contacts: Contacts,
    springs: Springs,
    compliance: Compliance,
    u: Any,
    ridge: float,
    work: YieldingWork,
) -> None:
    """The system of forces and motions, into `work.blocks`."""
    rows, push, gradient, lack = contacts.rows, work.push, work.gradient, work.lack
    touching, stiff, first, blocks = work.touching, work.stiff, work.first, work.blocks
    at_cap, pins, bodies = compliance.at_cap, compliance.pins, compliance.bodies
    teeth, bed, join = springs.teeth, springs.carrier_stiffness, compliance.join
    yields = bodies.shape[0] > 0
    for d in range(at_cap.size):
        block, own, shown = blocks[d], touching[d], at_cap[d]
        touch = first[d + 1] - first[d]
        end = _end(touch)
        for i in range(_FORCE_ROW):
            for j in range(end):
                block[i, j] = 0.0
        for i in range(touch):
            k, row = own[i], block[_FORCE_ROW + i]
            for j in range(touch):
                row[_FORCES + j] = bodies[d, own[j], k] if yields else 0.0
            for j in range(_FORCES + touch, end):
                row[j] = 0.0
            row[_FORCES + i] += 1.0 / stiff[d, k]
            nx, ny, h = rows[d, k, 0], rows[d, k, 1], rows[d, k, 2]
            fx, fy = push[d, k, 0], push[d, k, 1]
            row[0], row[1], row[2], row[_SIDE] = nx, ny, h, -lack[d, k]
            block[0, _FORCES + i] = -fx
            block[1, _FORCES + i] = -fy
            block[2, _FORCES + i] = -push[d, k, 2]
            if k < teeth:
                row[4], row[5], row[6], row[7] = 0.0, 0.0, 0.0, 0.0
                continue
            row[_FORCES + i] += pins[d, d] * (nx * fx + ny * fy)
            row[4] = -nx if bed > 0.0 else 0.0
            row[5] = -ny if bed > 0.0 else 0.0
            row[6] = -(1.0 - shown) * h
            row[7] = -shown * h
            held = push[d, k, 3]
            block[_CARRIER_ROW, _FORCES + i] = fx if bed > 0.0 else 0.0
            block[_CARRIER_ROW + 1, _FORCES + i] = fy if bed > 0.0 else 0.0
            block[_CARRIER_ROW + 2, _FORCES + i] = (1.0 - shown) * held
            block[_CARRIER_ROW + 3, _FORCES + i] = shown * held
        add_cam(contacts, springs, u, d, block, 0, 0)
        for i in range(3):
            block[i, i] += ridge
            block[i, _SIDE] = -gradient[4 + 3 * d + i]
    carrier = blocks[0, _CARRIER_ROW:_FORCE_ROW, _CARRIER:_FORCES]
    carrier[0, 0] = bed if bed > 0.0 else 1.0
    carrier[1, 1] = bed if bed > 0.0 else 1.0
    carrier[2, 2] = join
    carrier[2, 3] = -join
    carrier[3, 2] = -join
    carrier[3, 3] = join
    for i in range(4):
        carrier[i, i] += ridge
        blocks[0, _CARRIER_ROW + i, _SIDE] = -gradient[i]


@part(borrows=True, forceinline=True)
def _clear_row(row: Any, pivot: Any, share: float, low: int, high: int) -> None:
    """Take a share of the pivot's row out of another, in columns from `low` to `high`, by fours."""
    for j in range(low, high, 4):
        a = row[j] - share * pivot[j]
        b = row[j + 1] - share * pivot[j + 1]
        c = row[j + 2] - share * pivot[j + 2]
        d = row[j + 3] - share * pivot[j + 3]
        row[j], row[j + 1], row[j + 2], row[j + 3] = a, b, c, d


@part(borrows=True, forceinline=True)
def _clear(block: Any, i: int, column: int, inverse: float, rows: Any, columns: Any) -> None:
    """Take the pivot (row i and column) out of some rows, in the first eight columns and others."""
    pivot = block[i]
    for j in range(rows[0], rows[1]):
        row = block[j]
        share = row[column] * inverse
        if share != 0.0:
            _clear_row(row, pivot, share, 0, _FORCES)
            _clear_row(row, pivot, share, columns[0], columns[1])


@part(borrows=True, forceinline=True)
def _hand_on(blocks: Any, giver: int, taker: int) -> None:
    """The carrier's own rows as the blocks before have left them."""
    for i in range(_CARRIER_ROW, _FORCE_ROW):
        for j in range(_SIDE, _FORCES):
            blocks[taker, i, j] = blocks[giver, i, j]


@part(borrows=True, forceinline=True)
def eliminate_apart(work: YieldingWork, fixed: int) -> float:
    """Motions into `work.step`, changes of force into `work.change`, where the contacts touch.

    Of the carrier's motions the first `fixed` do not move. Returned is the torque over the turn of
    the plate, see :func:`.compliant_kernel.eliminate`.
    """
    blocks, step, first, touching = work.blocks, work.step, work.first, work.touching
    change, discs = work.change, first.size - 1
    carrier, none = (_CARRIER_ROW + fixed, _FORCE_ROW), (0, 0)
    for d in range(discs):
        if d > 0:
            _hand_on(blocks, d - 1, d)
        block, touch = blocks[d], first[d + 1] - first[d]
        end, last = _end(touch), _FORCE_ROW + touch
        for i in range(touch):
            r, c = _FORCE_ROW + i, _FORCES + i
            inverse = 1.0 / block[r, c]
            columns = (_FORCES + 4 * ((i + 1) // 4), end)
            _clear(block, r, c, inverse, (0, 3), columns)
            _clear(block, r, c, inverse, carrier, columns)
            _clear(block, r, c, inverse, (r + 1, last), columns)
    for d in range(discs):
        if discs > 1:
            _hand_on(blocks, (d - 1) % discs, d)
        block = blocks[d]
        for i in range(3):
            swap_for_pivot(block, i, i, 3, (0, _FORCES))
            inverse = 1.0 / block[i, i]
            _clear(block, i, i, inverse, (i + 1, 3), none)
            _clear(block, i, i, inverse, carrier, none)
    turn = carrier_motion(blocks[discs - 1], _CARRIER_ROW, _SIDE, fixed, work)
    for d in range(discs - 1, -1, -1):
        block, own = blocks[d], 4 + 3 * d
        for i in range(2, -1, -1):
            left = block[i, _SIDE]
            for k in range(fixed, 4):
                left -= block[i, _CARRIER + k] * step[k]
            for k in range(i + 1, 3):
                left -= block[i, k] * step[own + k]
            step[own + i] = left / block[i, i]
        touch = first[d + 1] - first[d]
        for i in range(touch - 1, -1, -1):
            row = block[_FORCE_ROW + i]
            left = row[_SIDE]
            for k in range(i + 1, touch):
                left -= row[_FORCES + k] * change[d, touching[d, k]]
            for k in range(fixed, 4):
                left -= row[_CARRIER + k] * step[k]
            for k in range(3):
                left -= row[k] * step[own + k]
            change[d, touching[d, i]] = left / row[_FORCES + i]
    return turn
