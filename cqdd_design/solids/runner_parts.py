"""The parts of what turns on a pin: sleeves, rollers, and the needles in them."""

from __future__ import annotations

from collections.abc import Iterable

from cqdd_design.catalog.bearings import BEARING_MATERIAL, Bearing
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.runners import Runner
from cqdd_design.solids import rotating
from cqdd_design.solids.features.rotating import sleeve_features
from cqdd_design.solids.layout import PackLayout
from cqdd_design.solids.part import Colour, Instance, Part, placed
from cqdd_design.solids.poses import Body, transform

BEARING_COLOUR: Colour = (0.86, 0.87, 0.88)


def runner_parts(
    where: str,
    name: str,
    runner: Runner,
    material: str,
    pack: PackLayout,
    body: Body,
    centres: Iterable[FloatArray],
) -> list[Part]:
    """One sleeve or roller a pin and disc, and the needle cage in the middle of it.

    Drawn cups stand side by side without a sleeve.

    Parameters
    ----------
    where, name : str
        Of which pins, and what turns on them; the parts are called so.
    body : Body
        What the pins move with.
    centres : iterable of array (2,)
        Of the pins, m.
    """
    places = [(x, y) for x, y in centres]

    def at_every_disc(called: str, length: float) -> tuple[Instance, ...]:
        above = 0.5 * (pack.disc_thickness - runner.rows * length)
        standing = [
            transform(x=x, y=y, z=pack.disc_bottom(disc) + above + row * length)
            for disc in range(pack.disc_count)
            for row in range(runner.rows)
            for x, y in places
        ]
        return placed(called, body, *standing)

    cage = runner.cage
    if cage is not None and runner.is_drawn_cup:
        called = f"{where} needle bearing"
        return [_needle_part(called, cage, at_every_disc(called, cage.width))]
    outer, inner, length = runner.diameter, runner.bore, runner.length
    turning = Part(
        f"{where} {name}",
        rotating.sleeve(inner, outer, length),
        material,
        BEARING_COLOUR,
        "make",
        f"ground {name} {inner * 1e3:g} x {outer * 1e3:g} x {length * 1e3:g} mm",
        at_every_disc(f"{where} {name}", length),
        stated=sleeve_features(inner, outer, length),
    )
    if cage is None:
        return [turning]
    called = f"{where} needle cage"
    return [turning, _needle_part(called, cage, at_every_disc(called, cage.width))]


def _needle_part(called: str, row: Bearing, standing: tuple[Instance, ...]) -> Part:
    return Part(
        called,
        rotating.sleeve(row.bore_diameter, row.outer_diameter, row.width),
        BEARING_MATERIAL,
        BEARING_COLOUR,
        "buy",
        row.designation,
        standing,
        catalogue_mass=row.mass,
    )
