"""Films and friction of a running gearbox, and what it wears."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cqdd_design.catalog.lubricants import find_lubricant
from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.gearbox.contact.films import hole_film, ring_film, travel
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.rubbing import slip
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.contact.states import NominalStates
from cqdd_design.gearbox.film.law import Film, FilmLaw
from cqdd_design.gearbox.film.mixed import asperity_share
from cqdd_design.gearbox.film.of_design import ContactFilm
from cqdd_design.gearbox.film.plastics import films_on_plastics
from cqdd_design.gearbox.film.wear import WEAR_BAND, Wear, wear_depth
from cqdd_design.gearbox.life.life import duty_cases
from cqdd_design.gearbox.losses import LossModel
from cqdd_design.geometry.contours import FloatArray

_PLACES = 512
"""Places of a lobe over which its length is summed."""


@dataclass(frozen=True)
class RunningFilm:
    """The films of one kind of contact, means by the force of all that are loaded.

    Attributes
    ----------
    thickness, least_thickness : float
        Mean, and that of the thinnest film under load, m.
    ratio, least_ratio : float
        lambda, likewise.
    carried : float
        Share of the load on asperities.
    by_film : float
        Coefficient of friction that the film leaves, as it is felt at the disc.
    friction : float
        That of the equilibrium: the same, or what the design states.
    roughness : float
        Composite, m.
    """

    thickness: float
    least_thickness: float
    ratio: float
    least_ratio: float
    carried: float
    by_film: float
    friction: float
    roughness: float

    @classmethod
    def of(cls, film: Film, law: FilmLaw, force: FloatArray, friction: float) -> RunningFilm:
        """Of films under forces, which load one contact or more."""
        loaded = force > 0.0

        def mean(values: FloatArray) -> float:
            return float(np.average(values[loaded], weights=force[loaded]))

        return cls(
            thickness=mean(film.thickness),
            least_thickness=float(film.thickness[loaded].min()),
            ratio=mean(film.ratio),
            least_ratio=float(film.ratio[loaded].min()),
            carried=mean(asperity_share(film.ratio)),
            by_film=mean(film.friction),
            friction=friction,
            roughness=law.roughness,
        )

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form."""
        return {
            "thickness_um": self.thickness * 1e6,
            "thickness_min_um": self.least_thickness * 1e6,
            "lambda": self.ratio,
            "lambda_min": self.least_ratio,
            "friction": self.friction,
            "friction_by_film": self.by_film,
            "asperity_share": self.carried,
            "roughness_um": self.roughness * 1e6,
        }


