"""What a search by closed forms does not vary, and the designs that are found in it."""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from cqdd_design.catalog.materials import Material, find_material
from cqdd_design.design import Requirements
from cqdd_design.gearbox.checks import allowables
from cqdd_design.results import Check
from cqdd_design.sizing.frame import USUAL_FIT, Fit
from cqdd_design.sizing.points import Points
from cqdd_design.sizing.result import SizedDesign
from cqdd_design.sizing.search import Search

FITS = (
    USUAL_FIT,
    Fit(9e-6, 28e-6),
    Fit(12e-6, 40e-6),
    Fit(16e-6, 56e-6),
    Fit(22e-6, 80e-6),
    Fit(30e-6, 110e-6),
)
"""Clearances that are tried, the closest first."""
MATERIALS = ("AISI 4140 Q&T 540C", "AISI 52100 / 100Cr6 hardened")
"""Of discs and ring where none is asked for: the paper's, and a through-hardened bearing steel."""
NEEDLE_PINS = "AISI 52100 / 100Cr6 hardened"
"""Of output pins that needles run on, where none is asked for."""
DISC_COUNTS = (2, 3)
"""Likewise of discs: those that balance."""


def closer(fit: Fit) -> Fit:
    """The next closer fit of those that are tried; the closest stays."""
    return FITS[max(FITS.index(fit) - 1, 0)]


class Space(NamedTuple):
    """What a search by closed forms does not vary; any cam bearing where none is named.

    All rings have the largest diameter within `ring_limit`, m; where `free`, they may be smaller.
    `quieter` is by how much the load on a cam bearing has to be less than it bears, and `throw` the
    largest eccentricity, m, for the shaft and the bearings at its ends.
    """

    disc_count: int
    disc_material: str
    ring_material: str
    fit: Fit
    needles: bool = False
    ring_limit: float = math.inf
    cam: str = ""
    free: bool = False
    quieter: float = 1.0
    throw: float = math.inf

    @property
    def anywhere(self) -> Space:
        """The same discs, materials and pins with any cam bearing in a ring of any size."""
        return self.kind._replace(cam="")

    @property
    def kind(self) -> Space:
        """The same discs, materials, pins and cam bearing in a ring of any size."""
        return self._replace(ring_limit=math.inf, free=False, quieter=1.0, throw=math.inf)

    def of(self, requirements: Requirements) -> Requirements:
        """The requirements with these discs and materials, which are tried and not asked for."""
        tried = requirements.unchecked_copy(
            {
                "disc_count": self.disc_count,
                "disc_material": self.disc_material,
                "ring_material": self.ring_material,
                "pin_material": self.pin_material(requirements),
            }
        )
        tried.model_fields_set.intersection_update(requirements.model_fields_set)
        return tried

    def pin_material(self, requirements: Requirements) -> str:
        """Of the output pins: under needles a hardened one, where none is stated."""
        if self.needles and "pin_material" not in requirements.model_fields_set:
            return NEEDLE_PINS
        return requirements.pin_material


@dataclass(frozen=True)
class Found:
    """A design of a space that the contact equilibrium bears out.

    Attributes
    ----------
    search : Search
    needs : mapping of str to float
        What closed forms had to show for it.
    sized : SizedDesign
    point : Points
        On the grid.
    rated : bool
        Whether the carrier's bearing has ratings: one that is made to order has none, and what it
        carries would stay unknown.
    weak : tuple of Check
        Lines of the shaft and of the bearings at its ends that it does not meet, if they were
        asked.
    """

    space: Space
    search: Search
    needs: Mapping[str, float]
    sized: SizedDesign
    point: Points
    rated: bool = True
    weak: tuple[Check, ...] = ()

    @property
    def worth(self) -> tuple[bool, float]:
        """What is better is less."""
        return not self.rated or bool(self.weak), self.sized.objective.score

    @property
    def cam(self) -> str:
        """Designation of its cam bearing."""
        return self.sized.design.reducer.cam_bearing.designation

    @property
    def ring(self) -> float:
        """Outside diameter of its ring, m."""
        return self.sized.design.reducer.ring.outer_diameter


def spaces(
    requirements: Requirements, fit: Fit, pins: tuple[bool, ...] = (False,)
) -> Iterator[Space]:
    """Materials and disc counts that are tried: those that are stated, or all.

    And output pins bare and on needles, as `pins` says. Of the materials, those alone than which no
    other is both stronger and lighter: nothing is the better for them by any goal.
    """
    stated = requirements.model_fields_set
    counts = (requirements.disc_count,) if "disc_count" in stated else DISC_COUNTS
    every = itertools.product(counts, pins, _undominated(MATERIALS))
    yield from dict.fromkeys(
        Space(
            count,
            requirements.disc_material if "disc_material" in stated else material,
            requirements.ring_material if "ring_material" in stated else material,
            fit,
            needles,
        )
        for count, needles, material in every
    )


@functools.cache
def _undominated(names: tuple[str, ...]) -> tuple[str, ...]:
    """Materials than which no other of them is both stronger and lighter."""
    tried = {name: _merits(find_material(name)) for name in names}
    return tuple(
        name
        for name, own in tried.items()
        if not any(
            other != own and all(theirs >= mine for theirs, mine in zip(other, own, strict=True))
            for other in tried.values()
        )
    )


def _merits(material: Material) -> tuple[float, ...]:
    """What of a material decides here: more is better."""
    return (
        material.yield_strength or 0.0,
        material.ultimate_strength or 0.0,
        allowables.contact_limit_static(material).value,
        allowables.contact_limit_fatigue(material).value,
        -material.density,
    )
