"""When nothing fits: which limits bind, the most torque there is, and the ring that would do.

Nothing here is a rule of thumb. The most torque is that of a real design, found by the same
search and confirmed by the same analysis; so is the ring.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType

from cqdd_design.catalog.motors import Motor
from cqdd_design.errors import InfeasibleError
from cqdd_design.gearbox.checks.guide import CHECK_GUIDE
from cqdd_design.geometry.limits import rounded_down
from cqdd_design.geometry.scale import largest_ring
from cqdd_design.results import Check
from cqdd_design.sizing.choose import strongest
from cqdd_design.sizing.finish import LOAD_CHECKS, torque_reserve
from cqdd_design.sizing.frame import Fit, search_frame
from cqdd_design.sizing.points import Points
from cqdd_design.sizing.result import SizedDesign
from cqdd_design.sizing.search import Search

CLOSE = 1.03
"""Load checks within this factor of the least reserve bind together with it."""
_LARGEST_RING_MM = 1000
"""Outside diameter at which the search for a larger ring stops (the model's own bound)."""
_LONGEST_PACK_MM = 500
"""Length at which the search for a longer pack stops (the model's own bound)."""
_STRIDE = 1.2
"""Of rings and packs that are tried, each over the one before."""
_SHARES = (0.9995, 0.997, 0.99, 0.98, 0.95, 0.9)
_ROUNDING = 1e-6
_HOPELESS = 0.8
"""Best reserve of a screen that no refinement brings to one."""
_FAR = 0.02
"""Share of a torque below which what is carried there says little of what can be."""
_NO_TORQUE = 1e-4
"""Share of the torque asked for below which a space counts as too small for any gearbox."""

WORDS = {
    "BEARING-STATIC": "the cam bearing",
    "BEARING-LIFE": "the cam bearing",
    "CONTACT-RING-PEAK": "contact pressure at the ring",
    "CONTACT-RING-CONTINUOUS": "pitting at the ring",
    "CONTACT-PIN-PEAK": "contact pressure of the output pins",
    "CONTACT-PIN-CONTINUOUS": "pitting at the output pins",
    "PIN-PAPER": "shear of the output pins",
    "PIN-SHARED": "shear of the output pins",
    "PIN-SHEAR-PEAK": "shear of the output pins",
    "PIN-BENDING-PEAK": "bending of the output pins",
    "PIN-BENDING-CONTINUOUS": "bending fatigue of the output pins",
    "PIN-BEARING-PEAK": "bearing pressure of the output pins",
}
"""What binds, in words, for every load check."""


class SizingInfeasibleError(InfeasibleError):
    """No design meets the requirements. Exit code 3.

    Attributes
    ----------
    binding : tuple of str
        Identifiers of the checks that bind, the tightest first.
    most_torque : float or None
        Peak torque that a design in the same space does carry, with the continuous torque lowered
        in proportion or to `most_lasting_torque`, N m; None where no gearbox of any torque fits.
    most_lasting_torque : float or None
        Continuous torque that goes with it, N m.
    outer_diameter_needed : float or None
        Smallest ring that was found to carry the torque asked for in the same length, m; None where
        none does that goes into the motor's bore.
    length_needed : float or None
        Shortest pack, likewise, that carries it in the same ring, m.
    ratio_needed : int or None
        Least ratio at which the motor reaches the torque in the same space; looked for only where
        the motor falls short through any gearbox.
    most_speed : float or None
        Input speed up to which the motor holds the continuous torque for ever in the same space,
        rpm; looked for only where that alone is short.
    cool_ratio : int
        About the least ratio at which the winding's heat would be little enough, where heat is
        short; 0 where none is known.
    figures : mapping of str to str
        Requirements of mass, stiffness and the like that fit in place of those that are short, as
        unit strings; looked for only where they alone are.
    short : tuple of Check
        Lines of the design that came nearest, where one was judged.
    estimate : str
        The part of the message on what is carried, no bound: a search may find more.
    """

    def __init__(
        self,
        message: str,
        *,
        binding: tuple[str, ...],
        most_torque: float | None,
        most_lasting_torque: float | None = None,
        outer_diameter_needed: float | None = None,
        length_needed: float | None = None,
        ratio_needed: int | None = None,
        most_speed: float | None = None,
        cool_ratio: int = 0,
        figures: Mapping[str, str] = MappingProxyType({}),
        short: tuple[Check, ...] = (),
        estimate: str = "",
    ) -> None:
        super().__init__(message)
        self.binding = binding
        self.most_torque = most_torque
        self.most_lasting_torque = most_lasting_torque
        self.outer_diameter_needed = outer_diameter_needed
        self.length_needed = length_needed
        self.ratio_needed = ratio_needed
        self.most_speed = most_speed
        self.cool_ratio = cool_ratio
        self.figures = figures
        self.short = short
        self.estimate = estimate

    def to_dict(self) -> dict[str, object]:
        """The JSON form."""
        return {
            "binding": list(self.binding),
            "most_peak_torque_Nm": self.most_torque,
            "most_continuous_torque_Nm": self.most_lasting_torque,
            "outer_diameter_needed_mm": _in_mm(self.outer_diameter_needed),
            "length_needed_mm": _in_mm(self.length_needed),
            "ratio_needed": self.ratio_needed,
            **({} if self.most_speed is None else {"most_continuous_speed_rpm": self.most_speed}),
            **({"requirements_that_fit": dict(self.figures)} if self.figures else {}),
        }


def _in_mm(length: float | None) -> float | None:
    return None if length is None else float(f"{1e3 * length:g}")


def no_design(search: Search, *, nearest: bool = True) -> SizingInfeasibleError:
    """Explain a search that found nothing, with the nearest requirements that would fit.

    Parameters
    ----------
    nearest : bool
        Whether a larger ring and a longer pack are looked for that would do by closed forms.
    """
    wanted = search.frame.requirements
    best = _most_torque(search)
    bore = search.frame.motor.bore_diameter
    largest = _LARGEST_RING_MM if bore is None else math.floor(largest_ring(bore) * 1e3 + _ROUNDING)
    ring = _smallest(search, "outer_diameter", largest) if nearest else None
    length = _smallest(search, "length", _LONGEST_PACK_MM) if nearest else None
    space = f"{a_length(wanted.outer_diameter)} ring"
    asked = f"{wanted.peak_torque:g} N*m at ratio {wanted.ratio}"
    fixes = []
    binding: tuple[str, ...]
    if best is None:
        binding = (_last_straw(search),)
        guide = CHECK_GUIDE[binding[0]]
        text = (
            f"no gearbox of ratio {wanted.ratio} fits in {space} and {wanted.length * 1e3:g} mm "
            f"of length at any torque; '{guide.title}' ({guide.formula}) binds"
        )
    else:
        binding = _binding(best)
        words = list(dict.fromkeys(WORDS[one] for one in binding))
        most = best.design.requirements
        text = (
            f"{asked} does not fit: in {space} the most is {most.peak_torque:g} N*m; "
            f"{listed(words)} {'binds' if len(words) == 1 else 'bind'}"
        )
        fixes.append(
            f"lower peak_torque to {most.peak_torque:g} N*m and continuous_torque to "
            f"{rounded_down(most.continuous_torque):g} N*m"
        )
    for key, need, what in (("outer_diameter", ring, "ring"), ("length", length, "pack of discs")):
        if need is not None:
            text += f"; {asked} needs {a_length(need)} {what}"
            fixes.append(f"raise {key} to {need * 1e3:g} mm")
    if nearest and ring is None and bore is not None and largest < _LARGEST_RING_MM:
        text += (
            f"; {search.frame.motor.name} has a bore of {bore * 1e3:g} mm, for rings up to "
            f"{largest} mm"
        )
    remedy = ", or ".join(fixes) or "change the ratio, the materials or disc_count"
    if wanted.bore is not None:
        remedy += ", or ask for a smaller bore"
    return SizingInfeasibleError(
        f"{text}. {remedy[0].upper()}{remedy[1:]}.",
        binding=binding,
        most_torque=None if best is None else best.design.requirements.peak_torque,
        most_lasting_torque=None
        if best is None
        else rounded_down(best.design.requirements.continuous_torque),
        outer_diameter_needed=ring,
        length_needed=length,
    )


def a_length(length: float) -> str:
    """A length in mm with the article it is read with: a 40 mm, an 80 mm."""
    text = f"{length * 1e3:g}"
    vowel = text.startswith("8") or text.split(".")[0] in ("11", "18")
    return f"{'an' if vowel else 'a'} {text} mm"


def listed(words: list[str]) -> str:
    """Words joined as in a sentence."""
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def refuse_motor(sized: SizedDesign, motor: Motor) -> None:
    """Raise when the motor that was asked for falls short; no size of the gearbox helps."""
    failed = [check for check in sized.checks if check.status == "fail"]
    if not failed:
        return
    requirements = sized.design.requirements
    torques = [check for check in failed if check.id in ("MOTOR-PEAK", "MOTOR-CONTINUOUS")]
    most = None
    if torques:
        share = min(check.margin for check in torques)
        most = rounded_down(requirements.peak_torque * share)
    reasons = "; ".join(
        f"{check.title.lower()} is {check.value:.4g} {check.unit} against {check.limit:.4g} "
        f"{check.unit}: {check.remedy}"
        for check in failed
    )
    raise SizingInfeasibleError(
        f"motor '{motor.name}' does not meet the requirements: {reasons}.",
        binding=tuple(check.id for check in failed),
        most_torque=most,
    )


def _binding(sized: SizedDesign) -> tuple[str, ...]:
    """Load checks next to their limit, the tightest first."""
    reserve = {
        check.id: torque_reserve(check, sized.design)
        for check in sized.checks
        if check.id in LOAD_CHECKS
    }
    least = min(reserve.values())
    close = [check for check, value in reserve.items() if value <= CLOSE * least]
    return tuple(sorted(close, key=lambda check: reserve[check]))


def _last_straw(search: Search) -> str:
    """The check after which no candidate was left."""
    left = search.found.screened
    for check, count in search.found.rejected.items():
        left -= count
        if left == 0:
            return check
    return next(reversed(search.found.rejected))


def _most_torque(search: Search) -> SizedDesign | None:
    """A confirmed design with the most torque in the same space, rounded down."""
    asked = torque = search.frame.requirements.peak_torque
    tables = search.evaluator.tables
    carried, best = 0.0, None
    while torque > _NO_TORQUE * asked:
        at = search if torque == asked else Search.of(search.frame.at_torque(torque), tables)
        most = at.most_reserve()
        reached = 0.0 if most is None else torque * float(most.reserve[0])
        # A reserve is the same design's at every torque, but the screen drops ring stages that fail
        # at the torque asked for; nearer to what is carried more of them come back.
        if reached > 1.001 * carried:
            carried, best = reached, most
        elif best is not None and carried > _FAR * torque:
            return _confirmed(search, carried, best)
        torque = 0.98 * carried if carried > _FAR * torque else 0.25 * torque
    return None


def _confirmed(search: Search, torque: float, best: Points) -> SizedDesign | None:
    """The design nearest below a torque that passes the analysis, from a point that carries it."""
    for share in _SHARES:
        rounded = rounded_down(share * torque, 3)
        at = Search.of(search.frame.at_torque(rounded), search.evaluator.tables)
        found = at.lightest(best)
        if found is not None:
            return found[0]
    return None


def _smallest(search: Search, key: str, limit: int) -> float | None:
    """Smallest whole-millimetre value of a requirement that carries the torque asked for, m.

    What is allowed more is never worse, so steps upward, then halves, find it.

    Parameters
    ----------
    key : {"outer_diameter", "length"}
    limit : int
        Where to give up, mm.
    """
    present: int = math.floor(getattr(search.frame.requirements, key) * 1e3 + _ROUNDING)
    low = high = present
    while not _fits(search, key, high):
        if high >= limit:
            return None
        low, high = high, min(math.ceil(_STRIDE * high) + 1, limit)
    while high - low > 1:
        middle = (low + high) // 2
        if _fits(search, key, middle):
            high = middle
        else:
            low = middle
    return high * 1e-3


def _at(search: Search, key: str, millimetres: int) -> Search | None:
    """The same search with another ring or length; None where no part of the catalogue fits."""
    frame = search.frame
    changed = frame.requirements.unchecked_copy({key: millimetres * 1e-3})
    fit = Fit(frame.equidistant, min(one.hole_clearance for one in frame.pin_sizes))
    try:
        other = search_frame(changed, frame.motor, frame.ambient, fit, frame.goal)
    except InfeasibleError:
        return None
    return Search.of(replace(other, needs=frame.needs), search.evaluator.tables)


def _fits(search: Search, key: str, millimetres: int) -> bool:
    at = _at(search, key, millimetres)
    if at is None or strongest(at.space, at.found, 1).merit.max(initial=0.0) < _HOPELESS:
        return False
    most = at.most_reserve()
    return most is not None and most.reserve[0] >= 1.0 and at.lightest(most) is not None
