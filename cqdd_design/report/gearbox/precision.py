"""Precision in the report: angle error, orders, and the figures beside the paper's."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.catalog.paper import METRICS, is_papers_actuator
from cqdd_design.design import Design
from cqdd_design.gearbox.precision.precision import LOST_MOTION_SHARE
from cqdd_design.report.ink.bars import bar_chart
from cqdd_design.report.ink.charts import Curve, line_chart
from cqdd_design.report.ink.numbers import ARCMIN, significant, with_unit
from cqdd_design.report.ink.page import Values
from cqdd_design.report.ink.svg import Figure, Words
from cqdd_design.terms import term

if TYPE_CHECKING:
    from cqdd_design.gearbox.precision.orders import Order
    from cqdd_design.gearbox.precision.precision import Precision
    from cqdd_design.machine.contact_analysis import ContactAnalysis

_ORDERS = 8


def precision_view(analysis: ContactAnalysis, design: Design) -> Values:
    """Figures, and rows of (name, value, measured in the paper, remark).

    The third stands only beside the paper's own actuator; `measured` tells whether it does.
    """
    found = analysis.precision
    torque = with_unit(found.torque, "N*m")
    angle = np.degrees(found.free.crank_angle)
    period = float(angle[-1] + angle[1])
    loaded, unloaded = ((x - x.min()) * ARCMIN for x in (found.loaded, found.unloaded))
    error = line_chart(
        Words(
            "angle-error",
            "Transmission error",
            "Carrier angle error over one period of the mesh, "
            f"{significant(period)} degrees of crank, above its least value, under load and "
            "without.",
            "Of perfect parts, above its least value, over one period of the mesh.",
        ),
        angle,
        [
            Curve("without load", unloaded, "series-2"),
            Curve(f"at {torque}", loaded, "series-1"),
        ],
        x_label="crank angle, \u00b0",
        y_label="angle error, arcmin",
        x_ticks=[*(round(period * k / 4.0, 2) for k in range(4)), period],
    )
    paper = is_papers_actuator(design)
    orders = [_order_bars(found.orders[:_ORDERS], torque)] if found.orders else []
    rows = _rows(found)
    if not paper:
        rows = tuple((name, value, remark) for name, value, _, remark in rows)
    return {"figures": (error, *orders), "rows": rows, "measured": paper}


def _order_bars(orders: tuple[Order, ...], torque: str) -> Figure:
    sizes = [order.amplitude * ARCMIN for order in orders]
    shown = [significant(size, 3) for size in sizes]
    words = Words(
        "angle-orders",
        "Orders of the transmission error",
        f"Amplitudes of the strongest orders; {orders[0].name} leads with {shown[0]} arcmin.",
        f"Amplitude in arcmin at {torque}, by number of periods in one output turn.",
    )
    return bar_chart(words, [f"{o.per_output_turn}: {o.name}" for o in orders], sizes, shown)


def _rows(found: Precision) -> tuple[tuple[str, ...], ...]:
    """Name, value, what the paper measured, remark."""
    free = found.free.free * ARCMIN
    torque = with_unit(found.torque, "N*m")
    small = with_unit(LOST_MOTION_SHARE * abs(found.torque), "N*m", 3)
    backlash, ripple = METRICS["backlash"], METRICS["torque_ripple"].value
    return (
        (
            term("backlash_arcmin").words,
            f"{significant(float(free.mean()))} arcmin",
            f"{backlash.value:g} \u00b1 {backlash.spread:g} arcmin",
            f"{significant(float(free.min()))} to {significant(float(free.max()))} over a turn, "
            "rigid parts, from the clearances of the design",
        ),
        (
            term("lost_motion_arcmin").words,
            f"{significant(found.lost_motion * ARCMIN)} arcmin",
            "",
            f"between \u00b1{small}",
        ),
        (
            term("stiffness_Nm_per_arcmin").words,
            f"{significant(found.stiffness / ARCMIN)} N\u00b7m/arcmin",
            "",
            f"secant from half of {torque}; contacts, pins and cam bearings only",
        ),
        (
            term("transmission_error_pp_arcmin").words,
            f"{significant(found.transmission_error * ARCMIN)} arcmin",
            "",
            f"at {torque}; {significant(float(np.ptp(found.unloaded)) * ARCMIN)} without load",
        ),
        (
            term("torque_ripple_pp_Nm").words,
            with_unit(found.ripple_pp, "N*m"),
            f"{2.0 * ripple:g} N\u00b7m (\u00b1{ripple:g} N\u00b7m)",
            f"at {torque}, perfect parts; tolerances add far more",
        ),
    )
