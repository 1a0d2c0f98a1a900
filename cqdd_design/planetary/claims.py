"""The paper's five sentences about its compound planetary, each answered by computation.

The paper (section III, "Sizing of Cycloidal and Planetary Gears") names teeth 12/36/22/70, module
1, 12 mm of face, 120 N*m peak and 40 N*m continuous torque, but neither material nor load factors,
so an answer is only as good as the settings it is given under. Each answer therefore states them,
and the two that hang on them (how many planets, surface failure) are also tried over a stated grid
of materials and factors.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from cqdd_design.planetary.assembly import most_planets_that_fit, neighbour_gap
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
    evaluate_setting,
    search_settings,
)
from cqdd_design.planetary.cycloid import CycloidLimit, binding_limit
from cqdd_design.planetary.gear_material import GearMaterial
from cqdd_design.planetary.gear_set import (
    LoadCase,
    PlanetaryGearSet,
    build_gear_set,
    planets_needed,
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
        None when nothing was handed in to judge it by.
    under : str
        The settings the answer holds under, and for which others it would turn out otherwise.
    """

    claim: str
    paper: str
    ours: str
    holds: bool | None
    under: str

    def to_dict(self) -> dict[str, object]:
        """The JSON form: claim, paper, ours, holds, under."""
        return dict(vars(self))


def paper_claims(
    material: GearMaterial,
    settings: RatingSettings,
    sun_speed: float,
    bore: float | None,
    cycloid: Sequence[CycloidLimit],
) -> tuple[tuple[Claim, ...], tuple[ClaimSetting, ...]]:
    """Answer the five claims for the paper's gear set, and return the grid behind two of them.

    Parameters
    ----------
    sun_speed : float
        rad/s, for life cycles and lubrication.
    bore : float or None
        Diameter of the space inside the stator, m.
    cycloid : sequence of CycloidLimit
        Limits of the cycloid at its peak torque; empty when none were computed.
    """
    gears = build_gear_set(PAPER_TEETH, PAPER_MODULE, PAPER_FACE_WIDTH, settings)
    peak = LoadCase("peak", PAPER_PEAK_TORQUE, sun_speed, settings.peak_cycles)
    continuous = LoadCase("continuous", PAPER_CONTINUOUS_TORQUE, sun_speed, None)
    grid = search_settings(settings, peak, continuous)
    own = evaluate_setting(gears, peak, continuous, material, settings.label)
    given = (
        f"{material.label}, {settings.label}; S_H {settings.least_contact_safety:g}, S_F "
        f"{settings.least_bending_safety:g} asked"
    )
    claims = (
        _ratio_claim(),
        _planets_claim(own, grid, given, gears, peak, material),
        _fit_claim(gears, bore),
        _surface_claim(own, grid, given, gears),
        _pins_claim(cycloid),
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


def _examples(found: Sequence[ClaimSetting], total: int) -> str:
    if not found:
        return f"It holds for none of the {total} settings tried."
    if len(found) == total:
        return f"It holds for all {total} settings tried."
    # Spread over the grid, so that the examples are not three neighbours.
    step = max(len(found) // 3, 1)
    named = "; ".join(setting.label for setting in found[::step][:3])
    return f"It holds for {len(found)} of the {total} settings tried, such as {named}."


def _planets_claim(
    own: ClaimSetting,
    grid: Sequence[ClaimSetting],
    given: str,
    gears: PlanetaryGearSet,
    peak: LoadCase,
    material: GearMaterial,
) -> Claim:
    needed = "more than 24" if own.planets_needed is None else str(own.planets_needed)
    alone = {
        criterion: planets_needed(gears, peak, material, criterion) or "more than 24"
        for criterion in ("contact", "bending")
    }
    return Claim(
        claim=f"{PAPER_PEAK_TORQUE:g} N*m of peak torque need {PAPER_PLANETS} planets.",
        paper=f"{PAPER_PLANETS}",
        ours=needed,
        holds=own.six_needed,
        under=(
            f"Fewest identical planets that bear it for {gears.settings.peak_cycles:g} cycles and "
            f"can be spaced equally; contact alone asks for {alone['contact']}, bending for "
            f"{alone['bending']}. {given}. "
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
    fitting_fails = sum(
        setting.contact_safety_fitting < setting.least_contact_safety for setting in grid
    )
    return Claim(
        claim=(
            f"Even with {PAPER_PLANETS} planets the flanks fail at the continuous torque of "
            f"{PAPER_CONTINUOUS_TORQUE:g} N*m."
        ),
        paper="surface failure",
        ours=(
            f"S_H {own.contact_safety_six:.2f} with {PAPER_PLANETS} planets, "
            f"{own.contact_safety_fitting:.2f} with the {fitting} that fit"
        ),
        holds=own.surface_failure,
        under=(
            f"{gears.settings.life_hours:g} h at full input speed. {given}. "
            + _examples([setting for setting in grid if setting.surface_failure], len(grid))
            + f" With the {fitting} planets that fit, the flanks fail in {fitting_fails} of them."
        ),
    )


def _pins_claim(cycloid: Sequence[CycloidLimit]) -> Claim:
    claim = "At peak torque the cycloid is limited by its output pins."
    paper = f"output pins, {PAPER_PIN_TORQUE:g} N*m"
    binding = binding_limit(cycloid, "peak")
    if binding is None:
        return Claim(claim, paper, "not computed", None, "No limits of a cycloid were handed in.")
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
            f"of this cycloid is reached; the least binds, at {binding.value:.4g} of "
            f"{binding.limit:.4g} {binding.unit} for {binding.torque:.4g} N*m.{own} The paper's "
            f"{PAPER_PIN_TORQUE:g} N*m is single shear of all five pins fully loaded at once."
        ),
    )
