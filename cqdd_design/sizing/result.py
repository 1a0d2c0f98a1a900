"""What sizing returns: the design, its alternatives, and how they were found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any

from cqdd_design.design import Design
from cqdd_design.errors import UsageError
from cqdd_design.machine import Machine, resolve
from cqdd_design.results import Check
from cqdd_design.sizing.frame import Goal
from cqdd_design.sizing.masses import SCOPE


@dataclass(frozen=True)
class Objective:
    """What a sized design was judged by.

    Attributes
    ----------
    score : float
        What the search makes small, by its `goal`.
    goal : Goal
        See :mod:`cqdd_design.sizing.goals`.
    mass : float
        Of discs, ring, output pins, cam bearings and eccentrics, kg.
    gearbox_inertia : float
        Of the same parts at the crank, kg m^2.
    reflected_inertia : float or None
        With the motor's rotor; None where its inertia is not known.
    torque_reserve : float
        Factor by which both required torques could grow until a check is on its limit.
    binding : str
        The load check with the least torque reserve.
    least_margin : float
        Margin of that check, in its own terms (a pressure grows with the root of the torque).
    """

    score: float
    goal: Goal
    mass: float
    gearbox_inertia: float
    reflected_inertia: float | None
    torque_reserve: float
    binding: str
    least_margin: float

    @property
    def scope(self) -> str:
        """What masses and inertias count."""
        known = self.reflected_inertia is not None
        rotor = "; inertia with the motor's rotor" if known else "; inertia unknown, as the rotor's"
        return f"{SCOPE}{rotor}"

    def to_dict(self) -> dict[str, object]:
        """The JSON form."""
        return {
            "score": self.score,
            "mass_kg": self.mass,
            "gearbox_inertia_kgm2": self.gearbox_inertia,
            "reflected_inertia_kgm2": self.reflected_inertia,
            "scope": self.scope,
            "torque_reserve": self.torque_reserve,
            "least_margin": self.least_margin,
            "binding": self.binding,
            "goal": self.goal,
        }


@dataclass(frozen=True)
class SizedDesign:
    """A design that meets the requirements.

    Attributes
    ----------
    checks : tuple of Check
        Of the finished design; none fails.
    warnings : tuple of str
        What could not be checked, or is not known, and why.
    machine : Machine
        The design made concrete.
    """

    design: Design
    checks: tuple[Check, ...]
    warnings: tuple[str, ...]
    objective: Objective
    machine: Machine = field(compare=False, repr=False)

    def remade(self, changes: Mapping[str, Any]) -> SizedDesign:
        """The same gearbox with other values of some dotted keys, checked anew."""
        design = self.design.replacing(changes)
        machine = resolve(design, self.machine.motor)
        analysis = machine.analysis
        return replace(
            self,
            design=design,
            machine=machine,
            checks=analysis.checks,
            warnings=analysis.warnings,
        )

    def to_dict(self) -> dict[str, object]:
        """The JSON form: the sizes that differ between alternatives, and the objective."""
        reducer = self.design.reducer
        pins = reducer.output_pins
        return {
            "name": self.design.name,
            "ring_pitch_radius_mm": reducer.ring_pitch_radius * 1e3,
            "eccentricity_mm": reducer.eccentricity * 1e3,
            "ring_pin_diameter_mm": reducer.ring_pin_diameter * 1e3,
            "disc_thickness_mm": reducer.disc_thickness * 1e3,
            "output_pin_count": pins.count,
            "output_pin_diameter_mm": pins.diameter * 1e3,
            "output_pin_circle_radius_mm": pins.circle_radius * 1e3,
            "cam_bearing": reducer.cam_bearing.designation,
            **self.objective.to_dict(),
        }


@dataclass(frozen=True)
class Cost:
    """One requirement that asks for more than is asked for, and what that would cost.

    Attributes
    ----------
    key : str
        Of ``[requirements]``.
    words : str
        How much more.
    asked : float
        What would be asked for, SI.
    mass : float or None
        Of the parts that the search counts, kg more than those of the design; None where nothing
        near it bears that.
    beyond_motor : bool
        Whether that is more than the design's motor gives, or holds for ever as it is cooled.
    """

    key: str
    words: str
    asked: float
    mass: float | None
    beyond_motor: bool = False

    @property
    def told(self) -> str:
        """In words."""
        more = "not in this space" if self.mass is None else f"{1e3 * self.mass:+.0f} g"
        if self.beyond_motor:
            more = "not with this motor, as it is cooled"
        return f"{self.words} {more}"

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form."""
        more = None if self.mass is None or self.beyond_motor else 1e3 * self.mass
        return {
            "key": self.key,
            "change": self.words,
            "mass_g": more,
            "beyond_motor": self.beyond_motor,
        }


