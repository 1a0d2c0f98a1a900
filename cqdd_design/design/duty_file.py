"""Duties from CSV files: time, torque and speed at the output, whatever the columns are called.

Numbers are read by numpy in pieces, so that a million rows take a second and little memory. Only
where that fails is the file read again, cell by cell, to say which one is wrong.
"""

from __future__ import annotations

import csv
import hashlib
import io
import math
import re
from collections.abc import Iterator
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import BinaryIO, NamedTuple, NoReturn

import numpy as np

from cqdd_design.design.duty_log import DutyColumns, DutyLog, FloatArray
from cqdd_design.errors import DesignError, UsageError, did_you_mean, shown
from cqdd_design.files import open_regular_file
from cqdd_design.files.sampling import first_that_does_not_rise, gap_in_even_rows
from cqdd_design.units import LOAD_SPEED, TIME, TORQUE, Dimension, format_quantity, parse_quantity

MOST_ROWS = 10_000_000
"""A day at 100 Hz, and some."""
MOST_TORQUE, MOST_SPEED = 1e5, 1e4
"""N m and rad/s: a robot joint, not a mill; the bounds of a step of `duty`."""
_IN_ROUND = re.compile(r"(\w+)\s*\(([^()]*)\)")
_PIECE = 100_000
_BYTES = 1 << 20
_LONGEST_LINE = 100_000
_DELIMITERS = ",;\t"
_EVEN_FROM = 20
"""Intervals from which a sampling is known to be even."""
_NAMES: dict[str, tuple[Dimension, tuple[str, ...]]] = {
    "time": (TIME, ("time", "t")),
    "torque": (TORQUE, ("torque", "tau", "moment")),
    "speed": (LOAD_SPEED, ("speed", "velocity", "omega", "rate")),
}
"""Quantities, and what their columns are usually called."""
_ENDINGS = {
    "time": {"_s": "s", "_ms": "ms"},
    "torque": {"_nm": "N*m"},
    "speed": {"_rad_s": "rad/s", "_deg_s": "deg/s", "_rpm": "rpm"},
}
"""Units as loggers write them behind those names."""


_TEMPLATE_HEAD = (
    "# A duty at the output, one cycle that comes again and again; for duty_file, or --duty.",
    "# Other columns may stand beside these, in any order, and other units in the brackets.",
    "# Torque and speed of opposite signs: the load drives the actuator.",
)


class _Column(NamedTuple):
    """Where a quantity stands, its heading, and the SI value of its unit."""

    quantity: str
    place: int
    heading: str
    factor: float


def duty_template() -> str:
    """A short duty to fill in, as text of a CSV file: a step of a knee."""
    rows = ((0.0, 1, 0.5), (0.1, 6, 1.0), (0.3, 4.5, -2.0), (0.5, -1, -3.5), (0.7, -1.5, 4.0))
    lines = [f"{t:g},{torque:g},{speed:g}" for t, torque, speed in (*rows, (1.0, 1, 0.5))]
    return "\n".join([*_TEMPLATE_HEAD, "time [s],torque [N*m],speed [rad/s]", *lines, ""])


def read_columns(text: str) -> DutyColumns:
    """The columns of ``time=t [ms],torque=tau [N*m]``, in any order, none or all of the three.

    Raises
    ------
    UsageError
        For anything else.
    """
    found: dict[str, str] = {}
    for part in text.split(","):
        name, equals, column = (piece.strip() for piece in part.partition("="))
        if name not in _NAMES or not equals or not column or name in found:
            raise UsageError(
                f"--duty-columns {text!r} names the columns like "
                '"time=t [ms],torque=tau [N*m],speed=dq [deg/s]", each once.'
            )
        found[name] = column
    return DutyColumns(**found)


