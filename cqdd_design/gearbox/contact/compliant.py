"""Contact equilibria whose carrier turns as it is built, and whose bodies yield.

The plate carries the output torque; the cap hangs on the pins, which hand it their share of every
force and bring it back to the plate, so that the net torque on it is zero. Both turn about one
axis: neither tilts, and the cap does not move sideways against the plate.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cqdd_design.errors import ContactError
from cqdd_design.gearbox.contact.kernel_values import (
    Compliance,
    Rubbing,
    SweepResult,
    Toleranced,
    YieldingResult,
)
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.pin_beam import PinBeam
from cqdd_design.gearbox.contact.rubbing import ContactFriction, rubbing
from cqdd_design.gearbox.contact.states import NominalStates
from cqdd_design.gearbox.contact.sweep import sweep_problem
from cqdd_design.geometry.contours import FloatArray


def carrier_compliance(
    pin_count: int, beam: PinBeam, bodies: FloatArray | None = None
) -> Compliance:
    """What yields behind the contacts of a gearbox whose cap hangs on its pins.

    Parameters
    ----------
    pin_count : int
        N_w; together they hold the cap by N_w joint R_w^2 against the plate.
    beam : PinBeam
        Of every pin. A cantilever's cap bears nothing and is as good as none.
    bodies : array (A, D, C, C), optional
        Closing that a contact loses by unit forces of its disc's contacts, m/N; default rigid.
    """
    return Compliance(
        pins=np.ascontiguousarray(beam.influence),
        at_cap=np.ascontiguousarray(beam.at_cap),
        # Where no pin reaches a cap, any spring holds it: nothing moves it against the plate.
        join=pin_count * beam.joint or 1.0,
        bodies=np.empty((0, 0, 0, 0)) if bodies is None else np.ascontiguousarray(bodies),
    )


def compliant_states(
    model: ContactModel,
    torque: float,
    states: NominalStates,
    changed: Toleranced,
    smooth: SweepResult,
    compliance: Compliance,
    friction: ContactFriction | None = None,
) -> YieldingResult:
    """Equilibria with compliance, from those of held plates and rigid bodies.

    Parameters
    ----------
    torque : float
        On the plate, N m.
    states, changed
        From :func:`.states.nominal_states` and :func:`.states.error_states`.
    smooth : SweepResult
        Equilibria without compliance and friction, from :func:`.sweep_kernel.solve_sweep`.

    Raises
    ------
    ContactError
        Where no forces carry the load, naming the angle.
    """
    from cqdd_design.gearbox.contact.compliant_sweep_kernel import yield_sweep

    contacts, springs, load, turns, _ = sweep_problem(model, torque, states, changed)
    none = ContactFriction("drive", 0.0, 0.0)
    rubs: Rubbing = rubbing(model, states, friction or none, torque)
    count, discs, each = states.gaps.shape
    result = YieldingResult(
        states=np.empty((count, 4 + 3 * discs)),
        approach=np.empty((count, discs, each)),
        force=np.empty((count, discs, each)),
        cam_force=np.empty((count, discs, 2)),
        torsional=np.empty(count),
        steps=np.zeros(count, dtype=np.int64),
    )
    solve: Any = yield_sweep
    failed = solve(contacts, springs, load, rubs, compliance, turns, smooth.states, result)
    if failed >= 0:
        why = "with the carrier's cap on its pins"
        if friction is not None:
            why += f" and friction of {friction.tooth:g} at teeth and {friction.pin:g} at pins"
        raise ContactError(
            f"at crank angle {math.degrees(states.crank_angle[failed]):.6g} deg and {torque:g} N*m "
            f"no forces carry the load {why}; lower the torque or the friction."
        )
    return result
