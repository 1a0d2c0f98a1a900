"""The comparison with a planetary: the cycloid's limits are those of its checks."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

from cqdd_design.design import load_design
from cqdd_design.errors import UsageError
from cqdd_design.gearbox.checks.equilibrium import lasting_checks
from cqdd_design.machine import resolve
from cqdd_design.machine.capacity import LoadedContacts
from cqdd_design.machine.carrying import EQUILIBRIUM, RIGID, torque_limits
from cqdd_design.machine.contact_analysis import analyse_contact
from cqdd_design.planetary.cycloid import binding_limit
from cqdd_design.report.judgement.planetary import limit_rows
from cqdd_design.sizing.comparison import (
    DEFAULT_STEEL,
    compare_with_planetary,
    cycloid_limits,
    papers_machine,
)

PAPER = load_design(Path(__file__).parents[2] / "designs" / "cqdd-10.toml")


@pytest.fixture(scope="module")
def papers():
    """The paper's machine, whose limits and comparison are found once."""
    return resolve(PAPER)


@pytest.fixture(scope="module")
def limits(papers):
    return cycloid_limits(papers)


@pytest.fixture(scope="module")
def compared(papers):
    return compare_with_planetary(papers)


def test_a_limit_that_contact_ends_before_is_not_told_as_reached():
    """Of the printed gearbox the parts move out of reach before anything gives way."""
    printed = load_design(Path(__file__).parents[2] / "designs" / "printed-13.toml")
    found = cycloid_limits(resolve(printed))
    assert not any(one.reached for one in found)
    rows = limit_rows(found)
    assert all("where contact ends: not reached" in told for *_, (told, _) in rows)
    one = found[0]
    assert one.to_dict()["reached"] is False
    beside = replace(one, part="pins", reached=True)
    assert binding_limit([one, beside], one.load).part == "pins"


@pytest.mark.deep
def test_at_its_capacity_a_limit_is_just_met(papers):
    """Every capacity, found from one torque, is where the equilibrium itself meets the limit."""
    contacts = LoadedContacts(papers.contact)
    solved = [one for one in torque_limits(papers, "peak") if one.model == EQUILIBRIUM]
    assert len(solved) > 5
    for limit in solved:
        asked, found = (
            contacts.greatest(torque)[limit.row.key] for torque in (limit.asked, limit.torque)
        )
        assert math.isclose(limit.value * found / asked, limit.limit, rel_tol=2e-3), limit


def test_values_are_those_of_analyse(papers, limits):
    """Pressures and forces at the torques asked for are what the contact sweep prints."""
    found = {(one.part, one.title): one for one in limits}
    contact = analyse_contact(papers).to_dict()["contact"]
    ring = found["ring teeth", "Hertz pressure at the ring, peak torque"]
    assert ring.value == pytest.approx(contact["ring_pressure_max_MPa"], rel=1e-9)
    holes = found["output pins", "Hertz pressure of pins in holes, peak torque"]
    assert holes.value == pytest.approx(contact["output_pressure_max_MPa"], rel=1e-9)
    cam = found["cam bearing", "load for C0/P = 1"]
    assert cam.value == pytest.approx(contact["cam_bearing_load_max_N"], rel=1e-9)
    bending = found["output pins", "Bending stress of the output pins, peak torque"]
    assert bending.value == pytest.approx(contact["output_pin_bending_max_MPa"], rel=1e-9)
    # Shear goes with the force: the rigid law's, less what it adds for sharing.
    shear = found["output pins", "Shear stress of the output pins, peak torque"]
    rigid = papers.analysis
    per_newton = rigid.output_pins.shear_stress_peak / rigid.rigid_peak.output_pin_force / 1e6
    expected = per_newton * contact["output_pin_force_max_N"]
    assert shear.value == pytest.approx(expected, rel=1e-9)
    assert {one.model for one in limits if one.load == "peak"} == {EQUILIBRIUM}


