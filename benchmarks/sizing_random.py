"""Sizing's search by the contact equilibrium against a random search with many times its time.

    python benchmarks/sizing_random.py [times [row ...]]

For ten requirements, `sizing.kinds.lightest` searches first. Then random points of the same
grid, over the whole space and about the best that was found at random so far, are screened by the
closed forms, and those that might be lighter are held against the same equilibrium
(`exact_checks`), and their shafts against theirs (`weak_lines`), for `times` (100) times as long.
Both are borne out by the same lines and end at the smallest ring that a motor is drawn round; what
is printed is the mass that the search finds over the lightest of the random one. Times are those of
the processor.
"""

from __future__ import annotations

import sys
import time

import numpy as np

from cqdd_design.design import Requirements, requirements_from_mapping
from cqdd_design.errors import ContactError, DesignError
from cqdd_design.machine import resolve
from cqdd_design.sizing.exact import exact_checks
from cqdd_design.sizing.finish import finish
from cqdd_design.sizing.hunt import Hunt
from cqdd_design.sizing.kinds import lightest
from cqdd_design.sizing.points import Evaluator, Points
from cqdd_design.sizing.ring_stages import Pins
from cqdd_design.sizing.search import Search
from cqdd_design.sizing.shafts import weak_lines
from cqdd_design.sizing.spaces import Found, spaces
from cqdd_design.sizing.stage_tables import stage_tables

TIMES = 100.0
_BATCH = 400
_ABOUT = 0.6
"""Share of the points that are drawn about the best of the random search."""
_REQUIREMENTS = 10


def drawn_requirements(count: int) -> list[Requirements]:
    """Torques, lives and lengths within reach of a 72 mm ring."""
    draw = np.random.default_rng(5)
    found = []
    for _ in range(count):
        ratio = int(draw.choice([6, 8, 9, 10, 11, 12, 14, 16, 20, 24]))
        peak = float(draw.uniform(12.0, 50.0))
        found.append(
            requirements_from_mapping(
                {
                    "ratio": ratio,
                    "peak_torque": f"{peak:.3g} N*m",
                    "continuous_torque": f"{peak * draw.uniform(0.05, 0.25):.3g} N*m",
                    "continuous_speed": "300 rpm",
                    "life": f"{10.0 ** draw.uniform(2.0, 3.7):.0f} h",
                }
            )
        )
    return found


def by_search(requirements: Requirements) -> tuple[Found | None, float]:
    """What the search finds, and the seconds that it took."""
    began = time.process_time()
    hunt = _hunt(requirements)
    hunt.fine = True
    found = lightest(hunt)
    return None if found is None or found.weak else found, time.process_time() - began


def _hunt(requirements: Requirements) -> Hunt:
    tables = stage_tables(requirements.ratio)
    return Hunt(requirements, None, None, lambda _: None, tables, "mass", usual={})


def by_chance(requirements: Requirements, seconds: float, seed: int) -> tuple[float, int]:
    """Mass of the lightest that random points lead to, kg, and how many the equilibrium saw."""
    hunt, draw = _hunt(requirements), np.random.default_rng(seed)
    tried = []
    for space in spaces(requirements, hunt.fit):
        frame = hunt.frame(space._replace(free=True), {})
        tried.append(Search.of(frame, hunt.tables))
    best, seen, end = np.inf, 0, time.process_time() + seconds
    place: tuple[Search, Points] | None = None
    while time.process_time() < end:
        about = place is not None and draw.random() < _ABOUT
        search = place[0] if about and place else tried[draw.integers(len(tried))]
        points = _points(search, draw, place[1] if about and place else None)
        fits = points.outer_radius >= search.frame.least_outer_radius
        light = np.flatnonzero(fits & (points.reserve >= 1.0) & (points.mass < best))
        for row in light[np.argsort(points.mass[light])][:4]:
            seen += 1
            if points.mass[row] < best and _borne_out(search.evaluator, points, int(row)):
                best, place = float(points.mass[row]), (search, points.rows(np.array([row])))
    return best, seen


def _points(search: Search, draw: np.random.Generator, about: Points | None) -> Points:
    """Random points of the grid, anywhere or about one; a third of them with smaller rings."""
    evaluator, frame = search.evaluator, search.frame
    most = np.array(
        [0.2 * frame.outer_radius, 0.2 * frame.outer_radius, 8e-3, frame.most_thickness]
    )
    top = np.maximum(np.floor(most / evaluator.grid.steps), 1.0)
    if about is None:
        steps = np.ceil(draw.random((_BATCH, 4)) * top).astype(np.intp)
        steps[draw.random(_BATCH) < 0.7, 2] = draw.integers(0, 8)
        count = draw.choice(np.array(search.space.pin_counts), _BATCH)
        size = draw.integers(0, len(frame.pin_sizes), _BATCH)
    else:
        spread = draw.choice([1.0, 3.0, 10.0])
        steps = np.maximum(about.steps + np.rint(draw.normal(0.0, spread, (_BATCH, 4))), 0)
        steps = np.maximum(steps, [1, 1, 0, 1]).astype(np.intp)
        count = np.repeat(about.pin_count, _BATCH)
        size = np.repeat(about.pin_size, _BATCH)
        other = draw.random(_BATCH) < 0.3
        count[other] = draw.choice(np.array(search.space.pin_counts), int(other.sum()))
        size[other] = draw.integers(0, len(frame.pin_sizes), int(other.sum()))
    pins = Pins.of(frame, count, size)
    return evaluator.evaluate(steps[:, :3], steps[:, 3:], pins, np.ones(_BATCH))


def _borne_out(evaluator: Evaluator, points: Points, row: int) -> bool:
    sized = finish(evaluator, points, row)
    if sized is None:
        return False
    try:
        machine = resolve(sized.design)
        borne = all(one.satisfied for one in exact_checks(machine))
        return borne and not weak_lines(machine)
    except (ContactError, DesignError):
        return False


def main(times: float, rows: tuple[int, ...]) -> None:
    """Print a row for every requirement, or for those of some numbers."""
    np.seterr(all="ignore")  # Of shapes that cannot be: they have no reserve.
    print("ratio  peak N*m  lasting N*m  life h  search s  search g  chance g  looked at  over")
    for seed, asked in enumerate(drawn_requirements(_REQUIREMENTS)):
        if rows and seed + 1 not in rows:
            continue
        by_search(asked)
        found, seconds = by_search(asked)
        best, seen = by_chance(asked, times * seconds, seed)
        mass = np.inf if found is None else found.sized.objective.mass
        print(
            f"{asked.ratio:5d}  {asked.peak_torque:8.3g}  {asked.continuous_torque:11.3g}  "
            f"{asked.life_hours:6.0f}  {seconds:8.2f}  {1e3 * mass:8.1f}  {1e3 * best:8.1f}  "
            f"{seen:9d}  {mass / best - 1.0:+.1%}",
            flush=True,
        )


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else TIMES, tuple(map(int, sys.argv[2:])))
