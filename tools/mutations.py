"""Mutation campaign: one wrong sign, factor or unit at a time, each against the tests that see it.

    python tools/mutations.py --count 120 --seed 1 --out mutations.json
    python tools/mutations.py --only "gearbox/hertz.py:41:0" # one again, with pytest's output
    python tools/mutations.py --list --count 120 --seed 1    # what would be tried

Mutations are drawn without replacement with a fixed seed, from every formula of the package, in
proportion to what each room holds of them. A mutation dies when a test fails on it. Rooms that only
lay out pictures are left out: a line two pixels further left is no formula. Mutations that change
nothing anyone could measure are listed in `tools/mutations_equivalent.txt` with the reason, and do
not count; every other survivor is a test to write.

The work is done in a copy of the working tree. The tests tried are, in this order: the doctests of
the mutated module, the test files that import it, those that import a module that imports it, and
the room's own by name; the first failure ends the run.
"""

from __future__ import annotations

import argparse
import ast
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "cqdd_design"
EQUIVALENT = Path(__file__).with_name("mutations_equivalent.txt")

#: What lays out pictures, words and command lines: no formulas.
NO_FORMULAS = ("__main__.py", "cli/", "environment.py", "errors.py", "exporting/sheets/", "report/")

#: Test files of a room beside those that import its modules, nearest first.
ROOM_TESTS = {
    "actuator": ("test_actuator_*", "test_bench*", "test_recording*", "test_calibration*"),
    "catalog": ("test_catalog_*", "test_cli_lookups*", "test_gearbox_*", "test_actuator_param*"),
    "design": ("test_design_*", "test_motor_file*", "test_own_motor*", "test_cli_bad_input*"),
    "exporting": (
        "test_exporting_*",
        "test_torque_c_header*",
        "test_cli_torque_export*",
        "test_torque_clients*",
    ),
    "files": ("test_files_*",),
    "gearbox": (
        "test_report_engine*",
        "test_gearbox_*",
        "test_contact_*",
        "test_life*",
        "test_losses*",
        "test_precision*",
    ),
    "geometry": ("test_geometry_*", "test_gearbox_*", "test_contact_*", "test_exporting_dxf*"),
    "machine": (
        "test_machine*",
        "test_report_engine*",
        "test_solids_*",
        "test_gearbox_*",
        "test_sizing_*",
    ),
    "planetary": ("test_planetary_*", "test_sizing_comparison*"),
    "roads": ("test_cli_size*", "test_export_stages*", "test_cli_*"),
    "sizing": ("test_sizing_*",),
    "solids": ("test_solids_*", "test_exporting_step*", "test_exporting_meshes*"),
    "torque": ("test_torque_*",),
    "units": ("test_units*", "test_design_files*"),
}
#: Constants up to this guard against rounding and division by zero; they are no factors.
GUARD = 1e-8
MOST_FILES = 12
MOST_SECONDS = 400.0

_SWAPS: dict[type[ast.operator], tuple[str, str]] = {
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
    ast.Mult: ("*", "/"),
    ast.Div: ("/", "*"),
    ast.Pow: ("**", "*"),
}
_TWINS = {"sin": "cos", "cos": "sin", "minimum": "maximum", "maximum": "minimum", "sinh": "cosh"}
_TEXT_CALLS = {"range", "round", "linspace", "format", "zip", "enumerate", "field", "isclose"}


@dataclass(frozen=True)
class Mutation:
    """One changed place.

    Attributes
    ----------
    file : str
        Below the package.
    line, column : int
        Of the changed text, from 1 and from 0.
    before, after : str
        The line as it is, and as it is tried.
    """

    file: str
    line: int
    column: int
    before: str
    after: str

    @property
    def name(self) -> str:
        """Such as ``gearbox/hertz.py:41:12``."""
        return f"{self.file}:{self.line}:{self.column}"

    @property
    def room(self) -> str:
        """The room that holds it."""
        return self.file.split("/")[0]

    @property
    def content(self) -> str:
        """What names it after lines have moved: the file, and both texts."""
        return f"{self.file} | {self.before.strip()} | {self.after.strip()}"


def mutations_of(path: Path) -> Iterator[Mutation]:
    """Every single-line mutation of one module."""
    text = path.read_text(encoding="utf-8")
    lines = text.splitlines()
    name = path.relative_to(PACKAGE).as_posix()
    tree = ast.parse(text)
    silent = _silent_lines(tree)
    for node in ast.walk(tree):
        line = getattr(node, "lineno", None)
        if line is None or line in silent:
            continue
        for first, last, new in _edits(node, lines):
            before = lines[line - 1]
            after = before[:first] + new + before[last:]
            if after != before:
                yield Mutation(name, line, first, before, after)


