"""The gearbox as the actuator feels it, from the contact engine: error, stiffness, backlash.

The carrier's angle error gamma(theta, T) changes with the load. One kinematic error and one
stiffness over angle stand for it such that the work is right: with the energy Pi = min(E - T gamma)
of the contact engine under T and -T::

    eps(theta) = -(Pi(T) - Pi(-T))/(2 T)        mean of gamma over loads from -T to T
    w(theta)   = -(Pi(T) + Pi(-T))/(2 T)        half of the backlash and p/(p+1) of the windup
    u(theta)   = mean u + ((p+1)/p) (w - mean w)    windup of a spring of exponent p

The stiffness over angle is (mean u/u)^p, its mean set to 1. Where the backlash of a drawn gearbox
varies by more than it winds up, u is kept to so much of its mean that the harmonics of that stay
above zero. The torque that holds the motor under the loads T and -T then varies over angle as
dPi/dphi does in the contact engine; n times that is the torque ripple at the output. The loaded
angle error itself is that of the mean load; mean windup, stiffening and backlash are those of the
loaded curve.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from cqdd_design.actuator.parameters import FloatArray, IntArray, least_stiffness
from cqdd_design.design import Design
from cqdd_design.errors import DesignError
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.states import error_states, nominal_states
from cqdd_design.gearbox.contact.sweep import (
    contact_sweep,
    output_turn_angles,
    output_turn_count,
    perfect_angles,
)
from cqdd_design.gearbox.precision.backlash import backlash
from cqdd_design.gearbox.tolerance.draws import draw_errors
from cqdd_design.geometry import kinematics

MOST_ORDERS = 64
NOISE_FLOOR = 1e-3
"""Harmonics weaker than this share of the strongest are left out."""
_PERFECT_ANGLES = 120
_MOST_CONTACTS = 4_000_000
"""Of a drawn gearbox over its output turn: what a gigabyte of memory holds."""
_PROBES = 24
"""Angles of that turn solved first: a gearbox that cannot be is soon refused."""
USUAL_LEAST = 0.25
"""Share of the mean windup that no spot falls below; where backlash varies much, the least above
it that leaves the stiffness enough of itself everywhere."""
_HALVINGS = 8
_LEAST_STIFFNESS = 0.05
"""Share of the mean."""
_Series = tuple[FloatArray, FloatArray, FloatArray, FloatArray]
"""Cosine and sine coefficients of the error, and those of the stiffness."""


@dataclass(frozen=True, eq=False)
class Transmission:
    """What the contact engine says of one gearbox at one torque, as in `GearParameters`.

    The stiffness is the secant from the end of the dead zone, the stiffening counts from half of
    the torque to it, the backlash is the mean over the turn. `least_windup` is the share of its
    mean that the windup is kept above.
    """

    error_torque: float
    error_orders: IntArray
    error_cosine: FloatArray
    error_sine: FloatArray
    stiffness_cosine: FloatArray
    stiffness_sine: FloatArray
    stiffness: float
    stiffening: float
    backlash: float
    least_windup: float


@lru_cache(maxsize=8)
def transmission(
    model: ContactModel, design: Design, torque: float, *, seed: int | None = None
) -> Transmission:
    """Solve a gearbox for what the actuator feels of it; verdict, shock and bench share it.

    Parameters
    ----------
    model : ContactModel
        Of the same design.
    design : Design
        Whose tolerances the seed draws from.
    torque : float
        N m, above zero.
    seed : int, optional
        Of one drawn gearbox, solved over a whole output turn; default perfect parts.

    Raises
    ------
    ContactError
        When the gearbox has no equilibrium at the torque.
    DesignError
        When its springs do not wind up under load, or by far less than the backlash of a drawn
        gearbox varies, or that has too many contacts.
    """
    n = model.lobe_count
    if seed is None:
        errors = None
        angle = perfect_angles(model, _PERFECT_ANGLES)
        per_turn = round(kinematics.imperfect_period(n) / model.period)
    else:
        _refuse_too_many(model)
        errors = draw_errors(model, design.tolerances, seed, 0, 1).one(0)
        for load in (torque, -torque):
            contact_sweep(model, load, output_turn_angles(model, _PROBES), errors=errors)
        angle, per_turn = output_turn_angles(model), 1
    states = nominal_states(model, angle)
    changed = error_states(model, states, errors)
    whole, half = (
        _Loaded(
            load,
            *(
                contact_sweep(model, sense * load, errors=errors, states=states, changed=changed)
                for sense in (1.0, -1.0)
            ),
        )
        for load in (torque, 0.5 * torque)
    )
    free = float(backlash(model, errors=errors, states=states).free.mean())
    return _felt(whole, half, free, per_turn)


@dataclass(frozen=True, eq=False)
class _Loaded:
    """A gearbox under a torque, N m, of either sense."""

    torque: float
    ahead: ContactSweep
    behind: ContactSweep

    @property
    def opening(self) -> float:
        """Half of the mean angle between the carrier's places under both, rad."""
        apart = self.ahead.carrier_angle_error - self.behind.carrier_angle_error
        return 0.5 * float(np.mean(apart))


