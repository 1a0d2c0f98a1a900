"""Designs by mere chance: random sizes, and random steps from the strongest of them.

Nothing of `cqdd_design.sizing` is used: sizes are drawn as numbers, made into a design as a file of
theirs would be, and asked what its own checks and the contact equilibrium say.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from contact_designs import PIN_DIAMETERS

from cqdd_design.catalog.bearings import bearings
from cqdd_design.design import Design
from cqdd_design.errors import ContactError, DesignError
from cqdd_design.gearbox.checks.equilibrium import PeakLoads, lasting_checks, peak_checks
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.life import life
from cqdd_design.geometry.trochoid import undercut_radius_limit
from cqdd_design.machine import resolve
from cqdd_design.machine.capacity import LoadedContacts

_RANDOM, _STEPS = 500, 300
_NOTHING: Mapping[str, str] = MappingProxyType({})
_LOADS = ("CONTACT-", "PIN-", "BEARING-")


class Space(NamedTuple):
    """What is asked for; lengths in m, torques in N m."""

    ratio: int
    outer_diameter: float
    length: float
    disc_count: int
    material: str
    peak_torque: float
    continuous_torque: float
    life_hours: float
    speed: str = "300 rpm"
    motor: str = "CubeMars RO100 KV55"
    tables: Mapping[str, object] = _NOTHING
    """Of the design file: a motor of one's own, environment."""
    clearances: tuple[str, str] | None = None
    """Of the profile and of the output pins' holes."""

    def times(self, factor: float) -> Space:
        """The same with other torques."""
        return self._replace(
            peak_torque=factor * self.peak_torque, continuous_torque=factor * self.continuous_torque
        )

    @property
    def requirements(self) -> dict[str, object]:
        """As a design file has them."""
        return {
            "ratio": self.ratio,
            "peak_torque": f"{self.peak_torque} N*m",
            "continuous_torque": f"{self.continuous_torque} N*m",
            "continuous_speed": self.speed,
            "motor": self.motor,
            "outer_diameter": f"{self.outer_diameter} m",
            "length": f"{self.length} m",
            "life": f"{self.life_hours} h",
            "disc_count": self.disc_count,
            "disc_material": self.material,
            "ring_material": self.material,
        }


def drawn_design(space: Space, place: np.ndarray) -> Design | None:
    """The design of a place in the unit cube, (8,); None where no bearing goes in."""
    n, outer = space.ratio, 0.5 * space.outer_diameter
    pitch = outer * (0.72 + 0.24 * place[0])
    throw = pitch / (n + 1) * (0.2 + 0.7 * place[1])
    most = min(float(undercut_radius_limit(n, pitch, throw)), pitch * math.sin(math.pi / (n + 1)))
    tooth = most * (0.15 + 0.8 * place[2])
    room = space.length / space.disc_count
    thickness = min(max(room * (0.3 + 0.65 * place[3]), 2e-3), room - 0.3e-3)
    diameter = PIN_DIAMETERS[min(int(place[4] * len(PIN_DIAMETERS)), len(PIN_DIAMETERS) - 1)]
    count = 3 + int(place[5] * 15)
    root = pitch - tooth - throw
    circle = root * (0.4 + 0.5 * place[6])
    within = circle - 0.5 * diameter - throw - 1e-3
    rows = [
        row
        for row in bearings().values()
        if row.kind in {"ball", "needle"}
        and 0.5 * row.outer_diameter < within
        and row.width <= thickness + 1e-9
        and row.bore_diameter > 2.0 * throw + 4e-3
        and row.static_rating is not None
    ]
    if not rows:
        return None
    rows.sort(key=lambda row: row.static_rating or 0.0)
    bearing = rows[min(int(place[7] * len(rows)), len(rows) - 1)]
    mapping: dict[str, Any] = {
        "name": "by-chance",
        "requirements": space.requirements,
        **space.tables,
        "reducer": {
            "ratio": n,
            "ring_pitch_radius": f"{pitch:.6f} m",
            "eccentricity": f"{throw:.6f} m",
            "ring_pin_diameter": f"{2.0 * tooth:.6f} m",
            "disc_count": space.disc_count,
            "disc_thickness": f"{thickness:.6f} m",
            "disc_material": space.material,
            "ring_material": space.material,
            "output_pins": {
                "count": count,
                "diameter": f"{diameter} m",
                "circle_radius": f"{circle:.6f} m",
            },
            "carrier": {"joint": "clamped"},
            "cam_bearing": {"designation": bearing.designation},
            "ring": {"outer_diameter": f"{space.outer_diameter} m"},
        },
    }
    if space.clearances is not None:
        profile, holes = space.clearances
        mapping["reducer"]["modification"] = {"equidistant": profile}
        mapping["reducer"]["output_pins"]["hole_clearance"] = holes
    try:
        return Design.from_mapping(mapping)
    except DesignError:
        return None


def reserve(design: Design) -> float:
    """Least margin of the load lines by the equilibrium; 0 where shape or room is wrong."""
    try:
        machine = resolve(design)
        state = machine.analysis
        for line in state.checks:
            loads = line.id.startswith((*_LOADS, "MOTOR-"))
            if line.status != "pass" and (not loads or line.id == "MOTOR-BORE"):
                return 0.0
        rough = [one.margin for one in state.checks if one.known and one.id.startswith(_LOADS)]
        if min(rough) < 0.2:
            return 0.01 * min(rough)
        rigid, peak = ContactModel.from_design(design), design.requirements.peak_torque
        loads = PeakLoads.of(peak, LoadedContacts(rigid).greatest(peak))
        lines = (*peak_checks(state, loads), *lasting_checks(state, life(design, rigid)))
    except (ContactError, DesignError):
        return 0.0
    return min((line.margin if line.known else 0.0) for line in lines)


class Strong(NamedTuple):
    """What chance leads to."""

    space: Space
    """With the torques that are just borne."""
    design: Design


def strongest(space: Space, seed: int) -> Strong | None:
    """The design with the most reserve that chance leads to, and the torques that it bears."""
    place = strongest_place(space, seed)
    if place is None:
        return None
    low, high = 0.01, 20.0
    for _ in range(12):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if _at(space, place, middle) >= 1.0 else (low, middle)
    borne = space.times(low)
    design = drawn_design(borne, place)
    return None if design is None or reserve(design) < 1.0 else Strong(borne, design)


def strongest_place(space: Space, seed: int) -> np.ndarray | None:
    """The place in the unit cube, (8,), of the design with the most reserve."""
    draw = np.random.default_rng(seed)
    most, place = 0.0, None
    for turn in range(_RANDOM + _STEPS):
        if place is None or turn < _RANDOM:
            tried = draw.random(8)
        else:
            moved = draw.random(8) < 0.5
            step = draw.normal(0.0, draw.choice([0.01, 0.05, 0.15]), 8)
            tried = np.clip(place + moved * step, 0.0, 0.999)
        value = _at(space, tried, 1.0)
        if value > most:
            most, place = value, tried
    return place


def _at(space: Space, place: np.ndarray, times: float) -> float:
    design = drawn_design(space.times(times), place)
    return 0.0 if design is None else reserve(design)
