"""Wire EDM in the report: how closely the files follow the exact curves."""

from __future__ import annotations

import math

from cqdd_design.exporting.edm.cut_facts import said
from cqdd_design.exporting.edm.dxf import contour_fit
from cqdd_design.exporting.edm.flat_parts import FlatPart, flat_parts
from cqdd_design.machine import Machine
from cqdd_design.report.ink.numbers import decimals, significant, with_unit
from cqdd_design.report.ink.page import Values


def edm_view(machine: Machine) -> Values:
    """Measure the contours of a machine as their files hold them: a row a program."""
    edm, flats = machine.design.edm, flat_parts(machine)
    within = with_unit(edm.profile_tolerance * 1e6, "um")
    offset = with_unit(edm.wire_offset * 1e3, "mm")
    return {
        "lead": f"Arcs follow the exact curve within {within}; the wire's centre runs {offset} "
        "beside it. Every file is read back from disk and measured so before it gets its name.",
        "rows": tuple(_row(flat) for flat in flats),
        "remarks": tuple(
            f"{flat.label}: {remark}" for flat in flats for remark in said(flat.remarks)
        ),
    }


def _row(flat: FlatPart) -> tuple[str, ...]:
    fit = contour_fit(flat)
    concave = fit.least_concave_radius
    return (
        flat.label,
        str(flat.quantity),
        with_unit(flat.thickness * 1e3, "mm"),
        str(fit.segments),
        decimals(fit.largest_deviation * 1e6, 3),
        decimals(fit.rms_deviation * 1e6, 3),
        with_unit(fit.perimeter * 1e3, "mm", 7),
        with_unit(fit.area * 1e6, "mm^2", 7),
        "0" if fit.tangent_break < 1e-12 else significant(fit.tangent_break, 2),
        "none" if math.isinf(concave) else with_unit(concave * 1e3, "mm"),
    )
