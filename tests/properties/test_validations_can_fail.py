"""Rows of the tables of validations fall when what they validate is wrong by half.

Every test of `test_contact_validation.py` and `test_actuator_validation.py` is called once more
with 1.5 times the result, or one field of it, of each function that its row is about. What happens
inside compiled kernels is `tools/mutations.py`'s part.
"""

from __future__ import annotations

import importlib.util
import inspect
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from wrong_by_half import name_of, wrong_by_half

from cqdd_design.actuator.simulate import simulate
from cqdd_design.actuator.thermal import response
from cqdd_design.gearbox import rigid
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.sweep import contact_sweep
from cqdd_design.gearbox.losses.sliding import friction_work, ring_sliding
from cqdd_design.gearbox.precision.backlash import Backlash
from cqdd_design.geometry.kinematics import mesh_period

pytestmark = pytest.mark.deep


def _loaded(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, Path(__file__).with_name(f"{name}.py"))
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[f"{name}_called"] = module  # where `wrong_by_half` finds its names
    spec.loader.exec_module(module)
    return module


CONTACT, ACTUATOR = _loaded("test_contact_validation"), _loaded("test_actuator_validation")
VALIDATED: dict[Callable[..., None], list[tuple[Any, str]]] = {
    CONTACT.test_balance: [
        (contact_sweep, "ring_force"),
        (contact_sweep, "pin_force"),
        (contact_sweep, "cam_force"),
    ],
    CONTACT.test_energy_slope_integrates_to_zero: [(mesh_period, "")],
    CONTACT.test_energy_slope_is_the_derivative: [
        (contact_sweep, "energy"),
        (contact_sweep, "contact_slope"),
        (ContactSweep.energy_slope, ""),
    ],
    CONTACT.test_rigid_limit: [(contact_sweep, "ring_force"), (rigid.ring_forces, "")],
    CONTACT.test_plain_twin: [(contact_sweep, "ring_force"), (contact_sweep, "pin_force")],
    CONTACT.test_independent_minimisation: [(contact_sweep, "ring_force")],
    CONTACT.test_backlash: [(Backlash.free, "")],
    CONTACT.test_period: [(mesh_period, "")],
    CONTACT.test_input_torque: [(contact_sweep, "cam_force")],
    CONTACT.test_friction_of_the_ring: [(friction_work, ""), (ring_sliding, "")],
    ACTUATOR.test_energy_is_kept_by_a_drawn_gearbox: [
        (simulate, f"ledger.{name}") for name in ("electrical", "copper", "stored_after")
    ],
    ACTUATOR.test_current_rises_as_in_a_coil: [(simulate, "current")],
    ACTUATOR.test_current_loop_is_of_first_order_and_late_by_its_delay: [(simulate, "current")],
    ACTUATOR.test_temperatures_follow_the_exact_network: [
        (simulate, "winding_temperature"),
        (simulate, "housing_temperature"),
        (response, ""),
    ],
    ACTUATOR.test_linear_transmission_swings_as_a_second_order_system: [(simulate, "deflection")],
    ACTUATOR.test_what_hits_behind_the_dead_zone_rebounds_as_a_second_order_system: [
        (simulate, "deflection")
    ],
    ACTUATOR.test_held_torque_winds_up_gap_and_spring: [(simulate, "deflection")],
    ACTUATOR.test_agrees_with_radau_on_the_smooth_equations: [
        (simulate, name)
        for name in ("current", "motor_angle", "motor_speed", "output_angle", "output_speed")
    ],
}


def _held(quantity: str, against: str, worst: float, bound: float) -> None:
    assert worst <= bound, f"{quantity} against {against}"


def _arguments(test: Callable[..., None]) -> dict[str, object]:
    given = {
        "validated": _held,
        "discs": 2,
        "name": "pendulum",
        "friction": "clip",
        "drawn": _drawn,
    }
    found = {name: given[name] for name in inspect.signature(test).parameters}
    return {name: value() if value is _drawn else value for name, value in found.items()}


def _drawn() -> object:
    machine = ACTUATOR.resolve(ACTUATOR.load_design(ACTUATOR.SAMPLE))
    return ACTUATOR.actuator_parameters(machine, ACTUATOR.Specimen(seed=3))


def test_every_validation_is_listed() -> None:
    tests = {
        one
        for module in (CONTACT, ACTUATOR)
        for name, one in vars(module).items()
        if name.startswith("test_") and "validated" in inspect.signature(one).parameters
    }
    assert tests == set(VALIDATED)


PAIRS = [(test, *pair) for test, pairs in VALIDATED.items() for pair in pairs]


@pytest.mark.parametrize(
    ("test", "exercised", "part"),
    PAIRS,
    ids=[f"{test.__name__}-{name_of(one)}-{part}" for test, one, part in PAIRS],
)
def test_a_row_falls(test: Callable[..., None], exercised: Any, part: str) -> None:
    arguments = _arguments(test)
    with wrong_by_half(exercised, part), pytest.raises(AssertionError, match=" against "):
        test(**arguments)
