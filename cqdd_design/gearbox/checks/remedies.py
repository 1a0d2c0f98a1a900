"""What would make a load check pass: other materials, thicker or more pins, less torque.

A remedy is named only where it holds for what it changes: a stiffer material bears a higher
pressure, a thicker pin needs a wider hole.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress

from cqdd_design.catalog.materials import Material, materials
from cqdd_design.catalog.screws import shoulder_screws
from cqdd_design.design.reducer import Reducer
from cqdd_design.design.requirements import EXTERNAL_LOADS, Requirements
from cqdd_design.errors import CqddError
from cqdd_design.gearbox.checks import allowables
from cqdd_design.gearbox.checks.allowables import Allowable
from cqdd_design.gearbox.checks.state import GearboxState
from cqdd_design.gearbox.loads import RigidMaxima
from cqdd_design.geometry.disc import ligaments
from cqdd_design.geometry.limits import rounded_down, rounded_up

_MEGA = 1e6
_MOST_THICKENING = 2.0
"""A thicker disc or pin is offered as a remedy up to this many times what it was."""
_AS_STIFF = 0.9
"""Of a part's modulus: what is softer is no harder part, though it would spread the contact."""
_SPARE = 1.02
"""Reserve of another material, since stiffer bodies share with fewer teeth and pins."""
PEAK_KEY = "requirements.peak_torque"
_MORE_PINS = 6
"""Beyond as many as are needed, up to which more are tried, in steps of two."""
_UNMOVED = 0.05e-3
"""A circle that moves by less need not be told, m."""

MaterialRule = Callable[[Material], Allowable]
Lower = Callable[[float], str]


def torque_words(value: float) -> str:
    """A torque as a remedy names it, rounded to the safe side."""
    return f"{rounded_down(value):g} N*m"


def lower_outside(asked: Requirements, share: float) -> str:
    """A share of the external loads that are asked for, each rounded to the safe side."""
    stated = [(key, getattr(asked, key), unit) for key, unit in EXTERNAL_LOADS.items()]
    told = [f"{key} to {rounded_down(share * one):g} {unit}" for key, one, unit in stated if one]
    return f"lower {' and '.join(told)}"


def lower_to(torque: float, which: str = "torque") -> str:
    """What to do where a line holds up to a torque (N m), by its name or key."""
    if torque <= 0.0:
        return f"no {which} is low enough"
    article = "" if which.startswith("requirements.") else "the "
    return f"lower {article}{which} to {torque_words(torque)}"


def lower_peak(torque: float, continuous: float, which: str = "torque") -> str:
    """The same of the peak torque (N m), below which the continuous one (N m) has to stay."""
    words = lower_to(torque, which)
    return f"{words} (with it the continuous torque)" if 0.0 < torque < continuous else words


def lower_shares(share: float | None) -> str:
    """The same of a duty, up to a share of whose torques a line holds; None where not known."""
    if share is None:
        return "lower the torques of the duty"
    if share <= 0.0:
        return "no torques of the duty are low enough"
    return f"lower the torques of the duty to {rounded_down(100.0 * share):g} % of what they are"


def lower_lasting(torque: float, requirements: Requirements) -> str:
    """The same of the continuous torque, by which closed forms judge a duty too."""
    which = "continuous torque"
    if requirements.load_cases:
        which += " (this screen's; `check` judges the duty)"
    return lower_to(torque, which)


def lower_screened(state: GearboxState, load: RigidMaxima, share: float) -> str:
    """What to do where closed forms let a part bear but a share of one of their two torques."""
    if share <= 0.0:
        return "choose a bearing with catalogue ratings"
    asked, torque = state.design.requirements, load.torque * share
    if load is state.rigid_peak:
        return lower_peak(torque, asked.continuous_torque)
    return lower_lasting(torque, asked)


