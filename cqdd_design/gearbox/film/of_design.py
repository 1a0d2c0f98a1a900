"""Film laws of a design's teeth and output pins: lubricant, surfaces, and where sliding happens.

    bare                                plain sleeve or roller
    disc on tooth, hole on pin          its bore on the pin: a journal, at the pin's radius

Needles roll, and have the friction of their catalogue: no film is asked for there.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

from cqdd_design.catalog.finishes import find_finish
from cqdd_design.catalog.lubricants import RUNNING_TEMPERATURE, find_lubricant
from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.gearbox import hertz
from cqdd_design.gearbox.film.law import FilmLaw
from cqdd_design.gearbox.film.mixed import BOUNDARY_FRICTION, composite_roughness
from cqdd_design.gearbox.output_pins import sleeve_share
from cqdd_design.geometry.output_pins import mean_pin_diameter
from cqdd_design.geometry.runners import Runner, pin_runner, ring_runner

_LEAST_PLAY = 1e-6
"""Of a sleeve that is said to have none, on the diameter, m: it would not turn."""


class Journal(NamedTuple):
    """Radii (m) of a pin, of the bore that turns on it, and of what has the bore, outside."""

    pin: float
    bore: float
    rim: float

    @property
    def radius(self) -> float:
        """Of the equivalent cylinder of pin and bore, m."""
        return float(hertz.conformal_equivalent_radius(self.pin, self.bore))


class ContactFilm(NamedTuple):
    """A film law, and the journal where sliding happens; None where it does at the disc itself."""

    law: FilmLaw
    journal: Journal | None


def tooth_film(design: Design, temperature: float = RUNNING_TEMPERATURE) -> ContactFilm | None:
    """Of ring teeth and discs, or of rollers and ring pins; None on needles.

    Raises
    ------
    UsageError
        Where the lubricant does not work at the temperature (deg C).
    """
    reducer, finish = design.reducer, design.reducer.finish
    pair = (reducer.ring_material, reducer.disc_material)
    rough = (finish.ring, finish.disc)
    return _film(design, temperature, ring_runner(design), reducer.ring_pin_diameter, pair, rough)


def pin_film(design: Design, temperature: float = RUNNING_TEMPERATURE) -> ContactFilm | None:
    """Of output pins and holes, or of sleeves and pins; None on needles.

    Raises
    ------
    UsageError
        Where the lubricant does not work at the temperature (deg C).
    """
    reducer, finish = design.reducer, design.reducer.finish
    pins = reducer.output_pins
    pair = (pins.material, reducer.disc_material)
    rough = (finish.pin, finish.disc)
    diameter = mean_pin_diameter(pins)
    return _film(design, temperature, pin_runner(design), diameter, pair, rough)


def _film(
    design: Design,
    temperature: float,
    runner: Runner | None,
    pin_diameter: float,
    pair: tuple[str, str],
    rough: tuple[str, str],
) -> ContactFilm | None:
    if runner is not None and runner.cage is not None:
        return None
    lubricant = find_lubricant(design.reducer.friction.lubricant)
    # What turns on a pin is of its material and made as it is.
    first, second = pair if runner is None else (pair[0], pair[0])
    surfaces = rough if runner is None else (rough[0], rough[0])
    law = FilmLaw(
        viscosity=lubricant.viscosity_at(temperature) * lubricant.density,
        pressure_coefficient=lubricant.pressure_coefficient_at(temperature),
        modulus=hertz.pair_modulus(find_material(first), find_material(second)),
        length=design.reducer.disc_thickness,
        roughness=composite_roughness(*(find_finish(one) for one in surfaces)),
        boundary=BOUNDARY_FRICTION,
        film=lubricant.film_friction,
    )
    if runner is None:
        return ContactFilm(law, None)
    journal = Journal(
        pin=0.5 * pin_diameter,
        bore=0.5 * (pin_diameter + max(runner.play, _LEAST_PLAY)),
        rim=0.5 * runner.diameter,
    )
    share = sleeve_share(pin_diameter, runner.diameter)
    most = journal.bore - journal.pin
    return ContactFilm(replace(law, share=share, most=most), journal)
