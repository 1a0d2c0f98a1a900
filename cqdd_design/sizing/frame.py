"""What the requirements fix before any candidate is tried: loads, limits, materials, catalogues.

A :class:`Frame` is read once. Its numbers come from the same places as the checks of a finished
design: defaults from the design model, allowables from
:mod:`cqdd_design.gearbox.checks.allowables`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal, NamedTuple

from cqdd_design.catalog.bearings import Bearing
from cqdd_design.catalog.materials import Material, find_material
from cqdd_design.catalog.motors import Motor, find_motor
from cqdd_design.design import Design, Requirements
from cqdd_design.errors import InfeasibleError
from cqdd_design.gearbox import hertz
from cqdd_design.gearbox.carrier import pin_ends
from cqdd_design.gearbox.checks import allowables
from cqdd_design.gearbox.checks.allowables import Allowable
from cqdd_design.gearbox.pin_beam import PinEnd
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.scale import largest_ring, smallest_ring
from cqdd_design.sizing.bought_parts import (
    BearingTable,
    PinSize,
    bearing_table,
    cam_bearings,
    needle_pins,
    pin_sizes,
)

_RING_STEP = 5e-6
"""Rings are turned to hundredths of their diameter, m."""
THICKNESS_STEP = 1e-4
"""Discs are ground to tenths of a millimetre, m."""


Goal = Literal["mass", "inertia", "backlash", "efficiency", "size"]
"""What a search can make small, see :mod:`cqdd_design.sizing.goals`."""


class Fit(NamedTuple):
    """Gap left at every tooth, and clearance of a hole on its diameter to the mean pin, m."""

    equidistant: float
    hole_clearance: float


USUAL_FIT = Fit(6e-6, 16e-6)
"""That of a design which states none."""


@dataclass(frozen=True)
class LoadLimits:
    """Allowables of the load checks, each with its origin.

    Attributes
    ----------
    ring_static, ring_fatigue, pin_static, pin_fatigue : Allowable
        Hertz pressures of the weaker partner, at peak and at continuous torque.
    shear, bending_peak, bending_continuous, bearing : Allowable
        Stresses of the output pins.
    pin_ultimate : float
        Ultimate strength of the pins, Pa.
    """

    ring_static: Allowable
    ring_fatigue: Allowable
    pin_static: Allowable
    pin_fatigue: Allowable
    shear: Allowable
    bending_peak: Allowable
    bending_continuous: Allowable
    bearing: Allowable
    pin_ultimate: float


@dataclass(frozen=True)
class Frame:
    """Everything about a search that no candidate changes; SI.

    Attributes
    ----------
    lobe_count, disc_count : int
        n and D.
    spacing, equidistant, radial, relief_clearance, wire_radius : float
        Design defaults: gap between discs, profile modification, relief of the ring, wire with
        its spark gap.
    default_fit : Fit
        Of a design that states none.
    clocking : float
        Of the first output hole, a quarter lobe pitch, rad.
    pin_ends : tuple of str
        How plate and cap hold the output pins, of :mod:`~cqdd_design.gearbox.carrier`.
    most_thickness : float
        Of one disc in the required length.
    cam_speed : float
        Of the eccentric relative to a disc, rad/s.
    ring_modulus, pin_modulus : float
        E* of tooth on disc and of pin on disc.
    disc_density, ring_density, pin_density : float
        kg/m^3.
    pin_sizes : tuple of PinSize
        Ascending.
    bearings : tuple of Bearing
        Rated cam bearings that no other one beats in every respect, smallest first.
    ambient : float or None
        Of the air round the actuator, deg C; None for a design's default.
    goal : Goal
        What the search makes small.
    needles : bool
        Whether the output pins have sleeves on needles.
    smaller_rings : bool
        Whether rings are as small as their teeth allow; else all have the largest diameter.
    ring_limit : float
        Outside diameter of the largest ring that is tried, m, where less than is asked for.
    ring_least : float
        Outside diameter of the smallest ring that is tried, m, where the motor leaves smaller ones.
    pin_circle_limit : float
        Radius of the largest pin circle that is tried, m.
    throw_limit : float
        Largest eccentricity that is tried, m.
    carrier_material : str
        What the carrier is made of; "auto" for what the housing is.
    needs : mapping of str to float
        Torque reserve by load check that closed forms have to show, see `needed`.
    """

    requirements: Requirements
    lobe_count: int
    disc_count: int
    spacing: float
    equidistant: float
    radial: float
    relief_clearance: float
    wire_radius: float
    default_fit: Fit
    clocking: float
    pin_ends: tuple[PinEnd, PinEnd]
    most_thickness: float
    cam_speed: float
    limits: LoadLimits
    ring_modulus: float
    pin_modulus: float
    disc_density: float
    ring_density: float
    pin_density: float
    motor: Motor
    pin_sizes: tuple[PinSize, ...]
    bearings: tuple[Bearing, ...]
    ambient: float | None = None
    goal: Goal = "mass"
    needles: bool = False
    smaller_rings: bool = True
    ring_limit: float = math.inf
    ring_least: float = 0.0
    pin_circle_limit: float = math.inf
    throw_limit: float = math.inf
    carrier_material: str = "auto"
    needs: Mapping[str, float] = field(default_factory=dict)

    def needed(self, check: str) -> float:
        """Torque reserve that a load check has to have by closed forms; 1 where nothing is known.

        What the contact equilibrium found the closed form to be short of, elsewhere near by.
        """
        return self.needs.get(check, 1.0)

    @property
    def rotor_inertia(self) -> float | None:
        """Of the motor, kg m^2; None where it is not known."""
        return self.motor.rotor_inertia

    @property
    def carrier_stated(self) -> dict[str, str]:
        """What a design states of its carrier's material: nothing where it is the housing's."""
        return {} if self.carrier_material == "auto" else {"material": self.carrier_material}

    @property
    def disc_torque(self) -> float:
        """Share of one disc of the peak torque, N m."""
        return self.requirements.peak_torque / self.disc_count

    @property
    def continuous_share(self) -> float:
        """Continuous over peak torque."""
        return self.requirements.continuous_torque / self.requirements.peak_torque

    def at_torque(self, peak_torque: float) -> Frame:
        """The same frame with both required torques scaled to another peak torque (N m)."""
        changed = self.requirements.unchecked_copy(
            {
                "peak_torque": peak_torque,
                "continuous_torque": peak_torque * self.continuous_share,
            }
        )
        return replace(self, requirements=changed)

    @property
    def outer_radius(self) -> float:
        """Of the largest ring, m: what is asked for, or what goes into the motor's bore."""
        asked, bore = self.requirements.outer_diameter, self.motor.bore_diameter
        most = min(asked, self.ring_limit)
        most = most if bore is None else min(most, largest_ring(bore))
        return round(math.floor(0.5 * most / _RING_STEP + 1e-6) * _RING_STEP, 9)

    @property
    def least_outer_radius(self) -> float:
        """Of the smallest ring that is tried, and round which a tube fills the motor's bore, m.

        Where no ring may be as large as that, the motor stands behind all of them.
        """
        bore = self.motor.bore_diameter
        inside = 0.0 if bore is None else smallest_ring(bore)
        behind = self.requirements.outer_diameter < inside
        return 0.5 * max(self.ring_least, 0.0 if behind else inside)

    def bearing_table(self) -> BearingTable:
        """The cam bearings as arrays."""
        hours = self.requirements.life_hours
        table = bearing_table(self.bearings, self.cam_speed, self.continuous_share, hours)
        return replace(
            table,
            static_load=table.static_load / self.needed("BEARING-STATIC"),
            life_load=table.life_load / self.needed("BEARING-LIFE"),
        )


