"""Design files: round trips, comments, bounds, and what is said about mistakes."""

import json
import math
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cqdd_design.design import (
    Design,
    load_design,
    load_requirements,
    requirements_from_mapping,
    save_design,
)
from cqdd_design.errors import CqddError, DesignError, UsageError

PAPER = Path(__file__).parents[2] / "designs" / "cqdd-10.toml"
REQUIRED = {
    "ratio": 10,
    "ring_pitch_radius": "32 mm",
    "eccentricity": "1.6 mm",
    "ring_pin_diameter": "7 mm",
}


def reducer(**changes):
    return {"reducer": {**REQUIRED, **changes}}


def test_paper_design_is_si_inside():
    design = load_design(PAPER)
    assert design.reducer.ring_pitch_radius == 0.032
    assert design.requirements.peak_torque == 120.0
    assert design.reducer.output_pins.hole_clocking == pytest.approx(math.pi / 20)
    assert design.reducer.pack_length == pytest.approx(0.0165)


@pytest.mark.parametrize(
    ("pin", "throw", "outside"),
    # Outside the pins' circle stands half a pin, or where the lobes' tips run if that is further.
    [("7 mm", "1.6 mm", 77.0), ("4 mm", "2.4 mm", 2.0 * (32.0 + 2.8 + 3.0))],
)
def test_the_ring_gets_a_wall_of_3_mm_outside_its_root(pin, throw, outside):
    given = reducer(ring_pin_diameter=pin, eccentricity=throw)
    assert Design.from_mapping(given).reducer.ring.outer_diameter == pytest.approx(1e-3 * outside)


def test_every_value_of_the_paper_design_says_its_origin():
    for line in PAPER.read_text().splitlines():
        if "=" in line and not line.startswith(("#", "schema_version", "name")):
            comment = line.split("#", 1)[1]
            assert any(word in comment for word in ("paper", "derived", "assumed")), line


def test_four_keys_are_enough_and_the_rest_is_listed_as_assumed():
    design = Design.from_mapping(reducer())
    given_keys = {f"reducer.{key}" for key in REQUIRED}
    assert set(design.assumed) == set(design.dotted_keys()) - given_keys
    assert design.requirements.peak_torque == 90.0
    assert design.requirements.continuous_torque == pytest.approx(34.2)


def test_mapping_round_trip_is_exact():
    design = load_design(PAPER)
    again = Design.from_mapping(design.to_mapping())
    assert again.to_mapping() == design.to_mapping()
    assert again.sha256 == design.sha256


