"""What the shaft bends and the carrier tilts, which the plane contact problem leaves out."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.catalog.bearings import shaft_material
from cqdd_design.catalog.materials import find_material
from cqdd_design.design import load_design
from cqdd_design.errors import GeometryError
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.rubbing import ContactFriction
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.gearbox.output_pins import disc_positions
from cqdd_design.gearbox.shaft_bending import ShaftSection, edge_load_factor, shaft_beam
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.contact_analysis import analyse_contact
from cqdd_design.machine.shaft import (
    ShaftBending,
    core_sections,
    disc_heights,
    drawn_sections,
    knife_edges,
    shaft_bending,
)

REPOSITORY = Path(__file__).resolve().parents[2]
SLENDER = ShaftSection(-0.03, 0.13, 12.0, math.inf)
SPAN = 0.1


@pytest.fixture(scope="module", params=["cqdd-10", "reference-s"])
def machine(request: pytest.FixtureRequest) -> Machine:
    return machine_of(request.param)


def machine_of(name: str, **changes: object) -> Machine:
    design = load_design(REPOSITORY / "designs" / f"{name}.toml")
    return resolve(design.replacing({key.replace("__", "."): v for key, v in changes.items()}))


def sweeps(machine: Machine, angles: int = 24) -> list[ContactSweep]:
    """At the peak torque in both senses."""
    return sweeps_of(machine.contact, machine, angles)


def sweeps_of(model: ContactModel, machine: Machine, angles: int = 24) -> list[ContactSweep]:
    peak = machine.design.requirements.peak_torque
    rubbed = ContactFriction.of(model, "drive")
    at = perfect_angles(model, angles)
    return [contact_sweep(model, torque, at, friction=rubbed) for torque in (peak, -peak)]


def bound(machine: Machine, angles: int = 24) -> ShaftBending:
    return shaft_bending(machine, sweeps(machine, angles))


def solved_by_elements(
    sections: list[ShaftSection], edges: tuple[float, float], at: np.ndarray, force: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Deflections and turns at forces from stiffnesses of beam elements with shear."""
    ends = np.unique([*edges, *at, *(end for s in sections for end in (s.bottom, s.top))])
    ends = ends[(ends >= edges[0]) & (ends <= edges[1])]
    stiff = np.zeros((2 * len(ends), 2 * len(ends)))
    for k, (low, high) in enumerate(itertools.pairwise(ends)):
        one = next(s for s in sections if s.bottom <= 0.5 * (low + high) <= s.top)
        length = high - low
        phi = 12.0 * one.bending / (one.shear * length**2)
        own = np.array(
            [
                [12.0, 6.0 * length, -12.0, 6.0 * length],
                [6.0 * length, (4.0 + phi) * length**2, -6.0 * length, (2.0 - phi) * length**2],
                [-12.0, -6.0 * length, 12.0, -6.0 * length],
                [6.0 * length, (2.0 - phi) * length**2, -6.0 * length, (4.0 + phi) * length**2],
            ]
        )
        part = slice(2 * k, 2 * k + 4)
        stiff[part, part] += one.bending / ((1.0 + phi) * length**3) * own
    load = np.zeros(2 * len(ends))
    nodes = np.searchsorted(ends, at)
    load[2 * nodes] = force
    free = np.setdiff1d(np.arange(2 * len(ends)), [0, 2 * len(ends) - 2])
    moved = np.zeros_like(load)
    moved[free] = np.linalg.solve(stiff[np.ix_(free, free)], load[free])
    return moved[2 * nodes], moved[2 * nodes + 1]


def test_one_force_on_an_even_shaft() -> None:
    """Closed forms of a slender beam under a force at a: w = F a^2 b^2/(3 E I L), and its slope."""
    at = np.array([0.03])
    beam = shaft_beam([SLENDER], (0.0, SPAN), at)
    a, b = 0.03, 0.07
    assert beam.deflection[0, 0] == pytest.approx((a * b) ** 2 / (3.0 * 12.0 * SPAN), rel=1e-12)
    assert beam.rotation[0, 0] == pytest.approx(a * b * (b - a) / (3.0 * 12.0 * SPAN), rel=1e-12)
    assert beam.on_upper == pytest.approx([a / SPAN], rel=1e-15)


