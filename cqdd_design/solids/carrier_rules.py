"""The rules of the output carrier: pins and columns between plate and cap, heights and seats."""

from __future__ import annotations

import math

from cqdd_design.catalog.screws import column_screw
from cqdd_design.design import Design
from cqdd_design.design.reducer import Reducer
from cqdd_design.errors import GeometryError
from cqdd_design.geometry.columns import column_offsets, has_columns
from cqdd_design.solids.dowel_rules import flange_dowels
from cqdd_design.solids.layout import CarrierLayout, ColumnLayout, PackLayout
from cqdd_design.solids.registers import NUT_SLOTS, spigot_depth
from cqdd_design.solids.selection import (
    ChosenBearing,
    OutputPin,
    cap_screw,
    counterbore_of,
    thread_size,
)
from cqdd_design.solids.shims import output_shims, shaft_shims

_ENGAGEMENT = 1.3
"""Least length of a column's screw in the plate, in threads."""
_BETWEEN_HEADS = 0.4e-3
"""Least wall between recesses for heads, m."""
_CLAMP_RIM = 0.8
"""Least thickness of the ring clamp between housing and cover, units."""
CLAMPED_SEAT = 1.0
"""Least length of a pin's seat in the cap that holds its slope, in diameters."""
_LEAST_SEAT = 0.75
"""Least length of a pin's seat, in diameters: what it bears of a moment grows with the square of
that."""


def pin_wall(diameter: float, unit: float) -> float:
    """Material of the cap around a pin or its counterbore, m."""
    return max(1.0 * unit, 0.375 * diameter)


def counterbore_radius(pin: OutputPin) -> float:
    """Radius of the counterbore for a pin's head, m; that of the pin for a dowel."""
    if pin.screw is None:
        return 0.5 * pin.nominal_diameter
    return 0.5 * counterbore_of(pin.head_diameter)


def column_head_radius(reducer: Reducer) -> float:
    """Radius of the recess in the cap for the head of a column's screw, m; 0 without columns."""
    if not has_columns(reducer):
        return 0.0
    thread = column_screw(reducer.carrier.column_diameter).thread
    return 0.5 * cap_screw(thread, 0.0).counterbore[0]


def reach_beside_circle(reducer: Reducer) -> float:
    """How far pins and columns stand out from their circle in the plate, m."""
    return 0.5 * max(reducer.output_pins.diameter, reducer.carrier.column_diameter)


