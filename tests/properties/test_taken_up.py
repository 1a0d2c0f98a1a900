"""The pose of taken-up play, against sampled outlines, the search for backlash and differences."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cqdd_design.design import load_design
from cqdd_design.errors import ContactError
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.states import nominal_states
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.gearbox.contact.tables import ring_table
from cqdd_design.gearbox.contact.taken_up import _pins, _until_touching, taken_up
from cqdd_design.gearbox.precision.backlash import backlash
from cqdd_design.geometry.kinematics import disc_pose
from cqdd_design.geometry.meshing import tooth_centres

DESIGNS = Path(__file__).parents[2] / "designs"
LOOSE = {
    "reducer.modification.equidistant": "300 um",
    "reducer.output_pins.hole_clearance": "200 um",
    "reducer.cam_bearing.radial_clearance": "0 um",
}


def model_of(name: str, changes: dict[str, object]) -> ContactModel:
    return ContactModel.from_design(load_design(DESIGNS / f"{name}.toml").replacing(changes))


@pytest.fixture(scope="module")
def loose() -> ContactModel:
    return model_of("printed-13", LOOSE)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_gaps_are_those_of_sampled_outlines(loose: ContactModel, sense: float) -> None:
    """Outline and pins moved by the found turns alone, the least distances taken point by point."""
    angle = perfect_angles(loose, 5)
    found = taken_up(loose, angle, sense)
    outline, _ = loose.disc.profile(np.linspace(0.0, 2.0 * np.pi, 200_001))
    rotation, centre = (part[:, 0] for part in disc_pose(loose.disc, angle[:, None]))
    teeth = tooth_centres(loose.disc) @ [1.0, 1j]
    seen = found.states.ring.point[:, 0] @ [1.0, 1j]
    for k in range(len(angle)):
        # The turn of the disc is read off one of its points; all others must follow it.
        place = loose.disc.profile(found.states.ring.parameter[k, 0])[0]
        turned = (seen[k] - centre[k]) / (place * rotation[k])
        assert turned == pytest.approx(turned[0], abs=1e-12)
        assert np.sign(np.angle(turned[0])) == sense
        flank = centre[k] + outline * rotation[k] * turned[0]
        distance = np.abs(teeth[:, None] - flank).min(axis=1) - loose.tooth_radius
        assert found.states.gaps[k, 0, :14] == pytest.approx(distance, abs=2e-9)
        assert distance.min() == pytest.approx(0.0, abs=2e-9)
        pins = loose.pin_circle_radius * np.exp(1j * found.states.pin_angle[k])
        holes = centre[k] + pins * np.exp(-1j * found.carrier_turn[k]) * turned[0]
        free = loose.pin_gap + loose.eccentricity - np.abs(pins - holes)
        assert found.states.gaps[k, 0, 14:] == pytest.approx(free, abs=1e-12)
        assert free.min() == pytest.approx(0.0, abs=1e-11)


def test_the_range_is_the_backlash_of_parts_on_a_tight_cam(loose: ContactModel) -> None:
    """Found there by linear programs over all positions of the parts."""
    angle = perfect_angles(loose, 3)
    ends = [taken_up(loose, angle, sense).carrier_turn for sense in (-1.0, 1.0)]
    assert ends[1] - ends[0] == pytest.approx(backlash(loose, angle).free, rel=2e-3)


def test_rates_are_differences_over_the_crank(loose: ContactModel) -> None:
    angle, step = perfect_angles(loose, 3) + 0.01, 1e-6
    disc, carrier = np.full(3, 0.012), np.full(3, 0.016)
    before, now, after = (
        ring_table(loose, angle + k * step, disc[:, None]) for k in (-1.0, 0.0, 1.0)
    )
    for rate, what in ((now.rates[..., 1], "arm"), (now.rates[..., 2], "gap")):
        ends = [t.rows[..., 2] if what == "arm" else t.gap for t in (before, after)]
        assert rate == pytest.approx((ends[1] - ends[0]) / (2.0 * step), rel=1e-5, abs=1e-7)
    ends = [_pins(loose, angle + k * step, disc, carrier) for k in (-1.0, 1.0)]
    rates = _pins(loose, angle, disc, carrier)[1]
    normals = [np.arctan2(rows[..., 1], rows[..., 0]) for rows, *_ in ends]
    spin = np.angle(np.exp(1j * (normals[1] - normals[0]))) / (2.0 * step)
    assert rates[..., 0] == pytest.approx(spin, rel=1e-6)
    arm = (ends[1][0][..., 2] - ends[0][0][..., 2]) / (2.0 * step)
    assert rates[..., 1] == pytest.approx(arm, rel=1e-5, abs=1e-8)
    assert rates[..., 2] == pytest.approx((ends[1][2] - ends[0][2]) / (2.0 * step), abs=1e-8)


@pytest.mark.parametrize("name", ["printed-13", "cqdd-10"])
def test_small_play_leaves_the_equilibria_where_they_were(name: str) -> None:
    model = model_of(name, {"reducer.modification.equidistant": "3 um"})
    angle = perfect_angles(model, 12)
    load = 6.0
    nominal = contact_sweep(model, load, states=nominal_states(model, angle))
    found = taken_up(model, angle, 1.0)
    again = contact_sweep(model, load, states=found.states)
    turned = found.carrier_turn + again.carrier_angle_error
    # Either leaves out what turns of some 6 mrad do to normals and arms.
    assert turned == pytest.approx(nominal.carrier_angle_error, rel=5e-3)
    assert again.ring_force == pytest.approx(
        nominal.ring_force, abs=0.03 * float(nominal.ring_force.max())
    )


def test_loads_that_the_nominal_pose_refuses_are_solved(loose: ContactModel) -> None:
    angle = perfect_angles(loose, 6)
    with pytest.raises(ContactError, match="quarter of the eccentricity"):
        contact_sweep(loose, 8.0, states=nominal_states(loose, angle))
    found = contact_sweep(loose, 8.0, states=taken_up(loose, angle, 1.0).states)
    assert np.all(found.carrier_angle_error > 0.0)


def test_parts_that_nothing_stops_are_refused() -> None:
    with pytest.raises(ContactError, match="within half a lobe"):
        _until_touching(lambda turn: np.full((len(turn), 1, 4), 1e-3), np.zeros(3), 1.0, 34e-3, 0.2)
