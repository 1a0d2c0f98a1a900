"""Records of hardware, beside the project and under their own licence: skipped where they are not.

J. V., "Anti-Backlash Mechanisms for Cost-Effective Cycloidal Drive Robotic Actuators: Design and
Evaluation", MSc thesis, University of Twente; repository JelmerV/Anti-Backlash-Cycloidal-Actuator,
CC BY-SA 4.0.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest


@pytest.fixture(scope="session")
def page(repository: Path) -> Iterator[ModuleType]:
    """What docs/measured.md is made of."""
    sys.path.insert(0, str(repository / "docs"))
    import measured

    if not measured.RECORDS.is_dir():
        pytest.skip("no records of hardware in ../shared/data/measured")
    yield measured
    sys.path.remove(str(repository / "docs"))