def lay_out_carrier(
    design: Design,
    pin: OutputPin,
    pack: PackLayout,
    support: ChosenBearing,
    output: ChosenBearing,
    core: float,
    unit: float,
    most_shoulder: float,
) -> CarrierLayout:
    """Lay out plate, cap, nut and pins around the pack of discs.

    Parameters
    ----------
    support, output : ChosenBearing
        Of shaft and carrier.
    core : float
        Radius of the shaft's core, m.
    unit : float
        A millimetre at the scale of this machine, m.
    most_shoulder : float
        Room for the plate's shoulder inside the ring clamp, radius, m.

    Raises
    ------
    GeometryError
        When the pins leave no room for the plate inside the ring.
    """
    pins = design.reducer.output_pins
    circle, diameter = pins.circle_radius, pins.diameter
    wall = pin_wall(diameter, unit)
    both, joint = pins.support == "both", design.reducer.carrier.joint
    counterbore = counterbore_radius(pin)
    beside = column_head_radius(design.reducer)
    most_outer = pack.inner_radius - 0.4 * unit
    # A catalogue head may be too large for a dense pin circle; ground dowels always fit.
    apart = 2.0 * circle * math.sin(math.pi / pins.count)
    between = max(0.4 * unit, _BETWEEN_HEADS)
    crowded = apart < 2.0 * counterbore + between
    if beside:
        apart = 2.0 * circle * math.sin(0.5 * math.pi / pins.count)
        crowded |= apart < counterbore + beside + between
    inward = circle - counterbore - core < unit
    outward = circle + counterbore + 0.4 * unit > most_outer
    if crowded or inward or outward:
        pin = pin.as_dowel()
    if pin.screw is None:
        counterbore = 0.0
    around = max(counterbore, beside, reach_beside_circle(design.reducer))

    bottom = pack.top + pack.gap
    span = bottom + pack.gap
    register, web = _seat_depths(pin, span, both, unit, clamped=joint == "clamped")
    shoulder_bottom = -pack.gap - web
    cap_bottom = shoulder_bottom - pin.head_height if both else -pack.gap
    columns = None
    if beside:
        columns = _lay_out_columns(design.reducer, pack, cap_bottom, beside, unit)
        cap_bottom = columns.seat - columns.screw.counterbore[1]
    lowest = min(cap_bottom, shoulder_bottom - pin.head_height)

    clamp = max(2.5 * unit, pack.gap + 1.5 * unit, 2.0 * spigot_depth(unit) + _CLAMP_RIM * unit)
    if pack.held_pins is not None:
        clamp = max(clamp, pack.relief + pack.held_pins.depth + 0.8 * unit)
    shoulder = min(output.shoulder_radius, most_shoulder)
    if shoulder < 0.5 * output.bearing.bore_diameter + 0.05 * unit:
        raise GeometryError(
            f"output_pins.circle_radius {circle * 1e3:.6g} mm leaves no room for the carrier plate "
            f"inside a ring of {2e3 * pack.ring_radius:.6g} mm; raise ring.outer_diameter to "
            f"{2e3 * (pack.ring_radius + 3.0 * unit):.4g} mm, or lower circle_radius."
        )
    bearing_bottom = pack.top + clamp
    bearing_top = bearing_bottom + output.bearing.width
    shims = shaft_shims(support)
    shaft_seat_top = bottom + support.bearing.width + shims.room
    nut_top = bearing_top + max(3.0 * unit, 0.05 * output.bearing.bore_diameter)
    plate_top = max(
        nut_top + 1.0 * unit,
        bottom + register + pin.thread_length + 0.5 * unit,
        (columns.thread_top if columns else bottom) + 0.5 * unit,
        shaft_seat_top + 1.5 * unit,
    )
    threads = max(diameter, columns.screw.thread if columns else 0.0)
    room = circle - 0.5 * threads - 0.5 * support.bearing.outer_diameter
    bolt_circle = 0.5 * support.bearing.outer_diameter + 0.5 * room
    # Six bolts stand their circle's radius apart.
    bolt = thread_size(min(0.55 * room, bolt_circle / 2.0, 4.0 * unit))
    if bolt > min(0.7 * room, bolt_circle / 1.5):
        bolt = 0.0
    # Beside the shaft's bearing where a wall stays, else above it.
    beside_seat = 0.5 * (room - bolt) >= 0.8 * unit
    bolt_room = plate_top - (bottom if beside_seat else shaft_seat_top)
    depth = bolt_room - (1.0 if beside_seat else 0.5) * unit
    return CarrierLayout(
        joint=joint,
        columns=columns,
        pin=pin,
        pin_count=pins.count,
        pin_circle_radius=circle,
        clocking=pins.hole_clocking,
        shoulder_bottom=shoulder_bottom,
        shoulder_top=bottom + register,
        cap=both,
        cap_bottom=cap_bottom,
        # Between the shaft's core and the pins, whatever room there is.
        cap_inner=max(circle - around - wall, 0.5 * (core + circle - around)),
        cap_outer=min(circle + around + wall, most_outer),
        counterbore_radius=counterbore,
        lowest=lowest,
        output=output,
        shoulder_radius=shoulder,
        plate_bottom=bottom,
        bearing_bottom=bearing_bottom,
        bearing_top=bearing_top,
        nut_top=nut_top,
        plate_top=plate_top,
        nut_radius=0.5 * _whole_tenth(output.bearing.bore_diameter - 0.5 * unit),
        nut_slots_bottom=nut_top - NUT_SLOTS * (nut_top - bearing_top),
        bolt_thread=bolt,
        bolt_circle_radius=bolt_circle,
        bolt_depth=min(2.0 * bolt, depth),
        bolt_room=bolt_room,
        flange_dowels=flange_dowels(
            design, bolt_circle, bolt, min(0.7 * room, room - 1.6 * unit), depth, unit
        ),
        shaft_seat_top=shaft_seat_top,
        shaft_shim=shims,
        output_shim=output_shims(output),
    )


def _whole_tenth(diameter: float) -> float:
    """Down to a tenth of a millimetre, m: taps and gauges are made for a thread's diameter.

    Examples
    --------
    >>> round(1e3 * _whole_tenth(49.5424e-3), 9)
    49.5
    """
    return round(math.floor(1e4 * diameter + 1e-6) * 1e-4, 9)


def _lay_out_columns(
    reducer: Reducer, pack: PackLayout, cap_bottom: float, head_radius: float, unit: float
) -> ColumnLayout:
    """Columns in a cap whose lower face is at `cap_bottom` (m) for the pins' sake, or lower."""
    diameter = reducer.carrier.column_diameter
    size = column_screw(diameter)
    deep = cap_screw(size.thread, 0.0).counterbore[1]
    under_head = max(1.0 * unit, 0.8 * size.thread)
    seat = min(cap_bottom + deep, -pack.gap - under_head)
    grip = pack.top + pack.gap - seat
    return ColumnLayout(
        count=reducer.carrier.column_count,
        angle=reducer.output_pins.hole_clocking + float(column_offsets(reducer)[0]),
        radius=0.5 * diameter,
        bore_radius=0.5 * size.bore,
        screw=cap_screw(size.thread, grip + _ENGAGEMENT * size.thread),
        counterbore_radius=head_radius,
        seat=seat,
    )


def _seat_depths(
    pin: OutputPin, span: float, both: bool, unit: float, *, clamped: bool
) -> tuple[float, float]:
    """Depth of the pin's seat in the plate, and length of shoulder below the pack, m.

    Screws come in steps of length; what a step is too long is shared between both seats.
    """
    diameter = pin.nominal_diameter
    seat = CLAMPED_SEAT * diameter if clamped else 0.0
    if pin.screw is None:
        web = max(2.5 * unit, _LEAST_SEAT * diameter, seat) if both else 0.0
        return pin.shoulder_length(span + web + 1.5 * diameter) - span - web, web
    least_register = max(1.0 * unit, _LEAST_SEAT * diameter)
    least_web = max(1.5 * unit, _LEAST_SEAT * diameter, seat) if both else 0.0
    spare = pin.shoulder_length(span + least_register + least_web) - span
    if both:
        register = max(least_register, min(0.5 * spare, spare - least_web))
    else:
        register = min(spare, 1.5 * diameter)
    return register, spare - register
