"""The turning mesh: its poster, which stands without a script, and the data of its script.

The poster is drawn by the package's own load law. The script (``templates/mesh.js``) computes the
same law from a dozen numbers, so it can show any crank angle; a test holds the two together.
"""

from __future__ import annotations

import math

import numpy as np

from cqdd_design.gearbox.disc_forces import DiscForces, disc_forces
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.report.drawings.outlines import Outlines
from cqdd_design.report.ink.numbers import THIN, decimals, significant
from cqdd_design.report.ink.svg import (
    Figure,
    View,
    Words,
    circle,
    element,
    fixed,
    group,
    line,
    part_shape,
)

POSTER_ANGLE_DEG = 30.0
"""Crank angle of the still picture, degrees: no lobe on an axis, so nothing looks special."""
_POSTER = math.radians(POSTER_ANGLE_DEG)
_SIZE = 560.0
_MARGIN = 12.0
_LONGEST_ARROW = 0.8
"""Length of the cam bearing's arrow at its greatest, as a share of the ring pitch radius."""
_PAGE = View(1e3, (0.0, 0.0))
"""The figure is drawn in mm and scaled as a whole."""


def arrow_path(tip: FloatArray, force: float, along: FloatArray, mm_per_newton: float) -> str:
    """Path data of an arrow (page mm, y down) whose tip (m) stands where the force acts."""
    length = force * mm_per_newton
    if length < 0.05:
        return "M0 0"
    head = min(2.4, 0.6 * length)
    width, half = 0.28, min(0.85, 0.3 * length)

    def at(back: float, side: float) -> str:
        x = 1e3 * tip[0] - back * along[0] - side * along[1]
        y = 1e3 * tip[1] - back * along[1] + side * along[0]
        return f"{fixed(float(x), 3)} {fixed(-float(y), 3)}"

    corners = [(0.0, 0.0), (head, half), (head, width), (length, width)]
    corners += [(length, -width), (head, -width), (head, -half)]
    return "M" + "L".join(at(*corner) for corner in corners) + "Z"


def mm_per_newton(outlines: Outlines, cam_load: float) -> float:
    """Scale of the arrows, from the greatest cam bearing load (N)."""
    return _LONGEST_ARROW * 1e3 * outlines.stages.ring_pitch_radius / cam_load


def mesh_data(outlines: Outlines, torque: float, cam_load: float) -> dict[str, float]:
    """What the script needs: the gearbox in mm, N and N m."""
    stages = outlines.stages
    return {
        "lobe_count": stages.lobe_count,
        "disc_count": stages.disc_count,
        "pin_count": stages.pin_count,
        "ring_pitch_radius": 1e3 * stages.ring_pitch_radius,
        "eccentricity": 1e3 * stages.eccentricity,
        "tooth_radius": 1e3 * stages.tooth_radius,
        "pin_circle_radius": 1e3 * stages.pin_circle_radius,
        "pin_contact_radius": 1e3 * stages.pin_contact_radius,
        "hole_clocking": stages.hole_clocking,
        "torque_Nm": torque,
        "mm_per_newton": mm_per_newton(outlines, cam_load),
        "poster_angle_deg": POSTER_ANGLE_DEG,
    }


def mesh_readout(outlines: Outlines, torque: float) -> dict[str, str]:
    """What stands beside the poster; the script writes the same for every other angle."""
    state = disc_forces(outlines.stages, torque, _POSTER)
    tooth, pin = int(state.ring_force.argmax()), int(state.pin_force.argmax())
    carrier = math.degrees(kinematics.carrier_angle(outlines.stages.lobe_count, _POSTER))
    return {
        "crank": f"{decimals(POSTER_ANGLE_DEG, 1)}\u00b0",
        "carrier": f"{decimals(carrier, 1)}\u00b0",
        "ring_force": f"{decimals(state.ring_force[tooth], 0)}{THIN}N on tooth {tooth + 1}",
        "pin_force": f"{decimals(state.pin_force[pin], 0)}{THIN}N on pin {pin + 1}",
        "cam_force": f"{decimals(float(np.hypot(*state.cam_force)), 0)}{THIN}N",
    }


