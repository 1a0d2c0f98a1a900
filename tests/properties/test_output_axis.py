"""The carrier's axis off the ring's: a place in the housing, which turns with nothing."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from solids_designs import CHANGES, known_design, known_parts, part_named

from cqdd_design.design import Design
from cqdd_design.exporting.sheets.assembly_facts import AssemblyFacts
from cqdd_design.exporting.sheets.part_facts import PartFacts
from cqdd_design.exporting.sheets.part_sheet import plan_sheet
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.part_errors import GearboxErrors
from cqdd_design.gearbox.contact.states import error_states, nominal_states
from cqdd_design.gearbox.contact.sweep import contact_sweep, output_turn_angles
from cqdd_design.gearbox.precision.backlash import Backlash, backlash
from cqdd_design.gearbox.tolerance.draws import GROUPS, draw_errors
from cqdd_design.geometry.contours import Circle
from cqdd_design.machine import resolve
from cqdd_design.machine.centring import centring, most_off_centre, most_reading
from cqdd_design.report.judgement.labels import label_of
from cqdd_design.solids.features.carrier import OUTPUT_REGISTER
from cqdd_design.solids.features.housing import INDICATOR_BAND
from cqdd_design.solids.features.kinds import TrueFace

OFF = np.array([7e-6, -4e-6])
"""Off in a direction that no symmetry of the paper's gearbox knows."""
ANGLES = (0.0, 0.4, 2.1, 17.3)
PIN_0 = (5.222435229341776, -3.733716011430492)
PLAY_0 = (1.4907817622942408, 1.689992036766012)
"""Of gearbox 0 of seed 0, um, as they were before the output's axis was drawn too."""


@pytest.fixture(scope="module")
def model() -> ContactModel:
    return ContactModel.from_design(known_design("paper"))


def stated(deviation: float) -> Design:
    """The paper's design with another tolerance of its output's place, m."""
    return known_design("paper").replacing({"tolerances.output_position": deviation})


def off_by(model: ContactModel, axis: np.ndarray) -> GearboxErrors:
    return GearboxErrors.none(model)._replace(output_axis=np.asarray(axis, dtype=float))


def by_hand(model: ContactModel, axis: np.ndarray, crank: float) -> GearboxErrors:
    """The same at one crank angle, by pins and cams that are off in their own turning frames."""
    off = complex(*axis)
    # Pins turn by -phi/n, disc d's crank by phi and its phase.
    pins = off * np.exp(1j * crank / model.lobe_count)
    cams = 0.5 * off * np.exp(-1j * (crank + np.asarray(model.phases)))
    return GearboxErrors.none(model)._replace(
        pin_position=np.tile([pins.real, pins.imag], (model.pin_count, 1)),
        cam_centre=np.stack([cams.real, cams.imag], axis=-1),
    )


def rings_way(model: ContactModel, axis: np.ndarray, crank: float) -> GearboxErrors:
    """The same as the shaft sees it, which stays: the ring goes one way and the pins the other."""
    half = by_hand(model, 0.5 * axis, crank)
    return half._replace(
        cam_centre=np.zeros_like(half.cam_centre),
        tooth_position=np.tile(-0.5 * axis, (model.tooth_count, 1)),
    )


def turned(axis: np.ndarray, angle: float) -> np.ndarray:
    whole = complex(*axis) * np.exp(1j * angle)
    return np.array([whole.real, whole.imag])


# ------------------------------------------------------------------ gaps and forces


@pytest.mark.parametrize("crank", ANGLES)
@pytest.mark.parametrize("other", [by_hand, rings_way])
def test_it_is_what_pins_and_cams_or_ring_and_pins_do_by_hand(
    model: ContactModel, crank: float, other: object
) -> None:
    assert callable(other)
    errors, hand = off_by(model, OFF), other(model, OFF, crank)
    at = np.array([crank])
    for torque in (40.0, -15.0):
        found = contact_sweep(model, torque, at, errors=errors)
        wanted = contact_sweep(model, torque, at, errors=hand)
        assert found.ring_force == pytest.approx(wanted.ring_force, abs=1e-5)
        assert found.pin_force == pytest.approx(wanted.pin_force, abs=1e-5)
        assert found.carrier_angle_error == pytest.approx(wanted.carrier_angle_error, rel=1e-7)
    free, known = backlash(model, at, errors=errors), backlash(model, at, errors=hand)
    # Of parts that are off only those of the pins' own frame do not turn with the carrier's play.
    assert free.free == pytest.approx(known.free, rel=3e-3)
    assert free.free[0] > 1e-4


