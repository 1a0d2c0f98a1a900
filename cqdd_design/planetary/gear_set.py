"""The whole gear set: both meshes built from tooth counts, rated for any number of planets."""

from __future__ import annotations

import math
from dataclasses import dataclass

from cqdd_design.errors import GeometryError, UsageError
from cqdd_design.planetary.assembly import (
    MOST_PLANETS,
    PlanetaryEnvelope,
    neighbour_gap,
    require_one_centre_distance,
)
from cqdd_design.planetary.gear_material import GearMaterial
from cqdd_design.planetary.kinematics import (
    PlanetaryTeeth,
    speeds,
    tangential_force,
    torques,
)
from cqdd_design.planetary.load_factors import MeshLoad, PlanetaryMesh
from cqdd_design.planetary.profile_shift import (
    ProfileShifts,
    default_shifts,
    least_shift_without_undercut,
)
from cqdd_design.planetary.rating import MeshRating, rate_mesh
from cqdd_design.planetary.settings import RatingSettings
from cqdd_design.planetary.tooth_geometry import GearPair, validate_module

#: Least rim outside the ring's root, m (the least wall of the cycloid's ring), and in modules.
LEAST_RING_WALL, RING_RIM_MODULES = 2.5e-3, 2.5


@dataclass(frozen=True)
class LoadCase:
    """A torque of the carrier with the life it must last.

    Attributes
    ----------
    name : str
        ``peak`` or ``continuous``.
    torque : float
        At the carrier, N*m.
    sun_speed : float
        rad/s.
    cycles : float or None
        Load cycles of every tooth; None counts them over the settings' life at `sun_speed`.
    """

    name: str
    torque: float
    sun_speed: float
    cycles: float | None


@dataclass(frozen=True)
class PlanetaryGearSet:
    """A compound planetary with fixed teeth, module and width; the number of planets is free.

    Attributes
    ----------
    module, face_width : float
        m; both meshes share them.
    centre_distance : float
        m.
    warnings : tuple of str
        Undercut, interference, thin tips, ranges of validity.
    """

    teeth: PlanetaryTeeth
    module: float
    face_width: float
    shifts: ProfileShifts
    centre_distance: float
    sun_mesh: PlanetaryMesh
    ring_mesh: PlanetaryMesh
    envelope: PlanetaryEnvelope
    settings: RatingSettings
    warnings: tuple[str, ...]

    @property
    def largest_tip_diameter(self) -> float:
        """Tip diameter of the larger planet gear, m."""
        return max(self.sun_mesh.pair.tip_diameters[1], self.ring_mesh.pair.tip_diameters[0])

    @property
    def ring_tip_diameter(self) -> float:
        """As made, m, positive."""
        return -self.ring_mesh.pair.tip_diameters[1]

    @property
    def shifts_text(self) -> str:
        """Profile shifts of sun, planet, planet and ring, as they are written."""
        return ", ".join(f"{shift:g}" for shift in vars(self.shifts).values())

    def fits(self, planets: int) -> bool:
        """Whether neighbouring planets clear each other."""
        return neighbour_gap(self.centre_distance, self.largest_tip_diameter, planets) > 0.0


