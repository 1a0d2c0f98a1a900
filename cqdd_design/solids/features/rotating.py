"""Features of the rotating group: eccentric shaft, loose cam, sleeves, pins."""

from __future__ import annotations

import math

from cqdd_design.catalog.adhesives import ROTOR_COMPOUND
from cqdd_design.catalog.fits import fit_limits
from cqdd_design.geometry.output_pins import RUNNER_BORE
from cqdd_design.solids.features import zones
from cqdd_design.solids.features.holes import Centre, Facing
from cqdd_design.solids.features.kinds import Feature, Joint, Seat
from cqdd_design.solids.features.making import BEARING_FACE, SHAFT_RIM, relief, seat, shoulder
from cqdd_design.solids.layout import PackLayout, ShaftLayout
from cqdd_design.solids.motor_layout import InrunnerLayout, MotorEnd
from cqdd_design.solids.registers import LEAD_IN

_MM, _UM = 1e3, 1e6


def crank_offset(pack: PackLayout, disc: int) -> Centre:
    """Centre of a lobe of the shaft at crank angle 0, m."""
    phase = 2.0 * math.pi * disc / pack.disc_count
    return pack.eccentricity * math.cos(phase), pack.eccentricity * math.sin(phase)


def shaft_features(
    pack: PackLayout, shaft: ShaftLayout, motor: MotorEnd | None, position: float
) -> tuple[Feature, ...]:
    """Of the eccentric shaft; its datum is the common axis A-B of its journals.

    Parameters
    ----------
    position : float
        Diameter of the zone of a lobe's axis, m.
    """
    found = journal_features(shaft)
    lobes = min(pack.disc_count, 2)
    for disc in range(lobes):
        beside: Facing | None = None if lobes < 2 else "up" if disc else "down"
        found += lobe_features(pack, shaft, disc, position, collar=beside)
    if pack.disc_count > 2:
        core = seat(
            "seat of the eccentric cam", 2.0 * shaft.shoulder_radius, pack.cam_top(1),
            pack.cam_top(2), zones.PRESSED_CAM, ground=True, refers="A-B",
        )  # fmt: skip
        how = _pressed_on(pack, position)
        found += [core, Joint("eccentric cam", "pressed", core.name, "eccentric cam", how)]
    if motor is not None:
        found += _motor_end(shaft, motor)
    return tuple(found)


def _pressed_on(pack: PackLayout, position: float) -> str:
    """How the loose cam is put on: round as its seat is, only a measurement turns it right.

    The zone (m) of the lobes' axes is what it may be turned off by.
    """
    angle = 2.0 * 360.0 / pack.disc_count
    off = math.degrees(0.5 * position / pack.eccentricity)
    return (
        f"light press fit, bonded over its whole bore with {ROTOR_COMPOUND.name}; turned, before "
        f"that sets, till lobe 3 is at {angle:g}\u00b0 from lobe 1, \u00b1{off:.2g}\u00b0, and its "
        f"axis within \u00d8{_MM * position:.3g} of its place to A-B"
    )


def journal_features(shaft: ShaftLayout) -> list[Feature]:
    """Journals, the shoulders between them, and their undercuts."""
    bearing = shaft.support.bearing
    bore, corner = bearing.bore_diameter, bearing.largest_fillet
    lower = seat(
        "lower journal and rotor seat", bore, shaft.bottom, shaft.lower_seat_top, zones.JOURNAL,
        ground=True, datum="A", refers="A-B",
    )  # fmt: skip
    upper = seat(
        "upper journal", bore, shaft.upper_seat_bottom, shaft.top, zones.JOURNAL,
        ground=True, datum="B", refers="A-B",
    )  # fmt: skip
    reach = min(bearing.width, lower.top - lower.bottom)
    ends = (
        shoulder("lower shoulder", shaft.lower_seat_top, 0.5 * bore, shaft.shoulder_radius, "down",
                 lower, refers="A-B", along=BEARING_FACE, rim=SHAFT_RIM),
        shoulder("upper shoulder", shaft.upper_seat_bottom, 0.5 * bore, shaft.shoulder_radius, "up",
                 upper, refers="A-B", along=BEARING_FACE, rim=SHAFT_RIM),
    )  # fmt: skip
    reliefs = (
        relief("undercut of the lower journal", lower, "down", corner, length=reach),
        relief("undercut of the upper journal", upper, "up", corner, length=reach),
    )
    return [lower, upper, *ends, *(one for one in reliefs if one is not None)]


