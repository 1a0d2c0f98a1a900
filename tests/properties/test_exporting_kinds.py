"""The table of kinds: what it says of every kind is what its writer does."""

from __future__ import annotations

import pytest

from cqdd_design.design import load_design
from cqdd_design.exporting import KINDS, stages
from cqdd_design.exporting.job import ExportJob
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
