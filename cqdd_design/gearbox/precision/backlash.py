"""Backlash of rigid parts: the free range of the carrier with crank and ring held."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cqdd_design.errors import ContactError
from cqdd_design.gearbox.contact.kernel_values import Extremes, RigidParts, Toleranced
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.part_errors import GearboxErrors
from cqdd_design.gearbox.contact.states import (
    NominalStates,
    error_states,
    hole_off_pin,
    nominal_states,
    profile_error,
)
from cqdd_design.gearbox.contact.sweep import output_turn_angles, perfect_angles
from cqdd_design.gearbox.contact.tables import nearest_parameter
from cqdd_design.geometry.contours import FloatArray, as_complex, as_points
from cqdd_design.geometry.kinematics import disc_pose, turned_with_carrier
from cqdd_design.geometry.meshing import tooth_centres

_CORRECTIONS = 2
"""Rounds of correction to the exact profile; each leaves a small share of the one before."""


@dataclass(frozen=True, eq=False)
class Backlash:
    """Free range of the carrier at A crank angles, bodies rigid, crank and ring held.

    Attributes
    ----------
    crank_angle : array (A,)
        rad.
    least, greatest : array (A,)
        Ends of the range of the carrier's angle error, rad; the greatest is where a vanishing
        positive torque holds it, so it is the unloaded kinematic error too. Both are the same
        where the parts leave no range.
    overlap : array (A,)
        Greatest overlap that no motion removes, m; above `preload_limit` the parts are
        preloaded there, and the range is what other joints leave while they stay pressed.
    preload_limit : float
        m.
    """

    crank_angle: FloatArray
    least: FloatArray
    greatest: FloatArray
    overlap: FloatArray
    preload_limit: float

    @property
    def free(self) -> FloatArray:
        """Backlash at every angle, (A,), rad; zero where parts are pressed from both sides."""
        return self.greatest - self.least

    @property
    def mean(self) -> float:
        """Mean over the angles, rad."""
        return float(self.free.mean())

    @property
    def preloaded(self) -> bool:
        """Whether parts overlap at any angle, whatever they do."""
        return bool(np.any(self.overlap > self.preload_limit))


def backlash(
    model: ContactModel,
    crank_angle: FloatArray | None = None,
    *,
    errors: GearboxErrors | None = None,
    states: NominalStates | None = None,
) -> Backlash:
    """Backlash from gaps alone, re-linearised at each solution until it stands still.

    The range of the carrier's angle over all positions of every disc at which no gap to a ring
    tooth, at an output pin or in a cam bearing is negative; the carrier's bearing is rigid. The
    search sees each flank as its osculating circle, and is then corrected to the exact profile.

    Parameters
    ----------
    crank_angle : array (A,), optional
        rad, rising; default the period of a perfect gearbox, an output turn with errors.
    states : NominalStates, optional
        Of the same model and angles.

    Raises
    ------
    ContactError
        Where the parts are so loose that the teeth pass each other.
    """
    from cqdd_design.gearbox.precision.backlash_kernel import CLOSED, OVERLAP

    if states is None:
        if crank_angle is None:
            crank_angle = perfect_angles(model) if errors is None else output_turn_angles(model)
        states = nominal_states(model, np.asarray(crank_angle, dtype=float))
    changed = error_states(model, states, errors)
    ends, overlaps = [], []
    for sense in (-1.0, 1.0):
        gaps = changed.gaps
        end, overlap, poses = _push(model, states, changed, gaps, errors, sense)
        for _ in range(_CORRECTIONS):
            # The model of each gap is right where it was linearised but for its third order;
            # what it misses of the exact gap at this pose is put into it.
            exact, modelled = _exact_and_modelled(model, states, changed.gaps, errors, poses)
            gaps = changed.gaps.copy()
            gaps[:, :, : model.tooth_count] += exact - modelled
            end, overlap, poses = _push(model, states, changed, gaps, errors, sense)
        ends.append(end)
        overlaps.append(overlap)
    overlap = np.maximum(*overlaps)
    # Parts that are pressed from both sides rest where their overlaps balance.
    closed = ends[1] - ends[0] <= np.where(overlap > OVERLAP, CLOSED / states.length, 0.0)
    rest = 0.5 * (ends[0] + ends[1])
    return Backlash(
        crank_angle=states.crank_angle,
        least=np.where(closed, rest, ends[0]),
        greatest=np.where(closed, rest, ends[1]),
        overlap=overlap,
        preload_limit=OVERLAP,
    )


def free_poses(model: ContactModel, states: NominalStates) -> FloatArray:
    """Poses of a perfect gearbox close to the ends of its range, (2, A, 3 + 3 D), m.

    Carrier (X, Y, gamma) and every disc (x, y, theta) near the least and the greatest angle of the
    carrier, angles times the pin circle: flanks count as osculating circles, which is close enough
    to start from.

    Raises
    ------
    ContactError
        As :func:`backlash`.
    """
    changed = error_states(model, states, None)
    return np.stack(
        [_push(model, states, changed, changed.gaps, None, sense)[2] for sense in (-1.0, 1.0)]
    )


def _apart(model: ContactModel, states: NominalStates, errors: GearboxErrors | None) -> FloatArray:
    """Hole off its pin by heat, by errors of both and by the carrier's axis, (A, D, P, 2), m."""
    shape = (len(states.crank_angle), model.disc_count, model.pin_count, 2)
    warm = hole_off_pin(model, states.pin_angle)
    if errors is None:
        return np.broadcast_to(warm, shape).copy()
    apart = errors.hole_position - errors.pin_position
    turned = turned_with_carrier(model.lobe_count, states.crank_angle, apart)
    return warm + turned - errors.output_axis


