"""Prices that a user fills in: a CSV file of designation, price, currency and vendor.

Bought parts are named by their designation in the bill, or that of an older standard for the same
part, as ``DIN 912`` for ``ISO 4762``; made ones by the name of the part. Rows of
parts that this machine does not use are left alone, as long as another may have them.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from cqdd_design.errors import UsageError, nearest_names, shown
from cqdd_design.exporting.bill.known import MADE_PARTS, catalogue_designations, is_to_size
from cqdd_design.exporting.bill.substitutes import by_newer_standard
from cqdd_design.files import read_regular_file

COLUMNS = ("designation", "price", "currency", "vendor")
"""Of a price list; vendors may be left out."""
_MOST_BYTES = 10_000_000


@dataclass(frozen=True)
class Price:
    """A row of a price list.

    Attributes
    ----------
    amount : float
        For one piece or pack.
    line : int
        Of the file.
    """

    designation: str
    amount: float
    currency: str
    vendor: str
    line: int


@dataclass(frozen=True)
class PriceList:
    """Prices of a file, by designation; case, runs of blanks and older standards do not matter."""

    path: Path
    prices: Mapping[str, Price]

    def of(self, designation: str) -> Price | None:
        """The price of a part, None where the list has none."""
        return self.prices.get(_key(designation))

    def refuse_unknown(self, machine: Iterable[str]) -> None:
        """Refuse rows that name no part.

        Parameters
        ----------
        machine : iterable of str
            What the machine's bill calls its parts, beside what any machine may have.

        Raises
        ------
        UsageError
            Naming the row and the nearest designations.
        """
        own = list(dict.fromkeys((*machine, *sorted(MADE_PARTS))))
        known = {_key(name) for name in (*own, *catalogue_designations())}
        for key, price in self.prices.items():
            if key in known or is_to_size(key):
                continue
            near = nearest_names(price.designation, own) or nearest_names(
                price.designation, catalogue_designations()
            )
            hint = "; the nearest are " + ", ".join(f"'{one}'" for one in near) if near else ""
            raise UsageError(
                f"{self.path}, line {price.line}: {shown(price.designation)} is no part of this "
                f"machine or another, and in no catalogue{hint}."
            )


def read_prices(path: Path) -> PriceList:
    """Read a price list.

    Raises
    ------
    UsageError
        When it cannot be read, lacks a column, or a row has no price, a price below zero, no
        currency, or names a part that an earlier row names.
    """
    try:
        text = read_regular_file(path, _MOST_BYTES).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise UsageError(f"{path} is not a text file in UTF-8; save the prices as CSV.") from None
    head = text.partition("\n")[0]
    rows = csv.reader(
        io.StringIO(text), delimiter=";" if head.count(";") > head.count(",") else ","
    )
    try:
        headings = [cell.strip().lower() for cell in next(rows, [])]
        places = _places(path, headings)
        found: dict[str, Price] = {}
        for cells in rows:
            if not any(cell.strip() for cell in cells):
                continue
            price = _price(path, rows.line_num, cells, places)
            if price is None:
                continue
            earlier = found.setdefault(_key(price.designation), price)
            if earlier is not price:
                raise UsageError(
                    f"{path}, lines {earlier.line} and {price.line} both price "
                    f"'{price.designation}'; keep one of them."
                )
    except csv.Error:
        raise UsageError(f"{path}, line {rows.line_num} cannot be read as CSV.") from None
    return PriceList(path, MappingProxyType(found))


def _places(path: Path, headings: list[str]) -> dict[str, int]:
    missing = [name for name in COLUMNS[:3] if name not in headings]
    if missing:
        raise UsageError(
            f"{path} has no column '{missing[0]}'; its first line has to be {','.join(COLUMNS)}."
        )
    return {name: headings.index(name) for name in COLUMNS if name in headings}


def _price(path: Path, line: int, cells: list[str], places: Mapping[str, int]) -> Price | None:
    """A row; None where its price is left empty, which a list to be filled in may have."""

    def cell(name: str) -> str:
        place = places.get(name, len(cells))
        return cells[place].strip() if place < len(cells) else ""

    where, name, amount = f"{path}, line {line}", cell("designation"), cell("price")
    if not amount:
        return None
    if not name:
        raise UsageError(f"{where}: a price without a designation; name the part, or take it out.")
    try:
        value = float(amount)
    except ValueError:
        value = math.nan
    if not math.isfinite(value) or value < 0.0:
        raise UsageError(
            f"{where}: the price {shown(amount)} of '{name}' is no number from 0; write it with a "
            "decimal point and without the currency, as in 12.50."
        )
    if not cell("currency"):
        raise UsageError(f"{where}: the price of '{name}' has no currency; write one, as in EUR.")
    return Price(name, value, cell("currency"), cell("vendor"), line)


def _key(name: str) -> str:
    return by_newer_standard(" ".join(name.split())).lower()
