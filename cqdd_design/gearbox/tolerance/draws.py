"""Draw toleranced gearboxes: every error of gearbox i follows from the seed and i alone.

Each tolerance has its own counter-based stream (Philox), in which gearbox i owns the same stretch
of raw numbers whoever draws it: the number of threads, the size of blocks and their order change
nothing, and one tolerance can be exchanged for another draw of it while the rest stay.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cqdd_design.design.actuator import Tolerances
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.part_errors import GearboxErrors
from cqdd_design.geometry.contours import FloatArray

GROUPS: tuple[str, ...] = (
    "tooth_position",
    "tooth_radius",
    "disc_profile",
    "hole_position",
    "hole_diameter",
    "pin_position",
    "pin_diameter",
    "eccentricity",
    "bearing_clearance",
    "output_position",
)
"""The tolerances of a design file, each of which is drawn by itself, in the order of the part
errors that they give."""

_WORDS = 4
"""Raw numbers per step of Philox's counter."""
_MOST_HARMONICS = 120


def harmonics(lobe_count: int) -> int:
    """Orders of the profile error round the disc: pitch errors, lobe form and waviness, 3 n."""
    return min(3 * lobe_count, _MOST_HARMONICS)


def profile_amplitudes(lobe_count: int) -> FloatArray:
    """Standard deviations of the harmonics' coefficients for a pointwise one of 1, falling as 1/m.

    A cut's error is mostly of low order: the drift of a turn weighs most, waviness least.
    """
    order = np.arange(1, harmonics(lobe_count) + 1)
    amplitude = 1.0 / order
    return np.asarray(amplitude / np.sqrt(np.sum(amplitude**2)))


def _shares(seed: int, group: int, matrix: int, first: int, count: int, size: int) -> FloatArray:
    """Even numbers between 0 and 1 for gearboxes `first` to `first + count`, (count, size)."""
    steps = -(-size // _WORDS)
    stream = np.random.Philox(key=np.array([seed, 2 * group + matrix], dtype=np.uint64))
    stream.advance(first * steps)
    raw = stream.random_raw(count * steps * _WORDS).reshape(count, -1)[:, :size]
    # 53 bits, in the middle of their steps: never 0 nor 1.
    return np.asarray(((raw >> np.uint64(11)).astype(float) + 0.5) * 2.0**-53)


def _standard(share: FloatArray, distribution: str) -> FloatArray:
    """Numbers of mean 0 and variance 1 from even ones between 0 and 1."""
    from scipy.special import ndtri

    if distribution == "uniform":
        return np.asarray(np.sqrt(3.0) * (2.0 * share - 1.0))
    return np.asarray(ndtri(share))


def _in_circle(share: FloatArray) -> FloatArray:
    """Places (S, 2) anywhere in a circle of radius 1 alike, from even numbers (S, 2)."""
    radius = np.sqrt(share[:, 0])
    angle = 2.0 * np.pi * share[:, 1]
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)


def draw_errors(
    model: ContactModel,
    tolerances: Tolerances,
    seed: int,
    first: int,
    count: int,
    matrices: Mapping[str, int] | None = None,
) -> GearboxErrors:
    """Draw gearboxes `first` to `first + count` of an ensemble.

    Parameters
    ----------
    seed : int
        0 to 2^64 - 1.
    first, count : int
        Gearboxes by number.
    matrices : mapping, optional
        Tolerances to take from a second, independent draw (1) instead of the first (0).
    """
    perfect = GearboxErrors.none(model, harmonics(model.lobe_count))
    drawn = []
    for number, (name, none) in enumerate(zip(GROUPS, perfect, strict=True)):
        matrix = (matrices or {}).get(name, 0)
        share = _shares(seed, number, matrix, first, count, none.size)
        if name == "output_position":
            # Measured in every gearbox, and set again where it is out of its zone.
            drawn.append(0.5 * tolerances.output_zone * _in_circle(share))
            continue
        values = _standard(share, tolerances.distribution)
        drawn.append(getattr(tolerances, name) * values.reshape(count, *none.shape))
    found = GearboxErrors(*drawn)
    return found._replace(
        disc_profile=found.disc_profile * profile_amplitudes(model.lobe_count),
        hole_radius=0.5 * found.hole_radius,
        pin_radius=0.5 * found.pin_radius,
    )
