"""A motor of one's own: in the design's table or in a file, by one reader and one precedence."""

from __future__ import annotations

import dataclasses
import math
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cqdd_design.actuator.build import actuator_parameters
from cqdd_design.catalog import find_motor, motors
from cqdd_design.catalog.motors import CONVENTIONS, WINDING_MOST
from cqdd_design.design import Design, load_design, load_requirements, save_design
from cqdd_design.design.motor import NAMELESS, MotorFile, MotorTable
from cqdd_design.design.motor_row import IN_DESIGN, row_over
from cqdd_design.design.schema import design_schema
from cqdd_design.errors import CqddError, DesignError, InfeasibleError
from cqdd_design.machine import resolve
from cqdd_design.machine.temperatures import machine_temperatures

PLACE = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"
DESIGN = load_design(PLACE)
LITE = find_motor("CubeMars RO100 Lite KV55")
INRUNNER = "CubeMars RI80 V2.0 KV75"
WINDING = {"speed_constant": "60 rpm/V", "resistance": "0.1 ohm"}


def with_table(**keys: Any) -> Design:
    mapping = DESIGN.leaving("drive.thermal_resistance").to_mapping()
    mapping["motor"] = keys
    return Design.from_mapping(mapping)


def of_file(**keys: Any) -> MotorFile:
    return MotorFile.from_mapping({"name": "filed", **keys}, place="motor.toml")


def test_a_table_and_a_file_are_one_motor() -> None:
    """The same keys in either place: the same row, but for where it says that it comes from."""
    keys = {
        "torque_constant": "0.2 N*m/A",
        "convention": "torque_per_rms",
        "resistance": "70 mohm",
        "inductance": "60 uH",
        "measured_between": "phase",
        "rotor_inertia": "900 g*cm^2",
        "rotor_mass": "150 g",
        "stator_mass": "250 g",
        "peak_torque": "9 N*m",
        "hysteresis": "0.02 N*m",
        "bore_diameter": "72 mm",
        "pole_pairs": 20,
    }
    inline = with_table(name="filed", **keys).motor_row
    filed = DESIGN.with_motor(motor=of_file(**keys)).motor_row
    assert (
        dataclasses.replace(
            filed, stated_in=inline.stated_in, source=inline.source, drag_source=inline.drag_source
        )
        == inline
    )
    assert filed.stated_in == "file: motor.toml"
    assert inline.stated_in == IN_DESIGN
    assert inline.torque_constant == pytest.approx(0.2 / math.sqrt(1.5), rel=1e-12)
    assert (inline.line_resistance, inline.line_inductance) == pytest.approx((0.14, 1.2e-4))
    assert inline.mass == pytest.approx(0.4)
    assert (inline.coulomb, inline.hysteresis) == (0.0, 0.02)


def test_what_a_motor_of_its_own_leaves_out_is_not_known() -> None:
    """Constant and resistance make a motor: no figure of another one stands in for the rest."""
    for row in (
        with_table(name="mine", **WINDING).motor_row,
        with_table(**WINDING).motor_row,
        DESIGN.with_motor(motor=of_file(**WINDING)).motor_row,
    ):
        known = {"speed_constant", "line_resistance"}
        for field in dataclasses.fields(row):
            if str(field.type).startswith(("float", "int")) and field.name not in known:
                assert getattr(row, field.name) is None, field.name
        assert row.based_on == ""
        assert set(row.missing) >= {"peak torque", "rotor inertia", "mass", "stator bore", "drag"}
    assert with_table(**WINDING).motor.name == NAMELESS


def test_what_a_table_leaves_out_of_a_named_motor_is_the_catalogues() -> None:
    for keys in ({"name": LITE.name}, {"name": "mine", "based_on": LITE.name}):
        row = with_table(**keys, resistance="0.2 ohm").motor_row
        assert (row.line_resistance, row.peak_torque) == (0.2, LITE.peak_torque)
        assert row.origin("line_resistance") == IN_DESIGN
        assert row.origin("peak_torque").startswith(f"catalogue: {LITE.name}, taken over from")
    assert with_table(name=LITE.name.upper()).motor_row is find_motor(LITE.name)


