"""Stages of work are counted as they are told, whatever is exported."""

from __future__ import annotations

import re

import pytest


def stages_told(err: str) -> list[tuple[int, int]]:
    """Number and total of every line of progress."""
    return [(int(one), int(all_)) for one, all_ in re.findall(r"^\[(\d+)/(\d+)\]", err, re.M)]


@pytest.mark.parametrize(
    "kinds",
    [
        pytest.param("gcode", marks=pytest.mark.deep),
        "edm,mjcf",
        pytest.param("dxf,bom", marks=pytest.mark.deep),
    ],
)
def test_export_counts_the_stages_that_it_tells(cqdd, paper_design_file, tmp_path, kinds):
    done = cqdd("export", paper_design_file, "--to", kinds, "--out", tmp_path / "files")
    assert done.code == 0, done.err
    told = stages_told(done.err)
    assert [one for one, _ in told] == list(range(1, len(told) + 1))
    assert {total for _, total in told} == {len(told)}