def read_duty(path: Path, columns: DutyColumns | None = None) -> DutyLog:
    """Read a duty.

    Parameters
    ----------
    path : Path
        Columns apart by commas, semicolons or tabs, under one line of headings such as
        ``time [s],torque [N*m],speed [rad/s]``; lines before that begin with ``#``. Units may
        stand in round brackets, or behind the name as in ``speed_rpm``. Other columns are left
        alone. Samples need not be even.
    columns : DutyColumns, optional
        Which columns are meant, and their units, where the headings do not say.

    Raises
    ------
    UsageError
        When there is no such file, or it cannot be read.
    DesignError
        When it is no duty: a column or a unit missing, a cell that is no finite number, a time
        that does not rise, a gap in even rows but for rest, fewer than two rows or too many,
        values no joint has. The message names line and column.
    """
    asked = columns or DutyColumns()
    with open_regular_file(path) as stream:
        stamp = hashlib.sha256()
        while piece := stream.read(_BYTES):
            stamp.update(piece)
        stream.seek(0)
        text = _text(stream)
        head, delimiter, line = _headings(path, text)
        found = [_column(path, head, name, getattr(asked, name)) for name in _NAMES]
        read = _numbers(path, text, delimiter, [one.place for one in found], len(head))
    if read is None:
        _refuse_first_wrong(path, line, delimiter, found, len(head))
    log = DutyLog(path.name, f"{stamp.hexdigest()} {asked}", line + 1, *_scaled(read, found))
    _judge(path, log, found)
    return log


def _text(stream: BinaryIO) -> io.TextIOWrapper:
    return io.TextIOWrapper(stream, encoding="utf-8-sig", errors="replace", newline=None)


def _headings(path: Path, text: io.TextIOWrapper) -> tuple[list[str], str, int]:
    """The cells of the line of headings, what parts them, and its number."""
    number = 0
    while True:
        line = text.readline(_LONGEST_LINE)
        number += 1
        if not line:
            raise DesignError(
                f"{path} is empty; a duty begins with the line time [s],torque [N*m],speed [rad/s]."
            )
        if line.strip() and not line.startswith("#"):
            break
    if "\0" in line or "\ufffd" in line:
        raise DesignError(f"{path} is not a text file in UTF-8; save it as CSV in UTF-8.")
    delimiter = max(_DELIMITERS, key=line.count)
    cells = next(csv.reader([line], delimiter=delimiter))
    return [cell.strip() for cell in cells], delimiter, number


def _column(path: Path, head: list[str], quantity: str, wanted: str) -> _Column:
    """The column of a quantity, by the name that is wanted or by its usual ones."""
    dimension, usual = _NAMES[quantity]
    name, unit = _split(wanted)
    if wanted:
        places = [k for k, cell in enumerate(head) if cell == wanted]
        places = places or [k for k, cell in enumerate(head) if _split(cell)[0] == name]
    else:
        places = [k for k, cell in enumerate(head) if _usual(cell, quantity)[0].lower() in usual]
    if len(places) != 1:
        there = ", ".join(head[:12]) + (", ..." if len(head) > 12 else "")
        if len(places) > 1:
            fault = f"has {len(places)} columns for {quantity}"
        elif wanted:
            fault = f"has no column '{wanted}' for {quantity}{did_you_mean(wanted, head)}"
        else:
            fault = f"has no column named {' or '.join(usual[:2])}"
        if all(map(_is_number, head)):
            raise DesignError(
                f"{path} has no line of headings; put time [s],torque [N*m],speed [rad/s] first."
            )
        raise DesignError(
            f"{path} {fault}; it has {there}. Name the one that is meant"
            f"{_example(quantity, dimension, [head[k] for k in places] or head)}."
        )
    place = places[0]
    own = (_split if wanted else partial(_usual, quantity=quantity))(head[place])[1]
    if unit and own and unit != own and head[place] != wanted:
        raise DesignError(
            f"{path}: column '{head[place]}' says {own}, and duty_columns says {unit}; keep one."
        )
    return _Column(quantity, place, head[place], _factor(path, head[place], unit or own, dimension))


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _example(quantity: str, dimension: Dimension, head: list[str]) -> str:
    """How a column is named, by the first whose unit is of its dimension."""
    for cell in head:
        with suppress(DesignError):
            parse_quantity(f"1 {_split(cell)[1]}", dimension)
            return (
                f', as in duty_columns = {{{quantity} = "{cell[:40]}"}} or --duty-columns '
                f'"{quantity}={cell[:40]}"'
            )
    return f', with its unit, as in --duty-columns "{quantity}=NAME [{dimension.unit}]"'


