"""The one judgement: where its values come from, what is not known, and when it says yes."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from shared_outputs import paper_input

from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.actuator.operating import held_torque, needed
from cqdd_design.actuator.specimen import AS_DRAWN
from cqdd_design.catalog.bearings import SHAFT_MATERIAL, bearings
from cqdd_design.catalog.motors import DRAG, find_motor
from cqdd_design.design import Design, load_design
from cqdd_design.gearbox.checks.equilibrium import ENDLESS
from cqdd_design.gearbox.checks.guide_row import GEOMETRY
from cqdd_design.gearbox.contact.rubbing import ContactFriction
from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles
from cqdd_design.gearbox.life.fatigue import contact_cycles
from cqdd_design.machine import Machine, resolve
from cqdd_design.machine.carrying import CarriedTorque
from cqdd_design.machine.contact_analysis import analyse_contact
from cqdd_design.machine.rotor_overhang import rotor_overhang
from cqdd_design.results import Check
from cqdd_design.verdict import Verdict, judge
from cqdd_design.verdict.drawn import (
    Allowed,
    drawn_cam_hours,
    good_gearboxes,
    used,
    yield_line,
)
from cqdd_design.verdict.headline import headline
from cqdd_design.verdict.judge import meets, sentence
from cqdd_design.verdict.lines import lines_without_drawn, with_drawn
from cqdd_design.verdict.motor import missing_figures, motor_lines
from cqdd_design.verdict.output_seat_line import output_seat_line

DESIGNS = Path(__file__).resolve().parents[2] / "designs"
SAMPLES = 24


@pytest.fixture(scope="module")
def machine() -> Machine:
    """At torques near what it bears, so that lines pass and fail."""
    design = load_design(DESIGNS / "reference-s.toml")
    return resolve(
        design.replacing({"requirements.peak_torque": 50.0, "requirements.continuous_torque": 14.0})
    )


@pytest.fixture(scope="module")
def judged(machine: Machine) -> Verdict:
    return judge(machine, samples=SAMPLES)


def by_id(lines: tuple[Check, ...]) -> dict[str, Check]:
    return {line.id: line for line in lines}


def test_peak_loads_are_those_of_sweeps_in_both_senses(machine: Machine, judged: Verdict) -> None:
    """Solved again by hand: pressures, shear and cam load at the peak torque, with friction."""
    model, reducer = machine.contact, machine.design.reducer
    friction = ContactFriction.of(model, "drive")
    sweeps = [
        contact_sweep(model, torque, perfect_angles(model, 400), friction=friction)
        for torque in (50.0, -50.0)
    ]
    ring = max(float(sweep.ring_pressure.max()) for sweep in sweeps) / 1e6
    hole = max(float(sweep.pin_pressure.max()) for sweep in sweeps) / 1e6
    pin = max(float(sweep.pin_force.max()) for sweep in sweeps)
    cam = max(float(sweep.cam_load.max()) for sweep in sweeps)
    area = math.pi / 4.0 * (1e3 * reducer.output_pins.diameter) ** 2
    lines = by_id(judged.lines)
    rating = machine.cam.static_rating
    assert rating is not None
    for name, value in (
        ("CONTACT-RING-PEAK", ring),
        ("CONTACT-PIN-PEAK", hole),
        ("PIN-SHEAR-PEAK", pin / area),
        ("BEARING-STATIC", rating / cam),
    ):
        assert lines[name].value == pytest.approx(value, rel=4e-3), name
        assert "contact equilibrium" in lines[name].basis
    # The screen's value is another one, and says what it is.
    screen = by_id(machine.analysis.checks)["CONTACT-RING-PEAK"]
    assert "first screen" in screen.basis
    assert screen.value != pytest.approx(lines["CONTACT-RING-PEAK"].value, rel=0.05)


def test_at_its_limit_a_flank_lasts_just_the_hours(machine: Machine, judged: Verdict) -> None:
    """Cycles at the limit of the line are those of the required life, times what a place sees."""
    line = by_id(judged.lines)["CONTACT-RING-CONTINUOUS"]
    life = machine.life
    turns = life.required_hours * life.loads[0].turns_per_hour
    assert line.limit is not None
    part = min(life.parts[:2], key=lambda one: one.reserve or math.inf)
    borne = float(contact_cycles(line.limit * 1e6, part.limit))
    # No place sees the greatest pressure at every tooth it meets.
    assert turns <= borne * 1.02 <= 1.05 * part.cycles_per_output_turn * turns
    assert line.margin == pytest.approx(part.reserve)
    assert (line.margin >= 1.0) == part.lasts(life.required_hours)


def test_the_output_bearing_is_judged_at_the_temperatures_of_the_verdict(
    machine: Machine, judged: Verdict
) -> None:
    line = by_id(judged.lines)["OUTPUT-PRELOAD"]
    assert line == output_seat_line(machine, judged.evidence.temperatures)
    assert line.status == "fail"


def test_lines_pass_exactly_where_the_life_does(machine: Machine, judged: Verdict) -> None:
    lines, life = by_id(judged.lines), machine.life
    hours = min(part.hours or ENDLESS for part in life.parts)
    passing = all(
        lines[f"{name}-CONTINUOUS"].status == "pass"
        for name in ("CONTACT-RING", "CONTACT-PIN", "PIN-BENDING")
    )
    assert passing == (hours >= life.required_hours)
    assert lines["BEARING-LIFE"].value == life.cam.set_hours
    figure = next(one for one in judged.headline if one.id == "life")
    # Of the gearboxes that are drawn all but the worst last so long; of perfect parts longer.
    most = drawn_cam_hours(machine, judged.evidence.drawn, judged.lines)
    assert figure.value == min(hours, most)
    assert most < life.cam.set_hours
    alone = headline(replace(judged.evidence, drawn=None), judged.lines, judged.peak)
    perfect = next(one for one in alone if one.id == "life")
    assert perfect.title == "life of perfect parts"
    assert perfect.value == min(hours, life.cam.set_hours)


def test_a_speed_at_its_limit_takes_the_whole_voltage(machine: Machine, judged: Verdict) -> None:
    actuator = actuator_parameters(machine)
    line = by_id(judged.lines)["MOTOR-SPEED"]
    assert line.value is not None
    speed = line.value * math.pi / 30.0 / machine.design.reducer.ratio
    shares = []
    for temperature in (actuator.thermal.most, actuator.thermal.ambient):
        need = needed(actuator, 14.0, speed, temperature)
        volts = need.voltage / actuator.drive.supply_voltage
        shares.append(max(volts, need.current / actuator.drive.current_limit))
    # Of a cold motor, whose magnets are stronger.
    assert max(shares) == pytest.approx(shares[1]) == pytest.approx(1.0, rel=2e-3)


@pytest.mark.parametrize(
    ("changes", "binding", "key", "unit"),
    [
        ({"motor.current_limit": "20 A"}, "driver", "current_limit", "A"),
        ({"motor.voltage": "24 V"}, "voltage", "voltage", "V"),
    ],
)
def test_the_cure_of_the_speed_raises_what_binds(
    changes: dict[str, str], binding: str, key: str, unit: str
) -> None:
    def line(design: Design) -> Check:
        machine = resolve(design)
        return by_id(motor_lines(machine, actuator_parameters(machine), ""))["MOTOR-SPEED"]

    weak = load_design(DESIGNS / "reference-s.toml").replacing(changes)
    found = line(weak)
    assert found.status == "fail"
    assert found.substituted.endswith(f"binding: {binding}")
    others = {"motor.current_limit", "motor.voltage"} - {f"motor.{key}"}
    assert not any(other in found.remedy for other in others)
    named = re.search(rf"raise motor\.{key}.*? to about ([\d.]+) {unit}", found.remedy)
    assert named, found.remedy
    assert line(weak.replacing({f"motor.{key}": f"{named[1]} {unit}"})).status == "pass"


def test_more_than_the_motor_itself_gives_is_no_matter_of_the_driver() -> None:
    design = load_design(DESIGNS / "reference-s.toml").replacing(
        {"motor.peak_torque": "2 N*m", "motor.based_on": "CubeMars RO100 KV55", "motor.name": "own"}
    )
    machine = resolve(design)
    found = by_id(motor_lines(machine, actuator_parameters(machine), ""))["MOTOR-SPEED"]
    assert found.value == 0.0
    assert found.substituted.endswith("binding: motor")
    assert found.remedy == "take a stronger motor or more ratio"


def test_continuous_means_for_ever_at_the_input_speed(machine: Machine, judged: Verdict) -> None:
    slow = machine.design.replacing({"requirements.input_speed": 20.0})
    actuator = actuator_parameters(resolve(slow))
    held = float(held_torque(actuator, 20.0 / slow.reducer.ratio)[0])
    lines = motor_lines(resolve(slow), actuator, "")
    line = by_id(lines)["MOTOR-CONTINUOUS"]
    assert line.value == pytest.approx(held)
    assert held > (by_id(judged.lines)["MOTOR-CONTINUOUS"].value or 0.0)
    assert f"{float(held_torque(actuator, 0.0)[0]):.4g} N*m standing still" in line.substituted
    unsure = motor_lines(resolve(slow), actuator, "", uncooled="nothing is drawn")
    assert by_id(unsure)["MOTOR-CONTINUOUS"].status == "unknown"
    assert by_id(unsure)["MOTOR-CONTINUOUS"].substituted == "nothing is drawn"


@pytest.mark.parametrize(("torque", "speed"), [(5.0, "1200 rpm"), (9.0, None), (40.0, "300 rpm")])
def test_the_speed_that_is_advised_is_one_at_which_the_torque_is_held(
    machine: Machine, torque: float, speed: str | None
) -> None:
    """And a little faster it is not; where it is not even held at rest, no speed is told."""

    def line_of(**changed: object) -> Check:
        stated = {"requirements.continuous_torque": torque, "requirements.peak_torque": 50.0}
        if speed is not None:
            stated["requirements.continuous_speed"] = speed
        other = resolve(machine.design.replacing({**stated, **changed}))
        return by_id(motor_lines(other, actuator_parameters(other), ""))["MOTOR-CONTINUOUS"]

    told = line_of()
    assert told.status == "fail"
    found = re.search(r"continuous_speed(?: to|, as it is held up to) ([\d.]+) rpm", told.remedy)
    assert (found is None) == (torque > 30.0)
    assert "continuous_speed" not in told.remedy or found
    if found:
        assert line_of(**{"requirements.continuous_speed": f"{found[1]} rpm"}).status == "pass"
        faster = 1.02 * float(found[1])
        assert line_of(**{"requirements.continuous_speed": f"{faster} rpm"}).status == "fail"


@pytest.mark.deep
def test_under_a_duty_its_heat_decides_and_not_the_continuous_torque(machine: Machine) -> None:
    duty = [{"torque": "3 N*m", "speed": "-1 rad/s", "share": 0.5}]
    mean = 0.5 * machine.design.reducer.ratio
    mapping = machine.design.to_mapping()
    mapping["requirements"]["duty"] = duty
    judged = judge(resolve(Design.from_mapping(mapping)), samples=0)
    lines = by_id(judged.lines)
    assert "MOTOR-CONTINUOUS" not in lines
    assert lines["DUTY-ENVELOPE"].status == "pass"
    figure = judged.headline[1]
    assert (figure.id, figure.required) == ("continuous_torque", None)
    assert figure.status == lines["THERMAL-RISE"].status == "pass"
    # Half of the time the output turns at 1 rad/s.
    assert figure.title == f"continuous torque at {mean * 30.0 / math.pi:.0f} rpm"
    actuator = judged.evidence.actuator
    assert actuator is not None
    held = float(held_torque(actuator, mean / machine.design.reducer.ratio)[0])
    # Warm parts press before the winding is at its limit.
    assert 1.0 < (figure.value or 0.0) < held
    assert "as far as all parts stand it" in figure.basis
    assert judged.headline[5].title == "temperature"
    assert "for ever at the duty's mean speed of the motor; not asked for" in figure.basis
    # At a speed that is stated this friction alone is too much: 0 N m says so.
    mapping["requirements"]["continuous_speed"] = "1286 rpm"
    stated = judge(resolve(Design.from_mapping(mapping)), samples=0).headline[1]
    assert stated.title == "continuous torque at 1286 rpm"
    assert stated.value == 0.0
    assert "at this speed of the motor: friction alone heats the winding too much" in stated.basis
    # In cold air the winding stands it, but parts that drag alone warms press on each other.
    relaxed = Design.from_mapping(mapping | {"environment": {"ambient": "-5 degC"}})
    pressing = judge(resolve(relaxed), samples=0).headline[1]
    assert pressing.value == 0.0
    assert "drag alone makes parts too warm or press there" in pressing.basis
    mapping["requirements"]["continuous_speed"] = "150 rpm"
    cooler = judge(resolve(Design.from_mapping(mapping)), samples=0).headline[1]
    assert (cooler.value or 0.0) > 0.0
    assert "alone" not in cooler.basis


def test_the_first_figure_is_the_weaker_of_motor_and_gearbox(judged: Verdict) -> None:
    figure, lines = judged.headline[0], by_id(judged.lines)
    motor = lines["MOTOR-PEAK"].value
    assert motor is not None
    assert figure.value is not None
    assert figure.value <= motor
    weak = [one for one in ("CONTACT-RING-PEAK", "DOWEL-BEARING") if not lines[one].satisfied]
    assert (figure.value < 50.0) == (motor < 50.0 or bool(weak))


@pytest.mark.deep
def test_the_rotor_hangs_on_the_support_bearings_at_any_torque(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """By proportion of all of their load the first figure was 8.04 N m, and its remedy 6.3."""
    # With the weakest of the shaft bearings that go in, or another is the first to give way.
    for stronger in ("SKF * 607", "SKF * 627"):
        monkeypatch.delitem(bearings(), stronger)
    judged = judge(resolve(load_design(DESIGNS / "printed-13.toml")), samples=0)
    figure, line = judged.headline[0], by_id(judged.lines)["SUPPORT-STATIC"]
    assert figure.basis.startswith(line.title)
    (told,) = re.findall(r"lower the torque to ([0-9.]+) N\*m", line.remedy)
    assert figure.value == pytest.approx(float(told), rel=0.02)


def test_a_peak_that_is_not_known_names_the_lines_that_are_not() -> None:
    steel = {"reducer.carrier.material": SHAFT_MATERIAL}
    printed = load_design(DESIGNS / "printed-13.toml").replacing(steel)
    figure = judge(resolve(printed), samples=0).headline[0]
    assert figure.status == "unknown"
    assert figure.value is None
    assert figure.basis.startswith("not known of OUTPUT-STATIC; all else holds to 13.63 N*m (")


@pytest.mark.deep
def test_a_peak_of_which_nothing_is_known_says_no_torque(
    machine: Machine, monkeypatch: pytest.MonkeyPatch
) -> None:
    bare = CarriedTorque(50.0, (), ("CONTACT-RING-PEAK",))
    monkeypatch.setattr("cqdd_design.verdict.headline.carried_torque", lambda _: bare)
    monkeypatch.setattr("cqdd_design.verdict.headline.standing_torque", lambda *_: None)
    blank = replace(machine, motor=replace(machine.motor, peak_torque=None))
    figure = judge(blank, samples=0).headline[0]
    assert (figure.value, figure.status) == (None, "unknown")
    assert figure.basis == "not known of MOTOR-PEAK, CONTACT-RING-PEAK"


def test_drag_that_nobody_measured_never_passes(machine: Machine) -> None:
    """Stated as nothing it is known."""
    free = replace(machine.motor, **dict.fromkeys(DRAG))
    lines = by_id(motor_lines(replace(machine, motor=free), None, ""))
    assert lines["MOTOR-DATA"].status == "unknown"
    told = lines["MOTOR-DATA"].substituted
    assert "drag; without its own drag (coulomb, viscous)" in told
    stated = replace(free, **dict.fromkeys(DRAG, 0.0))
    assert "MOTOR-DATA" not in by_id(motor_lines(replace(machine, motor=stated), None, ""))


def test_heat_and_speed_without_drag_are_not_known_unless_they_fail(machine: Machine) -> None:
    """A file without `coulomb` and `viscous` said a surface passed at 44 degC that has 62."""
    asked = {"requirements.surface_temperature": "200 degC"}
    whole = machine.changed(asked)
    free = replace(whole, motor=replace(machine.motor, **dict.fromkeys(DRAG)))
    known, unknown = (judge(one, samples=0) for one in (whole, free))
    before, after = by_id(known.lines), by_id(unknown.lines)
    assert before.keys() | {"MOTOR-DATA"} == after.keys()
    hanging = {"THERMAL-RISE", "SURFACE-TEMPERATURE", "MOTOR-CONTINUOUS", "MOTOR-SPEED"}
    for name in hanging:
        line = after[name]
        assert line.status in {"unknown", "fail"}
        if line.status == "unknown":
            assert "drag" in line.substituted
            assert "[motor]" in line.remedy
    assert {before[one].status for one in hanging} > {"fail"}
    assert unknown.headline[5].status != "pass"


@pytest.mark.parametrize("key", ["peak_torque", "bore_diameter", "rotor_inertia"])
def test_a_motor_without_a_figure_never_passes(machine: Machine, key: str) -> None:
    blank = replace(machine, motor=replace(machine.motor, **{key: None}))
    (words,) = missing_figures(blank.motor)
    lines = by_id(motor_lines(blank, actuator_parameters(blank, AS_DRAWN), ""))
    assert lines["MOTOR-DATA"].status == "unknown"
    assert words in lines["MOTOR-DATA"].substituted
    assert "--motor-file" in lines["MOTOR-DATA"].remedy
    assert meets(lines.values()) != "yes"
    if key == "bore_diameter":
        assert lines["MOTOR-BORE"].status == "unknown"
    if key == "peak_torque":
        assert lines["MOTOR-PEAK"].status == "unknown"
        # Enough of what is known to say no is a no.
        more = machine.design.replacing({"requirements.peak_torque": 500.0})
        asked = resolve(more, blank.motor)
        found = motor_lines(asked, actuator_parameters(asked), "")
        assert by_id(found)["MOTOR-PEAK"].status == "fail"


def test_nothing_asks_for_the_stator_bore_of_a_motor_behind_the_gearbox() -> None:
    behind = replace(find_motor("CubeMars RI70 KV95"), **dict.fromkeys(DRAG, 0.0))
    assert behind.bore_diameter is None
    assert missing_figures(behind) == ()
    machine = resolve(load_design(DESIGNS / "cqdd-10.toml"), behind)
    assert not [one for one in machine.analysis.warnings if "stator bore" in one]
    assert "MOTOR-DATA" not in by_id(machine.analysis.checks)
    assert "MOTOR-DATA" not in by_id(motor_lines(machine, actuator_parameters(machine), ""))


def test_without_an_actuator_every_limit_of_the_motor_is_unknown(machine: Machine) -> None:
    lines = by_id(motor_lines(machine, None, "no resistance"))
    for name in ("MOTOR-PEAK", "MOTOR-CONTINUOUS", "MOTOR-SPEED"):
        assert lines[name].status == "unknown"
        assert lines[name].substituted == "no resistance"


def test_a_torque_without_an_equilibrium_is_a_failure(machine: Machine, judged: Verdict) -> None:
    high = resolve(machine.design.replacing({"requirements.peak_torque": 20_000.0}))
    lines = by_id(lines_without_drawn(replace(judged.evidence, machine=high)))
    reach = lines["CONTACT-REACH"]
    assert reach.status == "fail"
    assert reach.value is not None
    assert 50.0 < reach.value < 20_000.0
    assert lines["CONTACT-RING-PEAK"].status == "unknown"
    model = high.contact
    contact_sweep(model, 0.99 * reach.value, friction=ContactFriction.of(model, "drive"))
    assert meets(lines.values()) == "no"


def test_what_could_not_be_computed_is_unknown(judged: Verdict) -> None:
    nothing = replace(
        judged.evidence,
        stress_checks=(),
        stress_missing="too thin to mesh",
        heat_checks=(),
        heat_missing="no expansion",
        temperatures=None,
        drawn=None,
        drawn_missing="nothing drawn",
    )
    lines = by_id(with_drawn(nothing, lines_without_drawn(nothing)))
    for name in ("RING-STRESS", "ROOT-FATIGUE", "THERMAL-RISE", "YIELD", "MOTOR-CONTINUOUS"):
        assert lines[name].status == "unknown", name
        assert not lines[name].satisfied
    assert lines["RING-STRESS"].substituted == "too thin to mesh"


def test_strengths_that_the_catalogue_lacks_are_unknown() -> None:
    design = load_design(DESIGNS / "printed-13.toml")
    lines = by_id(judge(resolve(design), samples=0).lines)
    assert lines["CONTACT-RING-CONTINUOUS"].status == "unknown"
    assert lines["CONTACT-RING-CONTINUOUS"].limit is None
    assert "no contact fatigue" in lines["CONTACT-RING-CONTINUOUS"].substituted


def test_a_gearbox_counts_where_it_does_not_bind_and_stays_within_limits(
    machine: Machine, judged: Verdict
) -> None:
    drawn, lines = judged.evidence.drawn, judged.lines
    assert drawn is not None
    drawn = drawn._replace(warm=None)
    for one, torque in zip(drawn[:2], (14.0, 50.0), strict=True):
        assert one.ensemble.torque == torque
        assert len(one.values) + one.lost == SAMPLES
    lasts, bears = (one.columns for one in drawn[:2])

    def with_margin(names: dict[str, float]) -> tuple[Check, ...]:
        """Lines with some margins: the limit moves, the value stays."""
        changed = []
        for line in lines:
            margin = names.get(line.id)
            if margin is not None:
                value, _ = line.compared
                limit = value * margin if line.sense == "max" else value / margin
                line = replace(line, limit=limit)
            changed.append(line)
        return tuple(changed)

    def good(**margins: float) -> set[int]:
        named = {
            "CONTACT-RING-PEAK": margins.get("peak", 1e3),
            "CONTACT-RING-CONTINUOUS": margins.get("lasting", 1e3),
            "BEARING-LIFE": margins.get("cam", 1e9),
        }
        found = good_gearboxes(machine, drawn, with_margin(named))
        assert found is not None
        return set(found[0].tolist())

    rating = machine.cam.static_rating
    assert rating is not None
    static = bears["cam_bearing_load_max_N"] <= rating
    allowed = Allowed.of(machine, lines)
    assert allowed is not None
    assert allowed.peak_load == rating
    shares = used(allowed, drawn)["BEARING-STATIC"]
    assert shares == pytest.approx(bears["cam_bearing_load_max_N"] / rating)
    loose = lasts["unloaded_torque_Nm"] <= 0.05 * 14.0
    free = set(drawn.continuous.numbers[loose]) & set(drawn.peak.numbers[static])
    assert good() == free
    assert 0 < len(free) < SAMPLES
    perfect = machine.loaded_contacts.greatest(14.0)
    middle = float(np.median(lasts["ring_pressure_max_MPa"]))
    within = lasts["ring_pressure_max_MPa"] <= middle
    half = good(lasting=middle / perfect["ring_pressure_max_MPa"] * (1.0 + 1e-9))
    assert half == free & set(drawn.continuous.numbers[within])
    cam = float(np.median(lasts["cam_bearing_load_max_N"]))
    soft = lasts["cam_bearing_load_max_N"] <= cam
    exponent = machine.analysis.cam_bearing.exponent
    share = (cam / perfect["cam_bearing_load_max_N"]) ** exponent
    assert good(cam=share * (1.0 + 1e-9)) == free & set(drawn.continuous.numbers[soft])
    at_peak = float(np.median(bears["ring_pressure_max_MPa"]))
    own = by_id(lines)["CONTACT-RING-PEAK"].value
    assert own is not None
    mild = bears["ring_pressure_max_MPa"] <= at_peak
    assert good(peak=at_peak / own * (1.0 + 1e-9)) == free & set(drawn.peak.numbers[mild])
    jammed = drawn._replace(continuous=replace(drawn.continuous, lost=SAMPLES))
    whole, less = (yield_line(machine, one, "", lines).value for one in (drawn, jammed))
    count = len(drawn.continuous.values) + drawn.continuous.lost
    assert whole is not None
    assert less == pytest.approx(whole * count / (len(drawn.continuous.values) + SAMPLES))
    strong = {"CONTACT-RING-CONTINUOUS": 1e3, "CONTACT-RING-PEAK": 1e3, "BEARING-LIFE": 1e9}
    for name, words in (
        (
            "",
            "give modification.equidistant and hole_clearance some um more, or closer [tolerances]",
        ),
        ("CONTACT-RING-PEAK", "; or ask for less peak torque"),
        ("BEARING-LIFE", "; or ask for less continuous torque, or a shorter life"),
    ):
        told = yield_line(machine, drawn, "", with_margin(strong | {name: 0.1})).remedy
        assert told.endswith(words)
    unsure = tuple(
        replace(one, value=None) if one.id == "CONTACT-RING-PEAK" else one for one in lines
    )
    assert yield_line(machine, drawn, "", unsure).status == "unknown"


def test_yes_needs_every_line_known_and_none_that_fails(judged: Verdict) -> None:
    line = next(one for one in judged.lines if one.status == "pass")
    bad = replace(line, value=2.0 * (line.limit or 1.0), sense="max")
    unknown, rule = replace(line, value=None), replace(bad, severity="warn")
    assert meets((line,)) == "yes"
    assert meets((line, rule)) == "yes"
    assert meets((line, unknown)) == "unknown"
    assert meets((line, unknown, bad)) == "no"
    assert sentence("knee", (line, unknown, bad, rule)) == (
        "knee does NOT meet its requirements: of 4 lines 1 pass, 1 warn, 1 FAIL, 1 are UNKNOWN"
    )
    share = replace(line, id="YIELD")
    assert sentence("knee", (line, share)) == "knee meets its requirements: of 2 lines 2 pass"
    assert sentence("knee", (line,)).startswith("knee: of 1 lines 1 pass; YIELD is open")
    assert unknown.to_dict()["value"] is None
    assert unknown.to_dict()["margin"] is None


def test_the_shafts_own_bearings_are_judged(machine: Machine, judged: Verdict) -> None:
    """Against the load that `analyse` tells of the discs, and what the rotor adds to it."""
    line = by_id(judged.lines)["SUPPORT-STATIC"]
    bending = analyse_contact(machine).bending
    assert bending is not None
    assert bending.support_rating is not None
    rotor = rotor_overhang(machine).on_bearings
    both = (one + other for one, other in zip(bending.support_load, rotor, strict=True))
    wanted = bending.support_rating / max(both)
    assert line.value == pytest.approx(wanted, rel=0.02)
    own = by_id(paper_input().verdict.lines)["SUPPORT-STATIC"]
    assert own.status == "fail"
    assert own.value == pytest.approx(1270 / 5115, rel=0.02)


def test_a_temperature_that_no_part_stands_is_told_as_heat_on_the_first_screen(
    judged: Verdict,
) -> None:
    """At 14 N m for ever the network of reference-s ends beyond 1000 deg C."""
    figure = next(one for one in judged.headline if one.id == "temperature")
    assert figure.value is not None
    assert figure.value > 300.0
    assert "(no part stands it: too much heat)" in figure.told


def test_a_cam_bearing_that_wears_out_is_told_the_rating_it_needs(judged: Verdict) -> None:
    paper = resolve(load_design(DESIGNS / "cqdd-10.toml"))
    line = by_id(paper_input().verdict.lines)["BEARING-LIFE"]
    assert line.status == "fail"
    hours, required = line.compared
    rating = paper.cam.dynamic_rating
    assert rating is not None
    told = re.search(r"needs C of ([\d.]+) kN", line.remedy)
    assert told is not None
    wanted = rating * (required / hours) ** (1.0 / 3.0)
    assert float(told[1]) == pytest.approx(wanted / 1e3, rel=1e-2)


def test_what_binds_comes_first(judged: Verdict) -> None:
    order = ["fail", "unknown", "warn", "pass"]
    places = [order.index(line.status) for line in judged.limits]
    assert places == sorted(places)
    failing = [line.margin for line in judged.limits if line.status == "fail"]
    assert failing == sorted(failing)
    assert len(judged.limits) >= 6


def test_what_gives_way_comes_before_sizes_that_a_search_has_filled(judged: Verdict) -> None:
    """A ring as wide as is allowed says nothing of what the gearbox bears."""
    passing = tuple(line for line in judged.lines if line.status == "pass")
    alone = replace(judged, lines=passing)
    sizes = [line.basis == GEOMETRY for line in alone.limits]
    assert not any(sizes)
    margins = [line.margin for line in alone.limits]
    assert margins == sorted(margins)
    assert all(line.basis == GEOMETRY and line.margin < 1.01 for line in alone.filled)
    assert "SPACE-DIAMETER" in {line.id for line in alone.filled}
