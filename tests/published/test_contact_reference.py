"""Design S against a second implementation that shares no code with this one."""

from dataclasses import replace
from pathlib import Path

import pytest
from contact_checks import one_body

from cqdd_design.design import load_design
from cqdd_design.gearbox.carrier import pin_of
from cqdd_design.gearbox.contact.rubbing import ContactFriction
from cqdd_design.gearbox.contact.sweep import contact_sweep
from cqdd_design.gearbox.life import life
from cqdd_design.machine import resolve

DESIGN = Path(__file__).resolve().parents[2] / "designs" / "reference-s.toml"

#: Torque in N m; pressure in MPa and cam load in N without friction, and with a friction of 0.08
#: and the motor driving; efficiency of the contacts.
FIGURES = [
    (34.2, (999.0, 902.0), (1054.0, 1155.0), 0.7725),
    (90.0, (1512.0, 2338.0), (1610.0, 3081.0), 0.755),
]


@pytest.mark.parametrize(("torque", "smooth", "rubbed", "efficiency"), FIGURES)
def test_pressure_and_cam_load_with_friction_and_without(
    torque, smooth, rubbed, efficiency, validated
):
    model = one_body(resolve(load_design(DESIGN)).contact)
    for choice, (pressure, cam) in (("off", smooth), ("drive", rubbed)):
        sweep = contact_sweep(model, torque, friction=ContactFriction.of(model, choice))
        words = "without friction" if choice == "off" else "driving, friction 0.08"
        for name, found, wanted in (
            ("pressure", sweep.ring_pressure.max() / 1e6, pressure),
            ("cam load", sweep.cam_load.max(), cam),
        ):
            validated(
                f"S at {torque:g} N·m, {words}: greatest {name}",
                "an independent implementation",
                abs(found / wanted - 1.0),
                0.02,
            )
        if choice == "drive":
            validated(
                f"S at {torque:g} N·m, {words}: efficiency of the contacts",
                "an independent implementation",
                abs(sweep.efficiency - efficiency),
                0.002,
            )


def test_life_is_what_decides():
    """Between stiff plates and without friction the ring of S lasts 47 h; friction takes more.

    A cap that hangs on the pins takes as much again; discs and ring that give bring some back.
    """
    machine = resolve(load_design(DESIGN))
    rigid = replace(machine.contact, bodies=None)
    stiff = replace(rigid, pin=pin_of(machine.design, ("hinged", "hinged")), tie=1e9)
    smooth, rubbed, hung, yielding = (
        life(machine.design, model, friction=friction).parts[0].hours
        for model, friction in (
            (stiff, False),
            (stiff, True),
            (rigid, True),
            (machine.contact, True),
        )
    )
    assert smooth == pytest.approx(47.0, rel=0.1)
    assert 0.3 < rubbed / smooth < 0.5
    assert 0.2 < hung / rubbed < 0.5
    assert 1.3 < yielding / hung < 2.0
