"""The machine on paper: heights along the axis and turned dimensions of every part.

Section through a two-disc gearbox, output upward; z = 0 is the lower face of disc 0::

                     +---- carrier plate ----+  z_top
        cover  ______|  nut                  |______
              |lip __|_______ . . . ________ |__    |
              |__[ output bearing ]              ___|  bearing_bottom
        ==== ring clamp ====|__________________|====   pack_top (+ gap to the plate)
        |  | ring | disc 1   (cam bearing) |shaft|
        |  |      | disc 0   (cam bearing) |     |     0
        |  +------+ - cap - [support bearing]    |
        |__________housing floor_________________|     housing_bottom
                                     shaft stub for the rotor

The carrier hangs on one output bearing; the eccentric shaft runs in two support bearings, one in
the housing floor (inside the cap where there is room) and one in the carrier plate. Pins are
shoulder screws, head in the cap, thread in the plate. Where they hold the cap stiffly they are
bonded into a seat of one diameter in it; columns are tubes between plate and cap, each drawn
together by a screw from the cap. Dimensions that nothing else decides are proportions of the ring,
in *units* of a millimetre on a 72 mm ring.
"""

from __future__ import annotations

from dataclasses import dataclass

from cqdd_design.catalog.motors import Motor
from cqdd_design.design.reducer import CarrierJoint
from cqdd_design.solids.motor_layout import InrunnerLayout, MotorEnd, MotorLayout
from cqdd_design.solids.selection import CapScrew, ChosenBearing, OutputPin


@dataclass(frozen=True)
class HeldPins:
    """Ring pins that rollers leave free along the discs: housing and clamp hold their ends, m.

    Attributes
    ----------
    depth : float
        Of either end in its seat.
    """

    count: int
    circle_radius: float
    diameter: float
    depth: float


@dataclass(frozen=True)
class PackLayout:
    """Discs, ring and cam bearings, m.

    Attributes
    ----------
    disc_thickness, pitch, top, gap : float
        One disc; from disc to disc; upper face of the last disc; from the pack to cap and plate.
    cam : ChosenBearing
        Between eccentric and disc.
    reach : float
        Radius that the orbiting lobes sweep.
    ledge_radius : float
        Inner radius of the faces between which the ring lies.
    relief : float
        Height by which housing and clamp stand off the discs inside these faces.
    ring_play : float
        Of the ring between its ledge and the clamp, which rests on the housing.
    inner_radius : float
        Inner radius of housing and clamp beyond the relief; where they hold ring pins, they reach
        in over the discs.
    most_clamp_radius : float
        Largest bore of the ring clamp that still holds ring and pins.
    held_pins : HeldPins or None
        Of a ring with rollers.
    ring_radius : float
        Outside radius of the ring.
    """

    disc_thickness: float
    pitch: float
    top: float
    gap: float
    disc_count: int
    eccentricity: float
    cam: ChosenBearing
    reach: float
    ledge_radius: float
    relief: float
    ring_play: float
    inner_radius: float
    most_clamp_radius: float
    held_pins: HeldPins | None
    ring_radius: float

    def disc_bottom(self, disc: int) -> float:
        """Height of the lower face of a disc."""
        return disc * self.pitch

    def cam_bottom(self, disc: int) -> float:
        """Height of the lower face of a disc's cam bearing, centred in the disc."""
        width = self.cam.bearing.width
        return self.disc_bottom(disc) + 0.5 * (self.disc_thickness - width)

    def cam_top(self, disc: int) -> float:
        """Height of the upper face of a disc's cam bearing."""
        return self.cam_bottom(disc) + self.cam.bearing.width


