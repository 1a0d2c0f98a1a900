"""What one search to the verdict is for, and what it learns on the way."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cqdd_design.catalog.bearings import find_bearing
from cqdd_design.catalog.materials import find_material
from cqdd_design.catalog.motors import Motor, find_motor
from cqdd_design.design import Requirements
from cqdd_design.errors import InfeasibleError
from cqdd_design.gearbox.checks import allowables
from cqdd_design.machine import Machine
from cqdd_design.results import Check
from cqdd_design.sizing.exact import exact_checks
from cqdd_design.sizing.frame import Fit, Frame, Goal, search_frame
from cqdd_design.sizing.spaces import FITS, Found, Space
from cqdd_design.sizing.stage_tables import StageTables

Progress = Callable[[str], None]

CAM = "BEARING-STATIC"
"""Check of the load on a cam bearing at the peak torque."""
_LIKELY, _HOPED = 0.95, 0.86
"""Of a reserve that part errors ask for with other cam bearings: they differ by so much."""
_MANY = 3
"""Cam bearings that have been looked at from which on another is not hoped to need less: they
differ by little, and each that is hoped for has to be looked at."""
_USUAL = {
    "CONTACT-RING-CONTINUOUS": 2.0,
    "CONTACT-RING-PEAK": 1.15,
    "BEARING-LIFE": 1.8,
    CAM: 1.3,
}
"""Reserve for part errors, by check, before toleranced gearboxes have been looked at: a little less
than searches at ratios from 5 to 30 came to ask for."""
_AT_PEAK = (CAM, "CONTACT-RING-PEAK")
"""Lines of which a stronger gearbox keeps more reserve."""
_STURDIEST = 3.0
"""Reserve at the peak beyond which no more is tried."""
_MOST_RISEN = 2
"""How often a torque is raised that was lowered before: it could go up and down for ever."""
_A_LITTLE, _MOST_RELENTED = 1.02, 3
"""Over the reserve that a design had whose part errors were too much for it, what is asked of
others where none has what it would have needed; and how often."""
_SOLVED = 15
"""Designs that are kept with their equilibria, but for the last."""


class Answer(NamedTuple):
    """What was found with a cam bearing in a space, if anything, for what was asked then.

    Attributes
    ----------
    fixed : tuple
        `Hunt.fixed`.
    extra : mapping of str to float
        `Hunt.extra_for` the bearing.
    found : Found or None
    fine : bool
        Whether rings of nearly the same size were tried too.
    least : float
        Objective below which nothing was found; infinite where nothing was at all.
    """

    fixed: tuple[object, ...]
    extra: Mapping[str, float]
    found: Found | None
    fine: bool
    least: float

    @property
    def gave_up(self) -> bool:
        """Whether nothing was looked for beyond an objective, because another kind is better."""
        return self.found is None and math.isfinite(self.least)


@dataclass
class Hunt:
    """One search to the verdict: what is learnt on the way.

    Attributes
    ----------
    requirements : Requirements
        With the torques that are tried where none were stated.
    usual : mapping of str to float
        Reserve for part errors while no toleranced gearboxes have been looked at, by check.
    extra_of : dict of str to dict
        Reserve for part errors of designs with one cam bearing, by its designation and by check.
    had : tuple
        Cam bearing and reserves, by check, of the last design whose part errors asked for more.
    relented : int
        How often less was asked for because of it.
    trusting : bool
        Whether designs with cam bearings that have not been looked at need much less, and nothing
        where none has been.
    left : bool
        Whether a design was left for what it is foreseen to miss.
    any_will_do : bool
        Whether the first design whose verdict is yes is enough, the best or not.
    hoped : float
        Objective of the first design that the equilibrium bore out, before part errors and heat
        were asked.
    lighter_than : float
        Mass from which on a design is not what is searched for, of the parts that are counted, kg.
    best_alone : bool
        Whether nothing but the best is searched for: any design, and the strongest, were in vain.
    in_vain : list of Requirements
        For which any design was searched for, and the strongest, and none found.
    short_of : tuple of Check
        Lines of the shaft and its bearings that the best of all designs was far from meeting, where
        that was why there is none.
    settling : bool
        Whether cam bearings that have been looked at are tried alone, if with any of them there is
        a design.
    borne : tuple of float, optional
        Shares of the peak and of the continuous torque that enough of the gearboxes that were
        looked at last bear, where these were too few.
    nearly : dict of str to float
        Share of both torques that enough of the gearboxes bore of the last design with each cam
        bearing that part errors left short.
    lowered : bool
        Whether the motor did not hold a continuous torque that was tried.
    lowered_by : str
        Cam bearing of the design with which it did not; empty where strength was short.
    risen : int
        How often the torque was raised again with another cam bearing.
    shaft_bears : float
        Share of the torques at which shafts were no longer too weak by far, where all were.
    eased : bool
        Whether torques were lowered to what part errors leave of a design.
    strongest : str
        Cam bearing that is tried first: of the design that bears most, where torques were lowered
        to what it bears, or of the last that bore what is asked for in more space.
    heavy : float
        Mass of the actuator that was too much last, kg.
    fit : Fit
        The closest that heat and part errors leave.
    least_bore : float
        Of the cam bearings that are tried, m: smaller ones leave the shaft's ends no bearing.
    least_ring : float
        Outside diameter of the smallest ring that is tried, m: smaller ones turn too far within
        their clearances.
    most_pin_circle : float
        Radius of the largest pin circle that is tried, m: round wider ones no carrier bearing of
        the catalogue fits.
    most_throw : float
        Largest eccentricity that is tried, m: larger ones leave the shaft too thin.
    thicker : tuple of float, optional
        Instead of a wider cam bearing: the bore of one, m, and an eccentricity, m, at which the
        shaft in it is thick enough for a bond that gave way.
    pins : tuple of bool
        Whether output pins that are tried are on needles.
    too_warm : set of str
        Cam bearings that are not tried, as the best with them loses too much.
    loose : set of str
        Cam bearings in which the shaft was too thin for its bond with the bell: since then none as
        narrow is tried, with which a cooler gearbox might have done.
    tried : set of Goal
        Goals that were taken to meet something that is asked for, and those left for them.
    sturdier : float
        Reserve at the peak that something takes which is asked for: stiffness, or a stop.
    held_up_to : float
        Input speed up to which a motor that is far from it holds the continuous torque, rpm; 0
        where it does not turn with it.
    yielding : tuple of array, optional
        Outputs of gearboxes whose discs and ring yield over those of rigid ones, at the continuous
        and at the peak torque, of the last design that was looked at with them.
    yielding_at : tuple of float
        Thickness of that design's discs, m, and its torques, N m.
    rigid : tuple, optional
        The machine that was looked at last, and outputs of its gearboxes while nothing yields.
    calm : tuple, optional
        The design, and whether its torque might rise, at which looks asked for nothing last.
    solved : list
        The last designs that were held against the equilibrium, for searches that come back.
    known : dict of Space to Found
        The best with each cam bearing as it was found last, in a ring of any size and for the
        closest fit: where to begin when asked again.
    answered : dict of Space to Answer
    fine : bool
        Whether rings of nearly the same size are tried too.
    too_weak : dict
        Peak torque, N m, beyond which shafts are hopeless, by disc count and cam bearing's bore.
    ends_bear : dict
        Peak torque, N m, that bearings at the shaft's ends bear, where that is far too little, by
        disc count, kind of cam bearing and its bore.
    """

    requirements: Requirements
    motor: Motor | None
    ambient: float | None
    say: Progress
    tables: StageTables
    goal: Goal
    usual: Mapping[str, float] = field(default_factory=lambda: _USUAL)
    extra_of: dict[str, dict[str, float]] = field(default_factory=dict)
    had: tuple[str, dict[str, float]] = ("", {})
    relented: int = 0
    trusting: bool = False
    left: bool = False
    any_will_do: bool = False
    hoped: float = 0.0
    lighter_than: float = math.inf
    best_alone: bool = False
    in_vain: list[Requirements] = field(default_factory=list)
    short_of: tuple[Check, ...] = ()
    settling: bool = False
    borne: tuple[float, float] | None = None
    nearly: dict[str, float] = field(default_factory=dict)
    lowered: bool = False
    lowered_by: str = ""
    risen: int = 0
    shaft_bears: float = 1.0
    eased: bool = False
    strongest: str = ""
    heavy: float = math.inf
    fit: Fit = FITS[0]
    least_bore: float = 0.0
    least_ring: float = 0.0
    most_pin_circle: float = math.inf
    most_throw: float = math.inf
    thicker: tuple[float, float] | None = None
    pins: tuple[bool, ...] = (False,)
    too_warm: set[str] = field(default_factory=set)
    loose: set[str] = field(default_factory=set)
    tried: set[Goal] = field(default_factory=set)
    sturdier: float = 1.0
    held_up_to: float = 0.0
    yielding: tuple[NDArray[np.float64], ...] | None = None
    yielding_at: tuple[float, ...] = ()
    rigid: tuple[Machine, tuple[NDArray[np.float64], ...]] | None = None
    calm: tuple[object, bool] | None = None
    solved: list[tuple[Machine, tuple[Check, ...]]] = field(default_factory=list)
    known: dict[Space, Found] = field(default_factory=dict)
    answered: dict[Space, Answer] = field(default_factory=dict)
    fine: bool = False
    too_weak: dict[tuple[int, float], float] = field(default_factory=dict)
    ends_bear: dict[tuple[int, str, float], float] = field(default_factory=dict)

    def held_against(self, machine: Machine) -> tuple[Machine, tuple[Check, ...]]:
        """The machine of its design that is known, and its load lines by the equilibrium.

        Raises
        ------
        ContactError, DesignError
            When it has none.
        """
        for one in self.solved:
            if one[0].design == machine.design:
                return one
        found = machine, exact_checks(machine)
        self.solved[_SOLVED:] = []
        self.solved.insert(0, found)
        return found

    @property
    def motor_row(self) -> Motor:
        """The motor that is sized for."""
        return self.motor or find_motor(self.requirements.motor)

    @property
    def fixed(self) -> tuple[object, ...]:
        """What is asked of every design with a cam bearing that is tried, but for part errors."""
        limits = self.most_pin_circle, self.least_ring, self.most_throw
        return self.requirements, self.goal, *limits

    def may_rise(self, cam: str) -> bool:
        """Whether a continuous torque is raised to what the motor holds in a design.

        Another cam bearing may rub less than the one with which it was too much.
        """
        other = self.lowered_by not in {"", cam} and self.risen < _MOST_RISEN
        return not self.lowered or other

    @property
    def may_be_sturdier(self) -> bool:
        """Whether still more reserve at the peak is tried for what is asked for."""
        return self.sturdier < _STURDIEST

    @property
    def has_extra(self) -> bool:
        """Whether part errors ask for any reserve."""
        return bool(self.extra_of)

    def extra_for(self, cam: str) -> Mapping[str, float]:
        """Reserve for part errors of designs with a cam bearing, by check.

        With one that has not been looked at, somewhat less than what the known one asks for whose
        rating is closest, and where none is named, than what every one does; where the hunt is
        trusting, still less. Where none is known, what is usual; where many are, as much as any.
        Where what is asked for takes a stronger gearbox than loads do, so much more at the peak.
        """
        own = self._for_errors(cam)
        if self.sturdier == 1.0:
            return own
        return {**own, **{one: self.sturdier * own.get(one, 1.0) for one in _AT_PEAK}}

    def _for_errors(self, cam: str) -> Mapping[str, float]:
        """The part of `extra_for` that part errors ask for."""
        own = self.extra_of.get(cam)
        if own is None and not self.extra_of:
            own = {} if self.trusting else dict(self.usual)
        elif own is None:
            part = _HOPED if self.trusting else _LIKELY
            many = len(self.extra_of) >= _MANY and not self.trusting
            known = [self._closest(cam)] if cam and not many else list(self.extra_of)
            every = [self.extra_of[one] for one in known]
            shared = set.intersection(*map(set, every))
            if cam and many:
                return {one: max(each[one] for each in every) for one in shared}
            own = {one: max(part * min(each[one] for each in every), 1.0) for one in shared}
        return own

    def _closest(self, cam: str) -> str:
        """Of the cam bearings that have been looked at, the one that is rated most alike."""
        rating = find_bearing(cam).static_rating or 1.0

        def ratio(other: str) -> float:
            return abs(math.log((find_bearing(other).static_rating or 1.0) / rating))

        return min(self.extra_of, key=ratio)

    def ask_extra(
        self, cam: str, asked: Mapping[str, float], had: Mapping[str, float] = MappingProxyType({})
    ) -> None:
        """Have designs with a cam bearing keep a reserve for part errors, by check.

        `had` is the reserve of the one whose part errors ask for that.
        """
        own = self.extra_of.get(cam, {})
        self.had = cam, dict(had)
        self.extra_of[cam] = own | {
            one: max(own.get(one, 1.0), more) for one, more in asked.items()
        }

    def relent(self) -> bool:
        """Whether less reserve is asked for: a little more than that with which a design failed.

        What part errors ask of one design another may do without. No more often than a few times.
        """
        cam, had = self.had
        asked = self.extra_of.get(cam, {})
        less = {one: min(more, _A_LITTLE * had.get(one, math.inf)) for one, more in asked.items()}
        if self.relented == _MOST_RELENTED or less == asked:
            return False
        self.extra_of[cam], self.relented = less, self.relented + 1
        return True

    @property
    def may_roll(self) -> bool:
        """Whether needles can run on the output pins that are asked for."""
        asked = self.requirements
        return "pin_material" not in asked.model_fields_set or allowables.is_hardened(
            find_material(asked.pin_material)
        )

    def frame(self, space: Space, needs: Mapping[str, float]) -> Frame:
        """The frame of a space; needs of part errors count on top.

        Raises
        ------
        InfeasibleError
            When nothing of the catalogues goes into the space.
        """
        asked = space.of(self.requirements)
        frame = search_frame(
            asked, self.motor, self.ambient, space.fit, self.goal, needles=space.needles
        )
        extra = self.extra_for(space.cam)
        every = {*needs, *extra}
        both = {one: needs.get(one, 1.0) * extra.get(one, 1.0) for one in every}
        both[CAM] = both.get(CAM, 1.0) * space.quieter
        bearings = tuple(
            one
            for one in frame.bearings
            if one.bore_diameter >= max(self.least_bore, asked.bore or 0.0)
            and space.cam in {"", one.designation}
            and one.designation not in self.too_warm
        )
        if not bearings:
            raise InfeasibleError(_no_bearing(asked))
        return replace(
            frame,
            needs=both,
            bearings=bearings,
            smaller_rings=space.free,
            ring_limit=space.ring_limit,
            ring_least=self.least_ring,
            pin_circle_limit=self.most_pin_circle,
            throw_limit=min(space.throw, self.most_throw),
        )


def _no_bearing(asked: Requirements) -> str:
    """Why no cam bearing of the catalogue is left to try."""
    told = "no cam bearing that is tried goes into this space"
    if asked.bore is None:
        return f"{told}."
    return (
        f"{told}: its own bore has to be wider than requirements.bore {1e3 * asked.bore:g} mm; ask "
        "for a smaller bore, or raise outer_diameter."
    )
