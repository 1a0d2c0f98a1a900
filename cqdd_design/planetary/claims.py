"""The paper's six sentences about cycloid and compound planetary, each answered by computation.

The paper (section III, "Sizing of Cycloidal and Planetary Gears") names teeth 12/36/22/70, module
1, 12 mm of face, 120 N*m peak and 40 N*m continuous torque, but neither material nor load factors,
so an answer is only as good as the settings it is given under. Each answer therefore states them,
and the two that hang on them (how many planets, surface failure) are tried over a stated grid of
materials and factors: they hold only where every setting says so. What is judged is the paper's
actuator, not the design that somebody compares.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from cqdd_design.planetary.assembly import (
    MOST_PLANETS,
    assembles,
    most_planets_that_fit,
    neighbour_gap,
)
from cqdd_design.planetary.claim_settings import (
    PAPER_CONTINUOUS_TORQUE,
    PAPER_FACE_WIDTH,
    PAPER_MODULE,
    PAPER_PEAK_TORQUE,
    PAPER_PIN_TORQUE,
    PAPER_PLANETS,
    PAPER_RATIO,
    PAPER_TEETH,
    ClaimSetting,
    evaluate_settings,
    search_settings,
)
from cqdd_design.planetary.cycloid import CycloidLimit, binding_limit
from cqdd_design.planetary.gear_material import GearMaterial
from cqdd_design.planetary.gear_set import (
    LoadCase,
    PlanetaryGearSet,
    build_gear_set,
    planets_needed,
    reserve,
)
from cqdd_design.planetary.kinematics import ratio_carrier_fixed, ratio_ring_fixed
from cqdd_design.planetary.settings import RatingSettings


@dataclass(frozen=True)
class Claim:
    """One sentence of the paper and our answer.

    Attributes
    ----------
    claim : str
        What the paper says.
    paper, ours : str
        The paper's figure, and ours.
    holds : bool or None
        None when settings decide it, or nothing was handed in to judge it by.
    under : str
        The settings the answer holds under, and for which others it would turn out otherwise.
    """

    claim: str
    paper: str
    ours: str
    holds: bool | None
    under: str

    @property
    def verdict(self) -> str:
        """In words: ``holds``, ``does not hold``, ``hangs on the settings`` or ``not computed``."""
        if self.holds is None:
            return "not computed" if self.ours == _NOT_COMPUTED else "hangs on the settings"
        return "holds" if self.holds else "does not hold"

    def to_dict(self) -> dict[str, object]:
        """The JSON form: claim, paper, ours, holds, under, verdict."""
        return {**vars(self), "verdict": self.verdict}


_NOT_COMPUTED = "not computed"


@dataclass(frozen=True)
class PaperCase:
    """The paper's actuator, as far as its claims need it.

    Attributes
    ----------
    material : GearMaterial
        Of the planetary's gears.
    sun_speed : float
        rad/s, for life cycles and lubrication.
    bore : float or None
        Diameter of the space inside the stator, m.
    cycloid : tuple of CycloidLimit
        Limits of the cycloid; empty when none were computed.
    """

    material: GearMaterial
    sun_speed: float
    bore: float | None
    cycloid: tuple[CycloidLimit, ...]


def paper_claims(
    case: PaperCase, settings: RatingSettings
) -> tuple[tuple[Claim, ...], tuple[ClaimSetting, ...]]:
    """Answer the claims for the paper's gear set, and return the grid behind two of them."""
    gears = build_gear_set(PAPER_TEETH, PAPER_MODULE, PAPER_FACE_WIDTH, settings)
    peak = LoadCase("peak", PAPER_PEAK_TORQUE, case.sun_speed, settings.peak_cycles)
    continuous = LoadCase("continuous", PAPER_CONTINUOUS_TORQUE, case.sun_speed, None)
    grid = search_settings(settings, case.sun_speed)
    (own,) = evaluate_settings(gears, peak, continuous, case.material, settings.label)
    given = (
        f"{case.material.label}, {settings.label}; S_H {settings.least_contact_safety:g}, S_F "
        f"{settings.least_bending_safety:g} asked"
    )
    claims = (
        _ratio_claim(),
        _planets_claim(own, grid, given, gears, peak, case.material),
        _fit_claim(gears, case.bore),
        _surface_claim(own, grid, given, gears),
        _pins_claim(case.cycloid),
        _compact_claim(gears, case.bore),
    )
    return claims, grid