def test_editing_keeps_comments_and_order(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(PAPER.read_text())
    design = load_design(path).replacing({"reducer.eccentricity": 0.0017})
    save_design(path, design)
    before, after = PAPER.read_text().splitlines(), path.read_text().splitlines()
    changed = [(a, b) for a, b in zip(before, after, strict=True) if a != b]
    assert changed == [
        (
            'eccentricity = "1.6 mm"           # assumed (Z_e): K1 = 0.55',
            'eccentricity = "1.7 mm"           # assumed (Z_e): K1 = 0.55',
        )
    ]


def test_new_file_leaves_assumed_keys_out(tmp_path):
    path = tmp_path / "new.toml"
    design = Design.from_mapping(reducer())
    save_design(path, design, comments={"reducer.ratio": "lobes"})
    assert "ratio = 10 # lobes" in path.read_text()
    again = load_design(path)
    assert again.reducer == design.reducer
    assert set(again.assumed) == set(design.assumed) - {"name"}
    assert "motor" not in path.read_text()


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (reducer(ratio=3), "nearest allowed is 4"),
        (reducer(ratio=1000), "nearest allowed is 119"),
        (reducer(ratio=10.5), "whole number from 4 to 119"),
        (reducer(ratio=math.nan), "whole number"),
        (reducer(ratio=math.inf), "whole number"),
        (reducer(ratio="10"), "whole number"),
        (reducer(ratio=True), "whole number"),
        (reducer(eccentricity=1.6), 'write it like "1.6 mm"'),
        (reducer(eccentricity="1.6 J"), "not a unit of length"),
        (reducer(eccentricity="-1 mm"), "nearest allowed is 0.01 mm"),
        (reducer(eccentricty="1.6 mm"), "did you mean 'eccentricity'"),
        (reducer(disc_material="AISI 4140 Q&T 540"), "AISI 4140 Q&T 540C"),
        (reducer(cam_bearing={"designation": "69022"}), "6902"),
        (reducer(ring_type="round"), "'solid', 'conjugate' or 'pinwheel'"),
        (reducer(output_pins=3), "must be a table"),
        (reducer(output_pins={"count": 2}), "nearest allowed is 3"),
        ({**reducer(), "requirements": {"ratio": 11}}, "is not reducer.ratio"),
        ({**reducer(), "requirements": {"peak_torque": "1286 rpm"}}, "not a unit of torque"),
        ({**reducer(), "requirements": {"input_speed": "20 Hz"}}, "rpm or rad/s"),
        ({**reducer(), "name": "../evil"}, "part of file names"),
        ({**reducer(), "name": ".."}, "part of file names"),
        ({**reducer(), "name": "a\x1b[2Jb"}, r"name 'a\x1b[2Jb' becomes part of file names"),
        ({**reducer(), "name": "a\x7fb"}, "part of file names"),
        ({**reducer(), "name": "a\x85b"}, "part of file names"),
        ({**reducer(), "name": "a\u200bb"}, "part of file names"),
        ({**reducer(), "name": "a\u202eb"}, "part of file names"),
        ({**reducer(), "name": "a\u2066b"}, "part of file names"),
        ({**reducer(), "name": "\ufeffab"}, "part of file names"),
        ({**reducer(), "name": "a\ud800b"}, "part of file names"),
        ({**reducer(), "name": "a" * 201}, "200 bytes at most"),
        (reducer(friction={"lubricant": "oil\u202e"}), "control or direction character"),
        (reducer(friction={"lubricant": "SKF LGLT2"}), "the nearest are 'SKF LGLT 2'"),
        (reducer(ratio=10**400), "reducer.ratio is a whole number of 401 digits"),
        (reducer(ratio=-(10**5000)), "reducer.ratio is a whole number of 5001 digits"),
        (reducer(output_pins={"count": 2**70}), "reducer.output_pins.count is 1180591620717411"),
        (reducer(eccentricity=10**400), "reducer.eccentricity is a whole number of 401 digits"),
        (
            {**reducer(), "requirements": {"duty": [{"torque": "1 N*m", "shares": 1.0}]}},
            "requirements.duty.0.shares is not a key of table 1 of [[requirements.duty]]; "
            "did you mean 'share'?",
        ),
        ({}, "reducer is missing"),
        ({**reducer(), "requirments": {}}, "did you mean 'requirements'"),
    ],
)
def test_mistakes_are_named_with_their_fix(data, says):
    with pytest.raises(DesignError) as caught:
        Design.from_mapping(data, source="mine.toml")
    assert says in str(caught.value)
    assert "mine.toml" in str(caught.value)


ASKED = {
    "motor": ("motor.name", "CubeMars RO80 KV105", "CubeMars RO100 Lite KV55"),
    "disc_count": ("reducer.disc_count", 3, 2),
    "disc_material": ("reducer.disc_material", "7075-T6", "AISI 4140 Q&T 540C"),
    "ring_material": ("reducer.ring_material", "7075-T6", "AISI 4140 Q&T 540C"),
    "pin_material": (
        "reducer.output_pins.material",
        "7075-T6",
        "18-8 shoulder screw (seed-consistent)",
    ),
}


@pytest.mark.parametrize("key", ASKED)
def test_a_file_whose_parts_are_not_those_it_asks_for_is_refused(tmp_path, key):
    place, other, own = ASKED[key]
    path, text = tmp_path / "a.toml", PAPER.read_text()
    for asked in (other, own):
        stated = f"[requirements]\n{key} = {json.dumps(asked)}\n"
        path.write_text(text.replace("[requirements]\n", stated))
        if asked == own:
            assert getattr(load_design(path).requirements, key) == own
            continue
        with pytest.raises(DesignError) as caught:
            load_design(path)
        assert str(caught.value) == (
            f"{path}: requirements.{key} {other!r} is not {place} {own!r}; make them equal or "
            f"leave requirements.{key} out."
        )


