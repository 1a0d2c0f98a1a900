"""Screws that are tightened: threads, the preload of a torque, and what is left of it (VDI 2230).

The rules are those of VDI 2230 part 1 (2015) in their simple form: concentric clamping, a working
load that takes all of itself from the clamp. Symbols are theirs::

    F_M = nu R_p A_0/sqrt(1 + 3 (3/2 d_2/d_0 (P/(pi d_2) + 1.155 mu))^2)       the preload
    M_A = F_M (0.16 P + 0.58 d_2 mu + mu D_Km/2)                               its torque
    F_Z = f_Z/(delta_S + delta_P)                                              what embedding takes
    F_th = l_K (alpha_P - alpha_S) dT/(delta_S + delta_P)                      cold takes, heat adds
    F_V = F_M/alpha_A - F_Z - F_th                                             what is left at least
    s_B = sqrt(((F_M + F_th)/A_S)^2 + 3 (k_tau tau_M)^2)                       its stress in use
    F_mG = tau_B pi d m/P (P/2 + (d - D_2) tan 30 deg)                         what strips the nut
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from cqdd_design.catalog.materials import Material
from cqdd_design.catalog.threads import Thread

FRICTION = 0.12
"""mu of thread and head, lightly oiled: where friction class B of VDI 2230, 0.08 to 0.16, lies."""
UTILISATION = 0.9
"""nu: share of the yield strength that tension and torsion together take at the torque."""
TIGHTENING_FACTOR = 1.6
"""alpha_A of a torque wrench where friction is estimated: greatest over least preload."""
EMBEDDING_ENDS, EMBEDDING_FACE = 6e-6, 2e-6
"""f_Z of thread and head together, and of every face between clamped parts, m: ground and turned
faces under a transverse load (VDI 2230, table 5.4/1)."""
TWIST_LEFT = 0.5
"""k_tau: share of the torsion of tightening that is left in use (VDI 2230, eq. R8/4)."""
TIGHTENED = 20.0
"""Temperature at which screws are tightened, deg C."""
GRIP_FRICTION = 0.15
"""mu of clean dry faces between clamped parts (VDI 2230, table A6: 0.1 to 0.18, steel on
aluminium)."""
SHEAR_SHARE = 0.6
"""Shear strength of a thread's material over its ultimate strength, the least of VDI 2230's for
steels and wrought aluminium."""
STRIPPING_SAFETY = 1.5
"""Least force that strips a thread over the greatest preload."""


@dataclass(frozen=True)
class Clamping:
    """A screw and what it holds together.

    Attributes
    ----------
    thread : Thread
    screw, clamped, tapped : Material or None
        Of the screw, of what is under its head, of the thread it is in; None where that is another
        machine's and not judged.
    bearing_outer, bearing_inner : float
        Diameters of the face under the head, m.
    grip, engaged : float
        Length that is clamped, and that of thread in thread, m.
    faces : int
        Between clamped parts.
    coldest : float
        To which what is held together cools once it is tightened at 20 deg C, deg C.
    """

    thread: Thread
    screw: Material
    clamped: Material
    tapped: Material | None
    bearing_outer: float
    bearing_inner: float
    grip: float
    engaged: float
    faces: int
    coldest: float = TIGHTENED

    @property
    def preload(self) -> float:
        """Greatest preload at the stated torque, N: what screw, head's seat and thread all bear.

        Seat and thread of a plastic whose creep is known bear it for long.
        """
        most = [self._bears]
        seats = self.clamped.yield_strength, self.clamped.held_stress
        most += [seat * self.bearing_area for seat in seats if seat is not None]
        if self.stripping is not None:
            most.append(self.stripping / STRIPPING_SAFETY)
        held = None if self.tapped is None else self.tapped.held_stress
        if held is not None:
            most.append(stripping_force(self.thread, self.engaged, SHEAR_SHARE * held))
        return min(most)

    @property
    def screw_yields(self) -> bool:
        """Whether the screw is what bears no more preload, not head's seat nor thread."""
        return self.preload >= self._bears

    @property
    def _bears(self) -> float:
        """Preload that the screw itself bears, N."""
        return preload_at_yield(self.thread, UTILISATION * (self.screw.yield_strength or 0.0))

    @property
    def bearing_area(self) -> float:
        """Under the head, m^2."""
        return 0.25 * math.pi * (self.bearing_outer**2 - self.bearing_inner**2)

    @property
    def torque(self) -> float:
        """That gives this preload, N m."""
        mean = 0.5 * (self.bearing_outer + self.bearing_inner)
        return tightening_torque(self.preload, self.thread, mean)

    @property
    def stress(self) -> float:
        """Of the screw's tension at this preload, Pa."""
        return self.preload / self.thread.stress_area

    def working_stress(self, warm: float) -> float:
        """Von Mises stress of the screw where the joint is as warm as it gets (deg C), Pa.

        At the greatest preload, and with what parts that grow by more than the screw add to it.
        """
        added = self._growth(max(warm - TIGHTENED, 0.0)) / self._new_resilience
        twist = TWIST_LEFT * _twist(self.thread, FRICTION) * self.stress
        return math.hypot(self.stress + added / self.thread.stress_area, math.sqrt(3.0) * twist)

    @property
    def stripping(self) -> float | None:
        """Force that strips the thread it is in, N; None where that is not judged."""
        if self.tapped is None:
            return None
        weak = SHEAR_SHARE * (self.tapped.ultimate_strength or 0.0)
        return stripping_force(self.thread, self.engaged, weak)

    @property
    def least_preload(self) -> float:
        """What is left after scatter, embedding and cold, N; 0 where these take all.

        Where what is clamped shrinks by more than the screw, as aluminium does. Materials whose
        expansion is not known count as the screw's.
        """
        lost = EMBEDDING_ENDS + EMBEDDING_FACE * self.faces
        lost += self._growth(max(TIGHTENED - self.coldest, 0.0))
        return max(self.preload / TIGHTENING_FACTOR - lost / self._new_resilience, 0.0)

    def _growth(self, change: float) -> float:
        """By how much more than the screw what is clamped grows over a change (K), m."""
        steel, other = self.screw.expansion or 0.0, self.clamped.expansion
        return self.grip * change * (0.0 if other is None else max(other - steel, 0.0))

    @property
    def _new_resilience(self) -> float:
        """delta_S + delta_P of materials that have not crept, m/N."""
        tapped = self.screw if self.tapped is None else self.tapped
        return self._resilience(self.clamped.youngs_modulus, tapped.youngs_modulus)

    @property
    def held_preload(self) -> float | None:
        """What is left of `least_preload` after 1000 h, N; None where a plastic's creep is unknown.

        Screw and plastic stay as long as they were tightened: what is soft and grows softer gives
        way to the screw. Moduli of creep are put where elastic ones stood (Crawford, Plastics
        Engineering, pseudo-elastic design).
        """
        tapped = self.screw if self.tapped is None else self.tapped
        clamped_later, tapped_later = _lasting(self.clamped), _lasting(tapped)
        if clamped_later is None or tapped_later is None:
            return None
        later = self._resilience(clamped_later, tapped_later)
        return self.least_preload * self._new_resilience / later

    @property
    def in_plastic(self) -> Material | None:
        """Of head's seat or thread, the one that is a plastic; None where neither is."""
        found = (one for one in (self.clamped, self.tapped) if one is not None and one.is_plastic)
        return next(found, None)

    def _resilience(self, clamped: float, tapped: float) -> float:
        """delta_S + delta_P, m/N, for Young's moduli of what is clamped and of the thread, Pa."""
        thread, steel = self.thread, self.screw.youngs_modulus
        core = 0.25 * math.pi * thread.root_diameter**2
        shank = 0.25 * math.pi * thread.diameter**2
        d = thread.diameter
        soft = (0.4 * d / shank + (self.grip + 0.5 * d) / core) / steel + 0.33 * d / shank / tapped
        area = substitution_area(self.bearing_outer, self.bearing_inner, self.grip)
        return soft + self.grip / (area * clamped)