def test_half_of_it_is_the_cams_and_all_of_it_the_pins(model: ContactModel) -> None:
    states = nominal_states(model, np.array(ANGLES))
    none, found = (error_states(model, states, off_by(model, axis)) for axis in (0.0 * OFF, OFF))
    assert found.offset - none.offset == pytest.approx(
        np.broadcast_to(0.5 * OFF, none.offset.shape), abs=1e-18
    )
    assert np.array_equal(found.offset_rates, none.offset_rates)
    teeth = model.tooth_count
    assert np.array_equal(found.gaps[..., :teeth], none.gaps[..., :teeth])
    toward = states.rows[:, :, teeth:, :2] @ OFF
    assert found.gaps[..., teeth:] - none.gaps[..., teeth:] == pytest.approx(-toward, abs=1e-17)


def test_none_of_it_changes_nothing(model: ContactModel) -> None:
    """To the bit, with every other error there is."""
    drawn = draw_errors(model, known_design("paper").tolerances, 4, 0, 1).one(0)
    without = drawn._replace(output_axis=np.zeros(2))
    states = nominal_states(model, output_turn_angles(model, 44))
    changed = error_states(model, states, without)
    part = without._replace(output_axis=np.array([-0.0, 0.0]))
    for a, b in zip(changed, error_states(model, states, part), strict=True):
        assert np.array_equal(a, b)
    perfect = backlash(model, states=states)
    same = backlash(model, states=states, errors=off_by(model, np.zeros(2)))
    assert np.array_equal(perfect.free, same.free)


def test_the_energys_slope_knows_that_it_does_not_turn(model: ContactModel) -> None:
    """The crank's torque is the energy's derivative over the crank angle, axis held."""
    errors, step = off_by(model, 2.0 * OFF), 1e-4
    for crank in ANGLES[1:]:
        at = np.array([crank - step, crank, crank + step])
        found = contact_sweep(model, 40.0, at, errors=errors)
        slope = (found.energy[2] - found.energy[0]) / (2.0 * step)
        assert abs(slope) > 1e-4
        assert found.crank_ripple[1] == pytest.approx(slope, rel=1e-3, abs=2e-6)


# ------------------------------------------------------------------ direction


def free(model: ContactModel, crank: np.ndarray, axis: np.ndarray) -> Backlash:
    return backlash(model, crank, errors=off_by(model, axis))


def test_the_ring_and_the_pins_say_which_ways_are_alike(model: ContactModel) -> None:
    """Two teeth on, crank and axis turned together, pins stand where others stood.

    With one pitch of the ring's eleven teeth the discs stand a lobe on, which is a tenth of a turn
    for the carrier: half of a pitch of its five pins, and a whole one after two. Half a turn is
    no symmetry of eleven teeth.
    """
    crank = np.array(ANGLES)
    ahead = 4.0 * np.pi / model.tooth_count
    found = free(model, crank, OFF)
    alike = free(model, crank + ahead, turned(OFF, ahead))
    assert alike.least == pytest.approx(found.least, abs=1e-8)
    assert alike.greatest == pytest.approx(found.greatest, abs=1e-8)
    still = free(model, crank + ahead, OFF)
    other = free(model, crank, -OFF)
    for unlike in (still, other):
        assert np.abs(unlike.greatest - found.greatest).max() > 2e-5


def test_seen_in_a_mirror_the_senses_change() -> None:
    """Across the line through the middle between teeth 1 and 2, twelve pins lie as they lay."""
    model = ContactModel.from_design(known_design("one disc"))
    assert (model.tooth_count, model.pin_count) == (11, 12)
    line, crank = 3.0 * np.pi / 11.0, np.array(ANGLES)
    found = free(model, crank, OFF)
    mirrored = free(model, (2.0 * line - crank)[::-1], turned(OFF * [1.0, -1.0], 2.0 * line))
    assert mirrored.least[::-1] == pytest.approx(-found.greatest, abs=1e-8)
    assert mirrored.greatest[::-1] == pytest.approx(-found.least, abs=1e-8)


def test_over_a_turn_it_takes_the_backlash_and_adds_to_the_error(model: ContactModel) -> None:
    """What docs/assumptions.md says of 10, 20 and 30 um, as means of 330 angles."""
    angle, arcmin = output_turn_angles(model, 330), math.radians(1.0 / 60.0)
    means = [free(model, angle, np.array([off, 0.0])).mean for off in (0.0, 10e-6, 20e-6, 30e-6)]
    assert means[0] == pytest.approx(6.8 * arcmin, rel=0.02)
    assert means[1] == pytest.approx(4.5 * arcmin, rel=0.02)
    assert means[2] == pytest.approx(1.8 * arcmin, rel=0.05)
    assert means[3] == pytest.approx(0.4 * arcmin, rel=0.1)
    error = np.ptp(contact_sweep(model, 8.0, angle, errors=off_by(model, OFF)).carrier_angle_error)
    assert error > 3.0 * np.ptp(contact_sweep(model, 8.0, angle).carrier_angle_error)


