"""``--temperature`` and the table of surroundings as processes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

DESIGN = Path(__file__).resolve().parents[2] / "designs" / "reference-s.toml"


def with_table(tmp_path: Path, text: str) -> str:
    path = tmp_path / "d.toml"
    path.write_text(DESIGN.read_text(encoding="utf-8") + text, encoding="utf-8")
    return str(path)


@pytest.mark.deep
def test_warm_parts_move_the_backlash_and_leave_the_closed_forms(cqdd) -> None:
    cold, warm = (
        json.loads(cqdd("analyse", str(DESIGN), "--angles", "24", "--json", *more).out)
        for more in ((), ("--temperature", "333.15 K"))
    )
    for found, least, most in ((cold, 5.5, 5.7), (warm, 2.65, 2.95)):
        assert least < found["results"]["precision"]["backlash_arcmin"] < most
    assert cold["results"]["geometry"] == warm["results"]["geometry"]


def test_toleranced_gearboxes_bind_when_warm(cqdd) -> None:
    words = ("tolerance", str(DESIGN), "--samples", "24", "--angles", "110", "--json")
    shares = []
    for more in ((), ("--temperature", "80 degC")):
        found = json.loads(cqdd(*words, *more).out)["results"]
        shares.append(found["share_beyond_limit"]["unloaded_torque_Nm"])
        assert found["temperatures_degC"]["carrier"] == (80.0 if more else 20.0)
    assert shares[0] < shares[1] == 1.0


@pytest.mark.parametrize(
    ("told", "says"),
    [
        ("-5 K", "outside -60 to 200 degC"),
        ("300 degC", "outside -60 to 200 degC"),
        ("60", 'has no unit; write it like "60 degC"'),
        ("60 C", "read in degC, K or degF"),
        ("60 kelvin", "read in degC, K or degF"),
    ],
)
@pytest.mark.parametrize("command", ["analyse", "tolerance"])
def test_absurd_temperatures_are_a_sentence(cqdd, command: str, told: str, says: str) -> None:
    done = cqdd(command, str(DESIGN), "--temperature", told)
    assert done.code == 2
    assert says in done.err
    assert done.out == ""


@pytest.mark.parametrize("command", ["analyse", "tolerance"])
def test_a_material_without_expansion_is_a_sentence(cqdd, tmp_path: Path, command: str) -> None:
    path = with_table(tmp_path, '\n[housing]\nmaterial = "PA6-CF 15% FDM"\n')
    done = cqdd(command, path, "--temperature", "60 degC")
    assert done.code == 3
    assert "no thermal expansion of 'PA6-CF 15% FDM', of which the carrier is made" in done.err


@pytest.mark.deep
def test_a_part_beyond_its_materials_limit_is_said(cqdd, tmp_path: Path) -> None:
    path = with_table(tmp_path, '\n[housing]\nmaterial = "PLA"\n')
    done = cqdd("analyse", path, "--angles", "16", "--temperature", "60 degC")
    assert done.code == 0
    assert "the carrier at 60 degC is above the 55 degC up to which 'PLA'" in done.err


@pytest.mark.parametrize(
    ("table", "says"),
    [
        ('ambient = "-300 degC"', "outside -60 degC to 90 degC"),
        ('coldest = "30 degC"', "coldest 30 degC is above ambient 25 degC"),
        ("ambient = 25", "has no unit"),
    ],
)
def test_wrong_surroundings_are_a_sentence(cqdd, tmp_path: Path, table: str, says: str) -> None:
    done = cqdd("check", with_table(tmp_path, f"\n[environment]\n{table}\n"))
    assert done.code == 3
    assert says in done.err
