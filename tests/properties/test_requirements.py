"""Requirements people have: what is stated is kept, used everywhere, and free of contradictions."""

import math
from pathlib import Path

import pytest

from cqdd_design.design import Design, load_design, requirements_from_mapping, save_design
from cqdd_design.errors import DesignError
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.life import life
from cqdd_design.gearbox.tolerance.limits import lasting_pressure, limits
from cqdd_design.machine import resolve
from cqdd_design.machine.carrying import compared_limits
from cqdd_design.machine.contact_analysis import analyse_contact
from cqdd_design.machine.duty_heat import duty_cases, duty_heat
from cqdd_design.machine.temperatures import machine_temperatures
from cqdd_design.sizing.frame import search_frame

PAPER = Path(__file__).parents[2] / "designs" / "cqdd-10.toml"
STATED = {
    "continuous_speed": "600 rpm",
    "speed_at_peak": "5 rad/s",
    "life": "2000 h",
    "bore": "8 mm",
    "mass": "1.5 kg",
    "reflected_inertia": "0.08 kg*m^2",
    "backlash": "6 arcmin",
    "lost_motion": "9 arcmin",
    "stiffness": "34000 N*m/rad",
    "efficiency": 0.7,
    "surface_temperature": "70 degC",
    "voltage": "24 V",
    "current": "40 A",
    "yield": 0.9,
}
ALWAYS = {"life": "1000 h", "yield": 0.95}


def changed(**values):
    return load_design(PAPER).replacing({f"requirements.{k}": v for k, v in values.items()})


def bare(**values):
    """A design that says nothing of its motor."""
    reducer = {"ratio": 10, "ring_pitch_radius": "32 mm", "eccentricity": "1.6 mm"}
    return Design.from_mapping(
        {"requirements": values, "reducer": {**reducer, "ring_pin_diameter": "7 mm"}}
    )


def test_what_is_stated_survives_a_file(tmp_path):
    design = bare(**STATED)
    save_design(tmp_path / "knee.toml", design)
    again = load_design(tmp_path / "knee.toml")
    assert again.requirements == design.requirements
    assert {key: again.to_mapping()["requirements"][key] for key in STATED} == STATED
    assert not {f"requirements.{key}" for key in STATED} & set(again.assumed)
    assert again.requirements.life == 2000.0 * 3600.0
    assert again.requirements.backlash == pytest.approx(math.radians(0.1))


def test_what_is_not_stated_is_neither_judged_nor_written(tmp_path):
    design = bare()
    written = design.to_mapping()["requirements"]
    assert {key: written.get(key) for key in STATED} == dict.fromkeys(STATED) | ALWAYS
    save_design(tmp_path / "knee.toml", design)
    assert not any(f"{key} =" in (tmp_path / "knee.toml").read_text() for key in STATED)
    left = [getattr(design.requirements, key) for key in STATED if key not in ALWAYS]
    assert left == [None] * (len(STATED) - len(ALWAYS))


def test_a_stiffness_may_be_per_arcmin():
    per_arcmin = requirements_from_mapping({"ratio": 10, "stiffness": "10 N*m/arcmin"})
    assert per_arcmin.stiffness == pytest.approx(10.0 * 60.0 * 180.0 / math.pi)


def test_lost_motion_may_be_limited_below_backlash_which_is_part_of_it() -> None:
    """Both are what it may be at most: with less of the one there is less of the other."""
    asked = bare(backlash="13 arcmin", lost_motion="12 arcmin").requirements
    assert asked.lost_motion < asked.backlash


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({"life": "0 h"}, "0 h is outside 1 h to 100000 h"),
        ({"life": 1000}, 'write it like "1000 h"'),
        ({"backlash": "6 mm"}, "'mm' is not a unit of angle"),
        ({"stiffness": "10 N*m"}, "torque per angle"),
        ({"efficiency": 80}, "80 is not a number from 0.01 to 0.999"),
        ({"yield": 1.1}, "a share of the gearboxes made"),
        ({"yield_share": 0.9}, "did you mean 'yield'?"),
        ({"continuous_speed": "2000 rpm"}, "above input_speed 1286 rpm"),
        ({"speed_at_peak": "20 rad/s"}, "turns the input at 1909.9 rpm, above input_speed"),
        ({"bore": "72 mm"}, "not within outer_diameter 72 mm"),
        ({"surface_temperature": "25 degC"}, "not above environment.ambient 25 degC"),
    ],
)
def test_contradictions_and_slips_are_sentences(values, says):
    with pytest.raises(DesignError) as caught:
        bare(**values)
    assert says in caught.value.message


@pytest.mark.parametrize(
    ("own", "key", "value", "more"),
    [("voltage", "voltage", "24 V", "48 V"), ("current", "current_limit", "30 A", "31 A")],
)
def test_the_motor_gets_the_supply_there_is(own, key, value, more):
    design = bare(**{own: value})
    assert design.to_mapping()["motor"][key] == value
    assert f"motor.{key}" in design.assumed
    assert design.replacing({f"requirements.{own}": more}).to_mapping()["motor"][key] == more
    with pytest.raises(DesignError, match=f"motor.{key} {more} is above requirements.{own}"):
        design.replacing({f"motor.{key}": more})