def test_the_file_goes_over_the_table_and_that_over_the_catalogue() -> None:
    """Each of three places gives what those before it leave out."""
    inline = with_table(name=LITE.name, peak_torque="9 N*m", rated_torque="3 N*m", voltage="36 V")
    both = inline.with_motor(motor=of_file(peak_torque="8 N*m"))
    row = both.motor_row
    assert (row.peak_torque, row.rated_torque, row.mass) == (8.0, 3.0, LITE.mass)
    assert both.motor.voltage == 36.0
    assert (row.name, row.based_on) == ("filed", LITE.name)
    # A name of the catalogue alone takes the place of all that the table says.
    other = inline.with_motor("CubeMars RO80 KV105")
    assert other.motor_row is find_motor("CubeMars RO80 KV105")
    assert other.motor.voltage == 36.0
    # Beside a name, a file goes over that motor, even one that could stand for itself.
    under = inline.with_motor("CubeMars RO80 KV105", of_file(**WINDING)).motor_row
    assert (under.based_on, under.rated_torque, under.line_resistance) == (
        "CubeMars RO80 KV105",
        find_motor("CubeMars RO80 KV105").rated_torque,
        0.1,
    )


def test_words_for_one_thing_replace_each_other() -> None:
    """A torque constant replaces a speed constant, line values stand beside those of a phase."""
    inline = with_table(
        name="mine",
        speed_constant="60 rpm/V",
        resistance="0.1 ohm",
        inductance="80 uH",
        mass="1 kg",
        coulomb="0.2 N*m",
        viscous="1e-3 N*m*s/rad",
    )
    row = inline.with_motor(
        motor=of_file(
            torque_constant="0.3 N*m/A",
            resistance="0.08 ohm",
            measured_between="phase",
            rotor_mass="0.2 kg",
            stator_mass="0.3 kg",
            hysteresis="0.05 N*m",
        )
    )
    # It stands for itself: constant and resistance are its own.
    assert row.motor_row.line_inductance is None
    partly = inline.with_motor(motor=of_file(resistance="0.08 ohm", measured_between="phase"))
    assert partly.motor_row.line_resistance == pytest.approx(0.16)
    assert partly.motor_row.line_inductance == pytest.approx(80e-6)
    other = inline.with_motor(motor=of_file(torque_constant="0.3 N*m/A")).motor_row
    assert other.torque_constant == pytest.approx(0.3)
    assert other.line_resistance == 0.1
    drag = inline.with_motor(motor=of_file(hysteresis="0.05 N*m")).motor_row
    assert (drag.coulomb, drag.viscous, drag.hysteresis) == (0.0, 0.0, 0.05)
    mass = inline.with_motor(motor=of_file(rotor_mass="0.2 kg", stator_mass="0.3 kg")).motor_row
    assert mass.mass == pytest.approx(0.5)


@settings(max_examples=40, deadline=None)
@given(
    value=st.floats(1e-3, 10.0),
    convention=st.sampled_from(sorted(CONVENTIONS)),
    resistance=st.floats(1e-3, 10.0),
    between=st.sampled_from(["line", "phase"]),
    inertia=st.floats(1e-7, 1e-3),
)
def test_a_design_with_a_motor_survives_being_written(
    tmp_path_factory: pytest.TempPathFactory,
    value: float,
    convention: str,
    resistance: float,
    between: str,
    inertia: float,
) -> None:
    design = with_table(
        name="mine",
        torque_constant=f"{value!r} N*m/A",
        convention=convention,
        resistance=f"{resistance!r} ohm",
        measured_between=between,
        rotor_inertia=f"{inertia!r} kg*m^2",
    )
    path = tmp_path_factory.mktemp("own") / "own.toml"
    save_design(path, design)
    again = load_design(path)
    row, back = design.motor_row, again.motor_row
    assert again.replacing({"name": design.name}).sha256 == design.sha256
    assert back.stated == row.stated
    for field in row.stated:
        assert getattr(back, field) == pytest.approx(getattr(row, field), rel=1e-11)
    assert row.torque_constant == pytest.approx(value / CONVENTIONS[convention])
    assert not [key for key in again.assumed if key.startswith("motor.n")]