def lobe_features(
    pack: PackLayout,
    shaft: ShaftLayout,
    disc: int,
    position: float,
    *,
    collar: Facing | None,
    refers: str = "A-B",
    zone: str = zones.LOBE,
) -> list[Feature]:
    """A lobe, and the face of the collar beside it.

    Its corner is a fillet: an undercut, on one side of it, would unbalance the crank.

    Parameters
    ----------
    position : float
        Diameter of the zone of its axis, m.
    collar : {"up", "down"} or None
        The way the collar's face looks, if it has one.
    refers : str
        Letters of the datums of the part that has it.
    """
    bearing = pack.cam.bearing
    lobe = seat(
        f"lobe {disc + 1}", bearing.bore_diameter, pack.cam_bottom(disc), pack.cam_top(disc),
        zone, ground=True, refers=refers, centre=crank_offset(pack, disc), position=position,
    )  # fmt: skip
    if collar is None:
        return [lobe]
    height = lobe.bottom if collar == "up" else lobe.top
    inner = 0.5 * bearing.bore_diameter - pack.eccentricity
    face = shoulder(
        f"collar beside lobe {disc + 1}", height, inner, shaft.web_radius, collar, lobe,
        fillet=bearing.largest_fillet, refers=refers, along=BEARING_FACE,
    )  # fmt: skip
    return [lobe, face]


def _motor_end(shaft: ShaftLayout, motor: MotorEnd) -> list[Feature]:
    """The stub for the rotor, and for a ring magnet; the pocket of a magnet that is inside."""
    name = "rotor hub" if isinstance(motor, InrunnerLayout) else "rotor bell"
    bell = Joint(name, "bonded", "lower journal and rotor seat", name, "bond on the stub")
    if motor.open:
        return [bell, Joint("encoder magnet", "bonded", "lower journal and rotor seat",
                            "encoder magnet", "bond on the stub")]  # fmt: skip
    if motor.magnet_bottom < shaft.bottom - 1e-9:
        return [bell]
    top = shaft.bottom + motor.magnet_height
    pocket = seat(
        "pocket of the encoder's magnet", 2.0 * motor.magnet_radius, shaft.bottom, top,
        zones.MAGNET_POCKET, inside=True, refers="A-B",
    )  # fmt: skip
    bond = Joint("encoder magnet", "bonded", pocket.name, "encoder magnet", "bond in its pocket")
    return [bell, pocket, bond]


def loose_cam_features(
    pack: PackLayout, shaft: ShaftLayout, position: float
) -> tuple[Feature, ...]:
    """Of the cam of the third disc; its datum is its bore."""
    bore = seat(
        "bore", 2.0 * shaft.shoulder_radius, pack.cam_top(1), pack.cam_top(2), zones.CAM_BORE,
        inside=True, ground=True, datum="A", lead_in=LEAD_IN,
    )  # fmt: skip
    lobe = lobe_features(pack, shaft, 2, position, collar="up", refers="A", zone=zones.LOOSE_LOBE)
    how = _ground_before(pack, shaft)
    on = Joint("eccentric shaft", "pressed", bore.name, "eccentric shaft", how)
    return (bore, *lobe, on)


def _ground_before(pack: PackLayout, shaft: ShaftLayout) -> str:
    """When the lobe is ground, and what the press fit does to it: it grows by delta a/b."""
    size, bore = 2.0 * shaft.shoulder_radius, pack.cam.bearing.bore_diameter
    most = fit_limits(zones.PRESSED_CAM, size).upper - fit_limits(zones.CAM_BORE, size).lower
    grown = _UM * most * size / bore
    return (
        f"bonded over the whole bore with {ROTOR_COMPOUND.name}; the lobe is ground before, for "
        f"disc 2 and its cam bearing are on the shaft by then and nothing can be ground after. At "
        f"most {_UM * most:.0f} µm of interference make it grow by {grown:.1f} µm, hence "
        f"its {zones.LOOSE_LOBE}"
    )


def sleeve_features(inner: float, outer: float, length: float) -> tuple[Feature, ...]:
    """Of a sleeve or roller that turns on a pin: bore and outside, ground."""
    return (
        seat("bore", inner, 0.0, length, RUNNER_BORE, inside=True, ground=True, datum="A"),
        seat("outside", outer, 0.0, length, zones.RUNNER, ground=True, refers="A"),
    )


def pin_features(diameter: float, bottom: float, top: float, zone: str) -> tuple[Seat, ...]:
    """Of a ground pin."""
    return (seat("outside", diameter, bottom, top, zone, ground=True, datum="A"),)


RING_PIN_PLAY = BEARING_FACE
"""At either end of a ring pin, m: with a length as true as bearings' faces, no pin is longer than
the thinnest ring, whose clamp then presses the ring and not its pins."""


def ring_pin_features(diameter: float, bottom: float, top: float, zone: str) -> tuple[Feature, ...]:
    """Of a pin of a ring, whose length has limits."""
    (outside,) = pin_features(diameter, bottom, top, zone)
    end = shoulder("end", top, 0.0, 0.5 * diameter, "up", outside, along=BEARING_FACE)
    return (outside, end)