@dataclass(frozen=True)
class SizingResult(SizedDesign):
    """A gearbox sized for its requirements, and how it was found.

    It meets every check; only a motor's shortfall (where the motor was not asked for) and the
    reported rules of thumb may warn.

    Attributes
    ----------
    alternatives : tuple of SizedDesign
        Up to three other designs, fewer only where several aims lead to one design: the lightest
        of all, and two with more torque reserve, each as light as that allows.
    candidates_screened, survivors : int
        Candidates tried, and those of them that met every check.
    rejected : dict of str to int
        The other candidates, each counted once at the first check it failed, in the order in which
        the checks are applied.
    seconds : float
        Wall time; not compared.
    costs : tuple of Cost
        What more would cost, near the design; none where closed forms alone have judged it, nor of
        an alternative.
    """

    alternatives: tuple[SizedDesign, ...]
    candidates_screened: int
    survivors: int
    rejected: dict[str, int]
    seconds: float = field(compare=False)
    costs: tuple[Cost, ...] = ()

    def picking(self, letter: str) -> SizingResult:
        """The same result with an alternative in the design's place, and the design among the rest.

        It has the letter a there.

        Parameters
        ----------
        letter : str
            At the end of the alternative's name: b, c or d.

        Raises
        ------
        UsageError
            Where no alternative has that letter; it names those there are.
        """
        letters = {one.design.name.rpartition("-")[2]: one for one in self.alternatives}
        picked = letters.get(letter)
        if picked is None:
            there = f"the letters there are: {', '.join(letters)}" if letters else "there is none"
            raise UsageError(
                f"--pick {letter}: no alternative of that letter was found; {there} (several aims "
                "may lead to one design). Leave --pick out for the first design."
            )
        own = {one.name: getattr(self, one.name) for one in fields(SizedDesign)}
        # Its name alone would be that of the file which the picked one takes.
        own["design"] = self.design.replacing({"name": f"{self.design.name}-a"})
        own["machine"] = resolve(own["design"], self.machine.motor)
        first = SizedDesign(**own)
        others = tuple(one for one in self.alternatives if one is not picked)
        return replace(self, **vars(picked), alternatives=(first, *others), costs=())

    def named(self, name: str) -> SizingResult:
        """The same result with its design called so, and the alternatives so with their letters."""

        def called(one: SizedDesign, name: str) -> SizedDesign:
            return replace(one, design=one.design.replacing({"name": name}))

        others = tuple(
            called(one, f"{name}-{one.design.name.rpartition('-')[2]}") for one in self.alternatives
        )
        return replace(self, design=self.design.replacing({"name": name}), alternatives=others)

    def to_dict(self) -> dict[str, object]:
        """The JSON form (``results`` of ``size``), without the time it took."""
        return {
            "candidates_screened": self.candidates_screened,
            "survivors": self.survivors,
            "rejected": dict(self.rejected),
            "objective": self.objective.to_dict(),
            "alternatives": [one.to_dict() for one in self.alternatives],
            "costs": [one.to_dict() for one in self.costs],
        }
