"""Draw a machine in a process of its own: a pickled job on standard input, views on the output.

The CAD kernel takes its time, and now and then the process; the report goes on beside it.
"""

import pickle
import sys

from cqdd_design.errors import CqddError
from cqdd_design.report.machine_view import hidden_line_views, viewer_data
from cqdd_design.solids.parts import build_parts


def main() -> int:
    """Read (design, layout), write (views, viewer)."""
    design, layout = pickle.load(sys.stdin.buffer)
    try:
        parts = build_parts(design, layout)
        found = hidden_line_views(design, parts), viewer_data(design, parts)
    except CqddError as error:
        sys.stderr.write(f"{error.message}\n")
        return error.exit_code
    pickle.dump(found, sys.stdout.buffer)
    return 0


if __name__ == "__main__":
    sys.exit(main())
