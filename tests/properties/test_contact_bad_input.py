"""The contact engine on absurd, impossible and extreme input: an answer or a clear refusal."""

from __future__ import annotations

import math
import re
import subprocess
import sys

import numpy as np
import pytest
from contact_checks import assert_sound, one_body, some_angles, swept
from contact_designs import (
    contact_designs,
    machine_of,
    paper_design,
    usual_torque,
)
from contact_oracle import solve
from examples import examples
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cqdd_design.design import Design
from cqdd_design.errors import ContactError, CqddError, DesignError
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.sweep import (
    contact_sweep,
    perfect_angles,
)

SEEDS = st.integers(0, 2**32 - 1)
SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much]


def paper(**changes: object) -> ContactModel:
    return ContactModel.from_design(paper_design().replacing(changes))


CLEARANCES = (
    "reducer.modification.equidistant",
    "reducer.output_pins.hole_clearance",
    "reducer.cam_bearing.radial_clearance",
)


def test_no_torque_is_no_force() -> None:
    sweep = contact_sweep(paper(), 0.0, np.linspace(0.0, 6.0, 9))
    assert sweep.ring_force.max() == 0.0
    assert sweep.pin_force.max() == 0.0
    assert sweep.cam_load.max() == 0.0
    for value in (sweep.energy, sweep.energy_slope, sweep.carrier_angle_error, sweep.stiffness):
        assert np.isfinite(value).all()
    assert np.abs(sweep.energy).max() == 0.0
    assert np.abs(sweep.energy_slope).max() == 0.0


@pytest.mark.parametrize("torque", [1e-6, -1e-6, 1e-3])
@pytest.mark.parametrize("line_model", ["palmgren", "johnson", "linear"])
def test_a_tiny_torque_is_carried(torque: float, line_model: str) -> None:
    model = ContactModel.from_design(paper_design(), line_model)
    sweep = contact_sweep(model, torque, np.linspace(0.0, 6.0, 7))
    assert_sound(sweep)
    # Hardly more than the clearance is used up.
    loose = contact_sweep(model, 0.1 * torque, np.linspace(0.0, 6.0, 7))
    assert sweep.carrier_angle_error == pytest.approx(loose.carrier_angle_error, rel=5e-3)


@pytest.mark.parametrize("torque", [1e4, 1e9, -1e15, 1e300])
@pytest.mark.parametrize("line_model", ["palmgren", "johnson", "linear"])
def test_an_absurd_torque_is_refused_or_balanced(torque: float, line_model: str) -> None:
    model = ContactModel.from_design(paper_design(), line_model)
    try:
        sweep = contact_sweep(model, torque, np.linspace(0.0, 6.0, 5))
    except ContactError as refused:
        error = refused
    else:
        assert abs(torque) == 1e4
        assert_sound(sweep)
        return
    assert "N*m" in error.message
    assert len(error.message) > 40


@pytest.mark.parametrize("torque", [math.nan, math.inf, -math.inf])
def test_a_torque_that_is_no_number_is_refused(torque: float) -> None:
    with pytest.raises(ContactError, match="torque"):
        contact_sweep(paper(), torque, np.array([0.0]))


@pytest.mark.parametrize("torque", [1e-6, 1e-2, 40.0, -120.0])
@pytest.mark.parametrize("line_model", ["palmgren", "johnson", "linear"])
def test_zero_clearance_everywhere(torque: float, line_model: str) -> None:
    design = paper_design().replacing(dict.fromkeys(CLEARANCES, 0.0))
    model = ContactModel.from_design(design, line_model)
    angle = np.linspace(0.0, 6.0, 7)
    assert_sound(contact_sweep(model, torque, angle))
    nothing = contact_sweep(model, 0.0, angle)
    # Gaps are zero to rounding, 1e-17 m, and a micron is about a thousand newtons.
    assert nothing.ring_force.max() < 1e-7
    assert np.abs(nothing.carrier_angle_error).max() < 1e-9
    plain = solve(machine_of(model), float(angle[2]), torque)
    one = contact_sweep(one_body(model), torque, angle[2:3])
    apart = np.abs(one.ring_force[0] - plain.ring_force).max()
    assert apart < 1e-6 * plain.ring_force.max() + 1e-8