def test_two_opposite_forces_on_an_even_shaft() -> None:
    """About the middle nothing moves; each half is a beam of L/2 with its own force."""
    at = np.array([0.03, 0.07])
    beam = shaft_beam([SLENDER], (0.0, SPAN), at)
    force = np.array([1.0, -1.0])
    a, b, half = 0.03, 0.02, 0.05
    sunk = (a * b) ** 2 / (3.0 * 12.0 * half)
    turned = a * b * (b - a) / (3.0 * 12.0 * half)
    assert beam.deflection @ force == pytest.approx([sunk, -sunk], rel=1e-12)
    assert beam.rotation @ force == pytest.approx([turned, turned], rel=1e-12)


def test_shear_of_an_even_shaft() -> None:
    """A beam that only shears is two straight lines; its sections do not turn."""
    stiff = ShaftSection(-1.0, 1.0, math.inf, 5.0)
    beam = shaft_beam([stiff], (0.0, SPAN), np.array([0.02, 0.06]))
    assert beam.deflection == pytest.approx(
        np.array([[0.02 * 0.08, 0.02 * 0.04], [0.02 * 0.04, 0.06 * 0.04]]) / (5.0 * SPAN), rel=1e-12
    )
    assert np.abs(beam.rotation).max() < 1e-15


def test_a_stepped_shaft_is_that_of_beam_elements() -> None:
    rng = np.random.default_rng(5)
    for discs in (1, 2, 3):
        levels = np.sort(rng.uniform(-0.01, 0.04, 7))
        levels[[0, -1]] = -0.012, 0.045
        sections = [
            ShaftSection(low, high, float(rng.uniform(20.0, 400.0)), float(rng.uniform(2e5, 4e6)))
            for low, high in itertools.pairwise(levels)
        ]
        at = np.sort(rng.uniform(0.002, 0.03, discs))
        beam = shaft_beam(sections, (-0.005, 0.035), at)
        force = rng.normal(0.0, 2e3, discs)
        sunk, turned = solved_by_elements(sections, (-0.005, 0.035), at, force)
        assert beam.deflection @ force == pytest.approx(sunk, rel=1e-9)
        assert beam.rotation @ force == pytest.approx(turned, rel=1e-8)
        assert beam.deflection == pytest.approx(beam.deflection.T, rel=1e-13)


def test_the_shaft_of_a_machine_is_that_of_beam_elements(machine: Machine) -> None:
    layout = machine.layout
    steel = find_material(shaft_material(machine.cam))
    edges, at = knife_edges(layout.shaft), disc_heights(layout.pack)
    drawn = drawn_sections(layout.pack, layout.shaft, steel)
    core = core_sections(layout.shaft, steel)
    found = bound(machine)
    pushed = -np.concatenate([one.cam_force for one in sweeps(machine)])
    for sections, sunk, turned in (
        (drawn, found.deflection, found.slope),
        (core, found.core_deflection, found.core_slope),
    ):
        assert sections[0].bottom < edges[0] < edges[1] < sections[-1].top
        each = [
            [solved_by_elements(list(sections), edges, at, f[:, axis]) for axis in (0, 1)]
            for f in pushed
        ]
        most = np.hypot(*np.moveaxis(np.array(each), 1, 0)).max(axis=(0, 2))
        assert (sunk, turned) == pytest.approx(tuple(most), rel=1e-8)
    assert found.deflection < found.core_deflection


def test_sections_are_those_of_the_drawn_rounds(machine: Machine) -> None:
    """Second moments of bored rounds; a bore out of a lobe's middle takes away by Steiner too."""
    pack, shaft = machine.layout.pack, machine.layout.shaft
    steel = find_material(shaft_material(machine.cam))
    bore, lobe, e = shaft.bore_radius, 0.5 * machine.cam.bore_diameter, pack.eccentricity
    whole, hole = math.pi * lobe**2, math.pi * bore**2
    second = 0.25 * (whole * lobe**2 - hole * bore**2) - whole * hole / (whole - hole) * e**2
    middle = 0.5 * (pack.cam_bottom(0) + pack.cam_top(0))
    found = next(one for one in drawn_sections(pack, shaft, steel) if one.bottom < middle < one.top)
    assert found.bending == pytest.approx(steel.youngs_modulus * second, rel=1e-9)
    journal, core, _ = core_sections(shaft, steel)
    for one, radius in ((journal, 0.5 * shaft.support.bearing.bore_diameter), (core, 0.0)):
        wide = radius or shaft.shoulder_radius
        second = 0.25 * math.pi * (wide**4 - bore**4)
        assert one.bending == pytest.approx(steel.youngs_modulus * second, rel=1e-12)
    solid = core_sections(replace(shaft, bore_radius=0.0), steel)[1]
    nu = steel.poisson_ratio
    sheared = steel.youngs_modulus * math.pi * shaft.shoulder_radius**2 * 3.0 / (7.0 + 6.0 * nu)
    assert solid.shear == pytest.approx(sheared, rel=1e-12)


