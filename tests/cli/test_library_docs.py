"""The page of the library and the example notebooks are true: what they show runs."""

import ast
import json
import os
import pkgutil
import re
import subprocess
import sys
from pathlib import Path

import pytest

import cqdd_design as cq
import cqdd_design.roads

REPOSITORY = Path(__file__).resolve().parents[2]
PAGE = REPOSITORY / "docs" / "library.md"
BOOKS = sorted((REPOSITORY / "examples").glob("*.ipynb"))


def snippets(page: Path = PAGE) -> list[str]:
    text = page.read_text(encoding="utf-8")
    return re.findall(r"^```python\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL)


def cells(book: Path, kind: str) -> list[str]:
    found = json.loads(book.read_text(encoding="utf-8"))["cells"]
    return ["".join(cell["source"]) for cell in found if cell["cell_type"] == kind]


def names_used(code: str) -> set[str]:
    """Public names that code asks of the library."""
    return {
        node.attr
        for node in ast.walk(ast.parse(code))
        if isinstance(node, ast.Attribute)
        and isinstance(node.value, ast.Name)
        and node.value.id == "cq"
    }


def told_by(code: str, folder: Path) -> str:
    """What a program prints in an empty folder, where it leaves nothing."""
    path = os.pathsep.join([str(REPOSITORY), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(
        [sys.executable, "-W", "error::UserWarning", "-c", code],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert not list(folder.iterdir())
    return done.stdout


@pytest.mark.deep
def test_every_snippet_of_the_page_runs(tmp_path):
    """In order, as one program."""
    told = told_by("\n".join(snippets()), tmp_path)
    assert 'torque: 36.0 has no unit; write it like "36.0 N*m".' in told
    assert "\nNone\n500.0\n" in told


@pytest.mark.deep
def test_the_snippet_of_the_readme_runs(tmp_path):
    (snippet,) = snippets(REPOSITORY / "README.md")
    assert told_by(snippet, tmp_path).startswith("Checked cqdd-10: does NOT meet")


@pytest.mark.deep
def test_type_checkers_know_the_calls(tmp_path):
    """By mypy, as a user of the package runs it: what is wrong is seen, and nothing else."""
    code = (
        "import cqdd_design as cq",
        'design: cq.Design = cq.load("cqdd-10")',
        'cq.report(design, out="a.html").verdict.headline[0].title.upper()',
        "asked = cq.Requirements(ratio=10)",
        'cq.size(requirements=asked, peak_torque="3 N*m", yield_share=0.9).design.replacing({})',
        "cq.size(10, peak_torque=3.0)  # wrong: no unit",
        'cq.size(10, peek_torque="3 N*m")  # wrong: no such requirement',
        'cq.simulate(design, load="pendullum")  # wrong: no such load',
        "cq.check(design).meat  # wrong: no such attribute",
    )
    path = tmp_path / "use.py"
    path.write_text("\n".join(code))
    cache = REPOSITORY / ".mypy_cache"
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", f"--cache-dir={cache}", str(path)],
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        check=False,
    )
    wrong = {number for number, line in enumerate(code, 1) if "# wrong" in line}
    assert {int(n) for n in re.findall(r"use\.py:(\d+): error", done.stdout)} == wrong, done.stdout


def test_the_page_tells_every_public_name_and_its_result():
    text = PAGE.read_text(encoding="utf-8")
    for name in cq.__all__:
        assert name.startswith("_") or f"`cq.{name}" in text, name
        told = getattr(getattr(cq, name), "__annotations__", {}).get("return")
        if told:
            assert re.search(rf"(?m)^\| `cq\.{name}\(.*\| `{told}` \|", text), name


def test_the_page_tells_every_error():
    from cqdd_design import errors

    text = PAGE.read_text(encoding="utf-8")
    family = [errors.CqddError]
    for kind in family:
        family += [one for one in kind.__subclasses__() if one.__module__ == errors.__name__]
    told = re.findall(r"(?m)^\| `(\w+Error)` \|", text)
    assert sorted(told) == sorted(kind.__name__ for kind in family[1:])


def test_pages_and_notebooks_ask_for_names_that_exist():
    shown = [*snippets(), *(code for book in BOOKS for code in cells(book, "code"))]
    assert len(shown) > 30
    assert set().union(*map(names_used, shown)) <= set(cq.__all__)


def test_every_road_has_a_notebook_without_outputs():
    roads = {one.name for one in pkgutil.iter_modules(cqdd_design.roads.__path__)}
    without = {"drawer", "kernels", "places", "sized_file", "telling", "torque_data"}
    assert {book.stem for book in BOOKS} == roads - without
    index = (REPOSITORY / "examples" / "README.md").read_text(encoding="utf-8")
    for book in BOOKS:
        content = json.loads(book.read_text(encoding="utf-8"))
        assert all(not cell.get("outputs") for cell in content["cells"]), book.name
        assert all(cell.get("execution_count") is None for cell in content["cells"]), book.name
        assert f"cq.{book.stem}(" in "\n".join(cells(book, "code"))
        assert f"[{book.stem}]({book.name})" in index


@pytest.mark.deep
@pytest.mark.parametrize("book", BOOKS, ids=lambda book: book.stem)
def test_a_notebook_runs(book, tmp_path, monkeypatch):
    """Its cells in order; the last line of each can be shown."""
    monkeypatch.chdir(tmp_path)
    space: dict[str, object] = {"__name__": "__main__"}
    shown = 0
    for code in cells(book, "code"):
        tree = ast.parse(code)
        last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
        exec(compile(tree, book.name, "exec"), space)
        if last is not None:
            value = eval(compile(ast.Expression(last.value), book.name, "eval"), space)
            html = getattr(value, "_repr_html_", None)
            assert value is None or repr(value)
            shown += html is not None and "<" in html()
    assert shown
    assert not list(tmp_path.iterdir())
