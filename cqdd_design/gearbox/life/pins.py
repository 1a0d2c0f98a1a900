"""Bending fatigue of the output pins: the moment of all discs, fibre by fibre round the pin.

The crank goes round a pin and pushes it along its own direction, so moment and direction both
vary. In carrier axes the stress of a fibre over one turn of the crank against the carrier is
followed and its cycles are counted. With one sense of torque the worst fibre pulsates from
nothing. When the duty has both senses their order is not known, so the pulses of one are paired
with those of the other, the greatest first, each pair one cycle from the one top to the other: the
rule of ASME VIII-2 (2021), annex 5-B, for load histories without an order. With equal torques and
times in both senses every cycle is then fully reversed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cqdd_design.gearbox import output_pins
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.life import fatigue
from cqdd_design.gearbox.output_pins import PinSupport
from cqdd_design.geometry.contours import ComplexArray, FloatArray

Cycle = tuple[float, float, float]
"""Lowest and highest stress, Pa, and how many of them an hour."""

_FIBRES = 72


@dataclass(frozen=True)
class FibreCycles:
    """Stress cycles of one fibre of a pin under the duty.

    Attributes
    ----------
    cycles : tuple of (low, high, per hour)
    section : int
        Section of :func:`moment_arms` that the fibre lies in.
    """

    cycles: tuple[Cycle, ...]
    section: int

    def damage(self, limit: float, ultimate: float, factor: float = 1.0) -> float:
        """Damage per hour, all stresses multiplied; `limit` in reversed bending."""
        if not self.cycles:
            return 0.0
        low, high, rate = np.array(self.cycles).T
        swing = fatigue.goodman_reversed(factor * low, factor * high, ultimate)
        return float(np.sum(rate / fatigue.pin_cycles(swing, limit, ultimate)))

    def reversed_amplitude(self, ultimate: float) -> float:
        """Largest reversed amplitude on Goodman's line, Pa."""
        if not self.cycles:
            return 0.0
        low, high, _ = np.array(self.cycles).T
        return float(fatigue.goodman_reversed(low, high, ultimate).max())


def moment_arms(
    disc_count: int, disc_thickness: float, disc_spacing: float, support: PinSupport
) -> FloatArray:
    """Bending moment at the sections judged per newton of every disc, (sections, D), m.

    Held at both ends: at the middle of every disc, simply supported, the disc's own force spread
    over its thickness as in :func:`.output_pins.bending_arm`. Cantilever: at the plate.
    """
    at = output_pins.disc_positions(disc_count, disc_thickness, disc_spacing)
    if support == "cantilever":
        return np.asarray(at[None, :])
    span = float(output_pins.pin_span(disc_count, disc_thickness, disc_spacing))
    near, far = np.minimum.outer(at, at), np.maximum.outer(at, at)
    return np.asarray(near * (span - far) / span - np.eye(disc_count) * disc_thickness / 8.0)


def pin_force_histories(sweep: ContactSweep) -> ComplexArray:
    """Force of every disc on a pin over one turn of the crank against the carrier.

    Parameters
    ----------
    sweep : ContactSweep
        Over the mesh period, which is 1/g of that turn, g = gcd(n, N_w). A period later each pin
        carries what the one N_w/g before it carried, so a history runs over g pins.

    Returns
    -------
    array (g A, D, N_w/g)
        Complex in the pin's own axes, radial and tangential, N. The other pins of the circle
        differ from these in nothing but the time.
    """
    model = sweep.model
    shared = math.gcd(model.lobe_count, model.pin_count)
    different = model.pin_count // shared
    middle = sweep.pin_point - model.pin_contact_radius * sweep.pin_normal
    outward = middle[..., 0] + 1j * middle[..., 1]
    load = sweep.pin_load
    on_disc = load[..., 0] + 1j * load[..., 1]
    force = -on_disc * np.conj(outward) / np.abs(outward)
    pin = np.arange(different) - different * np.arange(shared)[:, None]
    return np.concatenate([force[:, :, row] for row in np.mod(pin, model.pin_count)])


def bending_histories(sweep: ContactSweep, arms: FloatArray, diameter: float) -> ComplexArray:
    """Bending stress vector over the same turn, (N_w/g, sections, g A), Pa.

    Its size is the greatest stress in the section; the real part of it turned back by an angle is
    the stress of the fibre at that angle from the outward radius.
    """
    per_moment = 32.0 / (math.pi * diameter**3)
    return np.asarray(
        per_moment * np.einsum("sd,adp->psa", arms, pin_force_histories(sweep)), dtype=complex
    )


