"""Named values that the compiled kernels of contact, backlash and tolerance take and return.

A ``NamedTuple`` of arrays costs a kernel nothing and tells a reader what each array is. A is the
number of crank angles, D of discs, T of ring teeth, P of output pins, C = T + P of contacts. Angles
in states are multiplied by the pin circle's radius ("length"), so that every entry is a length.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cqdd_design.geometry.contours import FloatArray


class Springs(NamedTuple):
    """Force laws that every state of a gearbox shares."""

    teeth: int
    """Contacts of a disc that belong to the ring; the rest are pins."""
    ring_law: int
    pin_law: int
    """Codes of :data:`.laws.LINE_MODELS`."""
    ring_logarithm: float
    pin_logarithm: float
    """Johnson's B, m/N."""
    pin_series: FloatArray
    """(D,) Compliance of a pin at every disc, m/N."""
    cam_stiffness: float
    cam_exponent: float
    """K and p of F = K delta^p."""
    carrier_stiffness: float
    """N/m; 0 is rigid."""


class Contacts(NamedTuple):
    """Contacts at one crank angle, or (with a leading axis A, but for the play) at many."""

    rows: FloatArray
    """(D, C, 3) n_x, n_y and h/length of every contact, ring teeth first."""
    gaps: FloatArray
    """(D, C) m."""
    coefficient: FloatArray
    """(D, C) Of either law."""
    offset: FloatArray
    """(D, 2) Displacement of the cams' centres, m."""
    half_play: FloatArray
    """(D,) Half of the play of every cam bearing, m."""


class Load(NamedTuple):
    """Torque as a force at the pin circle."""

    pull: float
    """T/length, N."""
    scale_stiffness: float
    """A typical stiffness, N/m; sets the ridge that keeps slack discs where they are."""


class Forces(NamedTuple):
    """Forces of one state, N."""

    contact: FloatArray
    """(D, C)"""
    cam: FloatArray
    """(D, 2)"""


class Work(NamedTuple):
    """Scratch of one equilibrium, made once by :func:`.equilibrium_kernel.new_work`."""

    gradient: FloatArray
    step: FloatArray
    trial: FloatArray
    """(3 + 3 D,)"""
    stiff: FloatArray
    closed: FloatArray
    """(D, C) Stiffness and closing of every contact."""
    block: FloatArray
    shared: FloatArray
    """(D, 6) Hessian blocks xx, xy, xt, yy, yt, tt: of a disc, and its pins' part."""
    carrier: FloatArray
    """(6,) What is left at the carrier."""


class Rubbing(NamedTuple):
    """Coulomb friction at one crank angle, or (with a leading axis A) at many.

    The tangent of a contact is its normal turned a quarter turn counter-clockwise.
    """

    share: FloatArray
    """(D, C) Force on the disc along the tangent over the normal force, signed."""
    disc_arm: FloatArray
    carrier_arm: FloatArray
    """(D, C) Arm of a force along the tangent about the disc's nominal centre, and about the ring's
    centre, over length."""


class RubbingWork(NamedTuple):
    """Scratch of one equilibrium with friction, made by :func:`.friction_kernel.rubbing_work`."""

    work: Work
    matrix: FloatArray
    """(3 + 3 D, 3 + 3 D)"""
    unit: FloatArray
    """(3 + 3 D,) Displacements by a unit torque."""


class Compliance(NamedTuple):
    """What yields in series with the contacts, and how the pins join the carrier's plate and cap.

    A contact closes by its own law's approach and by what the bodies behind it yield under the
    forces of all contacts.
    """

    pins: FloatArray
    """(D, D) Deflection of a pin at a disc by a unit force of another, plate and cap held, m/N."""
    at_cap: FloatArray
    """(D,) Share of a disc's force on a pin that the cap bears, and of its motion that the pin has
    there; none where both plates are one body."""
    join: float
    """Torque between plate and cap over their turn, /length^2, N/m; above 0."""
    bodies: FloatArray
    """(D, C, C), with a leading axis A over angles: what a unit force of one contact of a disc
    (last axis but one) takes from the closing of another (last axis), m/N; of no length along
    every axis where bodies are rigid."""


class YieldingWork(NamedTuple):
    """Scratch of one equilibrium with compliance, made by :func:`.compliant_kernel.yielding_work`.

    U = 4 + 3 D motions: carrier X and Y, turns of plate and cap, then every disc.
    """

    gradient: FloatArray
    step: FloatArray
    trial: FloatArray
    unit: FloatArray
    """(U,)"""
    stiff: FloatArray
    lack: FloatArray
    yielded: FloatArray
    change: FloatArray
    trial_approach: FloatArray
    """(D, C) Stiffness of every law; closing that approach and bodies exceed; what bodies yield;
    step of the approach."""
    push: FloatArray
    """(D, C, 4) Force on the disc by a unit normal force, x and y; its arms about the disc's centre
    and at the carrier, over length."""
    touching: NDArray[np.int64]
    """(D, C) Contacts of a disc that bear a force."""
    first: NDArray[np.int64]
    """(D + 1,) Place of a disc's first force in the system, and the number of all."""
    matrix: FloatArray
    """(D C + U, D C + 1 + U) Forces and motions; the right-hand side stands between their
    columns."""
    blocks: FloatArray
    """(D, 7 + C, 8 + C or up to three more) The same of every disc with the carrier, where discs
    share nothing else; see :mod:`.compliant_apart_kernel`."""


