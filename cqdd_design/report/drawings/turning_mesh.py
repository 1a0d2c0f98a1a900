"""The turning mesh: its poster, which stands without a script, and the data of its script.

The poster is drawn by the package's own load law. The script (``templates/mesh.js``) computes the
same law from a dozen numbers, so it can show any crank angle; a test holds the two together.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cqdd_design.gearbox import rigid
from cqdd_design.report.drawings.outlines import Machine
from cqdd_design.report.ink.numbers import decimals, significant
from cqdd_design.report.ink.svg import (
    Figure,
    View,
    circle,
    contour_path,
    element,
    fixed,
    group,
    line,
    part_path,
)

#: Crank angle of the still picture, degrees: no lobe on an axis, so nothing looks special.
POSTER_ANGLE_DEG = 30.0
_SIZE = 560.0
_MARGIN = 12.0
#: Length of the cam bearing's arrow at its greatest, as a share of the ring pitch radius.
_LONGEST_ARROW = 0.8


@dataclass(frozen=True)
class MeshState:
    """Forces on one disc at one crank angle: N, and places in mm.

    Attributes
    ----------
    ring_force, ring_normal, ring_point : arrays (n+1,), (n+1, 2), (n+1, 2)
    pin_force, pin_point : arrays (N_w,), (N_w, 2)
    pin_direction, cam_force, centre : arrays (2,)
    """

    ring_force: NDArray[np.float64]
    ring_normal: NDArray[np.float64]
    ring_point: NDArray[np.float64]
    pin_force: NDArray[np.float64]
    pin_point: NDArray[np.float64]
    pin_direction: NDArray[np.float64]
    cam_force: NDArray[np.float64]
    centre: NDArray[np.float64]


def mesh_state(machine: Machine, torque: float, crank_angle: float, disc: int = 0) -> MeshState:
    """Rigid-law forces on one disc.

    Parameters
    ----------
    machine : Machine
    torque : float
        Output torque, N m, shared equally by the discs.
    crank_angle : float
        rad.
    disc : int
        From 0.
    """
    reducer = machine.design.reducer
    share = torque / reducer.disc_count
    own = np.array([crank_angle + machine.phase(disc)])
    ring = rigid.ring_stage(
        reducer.ratio,
        reducer.ring_pitch_radius,
        reducer.eccentricity,
        0.5 * reducer.ring_pin_diameter,
        share,
        own,
    )
    pins = rigid.output_stage(
        reducer.ratio,
        reducer.output_pins.count,
        reducer.output_pins.circle_radius,
        0.5 * machine.pin_diameter,
        share,
        own,
        reducer.output_pins.hole_clocking + machine.phase(disc) / reducer.ratio,
    )
    direction = pins.normal[0]
    cam = -(ring.force[0] @ ring.normal[0] + pins.force[0].sum() * direction)
    return MeshState(
        ring_force=ring.force[0],
        ring_normal=ring.normal[0],
        ring_point=1e3 * ring.point[0],
        pin_force=pins.force[0],
        pin_point=1e3 * pins.point[0],
        pin_direction=direction,
        cam_force=cam,
        centre=-1e3 * reducer.eccentricity * direction,
    )


def arrow_path(
    tip: NDArray[np.float64], force: float, along: NDArray[np.float64], mm_per_newton: float
) -> str:
    """Path data of an arrow (page mm, y down) whose tip stands where the force acts."""
    length = force * mm_per_newton
    if length < 0.05:
        return "M0 0"
    head = min(2.4, 0.6 * length)
    width, half = 0.28, min(0.85, 0.3 * length)

    def at(back: float, side: float) -> str:
        x = tip[0] - back * along[0] - side * along[1]
        y = tip[1] - back * along[1] + side * along[0]
        return f"{fixed(float(x), 3)} {fixed(-float(y), 3)}"

    corners = [(0.0, 0.0), (head, half), (head, width), (length, width)]
    corners += [(length, -width), (head, -width), (head, -half)]
    return "M" + "L".join(at(*corner) for corner in corners) + "Z"


def mm_per_newton(machine: Machine, cam_load: float) -> float:
    """Scale of the arrows, from the greatest cam bearing load (N)."""
    return _LONGEST_ARROW * 1e3 * machine.design.reducer.ring_pitch_radius / cam_load


def mesh_data(machine: Machine, torque: float, cam_load: float) -> dict[str, float]:
    """What the script needs: the gearbox in mm, N and N m."""
    reducer = machine.design.reducer
    pins = reducer.output_pins
    return {
        "lobe_count": reducer.ratio,
        "disc_count": reducer.disc_count,
        "pin_count": pins.count,
        "ring_pitch_radius": 1e3 * reducer.ring_pitch_radius,
        "eccentricity": 1e3 * reducer.eccentricity,
        "tooth_radius": 500.0 * reducer.ring_pin_diameter,
        "pin_circle_radius": 1e3 * pins.circle_radius,
        "pin_contact_radius": 500.0 * machine.pin_diameter,
        "hole_clocking": pins.hole_clocking,
        "torque_Nm": torque,
        "mm_per_newton": mm_per_newton(machine, cam_load),
        "poster_angle_deg": POSTER_ANGLE_DEG,
    }


def mesh_readout(machine: Machine, torque: float) -> dict[str, str]:
    """What stands beside the poster; the script writes the same for every other angle."""
    state = mesh_state(machine, torque, math.radians(POSTER_ANGLE_DEG))
    tooth, pin = int(state.ring_force.argmax()), int(state.pin_force.argmax())
    thin = "\u202f"
    return {
        "crank": f"{decimals(POSTER_ANGLE_DEG, 1)}\u00b0",
        "carrier": f"{decimals(-POSTER_ANGLE_DEG / machine.design.reducer.ratio, 1)}\u00b0",
        "ring_force": f"{decimals(state.ring_force[tooth], 0)}{thin}N on tooth {tooth + 1}",
        "pin_force": f"{decimals(state.pin_force[pin], 0)}{thin}N on pin {pin + 1}",
        "cam_force": f"{decimals(float(np.hypot(*state.cam_force)), 0)}{thin}N",
    }


def mesh_figure(machine: Machine, torque: float, cam_load: float) -> Figure:
    """The poster: ring, discs, carrier pins, crank and the forces on the first disc."""
    reducer = machine.design.reducer
    outer = 500.0 * reducer.ring.outer_diameter
    scale = (_SIZE - 2.0 * _MARGIN) / (2.0 * outer)
    view = View(1e3, (0.0, 0.0))
    angle = math.radians(POSTER_ANGLE_DEG)
    parts = [element("path", d=part_path(machine.ring, view), class_="ring")]
    parts += [
        element("path", d=contour_path(pin, view), class_="ring-pin") for pin in machine.ring_pins
    ]
    stack = [_disc(machine, disc, angle, view) for disc in range(reducer.disc_count)]
    parts.append(group(reversed(stack), class_="mesh-discs"))
    parts += [_cam(machine, disc, angle) for disc in range(reducer.disc_count - 1, -1, -1)]
    parts += [_carrier(machine, angle), _crank(machine, angle)]
    state = mesh_state(machine, torque, angle)
    parts.append(_arrows(state, mm_per_newton(machine, cam_load)))
    body = group(
        parts,
        transform=f"translate({fixed(_SIZE / 2)} {fixed(_SIZE / 2)}) scale({fixed(scale, 4)})",
        class_="mesh",
    )
    return Figure(
        "mesh",
        "The mesh under load",
        f"Ring with {reducer.ring_tooth_count} teeth, disc with {reducer.ratio} lobes and "
        f"{reducer.output_pins.count} output pins, with the contact forces at "
        f"{significant(torque)} N·m.",
        _SIZE,
        _SIZE,
        body,
    )


def _disc(machine: Machine, disc: int, crank_angle: float, view: View) -> str:
    reducer = machine.design.reducer
    own = crank_angle + machine.phase(disc)
    e = 1e3 * reducer.eccentricity
    place = f"translate({fixed(e * math.cos(own), 4)} {fixed(-e * math.sin(own), 4)})"
    shape = element("path", d=part_path(machine.discs[disc], view), class_="disc-body")
    # A mark on one lobe makes the slow turning visible.
    tip = 1e3 * machine.profile.tip_distance
    mark = math.pi / reducer.ratio
    dot = circle(((tip - 2.0) * math.cos(mark), -(tip - 2.0) * math.sin(mark)), 0.7, "disc-mark")
    return group(
        [shape, dot],
        class_="mesh-disc" if disc == 0 else "mesh-disc behind",
        data_disc=str(disc),
        transform=f"{place} rotate({fixed(math.degrees(own) / reducer.ratio, 4)})",
    )


def _cam(machine: Machine, disc: int, crank_angle: float) -> str:
    own = crank_angle + machine.phase(disc)
    e = 1e3 * machine.design.reducer.eccentricity
    bearing = machine.bearing
    return group(
        [
            circle((0.0, 0.0), 500.0 * bearing.outer_diameter, "bearing"),
            circle((0.0, 0.0), 500.0 * bearing.bore_diameter, "cam"),
        ],
        class_="mesh-cam" if disc == 0 else "mesh-cam behind",
        data_disc=str(disc),
        transform=f"translate({fixed(e * math.cos(own), 4)} {fixed(-e * math.sin(own), 4)})",
    )


def _carrier(machine: Machine, crank_angle: float) -> str:
    reducer = machine.design.reducer
    pins = reducer.output_pins
    radius = 1e3 * pins.circle_radius
    shapes = []
    for j in range(pins.count):
        at = pins.hole_clocking + 2.0 * math.pi * j / pins.count
        shapes.append(
            circle(
                (radius * math.cos(at), -radius * math.sin(at)),
                500.0 * machine.pin_diameter,
                "pin first" if j == 0 else "pin",
            )
        )
    turn = math.degrees(crank_angle) / reducer.ratio
    return group(shapes, class_="mesh-carrier", transform=f"rotate({fixed(turn, 4)})")


def _crank(machine: Machine, crank_angle: float) -> str:
    reach = 500.0 * machine.bearing.bore_diameter
    return group(
        [line((0.0, 0.0), (0.72 * reach, 0.0), "crank-hand"), circle((0.0, 0.0), 0.9, "axis-dot")],
        class_="mesh-crank",
        transform=f"rotate({fixed(-math.degrees(crank_angle), 4)})",
    )


def _arrows(state: MeshState, scale: float) -> str:
    shapes = [
        element("path", d=arrow_path(point, float(force), normal, scale), class_="force force-ring")
        for point, force, normal in zip(
            state.ring_point, state.ring_force, state.ring_normal, strict=True
        )
    ]
    shapes += [
        element(
            "path",
            d=arrow_path(point, float(force), state.pin_direction, scale),
            class_="force force-pin",
        )
        for point, force in zip(state.pin_point, state.pin_force, strict=True)
    ]
    load = float(np.hypot(*state.cam_force))
    shapes.append(
        element(
            "path",
            d=arrow_path(state.centre, load, state.cam_force / load, scale),
            class_="force force-cam",
        )
    )
    return group(shapes, class_="mesh-forces")