def worst_fibres(
    stresses: Sequence[ComplexArray],
    torques: Sequence[float],
    turns_per_hour: FloatArray,
    held: Sequence[bool],
    ultimate: float,
) -> list[FibreCycles]:
    """Cycles of the fibres worst loaded in one case or another of a duty.

    Parameters
    ----------
    stresses : sequence of array (N_w/g, sections, turns)
        From :func:`bending_histories`, for each load case, Pa.
    torques : sequence of float
        Of each case, N m; the sign counts.
    turns_per_hour : array (C,)
        Turns of the crank against the carrier, the share of time in them.
    held : sequence of bool
        Whether the case is a torque held at standstill. How often it comes is not known: it is
        taken as often as pulses of the other sense can meet it.
    ultimate : float
        S_u, Pa.
    """
    rates = [math.inf if still else float(t) for t, still in zip(turns_per_hour, held, strict=True)]
    fibre = np.exp(-2j * math.pi * np.arange(_FIBRES) / _FIBRES)
    extremes = [_extremes(stress, fibre) for stress in stresses]
    places = set()
    for case, rate in enumerate(rates):
        if rate <= 0.0 or math.isinf(rate):
            continue
        met = [k for k, r in enumerate(rates) if r > 0.0 and torques[k] * torques[case] < 0.0]
        low = np.min([extremes[k][0] for k in (case, *met)], axis=0)
        high = np.max([extremes[k][1] for k in (case, *met)], axis=0)
        swing = fatigue.goodman_reversed(low, high, ultimate)
        places.add(tuple(int(i) for i in np.unravel_index(int(swing.argmax()), swing.shape)))
    found = []
    for pin, section, angle in sorted(places):
        histories = [(stress[pin, section] * fibre[angle]).real for stress in stresses]
        found.append(FibreCycles(tuple(_duty_cycles(histories, torques, rates)), section))
    return found


def _extremes(stress: ComplexArray, fibre: ComplexArray) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest stress over the turn, (N_w/g, sections, fibres)."""
    every = (stress[..., None] * fibre).real
    return every.min(axis=2), every.max(axis=2)


def _duty_cycles(
    histories: Sequence[FloatArray], torques: Sequence[float], rates: Sequence[float]
) -> list[Cycle]:
    """Cycles an hour of a fibre: the largest of every turn paired over the senses, and the rest."""
    found: list[Cycle] = []
    senses: dict[bool, list[Cycle]] = {True: [], False: []}
    for history, torque, rate in zip(histories, torques, rates, strict=True):
        if rate <= 0.0 or not np.any(history):
            continue
        senses[torque >= 0.0].append((float(history.min()), float(history.max()), rate))
        if math.isfinite(rate):
            found += [(low, high, count * rate) for low, high, count in _lesser_cycles(history)]
    return found + paired_cycles(senses[True], senses[False])


def _lesser_cycles(history: FloatArray) -> list[Cycle]:
    """All cycles of a history that repeats but its largest."""
    start = int(history.argmax())
    counted = fatigue.rainflow(np.append(np.roll(history, -start), history[start]))
    left, largest = [], 1.0
    for low, high, count in sorted(counted, key=lambda c: c[0] - c[1]):
        used = min(count, largest)
        largest -= used
        if count > used:
            left.append((low, high, count - used))
    return left


def paired_cycles(one: Sequence[Cycle], other: Sequence[Cycle]) -> list[Cycle]:
    """Cycles of two groups of pulses whose order is not known, paired to the greatest swings.

    Parameters
    ----------
    one, other : sequence of (low, high, rate)
        Pulses of either sense; an infinite rate meets everything and counts for nothing itself.

    Examples
    --------
    >>> paired_cycles([(0.0, 9.0, 2.0), (0.0, 4.0, 5.0)], [(-6.0, 0.0, 3.0)])
    [(-6.0, 9.0, 2.0), (-6.0, 4.0, 1.0), (0.0, 4.0, 4.0)]
    """
    top = max((high for _, high, _ in one), default=-math.inf)
    if top < max((high for _, high, _ in other), default=-math.inf):
        one, other = other, one
    up = sorted(([*c] for c in one), key=lambda c: -c[1])
    down = sorted(([*c] for c in other), key=lambda c: c[0])
    found: list[Cycle] = []
    while up and down:
        (a_low, a_high, a_rate), (b_low, b_high, b_rate) = up[0], down[0]
        rate = min(a_rate, b_rate)
        if math.isinf(rate):
            break
        found.append((min(a_low, b_low), max(a_high, b_high), rate))
        up[0][2], down[0][2] = a_rate - rate, b_rate - rate
        up, down = [c for c in up if c[2] > 0.0], [c for c in down if c[2] > 0.0]
    found += [(low, high, rate) for low, high, rate in (*up, *down) if math.isfinite(rate)]
    return found
