"""A design made concrete once: one cam bearing, one motor, one choice of every other bearing."""

from __future__ import annotations

import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design.design import Design
from cqdd_design.design.motor import MotorFile
from cqdd_design.errors import DesignError, GeometryError
from cqdd_design.exporting.solids.bom import bill_of_materials
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.weighing import weigh
from cqdd_design.solids.inertia import ROTOR_PARTS

BASE = {
    "ratio": 12,
    "ring_pitch_radius": "32 mm",
    "eccentricity": "1.2 mm",
    "ring_pin_diameter": "5 mm",
    "disc_count": 3,
    "output_pins": {"circle_radius": "18 mm"},
}


def design(motor: str | None = None, **reducer: object) -> Design:
    """A design of ratio 12 with three discs, changed."""
    given = {"reducer": {**BASE, **reducer}}
    return Design.from_mapping(given | ({} if motor is None else {"motor": {"name": motor}}))


def bought(machine: Machine, part: str) -> str:
    rows = bill_of_materials(machine, machine.parts)
    return next(row.designation for row in rows if row.part == part)


def test_losses_and_bill_name_the_same_bearings() -> None:
    """Once 619/6 in the losses and 619/5 in the bill: a loose cam leaves a thinner core."""
    machine = resolve(design())
    assert machine.friction.support.name == bought(machine, "shaft bearing") == "SKF 619/5"
    assert machine.friction.output.name == bought(machine, "output bearing")


@settings(deadline=None, max_examples=examples(60))
@given(
    ratio=st.integers(6, 30),
    discs=st.integers(1, 3),
    share=st.floats(0.3, 0.75),
    tooth=st.floats(0.2, 0.5),
    pins=st.integers(4, 8),
    circle=st.floats(0.5, 0.75),
)
def test_whatever_the_design_there_is_one_choice(
    ratio: int, discs: int, share: float, tooth: float, pins: int, circle: float
) -> None:
    radius = 32.0
    changed = design(
        ratio=ratio,
        disc_count=discs,
        eccentricity=f"{share * radius / (ratio + 1)} mm",
        ring_pin_diameter=f"{tooth * 6.0 * radius / (ratio + 1)} mm",
        output_pins={"count": pins, "circle_radius": f"{circle * radius} mm"},
    )
    try:
        machine = resolve(changed)
        layout = machine.layout
    except DesignError:
        return
    assert machine.seats == (layout.shaft.support, layout.carrier.output)


def test_seats_are_told_where_nothing_can_be_laid_out() -> None:
    """Neighbouring cam bearings overlap: there are no parts, but the losses are asked for."""
    machine = resolve(design(disc_thickness="5 mm", cam_bearing={"designation": "6902"}))
    with pytest.raises(GeometryError, match="7 mm wide"):
        _ = machine.parts
    assert machine.friction.support.name
    assert machine.friction.output.name


def test_auto_names_a_bearing_and_keeps_what_was_given() -> None:
    machine = resolve(design())
    assert machine.given.reducer.cam_bearing.designation == "auto"
    assert machine.design.reducer.cam_bearing.designation == machine.cam.designation
    assert machine.given.sha256 != machine.design.sha256
    named = resolve(machine.design)
    assert named.design is machine.design
    assert named.cam is machine.cam


@pytest.mark.parametrize(
    "changes",
    [
        {"eccentricity": "4 mm"},
        {"ring_pin_diameter": "25 mm"},
        {"ring_pitch_radius": "15 mm"},
        {"output_pins": {"sleeve_diameter": "3 mm"}},
    ],
)
def test_auto_for_a_disc_that_cannot_exist_is_an_error_of_the_geometry(
    changes: dict[str, object],
) -> None:
    with pytest.raises(GeometryError):
        resolve(design(**changes))


def test_a_report_needs_one_disc(monkeypatch: pytest.MonkeyPatch) -> None:
    """However many rooms ask for the outline, it is checked once."""
    built: list[CycloidDisc] = []
    whole = CycloidDisc.__post_init__
    monkeypatch.setattr(CycloidDisc, "__post_init__", lambda one: built.append(one) or whole(one))
    machine = resolve(design(eccentricity="1.21 mm"))
    _ = machine.analysis, machine.parts, machine.contact, machine.friction
    assert built
    assert len(built) == len(set(built))


OWN = MotorFile.from_mapping(
    {
        "name": "rewound",
        "rotor_inertia": 2e-4,
        "mass": 0.9,
        "peak_torque": 3.0,
        "rated_torque": 1.0,
    },
    si=True,
)


def test_a_motor_of_a_file_is_the_machine_s() -> None:
    given_one = design(ring={"outer_diameter": "72 mm"})
    usual, own = resolve(given_one), resolve(given_one.with_motor(motor=OWN))
    assert own.motor.name == "rewound"
    assert own.given.motor.based_on == given_one.motor.name
    assert own.motor.outer_diameter == usual.motor.outer_diameter
    bodies = weigh(own)
    assert bodies.inertia.rotor_inertia == 2e-4
    own_parts = (*ROTOR_PARTS, "motor stator")
    motor = [part for part in bodies.inertia.parts if part.name in own_parts]
    assert sum(part.properties.mass for part in motor) == pytest.approx(0.9)
    # So light a rotor gives its bell half of its inertia at the most.
    assert bodies.inertia.rotor_drawn == pytest.approx(2e-4, rel=1e-6)


def test_a_motor_of_a_file_is_judged_as_one_that_was_asked_for() -> None:
    checks = {one.id: one for one in resolve(design().with_motor(motor=OWN)).analysis.checks}
    assert checks["MOTOR-PEAK"].value == pytest.approx(3.0 * 12 * 0.88)
    assert checks["MOTOR-PEAK"].status == "fail"
    usual = {one.id: one for one in resolve(design()).analysis.checks}
    assert usual["MOTOR-PEAK"].value == pytest.approx(12.0 * 12 * 0.88)
