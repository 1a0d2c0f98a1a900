"""One mass and one torque density in `inertia`, bench and report; what a gearbox carries."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest

from cqdd_design.actuator.bench import run_bench
from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.actuator.specimen import AS_DRAWN, Specimen
from cqdd_design.catalog import find_bearing
from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design, load_design
from cqdd_design.errors import ContactError, DesignError
from cqdd_design.gearbox.checks.allowables import contact_limit_static
from cqdd_design.gearbox.contact.rubbing import ContactFriction
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.carrying import EQUILIBRIUM, RIGID, carried_torque
from cqdd_design.machine.weighing import weigh
from cqdd_design.report.actuator.bench_table import comparison
from cqdd_design.report.gearbox.masses import bodies_view
from cqdd_design.roads.bench import RIPPLE_DRAWS, drawn_actuators
from cqdd_design.roads.inertia import InertiaAndBalance
from cqdd_design.roads.inertia import inertia as weighed
from cqdd_design.solids.inertia import gearbox_inertia
from cqdd_design.solids.mesh import mass_properties

PAPER = load_design(Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml")
WIDE = PAPER.replacing(
    {
        "reducer.ring.outer_diameter": 0.11,
        "requirements.peak_torque": 60.0,
        "motor": {"name": "CubeMars RO100 Lite KV55", "bore_diameter": "20 mm"},
    }
)
"""A stator too narrow for its neck: the motor is not drawn, and asked for 60 N m."""
CHEAP = ("mass", "peak_torque", "torque_density")


def by_inertia(design: Design, monkeypatch: pytest.MonkeyPatch) -> InertiaAndBalance:
    """The inertia road without its meshes, which take many seconds."""
    monkeypatch.setattr("cqdd_design.roads.inertia.weigh", lambda machine, source: weigh(machine))
    return weighed(design)


@pytest.mark.parametrize("design", [PAPER, WIDE], ids=["drawn", "not drawn"])
def test_mass_and_torque_density_are_the_same_everywhere(
    design: Design, monkeypatch: pytest.MonkeyPatch
) -> None:
    machine = resolve(design)
    found = by_inertia(design, monkeypatch)
    told = found.to_dict()
    parameters = actuator_parameters(machine)
    bench = run_bench(parameters, only=CHEAP, gearbox=carried_torque(machine))
    metrics = {metric.name: metric for metric in bench.metrics}
    assert told["total_mass_kg"] == parameters.mass == metrics["mass"].value
    assert told["torque_density_Nm_per_kg"] == pytest.approx(
        metrics["torque_density"].value, rel=1e-12
    )
    # Each says what it counts, in the same words.
    scope = told["total_mass_scope"]
    assert all(scope in words for words in (told["torque_density_scope"], metrics["mass"].remark))
    assert scope in metrics["torque_density"].remark
    assert bodies_view(design, found.bodies)["total_of"] == scope
    table = comparison(parameters, bench)
    shown = dict(table["rows"])["torque density, N·m/kg"][table["own"]]
    assert float(shown) == pytest.approx(told["torque_density_Nm_per_kg"], rel=1e-3)


def test_a_motor_that_is_not_drawn_weighs_by_its_catalogue() -> None:
    machine = resolve(WIDE)
    inertia = machine.inertia
    drawn = sum(part.count * part.properties.mass for part in inertia.parts)
    assert machine.motor.mass == 0.525
    assert inertia.mass == pytest.approx(drawn + 0.525)
    assert inertia.total.mass == pytest.approx(drawn)
    assert sum(inertia.group_masses.values()) == pytest.approx(inertia.mass)
    assert sum(inertia.group_inertias.values()) == pytest.approx(inertia.reflected_input)
    assert "its bell included, 0.525 kg" in inertia.mass_scope
    assert "without cover and encoder" in inertia.mass_scope
    assert "its bell included" in inertia.inertia_scope
    parameters = actuator_parameters(machine)
    assert "without the motor's rotor and its bell" in parameters.origins["gear.input_inertia"]
    assert "its bell included" in parameters.origins["motor.rotor_inertia"]
    known = resolve(PAPER).inertia
    assert known.mass == known.total.mass
    assert "without" not in known.mass_scope + known.inertia_scope


def test_a_motor_of_unknown_mass_is_left_out_and_said() -> None:
    """What no catalogue weighs is not counted as nothing: the words say that it is missing."""
    row = dataclasses.replace(resolve(WIDE).motor, mass=None)
    inertia = resolve(WIDE, row).inertia
    assert inertia.mass == inertia.total.mass
    assert "without the motor" in inertia.mass_scope
    assert inertia.whole_mass is None
    assert inertia.to_dict()["total_mass_kg"] is None
    assert resolve(PAPER).inertia.whole_mass == resolve(PAPER).inertia.mass


def test_torque_density_counts_no_more_than_is_asked_and_no_more_than_there_is() -> None:
    machine = resolve(PAPER)
    parameters, gearbox = actuator_parameters(machine), carried_torque(machine)
    for required, counted in ((60.0, 60.0), (120.0, 87.68)):
        asked = dataclasses.replace(gearbox, required=required)
        (density,) = run_bench(parameters, only=["torque_density"], gearbox=asked).metrics
        assert density.value == pytest.approx(counted / parameters.mass, rel=1e-3)
        assert f"{counted:g} N*m" in density.remark


# ------------------------------------------------------------------ what a gearbox carries


def test_at_its_limits_the_equilibrium_reaches_what_the_parts_stand() -> None:
    """Ring pressure and cam load, from sweeps of our own at the torques that are told."""
    machine = resolve(PAPER)
    limits = {one.check: one for one in carried_torque(machine).limits}
    assert {one.model for one in limits.values()} <= {EQUILIBRIUM, RIGID}
    angles = perfect_angles(machine.contact, 360)

    def most(torque: float, key: str) -> float:
        friction = ContactFriction.of(machine.contact, "drive")
        both = (
            contact_sweep(machine.contact, s * torque, angles, friction=friction)
            for s in (1.0, -1.0)
        )
        return max(sweep.maxima[key] for sweep in both)

    steel = contact_limit_static(find_material(PAPER.reducer.disc_material)).value / 1e6
    ring = most(limits["CONTACT-RING-PEAK"].torque, "ring_pressure_max_MPa")
    assert ring == pytest.approx(steel, rel=3e-3)
    rating = find_bearing(PAPER.reducer.cam_bearing.designation).static_rating
    cam = most(limits["BEARING-STATIC"].torque, "cam_bearing_load_max_N")
    assert cam == pytest.approx(rating, rel=3e-3)
    screw = find_material(PAPER.reducer.output_pins.material).yield_strength
    bent = most(limits["PIN-BENDING-PEAK"].torque, "output_pin_bending_max_MPa")
    assert 1e6 * bent == pytest.approx(screw / 1.2, rel=3e-3)
    torques = [one.torque for one in carried_torque(machine).limits]
    assert torques == sorted(torques)


def test_the_bench_says_what_the_gearbox_does_not_carry() -> None:
    machine = resolve(WIDE)
    gearbox = carried_torque(machine)
    parameters = actuator_parameters(machine)
    (peak,) = run_bench(parameters, only=["peak_torque"], gearbox=gearbox).metrics
    cam = next(one for one in gearbox.limits if one.check == "BEARING-STATIC")
    assert cam.torque < peak.value
    assert peak.details["gearbox_limited_Nm"] == gearbox.limits[0].torque
    assert peak.value == min(peak.details["driver_limited_Nm"], peak.details["motor_limited_Nm"])
    assert f"static rating of the cam bearing from {cam.torque:.3g} N*m" in peak.remark
    assert "contact equilibrium" in peak.remark
    assert "the gearbox carries it" in gearbox.told(0.5 * gearbox.limits[0].torque)
    (alone,) = run_bench(parameters, only=["peak_torque"]).metrics
    assert alone.remark == ""


def test_where_the_equilibrium_has_no_answer_the_rigid_law_says_so(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def none(*_: object, **__: object) -> None:
        raise ContactError("no contact equilibrium was found.")

    monkeypatch.setattr("cqdd_design.machine.capacity.contact_sweep", none)
    machine = resolve(PAPER)
    limits = carried_torque(machine).limits
    assert {one.model for one in limits} == {RIGID}
    checks = {check.id: check for check in machine.analysis.checks}
    by_check = {one.check: one.torque for one in limits}
    # Forces grow with the torque, pressures with its root.
    margin = checks["BEARING-STATIC"].margin
    assert by_check["BEARING-STATIC"] == pytest.approx(120.0 * margin)
    margin = checks["CONTACT-RING-PEAK"].margin
    assert by_check["CONTACT-RING-PEAK"] == pytest.approx(120.0 * margin**2)


def test_what_outlasts_the_equilibrium_is_not_said_to_give_way() -> None:
    """Strong pins of a single disc: the teeth lose their reach long before."""
    single = {
        "reducer.disc_count": 1,
        "reducer.output_pins.material": "Alloy steel 12.9 (ISO 7379)",
        "reducer.modification.equidistant": 60e-6,
    }
    limits = carried_torque(resolve(PAPER.replacing(single))).limits
    (end,) = (one for one in limits if not one.reached)
    assert end == limits[-1]
    assert "PIN-BEARING-PEAK" not in {one.check for one in limits if one.reached}
    assert "farther than they reach" in end.words


def test_a_bearing_without_rating_is_no_reserve() -> None:
    """An unknown strength is said, never taken for enough."""
    wide = {
        "reducer.ring_pitch_radius": 0.055,
        "reducer.ring.outer_diameter": 0.12,
        "reducer.disc_thickness": 0.009,
        "reducer.output_pins.circle_radius": 0.039,
        "reducer.cam_bearing.designation": "6710",
    }
    gearbox = carried_torque(resolve(PAPER.replacing(wide)))
    assert gearbox.unknown == ("BEARING-STATIC",)
    assert "static rating of the cam bearing: no strength is known" in gearbox.told(1e-3)


# ------------------------------------------------------------------ closed forms and meshes


@pytest.mark.deep
def test_the_actuators_inertias_are_those_of_the_meshes() -> None:
    """The simulation takes closed forms: within 6e-5 of what `inertia` measures from meshes."""
    machine = resolve(PAPER)
    parameters = actuator_parameters(machine)
    meshed = gearbox_inertia(machine.design, machine.motor, machine.parts, mass_properties)
    n = abs(parameters.gear.ratio)
    whole = parameters.motor_side_inertia + parameters.gear.output_inertia / n**2
    assert meshed.reflected_input == pytest.approx(whole, rel=6e-5)
    assert meshed.mass == pytest.approx(parameters.mass, rel=6e-5)
    for ours, mesh in zip(machine.inertia.parts, meshed.parts, strict=True):
        assert mesh.reflected == pytest.approx(ours.reflected, rel=1e-4, abs=1e-15), ours.name


def test_a_drawn_gearbox_that_cannot_be_simulated_is_left_out_and_told(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The others are measured; where there are none, perfect parts are."""
    machine = resolve(PAPER)
    usual = actuator_parameters(machine)

    def built(machine: Machine, specimen: Specimen) -> ActuatorParameters:
        assert specimen.seed is not None
        if specimen.seed in failing:
            raise DesignError("its stiffness falls to zero.")
        return usual

    monkeypatch.setattr("cqdd_design.roads.bench.actuator_parameters", built)
    failing = {1, 4}
    drawn, told = drawn_actuators(machine, AS_DRAWN)
    assert len(drawn) == RIPPLE_DRAWS - 2
    assert "2 of 6 gearboxes" in told[0]
    assert "those of the others: its stiffness falls to zero." in told[0]
    failing = set(range(RIPPLE_DRAWS))
    assert drawn_actuators(machine, AS_DRAWN)[0] == []
    assert "those of perfect parts" in drawn_actuators(machine, AS_DRAWN)[1][0]
    failing = set()
    assert drawn_actuators(machine, AS_DRAWN)[1] == ()
