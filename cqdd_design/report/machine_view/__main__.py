"""Draw a machine in a process of its own: a pickled job on standard input, views on the output.

The CAD kernel takes its time, and now and then the process; the report goes on beside it. Before
the views stands their digest.
"""

import contextlib
import gc
import hashlib
import os
import pickle
import sys
from types import ModuleType
from typing import BinaryIO

from cqdd_design.design import Design
from cqdd_design.errors import CqddError
from cqdd_design.report.machine_view import hidden_line_views, viewer_data
from cqdd_design.solids.cad import import_cadquery
from cqdd_design.solids.layout import Layout
from cqdd_design.solids.parts import build_parts

_PROFILE = 5e-6
"""Distance of drawn profiles from the exact curve, m: a twentieth of a pixel. Arcs within the
half micrometre of a wire's path are twice as many, each a face of the disc to cut and to hide."""


def main() -> int:
    """Read (design, layout), write (views, viewer)."""
    # Next to nothing of what a picture leaves behind is a cycle.
    gc.disable()
    # The CAD kernel's bridge to VTK imports all of it, a quarter of what the kernel takes to come.
    sys.modules.setdefault("vtk", ModuleType("vtk"))
    # What libraries print of their own goes to the errors, not among the views.
    sys.stdout.flush()
    with os.fdopen(os.dup(1), "wb") as out:
        os.dup2(2, 1)
        # It comes while whoever began this process gets the machine ready.
        with contextlib.suppress(CqddError):
            import_cadquery()
        try:
            design, layout = pickle.load(sys.stdin.buffer)
        except EOFError:
            # There is none to draw.
            return 0
        return _draw(design, layout, out)


def _draw(design: Design, layout: Layout, out: BinaryIO) -> int:
    within = max(design.edm.profile_tolerance, _PROFILE)
    seen = design.replacing({"edm.profile_tolerance": within})
    try:
        parts = build_parts(seen, layout)
        found = hidden_line_views(design, parts), viewer_data(design, parts)
    except CqddError as error:
        sys.stderr.write(f"{error.message}\n")
        return error.exit_code
    drawn = pickle.dumps(found)
    out.write(hashlib.sha256(drawn).digest() + drawn)
    # What is alive now dies with the process: to take the CAD kernel's thousands of classes apart
    # first costs half a second, for which whoever reads the views waits.
    gc.freeze()
    return 0


if __name__ == "__main__":
    sys.exit(main())
