"""Stops of the output in the report: how the torque was found, and what it asks of the parts."""

from __future__ import annotations

from collections.abc import Mapping

from cqdd_design.actuator.shock import METHODS, Shock, Stop
from cqdd_design.report.ink.numbers import NONE, significant, with_unit
from cqdd_design.report.ink.page import Values

_FORCES = ("ring_force_max_N", "output_pin_force_max_N", "cam_bearing_load_max_N")
_PRESSURES = ("ring_pressure_max_MPa", "output_pressure_max_MPa")


def shock_view(shocks: Mapping[str, Shock]) -> tuple[Values, ...]:
    """One table for each speed: a row for each of `METHODS`."""
    return tuple(
        {
            "name": name,
            "lead": f"{with_unit(one.speed, 'rad/s', 3)} at the output, {name} speed: "
            f"{with_unit(one.energy, 'J', 3)} of {with_unit(one.inertia, 'kg*m^2', 3)} that run on",
            "rows": tuple(_row(METHODS[key], stop) for key, stop in one.stops.items()),
        }
        for name, one in shocks.items()
    )


def _row(words: str, stop: Stop) -> Values:
    if stop.torque is None:
        return {"words": words, "cells": (NONE,) * 6, "note": stop.missing}
    keys = (*_FORCES, *_PRESSURES)
    over = [one for one in stop.limits if one.share > 1.0]
    shown = over or stop.limits[:1]
    note = "; ".join(f"{one.title} at {significant(one.share, 3)} of its limit" for one in shown)
    cells = (stop.torque, *(stop.forces[key] for key in keys))
    return {
        "words": words,
        "cells": tuple(significant(cell, 3) for cell in cells),
        "note": note or "no static limit is known",
    }
