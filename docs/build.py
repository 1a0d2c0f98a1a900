"""Write the pages and files of docs/ that follow from code and tests.

    python docs/build.py            write them
    python docs/build.py --check    only compare; exit code 1 when one is out of date

* ``design.schema.json``: what ``cqdd-design schema`` prints.
* ``cli.md``: the help of every command, between its markers.
* ``validation.md``: every number of the literature that a test compares with, as compared.
"""

from __future__ import annotations

import contextlib
import io
import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path

DOCS = Path(__file__).resolve().parent
BEGIN, END = "<!-- help: written by docs/build.py -->", "<!-- end of help -->"

VALIDATION_HEAD = """\
# Validation

Numbers of the literature beside ours. This page is written by `python docs/build.py` from the
tests in `tests/published`: each row is one assertion of one test, and a row outside its tolerance
would be a failing test. Tolerances are those the source supports; inputs and full sources stand in
`tests/published/data/published_examples.csv`.
"""


def schema_file() -> str:
    """The JSON schema of design files."""
    from cqdd_design.design.schema import design_schema

    return json.dumps(design_schema(), indent=2, ensure_ascii=False) + "\n"


def cli_page() -> str:
    """cli.md with the help of every command as it is now."""
    page = (DOCS / "cli.md").read_text(encoding="utf-8")
    before, _, rest = page.partition(BEGIN)
    after = rest.partition(END)[2]
    return f"{before}{BEGIN}\n\n{''.join(_help_texts())}{END}{after}"


def _help_texts() -> Iterator[str]:
    import os

    from cqdd_design.cli.main import COMMANDS, app

    os.environ["COLUMNS"] = "88"
    for function in COMMANDS:
        name = function.__name__
        caught = io.StringIO()
        with contextlib.redirect_stdout(caught):
            app([name, "--help"], prog_name="cqdd-design", standalone_mode=False)
        text = "\n".join(line.rstrip() for line in caught.getvalue().strip().splitlines())
        yield f"### {name}\n\n```text\n{text}\n```\n\n"


class _Comparisons:
    """Pytest plugin: collects what tests compared with rows of published numbers."""

    def __init__(self) -> None:
        self.rows: dict[str, list[tuple[dict[str, str], str]]] = {}

    def pytest_assertion_pass(self, item: object, lineno: int, orig: str, expl: str) -> None:
        parameters = getattr(getattr(item, "callspec", None), "params", {})
        row = parameters.get("row")
        compared = re.match(r"(?:np\.float64\()?(-?[\d.]+(?:e[+-]?\d+)?)\)? == ", expl)
        if isinstance(row, dict) and compared and 'row["value"]' in orig:
            found = self.rows.setdefault(row["group"], [])
            if all(known is not row and known != row for known, _ in found):
                found.append((row, compared[1]))


def validation_page() -> str:
    """The page of validation tables, from a run of tests/published."""
    import pytest

    seen = _Comparisons()
    quiet = io.StringIO()
    with contextlib.redirect_stdout(quiet):
        code = pytest.main(
            [
                str(DOCS.parent / "tests" / "published"),
                "-q",
                "-p",
                "no:cacheprovider",
                "-p",
                "no:xdist",
                "-o",
                "enable_assertion_pass_hook=true",
            ],
            plugins=[seen],
        )
    if code != 0:
        raise SystemExit(f"tests/published does not pass:\n{quiet.getvalue()}")
    parts = [VALIDATION_HEAD]
    for group, found in sorted(seen.rows.items()):
        parts += [
            f"\n## {group}\n\n| case | quantity | published | ours | difference | tolerance |"
        ]
        parts += ["\n|---|---|---|---|---|---|\n"]
        for row, ours in found:
            value, tolerance = float(row["value"]), float(row["tol"])
            unit = "" if row["unit"] == "-" else f" {row['unit']}"
            # What rounding leaves of an exact agreement differs from machine to machine.
            difference = float(ours) - value
            shown = "0" if abs(difference) < 1e-3 * tolerance else f"{difference:+.2g}"
            quantity = row["quantity"].replace("|", "\\|").partition(" (CN")[0]
            parts.append(
                f"| {row['case']} | {quantity} | {value:.7g}{unit} | {float(ours):.6g} "
                f"| {shown} | ±{tolerance:g} |\n"
            )
        sources = dict.fromkeys(row["source"] for row, _ in found)
        parts += ["\n", *(f"Source: {source}.\n" for source in sources)]
    return "".join(parts)


PAGES = {
    "design.schema.json": schema_file,
    "cli.md": cli_page,
    "validation.md": validation_page,
}


def main(arguments: list[str]) -> int:
    """Write or compare every page."""
    stale = []
    for name, make in PAGES.items():
        path, text = DOCS / name, make()
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            stale.append(name)
            if "--check" not in arguments:
                path.write_text(text, encoding="utf-8")
    if "--check" in arguments and stale:
        print(f"out of date: {', '.join(stale)}; run `python docs/build.py`")
        return 1
    print(f"wrote {', '.join(stale)}" if stale else "every page is up to date")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
