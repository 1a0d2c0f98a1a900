"""A motor's rotor on the shaft's stub: its magnets' pull, and what shaft, balls and web give."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design, load_design
from cqdd_design.gearbox.contact.laws import cam_spring
from cqdd_design.gearbox.rotor_overhang import bearings_give, overhang_give, settled
from cqdd_design.gearbox.shaft_bending import ShaftSection
from cqdd_design.gearbox.shaft_strength import step_stress
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.rotor_overhang import rotor_overhang, stub_stress
from cqdd_design.machine.shaft import knife_edges
from cqdd_design.machine.shaft_strength import shaft_steps
from cqdd_design.sizing.shafts import weak_lines
from cqdd_design.solids.rotor_pull import (
    NO_HOLES,
    REMANENCE,
    WebHoles,
    WebLoad,
    pull_rate,
    stiff_holes,
    stiff_web,
    web_tilting_rate,
)
from cqdd_design.verdict.rotor_lines import rotor_lines

REPOSITORY = Path(__file__).resolve().parents[2]
MU_0 = 4e-7 * math.pi
BENDING = 12.0
SLENDER = [ShaftSection(-0.1, 0.2, BENDING, math.inf)]


@pytest.fixture(scope="module")
def paper(paper_design_file) -> Design:
    return load_design(paper_design_file)


@pytest.fixture(scope="module")
def machine(paper: Design) -> Machine:
    return resolve(paper)


def pull_by_integral(
    diameter: float, length: float, gap: float, height: float, off: float
) -> float:
    """Maxwell's stress round a gap that is narrower on one side, added up; N."""
    angle = 2.0 * math.pi * (np.arange(720) + 0.5) / 720.0
    field = REMANENCE * height / (height + gap - off * np.cos(angle))
    stress = field**2 / (2.0 * MU_0)
    return float(np.mean(stress * np.cos(angle)) * math.pi * diameter * length)


@pytest.mark.parametrize("height", [0.3e-3, 1.0e-3, 2.0e-3, 4.0e-3])
def test_no_magnets_pull_more_than_is_said(height: float) -> None:
    gap, off = 0.5e-3, 1e-6
    said = pull_rate(0.1, 0.02, gap) * off
    found = pull_by_integral(0.1, 0.02, gap, height, off)
    assert found <= said * (1.0 + 1e-5)
    if height == 2.0 * gap:
        assert found == pytest.approx(said, rel=1e-5)
    else:
        assert found < 0.99 * said


def test_a_tilted_web_stores_the_work_of_its_moment() -> None:
    """Energy of the bent plate by its curvatures, against M theta/2 with theta = 1."""
    inner, outer, thick, modulus, nu = 9e-3, 50e-3, 2e-3, 71e9, 0.33
    rows = []
    for r in (inner, outer):
        rows.append([r, 1.0 / r, r**3, r * math.log(r)])
        rows.append([1.0, -1.0 / r**2, 3.0 * r**2, math.log(r) + 1.0])
    a, b, c, d = np.linalg.solve(rows, [inner, 1.0, 0.0, 0.0])
    r = np.linspace(inner, outer, 20001)
    f = a * r + b / r + c * r**3 + d * r * np.log(r)
    slope = a - b / r**2 + 3.0 * c * r**2 + d * (np.log(r) + 1.0)
    second = 2.0 * b / r**3 + 6.0 * c * r + d / r
    across = twist = slope / r - f / r**2
    plate = modulus * thick**3 / (12.0 * (1.0 - nu**2))
    # w = f cos t: the mean of cos^2 and of sin^2 round the plate is a half.
    bent = second**2 + across**2 + 2.0 * nu * second * across + 2.0 * (1.0 - nu) * twist**2
    energy = 0.5 * plate * math.pi * np.trapezoid(bent * r, r)
    assert 0.5 * web_tilting_rate(inner, outer, thick, modulus, nu) == pytest.approx(
        energy, rel=1e-6
    )


@pytest.mark.parametrize("at", [-0.04, -0.01, 0.03])
def test_a_shaft_gives_as_beams_do(at: float) -> None:
    """The overhang up to the hub, and the span under the moment of the arm, wherever it points."""
    edges, hub = (0.0, 0.1), -0.01
    arm, (low, high) = edges[0] - at, edges
    span = arm**2 * (high - low) / (3.0 * BENDING)
    stub = ((low - at) ** 3 - (hub - at) ** 3) / (3.0 * BENDING)
    assert overhang_give(SLENDER, edges, hub, at) == pytest.approx(span + stub, rel=1e-12)