@dataclass(frozen=True)
class ShaftLayout:
    """The eccentric shaft and its support bearings, m.

    Attributes
    ----------
    support : ChosenBearing
        The same at both ends.
    shoulder_radius, web_radius, bore_radius : float
        Core between lobe and journal (seat of the loose cam of a third disc too); collar between
        neighbouring lobes; hole through the shaft (0: none).
    lower_seat_top, upper_seat_bottom : float
        Heights of the shoulders against which the two support bearings sit.
    bottom, top : float
        Ends of the shaft.
    """

    support: ChosenBearing
    shoulder_radius: float
    web_radius: float
    bore_radius: float
    lower_seat_top: float
    upper_seat_bottom: float
    bottom: float
    top: float


@dataclass(frozen=True)
class ColumnLayout:
    """Columns between plate and cap with their screws, m; on the pins' circle.

    Attributes
    ----------
    count : int
        Of columns.
    angle : float
        Of the first at crank angle 0, rad.
    radius, bore_radius : float
        Of the tube.
    screw : CapScrew
        Head in the cap, thread in the plate.
    counterbore_radius, seat : float
        Of the recess for its head; height of the face under the head.
    """

    count: int
    angle: float
    radius: float
    bore_radius: float
    screw: CapScrew
    counterbore_radius: float
    seat: float

    @property
    def thread_top(self) -> float:
        """Height of the screw's end."""
        return self.seat + self.screw.length


@dataclass(frozen=True)
class FlangeDowels:
    """Dowel holes in the output's face, halfway between its bolts, m; all 0 without room.

    Attributes
    ----------
    depth : float
        Of the holes; dowels stand out as far.
    """

    diameter: float
    depth: float
    count: int


@dataclass(frozen=True)
class ShimLayout:
    """Shim rings beside the outer ring of a bearing, which set its axial play; m.

    Attributes
    ----------
    designation : str
        Of one ring without its thickness.
    inner, outer : float
        Radii.
    pack : float
        Thickness of the rings as drawn, with nominal lengths.
    play : float
        Beside them as drawn: the middle of what a pack to the next step leaves.
    """

    designation: str
    inner: float
    outer: float
    pack: float
    play: float

    @property
    def room(self) -> float:
        """Between the bearing and the face that the rings lie on."""
        return self.pack + self.play


@dataclass(frozen=True)
class CarrierLayout:
    """Carrier plate, cap, nut, pins and output bearing, m.

    Attributes
    ----------
    joint : {"clamped", "hinged", "columns"}
        How plate and cap are joined.
    columns : ColumnLayout or None
        None unless columns join them.
    pin_circle_radius, clocking : float
        Of the pins; the first pin's angle at crank angle 0.
    shoulder_bottom, shoulder_top : float
        Heights between which the ground shoulder of a pin runs.
    cap : bool
        Whether the pins are held at both ends.
    cap_bottom, cap_inner, cap_outer, counterbore_radius : float
        Of the cap; the counterbore is 0 for dowels.
    lowest : float
        Height of the lowest thing that turns with the carrier.
    shoulder_radius : float
        Of the plate's shoulder under the output bearing.
    plate_bottom, bearing_bottom, bearing_top, nut_top, plate_top : float
        Heights on the plate.
    nut_radius, nut_slots_bottom : float
        Thread of the nut that holds the output bearing; height down to which it has slots.
    bolt_thread, bolt_circle_radius, bolt_depth, bolt_room : float
        Tapped holes in the output face; a thread of 0 where there is no room. `bolt_room` is how
        thick the plate is there.
    flange_dowels : FlangeDowels
        Between these.
    shaft_seat_top : float
        Height of the plate's face over the shaft's upper bearing and its shims.
    shaft_shim, output_shim : ShimLayout
        Over the shaft's upper bearing, and over the output bearing.
    """

    joint: CarrierJoint
    columns: ColumnLayout | None
    pin: OutputPin
    pin_count: int
    pin_circle_radius: float
    clocking: float
    shoulder_bottom: float
    shoulder_top: float
    cap: bool
    cap_bottom: float
    cap_inner: float
    cap_outer: float
    counterbore_radius: float
    lowest: float
    output: ChosenBearing
    shoulder_radius: float
    plate_bottom: float
    bearing_bottom: float
    bearing_top: float
    nut_top: float
    plate_top: float
    nut_radius: float
    nut_slots_bottom: float
    bolt_thread: float
    bolt_circle_radius: float
    bolt_depth: float
    bolt_room: float
    flange_dowels: FlangeDowels
    shaft_seat_top: float
    shaft_shim: ShimLayout
    output_shim: ShimLayout

    @property
    def output_seat_top(self) -> float:
        """Height of the cover's lip over the output bearing and its shims."""
        return self.bearing_top + self.output_shim.room

    @property
    def bonded_in_cap(self) -> bool:
        """Whether the pins sit stiffly in the cap."""
        return self.cap and self.joint == "clamped"