def softer_contact(thickness: float, pressure: float, limit: float, lower: Lower) -> str:
    """Say what brings a Hertz pressure of the rigid law down to a limit: it grows with sqrt(T/b).

    Where parts yield a thicker disc is a stiffer one too, and shares with fewer teeth.

    Parameters
    ----------
    thickness : float
        b of a disc, m.
    lower : callable
        What to say of a share of the torque.
    """
    if min(limit, pressure) <= 0.0:
        return ""
    share = (pressure / limit) ** 2
    words = f"{lower(1.0 / share)}, or "
    if share <= _MOST_THICKENING:
        words = f"raise disc_thickness to {rounded_up(thickness * 1e3 * share):g} mm, or " + words
    return words


def harder_parts(
    parts: dict[str, Material], rule: MaterialRule, pressure: float, otherwise: str
) -> str:
    """Name, for every part too weak, the mildest material that allows the pressure it would bear.

    Parameters
    ----------
    parts : dict of str to Material
        The two in contact.
    rule : callable
        A material's limit.
    pressure : float
        Now, Pa; it changes with the root of the pair's E*.
    otherwise : str
        What to do where no materials are enough.
    """
    weak = [part for part, material in parts.items() if rule(material).value < pressure]
    offered = [
        [
            (rule(other).value, other.name, _compliance(other))
            for other in (materials().values() if part in weak else [material])
            if part not in weak or _harder(other, material, part)
        ]
        for part, material in parts.items()
    ]
    now = sum(_compliance(material) for material in parts.values())
    enough = [
        (one[0] + two[0], one, two)
        for one in offered[0]
        for two in offered[1]
        if min(one[0], two[0]) >= _SPARE * pressure * math.sqrt(now / (one[2] + two[2]))
    ]
    if not enough:
        most = rounded_up(pressure / _MEGA)
        return f"{otherwise}: no catalogue material allows {most:g} MPa"
    _, one, two = min(enough)
    words = [
        f"the {part} of '{name}' ({value / _MEGA:.0f} MPa)"
        for part, (value, name, _) in zip(parts, (one, two), strict=True)
        if part in weak
    ]
    borne = pressure * math.sqrt(now / (one[2] + two[2]))
    told = f", which lowers the pressure to {borne / _MEGA:.0f} MPa"
    return "make " + " and ".join(words) + (told if borne < 0.995 * pressure else "")


def _harder(other: Material, material: Material, part: str) -> bool:
    """Whether a part can be made of another material that is about as stiff."""
    stiff = other.youngs_modulus >= _AS_STIFF * material.youngs_modulus
    return stiff and _makes(other, part) and other.name != material.name


def _makes(material: Material, part: str) -> bool:
    """Whether a part is made of it: laminations and magnets make no disc, screws only pins."""
    return material.form == "stock" or (part == "pins" and material.form == "fastener")


def _compliance(material: Material) -> float:
    """(1 - nu^2)/E; 1/E* of a pair is the sum of its two, 1/Pa."""
    return (1.0 - material.poisson_ratio**2) / material.youngs_modulus


def thicker_ring_pin(reducer: Reducer, least: float) -> str:
    """To make pins under rollers at least as thick, m, and the rollers that go over them."""
    thick = rounded_up(least * 1e3)
    if reducer.ring.roller == "needle":
        return (
            f"take ring pins of at least {thick:g} mm that a needle cage runs on (`cqdd-design "
            "catalog bearings`), in rollers as much wider"
        )
    words = f"raise ring_pin_diameter to {thick:g} mm"
    outside = rounded_up(thick + 2e3 * allowables.SLEEVE_WALL)
    if reducer.ring.roller_diameter * 1e3 < outside:
        words += f" and ring.roller_diameter to {outside:g} mm"
    return words


def stronger_capacity(state: GearboxState, torque: float, needed: float) -> str:
    """Remedy for a capacity in shear, which grows with the square of the pin's diameter."""
    thicker = state.design.reducer.output_pins.diameter * math.sqrt(needed / torque)
    lower = lower_peak(torque, state.design.requirements.continuous_torque, "peak torque")
    return ", or ".join((*_thicker_pins(state, thicker), lower))


def better_held(reducer: Reducer) -> list[str]:
    """How to hold pins so that they bend less; nothing where they are held as well as can be.

    How much less is not known without the equilibrium of pins that are held so.
    """
    if reducer.output_pins.support != "both":
        return ["hold the pins at both ends (reducer.output_pins.support), which helps"]
    if reducer.carrier.joint == "hinged":
        return ["clamp them in the cap too (reducer.carrier.joint), which helps"]
    return []