def _split(heading: str) -> tuple[str, str]:
    """Name and unit of a heading such as ``speed [rad/s]``."""
    name, bracket, rest = heading.strip().partition("[")
    return name.strip(), rest.rstrip("] ").strip() if bracket else ""


def _usual(heading: str, quantity: str) -> tuple[str, str]:
    """The same, of ``speed (rpm)`` and ``speed_rpm`` too where speed is looked for."""
    found = _IN_ROUND.fullmatch(heading)
    if found and found[1].lower() in _NAMES[quantity][1]:
        return found[1], found[2]
    for name in _NAMES[quantity][1]:
        for ending, unit in _ENDINGS[quantity].items():
            if heading.lower() == name + ending:
                return name, unit
    return _split(heading)


def _factor(path: Path, heading: str, unit: str, dimension: Dimension) -> float:
    if not unit:
        raise DesignError(
            f"{path}: column '{heading}' has no unit; write it like "
            f"'{_split(heading)[0]} [{dimension.unit}]', or name it in duty_columns."
        )
    try:
        return parse_quantity(f"1 {unit}", dimension)
    except DesignError as error:
        raise DesignError(
            f"{path}: column '{heading}' must be a {dimension.name}: {error.message.rstrip('.')}."
        ) from None


class _Counted:
    """Lines of a text, counted; a blank one is not passed on as a row would be."""

    def __init__(self, text: io.TextIOWrapper) -> None:
        self._text = text
        self.rows = 0
        self.blank_inside = False
        self._blank = False

    def __iter__(self) -> Iterator[str]:
        while line := self._text.readline(_LONGEST_LINE):
            if not line.strip():
                self._blank = True
                continue
            self.blank_inside |= self._blank
            self.rows += 1
            yield line


def _numbers(
    path: Path, text: io.TextIOWrapper, delimiter: str, places: list[int], width: int
) -> list[FloatArray] | None:
    """The columns, or None where a cell is no finite number or a line is blank or short."""
    lines = _Counted(text)
    feed = iter(lines)
    pieces = []
    while True:
        before = lines.rows
        piece = [line for _, line in zip(range(_PIECE), feed, strict=False)]
        if not piece:
            break
        if lines.rows > MOST_ROWS:
            raise DesignError(
                f"{path} has more than {MOST_ROWS:,} rows; leave rows out, or cut the duty into "
                "one cycle."
            )
        try:
            found = np.loadtxt(
                piece,
                delimiter=delimiter,
                usecols=places,
                ndmin=2,
                comments=None,
                quotechar='"',
            )
        except (ValueError, IndexError):
            return None
        if len(found) != lines.rows - before or not np.all(np.isfinite(found)):
            return None
        if any(_cells_beyond(line, delimiter, width) for line in piece):
            return None
        pieces.append(found)
    if lines.blank_inside:
        return None
    if not pieces:
        raise DesignError(f"{path} has headings and no rows; a duty needs two or more.")
    return [np.concatenate([piece[:, k] for piece in pieces]) for k in range(len(places))]


def _cells_beyond(line: str, delimiter: str, width: int) -> int:
    """Cells of a line beyond those of the headings; an empty one at its end is none."""
    if line.count(delimiter) < width:
        return 0
    cells = next(csv.reader([line], delimiter=delimiter))
    return max(len(cells) - width - (not cells[-1].strip()), 0)