def test_a_design_without_keys_of_a_motor_is_what_it_was() -> None:
    assert set(DESIGN.to_mapping()["motor"]) == {"name", "voltage", "current_limit"}
    assert DESIGN.motor_row is LITE
    bare = Design.from_mapping({**DESIGN.to_mapping(), "motor": {}})
    assert "motor.name" in bare.assumed
    assert "motor.name" not in with_table(coulomb="0.1 N*m").assumed


@pytest.mark.parametrize(
    ("keys", "says"),
    [
        ({"name": "CubeMars AK80-9 V3"}, "geared actuator: .* behind a gear of 9, .* choose one"),
        ({"name": "CubeMars AK80-9 V3", **WINDING}, "under a name of your own"),
        ({"name": "mine"}, "has no motor 'mine'.* a motor of your own gives torque_constant"),
        ({"name": "mine", "resistance": "0.1 ohm"}, "or names the catalogue's that it is based_on"),
        ({"torque_constant": "0.1 N*m/A", "speed_constant": "60 rpm/V"}, "say the same; keep one"),
        ({**WINDING, "resistance": "-0.1 ohm"}, r"motor.resistance = '-0.1 ohm'.* nearest allowed"),
        ({"torque_constant": "0.1 N*m/A", "convention": "rms"}, "must be 'dc', 'torque_per_peak'"),
        ({**WINDING, "rotor_inertia": "1 kg*m"}, "not a unit of moment of inertia"),
        ({"name": LITE.name, "rotor_inertia": "2e-3 kg*m^2"}, "0.525 kg within 108.3 mm can have"),
        ({"name": LITE.name, "outer_diameter": "90 mm"}, "gap_diameter 100 mm is not inside"),
        ({"name": LITE.name, "stack_length": "60 mm"}, "stack_length 60 mm is not inside length"),
        ({"name": LITE.name, "rotor_length": "60 mm"}, "rotor_length 60 mm is not inside length"),
        ({"name": LITE.name, "slot_depth": "20 mm"}, "slot_depth 20 mm does not fit between bore_"),
        (
            {"name": INRUNNER, "hollow_diameter": "60 mm"},
            "hollow_diameter 60 mm is not inside",
        ),
        ({"name": INRUNNER, "slot_depth": "18 mm"}, "between gap_diameter .* which leave 17.25 mm"),
        ({"name": INRUNNER, "rotor_inertia": "1e-3 kg*m^2"}, "is more than iron between"),
        ({**WINDING, "kind": "gimbal"}, "must be 'outrunner' or 'inrunner'"),
    ],
)
def test_motors_that_cannot_be_are_refused(keys: dict[str, Any], says: str) -> None:
    with pytest.raises(DesignError, match=says):
        resolve(with_table(**keys))