@pytest.mark.parametrize("changes", [{}, {"requirements.duty": [
    {"torque": 60.0, "speed": 10.0, "share": 0.5}, {"torque": -20.0, "speed": 20.0, "share": 0.5},
]}], ids=["continuous torque", "duty"])  # fmt: skip
def test_over_the_duty_a_limit_is_that_of_its_check_and_held_up_to_its_torque(papers, changes):
    """The knee of a fatigue limit is what lasts for ever, which nothing asks for."""
    machine = resolve(PAPER.replacing(changes)) if changes else papers
    checks = {one.id: one for one in lasting_checks(machine.analysis, machine.life)}
    found = torque_limits(machine, "continuous")
    assert len(found) == 4
    for limit in found:
        check = checks[limit.check]
        if limit.check != "BEARING-LIFE":
            assert (limit.value, limit.limit) == check.compared
        assert (limit.torque >= limit.asked) == (check.status == "pass")
        for more, status in ((0.999, "pass"), (1.02, "fail")):
            lived = machine.under(duty_share=more * limit.torque / limit.asked).life
            at = {one.id: one for one in lasting_checks(machine.analysis, lived)}
            assert at[limit.check].status == status, limit.check


@pytest.mark.deep
def test_a_torque_without_equilibrium_has_the_value_of_its_check_and_a_capacity_below(limits):
    """20 kN m bends everything out of reach; what the ring carries is found from less."""
    machine = resolve(PAPER.replacing({"requirements.peak_torque": 20000.0}))
    (ring,) = [one for one in cycloid_limits(machine) if "ring, peak" in one.title]
    (check,) = [one for one in machine.analysis.checks if one.id == "CONTACT-RING-PEAK"]
    assert ring.value == check.value
    assert ring.model == f"{RIGID}; torque by the {EQUILIBRIUM}"
    usual = {one.title: one for one in limits}[ring.title]
    assert ring.torque_capacity == pytest.approx(usual.torque_capacity, rel=5e-3)


def test_every_strength_check_of_ring_pins_and_bearing_takes_part(limits):
    assert {limit.part for limit in limits} == {"ring teeth", "output pins", "cam bearing"}
    assert len(limits) == 10


def test_the_papers_machine_is_the_design_that_is_shipped():
    assert papers_machine().given.to_mapping() == PAPER.to_mapping()


def test_the_papers_claims_are_judged_on_the_papers_cycloid(compared):
    """Another design beside the same planetary: its own limits move, the claims do not."""
    other = PAPER.replacing(
        {"reducer.output_pins.material": "Alloy steel 12.9 (ISO 7379)",
         "reducer.output_pins.count": 10, "requirements.peak_torque": 60.0}
    )  # fmt: skip
    theirs, ours = compare_with_planetary(resolve(other)), compared
    assert theirs.claims == ours.claims
    assert theirs.cycloid != ours.cycloid
    assert "pressure of pins in holes" in ours.claims[4].ours


def test_discs_of_bronze_are_compared_with_gears_of_steel():
    design = PAPER.replacing({"reducer.disc_material": "Bronze CuSn12"})
    found = compare_with_planetary(resolve(design))
    assert found.material.label.startswith(DEFAULT_STEEL)
    assert DEFAULT_STEEL in found.warnings[0]
    with pytest.raises(UsageError):
        compare_with_planetary(resolve(design), material="Bronze CuSn12")


def test_options_left_out_are_the_papers(papers, compared):
    found = compared.to_dict()["planetary"]
    assert found["ratio"] == pytest.approx(10.5455, abs=1e-4)
    assert found["centre_distance_mm"] == pytest.approx(24.0)
    assert found["planets_that_fit"] == 3
    other = compare_with_planetary(papers, module=2e-3, planets=2).to_dict()["planetary"]
    assert other["centre_distance_mm"] == pytest.approx(48.0)
    assert other["planets"] == 2
