"""Time the elastic bodies: finite elements of a new geometry, and their matrices from disk.

    python benchmarks/elastic_bodies.py [DESIGN ...]

Everything in one thread, after imports; a loop of ten million additions stands beside each line,
since machines are not alike, nor one machine at all times. Run it by hand on a machine that does
nothing else. Asked for: under 3 s for a new geometry, under 50 ms from disk.

Beside the designs named, or reference-s and cqdd-10, it has reference-s with seven pins, whose ten
lobes share no symmetry with its holes, that with three discs, no two of one kind, and 29 lobes with
20 pins, again without symmetry.
"""

from __future__ import annotations

import itertools
import os
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

os.environ.update(OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1")

from cqdd_design.design import Design, load_design
from cqdd_design.gearbox.bodies.made import elastic_bodies
from cqdd_design.machine import resolve

DESIGNS = Path(__file__).resolve().parents[1] / "designs"


def loop() -> float:
    """Process time of ten million additions, s."""
    begin, total = time.process_time(), 0
    for k in range(10_000_000):
        total += k
    return time.process_time() - begin


def designs() -> Iterator[Design]:
    """Those of the command line, or two committed ones; then discs without any symmetry."""
    files = sys.argv[1:] or [DESIGNS / "reference-s.toml", DESIGNS / "cqdd-10.toml"]
    for file in files:
        yield load_design(Path(file))
    seven = load_design(DESIGNS / "reference-s.toml").replacing({"reducer.output_pins.count": 7})
    yield seven.replacing({"name": "seven pins, no symmetry"})
    three = {"reducer.disc_count": 3, "reducer.ring.outer_diameter": "80 mm"}
    yield seven.replacing({"name": "seven pins, three discs, no symmetry", **three})
    many: dict[str, object] = {
        "name": "29 lobes, 20 pins, no symmetry",
        "requirements.ratio": 29,
        "reducer.ratio": 29,
        "reducer.ring_pitch_radius": "27.9 mm",
        "reducer.eccentricity": "0.64 mm",
        "reducer.ring_pin_diameter": "2.9 mm",
        "reducer.output_pins.count": 20,
        "reducer.output_pins.circle_radius": "21.65 mm",
        "reducer.output_pins.hole_clocking": f"{90 / 29} deg",
        "reducer.ring.outer_diameter": "60.7 mm",
    }
    yield seven.replacing(many)


def main() -> None:
    """Print a line a design."""
    given = list(designs())
    with tempfile.TemporaryDirectory() as folder:
        for k, one in enumerate([given[0], *given]):
            # The first of all is for the imports.
            os.environ["CQDD_DESIGN_CACHE"] = str(Path(folder) / str(k))
            design = resolve(one).design
            pace = loop()
            marks = [(time.process_time(), time.perf_counter())]
            for _ in range(4):
                elastic_bodies(design)
                marks.append((time.process_time(), time.perf_counter()))
            steps = [(b[0] - a[0], b[1] - a[1]) for a, b in itertools.pairwise(marks)]
            if k:
                new, kept = steps[0], min(steps[1:])
                print(
                    f"{design.name}: new {new[0]:.2f} s of process time ({new[1]:.2f} s), "
                    f"from disk {1e3 * kept[0]:.0f} ms ({1e3 * kept[1]:.0f} ms); "
                    f"ten million additions {pace:.2f} s"
                )


if __name__ == "__main__":
    main()
