"""`compare`: every setting that decides can be given, and what was not given is printed."""

from __future__ import annotations

from pathlib import Path

import pytest
from terminal_lines import too_wide

from cqdd_design.errors import UsageError
from cqdd_design.planetary.profile_shift import ProfileShifts
from cqdd_design.planetary.settings import SETTINGS, RatingSettings, read_settings

DESIGN = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"

GIVEN = {
    "--material-quality": ("ML", "material_quality", "ML"),
    "--accuracy-class": ("7", "accuracy_class", 7),
    "--application-factor": ("1.25", "application_factor", 1.25),
    "--mesh-load-table": ("abs", "mesh_load_table", "abs"),
    "--lubricant-viscosity": ("46 mm^2/s", "lubricant_viscosity_mm2_per_s", 46.0),
    "--life-hours": ("5000", "life_hours", 5000.0),
    "--peak-cycles": ("1e6", "peak_cycles", 1e6),
    "--least-contact-safety": ("1.1", "least_contact_safety", 1.1),
    "--least-bending-safety": ("1.5", "least_bending_safety", 1.5),
    "--shifts": (
        "0.35, -0.35, 0.1, -0.1",
        "shifts",
        {"sun": 0.35, "planet_sun": -0.35, "planet_ring": 0.1, "ring": -0.1},
    ),
}


@pytest.mark.deep
def test_every_option_reaches_the_rating(cqdd):
    words = [word for name, (text, *_) in GIVEN.items() for word in (name, text)]
    told = cqdd("compare", DESIGN, "--json", *words).document["results"]["planetary"]
    for _, key, value in GIVEN.values():
        assert told["rating_settings"][key] == pytest.approx(value), key
    assert len(told["rating_settings_given"]) == len(GIVEN)
    assert told["profile_shifts"] == told["rating_settings"]["shifts"]
    plain = cqdd("compare", DESIGN, "--json").document["results"]["planetary"]
    assert plain["rating_settings_given"] == []
    first, second = (found["by_planets"][0]["S_H"] for found in (plain, told))
    assert second < first


def test_a_settings_file_is_read_and_options_go_before_it(cqdd, tmp_path):
    path = tmp_path / "settings.toml"
    path.write_text(
        'material_quality = "ME"\napplication_factor = 1.5\nface_load_factor = 1.2\n'
        'crowned = false\nflank_roughness = "5 um"\nring_tip_diameter = "68 mm"\n'
        "shifts = [0.3, -0.3, 0, 0]\n"
    )
    done = cqdd("compare", DESIGN, "--settings", path, "--application-factor", "1.1")
    lines = {" ".join(line.split()) for line in done.out.splitlines()}
    for line in (
        "material_quality ME given",
        "application_factor 1.1 given",
        "face_load_factor 1.2 given",
        "crowned no given",
        "flank_roughness 5 um given",
        "ring_tip_diameter 68 mm given",
        "life_hours 1000 h default",
        "lubricant_viscosity 150 mm^2/s default",
    ):
        assert line in lines, line
    assert "run into its root fillet" in done.err
    assert "68.222 mm clears" in done.err


def test_defaults_are_printed(cqdd):
    stdout = cqdd("compare", DESIGN).out
    assert too_wide(stdout) == []
    for name in SETTINGS:
        assert f"{name} " in stdout, name
    assert "profile shifts 0.3, -0.3, 0, 0; tip diameter of the ring 68.222 mm" in stdout
    assert "judged on the paper's actuator" in stdout
    assert stdout.count("It hangs on the settings.") == 2


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("aplication_factor = 1.2", "did you mean 'application_factor'"),
        ("application_factor = 20.0", "0.1 to 10; 1 is usual"),
        ('application_factor = "much"', "is not a number"),
        ("accuracy_class = 5.5", "is not a whole number"),
        ("accuracy_class = inf", "is not a whole number"),
        ("accuracy_class = 12", "1 to 11; 5 is usual"),
        ('mesh_load_table = "isoo"', "did you mean 'iso'"),
        ('material_quality = "mq"', "'MQ'"),
        ("lubricant_viscosity = 150", "mm^2/s"),
        ('lubricant_viscosity = "150 mm"', "kinematic viscosity"),
        ('crowned = "yes"', "true or false"),
        ("shifts = [0.3, -0.3, 0]", "four profile shifts"),
        ('shifts = "0.3,-0.3,0,nan"', "four profile shifts"),
        ("peak_cycles = inf", "peak_cycles"),
        ("life_hours = 0", "0.001 to 1e+07; 1000 is usual"),
        ('ring_tip_diameter = "2 m"', "1 mm to 1000 mm"),
        ("[tables]\nx = 1", "is no setting"),
        ("application_factor = ", "not valid TOML"),
    ],
)
def test_settings_that_are_none(tmp_path, text, said):
    path = tmp_path / "settings.toml"
    path.write_text(text)
    with pytest.raises(UsageError) as caught:
        read_settings(path)
    assert said in caught.value.message
    assert caught.value.message.startswith((str(path), "settings:"))


def test_options_name_themselves(cqdd):
    done = cqdd("compare", DESIGN, "--mesh-load-table", "equals")
    assert done.code == 2
    assert "--mesh-load-table" in done.err
    assert "'equal'" in done.err
    done = cqdd("compare", DESIGN, "--shifts", "0.3,0,0,0")
    assert (done.code, "one pin" in done.err) == (3, True)


def test_defaults_are_inside_their_ranges_and_offered():
    """What a refusal calls usual is the default, or what a default computes is near to."""
    usual = RatingSettings()
    for name, row in SETTINGS.items():
        value = getattr(usual, name)
        if row.most:
            assert row.least <= row.usual <= row.most
            assert value is None or value == row.usual
    assert read_settings(None) == usual
    assert read_settings(None, {"shifts": "0,0,0,0"}).shifts == ProfileShifts(0.0, 0.0, 0.0, 0.0)
    with pytest.raises(UsageError, match="it is a device"):
        read_settings(Path("/dev/zero"))