def test_an_inrunner_of_ones_own_says_that_it_is_one() -> None:
    """Without the word its rotor's bore is a hole through the shaft, and no stator has one."""
    row = find_motor(INRUNNER)
    sizes = {
        name: f"{1e3 * getattr(row, name)} mm"
        for name in ("outer_diameter", "length", "hollow_diameter", "gap_diameter")
    }
    sizes |= {"stack_length": "20 mm", "rotor_length": "22 mm", "slot_depth": "8 mm"}
    own = {"name": "mine", **WINDING, **sizes, "mass": "0.4 kg"}
    unsaid, said = with_table(**own), with_table(**own, kind="inrunner")
    assert 'kind = "inrunner" where its rotor turns inside' in resolve(unsaid).layout.motor_missing
    machine = resolve(said)
    assert machine.layout.inrunner is not None
    masses = {part.name: part.mass for part in machine.parts}
    heavier = with_table(
        **{key: value for key, value in own.items() if key != "mass"},
        kind="inrunner", rotor_mass="0.2 kg", stator_mass="0.2 kg",
    )  # fmt: skip
    other = {part.name: part.mass for part in resolve(heavier).parts}
    assert other["motor rotor"] == pytest.approx(0.2)
    assert masses["motor rotor"] == pytest.approx(0.3 * 0.4)
    assert other["motor rotor"] + other["motor stator"] == pytest.approx(0.4)


def test_a_limit_that_never_binds_names_one_that_does() -> None:
    """Rounded to a current that the winding takes, not beyond it."""
    slow = with_table(name=LITE.name, resistance="5.8 ohm", current_limit="50 A")
    with pytest.raises(DesignError, match=r"lower it to 8\.27 A"):
        actuator_parameters(resolve(slow))


def test_a_file_and_a_name_must_be_about_one_motor() -> None:
    own = of_file(based_on="CubeMars RO80 KV105", coulomb="0.1 N*m")
    with pytest.raises(DesignError, match="is asked for beside it; keep one"):
        DESIGN.with_motor(LITE.name, own)
    with pytest.raises(DesignError, match="is asked for beside it; keep one"):
        row_over(LITE.name, own, named=True)


@pytest.mark.parametrize(
    "name", [one.name for one in motors().values() if one.torque_at != "motor"]
)
def test_no_geared_actuator_is_a_motor(name: str) -> None:
    """Each is named, and so are bare motors that can take its place."""
    for make in (
        lambda: DESIGN.with_motor(name),
        lambda: DESIGN.replacing({"requirements.motor": name}),
        lambda: of_file(based_on=name),
    ):
        with pytest.raises(DesignError) as caught:
            make()
        assert f"'{name}' is a geared actuator" in caught.value.message
        assert not isinstance(caught.value, InfeasibleError)
        named = [one for one in motors() if f"'{one}'" in caught.value.message and one != name]
        assert any(find_motor(one).torque_at == "motor" for one in named)


def test_every_room_sees_the_motor_of_the_table() -> None:
    """Solids, inertia, checks and simulation: no other motor's figure anywhere."""
    keys = {"name": "mine", "based_on": LITE.name, "rotor_inertia": "4e-4 kg*m^2"}
    machine = resolve(with_table(**keys, mass="0.6 kg", peak_torque="5 N*m", resistance="0.2 ohm"))
    assert machine.inertia.rotor_inertia == 4e-4
    assert "mine as stated" in machine.inertia.mass_scope
    assert "rotor as stated" in machine.inertia.inertia_scope
    assert f"{LITE.name} by its catalogue" in resolve(DESIGN).inertia.mass_scope
    assert machine.inertia.group_masses["motor"] == pytest.approx(0.6)
    assert machine.inertia.rotor_drawn == pytest.approx(4e-4, rel=1e-6)
    (peak,) = [one for one in machine.analysis.checks if one.id == "MOTOR-PEAK"]
    assert (peak.value, peak.status) == (pytest.approx(5.0 * 10 * 0.88), "fail")
    found = actuator_parameters(machine)
    assert (found.motor.resistance, found.motor.rotor_inertia) == (0.2, 4e-4)
    assert found.origins["motor.resistance"] == f"{IN_DESIGN}, line to line"
    assert found.origins["motor.torque_constant"].startswith(f"catalogue: {LITE.name}")
    assert "mine" in machine.motor.remark
    assert LITE.name in machine.motor.remark
    assert resolve(DESIGN).motor.remark == ""