@dataclass(frozen=True)
class GapSeal:
    """A narrow gap about what turns, which keeps grease in and coarse dust out, m.

    Attributes
    ----------
    inner, outer : float
        Radii of what turns and of the bore about it.
    bottom, top : float
        Heights between which the bore runs.
    length : float
        Over which both face each other.
    """

    inner: float
    outer: float
    bottom: float
    top: float
    length: float

    @property
    def gap(self) -> float:
        """Radial."""
        return self.outer - self.inner


@dataclass(frozen=True)
class HousingLayout:
    """Housing, ring clamp and output cover, m.

    Attributes
    ----------
    register_radius : float
        Outside of the tube, on which the stator sits.
    seated_motor : bool
        Whether the register is the motor's stator bore.
    flange_radius, flange_bottom, bolt_circle_radius : float
        Of the flange at the output end.
    screw : CapScrew
        Holds cover and ring clamp to the flange.
    screw_count : int
        And as many mounting holes between them.
    mount_thread : float
        Of the screws through these.
    face, spigot : float
        Height of the flange's face under the clamp; how deep the clamp's spigots reach into the
        ring's seat below it and into the bearing's seat of the cover above it.
    clamp_inner : float
        Bore of the ring clamp.
    cover_bottom : float
        Height of the cover's face on the clamp.
    cover_flange_top, cover_hub_radius, cover_top : float
        Of the output cover.
    boss_radius, floor_top, bottom : float
        Of the floor that carries the lower support bearing.
    output_seal, shaft_seal : GapSeal
        Between bearing nut and cover, and between shaft and floor.
    """

    register_radius: float
    seated_motor: bool
    flange_radius: float
    flange_bottom: float
    bolt_circle_radius: float
    screw: CapScrew
    screw_count: int
    mount_thread: float
    face: float
    spigot: float
    clamp_inner: float
    cover_bottom: float
    cover_flange_top: float
    cover_hub_radius: float
    cover_top: float
    boss_radius: float
    floor_top: float
    bottom: float
    output_seal: GapSeal
    shaft_seal: GapSeal


@dataclass(frozen=True)
class DowelLayout:
    """Dowels across the seam of ring and housing, which keep the ring from turning, m.

    Attributes
    ----------
    radius : float
        0 where there is no room for any.
    angles : tuple of float
        rad, where the wall is thickest.
    bottom : float
        Of their holes, which open at the upper face of the ring.
    bearing_length : float
        Of `length`, between the chamfers of their ends.
    """

    radius: float
    angles: tuple[float, ...]
    bottom: float
    length: float
    bearing_length: float


@dataclass(frozen=True)
class Layout:
    """All of the above for one design; `unit` is a millimetre at its scale, m.

    `motor` is an outrunner and `inrunner` one behind the gearbox; both are None where the motor,
    `motor_row`, cannot be drawn, and `motor_missing` says why.
    """

    unit: float
    pack: PackLayout
    shaft: ShaftLayout
    carrier: CarrierLayout
    housing: HousingLayout
    dowels: DowelLayout
    motor: MotorLayout | None
    inrunner: InrunnerLayout | None
    motor_row: Motor
    motor_missing: str

    @property
    def motor_end(self) -> MotorEnd | None:
        """The motor, of whichever kind it is."""
        return self.motor or self.inrunner