@dataclass(frozen=True)
class Running:
    """Films and wear of a gearbox.

    Attributes
    ----------
    torque, input_speed, temperature, viscosity : float
        Of the films: N m, rad/s, deg C, and kinematic, m^2/s.
    lubricant : str
    teeth, pins : RunningFilm or None
        At ring teeth and output pins; None on needles, and where nothing is loaded.
    wear : Wear
        Over the required life.
    warnings : tuple of str
        On films of plastics.
    """

    torque: float
    input_speed: float
    temperature: float
    viscosity: float
    lubricant: str
    teeth: RunningFilm | None
    pins: RunningFilm | None
    wear: Wear
    warnings: tuple[str, ...]

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form (``film``): what has no name of its own is at the ring teeth."""
        found: dict[str, object] = dict.fromkeys(("thickness_um", "lambda", "friction"))
        if self.teeth is not None:
            found = self.teeth.to_dict()
        return {
            **found,
            "torque_Nm": self.torque,
            "input_speed_rad_per_s": self.input_speed,
            "temperature_degC": self.temperature,
            "lubricant": self.lubricant,
            "viscosity_mm2_s": self.viscosity * 1e6,
            "output_pins": None if self.pins is None else self.pins.to_dict(),
        }


def running(
    design: Design,
    model: ContactModel,
    losses: LossModel,
    sweep: ContactSweep,
    states: NominalStates,
) -> Running:
    """Films of a sweep at the speed of the continuous torque, and wear under the duty.

    Parameters
    ----------
    model, losses
        Of the same design.
    sweep : ContactSweep
        At crank angles over the period, with friction or without.
    states : NominalStates
        That it was solved at.
    """
    speed = design.requirements.held_speed
    lubricant = find_lubricant(design.reducer.friction.lubricant)
    teeth = ring_film(model, states, slip(model, states), sweep.ring_force, speed)
    pins = hole_film(model, sweep.pin_force, speed)
    return Running(
        torque=sweep.torque,
        input_speed=speed,
        temperature=losses.machine.temperature,
        viscosity=losses.machine.viscosity,
        lubricant=lubricant.name,
        teeth=_running(teeth, model.tooth_film, sweep.ring_force, sweep.mean_friction[0]),
        pins=_running(pins, model.hole_film, sweep.pin_force, sweep.mean_friction[1]),
        wear=_wear(design, model, losses, sweep, states),
        warnings=films_on_plastics(design, model),
    )


def _running(
    film: Film | None, of: ContactFilm | None, force: FloatArray, friction: float
) -> RunningFilm | None:
    if film is None or of is None or not np.any(force > 0.0):
        return None
    return RunningFilm.of(film, of.law, force, friction)


def _wear(
    design: Design,
    model: ContactModel,
    losses: LossModel,
    sweep: ContactSweep,
    states: NominalStates,
) -> Wear:
    cases, _ = duty_cases(design)
    n, discs, length = model.lobe_count, model.disc_count, model.contact_length
    seconds = design.requirements.life
    rubbed = sum(
        case.share * seconds * case.speed * n * losses.rubbed_at(case.torque) for case in cases
    )
    teeth, pins = (float(one) / discs for one in np.asarray(rubbed))

    def band(path: float, area: float) -> tuple[float, float]:
        low, high = wear_depth(WEAR_BAND, path, area)
        return float(low), float(high)

    disc_flank = ring_tooth = hole = pin = None
    way = _way_on_tooth(model, sweep, states)
    reducer = design.reducer
    # The band is that of steel; on plastics nothing is known.
    soft = find_material(reducer.disc_material).is_plastic
    teeth_known = not (soft or find_material(reducer.ring_material).is_plastic) and way > 0.0
    pins_known = not (soft or find_material(reducer.output_pins.material).is_plastic)
    if teeth_known and model.tooth_film is not None and model.tooth_film.journal is None:
        disc_flank = band(teeth, _perimeter(model) * length)
        ring_tooth = band(teeth, model.tooth_count * way * length)
    if pins_known and model.hole_film is not None and model.hole_film.journal is None:
        hole = band(pins, model.pin_count * 2.0 * math.pi * model.hole_radius * length)
        pin = band(pins, model.pin_count * 2.0 * math.pi * model.pin_contact_radius * length)
    return Wear(
        hours=design.requirements.life_hours,
        disc_flank=disc_flank,
        ring_tooth=ring_tooth,
        hole=hole,
        pin=pin,
        clearance=reducer.modification.equidistant,
    )


def _way_on_tooth(model: ContactModel, sweep: ContactSweep, states: NominalStates) -> float:
    """Way that loaded contacts travel on one ring tooth in a turn of the crank, m."""
    on_tooth, _ = travel(model, states, slip(model, states))
    loaded = np.abs(on_tooth) * (sweep.ring_force > 0.0)
    return 2.0 * math.pi * float(loaded.sum(axis=2).mean()) / model.tooth_count


def _perimeter(model: ContactModel) -> float:
    """Of a disc's lobed outline, m."""
    pitch = model.disc.half_pitch
    place = 2.0 * pitch * (np.arange(_PLACES) + 0.5) / _PLACES
    speed, _ = model.disc.rates(place)
    return float(model.lobe_count * 2.0 * pitch * np.mean(np.abs(speed)))