def stronger_pins(
    state: GearboxState,
    value: float,
    limits: tuple[MaterialRule, Allowable],
    lower: str,
    power: int,
    *,
    uneven: float = 1.0,
) -> str:
    """Remedy for a pin stress that falls with d^power and with the number of pins.

    Parameters
    ----------
    value : float
        Pa.
    limits : tuple
        A pin material's limit, and that of this design.
    lower : str
        How far to lower the torque, in words.
    uneven : float
        How much less evenly than rigid ones the pins share.
    """
    rule, allowed = limits
    if allowed.value <= 0.0:
        return f"choose a pin material the catalogue knows strengths of: {allowed.basis}"
    pins = state.design.reducer.output_pins
    ratio = value / allowed.value
    if power == 1 and pins.sleeve_diameter > 0.0:
        wider = rounded_up(pins.sleeve_diameter * 1e3 * ratio)
        return f"raise output_pins.sleeve_diameter to {wider:g} mm, or {lower}"
    words = [*_thicker_pins(state, pins.diameter * ratio ** (1.0 / power))]
    if ratio > 1.0:
        least = pins.count * ratio * uneven * 4.0 / state.output_pins.peak_force_factor
        if count := _more_pins(state, least):
            words.append(f"use {count} pins of {pins.diameter * 1e3:g} mm")
    if power == 3:
        words += better_held(state.design.reducer)
    screws = [
        (rule(screw).value, screw.name)
        for screw in materials().values()
        if screw.form == "fastener" and rule(screw).value >= value
    ]
    # What bears on the hole is limited by the disc too.
    if screws and power > 1:
        words.append(f"take pins of '{min(screws)[1]}'")
    return ", or ".join((*words, lower))


def _more_pins(state: GearboxState, least: float) -> int | None:
    """So many pins at least whose holes leave the disc enough; None where a few more do not either.

    An even count, whose peak factor is exactly four. How near holes come to the profile hangs on
    where lobes and holes meet.
    """
    key, bore = "reducer.output_pins.count", state.cam_bearing.bearing.outer_diameter
    first = 2 * math.ceil(0.5 * least)
    for count in range(first, first + _MORE_PINS, 2):
        with suppress(CqddError):
            found = ligaments(state.design.replacing({key: count}), bore_diameter=bore)
            # What was too thin before is another line's.
            now = {one.kind: one.thickness for one in state.geometry.ligaments}
            if all(one.thickness >= min(allowables.LIGAMENT, now[one.kind]) for one in found):
                return count
    return None


def _thicker_pins(state: GearboxState, least: float) -> tuple[str, ...]:
    """The thinnest catalogue shoulder of at least a diameter (m), and what its holes need."""
    pins, geometry = state.design.reducer.output_pins, state.geometry
    if least > _MOST_THICKENING * pins.diameter:
        return ()
    sizes = sorted(screw.shoulder_diameter for screw in shoulder_screws().values())
    size = next((size for size in sizes if size >= least), least)
    words = f"use pins of {size * 1e3:g} mm (at least {rounded_up(least * 1e3):g} mm)"
    grown = 0.5 * (size - pins.diameter)
    # What is left beside the wider holes on the same circle, and how far that should move.
    inside = geometry.ligament("hole to bore").thickness - grown
    outside = geometry.ligament("hole to profile").thickness - grown
    between = geometry.ligament("hole to hole").thickness - 2.0 * grown
    if state.design.reducer.carrier.column_count:
        between = geometry.ligament("column to hole").thickness - grown
    if inside + outside < 2.0 * allowables.LIGAMENT or between < allowables.LIGAMENT:
        return (f"{words} on a disc with room for their holes",)
    out = max(allowables.LIGAMENT - inside, 0.0) - max(allowables.LIGAMENT - outside, 0.0)
    if abs(out) > _UNMOVED:
        words += f" with output_pins.circle_radius near {1e3 * (pins.circle_radius + out):.1f} mm"
    return (words,)