@pytest.mark.parametrize("arm", [-0.02, 0.0, 0.03])
def test_bearings_give_what_their_energy_says(arm: float) -> None:
    """Castigliano's second theorem, on the forces that levers say the bearings bear."""
    stiffness, exponent, span, force = 3e8, 1.5, 0.05, 40.0

    def energy(at: float) -> float:
        bears = at * (arm + span) / span, at * arm / span
        power = 1.0 / exponent + 1.0
        return sum(abs(one) ** power / (power * stiffness ** (1.0 / exponent)) for one in bears)

    step = 1e-3
    slope = (energy(force + step) - energy(force - step)) / (2.0 * step)
    found = bearings_give(force, stiffness, exponent, arm, span)
    assert found == pytest.approx(slope, rel=1e-6)
    assert bearings_give(-force, stiffness, exponent, arm, span) == pytest.approx(-found)


def test_what_is_not_stiff_enough_is_pulled_over() -> None:
    for stiffness, expected in ((3e6, 50e-6 / 2.0), (1.01e6, math.inf), (0.5e6, math.inf)):
        found = settled(1e6, 50e-6, 0.0, lambda force, k=stiffness: force / k, 0.5e-3)
        assert found.deflection == pytest.approx(expected, rel=1e-6)
    light = settled(1e6, 50e-6, 0.0, lambda force: force / 3e6, 0.5e-3)
    heavy = settled(1e6, 50e-6, 10.0, lambda force: force / 3e6, 0.5e-3)
    assert heavy.deflection - light.deflection == pytest.approx(10.0 / 2e6, rel=1e-6)


def test_the_rotor_of_the_paper_is_held(machine: Machine) -> None:
    """By hand: 1.29 N/um of pull, 2.2 N of weight, 0.2 of unbalance, on web and balls."""
    found = rotor_overhang(machine)
    motor = machine.layout.motor
    assert motor is not None
    assert found.gap == pytest.approx(0.5e-3)
    rate = pull_rate(0.1, 20e-3, 0.5e-3)
    speed = machine.design.requirements.input_speed
    forces = found.mass * (9.81 + speed**2 * found.off_centre)
    assert found.settled.force == pytest.approx(
        rate * (found.off_centre + found.settled.deflection) + forces, rel=1e-6
    )
    metal = find_material("7075-T6")
    web = web_tilting_rate(
        motor.hub_radius, motor.rotor_inner, motor.web_top - motor.web_bottom,
        metal.youngs_modulus, metal.poisson_ratio, motor.lightening,
    )  # fmt: skip
    lever = 0.5 * (motor.ring_top + motor.ring_bottom - motor.web_top - motor.web_bottom)
    spring = cam_spring(machine.layout.shaft.support.bearing, 0.0)
    # The magnets stand round the lower bearing, which alone gives.
    assert found.arm == pytest.approx(0.0, abs=1e-9)
    gives = found.settled.force * lever**2 / web
    gives += (found.settled.force / spring.stiffness) ** (1.0 / spring.exponent)
    assert found.settled.deflection == pytest.approx(gives, rel=0.02)
    gap, stub = rotor_lines(machine)
    assert (gap.status, stub.status) == ("pass", "pass")
    assert gap.value == pytest.approx(100.0 * (0.1 + found.settled.deflection / 0.5e-3))
    assert gap.value == pytest.approx(29.1, abs=0.1)


def test_the_stub_bears_the_rotor_on_top_of_the_duty(machine: Machine) -> None:
    found, duty = rotor_overhang(machine), machine.life.pack
    told = stub_stress(machine, duty, found)
    modulus = math.pi / 32.0 * (told.diameter**4 - 5e-3**4) / told.diameter
    notch = told.rotor * modulus / (found.settled.force * found.moment_arm)
    assert 1.0 < notch < 3.0
    step = shaft_steps(machine.layout.pack, machine.layout.shaft)[0]
    strength = told.material.ultimate_strength
    assert strength is not None
    to_and_fro = step_stress(step, np.array([5.0, -5.0]), np.zeros(2), strength)
    assert notch == pytest.approx(to_and_fro.bending_factor)
    (_, stub) = rotor_lines(machine)
    assert stub.value == pytest.approx((told.lasting + told.rotor) / 1e6)


def test_a_bell_far_out_on_a_thin_stub_fails(paper: Design) -> None:
    """A 45 mm gearbox before a motor of 108 mm: its stub of 4 mm does not hold the magnets."""
    changes = {
        "reducer": {
            "ratio": 9, "ring_pitch_radius": "17.25 mm", "eccentricity": "0.6 mm",
            "ring_pin_diameter": "2.7 mm", "disc_thickness": "3.5 mm", "disc_count": 1,
            "output_pins": {"count": 9, "diameter": "4 mm", "circle_radius": "11.6 mm"},
            "cam_bearing": {"designation": "SKF 618/6"}, "ring": {"outer_diameter": "39.4 mm"},
            "carrier": {"joint": "clamped"},
        },
        "requirements": {"ratio": 9, "peak_torque": "2 N*m", "continuous_torque": "0.5 N*m"},
        "motor": {"name": "CubeMars RO100 KV55"},
    }  # fmt: skip
    thin = resolve(Design.model_validate({"schema_version": 1, "name": "thin", **changes}))
    assert thin.layout.shaft.support.bearing.bore_diameter == pytest.approx(4e-3)
    gap, stub = rotor_lines(thin)
    assert (gap.status, stub.status) == ("fail", "unknown")
    assert "grows faster than what carries it" in gap.substituted
    assert "cam bearing with a larger bore" in gap.remedy
    # A search for a design takes it for weak, but not for what it does not know.
    assert "SHAFT-ROTOR-GAP" in {one.id for one in weak_lines(thin)}
    assert "SHAFT-STUB" not in {one.id for one in weak_lines(thin)}