def _push(
    model: ContactModel,
    states: NominalStates,
    changed: Toleranced,
    gaps: FloatArray,
    errors: GearboxErrors | None,
    sense: float,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Extreme carrier angle (A,), overlap (A,) and poses (A, 3 + 3 D) of one sense."""
    from cqdd_design.gearbox.precision.backlash_kernel import backlash_sweep

    count, discs = gaps.shape[:2]
    parts = RigidParts(
        rows=states.rows,
        gaps=gaps,
        curvature=states.ring.centre_curvature,
        tooth_centre=tooth_centres(model.disc),
        pin_angle=states.pin_angle,
        crank_angle=states.crank_angle,
        own_angle=states.crank_angle[:, None] + model.phases,
        apart=_apart(model, states, errors),
        offset=changed.offset,
        half_play=changed.half_play,
        eccentricity=model.eccentricity,
        length=states.length,
    )
    found = Extremes(np.empty(count), np.empty(count), np.empty((count, 3 + 3 * discs)))
    starts = np.zeros((count, 3 + 3 * discs))
    failed = backlash_sweep(parts, np.arange(count), sense, starts, found)
    if failed >= 0:
        raise ContactError(
            "the parts are too loose for a backlash: at crank angle "
            f"{math.degrees(states.crank_angle[failed]):.6g} deg nothing stops the carrier near "
            "its nominal place. Lower reducer.modification, output_pins.hole_clearance or "
            "cam_bearing.radial_clearance."
        )
    return found.ends, found.preload, found.poses


def _exact_and_modelled(
    model: ContactModel,
    states: NominalStates,
    nominal: FloatArray,
    errors: GearboxErrors | None,
    poses: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Ring gaps (A, D, T) at displaced poses: by the exact profile, and by osculating circles."""
    teeth = model.tooth_count
    discs = poses[:, 3:].reshape(len(poses), -1, 3)
    shift, turn = as_complex(discs[..., :2])[..., None], discs[..., 2, None] / states.length
    own = states.crank_angle[:, None] + model.phases
    rotation, centre = (part[..., None] for part in disc_pose(model.disc, own))
    tooth = as_complex(tooth_centres(model.disc))
    # Displacement of the tooth against the disc, in the disc's nominal place.
    moved = (tooth - centre - shift) * np.exp(-1j * turn) - (tooth - centre)
    normal = as_complex(states.rows[:, :, :teeth, :2])
    out, along = -(moved * np.conj(normal)).real, (moved * np.conj(-1j * normal)).real
    bend = states.ring.centre_curvature
    root = np.sqrt((1.0 + bend * out) ** 2 + (bend * along) ** 2)
    modelled = nominal[:, :, :teeth] + (2.0 * out + bend * (out**2 + along**2)) / (1.0 + root)
    moved_tooth, radius = tooth, np.zeros(teeth)
    if errors is not None:
        moved_tooth, radius = tooth + as_complex(errors.tooth_position), errors.tooth_radius
    seen = (moved_tooth - centre - shift) / (rotation * np.exp(1j * turn))
    foot = nearest_parameter(model.disc, as_points(seen), states.ring.parameter)
    point, outward = model.disc.profile(foot)
    exact = (
        ((seen - point) * np.conj(outward)).real - model.tooth_radius - radius + model.roller_play
    )
    if errors is not None:
        exact = exact - profile_error(errors.disc_profile, foot)[0]
    return exact, modelled