def test_the_required_life_stands_in_every_limit():
    """Limits of the same gearbox over a hundredth of the hours and over all of them."""
    short, long = (resolve(changed(life=f"{hours} h")) for hours in (100, 10_000))
    times = 100.0
    balls = times ** (1.0 / 3.0)
    checks = [{c.id: c for c in one.analysis.checks}["BEARING-LIFE"] for one in (short, long)]
    assert [one.limit for one in checks] == [100.0, 10_000.0]
    assert checks[0].value == checks[1].value
    cam = [limits(one.design)["cam_bearing_load_max_N"] for one in (short, long)]
    assert cam[0] / cam[1] == pytest.approx(balls)
    compared = [
        next(one.limit for one in compared_limits(machine) if one.check == "BEARING-LIFE")
        for machine in (short, long)
    ]
    assert compared == pytest.approx(cam)
    # Both lie beyond the knee of the pitting curve.
    pressure = [lasting_pressure(one.design) for one in (short, long)]
    met = 100.0 * 60.0 * 1286.0 / 10.0 * 11.0
    knee = 1e7
    assert met < knee < times * met
    steep = (met / knee) ** -0.056
    assert pressure[0] / pressure[1] == pytest.approx(
        steep / (times * met / knee) ** -0.023, rel=1e-3
    )
    lived = [life(one.design, ContactModel.from_design(one.design)) for one in (short, long)]
    assert [one.required_hours for one in lived] == [100.0, 10_000.0]
    assert lived[0].parts[0].hours == lived[1].parts[0].hours
    reserve = [one.parts[1].reserve for one in lived]
    assert reserve[0] / reserve[1] > 1.1
    worn = [analyse_contact(one, angles=8).running.wear for one in (short, long)]
    assert [one.hours for one in worn] == [100.0, 10_000.0]
    assert worn[1].disc_flank == pytest.approx([times * depth for depth in worn[0].disc_flank])


def test_the_search_sizes_bearings_for_the_required_life():
    frames = [
        search_frame(requirements_from_mapping({"ratio": 10, "life": f"{hours} h"}))
        for hours in (1000, 8000)
    ]
    rows = [one.bearing_table() for one in frames]
    names = [[b.designation for b in one.bearings] for one in frames]
    common = names[0].index("6902"), names[1].index("6902")
    allowed = [row.life_load[k] for row, k in zip(rows, common, strict=True)]
    assert allowed[0] / allowed[1] == pytest.approx(2.0)


def test_a_longer_life_chooses_a_larger_bearing():
    gentle = {"peak_torque": "30 N*m", "continuous_torque": "20 N*m"}
    auto = {"reducer.cam_bearing.designation": "auto"}
    chosen = [
        resolve(changed(**gentle, life=f"{hours} h").replacing(auto)).cam for hours in (10, 100_000)
    ]
    assert chosen[0].dynamic_rating < chosen[1].dynamic_rating


def test_the_continuous_torque_is_held_at_its_own_speed():
    fast, slow = changed(), changed(continuous_speed="643 rpm")
    machines = [resolve(one) for one in (fast, slow)]
    hours = [{c.id: c for c in m.analysis.checks}["BEARING-LIFE"].value for m in machines]
    assert hours[1] == pytest.approx(2.0 * hours[0])
    assert duty_cases(machines[1])[0].input_speed == pytest.approx(
        0.5 * fast.requirements.input_speed
    )
    lived = [life(m.design, m.contact).duty[0].speed for m in machines]
    assert lived[1] == pytest.approx(0.5 * lived[0])
    winding = [machine_temperatures(m).steady[0] for m in machines]
    assert winding[1] < winding[0] - 10.0
    again = slow.turning_at(50.0).requirements
    assert (again.input_speed, again.held_speed) == (50.0, 50.0)


def duty(share):
    return [{"torque": "30 N*m", "speed": "5 rad/s", "share": share}]


def test_what_shares_leave_out_is_rest():
    """Half of the time at rest: twice the hours, half the heat, the same stress."""
    machines = [resolve(changed(duty=duty(share))) for share in (1.0, 0.5)]
    lived = [life(m.design, m.contact) for m in machines]
    for whole, half in zip(lived[0].parts, lived[1].parts, strict=True):
        assert half.stress == pytest.approx(whole.stress)
        if whole.hours is not None:
            assert half.hours == pytest.approx(2.0 * whole.hours)
    assert lived[1].cam.set_hours == pytest.approx(2.0 * lived[0].cam.set_hours)
    heat = [duty_heat(m, duty_cases(m)) for m in machines]
    assert heat[1].gearbox == pytest.approx(0.5 * heat[0].gearbox)
    assert heat[1].current_squared == pytest.approx(0.5 * heat[0].current_squared)
    with pytest.raises(DesignError, match=r"add up to 1\.2, more than all of the time"):
        changed(duty=[*duty(0.7), *duty(0.5)])


def test_a_duty_of_rest_alone_is_none():
    """A torque that is held at rest, or turning without load, is one."""
    rest = {"torque": "0 N*m", "speed": "0 rad/s", "share": 1.0}
    with pytest.raises(DesignError, match="rest alone; give steps"):
        changed(duty=[rest, rest])
    for work in ({"torque": "3 N*m"}, {"speed": "-3 rad/s"}):
        assert len(changed(duty=[rest | work]).requirements.load_cases) == 1