# ------------------------------------------------------------------ draws


@pytest.mark.parametrize("distribution", ["normal", "uniform"])
def test_it_is_anywhere_in_its_zone_alike_and_never_outside(
    model: ContactModel, distribution: str
) -> None:
    design = known_design("paper").replacing(
        {"tolerances.output_position": 4e-6, "tolerances.distribution": distribution}
    )
    drawn = draw_errors(model, design.tolerances, 9, 0, 20_000).output_axis
    radius = 0.5 * design.tolerances.output_zone
    assert radius == pytest.approx(8e-6)
    off = np.hypot(*drawn.T) / radius
    assert off.max() < 1.0
    # As many in a ring as its area is of the circle's, in every direction.
    for share in (0.2, 0.5, 0.9, 0.99):
        assert np.mean(off**2 < share) == pytest.approx(share, abs=0.01)
    angle = np.arctan2(*drawn.T)
    assert np.histogram(angle, 8, (-np.pi, np.pi))[0] == pytest.approx(2500, abs=200)
    assert drawn.std(axis=0) == pytest.approx(4e-6, rel=0.02)


def test_the_other_tolerances_have_the_streams_they_had() -> None:
    assert GROUPS.index("output_position") == len(GROUPS) - 1
    assert GROUPS[:3] == ("tooth_position", "tooth_radius", "disc_profile")
    design = known_design("paper")
    model = ContactModel.from_design(design)
    drawn = draw_errors(model, design.tolerances, 0, 0, 1).one(0)
    assert 1e6 * drawn.pin_position[0] == pytest.approx(PIN_0, rel=1e-9)
    assert 1e6 * drawn.cam_play == pytest.approx(PLAY_0, rel=1e-9)


# ------------------------------------------------------------------ the sheet


@pytest.mark.parametrize("deviation", [2e-6, 5e-6, 9.5e-6])
def test_what_the_sheet_asks_for_is_what_is_drawn(deviation: float) -> None:
    """An axis at the reading's limit, on a band at its own, is at the edge of the drawn zone."""
    machine = resolve(stated(deviation))
    band = next(
        one
        for one in part_named(machine.parts, "housing").features
        if isinstance(one, TrueFace) and one.name == INDICATOR_BAND
    )
    reading, zone = most_reading(machine), 4.0 * deviation
    assert 0.5 * reading + 0.5 * band.run_out == pytest.approx(0.5 * zone)
    said = centring(machine)
    assert f"until a whole turn reads {1e3 * reading:.4g} mm or less" in said
    assert f"within a zone of \u00d8{1e3 * zone:.4g} mm about the ring's" in said
    assert f"\u00d8{2e3 * machine.layout.housing.flange_radius:.5g} mm," in said
    assert said in AssemblyFacts(machine).notes()
    model = ContactModel.from_design(machine.design)
    drawn = draw_errors(model, machine.design.tolerances, 0, 0, 4000).output_axis
    assert 0.99 < np.hypot(*drawn.T).max() / (0.5 * zone) < 1.0


def test_by_default_it_is_two_hundredths_of_a_millimetre() -> None:
    machine = resolve(known_design("paper"))
    assert machine.design.tolerances.output_zone == pytest.approx(0.02e-3)
    assert "reads 0.015 mm or less" in centring(machine)
    assert label_of("tolerances.output_position").words == "output position"


def test_no_indicator_shows_what_is_truer_than_its_band() -> None:
    said = centring(resolve(stated(1e-6)))
    assert "which no indicator shows: state a deviation of 1.75 um or more" in said
    assert "tap the cover" not in said
    assert "tap the cover" in centring(resolve(stated(1.75e-6)))


def test_a_zone_that_the_spigots_keep_needs_no_indicator() -> None:
    machine = resolve(stated(30e-6))
    off = most_off_centre(machine)
    assert off is not None
    assert off < 60e-6
    assert "tap the cover" not in centring(machine)
    assert "leaves the output's axis within a zone of \u00d80.12 mm" in centring(machine)
    assert "tap the cover" in centring(resolve(stated(0.99 * off / 2.0)))