def _lasting(material: Material) -> float | None:
    """Modulus after 1000 h, Pa: a metal's own, a plastic's of creep, None where not known."""
    return material.creep_modulus if material.is_plastic else material.youngs_modulus


def preload_at_yield(thread: Thread, strength: float, friction: float = FRICTION) -> float:
    """Preload at which tension and torsion reach a strength (Pa), N (VDI 2230, eq. R8/1).

    Examples
    --------
    Table A1 of VDI 2230 has 29.6 kN for M10, 8.8, at 0.12:

    >>> from cqdd_design.catalog.threads import coarse_thread
    >>> round(preload_at_yield(coarse_thread(10e-3), 0.9 * 640e6) / 1e3, 1)
    29.6
    """
    twist = _twist(thread, friction)
    return strength * thread.stress_area / math.sqrt(1.0 + 3.0 * twist**2)


def _twist(thread: Thread, friction: float) -> float:
    """Torsion of a screw that is tightened over its tension."""
    d2, d0 = thread.pitch_diameter, thread.stress_diameter
    return 1.5 * d2 / d0 * (thread.pitch / (math.pi * d2) + 1.155 * friction)


def tightening_torque(
    preload: float, thread: Thread, head: float, friction: float = FRICTION
) -> float:
    """Torque of a preload (N), N m, with friction under the head at a mean diameter (m)."""
    d2 = thread.pitch_diameter
    return preload * (0.16 * thread.pitch + (0.58 * d2 + 0.5 * head) * friction)


def torque_words(torque: float) -> str:
    """A tightening torque (N m) as sheets, bills and checks state it, its unit left out.

    Examples
    --------
    >>> torque_words(2.2841)
    '2.28'
    """
    return f"{torque:.3g}"


def stripping_force(thread: Thread, engaged: float, strength: float) -> float:
    """Force that shears a nut thread off over an engaged length (m), N; its shear strength in Pa.

    The first and the last half of a turn carry nothing (VDI 2230, section 5.5.5: 0.8 P).
    """
    carries = max(engaged - 0.8 * thread.pitch, 0.0)
    depth = 0.5 + (thread.diameter - thread.pitch_diameter) / thread.pitch * math.tan(math.pi / 6.0)
    return strength * math.pi * thread.diameter * carries * depth


def substitution_area(head: float, hole: float, grip: float) -> float:
    """Area of the cylinder that yields as wide clamped plates do, m^2 (VDI 2230, 1986).

    Parameters
    ----------
    head, hole : float
        Diameters under the head and of the hole, m.
    grip : float
        Length that is clamped, m.
    """
    wide = head + grip
    spread = math.cbrt(grip * head / wide**2)
    ring = 0.25 * math.pi * (head**2 - hole**2)
    return ring + 0.125 * math.pi * head * (wide - head) * ((spread + 1.0) ** 2 - 1.0)
