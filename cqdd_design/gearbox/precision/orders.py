"""Order spectra over one output turn, with the orders named for what causes them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cqdd_design.geometry.contours import FloatArray

STRONGEST = 12


@dataclass(frozen=True)
class Order:
    """One harmonic of a quantity over the output turn.

    Attributes
    ----------
    per_output_turn : int
        Periods in one output turn: a whole number for every cause in the gearbox.
    per_crank_turn : float
        The same in one crank turn.
    name : str
        What repeats at it.
    amplitude : float
        Half of its peak to peak, in the unit of the quantity.
    """

    per_output_turn: int
    per_crank_turn: float
    name: str
    amplitude: float


def order_name(order: int, lobe_count: int, pin_count: int, cogging: int = 0) -> str:
    """Name an order over the output turn for what repeats so often.

    Errors fixed in the crank or in the ring's teeth repeat with the crank (n times a turn);
    errors fixed in the discs' lobes and holes or in the pins repeat as the crank meets them
    (n + 1 times); perfect parts repeat with every tooth, n (n + 1), or pin, N_w (n + 1).

    Parameters
    ----------
    cogging : int
        Periods of the motor's cogging in one of its turns; 0 where there is none.

    Examples
    --------
    >>> order_name(2520, 10, 5, cogging=252)
    'cogging 1'
    >>> order_name(10, 10, 5), order_name(11, 10, 5), order_name(110, 10, 5)
    ('crank 1', 'lobes and pins 1', 'teeth 1 (all)')
    """
    n, met = lobe_count, lobe_count + 1
    if order % (n * met) == 0:
        return f"teeth {order // (n * met)} (all)"
    if order % (pin_count * met) == 0:
        return f"pins {order // (pin_count * met)} (all)"
    if order == n:
        return "crank 1"
    if cogging > 1 and order % (n * cogging) == 0:
        return f"cogging {order // (n * cogging)}"
    if order % n == 0:
        return f"crank and ring teeth {order // n}"
    if order % met == 0:
        return f"lobes and pins {order // met}"
    return "mixed"


def order_spectrum(
    values: FloatArray,
    crank_span: float,
    lobe_count: int,
    pin_count: int,
    strongest: int = STRONGEST,
) -> tuple[Order, ...]:
    """The strongest orders of a quantity sampled evenly over its period.

    Parameters
    ----------
    values : array (A,)
        Even samples over `crank_span`, end left out.
    crank_span : float
        Crank angle of one period, rad; a whole share of an output turn.
    lobe_count, pin_count : int
        n and N_w.
    strongest : int
        How many to return, in falling order of amplitude; those below 1e-9 of the first are left
        out.
    """
    count = len(values)
    amplitude = 2.0 * np.abs(np.fft.rfft(values - values.mean())) / count
    if count % 2 == 0:
        amplitude[-1] *= 0.5
    amplitude[0] = 0.0
    per_turn = round(2.0 * math.pi * lobe_count / crank_span)
    found = []
    for index in np.argsort(-amplitude, kind="stable")[:strongest]:
        if amplitude[index] <= 1e-9 * amplitude.max():
            break
        order = int(index) * per_turn
        found.append(
            Order(
                per_output_turn=order,
                per_crank_turn=order / lobe_count,
                name=order_name(order, lobe_count, pin_count),
                amplitude=float(amplitude[index]),
            )
        )
    return tuple(found)