def test_statics_of_shaft_and_carrier(machine: Machine) -> None:
    """Supports hold the discs; the carrier's moment is that of ring and housing on all that turns.

    Of ring forces, which the bound does not read.
    """
    layout, found = machine.layout, bound(machine)
    at, (low, high) = disc_heights(layout.pack), knife_edges(layout.shaft)
    both = sweeps(machine)
    cam = np.concatenate([one.cam_force for one in both])
    ring = np.concatenate([one.ring_load.sum(axis=2) for one in both])
    lower = np.einsum("adx,d->ax", -cam, high - at) / (high - low)
    upper = -cam.sum(axis=1) - lower
    assert found.support_load == pytest.approx(
        [float(np.hypot(*one.T).max()) for one in (lower, upper)], rel=1e-12
    )
    output = layout.carrier.bearing_bottom + 0.5 * layout.carrier.output.bearing.width
    moment = np.einsum("adx,d->ax", ring, at - output) - lower * (low - output)
    assert found.carrier_moment == pytest.approx(float(np.hypot(*moment.T).max()), rel=1e-8)


def test_discs_stand_where_the_pins_of_the_equilibrium_have_them(machine: Machine) -> None:
    reducer, layout = machine.design.reducer, machine.layout
    from_plate = disc_positions(reducer.disc_count, reducer.disc_thickness, reducer.disc_spacing)
    assert layout.carrier.plate_bottom - disc_heights(layout.pack) == pytest.approx(
        from_plate, rel=1e-12
    )


def test_supports_that_yield_turn_a_straight_shaft() -> None:
    """Palmgren's 4.36e-4 (Q^2/D_w)^(1/3), Q = 4.37 F/Z, with the 8 balls of 3.6 mm of SKF 61900."""
    machine = machine_of("cqdd-10")
    found = bound(machine)
    at, (low, high) = disc_heights(machine.layout.pack), knife_edges(machine.layout.shaft)
    cam = np.concatenate([one.cam_force for one in sweeps(machine)])
    ends = []
    for arm in (high - at, at - low):
        load = np.einsum("adx,d->ax", -cam, arm) / (high - low)
        size = np.hypot(*load.T)[:, None]
        ends.append(load / size * 4.36e-7 * ((4.37 / 8.0 * size) ** 2 / 3.6) ** (1.0 / 3.0))
    turned = np.hypot(*(ends[1] - ends[0]).T).max() / (high - low)
    moved = [
        np.hypot(*(ends[0] * (high - z) + ends[1] * (z - low)).T).max() / (high - low) for z in at
    ]
    assert found.support_slope == pytest.approx(turned, rel=1e-9)
    assert found.support_deflection == pytest.approx(max(moved), rel=1e-9)
    closing = (found.core_slope + turned) * machine.design.reducer.disc_thickness
    assert found.edge_closing == pytest.approx(closing, rel=1e-9)


def test_a_shaft_in_bushes_has_no_known_slope_of_its_supports() -> None:
    machine = machine_of("cqdd-10")
    support = replace(machine.layout.shaft.support, source="bush")
    bushed = replace(machine.layout, shaft=replace(machine.layout.shaft, support=support))
    fresh = replace(machine)
    object.__setattr__(fresh, "layout", bushed)
    found = shaft_bending(fresh, sweeps(machine))
    told = found.to_dict()
    assert found.deflection == bound(machine).deflection
    for key in ("support_deflection_um", "support_slope_mrad", "edge_closing_um"):
        assert told[key] is None
    assert told["edge_load_factor"] is None
    assert found.warnings == ()


@pytest.mark.parametrize("share", [0.1, 1.0, 1.9999, 2.0001, 7.0, 400.0])
def test_an_edge_is_loaded_as_an_elastic_bed_is(share: float) -> None:
    """The bed of springs worked out: its level is where they bear the whole load."""
    along = (np.arange(40000) + 0.5) / 40000.0 - 0.5
    low, high = -share, share + 2.0
    for _ in range(80):
        level = 0.5 * (low + high)
        load = np.maximum(level + share * along, 0.0)
        low, high = (level, high) if load.mean() < 1.0 else (low, level)
    assert edge_load_factor(share, 1.0) == pytest.approx(level + 0.5 * share, rel=1e-3)