@pytest.mark.parametrize("line_model", ["palmgren", "johnson", "linear"])
def test_interference_is_a_balanced_preload(line_model: str) -> None:
    design = paper_design().replacing(
        {
            "reducer.modification.equidistant": -4e-6,
            "reducer.output_pins.hole_clearance": -6e-6,
            "reducer.cam_bearing.radial_clearance": 0.0,
        }
    )
    model = ContactModel.from_design(design, line_model)
    sweep = contact_sweep(model, 0.0, np.linspace(0.0, 6.0, 7))
    assert_sound(sweep)
    # Pressed all round: every tooth and every pin of every disc.
    assert sweep.ring_force.min() > 1.0
    assert sweep.pin_force.min() > 1.0
    assert sweep.energy.min() > 0.0
    assert sweep.stiffness.min() > 0.0
    model = one_body(model)
    plain = solve(machine_of(model), 2.0, 0.0)
    one = contact_sweep(model, 0.0, np.array([2.0]))
    assert np.abs(one.ring_force[0] - plain.ring_force).max() < 1e-6 * plain.ring_force.max()
    assert one.energy[0] == pytest.approx(plain.energy, rel=1e-7)
    # Torque unloads one side of a preloaded gearbox and adds to the other: no slack to take up.
    loaded = contact_sweep(model, 1e-2, np.array([2.0]))
    assert_sound(loaded)
    change = loaded.ring_force - one.ring_force
    assert change.min() < -1e-3
    assert change.max() > 1e-3
    assert loaded.carrier_angle_error[0] - one.carrier_angle_error[0] == pytest.approx(
        1e-2 / one.stiffness[0], rel=0.02
    )


@settings(max_examples=examples(16), deadline=None, suppress_health_check=SLOW)
@given(
    contact_designs(modified=False),
    st.floats(-8e-6, 2e-6),
    st.floats(-16e-6, 4e-6),
    st.sampled_from(["palmgren", "johnson", "linear"]),
    st.sampled_from([0.0, 1.0, -1.0]),
    SEEDS,
)
def test_random_fits_of_interference_balance(
    design: Design, ring: float, hole: float, line_model: str, sense: float, seed: int
) -> None:
    design = design.replacing(
        {"reducer.modification.equidistant": ring, "reducer.output_pins.hole_clearance": hole}
    )
    model = ContactModel.from_design(design, line_model)
    torque = 0.2 * sense * usual_torque(model)
    sweep = swept(model, torque, some_angles(seed, model, 3))
    if torque == 0.0 and sweep.ring_force.max() + sweep.pin_force.max() < 1e-5:
        # Nothing but the rounding of the gaps, 1e-17 m: no interference was asked for.
        assert ring > -1e-9
        return
    assert_sound(sweep)


def test_teeth_that_do_not_reach_are_named() -> None:
    """Clearance far beyond the engagement: refused with what to lower, never a wrong number."""
    for changes in (
        {"reducer.modification.equidistant": 500e-6},
        {"reducer.output_pins.hole_clearance": 1000e-6},
        {"reducer.modification.radial": 500e-6},
    ):
        model = ContactModel.from_design(paper_design().replacing(changes))
        try:
            sweep = contact_sweep(model, 40.0, np.linspace(0.0, 3.0, 5))
        except ContactError as refused:
            told = refused.message
        else:
            assert_sound(sweep)
            continue
        assert re.search(r"modification|hole_clearance", told)


def test_a_refusal_for_reach_is_true() -> None:
    """The plain minimisation moves the parts as far as the refusal says."""
    model = paper(**{"reducer.output_pins.hole_clearance": 1000e-6})
    with pytest.raises(ContactError, match="would have to move") as caught:
        contact_sweep(model, 40.0, np.array([0.3]))
    told = float(re.search(r"move by ([\d.e+-]+) mm", caught.value.message).group(1)) * 1e-3
    plain = solve(machine_of(model), 0.3, 40.0)
    moved = max(
        np.abs(plain.displacement[:, :2]).max(),
        np.abs(plain.displacement[:, 2]).max() * model.pin_circle_radius,
        abs(plain.gamma) * model.pin_circle_radius,
    )
    assert told == pytest.approx(moved, rel=5e-3)


