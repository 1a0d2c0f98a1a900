"""What every solved state of the contact engine owes, whatever the test."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import reject

from cqdd_design.errors import ContactError
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.part_errors import GearboxErrors
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.sweep import contact_sweep
from cqdd_design.geometry import kinematics

BALANCE = 1e-9


def one_body(model: ContactModel) -> ContactModel:
    """The same gearbox with plate and cap of its carrier as one body, as plain oracles have it."""
    return replace(model, pin=None)


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def imbalance(sweep: ContactSweep) -> float:
    """Greatest force and moment left over on any disc and on the carrier, over the load."""
    ring = sweep.ring_force[..., None] * sweep.ring_normal
    pins = sweep.pin_force[..., None] * sweep.pin_normal
    cam, centre = sweep.cam_force, sweep.disc_centre
    force = ring.sum(axis=2) + pins.sum(axis=2) + cam
    moment = (
        cross(sweep.ring_point, ring).sum(axis=2)
        + cross(sweep.pin_point, pins).sum(axis=2)
        + cross(centre, cam)
    )
    # What the pins take from the discs is what the torque on the carrier puts into them.
    carrier = sweep.torque - cross(sweep.pin_point, pins).sum(axis=(1, 2))
    radius = sweep.model.pin_circle_radius
    load = np.maximum(
        np.maximum(sweep.ring_force.max(axis=(1, 2)), sweep.pin_force.max(axis=(1, 2))),
        np.maximum(np.hypot(cam[..., 0], cam[..., 1]).max(axis=1), abs(sweep.torque) / radius),
    )
    arm = sweep.model.disc.ring_pitch_radius
    assert load.min() > 0.0
    assert np.isfinite(load).all()
    worst = (
        np.abs(force).max(axis=(1, 2)) / load,
        np.abs(moment).max(axis=1) / (load * arm),
        np.abs(carrier) / (load * radius),
    )
    return float(np.max(worst))


def assert_sound(sweep: ContactSweep) -> None:
    """Every array finite, nothing pulled, unit normals, the reported places consistent."""
    for name, value in vars(sweep).items():
        if isinstance(value, np.ndarray):
            assert np.isfinite(value).all(), name
    assert sweep.ring_force.min() >= 0.0
    assert sweep.pin_force.min() >= 0.0
    for normal in (sweep.ring_normal, sweep.pin_normal):
        assert np.abs(np.hypot(normal[..., 0], normal[..., 1]) - 1.0).max() < 1e-12
    assert imbalance(sweep) < BALANCE


def some_angles(seed: int, model: ContactModel, count: int = 5) -> np.ndarray:
    period = kinematics.imperfect_period(model.lobe_count)
    return np.sort(np.random.default_rng(seed).uniform(0.0, period, count))


def swept(
    model: ContactModel, torque: float, angle: np.ndarray, errors: GearboxErrors | None = None
) -> ContactSweep:
    """A sweep, unless the load would move the parts too far, which is not what is tested."""
    try:
        return contact_sweep(model, torque, angle, errors=errors)
    except ContactError as error:
        if "would have to move" in error.message:
            reject()
        raise
