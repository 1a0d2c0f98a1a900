"""Forces and pressures over one crank turn, from the rigid load law."""

from __future__ import annotations

import numpy as np

from cqdd_design.gearbox import GearboxAnalysis
from cqdd_design.gearbox.checks.allowables import UNEVEN_SHARING
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.report.ink.charts import Curve, Level, line_chart
from cqdd_design.report.ink.numbers import decimals, significant, with_unit
from cqdd_design.report.ink.svg import Figure, Words
from cqdd_design.results import Check

_ANGLE = "crank angle, °"
_TURN = (0.0, 60.0, 120.0, 180.0, 240.0, 300.0, 360.0)


def load_charts(analysis: GearboxAnalysis) -> tuple[Figure, ...]:
    """Ring forces, pin forces, cam load, and Hertz pressures with their limits.

    Parameters
    ----------
    analysis : GearboxAnalysis
        Its series covers one crank turn at the peak torque.
    """
    series, rigid = analysis.series, analysis.rigid
    torque = with_unit(series.torque, "N*m")
    tooth, pin = series.ring_force[:, 0, :], series.output_pin_force[:, 0, :]
    ring, pins, cam = (
        f"{decimals(force, 0)} N"
        for force in (rigid.ring_force, rigid.output_pin_force, rigid.cam_bearing_load)
    )
    over = f"over one crank turn at {torque}"
    charts: list[tuple[Words, str, list[Curve], list[Level]]] = [
        (
            Words(
                "ring-force-chart",
                "Force at the ring teeth, disc 1",
                f"Force on each ring tooth {over}; the most loaded tooth reaches {ring}.",
                f"At {torque}, discs sharing equally. Greatest over the period: {ring}.",
            ),
            "force, N",
            [*_each(tooth, "each tooth"), _most(tooth, "most loaded tooth")],
            [],
        ),
        (
            Words(
                "pin-force-chart",
                "Force at the output pins, disc 1",
                f"Force of each output pin {over}; the most loaded pin reaches {pins}.",
                f"At {torque}. Greatest over the period: {pins}.",
            ),
            "force, N",
            [*_each(pin, "each pin"), _most(pin, "most loaded pin")],
            [],
        ),
        (
            Words(
                "cam-load-chart",
                "Load on the cam bearings",
                f"Load on each cam bearing {over}, output-pin reaction included; at most {cam}.",
                "Ring and output-pin forces together. Greatest over the period, the discs and "
                f"both senses of torque: {cam}.",
            ),
            "load, N",
            [
                Curve(f"disc {d}", load, f"series-{d}")
                for d, load in enumerate(series.cam_load.T, 1)
            ],
            _static_rating(analysis),
        ),
        (
            Words(
                "pressure-chart",
                "Hertz pressure, greatest of all discs",
                f"Greatest Hertz pressure at ring teeth and output pins {over}, with the limits "
                "of the peak torque.",
                "By the rigid law, without the factor for uneven sharing of a search's first "
                f"screen (√{UNEVEN_SHARING:g} on pressures); the verdict's pressures are those of "
                "the contact equilibrium.",
            ),
            "pressure, MPa",
            [
                Curve("ring teeth", series.ring_pressure.max(axis=1) / 1e6, "series-1"),
                Curve("output pins", series.output_pressure.max(axis=1) / 1e6, "series-2"),
            ],
            _pressure_limits({check.id: check for check in analysis.checks}),
        ),
    ]
    angle = np.degrees(series.crank_angle)
    return tuple(
        line_chart(words, angle, curves, levels, y_label=label, x_label=_ANGLE, x_ticks=_TURN)
        for words, label, curves, levels in charts
    )


def _most(values: FloatArray, label: str) -> Curve:
    return Curve(label, values.max(axis=1), "series-1")


def _each(values: FloatArray, label: str) -> list[Curve]:
    return [Curve("" if i else label, values[:, i], "faint") for i in range(values.shape[1])]


def _static_rating(analysis: GearboxAnalysis) -> list[Level]:
    bearing = analysis.cam_bearing.bearing
    if bearing.static_rating is None:
        return []
    label = f"C_0 of {bearing.designation}: {significant(bearing.static_rating)} N"
    return [Level(label, bearing.static_rating)]


def _pressure_limits(checks: dict[str, Check]) -> list[Level]:
    found = []
    for check_id, name in (("CONTACT-RING-PEAK", "ring"), ("CONTACT-PIN-PEAK", "pins")):
        check = checks.get(check_id)
        limit = None if check is None else check.limit
        if limit:
            found.append(Level(f"limit {name} {significant(limit)} MPa", limit))
    if len(found) == 2 and found[0].value == found[1].value:
        return [Level(f"limit {significant(found[0].value)} MPa", found[0].value)]
    return found