def test_an_inrunner_on_its_long_stub_is_judged_too(paper: Design) -> None:
    machine = resolve(paper.replacing({"motor": {"name": "CubeMars RI100 KV105"}}))
    found = rotor_overhang(machine)
    low, _ = knife_edges(machine.layout.shaft)
    inrunner = machine.layout.inrunner
    assert inrunner is not None
    assert found.arm == pytest.approx(low - 0.5 * (inrunner.ring_bottom + inrunner.ring_top))
    assert found.arm > 15e-3
    gap, _ = rotor_lines(machine)
    assert gap.status == "pass"


def test_without_a_rotor_nothing_is_known(paper: Design) -> None:
    machine = resolve(paper.replacing({"motor": {"name": "CubeMars R100 KV90"}}))
    assert [one.status for one in rotor_lines(machine)] == ["unknown", "unknown"]


def test_a_thin_web_is_made_thicker() -> None:
    load = WebLoad(9e-3, 50e-3, 5e-3, pull_rate(0.1, 20e-3, 0.5e-3), find_material("7075-T6"))
    assert stiff_web(load, 2e-3) == 2e-3
    far = load._replace(arm=14e-3)
    thick = stiff_web(far, 1e-3)
    assert thick > 1.5e-3
    assert far.share(thick) <= 0.6 < far.share(thick - 0.011e-3)
    wrist = resolve(load_design(REPOSITORY / "docs/gallery/wrist-15.toml"))
    motor = wrist.layout.motor
    assert motor is not None
    assert motor.web_top - motor.web_bottom > 2.0 * wrist.layout.unit + 0.2e-3
    assert rotor_lines(wrist)[0].status == "pass"


def test_holes_weaken_a_web_by_what_they_leave() -> None:
    """Most where a line from the axis touches them: they fill N asin(r/R)/pi of that circle."""
    shape = (9e-3, 50e-3, 2e-3, 71e9, 0.33)
    whole = web_tilting_rate(*shape)
    share = [
        web_tilting_rate(*shape, WebHoles(6, 29e-3, one)) / whole for one in (1e-6, 5e-3, 1e-2)
    ]
    assert share[0] == pytest.approx(1.0, abs=1e-6)
    assert 1.0 > share[1] > share[2] > 0.3
    solid = WebHoles(6, 29e-3, 1e-2).solid(np.linspace(10e-3, 48e-3, 3801))
    assert solid.min() == pytest.approx(1.0 - 6.0 * math.asin(10.0 / 29.0) / math.pi, abs=1e-4)
    assert solid[0] == solid[-1] == 1.0
    # A plate that is weakened alike everywhere is weakened by just that.
    fill = web_tilting_rate(*shape, Slotted(1, 1.0, 0.0))
    assert fill == pytest.approx(0.25 * whole)


class Slotted(WebHoles):
    """Slots from hub to rim that leave a quarter."""

    def solid(self, at):
        return np.full_like(at, 0.25)


def test_lightening_holes_leave_what_the_pull_asks_for(machine: Machine) -> None:
    motor = machine.layout.motor
    assert motor is not None
    load = WebLoad(
        motor.hub_radius, motor.rotor_inner, 0.5 * (motor.ring_top + motor.ring_bottom)
        - motor.web_top, pull_rate(0.1, 20e-3, 0.5e-3), find_material("7075-T6"),
    )  # fmt: skip
    thick, holes, unit = motor.web_top - motor.web_bottom, motor.lightening, machine.layout.unit
    assert load.share(thick, holes) <= 0.6
    assert load.share(thick, holes._replace(radius=holes.radius + 0.3 * unit)) > 0.6
    (bell,) = (part for part in machine.parts if part.name == "rotor bell")
    (drawn,) = (one for one in bell.features if getattr(one, "name", "") == "lightening holes")
    assert drawn.diameter == pytest.approx(2.0 * holes.radius)
    hopeless = load._replace(rate=100.0 * load.rate)
    assert stiff_holes(hopeless, thick, holes, unit) == NO_HOLES