def build_gear_set(
    teeth: PlanetaryTeeth,
    module: float,
    face_width: float,
    settings: RatingSettings | None = None,
) -> PlanetaryGearSet:
    """Build both meshes and check that they share one centre distance.

    Parameters
    ----------
    module, face_width : float
        m.

    Raises
    ------
    UsageError
        Module, width or shifts outside their ranges.
    GeometryError
        Unequal centre distances, teeth that cannot mesh, pointed teeth.

    Examples
    --------
    >>> gears = build_gear_set(PlanetaryTeeth(12, 36, 22, 70), 1e-3, 12e-3)
    >>> round(gears.centre_distance * 1e3, 9), gears.fits(3), gears.fits(4)
    (24.0, True, False)
    """
    chosen = settings or RatingSettings()
    shifts = chosen.shifts or default_shifts(teeth)
    if not teeth.stepped and shifts.planet_sun != shifts.planet_ring:
        raise UsageError(
            f"shifts: the planet of {teeth.planet_sun} teeth is one gear in both meshes and cannot "
            f"have the shifts {shifts.planet_sun:g} and {shifts.planet_ring:g}; give both "
            f"{shifts.planet_sun:g}."
        )
    validate_module(module)
    if shifts.sun + shifts.planet_sun == 0.0 == shifts.planet_ring + shifts.ring:
        # Before the teeth are looked at: counts that belong on no common pin deserve that message,
        # not a remark about some tooth of theirs.
        sun_distance = 0.5 * module * (teeth.sun + teeth.planet_sun)
        ring_distance = 0.5 * module * (teeth.ring - teeth.planet_ring)
        require_one_centre_distance(teeth, module, sun_distance, ring_distance)
    sun_pair = GearPair(
        teeth.sun, teeth.planet_sun, module, face_width, shifts.sun, shifts.planet_sun
    )
    made = chosen.ring_tip_diameter
    ring_pair = GearPair(
        teeth.planet_ring,
        -teeth.ring,
        module,
        face_width,
        shifts.planet_ring,
        shifts.ring,
        wheel_tip_diameter=None if made is None else -made,
    )
    distance = sun_pair.working_centre_distance
    require_one_centre_distance(teeth, module, distance, -ring_pair.working_centre_distance)
    rim, idler = max(LEAST_RING_WALL, RING_RIM_MODULES * module), not teeth.stepped
    sun_mesh = PlanetaryMesh("sun_planet", sun_pair, (False, idler))
    ring_mesh = PlanetaryMesh("planet_ring", ring_pair, (idler, False), rim)
    tip = max(sun_pair.tip_diameters[1], ring_pair.tip_diameters[0])
    smallest_root, depth = min(
        (sun_pair.root_diameters[1], sun_pair.tooth_depths[1]),
        (ring_pair.root_diameters[0], ring_pair.tooth_depths[0]),
    )
    envelope = PlanetaryEnvelope(
        planet_sweep_diameter=2.0 * distance + tip,
        ring_outer_diameter=-ring_pair.root_diameters[1] + 2.0 * rim,
        planet_bore_most=max(smallest_root - 2.4 * depth, 0.0),
    )
    return PlanetaryGearSet(
        teeth,
        module,
        face_width,
        shifts,
        distance,
        sun_mesh,
        ring_mesh,
        envelope,
        chosen,
        _warnings(teeth, shifts, sun_pair, ring_pair),
    )


def _warnings(
    teeth: PlanetaryTeeth,
    shifts: ProfileShifts,
    sun_pair: GearPair,
    ring_pair: GearPair,
) -> tuple[str, ...]:
    """What a rating of these teeth cannot promise, one sentence each."""
    found = []
    for name, count, shift in (
        ("sun", teeth.sun, shifts.sun),
        ("planet at the sun", teeth.planet_sun, shifts.planet_sun),
        ("planet at the ring", teeth.planet_ring, shifts.planet_ring),
    ):
        least = least_shift_without_undercut(count)
        if shift < least - 1e-9:
            found.append(
                f"The {name} of {count} teeth is undercut at profile shift {shift:g}; ISO 6336 "
                f"rates it too favourably. It needs {least:.3f} or more."
            )
    for names, pair in ((("sun", "planet"), sun_pair), (("planet", "ring"), ring_pair)):
        name, nominal = " and ".join(names), pair.transverse_contact_ratio
        found += _interference(names, pair)
        if nominal >= 2.0:
            found.append(
                f"{name.capitalize()} have a contact ratio of {nominal:.2f}; two pairs always "
                "share the load, which is not credited beyond Z_eps."
            )
        for index in (0, 1):
            count = abs(pair.teeth[index])
            if pair.tip_thickness(index) <= 0.0:
                raise GeometryError(
                    f"the teeth of the gear of {count} teeth come to a point below their full "
                    f"height at profile shift {pair.shifts[index]:g}; give it more teeth or a "
                    "smaller shift."
                )
            if pair.tip_thickness(index) < 0.2 * pair.module:
                found.append(
                    f"The tips of the gear of {count} teeth are "
                    f"{pair.tip_thickness(index) * 1e3:.3f} mm wide, less than 0.2 modules; lower "
                    "its profile shift."
                )
    in_scope = sun_pair.module >= 0.5e-3 and 4e-3 <= sun_pair.face_width <= 1.2
    if not in_scope:
        found.append(
            "ISO 1328-1 defines tolerances for modules from 0.5 mm and widths from 4 to 1200 mm; "
            "outside they are extrapolated."
        )
    return tuple(found)


