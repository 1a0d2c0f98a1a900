"""Screws of the housing: of its cover, and of the holes by which it is fixed, held by friction."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from cqdd_design.catalog.materials import Material, find_material
from cqdd_design.catalog.threads import coarse_thread
from cqdd_design.catalog.tightening import GRIP_FRICTION, Clamping

if TYPE_CHECKING:
    from cqdd_design.design import Design, Requirements

SCREW_MATERIAL = "Alloy steel 12.9 (ISO 7379)"
"""Of mounting screws, and of every other that is not an output pin."""
_THREADS = (2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0)
"""Mounting screws that are tried, mm."""
_PAIRED, _ALONE = 0.46, 1.1
_COVER_RESERVES, _LARGER = (1.35, 1.1), 2
_RESERVE = 1.28
"""Of the clamping force over what the torque asks for, of cover (or at least: the force is
estimated, and larger screws are nearer to what SCREW-SLIP asks) and mounting."""


def forces(asked: Requirements, count: int, radius: float) -> tuple[float, float]:
    """Force across and along one of `count` screws on a circle (radius, m) of a housing, N.

    At the peak torque and the external loads of the requirements.
    """
    across = asked.peak_torque / radius + (asked.external_radial or 0.0)
    along = (asked.external_axial or 0.0) + 2.0 * (asked.external_moment or 0.0) / radius
    return across / count, along / count


def clamping(thread: float, grip: float, engaged: float, metal: Material) -> Clamping:
    """A mounting screw of a thread (m) from another machine's part into the housing's flange.

    Of the other part nothing is known: of the same metal, one and a half diameters thick.

    Parameters
    ----------
    grip, engaged : float
        Thickness of cover and clamp, and length of the flange's thread, m.
    """
    alone = _clamping(thread, grip + 1.5 * thread, metal)
    return replace(alone, tapped=metal, engaged=engaged, faces=3)


def _clamping(thread: float, grip: float, metal: Material) -> Clamping:
    """A screw of a thread (m) over a grip (m), of whose thread nothing is known.

    Proportions of the head are those of ISO 4762.
    """
    return Clamping(
        thread=coarse_thread(thread),
        screw=find_material(SCREW_MATERIAL),
        clamped=metal,
        tapped=None,
        bearing_outer=1.7 * thread,
        bearing_inner=1.1 * thread,
        grip=grip,
        engaged=0.0,
        faces=1,
    )


def cover_thread(design: Design, thread: float, count: int, grip: float) -> float:
    """The thread of the cover's screws (m): up to two sizes more where that is enough.

    What pushes the output bearing to one side is about the force of the torque on the pins' circle,
    and less than half of it where pins stand opposite each other on several discs.
    """
    pins, asked = design.reducer.output_pins, design.requirements
    metal, ring = find_material(design.housing.material), 0.5 * design.reducer.ring.outer_diameter
    paired = pins.count % 2 == 0 and design.reducer.disc_count > 1
    force = (_PAIRED if paired else _ALONE) * asked.peak_torque / pins.circle_radius
    force += asked.external_radial or 0.0
    along = (asked.external_axial or 0.0) + 2.0 * (asked.external_moment or 0.0) / ring
    larger = [mm * 1e-3 for mm in _THREADS if mm * 1e-3 > thread + 1e-9]
    coldest = design.environment.coldest

    def holds(size: float, reserve: float) -> bool:
        left = replace(_clamping(size, grip, metal), coldest=coldest).least_preload
        return (count * left - along) * GRIP_FRICTION >= reserve * force

    every = [(size, reserve) for reserve in _COVER_RESERVES for size in (thread, *larger[:_LARGER])]
    return next((size for size, reserve in every if holds(size, reserve)), thread)


def mounting_thread(
    asked: Requirements,
    count: int,
    radius: float,
    least: float,
    grip: float,
    engaged: float,
    metal: Material,
    coldest: float,
) -> float:
    """The least thread (m) that holds by friction, from `least` (m) to twice that; else the latter.

    Parameters
    ----------
    radius : float
        Of the circle, m.
    grip, engaged : float
        Of `clamping`, m.
    coldest : float
        That it has to hold at, deg C.
    """
    across, along = forces(asked, count, radius)
    sizes = [mm * 1e-3 for mm in _THREADS if least - 1e-9 <= mm * 1e-3 <= 2.0 * least + 1e-9]
    for size in sizes:
        cold = replace(clamping(size, grip, engaged, metal), coldest=coldest)
        held = (cold.least_preload - along) * GRIP_FRICTION
        if held >= _RESERVE * across:
            return size
    return sizes[-1]
