"""Precision in the report: angle error, orders, and the figures beside the paper's."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from cqdd_design.catalog.paper import METRICS
from cqdd_design.report.ink.bars import bar_chart
from cqdd_design.report.ink.charts import Curve, line_chart
from cqdd_design.report.ink.numbers import significant, with_unit
from cqdd_design.report.ink.svg import Figure

if TYPE_CHECKING:
    from cqdd_design.gearbox.contact_analysis import ContactAnalysis
    from cqdd_design.gearbox.precision.orders import Order
    from cqdd_design.gearbox.precision.precision import Precision

_ARCMIN = math.degrees(1.0) * 60.0
_ORDERS = 8


@dataclass(frozen=True)
class PrecisionView:
    """What the section shows.

    Attributes
    ----------
    figures : tuple of Figure
    rows : tuple of (name, value, remark, measured in the paper or "")
    measured : bool
        Whether any row has a measured value.
    """

    figures: tuple[Figure, ...]
    rows: tuple[tuple[str, str, str, str], ...]
    measured: bool


def precision_view(analysis: ContactAnalysis, beside_paper: bool) -> PrecisionView:
    """Values of the section, beside what was measured of the paper's actuator or alone."""
    found = analysis.precision
    torque = with_unit(found.torque, "N*m")
    period = float(np.degrees(found.free.crank_angle[-1] + found.free.crank_angle[1]))
    loaded = (found.loaded - found.loaded.min()) * _ARCMIN
    unloaded = (found.unloaded - found.unloaded.min()) * _ARCMIN
    ticks = [round(period * k / 4.0, 2) for k in range(4)] + [period]
    error = line_chart(
        "angle-error",
        "Transmission error",
        f"Carrier angle error over one period of the mesh, {significant(period)} degrees of crank, "
        "above its least value, under load and without.",
        x=np.degrees(found.free.crank_angle),
        x_label="crank angle, \u00b0",
        y_label="angle error, arcmin",
        curves=[
            Curve("without load", unloaded, "series-2"),
            Curve(f"at {torque}", loaded, "series-1"),
        ],
        x_ticks=ticks,
        caption="Of perfect parts, above its least value, over one period of the mesh.",
    )
    rows = _rows(found, beside_paper)
    figures = [error]
    if found.orders:
        figures.append(_order_bars(found.orders, torque))
    return PrecisionView(tuple(figures), rows, any(row[3] for row in rows))


def _order_bars(orders: tuple[Order, ...], torque: str) -> Figure:
    shown = orders[:_ORDERS]
    first = shown[0]
    return bar_chart(
        "angle-orders",
        "Orders of the transmission error",
        f"Amplitudes of the strongest orders; {first.name} leads with "
        f"{significant(first.amplitude * _ARCMIN, 3)} arcmin.",
        names=[f"{o.per_output_turn}: {o.name}" for o in shown],
        values=[o.amplitude * _ARCMIN for o in shown],
        shown=[significant(o.amplitude * _ARCMIN, 3) for o in shown],
        caption=f"Amplitude in arcmin at {torque}, by number of periods in one output turn.",
    )


def _rows(found: Precision, paper: bool) -> tuple[tuple[str, str, str, str], ...]:
    free = found.free.free * _ARCMIN
    torque = with_unit(found.torque, "N*m")
    backlash, ripple = METRICS["backlash"], METRICS["torque_ripple"].value
    small = with_unit(0.03 * abs(found.torque), "N*m", 3)
    return (
        (
            "backlash",
            f"{significant(float(free.mean()))} arcmin",
            f"{significant(float(free.min()))} to {significant(float(free.max()))} over a turn, "
            "rigid parts, from the clearances of the design",
            f"{backlash.value:g} \u00b1 {backlash.spread:g} arcmin" if paper else "",
        ),
        (
            "lost motion",
            f"{significant(found.lost_motion * _ARCMIN)} arcmin",
            f"between \u00b1{small}",
            "",
        ),
        (
            "stiffness",
            f"{significant(found.stiffness / _ARCMIN)} N\u00b7m/arcmin",
            f"secant from half of {torque}; contacts, pins and cam bearings only",
            "",
        ),
        (
            "transmission error, peak to peak",
            f"{significant(found.transmission_error * _ARCMIN)} arcmin",
            f"at {torque}; {significant(float(np.ptp(found.unloaded)) * _ARCMIN)} without load",
            "",
        ),
        (
            "torque ripple, peak to peak",
            with_unit(found.ripple_pp, "N*m"),
            f"at {torque}, perfect parts; tolerances add far more",
            f"{2.0 * ripple:g} N\u00b7m (\u00b1{ripple:g})" if paper else "",
        ),
    )
