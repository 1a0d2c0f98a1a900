r"""The cycloidal reducer of a design file: disc, ring, output pins, cam bearing.

ring tooth (Z_p)   ring_pitch_radius (Z_r)
     ____  <----------------------+
  .-'  O '-.                      |
 / o  ___ o \   o output pin      |
| O  ( + )  O |  + input axis ----+
 \ o  ---  o /   eccentricity (Z_e): disc axis to input axis
  '-.____.-'
"""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import ValidationInfo, model_validator

from cqdd_design.design.fields import (
    BearingName,
    FreeText,
    FrozenModel,
    MaterialName,
    Share,
    Whole,
    default,
)
from cqdd_design.design.requirements import DiscCount, Ratio
from cqdd_design.units import (
    ANGLE,
    LENGTH,
    RADIAL_STIFFNESS,
    SMALL_ANGLE,
    SMALL_LENGTH,
    QuantityIn,
    format_quantity,
)

CarrierJoint = Literal["clamped", "hinged", "columns"]
RingType = Literal["solid", "conjugate", "pinwheel"]

PIN_CIRCLE_SHARE = 0.61
"""Default radius of the pin circle over the ring's pitch radius: the paper's 19.5 mm on 32 mm."""
RING_WALL = 3e-3
"""Default wall outside the ring's root, m."""


_Shift = Annotated[
    float, QuantityIn(SMALL_LENGTH, "-500 um", "500 um", "a profile shift, not a new profile")
]
_Friction = Annotated[float, Share(0.0, 1.0, "a coefficient of friction")]


class Modification(FrozenModel):
    """Profile modification of the disc; positive values shrink it."""

    equidistant: _Shift = default("6 um")
    radial: _Shift = default("0 um")
    rotation: Annotated[
        float, QuantityIn(SMALL_ANGLE, "0 arcmin", "60 arcmin", "each flank turns to its lobe")
    ] = default("0 arcmin")


class OutputPins(FrozenModel):
    """The output pins (shoulder screws, with or without sleeves) and their holes in the disc."""

    count: Annotated[int, Whole(3, 60, "three pins hold a carrier")] = 6
    diameter: Annotated[
        float, QuantityIn(LENGTH, "0.5 mm", "100 mm", "shoulder of a screw or a dowel")
    ] = default("4 mm")
    circle_radius: Annotated[
        float, QuantityIn(LENGTH, "1 mm", "1000 mm", "must lie inside the lobes")
    ]
    sleeve_diameter: Annotated[float, QuantityIn(LENGTH, "0 mm", "150 mm", "0 means no sleeve")] = (
        default("0 mm")
    )
    hole_clearance: Annotated[
        float,
        QuantityIn(SMALL_LENGTH, "-100 um", "1000 um", "on the diameter, to the pin's mean"),
    ] = default("16 um")
    hole_clocking: Annotated[
        float, QuantityIn(ANGLE, "-360 deg", "360 deg", "first hole from the valley on +x")
    ]
    support: Literal["both", "cantilever"] = "both"
    material: MaterialName = "Alloy steel 12.9 (ISO 7379)"


class CamBearing(FrozenModel):
    """The bearing between eccentric and disc."""

    designation: BearingName = "auto"
    radial_clearance: Annotated[
        float, QuantityIn(SMALL_LENGTH, "0 um", "500 um", "total play by ISO 5753")
    ] = default("5 um")


class Carrier(FrozenModel):
    """How the carrier's plate and cap are joined, where both hold the output pins.

    clamped: the pins sit tight in both and keep their slope there; hinged: tight in the plate,
    free to slide and turn in the cap; columns: as hinged, and columns between the pins, through
    holes of the discs, tie the cap to the plate.
    """

    joint: CarrierJoint = "clamped"
    column_count: Annotated[int, Whole(0, 60, "columns stand between the output pins")] = 0
    column_diameter: Annotated[
        float, QuantityIn(LENGTH, "0 mm", "100 mm", "0 where there are no columns")
    ] = default("0 mm")


class CarrierBearing(FrozenModel):
    """The bearing of the output carrier in the housing."""

    stiffness: Annotated[
        float,
        QuantityIn(RADIAL_STIFFNESS, "0 N/um", "1000000 N/um", "radial; 0 means rigid"),
    ] = default("0 N/um")


class Ring(FrozenModel):
    """The fixed ring."""

    outer_diameter: Annotated[
        float, QuantityIn(LENGTH, "5 mm", "2500 mm", "must leave a wall outside the teeth")
    ]
    relief_clearance: Annotated[
        float,
        QuantityIn(LENGTH, "0.01 mm", "5 mm", "clears the lobe tips between the teeth"),
    ] = default("0.1 mm")


