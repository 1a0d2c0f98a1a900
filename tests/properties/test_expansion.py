"""Warm parts: the contacts move as the parts' own sizes say, by any road."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from reference_design import DESIGN_S

from cqdd_design.catalog.bearings import BEARING_MATERIAL, find_bearing
from cqdd_design.catalog.materials import find_material, materials
from cqdd_design.design import load_design
from cqdd_design.errors import ContactError, DesignError, UsageError
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.part_errors import GearboxErrors
from cqdd_design.gearbox.contact.rubbing import ContactFriction
from cqdd_design.gearbox.contact.states import nominal_states
from cqdd_design.gearbox.contact.sweep import contact_sweep, idle_sweep, perfect_angles
from cqdd_design.gearbox.heat.expansion import (
    AS_DRAWN,
    PartTemperatures,
    growth_of,
    heated,
    part_materials,
)
from cqdd_design.gearbox.precision.backlash import backlash
from cqdd_design.gearbox.tolerance.ensemble import make_ensemble
from cqdd_design.gearbox.tolerance.run import run_ensemble
from cqdd_design.geometry.kinematics import disc_pose
from cqdd_design.machine import Machine, resolve

UNEVEN = PartTemperatures(ring=45.0, disc=58.0, carrier=52.0, pin=55.0, shaft=63.0)


@pytest.fixture(scope="module")
def machine() -> Machine:
    return resolve(load_design(DESIGN_S))


def test_at_the_drawings_temperature_nothing_moves(machine: Machine) -> None:
    assert heated(machine.contact, machine.design, AS_DRAWN) is machine.contact


def test_seats_of_another_material_give_or_take_play(machine: Machine) -> None:
    """A disc of bronze grows beyond its bearing's outer ring; a disc alone widens the raceway."""
    bronze = machine.changed({"reducer.disc_material": "Bronze CuSn12"})
    bearing = find_bearing(bronze.design.reducer.cam_bearing.designation)
    alpha, steel = (find_material(one).expansion for one in ("Bronze CuSn12", BEARING_MATERIAL))
    shaft = find_material(part_materials(bronze.design)["shaft"]).expansion
    grown = growth_of(bronze.design, PartTemperatures.even(60.0)).play
    wanted = (alpha - steel) * bearing.outer_diameter - (shaft - steel) * bearing.bore_diameter
    assert grown == pytest.approx(40.0 * wanted, rel=1e-12)
    assert grown > 5e-6
    uneven = growth_of(machine.design, PartTemperatures(20.0, 50.0, 20.0, 20.0, 20.0)).play
    disc = find_material(machine.design.reducer.disc_material).expansion
    mean = 0.5 * (bearing.bore_diameter + bearing.outer_diameter)
    assert uneven == pytest.approx(
        30.0 * (steel * mean + (disc - steel) * bearing.outer_diameter), rel=1e-12
    )


def test_teeth_and_pins_stand_where_their_parts_take_them(machine: Machine) -> None:
    """Every gap from the parts alone: lengths of a part by its own factor, in the plane."""
    drawn, model = machine.contact, machine.at(UNEVEN).contact
    share = growth_of(machine.design, UNEVEN)
    phi = np.linspace(0.0, 5.0, 7)
    states = nominal_states(model, phi)
    n, own = model.lobe_count, phi[:, None] + model.phases
    e = drawn.eccentricity * (1.0 + share.shaft)
    turn, shift = disc_pose(model.disc, own)
    assert np.abs(shift) == pytest.approx(e, rel=1e-12)
    # Ring: distance from a warm tooth's centre to the drawn disc, stretched.
    teeth = drawn.ring_pitch_radius * np.exp(2j * np.pi * np.arange(n + 1) / (n + 1))
    seen = ((1.0 + share.ring) * teeth - shift[..., None]) / turn[..., None]
    outline = drawn.disc.profile(np.linspace(0.0, 2.0 * np.pi, 40_000))[0] * (1.0 + share.disc)
    far = np.abs(seen[..., None] - outline).min(axis=-1)
    gap = far - drawn.tooth_radius * (1.0 + share.ring)
    assert states.gaps[:, :, : n + 1] == pytest.approx(gap, abs=3e-9)
    # Pins: distance between the middles of hole and pin, to first order in what heat parts them.
    around = 2.0 * np.pi * np.arange(model.pin_count) / model.pin_count
    at = np.exp(1j * (model.hole_clocking + around - phi[:, None] / n))[:, None, :]
    hole = shift[..., None] + drawn.pin_circle_radius * (1.0 + share.disc) * at
    pin = drawn.pin_circle_radius * (1.0 + share.carrier) * at
    room = drawn.hole_radius * (1.0 + share.disc)
    room -= drawn.pin_contact_radius * (1.0 + share.pin)
    assert states.gaps[:, :, n + 1 :] == pytest.approx(room - np.abs(hole - pin), abs=3e-8)


