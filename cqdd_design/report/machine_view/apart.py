"""Draw a machine in another process, and fetch what it has drawn; what was drawn before is kept."""

from __future__ import annotations

import contextlib
import hashlib
import json
import pickle
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING

from cqdd_design.environment import cache_folder
from cqdd_design.files.kept import entry_path, read_entry, write_entry
from cqdd_design.files.package_state import package_state

if TYPE_CHECKING:
    import subprocess
    from collections.abc import Callable
    from pathlib import Path

    from cqdd_design.machine import Machine
    from cqdd_design.report.machine_view.model import ViewerData
    from cqdd_design.report.machine_view.stills import MachineViews

_DIGEST = hashlib.sha256().digest_size
_MOST_KEPT = 100_000_000
"""Bytes of all entries together: some sixty machines."""


@dataclass(frozen=True)
class Drawing:
    """A machine being drawn, or one that was drawn before.

    Attributes
    ----------
    text : str
        All that the pictures depend on.
    process : subprocess.Popen or None
        Draws; None where the pictures are there already.
    """

    text: str
    process: subprocess.Popen[bytes] | None
    before: tuple[MachineViews, ViewerData] | None = None

    def close(self) -> None:
        """Stop it, where it still draws."""
        if self.process is not None:
            self.process.kill()
            self.process.communicate()

    def fetch(self) -> tuple[MachineViews, ViewerData] | str:
        """Wait for the views; a sentence on why there are none, where the process failed."""
        if self.before is not None:
            return self.before
        assert self.process is not None
        drawn, said = self.process.communicate()
        if self.process.returncode == 0:
            digest, pictures = drawn[:_DIGEST], drawn[_DIGEST:]
            if hashlib.sha256(pictures).digest() != digest:
                return "no pictures of the machine: what was drawn arrived damaged"
            found: tuple[MachineViews, ViewerData] = pickle.loads(pictures)
            _keep(self.text, *found)
            return found
        lines = said.decode("utf-8", "replace").strip().splitlines()
        why = lines[-1] if lines else "the CAD kernel crashed"
        return f"no pictures of the machine: {why}"


def start_drawing(machine: Machine, drawer: Callable[[], subprocess.Popen[bytes]]) -> Drawing:
    """Begin; a design that cannot be built is told by :meth:`Drawing.fetch`.

    Whoever begins it closes it.

    Parameters
    ----------
    drawer : callable
        Gives a process of this package's ``report.machine_view`` with pipes, where one is needed.
    """
    # A design's pickle is not the same in every process, its digest is.
    layout = hashlib.sha256(pickle.dumps(machine.layout)).hexdigest()
    text = json.dumps([package_state(), sys.version, machine.design.sha256, layout])
    before = _kept(text)
    if before is not None:
        return Drawing(text, None, before)
    process = drawer()
    assert process.stdin is not None
    # The job now, and not when the views are fetched: it is to draw meanwhile.
    with contextlib.suppress(BrokenPipeError), process.stdin:
        process.stdin.write(pickle.dumps((machine.design, machine.layout)))
    process.stdin = None
    return Drawing(text, process)


def _place(text: str) -> Path:
    return entry_path(cache_folder() / "pictures", text, "pictures")


def _kept(text: str) -> tuple[MachineViews, ViewerData] | None:
    """Pictures of an earlier run of this very package."""
    found = read_entry(_place(text), text)
    if found is None:
        return None
    from cqdd_design.report.ink.svg import Figure
    from cqdd_design.report.machine_view.model import ViewerData
    from cqdd_design.report.machine_view.stills import MachineViews

    (model,), (turns, figures) = found
    views = MachineViews(**{name: Figure(*values) for name, values in figures.items()})
    return views, ViewerData(model.tobytes(), turns)


def _keep(text: str, views: MachineViews, viewer: ViewerData) -> None:
    import numpy as np

    figures = {name: list(vars(figure).values()) for name, figure in vars(views).items()}
    model = np.frombuffer(viewer.glb, np.uint8)
    write_entry(_place(text), text, [model], [viewer.turns, figures], _MOST_KEPT)
