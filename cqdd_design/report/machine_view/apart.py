"""Start drawing a machine in another process, and fetch what it has drawn."""

from __future__ import annotations

import contextlib
import pickle
import subprocess
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cqdd_design.machine import Machine
    from cqdd_design.report.machine_view.model import ViewerData
    from cqdd_design.report.machine_view.stills import MachineViews


@dataclass(frozen=True)
class Drawing:
    """A machine being drawn."""

    process: subprocess.Popen[bytes]

    def close(self) -> None:
        """Stop it, where it still draws."""
        self.process.kill()
        self.process.communicate()

    def fetch(self) -> tuple[MachineViews, ViewerData] | str:
        """Wait for the views; a sentence on why there are none, where the process failed."""
        drawn, said = self.process.communicate()
        if self.process.returncode == 0:
            found: tuple[MachineViews, ViewerData] = pickle.loads(drawn)
            return found
        lines = said.decode("utf-8", "replace").strip().splitlines()
        why = lines[-1] if lines else "the CAD kernel crashed"
        return f"no pictures of the machine: {why}"


def start_drawing(machine: Machine) -> Drawing:
    """Begin; a design that cannot be built is told by :meth:`Drawing.fetch`.

    Whoever begins it closes it.
    """
    process = subprocess.Popen(
        [sys.executable, "-m", "cqdd_design.report.machine_view"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert process.stdin is not None
    # The job now, and not when the views are fetched: it is to draw meanwhile.
    with contextlib.suppress(BrokenPipeError), process.stdin:
        process.stdin.write(pickle.dumps((machine.design, machine.layout)))
    process.stdin = None
    return Drawing(process)