def _interference(names: tuple[str, str], pair: GearPair) -> list[str]:
    """Where the tips of one gear reach past the involute of the other."""
    found = []
    for index, past in enumerate(pair.root_interference):
        if past <= 1e-9:
            continue
        here, there = names[index], names[1 - index]
        form = abs(pair.form_rolls[index]) * 1e3
        met = form - past * 1e3 if index == 0 or not pair.internal else form + past * 1e3
        where = (
            f"The tips of the {there} reach the {here} at a radius of curvature of {met:.3f} mm, "
            f"past the end of its involute at {form:.3f} mm: "
        )
        undercut = pair.shifts[index] < least_shift_without_undercut(abs(pair.teeth[index]))
        if undercut and pair.teeth[index] > 0:
            found.append(
                f"{where}of the contact ratio {pair.transverse_contact_ratio:.3f} only "
                f"{pair.interference_free_contact_ratio:.3f} is usable. Shift the {here} outward."
            )
        else:
            clears = abs(pair.clearing_tip_diameters[1 - index]) * 1e3
            found.append(
                f"{where}they run into its root fillet, and such a pair does not turn. A tip "
                f"diameter of {clears:.3f} mm clears."
            )
    if pair.internal and pair.tip_fouling < 0.0:
        found.append(
            "The tips of planet and ring foul each other beside the line of action; give the ring "
            "more teeth or shorter tips."
        )
    return found


def rate_gear_set(
    gears: PlanetaryGearSet, planets: int, case: LoadCase, material: GearMaterial
) -> tuple[MeshRating, MeshRating]:
    """Sun and ring mesh with `planets` planets under one load case.

    The planets need not fit: the rating answers how many the teeth would need.
    """
    settings = gears.settings
    load = torques(gears.teeth, case.torque, planets)
    relative = speeds(gears.teeth, case.sun_speed)
    turns = settings.life_hours * 3600.0 / (2.0 * math.pi)
    sun_cycles = planets * abs(relative.sun_to_carrier) * turns
    planet_cycles = abs(relative.planet_to_carrier) * turns
    ring_cycles = planets * abs(relative.ring_to_carrier) * turns
    if case.cycles is not None:
        sun_cycles = planet_cycles = ring_cycles = case.cycles
    sun_load = MeshLoad(
        case.name,
        planets,
        tangential_force(load.sun / planets, gears.teeth.sun, gears.module),
        abs(relative.sun_to_carrier),
        sun_cycles,
        planet_cycles,
    )
    ring_load = MeshLoad(
        case.name,
        planets,
        tangential_force(load.planet, gears.teeth.planet_ring, gears.module),
        abs(relative.planet_to_carrier),
        planet_cycles,
        ring_cycles,
    )
    return (
        rate_mesh(gears.sun_mesh, sun_load, material, settings),
        rate_mesh(gears.ring_mesh, ring_load, material, settings),
    )


def reserve(gears: PlanetaryGearSet, planets: int, case: LoadCase, material: GearMaterial) -> float:
    """The least safety factor of contact or bending over the one asked for: 1 and more is safe."""
    settings = gears.settings
    return min(
        min(
            rating.contact_safety / settings.least_contact_safety,
            rating.bending_safety / settings.least_bending_safety,
        )
        for rating in rate_gear_set(gears, planets, case, material)
    )


def planets_needed(
    gears: PlanetaryGearSet, case: LoadCase, material: GearMaterial, criterion: str
) -> int | None:
    """The fewest planets, fitting or not, with which both meshes keep their safety factor.

    Parameters
    ----------
    criterion : {"contact", "bending"}

    Returns
    -------
    int or None
        None when 24 planets do not suffice.
    """
    settings = gears.settings
    for planets in range(1, MOST_PLANETS + 1):
        ratings = rate_gear_set(gears, planets, case, material)
        if criterion == "contact":
            safe = all(r.contact_safety >= settings.least_contact_safety for r in ratings)
        else:
            safe = all(r.bending_safety >= settings.least_bending_safety for r in ratings)
        if safe:
            return planets
    return None
