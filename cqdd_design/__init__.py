"""Cycloidal quasi-direct-drive actuators: sizing, checks, solids, files and reports.

    >>> import cqdd_design as cq
    >>> cq.load("cqdd-10")
    Design cqdd-10: ratio 10, ring 72 mm, 2 x 8 mm of disc, CubeMars RO100 Lite KV55

Every public name is listed in `__all__` and imported when it is first asked for.
"""

from __future__ import annotations

from importlib import import_module

from cqdd_design.version import __version__

#: As `typing` has it, whose import would take most of the time of this one.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from cqdd_design.design import Design, Requirements
    from cqdd_design.library.actuators import bench, calibrate
    from cqdd_design.library.designs import load, size
    from cqdd_design.library.gearboxes import compare, inertia, tolerance
    from cqdd_design.library.judging import analyse, check
    from cqdd_design.library.simulating import simulate
    from cqdd_design.library.writing import export, report
    from cqdd_design.machine import Machine
    from cqdd_design.verdict import Verdict

# The room `report` has the name of a function: imported once, while it costs nothing, it is never
# bound again in the function's place.
import_module(f"{__name__}.report")
del globals()["report"]

__all__ = [
    "Design",
    "Machine",
    "Requirements",
    "Verdict",
    "__version__",
    "analyse",
    "bench",
    "calibrate",
    "check",
    "compare",
    "export",
    "inertia",
    "load",
    "report",
    "simulate",
    "size",
    "tolerance",
]

_ROOMS = {
    "Design": "design",
    "Machine": "machine",
    "Requirements": "design",
    "Verdict": "verdict",
    "analyse": "library.judging",
    "bench": "library.actuators",
    "calibrate": "library.actuators",
    "check": "library.judging",
    "compare": "library.gearboxes",
    "export": "library.writing",
    "inertia": "library.gearboxes",
    "load": "library.designs",
    "report": "library.writing",
    "simulate": "library.simulating",
    "size": "library.designs",
    "tolerance": "library.gearboxes",
}


def __getattr__(name: str) -> Any:
    """A public name, from the room where it stands."""
    if name not in _ROOMS:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = getattr(import_module(f"{__name__}.{_ROOMS[name]}"), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    """The public names, loaded or not."""
    return sorted(__all__)
