"""The tools that cut involute teeth, and where the involute ends that they leave.

Lengths are in modules here. An external gear is cut by a rack, a ring by a pinion cutter; both
tools have rounded tips, so below the form circle (ISO 21771:2007, clause 7: root form diameter)
there is fillet and no involute, and no mate can be in proper contact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from scipy.optimize import brentq

from cqdd_design.errors import UsageError


def involute(angle: float) -> float:
    """inv(alpha) = tan(alpha) - alpha, rad."""
    return math.tan(angle) - angle


def inverse_involute(value: float) -> float:
    """The angle in [0, pi/2) whose involute is `value` >= 0, by Newton's method.

    Examples
    --------
    >>> round(inverse_involute(involute(0.35)), 12)
    0.35
    """
    # inv(a) > a^3/3, so this start lies above the root, from where Newton falls monotonically.
    angle = min(math.cbrt(3.0 * value), 1.4)
    for _ in range(60):
        step = (involute(angle) - value) / max(math.tan(angle) ** 2, 1e-12)
        angle = min(max(angle - step, 1e-9), 1.55)
        if abs(step) < 1e-15:
            break
    return angle


@dataclass(frozen=True)
class BasicRack:
    """Basic rack tooth profile, lengths in modules.

    Attributes
    ----------
    addendum, dedendum, fillet_radius : float
        h_aP*, h_fP*, rho_fP*. The defaults are profile A of ISO 53:1998.
    pressure_angle : float
        Normal pressure angle, rad.
    """

    addendum: float = 1.0
    dedendum: float = 1.25
    fillet_radius: float = 0.38
    pressure_angle: float = math.radians(20.0)

    @property
    def half_tip_land(self) -> float:
        """Half the flat between the roundings of the tool's tip, in modules.

        This is E of ISO 6336-3:2006 eq. 10 without undercut: pi/4 - h_fP* tan(alpha) - (1 -
        sin(alpha)) rho_fP*/cos(alpha).
        """
        alpha = self.pressure_angle
        rounding = (1.0 - math.sin(alpha)) * self.fillet_radius / math.cos(alpha)
        return 0.25 * math.pi - self.dedendum * math.tan(alpha) - rounding

    @property
    def straight_depth(self) -> float:
        """How far the straight flank reaches below the reference line, h_FfP*, in modules."""
        return self.dedendum - self.fillet_radius * (1.0 - math.sin(self.pressure_angle))


#: The usual basic rack.
ISO_53_A = BasicRack()

#: Least teeth of the usual pinion cutter; smaller rings are cut by one of half their teeth.
CUTTER_TEETH = 20
#: A rounding of the cutter's tip takes this share of the largest there is room for, so that a land
#: is left between both.
_SHARE_OF_FULL_RADIUS = 0.85


def full_tip_radius(teeth: int, rack: BasicRack = ISO_53_A) -> float:
    """Largest rounding at the tip of a pinion cutter, in modules: both sides meet in one arc.

    The rounding touches tip circle and involute, so its centre lies on a tangent of the base
    circle, one radius short of the involute; at most it lies on the tooth's centre line.

    Examples
    --------
    >>> round(full_tip_radius(20), 3)
    0.346
    """
    tip = 0.5 * teeth + rack.dedendum
    base = 0.5 * teeth * math.cos(rack.pressure_angle)
    half_base = 0.5 * math.pi / teeth + involute(rack.pressure_angle)

    def room(radius: float) -> float:
        along = math.sqrt((tip - radius) ** 2 - base**2)
        return half_base - (along + radius) / base + math.atan2(along, base)

    return float(brentq(room, 0.0, tip - base, xtol=1e-14))


@dataclass(frozen=True)
class PinionCutter:
    """A pinion cutter without profile shift, which cuts a ring to the depth of the rack.

    Attributes
    ----------
    teeth : int
        z_0.
    tip_radius : float
        Rounding of its tips rho_a0, in modules.

    Raises
    ------
    UsageError
        The rounding is larger than the tooth.
    """

    teeth: int
    tip_radius: float

    def __post_init__(self) -> None:
        """Refuse a cutter that cannot exist."""
        most = full_tip_radius(self.teeth)
        if not 0.0 <= self.tip_radius <= most:
            raise UsageError(
                f"cutter: a tip radius of {self.tip_radius:g} modules does not fit a cutter of "
                f"{self.teeth} teeth, whose tips are round all over at {most:.3f}."
            )

    @classmethod
    def usual(
        cls, ring_teeth: int, pinion_teeth: int = 0, rack: BasicRack = ISO_53_A
    ) -> PinionCutter:
        """The cutter of a ring where none is named.

        It has no fewer teeth than the gear that will run in the ring, whose tips would else reach
        past the involute that the cutter leaves.

        Examples
        --------
        >>> cutter = PinionCutter.usual(70)
        >>> cutter.teeth, round(cutter.tip_radius, 3)
        (20, 0.294)
        """
        teeth = max(min(CUTTER_TEETH, ring_teeth // 2), pinion_teeth)
        radius = min(rack.fillet_radius, _SHARE_OF_FULL_RADIUS * full_tip_radius(teeth, rack))
        return cls(teeth, radius)


def rack_form_roll(
    teeth: int, shift: float, rack: BasicRack = ISO_53_A, helix_angle: float = 0.0
) -> float:
    """Radius of curvature where the involute of a rack-cut gear begins, in normal modules.

    r sin(alpha_t) - (h_FfP* - x)/sin(alpha_t) (ISO 21771:2007, 7.6). Where that is negative the
    rack undercuts: the involute then begins where the fillet, a trochoid, crosses it. An undercut
    helical gear counts from its base circle.

    Examples
    --------
    The 22-tooth planet of the paper's planetary:

    >>> round(rack_form_roll(22, 0.0), 3)
    0.839
    """
    alpha = math.atan(math.tan(rack.pressure_angle) / math.cos(helix_angle))
    radius = 0.5 * teeth / math.cos(helix_angle)
    roll = radius * math.sin(alpha) - (rack.straight_depth - shift) / math.sin(alpha)
    if roll >= 0.0:
        return roll
    return 0.0 if helix_angle else _undercut_roll(teeth, shift, rack)


def _undercut_roll(teeth: int, shift: float, rack: BasicRack) -> float:
    """Radius of curvature where the fillet of an undercut spur gear crosses its involute.

    The gear stands with a space on the y axis and the rack's tooth in it. The rounding's centre is
    x to the side and g below the pitch point; the fillet is its offset along the line through
    both, turned back by the roll (x - E)/r.
    """
    alpha, r = rack.pressure_angle, 0.5 * teeth
    depth = rack.dedendum - rack.fillet_radius - shift
    base = r * math.cos(alpha)
    half_space = (0.5 * math.pi - 2.0 * shift * math.tan(alpha)) / teeth

    def fillet(x: float) -> tuple[float, float]:
        share = 1.0 + rack.fillet_radius / math.hypot(x, depth)
        across, up = x * share, r - depth * share
        turned = math.atan2(across, up) - (x - rack.half_tip_land) / r
        return math.hypot(across, up), turned

    def room(x: float) -> float:
        where, turned = fillet(x)
        angle = math.acos(min(base / where, 1.0))
        return turned - (half_space - involute(alpha) + involute(angle))

    # The straight flank ends where its normal has the pressure angle.
    end = depth / math.tan(alpha)
    begin = brentq(lambda x: fillet(x)[0] - base, 1e-12, end)
    if room(begin) <= 0.0:
        return 0.0
    crossing = fillet(brentq(room, begin, end))[0]
    return math.sqrt(max(crossing**2 - base**2, 0.0))


def ring_form_roll(
    teeth: int, shift: float, cutter: PinionCutter, rack: BasicRack = ISO_53_A
) -> float:
    """Radius of curvature where a spur ring's involute ends, in modules, positive.

    Where the cutter's involute passes into its tip rounding, both are in contact with the ring's
    last involute point: |a_0| sin(alpha_w0) plus the cutter's radius of curvature there.

    Parameters
    ----------
    teeth : int
        Positive.
    shift : float
        x of the ring in the sign of ISO 21771.

    Examples
    --------
    >>> round(ring_form_roll(70, 0.0, PinionCutter(20, 0.0)), 3)
    14.736
    """
    alpha = rack.pressure_angle
    difference = teeth - cutter.teeth
    value = involute(alpha) - 2.0 * math.tan(alpha) * shift / difference
    working = inverse_involute(max(value, 0.0))
    tangent = 0.5 * difference * math.cos(alpha) * math.tan(working)
    base = 0.5 * cutter.teeth * math.cos(alpha)
    centre = 0.5 * cutter.teeth + rack.dedendum - cutter.tip_radius
    return tangent + math.sqrt(centre**2 - base**2) + cutter.tip_radius