def _silent_lines(tree: ast.Module) -> set[int]:
    """Lines of annotations, texts for people, raised errors and calls that count or round."""
    silent: set[int] = set()
    for node in ast.walk(tree):
        quiet: list[ast.AST] = []
        if isinstance(node, ast.Raise | ast.Assert | ast.JoinedStr):
            quiet.append(node)
        elif isinstance(node, ast.AnnAssign):
            quiet.append(node.annotation)
        elif isinstance(node, ast.FunctionDef):
            quiet += [one.annotation for one in node.args.args if one.annotation is not None]
            quiet += [one.annotation for one in node.args.kwonlyargs if one.annotation is not None]
            quiet += [] if node.returns is None else [node.returns]
        elif isinstance(node, ast.Call) and _called(node) in _TEXT_CALLS:
            quiet.append(node)
        for one in quiet:
            silent |= set(range(one.lineno, (one.end_lineno or one.lineno) + 1))  # type: ignore[attr-defined]
    return silent


def _called(node: ast.Call) -> str:
    return node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")


def _edits(node: ast.AST, lines: list[str]) -> Iterator[tuple[int, int, str]]:
    """Columns to replace on the node's first line, and by what."""
    if isinstance(node, ast.BinOp) and node.left.end_lineno == node.right.lineno == node.lineno:
        found = _SWAPS.get(type(node.op))
        if found is None or _is_text(node.left) or _is_text(node.right):
            return
        first = _bytes_to_column(lines[node.lineno - 1], node.left.end_col_offset or 0)
        last = _bytes_to_column(lines[node.lineno - 1], node.right.col_offset)
        gap = lines[node.lineno - 1][first:last]
        place = gap.find(found[0])
        if place >= 0 and gap.strip(" ()") == found[0]:
            yield first + place, first + place + len(found[0]), found[1]
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        if not isinstance(node.operand, ast.Constant) or node.operand.value != 1:
            first = _bytes_to_column(lines[node.lineno - 1], node.col_offset)
            yield first, first + 1, "+"
    elif isinstance(node, ast.Constant) and isinstance(node.value, float):
        if abs(node.value) > GUARD:
            first = _bytes_to_column(lines[node.lineno - 1], node.col_offset)
            last = _bytes_to_column(lines[node.lineno - 1], node.end_col_offset or 0)
            yield first, last, repr(_other(node.value))
    elif isinstance(node, ast.Attribute) and node.attr in _TWINS and node.end_lineno == node.lineno:
        last = _bytes_to_column(lines[node.lineno - 1], node.end_col_offset or 0)
        yield last - len(node.attr), last, _TWINS[node.attr]


def _is_text(node: ast.AST) -> bool:
    """Whether joining, not adding: strings, lists and tuples."""
    if isinstance(node, ast.Constant):
        return isinstance(node.value, str | bytes)
    return isinstance(node, ast.JoinedStr | ast.List | ast.Tuple | ast.ListComp | ast.BitOr)


def _other(value: float) -> float:
    """A factor or unit gone wrong: a thousandfold for powers of ten, else a quarter more."""
    text = f"{abs(value):e}"
    return value * 1e3 if text.startswith("1.000000e") and abs(value) != 1.0 else value * 1.25


def _bytes_to_column(line: str, offset: int) -> int:
    return len(line.encode("utf-8")[:offset].decode("utf-8"))


def candidates() -> dict[str, list[Mutation]]:
    """All mutations by room."""
    rooms: dict[str, list[Mutation]] = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        name = path.relative_to(PACKAGE).as_posix()
        if name.startswith(NO_FORMULAS):
            continue
        for one in mutations_of(path):
            rooms.setdefault(one.room, []).append(one)
    return rooms


def _equivalent() -> set[str]:
    """Contents of the mutations that were looked at and change nothing; the reason follows `#`."""
    if not EQUIVALENT.exists():
        return set()
    rows = EQUIVALENT.read_text(encoding="utf-8").splitlines()
    return {row.partition("  # ")[0].strip() for row in rows if row and not row.startswith("#")}


def draw(count: int, seed: int) -> list[Mutation]:
    """`count` mutations, each room by its share and at least two of each.

    Those known to change nothing that can be measured leave the draw, which stays as it is.
    """
    rooms, known = candidates(), _equivalent()
    total = sum(map(len, rooms.values()))
    chosen: list[Mutation] = []
    for name in sorted(rooms):
        share = max(2, round(count * len(rooms[name]) / total))
        # Seeded by room, so that a change in one room leaves the draws of the others.
        chosen += random.Random(f"{seed}/{name}").sample(rooms[name], min(share, len(rooms[name])))
    return [one for one in chosen if one.content not in known]


