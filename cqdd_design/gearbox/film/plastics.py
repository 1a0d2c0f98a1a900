"""Plastics that rub at output pins: pressure on the projected area times speed."""

from __future__ import annotations

from dataclasses import dataclass

from cqdd_design.catalog.finishes import rubbing_limits
from cqdd_design.catalog.materials import find_material
from cqdd_design.design import Design
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.solved import ContactSweep
from cqdd_design.gearbox.losses.sliding import pin_sliding
from cqdd_design.gearbox.rolling_contacts import at_rest


@dataclass(frozen=True)
class RubbingPlastic:
    """A plastic that slides, steadily loaded.

    Attributes
    ----------
    material : str
    pressure, speed : float
        Mean over the period on the projected area of the busiest pin, Pa, and of sliding, m/s.
    limit : float or None
        Of their product, of the plastic dry on steel, Pa m/s; None where the catalogue has none.
    source : str
        Of the limit.
    """

    material: str
    pressure: float
    speed: float
    limit: float | None
    source: str

    @property
    def value(self) -> float:
        """Pressure times speed, Pa m/s."""
        return self.pressure * self.speed


def sliding_plastics(design: Design, model: ContactModel) -> tuple[str, ...]:
    """Plastics that slide at output pins: pins and holes, or pins under plain sleeves.

    None where needles roll.
    """
    if model.hole_film is None:
        return ()
    reducer = design.reducer
    pair = [reducer.disc_material, reducer.output_pins.material]
    rubbing = pair if model.hole_film.journal is None else pair[1:]
    return tuple(name for name in dict.fromkeys(rubbing) if find_material(name).is_plastic)


def rubbing_plastics(
    design: Design, model: ContactModel, sweep: ContactSweep, speed: float
) -> tuple[RubbingPlastic, ...]:
    """How hard they rub under the forces of a sweep, the crank at a speed (rad/s)."""
    names = sliding_plastics(design, model)
    if not names or model.hole_film is None:
        return ()
    journal = model.hole_film.journal
    radius = model.pin_contact_radius if journal is None else journal.pin
    slow = 1.0 if journal is None else journal.pin / journal.rim
    velocity = float(pin_sliding(model.lobe_count, model.eccentricity)) * abs(speed) * slow
    pressed = float(sweep.pin_force.mean(axis=0).max()) / (2.0 * radius * model.contact_length)
    limits = rubbing_limits()

    def one(name: str) -> RubbingPlastic:
        found = limits.get(name)
        if found is None:
            return RubbingPlastic(name, pressed, velocity, None, "")
        return RubbingPlastic(name, pressed, velocity, found.limit, found.source)

    return tuple(one(name) for name in names)


def films_on_plastics(design: Design, model: ContactModel) -> tuple[str, ...]:
    """A sentence on films between plastics, where there are any."""
    reducer = design.reducer
    pair = (reducer.disc_material, reducer.output_pins.material, reducer.ring_material)
    soft = [name for name in dict.fromkeys(pair) if find_material(name).is_plastic]
    if not soft or not any(model.by_film):
        return ()
    return (
        f"{' and '.join(soft)}: friction by a film takes the boundary layer of steel, "
        f"{at_rest('film'):g}; state reducer.friction.tooth and reducer.friction.pin instead.",
    )