def _ratio_claim() -> Claim:
    ratio = ratio_ring_fixed(PAPER_TEETH)
    other = ratio_carrier_fixed(PAPER_TEETH)
    return Claim(
        claim=f"A compound planetary {PAPER_TEETH} has a gear ratio of {PAPER_RATIO}.",
        paper=f"{PAPER_RATIO}",
        ours=f"{ratio:.4f}",
        holds=abs(ratio - PAPER_RATIO) < 5e-3 * PAPER_RATIO,
        under=(
            f"Sun in, carrier out, ring held: 1 + Z_p1 Z_r/(Z_s Z_p2) = {ratio:.4f}, "
            f"{100.0 * (ratio / PAPER_RATIO - 1.0):+.1f} %. With the carrier held it is "
            f"{other:.4f}. Tooth counts alone decide; a ratio within 0.5 % would count as holding."
        ),
    )


def _by_every(found: Sequence[bool]) -> bool | None:
    """True or False where every setting says so, None where they differ."""
    return found[0] if len(set(found)) == 1 else None


def _examples(found: Sequence[ClaimSetting], total: int) -> str:
    if not found:
        return f"It holds for none of the {total} settings tried."
    if len(found) == total:
        return f"It holds for all {total} settings tried."
    # Spread over the grid, so that the examples are not three neighbours.
    step = max(len(found) // 3, 1)
    named = "; ".join(setting.label for setting in found[::step][:3])
    return f"It holds for {len(found)} of the {total} settings tried, such as {named}."


def _spread(grid: Sequence[ClaimSetting]) -> str:
    """How many settings need how many planets."""
    counted = Counter(setting.planets_needed for setting in grid)
    more = counted.pop(None, 0)
    parts = [f"{planets} in {counted[planets]}" for planets in sorted(filter(None, counted))]
    return ", ".join([*parts, *([f"more than {MOST_PLANETS} in {more}"] if more else [])])


def _planets_claim(
    own: ClaimSetting,
    grid: Sequence[ClaimSetting],
    given: str,
    gears: PlanetaryGearSet,
    peak: LoadCase,
    material: GearMaterial,
) -> Claim:
    beyond = f"more than {MOST_PLANETS}"
    alone = {
        criterion: planets_needed(gears, peak, material, criterion) or beyond
        for criterion in ("contact", "bending")
    }
    fewer = own.planets_needed or MOST_PLANETS + 1
    short = [
        f"{planets} do not assemble"
        if not assembles(gears.teeth, planets)
        else f"{planets} reach {reserve(gears, planets, peak, material):.2f} of the safety asked"
        for planets in range(max(fewer - 2, 1), fewer)
    ]
    return Claim(
        claim=f"{PAPER_PEAK_TORQUE:g} N*m of peak torque need {PAPER_PLANETS} planets.",
        paper=f"{PAPER_PLANETS}",
        ours=(
            f"{own.planets_needed or beyond} under the settings given; over all tried: "
            f"{_spread(grid)}"
        ),
        holds=_by_every([setting.six_needed for setting in (own, *grid)]),
        under=(
            f"Fewest identical planets that bear it for {gears.settings.peak_cycles:g} cycles and "
            f"can be spaced equally; contact alone asks for {alone['contact']}, bending for "
            f"{alone['bending']}"
            + "".join(f"; {words}" for words in short)
            + f". {given}. "
            + _examples([setting for setting in grid if setting.six_needed], len(grid))
        ),
    )


def _fit_claim(gears: PlanetaryGearSet, bore: float | None) -> Claim:
    gap = neighbour_gap(gears.centre_distance, gears.largest_tip_diameter, PAPER_PLANETS)
    most = most_planets_that_fit(gears.centre_distance, gears.largest_tip_diameter)
    size = gears.envelope.outer_diameter
    space = ""
    fits = gap > 0.0
    if bore is not None:
        fits = fits and gears.envelope.fits(bore)
        space = f" The bore inside the stator is {bore * 1e3:.4g} mm."
    return Claim(
        claim=f"{PAPER_PLANETS} planets do not fit the design constraints.",
        paper="does not fit",
        ours=(
            f"tips overlap by {-gap * 1e3:.1f} mm; {most} planets clear each other"
            if gap <= 0.0
            else f"tips clear by {gap * 1e3:.1f} mm"
        ),
        holds=not fits,
        under=(
            f"Geometry alone: planets of {gears.largest_tip_diameter * 1e3:.4g} mm tip diameter on "
            f"a centre distance of {gears.centre_distance * 1e3:.4g} mm, in one plane. With any "
            f"number of planets the gears sweep {size * 1e3:.4g} mm.{space}"
        ),
    )


def _surface_claim(
    own: ClaimSetting,
    grid: Sequence[ClaimSetting],
    given: str,
    gears: PlanetaryGearSet,
) -> Claim:
    fitting = most_planets_that_fit(gears.centre_distance, gears.largest_tip_diameter)
    # The continuous torque knows no peak cycles, so one number of them stands for all.
    tried = [setting for setting in grid if setting.peak_cycles == grid[0].peak_cycles]
    fails = [setting for setting in tried if setting.surface_failure]
    fitting_fails = sum(
        setting.contact_safety_fitting < setting.least_contact_safety for setting in tried
    )
    return Claim(
        claim=(
            f"Even with {PAPER_PLANETS} planets the flanks fail at the continuous torque of "
            f"{PAPER_CONTINUOUS_TORQUE:g} N*m."
        ),
        paper="surface failure",
        ours=(
            f"S_H {own.contact_safety_six:.2f} with {PAPER_PLANETS} planets, "
            f"{own.contact_safety_fitting:.2f} with the {fitting} that fit; they fail in "
            f"{len(fails)} of {len(tried)} settings"
        ),
        holds=_by_every([setting.surface_failure for setting in (own, *tried)]),
        under=(
            f"{gears.settings.life_hours:g} h at full input speed. {given}. "
            + _examples(fails, len(tried))
            + f" With the {fitting} planets that fit, the flanks fail in {fitting_fails} of them."
        ),
    )


def _pins_claim(cycloid: Sequence[CycloidLimit]) -> Claim:
    claim = "At peak torque the cycloid is limited by its output pins."
    paper = f"output pins, {PAPER_PIN_TORQUE:g} N*m"
    binding = binding_limit(cycloid, "peak")
    if binding is None:
        return Claim(claim, paper, _NOT_COMPUTED, None, "No limits of a cycloid were handed in.")
    pins = [limit for limit in cycloid if limit.load == "peak" and limit.part == "output pins"]
    least_pins = binding_limit(pins, "peak")
    own = (
        f" Output pins: {least_pins.torque_capacity:.1f} N*m ({least_pins.title})."
        if least_pins is not None
        else ""
    )
    return Claim(
        claim=claim,
        paper=paper,
        ours=f"{binding.part}, {binding.torque_capacity:.1f} N*m ({binding.title})",
        holds=binding.part == "output pins",
        under=(
            f"Torque at which each of {sum(limit.load == 'peak' for limit in cycloid)} peak limits "
            f"of the paper's cycloid is reached by the {binding.model}; the least binds, at "
            f"{binding.value:.4g} of {binding.limit:.4g} {binding.unit} for {binding.torque:.4g} "
            f"N*m.{own} The paper's {PAPER_PIN_TORQUE:g} N*m is single shear of all five pins "
            "fully loaded at once."
        ),
    )


def _compact_claim(gears: PlanetaryGearSet, bore: float | None) -> Claim:
    claim = f"A compound planetary {PAPER_TEETH} is compact enough to fit within the stator."
    paper = "fits"
    envelope = gears.envelope
    if bore is None:
        return Claim(claim, paper, _NOT_COMPUTED, None, "No bore of a stator was handed in.")
    sweep, ring = envelope.planet_sweep_diameter * 1e3, envelope.ring_outer_diameter * 1e3
    return Claim(
        claim=claim,
        paper=paper,
        ours=f"planets sweep {sweep:.1f} mm, the ring takes {ring:.1f} mm of {bore * 1e3:.4g} mm",
        holds=envelope.fits(bore),
        under=(
            f"Geometry alone: twice the centre distance of {gears.centre_distance * 1e3:.4g} mm "
            f"and a tip diameter of {gears.largest_tip_diameter * 1e3:.4g} mm; the ring's root "
            f"circle with a rim of {gears.ring_mesh.ring_rim * 1e3:.4g} mm. Any number of planets."
        ),
    )