def tests_for(mutation: Mutation) -> list[str]:
    """Test files to try, nearest first, after the doctests of the module itself."""
    module = f"cqdd_design/{mutation.file}"
    dotted = module.removesuffix(".py").replace("/", ".")
    first = _importers(dotted, ROOT / "tests")
    users = [one for one in _importers(dotted, PACKAGE) if not one.endswith("__init__.py")]
    second: list[str] = []
    for one in users:
        second += _importers(one.removesuffix(".py").replace("/", "."), ROOT / "tests")
    named: list[str] = []
    for pattern in ROOM_TESTS.get(mutation.room, ()):
        named += sorted(
            str(path.relative_to(ROOT)) for path in (ROOT / "tests").glob(f"*/{pattern}.py")
        )
    stem = Path(mutation.file).stem
    found = list(dict.fromkeys([*first, *named, *second]))
    found.sort(key=lambda name: (name not in first, stem not in name, "/cli/" in name))
    return [module, *found[:MOST_FILES]]


def _importers(dotted: str, folder: Path) -> list[str]:
    """Files that import a module, by its name in an import statement."""
    parent, _, leaf = dotted.rpartition(".")
    wanted = re.compile(
        rf"from {re.escape(dotted)} import|from {re.escape(parent)} import [^\n]*\b{leaf}\b"
    )
    found = []
    for path in sorted(folder.rglob("*.py")):
        is_test = path.name.startswith("test_") or folder == PACKAGE
        if is_test and wanted.search(path.read_text(encoding="utf-8")):
            found.append(str(path.relative_to(ROOT)))
    return found


def verdict(mutation: Mutation, copy: Path, *, shown: bool = False) -> tuple[str, float]:
    """``killed``, ``survived`` or ``timeout``, and the seconds it took."""
    path = copy / "cqdd_design" / mutation.file
    original, stamp = path.read_bytes(), path.stat()
    lines = original.decode("utf-8").splitlines(keepends=True)
    lines[mutation.line - 1] = mutation.after + "\n"
    command = [
        *(sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "-p", "no:xdist"),
        *tests_for(mutation),
    ]
    began = time.monotonic()
    environment = {**os.environ, "PYTHONPATH": str(copy), "PYTHONDONTWRITEBYTECODE": "1"}
    kernels = tempfile.TemporaryDirectory()
    if b"njit" in original:
        # numba keeps a compiled caller when a function it calls in another file has changed.
        environment["NUMBA_CACHE_DIR"] = kernels.name
    try:
        path.write_bytes("".join(lines).encode("utf-8"))
        done = subprocess.run(
            command,
            cwd=copy,
            env=environment,
            stdout=None if shown else subprocess.DEVNULL,
            stderr=None if shown else subprocess.DEVNULL,
            timeout=MOST_SECONDS,
            check=False,
        )
        found = "survived" if done.returncode in (0, 5) else "killed"
    except subprocess.TimeoutExpired:
        found = "timeout"
    finally:
        kernels.cleanup()
        path.write_bytes(original)
        # The compiled kernels of the untouched file stay valid.
        os.utime(path, ns=(stamp.st_atime_ns, stamp.st_mtime_ns))
    return found, time.monotonic() - began


def main() -> int:
    """Run the campaign, or a part of it."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--count", type=int, default=120)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", help="one mutation by its name, with pytest's output")
    parser.add_argument("--list", action="store_true", help="print what would be tried")
    parser.add_argument("--part", default="1/1", help="such as 2/3: the second third")
    parser.add_argument("--out", type=Path)
    chosen = parser.parse_args()
    if chosen.only:
        drawn = [one for found in candidates().values() for one in found if one.name == chosen.only]
    else:
        part, _, parts = chosen.part.partition("/")
        drawn = draw(chosen.count, chosen.seed)[int(part) - 1 :: int(parts)]
    if chosen.list:
        for one in drawn:
            print(f"{one.name}\n    {one.before.strip()}\n    {one.after.strip()}")
        return 0
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "tree"
        shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns(".git", ".venv", "node_modules"))
        for one in drawn:
            found, seconds = verdict(one, copy, shown=bool(chosen.only))
            rows.append({**asdict(one), "verdict": found, "seconds": round(seconds, 1)})
            print(f"{found:9}{seconds:6.1f} s  {one.content}", flush=True)
            if chosen.out:
                chosen.out.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    dead = sum(row["verdict"] == "killed" for row in rows)
    print(f"{dead} of {len(rows)} mutations died ({100.0 * dead / max(len(rows), 1):.1f} %)")
    return 0 if dead >= 0.95 * len(rows) else 1


if __name__ == "__main__":
    sys.exit(main())
