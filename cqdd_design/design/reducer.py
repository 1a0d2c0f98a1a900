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

from cqdd_design.catalog.materials import find_material
from cqdd_design.catalog.screws import LEAST_COLUMN
from cqdd_design.design.fields import (
    BearingName,
    FinishName,
    FrozenModel,
    LubricantName,
    MaterialName,
    MaterialOrAuto,
    Share,
    ShareOr,
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
RunsOn = Literal["plain", "needle", "drawn cup"]
"""What a sleeve or roller turns on: its pin itself, or a needle cage between the two; or it is the
cup of needle bearings itself, which roll in the disc."""

PIN_CIRCLE_SHARE = 0.61
"""Default radius of the pin circle over the ring's pitch radius: the paper's 19.5 mm on 32 mm."""
RING_WALL = 3e-3
"""Default wall outside the ring's root, m."""
_FEWEST_COLUMNS = 3
"""Three columns hold a cap square to the plate, and leave the carrier balanced."""


_Shift = Annotated[
    float, QuantityIn(SMALL_LENGTH, "-500 um", "500 um", "a profile shift, not a new profile")
]
_Friction = Annotated[
    float | Literal["film"], ShareOr(Share(0.0, 1.0, "a coefficient of friction"), "film")
]


class Modification(FrozenModel):
    """Profile modification of the disc; positive values shrink it."""

    equidistant: _Shift = default("6 um")
    radial: _Shift = default("0 um")
    rotation: Annotated[
        float, QuantityIn(SMALL_ANGLE, "0 arcmin", "60 arcmin", "each flank turns to its lobe")
    ] = default("0 arcmin")


class OutputPins(FrozenModel):
    """The output pins (shoulder screws, with or without sleeves) and their holes in the disc.

    A sleeve of `sleeve_diameter` turns on its pin of `diameter`: plain, with `sleeve_play` between
    the two, or on the needle cage of the catalogue that fits between them, with that play in it.
    Drawn cups of the catalogue of both diameters need no sleeve: as many roll side by side in the
    hole as the disc is thick.
    Without it, it is the mean that the drawn fit leaves: a bore of G6 on a pin ground to h5, as
    makers of needle cages ask for, or on the f9 of a screw; F6 inside the needles of a cup.
    """

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
    sleeve: RunsOn = "plain"
    sleeve_play: (
        Annotated[
            float,
            QuantityIn(SMALL_LENGTH, "0 um", "500 um", "of a sleeve on its pin, on the diameter"),
        ]
        | None
    ) = None
    hole_clearance: Annotated[
        float,
        QuantityIn(SMALL_LENGTH, "-100 um", "1000 um", "on the diameter, to the pin's mean"),
    ] = default("16 um")
    hole_clocking: Annotated[
        float, QuantityIn(ANGLE, "-360 deg", "360 deg", "first hole from the valley on +x")
    ]
    support: Literal["both", "cantilever"] = "both"
    material: MaterialName = "Alloy steel 12.9 (ISO 7379)"

    @model_validator(mode="after")
    def _needles_in_a_sleeve(self) -> OutputPins:
        if self.sleeve != "plain" and self.sleeve_diameter == 0.0:
            raise ValueError(
                f'sleeve = "{self.sleeve}" needs a sleeve for the needles to run in; give '
                'sleeve_diameter, or make sleeve "plain"'
            )
        return self


class CamBearing(FrozenModel):
    """The bearing between eccentric and disc, and what carries the eccentric.

    `support_stiffness` is that of shaft, shaft bearings and their seats together, at the discs;
    of steel they are far stiffer than the bearing, of plastic they are not.
    """

    designation: BearingName = "auto"
    radial_clearance: Annotated[
        float, QuantityIn(SMALL_LENGTH, "0 um", "500 um", "total play by ISO 5753")
    ] = default("5 um")
    support_stiffness: Annotated[
        float,
        QuantityIn(RADIAL_STIFFNESS, "0 N/um", "1000000 N/um", "radial; 0 means rigid"),
    ] = default("0 N/um")


class SupportBearing(FrozenModel):
    """The bearings at both ends of the eccentric shaft; "auto" is what of the catalogue fits."""

    designation: BearingName = "auto"


class Carrier(FrozenModel):
    """What the carrier's plate and cap are of, and how they are joined, where both hold the pins.

    material: "auto" is that of the housing.

    clamped: the pins sit tight in both and keep their slope there; hinged: tight in the plate,
    free to slide and turn in the cap; columns: as hinged, and columns between the pins, through
    holes of the discs, tie the cap to the plate. As many columns as pins unless the file says
    otherwise.
    """

    material: MaterialOrAuto = "auto"
    joint: CarrierJoint = "clamped"
    column_count: Annotated[int, Whole(0, 60, "columns stand between the output pins")] = 0
    column_diameter: Annotated[
        float, QuantityIn(LENGTH, "0 mm", "100 mm", "0 where there are no columns")
    ] = default("0 mm")

    @model_validator(mode="after")
    def _of_metal(self) -> Carrier:
        if self.material != "auto" and find_material(self.material).is_plastic:
            raise ValueError(
                f"material '{self.material}' is a plastic, of which a carrier is made where the "
                'housing is: set housing.material and leave this at "auto", or choose a metal '
                "such as 'AISI 4140 Q&T 540C'"
            )
        return self

    @model_validator(mode="after")
    def _columns_belong(self) -> Carrier:
        count, diameter = self.column_count, self.column_diameter
        told = f"column_count {count} and column_diameter {diameter * 1e3:.6g} mm"
        if self.joint != "columns" and (count or diameter):
            raise ValueError(
                f'{told} belong to joint = "columns", not to joint = "{self.joint}"; leave them '
                'out, or choose joint = "columns"'
            )
        if self.joint == "columns" and diameter < LEAST_COLUMN:
            raise ValueError(
                f"column_diameter {diameter * 1e3:.6g} mm must be from {LEAST_COLUMN * 1e3:g} to "
                "100 mm: a column is a tube over its screw, M1.6 at least; the nearest allowed is "
                f"{LEAST_COLUMN * 1e3:g} mm"
            )
        return self


class CarrierBearing(FrozenModel):
    """The bearing of the output carrier in the housing; "auto" is what of the catalogue fits."""

    designation: BearingName = "auto"
    stiffness: Annotated[
        float,
        QuantityIn(RADIAL_STIFFNESS, "0 N/um", "1000000 N/um", "radial; 0 means rigid"),
    ] = default("0 N/um")


class Ring(FrozenModel):
    """The fixed ring.

    The pins of a pinwheel ring take rollers of `roller_diameter`, which then is what meshes with
    the discs: plain, with `roller_play` between roller and pin, or on the needle cage of the
    catalogue that fits between the two, with that play in it. Without it, it is the mean of a G6
    bore on a pin ground to h5.
    """

    outer_diameter: Annotated[
        float, QuantityIn(LENGTH, "5 mm", "2500 mm", "must leave a wall outside the teeth")
    ]
    relief_clearance: Annotated[
        float,
        QuantityIn(LENGTH, "0.01 mm", "5 mm", "clears the lobe tips between the teeth"),
    ] = default("0.1 mm")
    roller_diameter: Annotated[
        float, QuantityIn(LENGTH, "0 mm", "500 mm", "0 means no rollers on the pins")
    ] = default("0 mm")
    roller: RunsOn = "plain"
    roller_play: (
        Annotated[
            float,
            QuantityIn(SMALL_LENGTH, "0 um", "500 um", "of a roller on its pin, on the diameter"),
        ]
        | None
    ) = None

    @model_validator(mode="after")
    def _needles_in_a_roller(self) -> Ring:
        if self.roller != "plain" and self.roller_diameter == 0.0:
            raise ValueError(
                f'roller = "{self.roller}" needs a roller for the needles to run in; give '
                'roller_diameter, or make roller "plain"'
            )
        return self


class ReducerFriction(FrozenModel):
    """Friction at teeth and pins.

    A number is a coefficient by Coulomb, of any speed and load; "film" takes it from the film that
    the lubricant builds between surfaces as `finish` says they are made. Seals are those of the
    shaft's support bearings and of the carrier's, on both sides.
    """

    tooth: _Friction = "film"
    pin: _Friction = "film"
    lubricant: LubricantName = "NLGI 2 grease"
    seals: Literal["none", "contact"] = "none"


class Finish(FrozenModel):
    """How the surfaces that rub are made: names of the catalogue of finishes."""

    disc: FinishName = "wire EDM, three skim cuts"
    ring: FinishName = "wire EDM, three skim cuts"
    pin: FinishName = "shoulder screw"


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
    support_bearing: SupportBearing = SupportBearing()
    carrier: Carrier = Carrier()
    carrier_bearing: CarrierBearing = CarrierBearing()
    ring: Ring
    friction: ReducerFriction = ReducerFriction()
    finish: Finish = Finish()
    balance: Balance = Balance()

    @property
    def tooth_diameter(self) -> float:
        """What meshes with the discs, m: the rollers where there are any, else the ring's pins."""
        return self.ring.roller_diameter or self.ring_pin_diameter

    @property
    def tooth_key(self) -> str:
        """The key that says it."""
        return "ring.roller_diameter" if self.ring.roller_diameter else "ring_pin_diameter"

    @property
    def ring_tooth_count(self) -> int:
        """Teeth of the ring, one more than lobes on the disc."""
        return self.ratio + 1

    @property
    def pack_length(self) -> float:
        """Length of the pack of discs, m."""
        return self.disc_count * self.disc_thickness + (self.disc_count - 1) * self.disc_spacing

    @model_validator(mode="after")
    def _columns_between_pins(self) -> Reducer:
        carrier, pins = self.carrier, self.output_pins.count
        if carrier.joint != "columns":
            return self
        if self.output_pins.support != "both":
            raise ValueError(
                'carrier.joint "columns" ties a cap to the plate, and output_pins.support '
                f'"{self.output_pins.support}" has no cap; set support = "both", or leave joint, '
                "column_count and column_diameter out"
            )
        count = carrier.column_count
        even = [n for n in range(_FEWEST_COLUMNS, pins + 1) if pins % n == 0]
        if count not in even:
            raise ValueError(
                f"carrier.column_count {count} must be a divisor of output_pins.count {pins}, "
                f"{_FEWEST_COLUMNS} or more, so that columns stand evenly midway between pins; the "
                f"nearest is {min(even, key=lambda n: (abs(n - count), n))}"
            )
        return self

    @model_validator(mode="after")
    def _rollers_on_pins(self) -> Reducer:
        if self.ring.roller_diameter > 0.0 and self.ring_type != "pinwheel":
            raise ValueError(
                f"ring.roller_diameter: rollers turn on the pins of a pinwheel ring, and this one "
                f'is "{self.ring_type}"; make ring_type "pinwheel", or roller_diameter "0 mm"'
            )
        return self

    @model_validator(mode="before")
    @classmethod
    def _derive(cls, data: Any, info: ValidationInfo) -> Any:
        """Defaults that follow from other keys: hole clocking, pin circle, ring size, columns."""
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
            carrier = filled.get("carrier")
            if isinstance(carrier, dict) and carrier.get("joint") == "columns":
                # One between every two pins.
                count = pins.get("count", OutputPins.model_fields["count"].default)
                if isinstance(count, int):
                    filled["carrier"] = {"column_count": count, **carrier}
        if isinstance(ring, dict):
            ring = dict(ring)
            if "outer_diameter" not in ring and lengths is not None:
                pitch, throw, pin = lengths
                rollers = _readable_lengths(
                    ring,
                    ("roller_diameter",),
                    si=bool(info.context and info.context.get("si")),
                )
                pin = max(pin, rollers[0]) if rollers else pin
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