@pytest.mark.parametrize("lobes", [60, 119])
def test_many_lobes(lobes: int) -> None:
    radius = 0.12
    design = Design.from_mapping(
        {
            "reducer": {
                "ratio": lobes,
                "ring_pitch_radius": radius,
                "eccentricity": 0.6 * radius / (lobes + 1),
                "ring_pin_diameter": 1.2 * radius * math.sin(math.pi / (lobes + 1)),
                "disc_thickness": 0.012,
                "disc_count": 3,
                "output_pins": {"count": 12, "diameter": 0.008},
                "cam_bearing": {"designation": "6005"},
            }
        },
        si=True,
    )
    model = ContactModel.from_design(design)
    sweep = contact_sweep(model, 200.0, perfect_angles(model, 12))
    assert_sound(sweep)
    assert sweep.ring_force.shape == (12, 3, lobes + 1)
    # About half of the teeth are on the loaded side; the clearance frees some of them.
    assert 0.1 * lobes < sweep.teeth_in_contact.mean() < 0.6 * lobes


def test_a_thousand_lobes_are_refused() -> None:
    for lobes in (120, 1000, 10**9):
        with pytest.raises(DesignError, match="ratio"):
            paper_design().replacing({"reducer.ratio": lobes, "requirements.ratio": lobes})


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_crank_angles_in_any_order_and_number() -> None:
    model = paper()
    with pytest.raises(CqddError, match="angle"):
        contact_sweep(model, 40.0, np.array([]))
    shuffled = np.array([5.0, -30.0, 5.0, 1e4, 0.0])
    sweep = contact_sweep(model, 40.0, shuffled)
    assert_sound(sweep)
    assert np.abs(sweep.ring_force[0] - sweep.ring_force[2]).max() < 1e-6
    for bad in (math.nan, math.inf):
        with pytest.raises(CqddError):
            contact_sweep(model, 40.0, np.array([0.0, bad]))


WATCHED = """
import sys
from pathlib import Path
import numpy as np
from cqdd_design.design import load_design
from cqdd_design.errors import CqddError
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.sweep import contact_sweep
design = load_design(Path(sys.argv[1]))
rng = np.random.default_rng(7)
done = 0
for _ in range(60):
    changes = {
        "reducer.modification.equidistant": float(rng.choice([-5e-4, -1e-5, 0.0, 1e-5, 5e-4])),
        "reducer.modification.radial": float(rng.choice([-1e-4, 0.0, 0.0, 1e-4])),
        "reducer.output_pins.hole_clearance": float(rng.choice([-1e-4, -1e-6, 0.0, 1e-6, 1e-3])),
        "reducer.cam_bearing.radial_clearance": float(rng.choice([0.0, 1e-6, 5e-4])),
        "reducer.disc_count": int(rng.integers(1, 4)),
        "reducer.output_pins.count": int(rng.integers(3, 7)),
    }
    torque = float(rng.choice([0.0, 1e-300, 1e-6, -1.0, 40.0, 1e5, -1e9, 1e200]))
    try:
        model = ContactModel.from_design(
            design.replacing(changes), str(rng.choice(["palmgren", "johnson", "linear"]))
        )
        sweep = contact_sweep(model, torque, np.sort(rng.uniform(0.0, 60.0, 4)))
        for name, value in vars(sweep).items():
            if isinstance(value, np.ndarray):
                assert np.isfinite(value).all(), (name, changes, torque)
    except CqddError as error:
        assert len(error.message) > 30
    done += 1
print(done)
"""


def test_nothing_hangs(tmp_path: object) -> None:
    """Sixty absurd gearboxes in a process of their own, which may not take long."""
    from contact_designs import PAPER_FILE

    ended = subprocess.run(
        [sys.executable, "-W", "error::RuntimeWarning", "-c", WATCHED, str(PAPER_FILE)],
        capture_output=True,
        encoding="utf-8",
        timeout=90.0,
        check=False,
    )
    assert ended.returncode == 0, ended.stderr[-2000:]
    assert ended.stdout.split() == ["60"]
