"""One price list for several machines: what any of them may have passes, a slip is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from cqdd_design.catalog.screws import find_shoulder_screw
from cqdd_design.design import load_design
from cqdd_design.errors import UsageError
from cqdd_design.exporting.bill.known import MADE_PARTS, catalogue_designations, is_to_size
from cqdd_design.exporting.bill.prices import read_prices
from cqdd_design.exporting.solids.bom import BomRow, bill_of_materials, priced
from cqdd_design.machine import Machine, resolve

ROOT = Path(__file__).resolve().parents[2]
COLUMNS = {
    "reducer.carrier.joint": "columns",
    "reducer.carrier.column_count": 5,
    "reducer.carrier.column_diameter": "5 mm",
    "reducer.output_pins.count": 5,
}


def bill_of(machine: Machine) -> tuple[BomRow, ...]:
    return bill_of_materials(machine, machine.parts)


@pytest.fixture(scope="module")
def plain() -> Machine:
    return resolve(load_design(ROOT / "designs" / "cqdd-10.toml"))


@pytest.fixture(scope="module")
def bills(plain: Machine) -> dict[str, tuple[BomRow, ...]]:
    """Of machines as unlike each other as designs are."""
    found = [plain, plain.changed(COLUMNS), plain.changed({"reducer.disc_count": 3})]
    found.append(plain.changed({"reducer.disc_count": 1}))
    files = [ROOT / "designs" / "reference-s.toml", ROOT / "designs" / "printed-13.toml"]
    files += sorted((ROOT / "docs" / "gallery").glob("*.toml"))
    found += [resolve(load_design(path)) for path in files]
    return {f"{place} {one.design.name}": bill_of(one) for place, one in enumerate(found)}


def test_one_list_prices_every_machine(
    bills: dict[str, tuple[BomRow, ...]], tmp_path: Path
) -> None:
    """All parts of all machines in one file: each bill is then priced to its last line."""
    names = {row.priced_by.lower(): row.priced_by for bill in bills.values() for row in bill}
    path = tmp_path / "prices.csv"
    lines = "".join(f'"{name}",1.5,EUR\n' for key, name in names.items() if key)
    path.write_text(f"designation,price,currency\n{lines}", encoding="utf-8")
    prices = read_prices(path)
    for bill in bills.values():
        rows = priced(bill, prices)
        assert all(row.price_each == 1.5 for row in rows if row.priced_by)


def test_the_names_of_made_parts_are_known(bills: dict[str, tuple[BomRow, ...]]) -> None:
    made = {row.part for bill in bills.values() for row in bill if row.make_or_buy == "make"}
    assert made <= MADE_PARTS
    assert {"disc", "disc 1", "carrier column", "eccentric cam", "dowel pin"} <= made


def test_what_is_ordered_to_a_size_is_known_by_its_pattern() -> None:
    screw = find_shoulder_screw(4e-3).designation(41.5e-3).lower()
    assert screw not in {one.lower() for one in catalogue_designations()}
    for key in (
        screw,
        "iso 4762 m3 x 37 - 12.9",
        "shim rings 61.2 x 66, cut from strip",
        "diametric magnet ndfeb n35h 5 x 2.5 mm",
        "ring magnet ndfeb n35h, magnetised across, 16 x 10 x 3 mm",
    ):
        assert is_to_size(key)
        assert not is_to_size(key[:-1])
    assert not is_to_size("iso 4762 m3.1 x 37 - 12.9")
    assert not is_to_size("iso 4762 m3 x - 12.9")


def test_a_price_by_an_older_standard_is_of_the_same_part(plain: Machine, tmp_path: Path) -> None:
    row = next(one for one in bill_of(plain) if one.designation.startswith("ISO 4762 "))
    older = next(one for one in row.substitutes.split("; ") if one.startswith("DIN 912 "))
    path = tmp_path / "prices.csv"
    path.write_text(f"designation,price,currency\n{older},0.25,EUR\n", encoding="utf-8")
    found = {one.designation: one for one in priced(bill_of(plain), read_prices(path))}
    assert found[row.designation].price_each == 0.25
    both = f"designation,price,currency\n{older},0.25,EUR\n{row.designation},0.3,EUR\n"
    path.write_text(both, encoding="utf-8")
    with pytest.raises(UsageError, match="lines 2 and 3 both price"):
        read_prices(path)


@pytest.mark.parametrize(
    ("row", "near"),
    [("dics 2", "'disc 2'"), ("carrier colum", "'carrier column'"), ("disc 7", "'disc 3'")],
)
def test_a_slip_of_the_pen_is_refused_with_near_names(
    plain: Machine, tmp_path: Path, row: str, near: str
) -> None:
    path = tmp_path / "prices.csv"
    path.write_text(f"designation,price,currency\n{row},4,EUR\n", encoding="utf-8")
    with pytest.raises(UsageError) as caught:
        priced(bill_of(plain), read_prices(path))
    assert near in caught.value.message
    assert "line 2" in caught.value.message