def search_frame(
    requirements: Requirements,
    motor: Motor | None = None,
    ambient: float | None = None,
    fit: Fit = USUAL_FIT,
    goal: Goal = "mass",
    *,
    needles: bool = False,
) -> Frame:
    """Read the requirements, the design defaults and the catalogues.

    Parameters
    ----------
    motor : Motor, optional
        Default the catalogue's row of the motor that the requirements name.
    ambient : float, optional
        Of the air, deg C; default that of a design.
    fit : Fit
        Clearances of teeth and of pins in holes; default those of a design.
    goal : Goal
        What the search makes small.
    needles : bool
        Whether the output pins, of a hardened steel then, have sleeves on needles.

    Raises
    ------
    InfeasibleError
        When the requirements leave no room for any catalogue part, or name a material without a
        strength or a geared actuator as the motor; the message names the key.
    """
    template = _template(requirements)
    reducer, pins = template.reducer, template.reducer.output_pins
    disc = find_material(requirements.disc_material)
    ring = find_material(requirements.ring_material)
    pin = find_material(requirements.pin_material)
    count, spacing = requirements.disc_count, reducer.disc_spacing
    thickness = (requirements.length - (count - 1) * spacing) / count
    most = math.floor(thickness / THICKNESS_STEP + 1e-6) * THICKNESS_STEP
    offered = needle_pins if needles else pin_sizes
    sizes = offered(requirements, fit.hole_clearance)
    return Frame(
        requirements=requirements,
        lobe_count=requirements.ratio,
        disc_count=count,
        spacing=spacing,
        equidistant=fit.equidistant,
        radial=reducer.modification.radial,
        relief_clearance=reducer.ring.relief_clearance,
        wire_radius=template.edm.wire_offset,
        default_fit=Fit(reducer.modification.equidistant, pins.hole_clearance),
        clocking=pins.hole_clocking,
        pin_ends=pin_ends(template),
        most_thickness=most,
        cam_speed=float(
            kinematics.cam_bearing_speed_ring_fixed(requirements.ratio, requirements.held_speed)
        ),
        limits=_load_limits(requirements, disc, ring, pin),
        ring_modulus=hertz.pair_modulus(disc, ring),
        pin_modulus=hertz.pair_modulus(disc, pin),
        disc_density=disc.density,
        ring_density=ring.density,
        pin_density=pin.density,
        motor=motor or find_motor(requirements.motor),
        pin_sizes=sizes,
        bearings=cam_bearings(requirements, most, spacing, sizes[0].running_diameter),
        ambient=ambient,
        goal=goal,
        needles=needles,
    )


