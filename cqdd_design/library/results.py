"""What calls return: frozen, told in a few lines, as a page in notebooks, as JSON, as a table."""

from __future__ import annotations

import html
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

from cqdd_design.errors import DependencyError

if TYPE_CHECKING:
    import pandas

    from cqdd_design.design import Design
    from cqdd_design.files import WrittenFile
    from cqdd_design.machine import Machine
    from cqdd_design.report.notebook import Section
    from cqdd_design.results import Check, Provenance
    from cqdd_design.verdict import Verdict

Row = Mapping[str, object]

_PAGE_HEIGHT = 640
"""Of a result in a notebook, px; what is longer scrolls."""
_FITTED = (
    "this.style.height=Math.min(this.contentDocument.documentElement.scrollHeight+8,"
    f"{2 * _PAGE_HEIGHT})+'px'"
)
"""As high as what is in it, up to twice that; where a notebook runs no scripts it scrolls."""


@dataclass(frozen=True, eq=False, repr=False)
class Result:
    """What every call returns.

    Attributes
    ----------
    design : Design
        That it is about, as the call understood it.
    warnings : tuple of str
        Sentences on what was not judged or cannot be relied on.
    files : tuple of WrittenFile
        That were written: path, kind, bytes and sha256.
    provenance : Provenance
        Version, time and hash of the design.
    """

    command: ClassVar[str] = ""

    design: Design
    warnings: tuple[str, ...]
    files: tuple[WrittenFile, ...] = field(default=(), kw_only=True)
    provenance: Provenance = field(init=False)

    def __post_init__(self) -> None:
        """Note when it was made, and of what."""
        from cqdd_design.roads.telling import provenance

        object.__setattr__(self, "provenance", provenance(self.design))

    @property
    def machine(self) -> Machine:
        """The design made concrete: bearings and motor chosen, parts laid out."""
        from cqdd_design.machine import resolve

        return resolve(self.design)

    @property
    def verdict(self) -> Verdict | None:
        """Whether the design meets its requirements; None where nobody judged."""
        return None

    @property
    def checks(self) -> tuple[Check, ...]:
        """Every line that was judged."""
        return ()

    def to_dict(self) -> dict[str, Any]:
        """The document that the command of the same name prints with ``--json``."""
        from cqdd_design.library.envelope import result_body

        return result_body(
            self.command,
            self._results(),
            design=self.design,
            checks=self.checks,
            warnings=self.warnings,
            files=self.files,
            origin=self.provenance,
        )

    def to_pandas(self) -> pandas.DataFrame:
        """The table of the result; its columns carry their unit.

        Raises
        ------
        DependencyError
            Where pandas is not installed.
        """
        return frame(self._rows())

    def __repr__(self) -> str:
        """A few lines: what it is of, the answer, the figures."""
        head = f"{type(self).__name__} {self.design.name}"
        return "\n".join([f"{head}: {self._told()}", *(f"  {line}" for line in self._figures())])

    def _repr_html_(self) -> str:
        """The same in a notebook, with the report's own pictures and tables."""
        from cqdd_design.report.notebook import notebook_page

        page = notebook_page(self.design, self.verdict, self._told(), self._sections())
        return (
            f'<iframe srcdoc="{html.escape(page)}" title="{html.escape(self.design.name)}" '
            f'style="width:100%;height:{_PAGE_HEIGHT}px;border:0" onload="{_FITTED}"></iframe>'
        )

    def _told(self) -> str:
        """What comes first, in a line."""
        return self._answer(self.checks)

    def _answer(self, lines: Sequence[Check]) -> str:
        """Whether the design will do, as commands say it, without its name."""
        from cqdd_design.verdict.judge import sentence

        return sentence("", lines).strip(": ") if lines else "not judged"

    def _figures(self) -> tuple[str, ...]:
        """A line each: the seven figures where there is a verdict."""
        judged = self.verdict
        return () if judged is None else tuple(one.told for one in judged.headline)

    def _results(self) -> Mapping[str, Any]:
        """The ``results`` of the document."""
        raise NotImplementedError

    def _rows(self) -> Sequence[Row]:
        """Rows of the table."""
        raise NotImplementedError

    def _sections(self) -> Sequence[Section]:
        """What the page shows below verdict and drawing."""
        return ()


def check_rows(lines: Sequence[Check]) -> list[Row]:
    """A row a check: the columns of the JSON that are no prose."""
    keys = ("id", "title", "status", "value", "limit", "unit", "margin", "basis", "source")
    return [{key: line.to_dict()[key] for key in keys} for line in lines]


def frame(rows: Sequence[Row] | Mapping[str, Any]) -> pandas.DataFrame:
    """A DataFrame of rows, or of columns by name."""
    try:
        import pandas
    except ImportError as error:
        raise DependencyError(
            f"to_pandas needs the Python package pandas, which is missing or broken ({error}); "
            "run `pip install pandas`, or take to_dict()."
        ) from error
    return pandas.DataFrame(rows)