@pytest.mark.parametrize("name", CHANGES)
def test_the_band_is_there_and_an_indicator_gets_at_it(name: str) -> None:
    """Round, half a millimetre high or more, with room beside it for a stylus on its lever."""
    parts = known_parts(name)
    housing = part_named(parts, "housing")
    band = next(one for one in housing.features if getattr(one, "name", "") == INDICATOR_BAND)
    assert isinstance(band, TrueFace)
    assert band.top - band.bottom >= 0.5e-3
    middle = 0.5 * (band.bottom + band.top)
    layers = [one for one in housing.shape.layers if one.bottom < middle < one.top]
    outside = [one.shape.outer for one in layers if isinstance(one.shape.outer, Circle)]
    assert max(one.radius for one in outside) == pytest.approx(0.5 * band.diameter)
    assert len(outside) == len(layers)
    motor = resolve(known_design(name)).layout.motor
    if motor is not None:
        head = motor.ear_circle - 0.5 * motor.cover_screw.head_diameter
        assert head - 0.5 * band.diameter >= 5e-3


@pytest.mark.parametrize("name", CHANGES)
def test_the_housings_sheet_has_room_for_what_is_said_of_the_band(name: str) -> None:
    facts = PartFacts(part_named(known_parts(name), "housing"), known_design(name))
    plan = plan_sheet(facts)
    assert plan.fits
    assert plan.scale >= 0.2
    band = next(one for one in facts.part.features if getattr(one, "name", "") == INDICATOR_BAND)
    assert isinstance(band, TrueFace)
    on_band = plan.section.at(0.5 * (band.bottom + band.top), 0.5 * band.diameter)
    assert on_band in [one.block.target for one in plan.section.blocks]


# ------------------------------------------------------------------ without load


@pytest.mark.parametrize("seed", [None, 0, 1, 2, 3])
def test_without_load_parts_press_where_they_overlap(model: ContactModel, seed: int | None) -> None:
    """And nowhere else: parts that hang free have an equilibrium too, without any force."""
    design, angle = known_design("paper"), output_turn_angles(model, 66)
    errors = off_by(model, 3.0 * OFF)
    if seed is not None:
        errors = draw_errors(model, design.tolerances, seed, 0, 1).one(0)
    found = contact_sweep(model, 0.0, angle, errors=errors)
    most = np.maximum(found.ring_force.max(axis=(1, 2)), found.pin_force.max(axis=(1, 2)))
    rigid = backlash(model, angle, errors=errors)
    tight, loose = rigid.overlap > 5e-7, rigid.overlap < 2e-8
    assert loose.any()
    assert most[tight].min(initial=np.inf) > 1.0
    assert most[loose].max() < 1e-9


@pytest.mark.parametrize("name", ["paper", "one disc"])
def test_what_is_driven_is_centred_by_a_bore_or_by_dowels(name):
    """The bore runs from the shoulder of the shaft's bearing to the output's face, all H7."""
    machine = resolve(known_design(name))
    carrier, shaft = machine.layout.carrier, machine.layout.shaft
    plate = part_named(machine.parts, "carrier plate")
    (bore,) = (one for one in plate.features if one.name == OUTPUT_REGISTER)
    assert (bore.zone, bore.refers, bore.inside) == ("H7", "A", True)
    assert bore.diameter == 2.0 * shaft.support.lip_radius
    # Nothing of the shaft stands in it.
    depth = carrier.plate_top - max(carrier.shaft_seat_top, shaft_end(machine))
    assert bore.top - bore.bottom == pytest.approx(depth)
    radius = min(
        hole.radius
        for layer in plate.shape.layers
        if layer.bottom <= bore.bottom + 1e-9 and layer.top > bore.bottom
        for hole in layer.shape.holes
        if isinstance(hole, Circle) and not np.any(hole.centre)
    )
    assert radius == pytest.approx(0.5 * bore.diameter)
    (said,) = (one for one in AssemblyFacts(machine).notes() if one.startswith("What is driven"))
    assert f"\u00d8{1e3 * bore.diameter:.4g} H7 and {1e3 * depth:.3g} mm deep" in said
    assert carrier.flange_dowels.count
    assert said.endswith("or by the dowels of the output's face: the other needs play then.")
    bare = replace(carrier, flange_dowels=replace(carrier.flange_dowels, count=0))
    facts = AssemblyFacts(machine)
    facts.machine = SimpleNamespace(layout=replace(machine.layout, carrier=bare))
    assert facts.driven().endswith(" mm deep.")


def shaft_end(machine):
    """Height of the eccentric shaft's output end, m."""
    shafts = [one for one in machine.parts if one.name.startswith("eccentric shaft")]
    return max(layer.top for one in shafts for layer in one.shape.layers)