def test_a_line_that_one_end_leaves_is_a_warning_with_a_remedy() -> None:
    found = bound(machine_of("reference-s"))
    assert found.warnings == ()
    assert found.edge_closing is not None
    softer = replace(found, edge_closing=2.001 * found.ring_approach)
    assert len(softer.warnings) == 1
    assert "thicker shaft" in softer.warnings[0]
    assert softer.edge_load_factor == pytest.approx(2.0, rel=1e-3)


@pytest.mark.parametrize("discs", [1, 2, pytest.param(3, marks=pytest.mark.deep)])
def test_any_number_of_discs_is_bounded(discs: int) -> None:
    changes = {"reducer__disc_count": discs, "requirements__peak_torque": 45.0}
    found = bound(machine_of("cqdd-10", **changes), 8)
    assert 0.0 < found.deflection < found.core_deflection < 50e-6
    assert found.edge_closing is not None
    assert found.carrier_moment > 0.0


def test_a_machine_without_a_layout_has_no_bound_and_says_why(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def unable(_: Machine) -> object:
        raise GeometryError("nothing fits")

    monkeypatch.setattr(Machine, "layout", property(unable))
    found = analyse_contact(machine_of("cqdd-10"), angles=8)
    assert found.to_dict()["bending"] is None
    assert "no bound on bending and tilt: nothing fits" in found.warnings


ROWS = {
    "shaft as drawn: deflection at a disc, µm": "shaft_deflection_um",
    "shaft as drawn: slope there, mrad": "shaft_slope_mrad",
    "core alone: deflection, µm": "core_deflection_um",
    "core alone: slope, mrad": "core_slope_mrad",
    "load of its bearing at the output end, N": "support_load_N",
    "its two bearings: motion at a disc, µm": "support_deflection_um",
    "its two bearings: slope, mrad": "support_slope_mrad",
    "approach of a cam bearing, µm": "cam_approach_um",
    "edge closing, µm": "edge_closing_um",
    "approach of the busiest tooth, µm": "ring_approach_um",
    "load at that tooth's edge over its mean": "edge_load_factor",
    "moment that tilts the carrier, N·m": "carrier_tilting_moment_Nm",
}


def test_the_pages_have_these_figures() -> None:
    page, short = (
        re.sub(r"\s+", " ", (REPOSITORY / "docs" / name).read_text(encoding="utf-8"))
        for name in ("contact-model.md", "assumptions.md")
    )
    every = [bound(machine_of(name), 360).to_dict() for name in ("cqdd-10", "reference-s")]
    shown = {}
    for words, key in ROWS.items():
        values = [one[key] for one in every]
        last = [value[-1] if isinstance(value, list) else value for value in values]
        shown[key] = [f"{float(f'{value:.3g}'):g}" for value in last]
        assert f"| {words} | {' | '.join(shown[key])} |" in page
    edges = [math.sqrt(float(value)) for value in shown["edge_load_factor"]]
    assert f"at most {edges[0]:.2f} to {edges[1]:.2f} of the one told" in page
    closing, factor, moment = (
        shown[key] for key in ("edge_closing_um", "edge_load_factor", "carrier_tilting_moment_Nm")
    )
    assert f"by {closing[0]} µm more at one face" in short
    assert f"one of S by {closing[1]} µm" in short
    assert f"with {factor[0]} and {factor[1]} of its mean" in short
    assert f"moments of {moment[0]} and {moment[1]} N·m" in short


def test_a_shaft_that_yields_lowers_forces_and_stiffness(machine: Machine) -> None:
    """The page's figures of cam bearings that yield as much more as core and supports move."""
    found, model = bound(machine), machine.contact
    assert found.support_deflection is not None
    more = 1.0 + (found.core_deflection + found.support_deflection) / found.cam_approach
    cam = replace(model.cam, stiffness=model.cam.stiffness / more**model.cam.exponent)
    rigid, soft = sweeps(machine), sweeps_of(replace(model, cam=cam), machine)

    def ratio(value: Callable[[ContactSweep], float]) -> float:
        return max(map(value, soft)) / max(map(value, rigid))

    assert ratio(lambda one: one.ring_force.max()) <= 1.0
    fall = {"cqdd-10": 0.93, "reference-s": 0.95}[machine.design.name]
    assert ratio(lambda one: one.cam_load.max()) == pytest.approx(fall, abs=0.005)
    assert ratio(lambda one: one.stiffness.mean()) == pytest.approx(0.77, abs=0.006)