def test_rates_of_the_gaps_are_their_slopes(machine: Machine) -> None:
    model, step = machine.at(UNEVEN).contact, 1e-5
    phi = np.linspace(0.1, 4.0, 5)
    ahead, behind = (nominal_states(model, phi + s).gaps for s in (step, -step))
    slope = (ahead - behind) / (2.0 * step)
    assert nominal_states(model, phi).rates[..., 2] == pytest.approx(slope, abs=1e-9)


def test_pins_off_their_holes_are_the_position_errors_that_they_are(machine: Machine) -> None:
    model = machine.at(UNEVEN).contact
    angle = model.hole_clocking + 2.0 * np.pi * np.arange(model.pin_count) / model.pin_count
    outward = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    errors = GearboxErrors.none(model)._replace(pin_position=model.pin_reach * outward)
    phi = np.linspace(0.0, model.period, 12)
    told = backlash(replace(model, pin_reach=0.0), phi, errors=errors)
    assert backlash(model, phi).free == pytest.approx(told.free, rel=1e-6)


def test_an_ensemble_without_tolerances_is_the_warm_gearbox(machine: Machine) -> None:
    zero = {key: 0.0 for key in machine.design.to_mapping()["tolerances"] if key != "distribution"}
    design = machine.design.replacing({f"tolerances.{key}": 0.0 for key in zero})
    parts = PartTemperatures.even(55.0)
    found = run_ensemble(
        make_ensemble(design, temperatures=parts, angles=220), 1, sensitivity=False
    )
    exact = backlash(machine.at(parts).contact).mean * 60.0 * math.degrees(1.0)
    assert found.statistics()["backlash_arcmin"]["mean"] == pytest.approx(exact, abs=0.02)
    cold = run_ensemble(make_ensemble(design, angles=220), 1, sensitivity=False)
    assert cold.statistics()["backlash_arcmin"]["mean"] > 1.2 * exact


def test_a_bearing_with_a_warm_inner_ring_loses_play(machine: Machine) -> None:
    alpha = find_material(BEARING_MATERIAL).expansion
    assert alpha is not None
    even = machine.changed({"reducer.disc_material": BEARING_MATERIAL})
    apart = growth_of(even.design, PartTemperatures(disc=60.0, shaft=80.0)).play
    same = growth_of(even.design, PartTemperatures(disc=80.0, shaft=80.0)).play
    mean = 0.5 * (machine.cam.bore_diameter + machine.cam.outer_diameter)
    # 20 K between rings on the mean diameter, and the disc's seat follows its ring.
    assert apart - same == pytest.approx(-alpha * mean * 20.0, rel=1e-9)
    hot: ContactModel = even.at(PartTemperatures(shaft=120.0)).contact
    assert hot.cam.play == 0.0


def test_materials_without_expansion_are_said(machine: Machine) -> None:
    unknown = [name for name, one in materials().items() if one.expansion is None]
    assert unknown
    carbon = machine.changed({"housing.material": unknown[0]})
    with pytest.raises(DesignError, match=r"no thermal expansion of .*the carrier is made"):
        growth_of(carbon.design, PartTemperatures.even(21.0))
    assert growth_of(carbon.design, AS_DRAWN).carrier == 0.0


@pytest.mark.parametrize("wrong", [-61.0, 201.0, math.nan, math.inf])
def test_absurd_temperatures_are_refused(wrong: float) -> None:
    with pytest.raises(UsageError, match="outside -60 to 200 degC"):
        PartTemperatures.even(wrong)


def test_every_figure_of_heat_has_a_source() -> None:
    for one in materials().values():
        told = (one.expansion, one.conductivity, one.specific_heat, one.emissivity)
        assert bool(one.thermal_source) == all(value is not None for value in told), one.name


def test_parts_that_hang_between_contacts_have_an_equilibrium_under_next_to_no_load(
    machine: Machine,
) -> None:
    """At 62 deg C the parts of S just touch: without any load friction holds nothing in place."""
    model = machine.at(PartTemperatures.even(62.0)).contact
    states = nominal_states(model, perfect_angles(model, 24))
    rubbed = ContactFriction.of(model, "drive")
    with pytest.raises(ContactError):
        contact_sweep(model, 0.0, states=states, friction=rubbed)
    idle = idle_sweep(model, 90.0, states, rubbed)
    assert idle.torque == 0.0
    assert 0.0 < idle.ring_force.max() < 1.0
