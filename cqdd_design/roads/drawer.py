"""A process that draws machines, begun before there is one: a CAD kernel takes a second to come.

Nothing is imported here, so that it can come while a command still reads its own code.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager


def begin_drawer() -> subprocess.Popen[bytes]:
    """A process that waits for a machine; see :func:`.apart.start_drawing`."""
    return subprocess.Popen(
        [sys.executable, "-m", "cqdd_design.report.machine_view"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )


@contextmanager
def waiting_drawer() -> Iterator[subprocess.Popen[bytes]]:
    """The same, stopped at the end, whether it was given a machine or not."""
    with begin_drawer() as process:
        try:
            yield process
        finally:
            process.kill()