def _felt(whole: _Loaded, half: _Loaded, free: float, per_turn: int) -> Transmission:
    """The gearbox from its sweeps under the torque and half of it, and its mean backlash, rad."""
    torque, ahead, behind = whole.torque, whole.ahead, whole.behind
    mean, half_mean = whole.opening - 0.5 * free, half.opening - 0.5 * free
    if not 0.0 < half_mean < mean:
        raise DesignError(
            f"the gearbox does not wind up beyond its backlash at {torque:g} N*m; raise "
            "requirements.continuous_torque, or lower the clearances."
        )
    power = float(np.clip(math.log(2.0) / math.log(mean / half_mean), 1.0, 4.0))
    error = -(ahead.energy - behind.energy) / (2.0 * torque)
    work = -(ahead.energy + behind.energy) / (2.0 * torque)
    windup = mean + (power + 1.0) / power * (work - work.mean())

    def above(least: float) -> tuple[IntArray, _Series]:
        share = (mean / np.maximum(windup, least * mean)) ** power
        return _harmonics(error, share / share.mean(), per_turn, mean)

    def enough(least: float) -> bool:
        orders, series = above(least)
        return least_stiffness(orders, *series[2:]) >= _LEAST_STIFFNESS

    least = _least_share(enough)
    if least is None:
        raise DesignError(
            f"at {torque:g} N*m the gearbox winds up by {math.degrees(mean) * 60.0:.2g} arcmin, "
            "too little beside what its backlash varies by over the turn for a stiffness over "
            "angle; raise requirements.continuous_torque, or tighten the tolerances."
        )
    orders, series = above(least)
    return Transmission(
        error_torque=torque,
        error_orders=orders,
        error_cosine=series[0],
        error_sine=series[1],
        stiffness_cosine=series[2],
        stiffness_sine=series[3],
        stiffness=torque / mean,
        stiffening=power,
        backlash=free,
        least_windup=least,
    )


def _least_share(enough: Callable[[float], bool]) -> float | None:
    """The least share of the mean windup that is enough, from the usual one to all of it."""
    if enough(USUAL_LEAST):
        return USUAL_LEAST
    short, least = USUAL_LEAST, 1.0
    if not enough(least):
        return None
    for _ in range(_HALVINGS):
        middle = 0.5 * (short + least)
        short, least = (short, middle) if enough(middle) else (middle, least)
    return least


def _refuse_too_many(model: ContactModel) -> None:
    """Raise where the states of a drawn gearbox over its output turn are beyond memory."""
    each = model.disc_count * (model.tooth_count + model.pin_count)
    contacts = output_turn_count(model.lobe_count) * each
    if contacts > _MOST_CONTACTS:
        raise DesignError(
            f"a gearbox drawn from the tolerances has {contacts / 1e6:.3g} million contacts over "
            f"an output turn at ratio {model.lobe_count}, more than {_MOST_CONTACTS / 1e6:g} "
            "million; use perfect parts (without a seed or samples)."
        )


def _harmonics(
    error: FloatArray, share: FloatArray, per_turn: int, windup: float
) -> tuple[IntArray, _Series]:
    """Orders worth keeping, and cosine and sine coefficients of error and stiffness share."""
    count = len(error)
    spectra = [np.fft.rfft(values) * (2.0 / count) for values in (error, share)]
    size = np.abs(spectra[0]) + windup * np.abs(spectra[1])
    size[0] = 0.0
    if count % 2 == 0:
        # The last line of an even count has no sine: its phase is not known.
        size[-1] = 0.0
    index = np.flatnonzero(size > NOISE_FLOOR * size.max())
    if len(index) > MOST_ORDERS:
        # Ripple grows with the order.
        index = np.sort(index[np.argsort(-size[index] * index, kind="stable")[:MOST_ORDERS]])
    coefficients = [part for s in spectra for part in (s.real[index], -s.imag[index])]
    return index * per_turn, tuple(coefficients)  # type: ignore[return-value]
