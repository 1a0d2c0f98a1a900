"""Calls that write files: `export` and `report`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from cqdd_design.library.actuators import CalibrationLike, specimen_given
from cqdd_design.library.calls import names, road, si_value, text, whole
from cqdd_design.library.inputs import DesignLike, PathLike, design_of, path_of, source_of
from cqdd_design.library.results import Result, Row, check_rows

if TYPE_CHECKING:
    from cqdd_design.report.notebook import Section
    from cqdd_design.results import Check
    from cqdd_design.roads.report import WrittenReport
    from cqdd_design.units import Quantity
    from cqdd_design.verdict import Verdict


@dataclass(frozen=True, eq=False, repr=False)
class Exported(Result):
    """What `export` returns; `to_pandas` has a row a file.

    Attributes
    ----------
    kinds : tuple of str
        That were written.
    """

    command: ClassVar[str] = "export"

    kinds: tuple[str, ...]

    def _told(self) -> str:
        return f"{len(self.files)} files"

    def _figures(self) -> tuple[str, ...]:
        files = (f"{one.path} ({one.kind}, {one.bytes:,} bytes)" for one in self.files)
        return (*files, *(f"warning: {one}" for one in self.warnings))

    def _results(self) -> Mapping[str, Any]:
        return {"kinds": list(self.kinds)}

    def _rows(self) -> Sequence[Row]:
        return [one.to_dict() for one in self.files]

    def _sections(self) -> Sequence[Section]:
        from cqdd_design.report.notebook import table

        rows = [(str(one.path), one.kind, f"{one.bytes:,}") for one in self.files]
        files = table("Files", ("File", "Kind", "#Bytes"), rows)
        if not self.warnings:
            return (files,)
        return table("What to know of them", ("Warning",), [(one,) for one in self.warnings]), files


@road
def export(
    design: DesignLike,
    to: str | Sequence[str] = "dxf,step",
    *,
    out: PathLike | None = None,
    dxf_version: Literal["R12", "R2000", "R2010"] = "R2000",
    dxf_style: Literal["polyline", "entities"] = "polyline",
    step_schema: Literal["AP214", "AP242"] = "AP214",
    gcode_dialect: Literal["iso", "sodick"] = "iso",
    passes: int = 4,
    tab_length: Quantity | None = None,
    prices: PathLike | None = None,
    seed: int | None = None,
    calibration: CalibrationLike | None = None,
    force: bool = False,
    progress: Callable[[str], None] | None = None,
) -> Exported:
    """Files for makers (DXF, EDM, STEP, ...) and simulators.

    Parameters
    ----------
    design : Design or path
        A path is that of a design file; a bare name may be an example's.
    to : sequence of str
        Kinds of file; docs/cli.md lists them.
    out : path, optional
        Folder; default ``exports/NAME``, whose files are replaced.
    dxf_version : {"R12", "R2000", "R2010"}
        Dialect of DXF.
    dxf_style : {"polyline", "entities"}
        Contours closed, or as lines and arcs end to end.
    step_schema : {"AP214", "AP242"}
        Protocol of STEP.
    gcode_dialect : {"iso", "sodick"}
        Offsets D, set on the control, or H, set in the program.
    passes : int
        Of the wire along a contour in G-code: the rough cut and up to three skim cuts.
    tab_length : quantity, optional
        Left uncut in G-code until held; default 3 mm.
    prices : path, optional
        CSV file of designation, price, currency and vendor for the bill of materials.
    seed : int, optional
        Gearbox of simulators drawn from the tolerances; default perfect parts.
    calibration : path or Calibrated, optional
        Fitted factors for simulators.
    force : bool
        Replace files in a named folder.
    progress : callable, optional
        Told in a few words what is written.

    Returns
    -------
    Exported
        `files`: path, kind, bytes and sha256 of each.

    Raises
    ------
    UsageError
        No such kind or dialect; an option that no kind asked for reads; a file exists; the folder
        cannot be written.
    DesignError, GeometryError
        No valid design, or no such part of it.
    ReadBackError
        A file is not the part that it should be.
    DependencyError
        A library that a kind needs is missing.

    Notes
    -----
    docs/how-to-edm.md and docs/how-to-solids.md say how exact each kind is, and how it is checked.

    Examples
    --------
    >>> import tempfile
    >>> import cqdd_design as cq
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     written = cq.export("cqdd-10", "dxf", out=folder)
    >>> {one.kind for one in written.files}
    {'dxf'}
    """
    from cqdd_design.exporting import ExportOptions
    from cqdd_design.exporting.bill.prices import read_prices
    from cqdd_design.exporting.kinds import read_kinds
    from cqdd_design.exporting.options import DEFAULTS, MOST_PASSES, refuse_unread
    from cqdd_design.roads.export import export as write
    from cqdd_design.roads.export import left_out
    from cqdd_design.roads.telling import silent
    from cqdd_design.units import LENGTH

    kinds = read_kinds(names("to", to, "dxf"))
    tab = si_value("tab_length", tab_length, LENGTH, positive=True)
    options = ExportOptions(
        dxf_version=text("dxf_version", dxf_version, "R2000").upper(),
        dxf_style=text("dxf_style", dxf_style, "polyline").lower(),
        step_schema=text("step_schema", step_schema, "AP214").upper(),
        gcode_dialect=text("gcode_dialect", gcode_dialect, "iso").lower(),
        passes=whole("passes", passes, 1, MOST_PASSES),
        tab_length=DEFAULTS.tab_length if tab is None else tab,
    )
    refuse_unread(kinds, options, prices=prices, seed=seed, calibration=calibration)
    if prices is not None:
        options = replace(options, prices=read_prices(path_of("prices", prices)))
    loaded = design_of(design)
    specimen, told = specimen_given(loaded, seed, calibration)
    files = write(
        loaded,
        kinds,
        None if out is None else path_of("out", out),
        specimen=specimen,
        force=force,
        options=options,
        progress=progress or silent,
    )
    told = (*told, *left_out(loaded, kinds, specimen=specimen))
    return Exported(loaded, told, kinds, files=files)


@dataclass(frozen=True, eq=False, repr=False)
class Reported(Result):
    """What `report` returns; `to_pandas` has a row a check.

    Attributes
    ----------
    found : WrittenReport
        The file, and the verdict that it prints.
    """

    command: ClassVar[str] = "report"

    found: WrittenReport

    @property
    def verdict(self) -> Verdict:
        """That the page prints."""
        return self.found.verdict

    @property
    def checks(self) -> tuple[Check, ...]:
        """Lines of the verdict."""
        return self.found.verdict.lines

    def _told(self) -> str:
        return f"{self.found.file.path}; {self._answer(self.checks)}"

    def _results(self) -> Mapping[str, Any]:
        return self.found.to_dict()

    def _rows(self) -> Sequence[Row]:
        return check_rows(self.checks)


@road
def report(
    design: DesignLike,
    *,
    out: PathLike | None = None,
    seed: int | None = None,
    calibration: CalibrationLike | None = None,
    format: Literal["html", "pdf"] | None = None,
    force: bool = False,
    progress: Callable[[str], None] | None = None,
) -> Reported:
    """Write one self-contained file for the design review: HTML, or PDF through a browser.

    Parameters
    ----------
    design : Design or path
        A path is that of a design file, whose comments then stand in the report; a bare name may
        be an example's.
    out : path, optional
        Default ``reports/NAME.html`` or ``.pdf``, which is replaced.
    seed : int, optional
        Of the simulated gearbox; default perfect parts.
    calibration : path or Calibrated, optional
        Fitted factors to apply.
    format : {"html", "pdf"}, optional
        The page, or its print by a browser of the Chromium family; default as `out` ends, or html.
    force : bool
        Replace a file that was named.
    progress : callable, optional
        Told in a few words what begins.

    Returns
    -------
    Reported
        `files`, and the `verdict` that the page prints.

    Raises
    ------
    UsageError
        The file exists, cannot be written, or ends otherwise than a report of this format.
    DesignError, GeometryError
        No valid design, or a shape that cannot exist.
    DependencyError
        No browser that prints.

    Notes
    -----
    Every figure on the page names its model and its source.

    Examples
    --------
    >>> import tempfile
    >>> import cqdd_design as cq
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     page = cq.report("cqdd-10", out=f"{folder}/review.html")
    >>> page.files[0].path.name, page.verdict.meets
    ('review.html', 'no')
    """
    from cqdd_design.roads.report import report_form, write_report
    from cqdd_design.roads.telling import silent

    path = None if out is None else path_of("out", out)
    form = report_form(format, path)
    loaded = design_of(design)
    specimen, told = specimen_given(loaded, seed, calibration)
    found = write_report(
        loaded,
        path,
        specimen=specimen,
        source=source_of(design),
        form=form,
        force=force,
        progress=progress or silent,
    )
    warnings = (*told, *found.verdict.warnings)
    return Reported(loaded, warnings, found, files=(found.file,))