class YieldingResult(NamedTuple):
    """Equilibria with compliance at A crank angles, filled by `compliant_kernel.yield_sweep`."""

    states: FloatArray
    """(A, 4 + 3 D)"""
    approach: FloatArray
    """(A, D, C) Of every contact by its own law; below zero is a gap, m."""
    force: FloatArray
    """(A, D, C) N."""
    cam_force: FloatArray
    """(A, D, 2) N."""
    torsional: FloatArray
    """(A,) dT/dgamma/length^2 at the plate, N/m."""
    steps: NDArray[np.int64]
    """(A,) Newton steps."""


class SweepResult(NamedTuple):
    """Equilibria at A crank angles, filled by :func:`.sweep_kernel.solve_sweep`."""

    states: FloatArray
    """(A, 3 + 3 D)"""
    force: FloatArray
    """(A, D, C) N."""
    cam_force: FloatArray
    """(A, D, 2) N."""
    torsional: FloatArray
    """(A,) dT/dgamma/length^2, N/m."""
    steps: NDArray[np.int64]
    """(A,) Newton steps."""


class Nominal(NamedTuple):
    """The perfect gearbox over its crank angles: what toleranced ones differ from."""

    rows: FloatArray
    gaps: FloatArray
    coefficient: FloatArray
    """As in :class:`Contacts`, (A, D, C, ...)."""
    rates: FloatArray
    """(A, D, C, 4) See :class:`.states.NominalStates`."""
    parameter: FloatArray
    parameter_rate: FloatArray
    """(A, D, T) Place on the disc's profile, rad, and its derivative."""
    curvature: FloatArray
    """(A, D, T) Of the curve parallel to the flank through each tooth's centre, 1/m."""
    tooth_centre: FloatArray
    """(T, 2) m."""
    pin_angle: FloatArray
    """(A, P) Of every pin in the ring's frame, rad."""
    crank_angle: FloatArray
    """(A,) rad."""
    phases: FloatArray
    """(D,) rad."""
    basis: FloatArray
    """(G, 2, M) From :func:`.gaps_kernel.harmonic_basis`."""
    lobe_count: int
    play: float
    """Total play of a cam bearing, m."""
    eccentricity: float
    length: float
    """Pin circle, m."""


class Toleranced(NamedTuple):
    """A gearbox with its part errors, from :mod:`.states` or filled by :mod:`.gaps_kernel`."""

    gaps: FloatArray
    """(A, D, C) Nominal gaps and what errors change in them, to first order, m."""
    gap_rates: FloatArray
    """(A, D, C) Derivatives over crank angle of that change, m."""
    offset: FloatArray
    offset_rates: FloatArray
    """(A, D, 2) Displacement of the cams' centres in the ring's frame, and its derivative, m."""
    half_play: FloatArray
    """(D,) Half of the play of every cam bearing, not below zero, m."""


class Start(NamedTuple):
    """What the perfect gearbox knows before toleranced ones are solved."""

    marked: NDArray[np.bool_]
    """(A,) Angles that serve the gearbox without load."""
    thinned: NDArray[np.bool_]
    """(B,) Those of the marked angles that serve backlash and stiffness."""
    perfect: FloatArray
    """(A, 3 + 3 D) Its states under the torque, plates held and without friction."""
    free_poses: FloatArray
    """(2, A, 3 + 3 D) Its poses at both ends of its backlash."""
    torque: float
    """N m."""


class Worn(NamedTuple):
    """What friction and pressure of a gearbox's contacts come from, over its crank angles."""

    slip: FloatArray
    """(A, D, C) Size of the slip at every contact per radian of the crank, m."""
    pressing: FloatArray
    """(A, D, T) Square of the pressure at a ring tooth over its force, Pa^2/N."""
    crank_sense: float
    """In which the crank turns under the torque, 1 or -1."""


class Shared(NamedTuple):
    """Friction, compliance and pressures that all gearboxes of an ensemble share."""

    rubbing: Rubbing
    """Under the torque, with a leading axis A."""
    smooth: Rubbing
    """No friction, likewise."""
    compliance: Compliance
    """Under that friction."""
    idle: Compliance
    """Without friction."""
    worn: Worn


class RigidParts(NamedTuple):
    """A gearbox whose parts do not yield, over its crank angles."""

    rows: FloatArray
    gaps: FloatArray
    """As in :class:`Contacts`, with errors, (A, D, C, ...)."""
    curvature: FloatArray
    tooth_centre: FloatArray
    pin_angle: FloatArray
    crank_angle: FloatArray
    """As in :class:`Nominal`."""
    own_angle: FloatArray
    """(A, D) Crank angle of every disc, rad."""
    apart: FloatArray
    """(A, D, P, 2) Hole off its pin by position errors, in the ring's frame, m."""
    offset: FloatArray
    half_play: FloatArray
    """(A, D, 2) and (D,) Of the cams, m."""
    eccentricity: float
    length: float
    """e and the pin circle, m."""


class Extremes(NamedTuple):
    """Ends of the carrier's free range at B angles, filled by `backlash_sweep`."""

    ends: FloatArray
    """(B,) Angle, rad; meaningless where parts overlap whatever they do."""
    preload: FloatArray
    """(B,) Greatest overlap that no motion removes, m; clearances give about the push."""
    poses: FloatArray
    """(B, 3 + 3 D) Carrier and discs there, m."""