def test_the_windings_limit_and_its_cooling_are_the_tables() -> None:
    """A cooler limit holds everywhere; the catalogue's class of wire does not raise it."""
    assert LITE.winding_limit == 155.0
    assert resolve(DESIGN).motor.winding_most == WINDING_MOST
    usual = with_table(name=LITE.name)
    cool = resolve(with_table(name=LITE.name, winding_limit="90 degC"))
    assert cool.motor.winding_most == 90.0
    thermal = actuator_parameters(cool).thermal
    assert (thermal.most, thermal.derating_begins) == (90.0, 70.0)
    # A better cooled winding stays colder, by whichever table says how it is cooled.
    by_motor = resolve(with_table(name=LITE.name, thermal_resistance="0.5 K/W"))
    by_drive = resolve(usual.replacing({"drive.thermal_resistance": "0.5 K/W"}))
    ways = [machine_temperatures(one).steady for one in (by_motor, by_drive, resolve(usual))]
    assert ways[0] == pytest.approx(ways[1])
    assert max(ways[0]) < max(ways[2]) - 10.0
    with pytest.raises(DesignError, match="both say how the winding is cooled; keep one"):
        by_motor.given.replacing({"drive.thermal_resistance": "0.6 K/W"})
    stated = usual.replacing({"drive.thermal_resistance": "0.6 K/W"})
    over = resolve(stated.with_motor(motor=of_file(thermal_resistance="0.5 K/W")))
    assert over.cooling.value == 0.5


def test_requirements_take_the_motor_of_their_file(tmp_path: Path) -> None:
    path = tmp_path / "asked.toml"
    path.write_text('[requirements]\nratio = 10\n[motor]\nname = "CubeMars RO80 KV105"\n')
    assert load_requirements(path).motor == "CubeMars RO80 KV105"
    path.write_text(
        '[requirements]\nratio = 10\nmotor = "CubeMars RI60 KV120"\n'
        '[motor]\nname = "CubeMars RO80 KV105"\n'
    )
    assert load_requirements(path).motor == "CubeMars RI60 KV120"


def test_requirements_take_the_driver_of_their_file(tmp_path: Path) -> None:
    """Else a design for more than it gives would be called good."""
    path = tmp_path / "asked.toml"
    text = "[requirements]\nratio = 10\n{}[motor]\nvoltage = '24 V'\ncurrent_limit = '10 A'\n"
    path.write_text(text.format(""))
    asked = load_requirements(path)
    assert (asked.voltage, asked.current) == (24.0, 10.0)
    path.write_text(text.format("current = '8 A'\n"))
    assert load_requirements(path).current == 8.0
    assert load_requirements(path, {"voltage": "36 V"}).voltage == 36.0


def test_the_schema_knows_the_keys_of_a_motor() -> None:
    table = design_schema()["$defs"]["MotorTable"]
    assert set(MotorTable.model_fields) == set(table["properties"])
    assert table["required"] == []
    assert LITE.name in table["properties"]["based_on"]["examples"]
    for key, field in table["properties"].items():
        assert field.get("default", "") is not None, key
        assert "null" not in str(field), key


def test_a_wrong_name_of_a_catalogue_lists_the_nearest() -> None:
    with pytest.raises(CqddError, match="nearest are 'CubeMars RO100 KV55'"):
        with_table(name="CubeMars R0100 KV55")


def test_the_page_on_motors_knows_every_key_and_its_table_is_a_motor() -> None:
    page = (PLACE.parents[1] / "docs" / "how-to-motor.md").read_text(encoding="utf-8")
    keys = page.partition("## Keys")[2]
    for key in MotorFile.model_fields:
        assert f"`{key}`" in keys, key
    (block,) = re.findall(r"^```toml\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    row = with_table(**tomllib.loads(block)["motor"]).motor_row
    assert row.torque_constant == pytest.approx(0.1737, rel=1e-3)
    assert (row.line_resistance, row.mass) == (0.143, find_motor("CubeMars RO100 KV55").mass)
