"""Kept entries: what was used last stays, and all together are no more than they may be."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from cqdd_design.files import kept
from cqdd_design.files.kept import entry_path, read_entry, write_entry

ARRAY = np.arange(100.0)
SIZE = 1000
"""Bytes of an entry, about."""


@pytest.fixture(autouse=True)
def _nothing_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kept, "_TAKEN", {})


def written(folder: Path, number: int, most: int, suffix: str = "bin") -> Path:
    path = entry_path(folder, str(number), suffix)
    write_entry(path, str(number), [ARRAY + number], number, most)
    if path.exists():
        os.utime(path, (number, number))
    return path


def test_what_was_not_used_for_longest_goes(tmp_path: Path) -> None:
    most = int(3.5 * SIZE)
    paths = [written(tmp_path, number, most) for number in range(1, 4)]
    assert all(path.exists() for path in paths)
    # Reading is use: the first is the newest now.
    assert read_entry(paths[0], "1") is not None
    other = written(tmp_path, 4, most)
    assert [path.exists() for path in paths] == [True, False, True]
    assert other.exists()
    found = read_entry(other, "4")
    assert found is not None
    assert found[1] == 4
    np.testing.assert_array_equal(found[0][0], ARRAY + 4)


def test_entries_of_another_kind_stay(tmp_path: Path) -> None:
    most = int(1.5 * SIZE)
    other = written(tmp_path, 1, most, "npz")
    (tmp_path / "note.txt").write_text("a user's")
    first, second = (written(tmp_path, number, most) for number in (2, 3))
    assert not first.exists()
    assert second.exists()
    assert other.exists()
    assert (tmp_path / "note.txt").exists()


def test_the_folder_is_read_when_it_may_be_full_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    counted: list[int] = []
    clear = kept._clear

    def counting(*given: object) -> int:
        counted.append(1)
        return clear(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(kept, "_clear", counting)
    for number in range(1, 6):
        written(tmp_path, number, 20 * SIZE)
    # At the first write of a process, what stands there is not known.
    assert len(counted) == 1
    for number in range(6, 30):
        written(tmp_path, number, 20 * SIZE)
    assert len(counted) > 1
    assert sum(one.stat().st_size for one in tmp_path.iterdir()) <= 20 * SIZE