class ReducerFriction(FrozenModel):
    """Coulomb friction at teeth and pins."""

    tooth: _Friction = 0.08
    pin: _Friction = 0.08
    lubricant: FreeText = "NLGI 2 grease"


class Balance(FrozenModel):
    """Counterweights on the eccentric shaft."""

    counterweights: bool = False


class Reducer(FrozenModel):
    """The reducer; ratio, ring_pitch_radius, eccentricity and ring_pin_diameter are required.

    The words of the paper: `ratio` is Z_nt lobes on the disc (the ring has Z_np = ratio + 1
    teeth), `ring_pitch_radius` Z_r, `eccentricity` Z_e, `ring_pin_diameter` Z_p.
    """

    ratio: Ratio
    ring_pitch_radius: Annotated[
        float, QuantityIn(LENGTH, "2 mm", "1000 mm", "circle through the ring's teeth")
    ]
    eccentricity: Annotated[
        float, QuantityIn(LENGTH, "0.01 mm", "100 mm", "throw of the eccentric shaft")
    ]
    ring_pin_diameter: Annotated[
        float, QuantityIn(LENGTH, "0.1 mm", "500 mm", "diameter of a ring tooth or pin")
    ]
    ring_type: RingType = "solid"
    disc_count: DiscCount = 2
    disc_thickness: Annotated[float, QuantityIn(LENGTH, "0.5 mm", "200 mm", "one disc")] = default(
        "8 mm"
    )
    disc_spacing: Annotated[
        float, QuantityIn(LENGTH, "0 mm", "50 mm", "gap between neighbouring discs")
    ] = default("0.5 mm")
    disc_material: MaterialName = "AISI 4140 Q&T 540C"
    ring_material: MaterialName = "AISI 4140 Q&T 540C"
    modification: Modification = Modification()
    output_pins: OutputPins
    cam_bearing: CamBearing = CamBearing()
    carrier: Carrier = Carrier()
    carrier_bearing: CarrierBearing = CarrierBearing()
    ring: Ring
    friction: ReducerFriction = ReducerFriction()
    balance: Balance = Balance()

    @property
    def ring_tooth_count(self) -> int:
        """Teeth of the ring, one more than lobes on the disc."""
        return self.ratio + 1

    @property
    def pack_length(self) -> float:
        """Length of the pack of discs, m."""
        return self.disc_count * self.disc_thickness + (self.disc_count - 1) * self.disc_spacing

    @model_validator(mode="before")
    @classmethod
    def _derive(cls, data: Any, info: ValidationInfo) -> Any:
        """Defaults that follow from the first four keys: hole clocking, pin circle, ring size."""
        if not isinstance(data, dict):
            return data
        filled = dict(data)
        pins = filled.get("output_pins", {})
        ring = filled.get("ring", {})
        lengths = _readable_lengths(
            filled,
            ("ring_pitch_radius", "eccentricity", "ring_pin_diameter"),
            si=bool(info.context and info.context.get("si")),
        )
        ratio = filled.get("ratio")
        if isinstance(pins, dict):
            pins = dict(pins)
            if "hole_clocking" not in pins and isinstance(ratio, (int, float)) and ratio >= 1:
                # A quarter lobe pitch: two discs are then one part, one of them flipped over.
                pins["hole_clocking"] = format_quantity(math.pi / (2.0 * ratio), ANGLE)
            if "circle_radius" not in pins and lengths is not None:
                # To a tenth of a millimetre.
                radius = round(PIN_CIRCLE_SHARE * lengths[0], 4)
                pins["circle_radius"] = format_quantity(radius, LENGTH)
            filled["output_pins"] = pins
        if isinstance(ring, dict):
            ring = dict(ring)
            if "outer_diameter" not in ring and lengths is not None:
                pitch, throw, pin = lengths
                root = pitch + max(2.0 * throw - 0.5 * pin, 0.5 * pin)
                ring["outer_diameter"] = format_quantity(2.0 * (root + RING_WALL), LENGTH)
            filled["ring"] = ring
        return filled


def _readable_lengths(
    data: dict[str, Any], keys: tuple[str, ...], *, si: bool
) -> list[float] | None:
    """The lengths of `keys` in m, or None while any of them is missing or unreadable."""
    from cqdd_design.errors import DesignError
    from cqdd_design.units import parse_quantity

    values = []
    for key in keys:
        raw = data.get(key)
        if isinstance(raw, str):
            try:
                values.append(parse_quantity(raw, LENGTH))
            except DesignError:
                return None
        elif si and isinstance(raw, (int, float)):
            values.append(float(raw))
        else:
            return None
    return values
