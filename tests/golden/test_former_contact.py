"""Without friction, between held plates and rigid bodies: what the first solver gave of design S.

Its forces were stored before there was friction, a joined carrier or an elastic body in the code,
and stand against both roads of today: the sweep that knows nothing of them, and the one that knows
them all and finds each of them absent.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cqdd_design.design import load_design
from cqdd_design.gearbox.contact.compliant import carrier_compliance, compliant_states
from cqdd_design.gearbox.contact.kernel_values import SweepResult
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.rubbing import ContactFriction
from cqdd_design.gearbox.contact.states import error_states, nominal_states
from cqdd_design.gearbox.contact.sweep import contact_sweep
from cqdd_design.gearbox.pin_beam import PinBeam

DESIGN = Path(__file__).resolve().parents[2] / "designs" / "reference-s.toml"
FORMER = json.loads(Path(__file__).with_name("test_former_contact_golden.json").read_text())
WITHIN = 1e-9


@pytest.mark.parametrize(
    "case", FORMER["cases"], ids=lambda one: f"{one['discs']}-{one['law']}-{one['torque_Nm']}"
)
def test_the_former_forces_to_a_billionth(case: dict[str, Any]) -> None:
    design, discs = load_design(DESIGN), case["discs"]
    reducer = design.reducer.unchecked_copy({"disc_count": discs})
    model = ContactModel.from_design(design.unchecked_copy({"reducer": reducer}), case["law"])
    model = replace(model, pin=None, bodies=None)
    angle, torque = np.array(FORMER["crank_angle_rad"]), case["torque_Nm"]
    sweep = contact_sweep(model, torque, angle)
    force = np.concatenate([sweep.ring_force, sweep.pin_force], axis=2)
    ring, pins = (
        np.array(case[f"{kind}_force_N"]).reshape(3, discs, -1) for kind in ("ring", "pin")
    )
    cam = np.array(case["cam_force_N"]).reshape(3, discs, 2)
    wanted = np.concatenate([ring, pins], axis=2)
    scale = float(np.abs(cam).max())
    none = np.zeros(discs)
    lone = PinBeam(1.0 - none, none, np.diag(model.pin_series), 0.0, np.zeros((2, 0)), none)
    states = nominal_states(model, angle)
    start = SweepResult(
        sweep.state_vectors, force, sweep.cam_force, sweep.stiffness, np.zeros(3, int)
    )
    rubbing = contact_sweep(model, torque, angle, friction=ContactFriction("drive", 0.0, 0.0))
    joined = compliant_states(
        model,
        torque,
        states,
        error_states(model, states, None),
        start,
        carrier_compliance(model.pin_count, lone),
        ContactFriction("drive", 0.0, 0.0),
    )
    rubbed = np.concatenate([rubbing.ring_force, rubbing.pin_force], axis=2)
    for found, carried in (
        (force, sweep.cam_force),
        (rubbed, rubbing.cam_force),
        (joined.force, joined.cam_force),
    ):
        assert np.abs(found - wanted).max() < WITHIN * scale
        assert np.abs(carried - cam).max() < WITHIN * scale
    # Read from the last step's matrix, which stands a step before the state.
    stiffness = np.array(case["stiffness_Nm_per_rad"])
    assert sweep.stiffness == pytest.approx(stiffness, rel=WITHIN)
    assert joined.torsional * model.pin_circle_radius**2 == pytest.approx(stiffness, rel=1e-5)
