"""Arrays the kernels work on: contacts of ring and pins in one row each, with part errors."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from cqdd_design.gearbox.contact.kernel_values import Toleranced
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.part_errors import SHAFT_SHARE, GearboxErrors
from cqdd_design.gearbox.contact.tables import RingTable, pin_table, ring_table
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.contours import FloatArray

_COMPLIANCES = 16_000_000
"""Numbers of compliances that are kept at once: 128 MB, and twice that while they are made."""

_KEPT = 100_000
"""Contacts at all angles of states that are kept, at most: 15 MB."""


@dataclass(frozen=True, eq=False)
class NominalStates:
    """Contacts of the perfect gearbox at A crank angles; C = teeth + pins.

    At the nominal pose, unless it says otherwise (:mod:`.taken_up`).

    Attributes
    ----------
    crank_angle : array (A,)
        rad, rising.
    pin_angle : array (A, P)
        Angle of every pin in the ring's frame, rad.
    rows : array (A, D, C, 3)
        n_x, n_y and h/length, ring teeth first.
    gaps, coefficient : array (A, D, C)
        m, and the coefficient of the contact's law.
    rates : array (A, D, C, 4)
        Derivatives over crank angle of the normal's angle, of h/length, of the gap and of the
        coefficient (which Johnson's law takes from the changing radius).
    length : float
        Pin circle radius, which turns angles into lengths, m.
    """

    crank_angle: FloatArray
    ring: RingTable
    pin_angle: FloatArray
    rows: FloatArray
    gaps: FloatArray
    coefficient: FloatArray
    rates: FloatArray
    length: float

    def some(self, which: slice) -> NominalStates:
        """Those of some of the crank angles; itself where they are all."""
        if which.indices(len(self.crank_angle)) == (0, len(self.crank_angle), 1):
            return self
        ring = RingTable(**{name: value[which] for name, value in vars(self.ring).items()})
        parts = {
            name: value if name == "length" else value[which]
            for name, value in vars(self).items()
            if name != "ring"
        }
        return NominalStates(ring=ring, **parts)

    @property
    def compliances_at_once(self) -> int:
        """At how many angles compliances between all contacts of discs fit into memory."""
        _, discs, contacts = self.gaps.shape
        return max(int(_COMPLIANCES // (discs * contacts**2)), 1)

    @property
    def turns(self) -> FloatArray:
        """Crank angle since the state before, (A,), rad."""
        return np.diff(self.crank_angle, prepend=self.crank_angle[:1])


def nominal_states(model: ContactModel, crank_angle: FloatArray) -> NominalStates:
    """Contacts of the perfect gearbox.

    Many models of a machine ask at the same angles, so that the last few are kept: what follows
    from them, such as what bodies yield, is then found once too.

    Parameters
    ----------
    crank_angle : array (A,)
        rad.
    """
    contacts = model.disc_count * (model.tooth_count + model.pin_count)
    if contacts * crank_angle.size > _KEPT:
        return _nominal_states(model, crank_angle)
    return _kept_states(model, np.asarray(crank_angle, dtype=float).tobytes())


@lru_cache(maxsize=4)
def _kept_states(model: ContactModel, crank_angle: bytes) -> NominalStates:
    return _nominal_states(model, np.frombuffer(crank_angle).copy())


def _nominal_states(model: ContactModel, crank_angle: FloatArray) -> NominalStates:
    rows, rates, pin_angle = pin_table(model, crank_angle)
    still = np.concatenate([rates, np.zeros((*rates.shape[:-1], 1))], axis=-1)
    gaps = np.full(rows.shape[:-1], model.pin_gap)
    return states_of(
        model, crank_angle, ring_table(model, crank_angle), (rows, still, gaps), pin_angle
    )


def states_of(
    model: ContactModel,
    crank_angle: FloatArray,
    ring: RingTable,
    pins: tuple[FloatArray, FloatArray, FloatArray],
    pin_angle: FloatArray,
) -> NominalStates:
    """Contacts of ring and pins in one row each.

    Parameters
    ----------
    crank_angle : array (A,)
        rad.
    pins : tuple of array
        Rows (A, D, P, 3) with h in m, rates of the normal's angle, of h and of the gap
        (A, D, P, 3), and gaps (A, D, P) of pins at their drawn radius, m.
    pin_angle : array (A, P)
        rad.
    """
    pin_rows, pin_rates, pin_gaps = pins
    length = model.pin_circle_radius
    rows = np.concatenate([ring.rows, pin_rows], axis=2)
    rows[..., 2] /= length
    opening = pin_openings(model, pin_rows, pin_angle)
    moving = np.zeros((*pin_rates.shape[:-1], 4))
    moving[..., :3] = pin_rates
    moving[..., 2] += opening[1]
    softening = -model.ring_law.logarithm * ring.radius_rate
    rates = np.concatenate(
        [np.concatenate([ring.rates, softening[..., None]], axis=-1), moving], axis=2
    )
    rates[..., 1] /= length
    return NominalStates(
        crank_angle=crank_angle,
        ring=ring,
        pin_angle=pin_angle,
        rows=rows,
        gaps=np.concatenate([ring.gap, pin_gaps + opening[0]], axis=2),
        coefficient=np.concatenate(
            [
                model.ring_coefficient(ring.equivalent_radius),
                np.full(pin_gaps.shape, model.pin_coefficient()),
            ],
            axis=2,
        ),
        rates=rates,
        length=length,
    )


def pin_openings(
    model: ContactModel, rows: FloatArray, pin_angle: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """What pins that stand further out than their holes add to the gaps, and its rate, (A, D, P).

    Parameters
    ----------
    rows : array (A, D, P, 3)
        Of the pins.
    pin_angle : array (A, P)
        rad.
    """
    apart = hole_off_pin(model, pin_angle)
    turned = np.stack([-rows[..., 1], rows[..., 0]], axis=-1)
    drift = np.stack([apart[..., 1], -apart[..., 0]], axis=-1) / model.lobe_count
    return (
        np.sum(rows[..., :2] * apart, axis=-1),
        np.sum(turned * apart + rows[..., :2] * drift, axis=-1),
    )


def hole_off_pin(model: ContactModel, pin_angle: FloatArray) -> FloatArray:
    """Hole from its pin by what pins stand further out, in the ring's frame, (A, 1, P, 2), m."""
    outward = np.stack([np.cos(pin_angle), np.sin(pin_angle)], axis=-1)
    return np.asarray(-model.pin_reach * outward[:, None])


def error_states(
    model: ContactModel, states: NominalStates, errors: GearboxErrors | None
) -> Toleranced:
    """What part errors change: plain twin of :func:`.gaps_kernel.fill_errors`.

    A tooth that moves toward the disc or grows, and material on the disc, close the gap; a hole
    that moves along the pin's force or grows opens it, a pin that does closes it. Pins and cams
    stand off with the axes of carrier and shaft, which turn with nothing.
    """
    shape = states.gaps.shape
    offset = np.zeros((*shape[:2], 2))
    half_play = np.full(shape[1], 0.5 * model.cam.play)
    gaps, gap_rates = np.zeros(shape), np.zeros(shape)
    if errors is None:
        return Toleranced(states.gaps, gap_rates, offset, offset.copy(), half_play)
    teeth = model.tooth_count
    normal, spin = states.rows[..., :2], states.rates[..., 0]
    turned = np.stack([-normal[..., 1], normal[..., 0]], axis=-1) * spin[..., None]
    material, slope = profile_error(errors.disc_profile, states.ring.parameter)
    gaps[..., :teeth] = (
        -np.einsum("adtx,tx->adt", normal[:, :, :teeth], errors.tooth_position)
        - errors.tooth_radius
        - material
    )
    gap_rates[..., :teeth] = (
        -np.einsum("adtx,tx->adt", turned[:, :, :teeth], errors.tooth_position)
        - slope * states.ring.parameter_rate
    )
    seen = kinematics.turned_with_carrier(
        model.lobe_count, states.crank_angle, errors.hole_position - errors.pin_position
    )
    drift = np.stack([seen[..., 1], -seen[..., 0]], axis=-1) / model.lobe_count
    apart = seen - errors.output_axis
    gaps[..., teeth:] = (
        np.sum(normal[:, :, teeth:] * apart, axis=-1) + errors.hole_radius - errors.pin_radius
    )
    gap_rates[..., teeth:] = np.sum(
        turned[:, :, teeth:] * apart + normal[:, :, teeth:] * drift, axis=-1
    )
    u = kinematics.crank_direction(states.crank_angle[:, None], model.phases)
    v = np.stack([-u[..., 1], u[..., 0]], axis=-1)
    along, across = errors.cam_centre[:, :1], errors.cam_centre[:, 1:]
    return Toleranced(
        gaps=states.gaps + gaps,
        gap_rates=gap_rates,
        offset=along * u + across * v + SHAFT_SHARE * errors.output_axis,
        offset_rates=along * v - across * u,
        half_play=np.maximum(half_play + 0.5 * errors.cam_play, 0.0),
    )


def profile_error(harmonics: FloatArray, parameter: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Material added to the discs' profiles, and its derivative over the parameter.

    Parameters
    ----------
    harmonics : array (D, 2, M)
        Cosine and sine coefficients of orders 1 to M, m.
    parameter : array (A, D, T)
        Place on the profile, rad.

    Returns
    -------
    material, slope : array (A, D, T)
        m and m/rad.
    """
    # The real part of a polynomial in z = exp(i t), by Horner's rule.
    z = np.exp(1j * parameter)
    total, slope = np.zeros((2, *parameter.shape), dtype=complex)
    for order in range(harmonics.shape[-1], 0, -1):
        line = (harmonics[:, 0, order - 1] - 1j * harmonics[:, 1, order - 1])[:, None]
        total = (total + line) * z
        slope = (slope + 1j * order * line) * z
    return total.real, slope.real