def test_a_motor_of_its_own_is_the_one_it_is_based_on(tmp_path):
    path = tmp_path / "a.toml"
    named = 'name = "CubeMars RO100 Lite KV55"'
    text = PAPER.read_text().replace("[requirements]\n", f"[requirements]\nmotor{named[4:]}\n")
    path.write_text(text.replace(f"\n{named}", f'\nname = "rewound"\nbased_on{named[4:]}'))
    design = load_design(path)
    assert design.motor.name == "rewound"
    # Another motor, of whoever takes the design on, is no contradiction within a file.
    assert design.with_motor("CubeMars RO80 KV105").motor.name == "CubeMars RO80 KV105"


def test_continuous_above_peak_is_refused():
    with pytest.raises(DesignError, match="above"):
        requirements_from_mapping(
            {"ratio": 10, "peak_torque": "5 N*m", "continuous_torque": "6 N*m"}
        )


@pytest.mark.parametrize(
    ("content", "error", "says"),
    [
        (None, UsageError, "there is no file"),
        (b"", DesignError, "empty"),
        (b"\x89PNG\r\n\x1a\n\x00\xff", DesignError, "not a text file"),
        (b'[reducer]\nratio = 10\neccentricity = "1.', DesignError, "not valid TOML"),
        (b"x = 1\n" * 200_000, DesignError, "MB"),
        (b"a = " + b"[" * 50_000, DesignError, "TOML"),
        (b"schema_version = 2\n[reducer]\n", DesignError, "schema_version"),
    ],
)
def test_bad_files(tmp_path, content, error, says):
    path = tmp_path / "bad.toml"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(error, match=says):
        load_design(path)


def test_files_of_windows_editors(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_bytes(b"\xef\xbb\xbf" + PAPER.read_bytes())
    design = load_design(path)
    assert design.sha256 == load_design(PAPER).sha256
    save_design(path, design.replacing({"reducer.eccentricity": 0.0017}))
    assert load_design(path).reducer.eccentricity == 0.0017
    assert path.read_text().startswith(PAPER.read_text()[:100])


def test_files_of_a_copy_are_called_after_it_and_not_by_the_name_within(tmp_path):
    """A copy with another's name within wrote over the other's report and exports."""
    path = tmp_path / "knee.v2.toml"
    path.write_bytes(PAPER.read_bytes())
    design = load_design(path)
    assert (design.name, design.file_name) == ("cqdd-10", "knee.v2")
    assert design.sha256 == load_design(PAPER).sha256
    changed = (
        design.replacing({"reducer.disc_count": 3}),
        design.leaving("reducer.balance.counterweights"),
        design.with_motor("CubeMars RO100 KV55"),
        design.with_duty_log(None),
        design.model_copy(update={"environment": design.environment}),
    )
    assert {one.file_name for one in changed} == {"knee.v2"}
    assert design.replacing({"name": "hip"}).file_name == "hip"
    assert load_design(PAPER).file_name == load_design(PAPER).name
    # What no system's files can be called does not become part of others'.
    odd = tmp_path / ("x" * 250 + ".toml")
    odd.write_bytes(PAPER.read_bytes())
    assert load_design(odd).file_name == "cqdd-10"


def test_missing_file_suggests_its_neighbour(tmp_path):
    (tmp_path / "cqdd-10.toml").write_text("")
    with pytest.raises(UsageError, match=r"did you mean .*cqdd-10\.toml"):
        load_design(tmp_path / "cqdd-1.toml")


def test_folder_is_no_design(tmp_path):
    with pytest.raises(UsageError, match="folder"):
        load_design(tmp_path)


def test_requirements_come_from_either_kind_of_file(tmp_path):
    assert load_requirements(PAPER).peak_torque == 120.0
    path = tmp_path / "wish.toml"
    path.write_text('[requirements]\nratio = 12\npeak_torque = "50 N*m"\n')
    assert load_requirements(path).ratio == 12
    path.write_text("[reducer]\n")
    with pytest.raises(DesignError, match="requirements"):
        load_requirements(path)


json_like = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.text(max_size=12)
    | st.sampled_from(["10 mm", "5 N*m", "1e-3 mm", "0 mm", "nan mm", "5 deg", "auto"]),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3)
    ),
    max_leaves=6,
)
KEYS = Design.from_mapping(reducer()).dotted_keys()


@settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.dictionaries(st.sampled_from(KEYS), json_like, max_size=6))
def test_no_value_raises_anything_but_our_own(changes):
    data = reducer()
    for key, value in changes.items():
        table = data
        *parents, last = key.split(".")
        for parent in parents:
            table = table.setdefault(parent, {})
            if not isinstance(table, dict):
                return
        table[last] = value
    try:
        design = Design.from_mapping(data)
    except CqddError:
        return
    assert Design.from_mapping(design.to_mapping()).sha256 == design.sha256


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda one: setattr(one, "name", "x"), "frozen, and name of Design .*replacing"),
        (lambda one: setattr(one.reducer, "eccentricity", 0.002), "eccentricity of Reducer"),
        (lambda one: setattr(one.requirements, "life", 1.0), "life of Requirements"),
        (lambda one: setattr(one.reducer, "eccentricty", 0.002), "did you mean 'eccentricity'"),
        (lambda one: delattr(one.reducer, "eccentricity"), "frozen, and eccentricity of Reducer"),
    ],
)
def test_a_design_never_changes_and_says_how_to_get_another(change, told):
    design = load_design(PAPER)
    with pytest.raises(UsageError, match=told):
        change(design)
    assert design == load_design(PAPER)


@pytest.mark.parametrize(
    ("table", "update", "told"),
    [
        ("reducer", {"eccentricty": 0.001}, "did you mean 'eccentricity'"),
        ("reducer", {"eccentricity": -1.0}, "outside 0.01 mm to 100 mm"),
        ("reducer", {"eccentricity": "1 kg"}, "not a unit of length"),
        ("requirements", {"peak_torque": 1.0}, "continuous_torque 40 N.m is above peak_torque"),
        ("environment", {"coldest": 50.0}, "above ambient"),
        ("environment", {"ambient": -20.0}, "coldest -10 degC is above ambient -20 degC"),
        (None, {"name": "a/b"}, "becomes part of file names"),
    ],
)
def test_a_copy_with_other_values_is_checked_like_a_file(table, update, told):
    design = load_design(PAPER)
    with pytest.raises(DesignError, match=told):
        (design if table is None else getattr(design, table)).model_copy(update=update)


def test_replacing_refuses_what_is_no_key():
    design = load_design(PAPER)
    for key, told in (
        (3, r'^3 is not a dotted key, such as "reducer\.eccentricity"\.$'),
        ("name.first", r"^name\.first is not a key: name is no table\.$"),
        ("reducer.eccentricty", "did you mean 'eccentricity'"),
    ):
        with pytest.raises(DesignError, match=told):
            design.replacing({key: "2 mm"})


def test_a_copy_with_other_values_is_the_design_that_replacing_gives():
    design = load_design(PAPER)
    thicker = design.reducer.model_copy(update={"disc_thickness": "9 mm"})
    copied = design.model_copy(update={"reducer": thicker})
    replaced = design.replacing({"reducer.disc_thickness": 9e-3})
    assert copied.sha256 == replaced.sha256 != design.sha256
    assert thicker.model_copy() == thicker
    # What was copied stays where another key is replaced.
    assert copied.replacing({"name": "x"}).reducer.disc_thickness == 9e-3
    loose = design.requirements.model_copy(update={"yield_share": 0.5})
    assert (loose.yield_share, loose.peak_torque) == (0.5, 120.0)
