"""To which depth under a contact a law counts, so that the bodies count the rest.

Johnson's law names the depth. Palmgren's was measured, on bodies of their own size: it stands for
the depth at which Johnson's law for the same pair and curvature gives the same approach at an
ordinary load, equal in tooth and disc; under an output pin the pin is counted to its axis, from
where its bending counts. It counts no deeper than Johnson's law does, where the body ends: what
Palmgren's figure has above that is his, and stays. The linear law is Palmgren's secant there.
"""

from __future__ import annotations

import numpy as np

from cqdd_design.gearbox.contact import laws
from cqdd_design.gearbox.contact.model import LINE_LOAD, ContactModel
from cqdd_design.geometry.contours import FloatArray


def ring_depths(
    model: ContactModel, equivalent_radius: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Depths in tooth and disc at ring contacts of the given R_eq (m), m."""
    tooth, disc = model.ring_bodies
    if model.ring_law.model == "johnson":
        shape = np.shape(equivalent_radius)
        return np.full(shape, tooth[0]), np.full(shape, disc[0])
    depth = _equal_depth(model, equivalent_radius)
    return np.minimum(depth, tooth[0]), np.minimum(depth, disc[0])


def _equal_depth(model: ContactModel, equivalent_radius: FloatArray) -> FloatArray:
    """Depth in both bodies at which Johnson's law gives Palmgren's approach, m."""
    bodies = tuple((1.0, *body[1:]) for body in model.ring_bodies)
    a, B = laws.johnson_coefficients(
        model.contact_length, equivalent_radius, model.ring_modulus, (bodies[0], bodies[1])
    )
    return np.asarray(np.exp(_missing(model, model.ring_modulus, a, B) / (2.0 * B)))


def pin_depth(model: ContactModel) -> float:
    """Depth in the disc at an output pin, m."""
    pin, disc = model.pin_bodies
    if model.pin_law.model == "johnson":
        return disc[0]
    unit = (1.0, *disc[1:])
    a, B = laws.johnson_coefficients(
        model.contact_length, model.pin_equivalent_radius, model.pin_modulus, (pin, unit)
    )
    share = (1.0 - disc[2] ** 2) / (np.pi * disc[1] * model.contact_length)
    return min(float(np.exp(_missing(model, model.pin_modulus, a, B) / (2.0 * share))), disc[0])


def _missing(model: ContactModel, modulus: float, a: FloatArray, B: float) -> FloatArray:
    """Compliance (m/N) of Palmgren's secant above Johnson's at unit depth."""
    force = LINE_LOAD * model.contact_length
    palmgren = laws.palmgren_coefficient(model.contact_length, modulus) * force**-0.1
    return np.asarray(palmgren - (a - B * np.log(force)))
