"""Evaluate batches of toleranced gearboxes: the nominal tables once, the compiled kernel often."""

from __future__ import annotations

import math
import os
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cqdd_design.errors import ContactError
from cqdd_design.gearbox.bodies.compliance import ElasticBodies, compliance, rigid_cam_force
from cqdd_design.gearbox.contact.compliant import model_compliance
from cqdd_design.gearbox.contact.kernel_values import Load, Nominal, Shared, Start, Worn
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.part_errors import GearboxErrors
from cqdd_design.gearbox.contact.problem import springs_of, stiffness_scale
from cqdd_design.gearbox.contact.rubbing import ContactFriction, rubbing, slip
from cqdd_design.gearbox.contact.states import NominalStates, nominal_states
from cqdd_design.gearbox.contact.sweep import (
    contact_sweep,
    output_turn_angles,
    perfect_angles,
)
from cqdd_design.gearbox.hertz import line_contact_pressure
from cqdd_design.gearbox.precision.backlash import free_poses
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.meshing import tooth_centres

OUTPUTS: tuple[str, ...] = (
    "backlash_arcmin",
    "transmission_error_pp_arcmin",
    "ring_force_max_N",
    "stiffness_Nm_per_arcmin",
    "torque_ripple_pp_Nm",
    "ring_pressure_max_MPa",
    "cam_bearing_load_max_N",
    "preload_force_max_N",
    "unloaded_torque_Nm",
)
"""Forces, pressure, transmission error and ripple are under the torque, the motor driving; the
ripple and the torque that turns the gearbox without load are n times those of the crank."""

LOADS: tuple[str, ...] = (
    "ring_force_max_N",
    "ring_pressure_max_MPa",
    "cam_bearing_load_max_N",
)
"""Of the outputs, the greatest loads: found in half of the time of all."""

RANKED: tuple[str, ...] = (
    "backlash_arcmin",
    "torque_ripple_pp_Nm",
    "ring_pressure_max_MPa",
)
"""Of the outputs, those by which a report ranks the tolerances, in three quarters of the time."""

FREEDOM: tuple[str, ...] = (
    "preload_force_max_N",
    "unloaded_torque_Nm",
)
"""Of the outputs, how freely a gearbox turns without load, in half of the time or less."""

_ARCMIN = math.degrees(1.0) * 60.0

_FILM_ANGLES = 24
"""Crank angles over which the mean friction of films is taken."""
_TURN = 1000
"""About so many crank angles of the output turn for each gearbox."""
PER_TOOTH = 8, 2
"""Most and fewest of them to a tooth. Against sixteen, eight lose 0.2 to 0.3 % of the greatest
pressure at the continuous torque and 0.1 % at the peak, four 0.7 to 1.1 and 0.1 to 0.4 %, two 2 %
and up to 1; of the transmission error 0.5, 1.5 and 5 % (means of 64 gearboxes, ratios 8 to 15)."""
_COARSE = 200
"""About so many of the angles serve what turns the gearbox unloaded: a hundred would lose a fifth
of the torque that turns the tightest (ratio 10)."""
_THINNED, _LEAST_THINNED = 0.5 * (3.0 + math.sqrt(5.0)), 60
"""Steps between those of them that serve backlash and stiffness, which are means, and how many
there are at least: against all angles of the turn the 95th percentile of the backlash is off by
0.4 % at most and the 5th of the stiffness by 0.7 % (ratios 8 to 15). Steps of the golden section
see all phases of the teeth alike."""
_NICER = 10
"""By how much threads that work gearboxes are nicer to others, of 19 steps."""


@dataclass(frozen=True, eq=False)
class EnsembleTables:
    """What all gearboxes of an ensemble share.

    Attributes
    ----------
    states : NominalStates
        Over one output turn.
    start : Start
        The perfect gearbox, from which the others start.
    shared : Shared
        Friction, compliance and pressures.
    """

    model: ContactModel
    states: NominalStates
    start: Start
    shared: Shared

    def yielding(self, bodies: BodyCompliance) -> EnsembleTables:
        """The same gearbox with discs and ring that yield."""
        shared = self.shared._replace(
            compliance=model_compliance(self.model, bodies.rubbing),
            idle=model_compliance(self.model, bodies.smooth),
        )
        return replace(self, shared=shared)