def mesh_figure(outlines: Outlines, torque: float, cam_load: float) -> Figure:
    """The poster: ring, discs, carrier pins, crank and the forces on the first disc."""
    reducer = outlines.design.reducer
    scale = (_SIZE - 2.0 * _MARGIN) / (1e3 * reducer.ring.outer_diameter)
    order = range(reducer.disc_count - 1, -1, -1)
    state = disc_forces(outlines.stages, torque, _POSTER)
    parts = [
        *outlines.ring_shapes(_PAGE),
        group((_disc(outlines, disc) for disc in order), class_="mesh-discs"),
        *(_cam(outlines, disc) for disc in order),
        _carrier(outlines),
        _crank(outlines),
        _arrows(state, mm_per_newton(outlines, cam_load)),
    ]
    body = group(
        parts,
        transform=f"translate({fixed(_SIZE / 2)} {fixed(_SIZE / 2)}) scale({fixed(scale, 4)})",
        class_="mesh",
    )
    words = Words(
        "mesh",
        "The mesh under load",
        f"Ring with {reducer.ring_tooth_count} teeth, disc with {reducer.ratio} lobes and "
        f"{reducer.output_pins.count} output pins, with the contact forces at "
        f"{significant(torque)} N·m.",
    )
    return words.figure(_SIZE, _SIZE, [body])


def _turned(angle: float) -> str:
    """A transform by an angle that is counter-clockwise in the machine (rad)."""
    return f"rotate({fixed(-math.degrees(angle), 4)})"


def _moving(outlines: Outlines, kind: str, disc: int, shapes: list[str], *, turns: bool) -> str:
    """Shapes that go round with a disc's centre, turning with its lobes or not."""
    turn, (x, y) = outlines.disc_pose(disc, _POSTER)
    place = f"translate({fixed(1e3 * x, 4)} {fixed(-1e3 * y, 4)})"
    return group(
        shapes,
        class_=f"mesh-{kind}" if disc == 0 else f"mesh-{kind} behind",
        data_disc=str(disc),
        transform=f"{place} {_turned(turn)}" if turns else place,
    )


def _disc(outlines: Outlines, disc: int) -> str:
    shape = part_shape(outlines.discs[disc], _PAGE, "disc-body")
    # A mark on one lobe makes the slow turning visible.
    mark = _PAGE.polar(outlines.profile.tip_distance - 2e-3, outlines.profile.half_pitch)
    return _moving(outlines, "disc", disc, [shape, circle(mark, 0.7, "disc-mark")], turns=True)


def _cam(outlines: Outlines, disc: int) -> str:
    bearing = outlines.bearing
    shapes = [
        circle((0.0, 0.0), 500.0 * bearing.outer_diameter, "bearing"),
        circle((0.0, 0.0), 500.0 * bearing.bore_diameter, "cam"),
    ]
    return _moving(outlines, "cam", disc, shapes, turns=False)


def _carrier(outlines: Outlines) -> str:
    stages = outlines.stages
    shapes = [
        circle(
            _PAGE.polar(stages.pin_circle_radius, angle),
            _PAGE.length(stages.pin_contact_radius),
            "pin" if index else "pin first",
        )
        for index, angle in enumerate(outlines.pin_angles(0.0))
    ]
    shapes += outlines.column_shapes(_PAGE, 0.0)
    turn = float(kinematics.carrier_angle(stages.lobe_count, _POSTER))
    return group(shapes, class_="mesh-carrier", transform=_turned(turn))


def _crank(outlines: Outlines) -> str:
    reach = 500.0 * outlines.bearing.bore_diameter
    hand = line((0.0, 0.0), (0.72 * reach, 0.0), "crank-hand")
    shapes = [hand, circle((0.0, 0.0), 0.9, "axis-dot")]
    return group(shapes, class_="mesh-crank", transform=_turned(_POSTER))


def _arrows(state: DiscForces, scale: float) -> str:
    def arrow(kind: str, tip: FloatArray, force: float, along: FloatArray) -> str:
        data = arrow_path(tip, force, along, scale)
        return element("path", d=data, class_=f"force force-{kind}")

    load = float(np.hypot(*state.cam_force))
    ring = zip(state.ring_point, state.ring_force, state.ring_normal, strict=True)
    pins = zip(state.pin_point, state.pin_force, strict=True)
    shapes = [arrow("ring", point, float(force), normal) for point, force, normal in ring]
    shapes += [arrow("pin", point, float(force), state.pin_direction) for point, force in pins]
    shapes.append(arrow("cam", state.centre, load, state.cam_force / load))
    return group(shapes, class_="mesh-forces")
