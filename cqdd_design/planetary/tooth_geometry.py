"""Geometry of one involute gear pair after ISO 21771, external or internal, spur or helical.

Sign convention of ISO 21771 and ISO 6336: the teeth of an internal gear are counted NEGATIVE, and
with them its diameters, the gear ratio and the centre distance of the pair. The formulas of the
external pair then hold for the internal one as they stand. Positive profile shift always moves the
tooth tip outward from the tooth's own root, so it makes an internal gear's bore smaller.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

from cqdd_design.errors import GeometryError, UsageError
from cqdd_design.planetary.cutting_tools import (
    ISO_53_A,
    BasicRack,
    PinionCutter,
    inverse_involute,
    involute,
    rack_form_roll,
    ring_form_roll,
)

#: Modules outside 0.05 to 50 mm are typing mistakes (m against mm) rather than gears.
LEAST_MODULE, MOST_MODULE = 0.05e-3, 50e-3


def validate_module(module: float) -> None:
    """Raise a `UsageError` unless the module (m) is one of a gear, 0.05 to 50 mm."""
    if not LEAST_MODULE <= module <= MOST_MODULE:
        raise UsageError(
            f"module: {module * 1e3:g} mm is outside {LEAST_MODULE * 1e3:g} to "
            f"{MOST_MODULE * 1e3:g} mm; the paper's gear has 1 mm."
        )


@dataclass(frozen=True)
class GearPair:
    """Two meshing gears, the pinion external, the wheel external or internal.

    Attributes
    ----------
    pinion_teeth : int
        z1 > 0.
    wheel_teeth : int
        z2; negative for an internal gear (ring).
    module : float
        Normal module, m.
    face_width : float
        b, m.
    pinion_shift, wheel_shift : float
        Profile shift coefficients x1, x2.
    helix_angle : float
        At the reference cylinder, rad; 0 for spur gears.
    pinion_tip_diameter, wheel_tip_diameter : float or None
        Made tip diameters in m (negative for a ring); None for the rack's addendum with shift,
        which a ring shortens to what clears the pinion's root fillet.
    centre_distance : float or None
        Working centre distance in m (negative for an internal pair); None for the distance without
        backlash that follows from the shifts.
    cutter : PinionCutter or None
        Of a ring; None for `PinionCutter.usual`.
    """

    pinion_teeth: int
    wheel_teeth: int
    module: float
    face_width: float
    pinion_shift: float = 0.0
    wheel_shift: float = 0.0
    helix_angle: float = 0.0
    rack: BasicRack = ISO_53_A
    pinion_tip_diameter: float | None = None
    wheel_tip_diameter: float | None = None
    centre_distance: float | None = None
    cutter: PinionCutter | None = None

    def __post_init__(self) -> None:
        """Refuse lengths no gear can have and pairs that do not hand over from tooth to tooth."""
        validate_module(self.module)
        if not 0.0 < self.face_width < math.inf:
            raise UsageError(
                f"face width: {self.face_width * 1e3:g} mm is not a positive length; the paper's "
                "gear has 12 mm."
            )
        if self.wheel_teeth < 0 and -self.wheel_teeth <= self.pinion_teeth:
            raise GeometryError(
                f"a ring of {-self.wheel_teeth} teeth cannot surround a gear of "
                f"{self.pinion_teeth}; give it at least {self.pinion_teeth + 10}."
            )
        for name, teeth, tip in zip(
            ("pinion", "wheel"), self.teeth, self.tip_diameters, strict=True
        ):
            if abs(tip) <= abs(self.base_diameter(teeth)):
                raise GeometryError(
                    f"{name} with {abs(teeth)} teeth: its tips at {abs(tip) * 1e3:.4g} mm lie "
                    f"inside the base circle of {abs(self.base_diameter(teeth)) * 1e3:.4g} mm, "
                    "where no involute exists; "
                    + (
                        f"a full-depth ring needs {self.least_full_depth_ring} teeth or a "
                        "negative profile shift."
                        if teeth < 0
                        else "raise its profile shift."
                    )
                )
        if self.transverse_contact_ratio < 1.0:
            raise GeometryError(
                f"teeth {self.pinion_teeth}/{abs(self.wheel_teeth)}: the contact ratio is "
                f"{self.transverse_contact_ratio:.3f}, below 1, so a tooth lets go before the next "
                "takes over; lower the profile shifts or raise the tooth counts."
            )

    @property
    def teeth(self) -> tuple[int, int]:
        """z1 and z2."""
        return self.pinion_teeth, self.wheel_teeth

    @property
    def shifts(self) -> tuple[float, float]:
        """x1 and x2."""
        return self.pinion_shift, self.wheel_shift

    @property
    def internal(self) -> bool:
        """Whether the wheel is a ring."""
        return self.wheel_teeth < 0

    @property
    def gear_ratio(self) -> float:
        """Gear ratio u = z2/z1, negative for an internal pair (ISO 6336-1, 4.1)."""
        return self.wheel_teeth / self.pinion_teeth

    @property
    def least_full_depth_ring(self) -> int:
        """Smallest ring whose tips, one addendum inside, still lie on the involute.

        |z|/2 - h_aP* - x >= |z|/2 cos(alpha_t), ISO 21771, 4.6 and 5.4.
        """
        height = 2.0 * (self.rack.addendum + self.wheel_shift) * math.cos(self.helix_angle)
        return math.ceil(height / (1.0 - math.cos(self.transverse_pressure_angle)))

    @functools.cached_property
    def transverse_pressure_angle(self) -> float:
        """alpha_t with tan(alpha_t) = tan(alpha_n)/cos(beta), ISO 21771 eq. 7."""
        return math.atan(math.tan(self.rack.pressure_angle) / math.cos(self.helix_angle))

    @functools.cached_property
    def base_helix_angle(self) -> float:
        """beta_b with sin(beta_b) = sin(beta) cos(alpha_n), ISO 6336-3:2006 eq. 20."""
        return math.asin(math.sin(self.helix_angle) * math.cos(self.rack.pressure_angle))

    def reference_diameter(self, teeth: int) -> float:
        """D = z m_n/cos(beta), m; negative for a ring."""
        return teeth * self.module / math.cos(self.helix_angle)

    def base_diameter(self, teeth: int) -> float:
        """d_b = d cos(alpha_t), m; negative for a ring."""
        return self.reference_diameter(teeth) * math.cos(self.transverse_pressure_angle)

    @functools.cached_property
    def tip_diameters(self) -> tuple[float, float]:
        """d_a = d + 2 m (h_aP* + x) of pinion and wheel, m, unless given.

        A ring's default goes no further in than the pinion's form circle asks for: beyond, its tips
        would run into the pinion's root fillet.
        """
        found = []
        made = (self.pinion_tip_diameter, self.wheel_tip_diameter)
        for teeth, shift, given in zip(self.teeth, self.shifts, made, strict=True):
            nominal = self.reference_diameter(teeth)
            nominal += 2.0 * self.module * (self.rack.addendum + shift)
            if given is None and teeth < 0:
                nominal = min(nominal, self.clearing_tip_diameters[1])
            found.append(nominal if given is None else given)
        return found[0], found[1]

    @functools.cached_property
    def clearing_tip_diameters(self) -> tuple[float, float]:
        """Tip diameters of pinion and wheel that just reach the mate's form circle, m; signed."""
        first, second = (
            math.copysign(
                2.0 * math.hypot(self.tangent_length - form, 0.5 * self.base_diameter(teeth)), teeth
            )
            for teeth, form in zip(self.teeth, reversed(self.form_rolls), strict=True)
        )
        return first, second

    @functools.cached_property
    def ring_cutter(self) -> PinionCutter:
        """The cutter of the ring, given or usual."""
        return self.cutter or PinionCutter.usual(-self.wheel_teeth, self.pinion_teeth, self.rack)

    @functools.cached_property
    def form_rolls(self) -> tuple[float, float]:
        """Radius of curvature where the involute of pinion and wheel ends at the root, m; signed.

        See :func:`rack_form_roll` and :func:`ring_form_roll`.
        """
        pinion, wheel = self.teeth
        beta = self.helix_angle
        first = rack_form_roll(pinion, self.pinion_shift, self.rack, beta)
        if self.internal:
            second = -ring_form_roll(-wheel, self.wheel_shift, self.ring_cutter, self.rack)
        else:
            second = rack_form_roll(wheel, self.wheel_shift, self.rack, beta)
        return first * self.module, second * self.module

    @property
    def tangent_length(self) -> float:
        """Distance between the tangent points of both base circles, m; negative if internal."""
        return self.working_centre_distance * math.sin(self.working_pressure_angle)

    @functools.cached_property
    def root_diameters(self) -> tuple[float, float]:
        """d_f = d - 2 m (h_fP* - x) of pinion and wheel, m; a ring's is its largest, negative."""
        pinion, wheel = (
            self.reference_diameter(teeth) - 2.0 * self.module * (self.rack.dedendum - shift)
            for teeth, shift in zip(self.teeth, self.shifts, strict=True)
        )
        return pinion, wheel

    @property
    def tooth_depths(self) -> tuple[float, float]:
        """Tooth depth h_t = |d_a - d_f|/2 of pinion and wheel, m."""
        tips, roots = self.tip_diameters, self.root_diameters
        return 0.5 * abs(tips[0] - roots[0]), 0.5 * abs(tips[1] - roots[1])

    @functools.cached_property
    def reference_centre_distance(self) -> float:
        """a_d = (d1 + d2)/2, m; negative for an internal pair."""
        return 0.5 * (
            self.reference_diameter(self.pinion_teeth) + self.reference_diameter(self.wheel_teeth)
        )

    @functools.cached_property
    def working_pressure_angle(self) -> float:
        """alpha_wt, from the centre distance if given, else from the shifts (ISO 21771, 5.2).

        inv(alpha_wt) = inv(alpha_t) + 2 tan(alpha_n) (x1 + x2)/(z1 + z2).

        Raises
        ------
        GeometryError
            The shifts ask the gears to run closer than their base circles allow.
        """
        alpha = self.transverse_pressure_angle
        if self.centre_distance is not None:
            cosine = self.reference_centre_distance * math.cos(alpha) / self.centre_distance
            if not 0.0 < cosine < 1.0:
                raise GeometryError(
                    f"a centre distance of {self.centre_distance * 1e3:.4g} mm is inside the base "
                    f"circles of {self.pinion_teeth} and {abs(self.wheel_teeth)} teeth; without "
                    f"shift it is {self.reference_centre_distance * 1e3:.4g} mm."
                )
            return math.acos(cosine)
        shifts = self.pinion_shift + self.wheel_shift
        value = involute(alpha) + 2.0 * math.tan(self.rack.pressure_angle) * shifts / (
            self.pinion_teeth + self.wheel_teeth
        )
        if value <= 0.0:
            raise GeometryError(
                f"the profile shifts {self.pinion_shift:g} and {self.wheel_shift:g} of "
                f"{self.pinion_teeth} and {abs(self.wheel_teeth)} teeth leave no pressure angle; "
                "bring their sum nearer to zero."
            )
        return inverse_involute(value)

    @functools.cached_property
    def working_centre_distance(self) -> float:
        """A = a_d cos(alpha_t)/cos(alpha_wt), m; negative for an internal pair."""
        return (
            self.reference_centre_distance
            * math.cos(self.transverse_pressure_angle)
            / math.cos(self.working_pressure_angle)
        )

    @property
    def transverse_base_pitch(self) -> float:
        """p_et = pi m_n cos(alpha_t)/cos(beta), m."""
        return (
            math.pi
            * self.module
            * math.cos(self.transverse_pressure_angle)
            / math.cos(self.helix_angle)
        )

    @functools.cached_property
    def path_of_contact(self) -> tuple[float, float]:
        """Radius of curvature of the pinion's flank where contact begins and where it ends, m.

        Contact needs both involutes: it lies between the tip circles and, where one reaches further
        than the mate's involute, the form circles (ISO 21771:2007, 5.4).
        """
        (tip_1, tip_2), (form_1, form_2) = self._roll_lengths, self.form_rolls
        return (
            max(self.tangent_length - tip_2, form_1),
            min(tip_1, self.tangent_length - form_2),
        )

    @property
    def _roll_lengths(self) -> tuple[float, float]:
        """Radii of curvature of the flanks at the tips of pinion and wheel, m, signed."""
        first, second = (
            math.copysign(0.5 * math.sqrt(tip * tip - self.base_diameter(teeth) ** 2), teeth)
            for teeth, tip in zip(self.teeth, self.tip_diameters, strict=True)
        )
        return first, second

    @functools.cached_property
    def transverse_contact_ratio(self) -> float:
        """eps_alpha from the tip circles (ISO 6336-1, 8.3; ISO 21771, 5.4).

        It takes both flanks to reach the line of action everywhere between the tip circles. Where
        a root is undercut or a tip interferes (:attr:`interference_free_contact_ratio` is then
        smaller) it is too favourable; the standard does not rate such gears.
        """
        return (sum(self._roll_lengths) - self.tangent_length) / self.transverse_base_pitch

    @functools.cached_property
    def interference_free_contact_ratio(self) -> float:
        """eps_alpha of :attr:`path_of_contact`."""
        begin, end = self.path_of_contact
        return (end - begin) / self.transverse_base_pitch

    @property
    def root_interference(self) -> tuple[float, float]:
        """How far the mate's tip reaches past the involute of pinion and wheel, m of curvature.

        Positive: the tip runs into the root fillet, and no such pair turns.
        """
        (tip_1, tip_2), (form_1, form_2) = self._roll_lengths, self.form_rolls
        return form_1 - (self.tangent_length - tip_2), tip_1 - (self.tangent_length - form_2)

    @property
    def tip_fouling(self) -> float:
        """Room between the tips of pinion and ring away from the line of action, rad of the ring.

        Negative where they foul. Tip corners that pass one point of both tip circles: theta_2 +
        inv(alpha_a2) - inv(alpha_wt) against z_1/|z_2| times the pinion's (Colbourne, The Geometry
        of Involute Gears, 1987, ch. 8).
        """
        distance = abs(self.working_centre_distance)
        radius_1, radius_2 = (0.5 * abs(tip) for tip in self.tip_diameters)
        if radius_1 + distance <= radius_2:
            return math.pi
        cosine_1 = (radius_2**2 - radius_1**2 - distance**2) / (2.0 * distance * radius_1)
        cosine_2 = (radius_2**2 - radius_1**2 + distance**2) / (2.0 * distance * radius_2)
        working = involute(self.working_pressure_angle)
        turned = []
        for cosine, teeth, tip in zip(
            (cosine_1, cosine_2), self.teeth, self.tip_diameters, strict=True
        ):
            flank = involute(math.acos(self.base_diameter(teeth) / tip)) - working
            turned.append(math.acos(min(max(cosine, -1.0), 1.0)) + flank)
        return turned[0] * self.pinion_teeth / abs(self.wheel_teeth) - turned[1]

    @property
    def overlap_ratio(self) -> float:
        """eps_beta = b sin(beta)/(pi m_n)."""
        return self.face_width * math.sin(abs(self.helix_angle)) / (math.pi * self.module)

    @property
    def virtual_teeth(self) -> tuple[float, float]:
        """z_n = z/(cos^2(beta_b) cos(beta)) of both gears, ISO 6336-3:2006 eq. 21."""
        factor = 1.0 / (math.cos(self.base_helix_angle) ** 2 * math.cos(self.helix_angle))
        return self.pinion_teeth * factor, self.wheel_teeth * factor

    def tip_thickness(self, index: int) -> float:
        """Transverse tooth thickness at the tip circle of pinion (0) or wheel (1), m.

        s_a = |d_a| ((pi/2 + 2 x tan(alpha_n))/|z| +- (inv(alpha_t) - inv(alpha_a))), the upper
        sign for an external gear (ISO 21771 eq. 44): a ring's teeth grow narrower inward.
        """
        teeth, shift = self.teeth[index], self.shifts[index]
        tip = self.tip_diameters[index]
        alpha_tip = math.acos(self.base_diameter(teeth) / tip)
        half = 0.5 * math.pi + 2.0 * shift * math.tan(self.rack.pressure_angle)
        flank = involute(self.transverse_pressure_angle) - involute(alpha_tip)
        return tip * (half / teeth + flank)