def turn_angles(lobe_count: int) -> int:
    """Crank angles over the output turn that an ensemble solves: about a thousand."""
    teeth = lobe_count * (lobe_count + 1)
    most, fewest = PER_TOOTH
    return min(max(_TURN // teeth, fewest), most) * teeth


def marked_angles(lobe_count: int, count: int) -> NDArray[np.bool_]:
    """Which of `count` angles over the output turn serve the gearbox without load, (count,).

    The step between them shares no factor with the angles to a tooth: with one it would see the
    teeth in some of their phases only.
    """
    to_a_tooth = max(round(count / (lobe_count * (lobe_count + 1))), 1)
    wanted = max(count / _COARSE, 1.0)
    steps = [
        step for step in range(1, 2 * math.ceil(wanted) + 2) if math.gcd(step, to_a_tooth) == 1
    ]
    marked = np.zeros(count, dtype=np.bool_)
    marked[:: min(steps, key=lambda step: abs(math.log(step / wanted)))] = True
    return marked


def thinned_angles(count: int) -> NDArray[np.bool_]:
    """Which of `count` marked angles serve backlash and stiffness, (count,)."""
    step = min(max(count / _LEAST_THINNED, 1.0), _THINNED)
    places = (step * np.arange(count)).astype(int)
    return np.isin(np.arange(count), places)


class BodyCompliance(NamedTuple):
    """Compliance of discs and ring between the contacts of the perfect gearbox, (A, D, C, C)."""

    rubbing: FloatArray
    """With the friction of a motor that drives."""
    smooth: FloatArray
    """Without friction."""


def body_compliance(
    bodies: ElasticBodies,
    model: ContactModel,
    torque: float,
    angles: int | None = None,
    *,
    at_rest: bool = False,
) -> BodyCompliance:
    """What discs and ring yield over the output turn; arguments as :func:`ensemble_tables`."""
    wanted = turn_angles(model.lobe_count) if angles is None else angles
    states = nominal_states(model, output_turn_angles(model, wanted))
    share = rubbing(model, states, _driving(model, torque, at_rest=at_rest), torque).share
    cam_force = rigid_cam_force(model, states, torque)
    return BodyCompliance(
        compliance(bodies, model, states, cam_force, share),
        compliance(bodies, model, states, cam_force),
    )


def _driving(model: ContactModel, torque: float, *, at_rest: bool = False) -> ContactFriction:
    """Friction of a motor that drives; by films, the mean of the perfect gearbox at every contact.

    Forces of toleranced parts differ from its forces, and films hardly know the force.
    """
    friction = ContactFriction.of(model, "drive", 0.0 if at_rest else None)
    assert friction is not None
    if not friction.film_speed:
        return friction
    held = replace(model, pin=None)
    sweep = contact_sweep(held, torque, perfect_angles(held, _FILM_ANGLES), friction=friction)
    return ContactFriction("drive", *sweep.mean_friction)


def ensemble_tables(
    model: ContactModel,
    torque: float,
    angles: int | None = None,
    bodies: BodyCompliance | None = None,
    *,
    outputs: tuple[str, ...] = OUTPUTS,
    at_rest: bool = False,
) -> EnsembleTables:
    """Prepare an ensemble.

    Parameters
    ----------
    torque : float
        N m, positive; transmission error, ring force and ripple are at it, the stiffness is the
        secant between half of it and it.
    angles : int, optional
        Crank angles over the output turn, at least 8; default :func:`turn_angles`.
    bodies : BodyCompliance, optional
        Of the same angles, from :func:`body_compliance`; default rigid.
    outputs : tuple of str
        `OUTPUTS`, or `LOADS`, which ask for nothing of a gearbox without load.
    at_rest : bool
        Whether friction is that of a gearbox that stands, without films.
    """
    wanted = turn_angles(model.lobe_count) if angles is None else angles
    states = nominal_states(model, output_turn_angles(model, wanted))
    marked = marked_angles(model.lobe_count, len(states.crank_angle))
    held = replace(model, pin=None)
    perfect = contact_sweep(held, torque, states=states).state_vectors
    free = np.zeros((2, *perfect.shape)) if outputs == LOADS else free_poses(model, states)
    start = Start(marked, thinned_angles(int(marked.sum())), perfect, free, torque)
    rigid = EnsembleTables(model, states, start, _shared(model, states, torque, at_rest=at_rest))
    return rigid if bodies is None else rigid.yielding(bodies)


def _shared(model: ContactModel, states: NominalStates, torque: float, *, at_rest: bool) -> Shared:
    friction = _driving(model, torque, at_rest=at_rest)
    teeth = states.ring.equivalent_radius
    rubbed = rubbing(model, states, friction, torque)
    held = model_compliance(model)
    return Shared(
        rubbing=rubbed,
        smooth=rubbed._replace(share=np.zeros_like(rubbed.share)),
        compliance=held,
        idle=held,
        worn=Worn(
            slip=np.abs(slip(model, states)),
            pressing=line_contact_pressure(1.0, model.contact_length, teeth, model.ring_modulus)
            ** 2,
            crank_sense=friction.crank_sense(torque),
        ),
    )


def nominal_of(tables: EnsembleTables, harmonics: int) -> Nominal:
    """The perfect gearbox as the kernels take it, with a profile table for so many harmonics."""
    from cqdd_design.gearbox.contact.gaps_kernel import harmonic_basis, table_size

    model, states = tables.model, tables.states
    return Nominal(
        rows=states.rows,
        gaps=states.gaps,
        coefficient=states.coefficient,
        rates=states.rates,
        parameter=states.ring.parameter,
        parameter_rate=states.ring.parameter_rate,
        curvature=states.ring.centre_curvature,
        tooth_centre=tooth_centres(model.disc),
        pin_angle=states.pin_angle,
        crank_angle=states.crank_angle,
        phases=model.phases,
        basis=harmonic_basis(table_size(len(states.crank_angle), harmonics), harmonics),
        lobe_count=model.lobe_count,
        play=model.cam.play,
        eccentricity=model.eccentricity,
        length=states.length,
    )


def _let_others_first() -> None:
    """Lower this thread's priority, where threads have one of their own.

    Gearboxes are many and can use any core at any time. What goes on beside them, such as a
    report's other chapters and the process that draws its pictures, is one after the other: it
    would last longer than all of them.
    """
    if sys.platform == "linux":
        own = threading.get_native_id()
        least = min(os.getpriority(os.PRIO_PROCESS, own) + _NICER, 19)
        os.setpriority(os.PRIO_PROCESS, own, least)


def evaluate_gearboxes(
    tables: EnsembleTables,
    batch: GearboxErrors,
    threads: int | None = None,
    outputs: tuple[str, ...] = OUTPUTS,
) -> FloatArray:
    """Results (S, 9) of every gearbox of a batch, in the units and order of `outputs`.

    Rows of gearboxes that jam at some angle are not numbers.

    Parameters
    ----------
    batch : GearboxErrors
        S gearboxes.
    threads : int, optional
        Default all; the numbers do not depend on it.
    outputs : tuple of str
        `OUTPUTS`, or `LOADS`, `RANKED` or `FREEDOM` alone. The numbers are the same, but that those
        of `FREEDOM` jam at angles of `marked_angles` alone, where parts are tight: where they are
        free, those jam that do in any other state too.

    Raises
    ------
    ContactError
        When none of them has an equilibrium, naming an angle.
    """
    import numba

    from cqdd_design.gearbox.tolerance import ensemble_kernel as kernel

    model, states, torque = tables.model, tables.states, tables.start.torque
    count = len(batch.tooth_radius)
    values, failed = np.empty((count, kernel.RESULTS)), np.empty(count, dtype=np.int64)
    nominal = nominal_of(tables, batch.disc_profile.shape[-1])
    springs = springs_of(model)
    load = Load(torque / states.length, stiffness_scale(model, torque))
    solve: Any = kernel.solve_gearbox
    alone = {
        LOADS: kernel.LOADS_ALONE,
        RANKED: kernel.RANKED_ALONE,
        FREEDOM: kernel.FREEDOM_ALONE,
    }
    asked = alone.get(outputs, kernel.EVERYTHING)

    def work(which: int) -> None:
        errors = batch.one(which)
        failed[which] = solve(
            nominal, springs, load, tables.start, tables.shared, errors, asked, values[which]
        )

    with ThreadPoolExecutor(
        threads or numba.get_num_threads(), initializer=_let_others_first
    ) as pool:
        for _ in pool.map(work, range(count)):
            pass
    values[failed >= 0] = np.nan
    if np.all(failed >= 0):
        which = int(np.flatnonzero(failed >= 0)[0])
        angle = math.degrees(states.crank_angle[failed[which]])
        raise ContactError(
            "no gearbox of the batch has a contact equilibrium at every crank angle (number "
            f"{which} not at {angle:.6g} deg) and {torque:g} N*m; errors are too large for these "
            "clearances, or friction jams it: lower [tolerances], reducer.friction, or the "
            "clearances."
        )
    n = float(model.lobe_count)
    scale = np.array([_ARCMIN, _ARCMIN, 1.0, 1.0 / _ARCMIN, n, 1e-6, 1.0, 1.0, n])
    columns = [OUTPUTS.index(name) for name in outputs]
    return np.asarray(values[:, columns] * scale[columns])
