"""The table of kinds: what it says of every kind is what its writer does."""

from __future__ import annotations

from contextlib import contextmanager

import pytest

from cqdd_design.design import load_design
from cqdd_design.exporting import KINDS, stages
from cqdd_design.exporting.job import ExportJob
from cqdd_design.roads import kernels
from cqdd_design.roads.export import export


class PartsAskedForError(Exception):
    """Somebody wants the solids."""


@pytest.mark.parametrize("kind", KINDS)
def test_a_kind_needs_solids_where_the_table_says_so(
    kind, paper_design_file, tmp_path, monkeypatch
):
    def refuse(job: ExportJob) -> None:
        raise PartsAskedForError

    monkeypatch.setattr(ExportJob, "parts", property(refuse))
    # Of plastic: a machine of metal has nothing to print.
    design, told = load_design(paper_design_file.with_name("printed-13.toml")), []
    if KINDS[kind].needs_solids:
        with pytest.raises(PartsAskedForError):
            export(design, kind, tmp_path)
        return
    files = export(design, kind, tmp_path, progress=told.append)
    assert files
    assert len(told) == stages([kind])


def test_solids_are_one_stage_more_for_all_kinds_together():
    assert stages(["dxf", "svg", "edm", "gcode", "mjcf", "urdf", "card", "bam"]) == 8
    assert stages(["bom"]) == 2
    assert stages(["dxf", "step", "stl", "3mf", "glb", "bom"]) == 7
    assert stages([]) == 0


def test_only_files_of_simulators_wait_for_kernels_that_are_not_compiled(
    paper_design_file, tmp_path, monkeypatch
):
    told = []

    @contextmanager
    def compiling(wanted):
        assert wanted == [*kernels.GEARBOX, *kernels.SIMULATION]
        told.append("begun")
        yield lambda: told.append("waited")
        told.append("left")

    monkeypatch.setattr(kernels, "missing", lambda **_: [*kernels.GEARBOX, *kernels.SIMULATION])
    monkeypatch.setattr(kernels, "compiling", compiling)
    design = load_design(paper_design_file)
    export(design, "svg,urdf", tmp_path / "both", progress=told.append)
    assert told == ["begun", "writing svg", "writing urdf", "waited", "left"]
    told.clear()
    export(design, "svg", tmp_path / "maker", progress=told.append)
    assert told == ["writing svg"]