def _template(requirements: Requirements) -> Design:
    """A design with the required ratio whose other values are the defaults of the model."""
    # Sizes that any ratio accepts; none of them reaches the search.
    radius = 0.1
    return Design.from_mapping(
        {
            "requirements": {"ratio": requirements.ratio},
            "reducer": {
                "ratio": requirements.ratio,
                "ring_pitch_radius": radius,
                "eccentricity": 0.5 * radius / (requirements.ratio + 1),
                "ring_pin_diameter": radius / (requirements.ratio + 1),
                "disc_count": requirements.disc_count,
            },
        },
        si=True,
    )


def _load_limits(
    requirements: Requirements, disc: Material, ring: Material, pin: Material
) -> LoadLimits:
    static, fatigue = allowables.contact_limit_static, allowables.contact_limit_fatigue
    weaker = allowables.weaker
    senses = [point.torque for point in requirements.load_cases]
    limits = LoadLimits(
        ring_static=weaker(static(disc), static(ring)),
        ring_fatigue=weaker(fatigue(disc), fatigue(ring)),
        pin_static=weaker(static(disc), static(pin)),
        pin_fatigue=weaker(fatigue(disc), fatigue(pin)),
        shear=allowables.pin_shear_limit_peak(pin),
        bending_peak=allowables.pin_limit_peak(pin),
        bending_continuous=allowables.pin_bending_limit_continuous(
            pin, duty_reverses=min(senses, default=0.0) < 0.0 < max(senses, default=0.0)
        ),
        bearing=weaker(allowables.pin_limit_peak(pin), allowables.pin_limit_peak(disc)),
        pin_ultimate=pin.ultimate_strength or 0.0,
    )
    for key, given, names in (
        ("disc_material", disc, ("ring_static", "ring_fatigue", "pin_static", "pin_fatigue")),
        ("ring_material", ring, ("ring_static", "ring_fatigue")),
        ("pin_material", pin, ("pin_static", "pin_fatigue", "shear", "bending_continuous")),
    ):
        for name in names:
            allowed: Allowable = getattr(limits, name)
            if allowed.value <= 0.0 and given.name in allowed.basis:
                raise InfeasibleError(
                    f"requirements.{key} '{given.name}' has no basis for a limit: "
                    f"{allowed.basis}; choose a steel with a hardness, such as "
                    "'AISI 4140 Q&T 540C'."
                )
    return limits
