"""Time the elastic bodies: finite elements of a new geometry, and their matrices from disk.

    python benchmarks/elastic_bodies.py [DESIGN ...]

Everything in one thread, after imports; a loop of ten million additions stands beside it, since
machines are not alike. Run it by hand on a machine that does nothing else. Asked for: under 3 s for
a new geometry, under 50 ms from disk.
"""

from __future__ import annotations

import itertools
import os
import sys
import tempfile
import time
from pathlib import Path

os.environ.update(OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1")

from cqdd_design.design import load_design
from cqdd_design.gearbox.bodies.made import elastic_bodies
from cqdd_design.machine import resolve

DESIGNS = Path(__file__).resolve().parents[1] / "designs"


def loop() -> float:
    """Process time of ten million additions, s."""
    begin, total = time.process_time(), 0
    for k in range(10_000_000):
        total += k
    return time.process_time() - begin


def main() -> None:
    """Print a line a design."""
    files = [Path(one) for one in sys.argv[1:]] or [
        DESIGNS / "reference-s.toml",
        DESIGNS / "cqdd-10.toml",
    ]
    print(f"ten million additions: {loop():.2f} s")
    with tempfile.TemporaryDirectory() as folder:
        for k, file in enumerate([files[0], *files]):
            # The first of all is for the imports.
            os.environ["CQDD_DESIGN_CACHE"] = str(Path(folder) / str(k))
            design = resolve(load_design(file)).design
            marks = [(time.process_time(), time.perf_counter())]
            for _ in range(4):
                elastic_bodies(design)
                marks.append((time.process_time(), time.perf_counter()))
            steps = [(b[0] - a[0], b[1] - a[1]) for a, b in itertools.pairwise(marks)]
            if k:
                new, kept = steps[0], min(steps[1:])
                print(
                    f"{design.name}: new {new[0]:.2f} s of process time ({new[1]:.2f} s), "
                    f"from disk {1e3 * kept[0]:.0f} ms ({1e3 * kept[1]:.0f} ms)"
                )


if __name__ == "__main__":
    main()
