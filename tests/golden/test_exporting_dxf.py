"""Golden numbers of the paper design's EDM files, and its bill of materials.

Made with this package. To regenerate: ``python tests/golden/test_exporting_dxf.py`` prints them;
review the difference. Profile area and perimeter follow from the closed form, so they move only
with the design; number of arcs and deviation move with the fit.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import pytest

from cqdd_design.design import load_design
from cqdd_design.exporting.edm.dxf import write_flat_part
from cqdd_design.exporting.edm.flat_parts import flat_parts
from cqdd_design.exporting.edm.readback import read_back
from cqdd_design.geometry.contours import Circle
from cqdd_design.machine import resolve

DESIGN = Path(__file__).parents[2] / "designs" / "cqdd-10.toml"

#: segments, largest deviation (um), rms (um), exact perimeter (mm), exact area (mm^2), least
#: concave radius (mm), loops
GOLDEN = {
    "disc": (270, 0.4884, 0.2519, 194.55063593, 2584.74702681, 3.5955, 7),
    "ring": (55, 0.0, 0.0, 214.20740409, 2944.72529117, 5.00155926, 2),
}


def numbers() -> dict[str, tuple[float, ...]]:
    """The same numbers, read back from files written now."""
    design = load_design(DESIGN)
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for flat in flat_parts(resolve(design)):
            path = Path(folder) / f"{flat.label}.dxf"
            write_flat_part(flat, design, path)
            fit = read_back(path, flat, design.edm)
            rounds = [one for one in flat.contours if isinstance(one, Circle)]
            inner = [one.radius for one in rounds if one is not flat.shape.outer]
            found[flat.label] = (
                fit.segments,
                round(fit.largest_deviation * 1e6, 4),
                round(fit.rms_deviation * 1e6, 4),
                round((fit.perimeter - fit.perimeter_error) * 1e3, 8),
                round((fit.area - fit.area_error) * 1e6, 8),
                round(min([fit.least_concave_radius, *inner]) * 1e3, 8),
                len(flat.contours),
            )
    return found


@pytest.mark.parametrize("label", sorted(GOLDEN))
def test_paper_files(label):
    assert numbers()[label] == pytest.approx(GOLDEN[label], rel=1e-7, abs=2e-4)


if __name__ == "__main__":
    print(numbers())