def _refuse_first_wrong(
    path: Path, head_line: int, delimiter: str, columns: list[_Column], width: int
) -> NoReturn:
    """Say which cell is the first that is no finite number."""
    with open_regular_file(path) as stream:
        text = _text(stream)
        for number, line in enumerate(iter(lambda: text.readline(_LONGEST_LINE), ""), 1):
            if number <= head_line:
                continue
            where = f"{path}, line {number}"
            if not line.strip():
                raise DesignError(f"{where} is empty; take it out, or fill in its row.")
            try:
                cells = next(csv.reader([line], delimiter=delimiter))
            except (csv.Error, StopIteration):
                raise DesignError(f"{where} cannot be read as CSV.") from None
            if more := _cells_beyond(line, delimiter, width):
                raise DesignError(
                    f"{where} has {width + more} cells, and the headings {width}; take the others "
                    "out, and where decimals are written with commas save with decimal points."
                )
            for column in columns:
                _refuse_cell(where, cells, column, width)
    raise DesignError(f"{path} cannot be read as numbers; save the duty as CSV.")


def _refuse_cell(where: str, cells: list[str], column: _Column, width: int) -> None:
    if column.place >= len(cells):
        raise DesignError(
            f"{where} has {len(cells)} cells, and the headings {width}: there is no "
            f"'{column.heading}'; complete the line, or take it out."
        )
    cell = cells[column.place].strip()
    if not cell:
        raise DesignError(
            f"{where}: a gap, '{column.heading}' is empty; fill it in, or take the line out."
        )
    try:
        # Python takes 1_000, numpy does not.
        value = float(cell.replace("_", "?"))
    except ValueError:
        raise DesignError(
            f"{where}: {shown(cell, 40)} in column '{column.heading}' is no number; write it with "
            "a decimal point and without a unit."
        ) from None
    if not math.isfinite(value):
        raise DesignError(
            f"{where}: column '{column.heading}' is {cell[:20]}; take the line out, or give a "
            "finite number."
        )


def _scaled(read: list[FloatArray], columns: list[_Column]) -> tuple[FloatArray, ...]:
    """Time from the first row on, torque and speed, SI."""
    time, torque, speed = (
        values * column.factor for values, column in zip(read, columns, strict=True)
    )
    return time, torque, speed


def _judge(path: Path, log: DutyLog, columns: list[_Column]) -> None:
    """Refuse rows that are no duty, naming line and column."""
    if log.rows < 2:
        raise DesignError(
            f"{path} has one row; a duty needs two or more. For one steady load write duty = "
            '[{torque = "30 N*m", speed = "5 rad/s", share = 1.0}].'
        )
    heading = columns[0].heading
    wrong = first_that_does_not_rise(log.time)
    if wrong is not None:
        here, before = (log.time[k] / columns[0].factor for k in (wrong, wrong - 1))
        fault = (
            f"{here:.9g} in column '{heading}' stands in the line before too; keep one row for "
            "each time"
            if here == before
            else f"{here:.9g} in column '{heading}' does not rise above {before:.9g} in the line "
            "before; sort the rows by time"
        )
        raise DesignError(f"{path}, line {log.line(wrong)}: {fault}.")
    rests = (log.torque == 0.0) & (log.speed == 0.0)
    # Between two rows of rest there is rest.
    gap = gap_in_even_rows(log.time, _EVEN_FROM, rests[1:] & rests[:-1])
    if gap is not None:
        raise DesignError(
            f"{path}, line {log.line(gap[0])}: a gap of {gap[1]:.6g} s in column '{heading}', "
            f"where rows are {gap[2]:.6g} s apart; fill it in with rows of what happens "
            "there, rest included."
        )
    for values, most, column, dimension in (
        (log.torque, MOST_TORQUE, columns[1], TORQUE),
        (log.speed, MOST_SPEED, columns[2], LOAD_SPEED),
    ):
        large = np.flatnonzero(np.abs(values) > most)
        if large.size:
            row = int(large[0])
            raise DesignError(
                f"{path}, line {log.line(row)}: column '{column.heading}' is "
                f"{format_quantity(float(values[row]), dimension)}, more than any joint has "
                f"({format_quantity(most, dimension)}); is the unit right?"
            )
    if not (np.any(log.torque) or np.any(log.speed)):
        raise DesignError(
            f"{path}: columns '{columns[1].heading}' and '{columns[2].heading}' are 0 in every "
            "row, which is rest alone; give rows of what the joint does, or leave the duty out."
        )
