"""Forces and pressures over one crank turn, from the rigid load law."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from cqdd_design.gearbox import GearboxAnalysis
from cqdd_design.report.ink.charts import Curve, Level, line_chart
from cqdd_design.report.ink.numbers import decimals, significant, with_unit
from cqdd_design.report.ink.svg import Figure
from cqdd_design.results import Check

FloatArray = NDArray[np.float64]

_TURN = (0.0, 60.0, 120.0, 180.0, 240.0, 300.0, 360.0)


def load_charts(analysis: GearboxAnalysis) -> tuple[Figure, ...]:
    """Ring forces, pin forces, cam load, and Hertz pressures with their limits.

    Parameters
    ----------
    analysis : GearboxAnalysis
        Its series covers one crank turn at the peak torque.
    """
    series = analysis.series
    angle = np.degrees(series.crank_angle)
    torque = with_unit(series.torque, "N*m")
    checks = {check.id: check for check in analysis.checks}
    tooth, pin = series.ring_force[:, 0, :], series.output_pin_force[:, 0, :]
    cam = series.cam_load
    return (
        line_chart(
            "ring-force-chart",
            "Force at the ring teeth, disc 1",
            f"Force on each ring tooth over one crank turn at {torque}; the most loaded tooth "
            f"reaches {decimals(analysis.rigid.ring_force, 0)} N.",
            x=angle,
            x_label="crank angle, °",
            y_label="force, N",
            curves=[
                *_each(tooth, "each tooth"),
                Curve("most loaded tooth", tooth.max(axis=1), "series-1"),
            ],
            x_ticks=_TURN,
            caption=f"At {torque}, discs sharing equally. Greatest over the period: "
            f"{decimals(analysis.rigid.ring_force, 0)} N.",
        ),
        line_chart(
            "pin-force-chart",
            "Force at the output pins, disc 1",
            f"Force of each output pin over one crank turn at {torque}; the most loaded pin "
            f"reaches {decimals(analysis.rigid.output_pin_force, 0)} N.",
            x=angle,
            x_label="crank angle, °",
            y_label="force, N",
            curves=[
                *_each(pin, "each pin"),
                Curve("most loaded pin", pin.max(axis=1), "series-1"),
            ],
            x_ticks=_TURN,
            caption=f"At {torque}. Greatest over the period: "
            f"{decimals(analysis.rigid.output_pin_force, 0)} N.",
        ),
        line_chart(
            "cam-load-chart",
            "Load on the cam bearings",
            f"Load on each cam bearing over one crank turn at {torque}, output-pin reaction "
            f"included; at most {decimals(analysis.rigid.cam_bearing_load, 0)} N.",
            x=angle,
            x_label="crank angle, °",
            y_label="load, N",
            curves=[
                Curve(f"disc {d + 1}", cam[:, d], f"series-{d + 1}") for d in range(cam.shape[1])
            ],
            levels=_static_rating(analysis),
            x_ticks=_TURN,
            caption="Ring and output-pin forces together. Greatest over the period, the discs and "
            f"both senses of torque: {decimals(analysis.rigid.cam_bearing_load, 0)} N.",
        ),
        line_chart(
            "pressure-chart",
            "Hertz pressure, greatest of all discs",
            f"Greatest Hertz pressure at ring teeth and output pins over one crank turn at "
            f"{torque}, with the limits of the peak torque.",
            x=angle,
            x_label="crank angle, °",
            y_label="pressure, MPa",
            curves=[
                Curve("ring teeth", series.ring_pressure.max(axis=1) / 1e6, "series-1"),
                Curve("output pins", series.output_pressure.max(axis=1) / 1e6, "series-2"),
            ],
            levels=_pressure_limits(checks),
            x_ticks=_TURN,
            caption="Raw pressures, without the factor for uneven sharing that the checks apply "
            "(√1.15 on pressures).",
        ),
    )


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
        if check is not None and check.limit > 0.0:
            found.append(Level(f"limit {name} {significant(check.limit)} MPa", check.limit))
    if len(found) == 2 and found[0].value == found[1].value:
        return [Level(f"limit {significant(found[0].value)} MPa", found[0].value)]
    return found
