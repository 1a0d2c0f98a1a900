"""The `Machine`: what a design means once bearings and motor are chosen and laid out."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from cqdd_design.catalog.bearings import Bearing
from cqdd_design.catalog.lubricants import RUNNING_TEMPERATURE, find_lubricant
from cqdd_design.catalog.motors import Motor
from cqdd_design.design import Design
from cqdd_design.design.requirements import EXTERNAL_LOADS
from cqdd_design.errors import GeometryError
from cqdd_design.solids.counterweights import drawn_weights
from cqdd_design.solids.layout import Layout
from cqdd_design.solids.part import Part
from cqdd_design.solids.parts import build_parts
from cqdd_design.solids.proportions import lay_out, seat_bearings
from cqdd_design.solids.selection import ChosenBearing
from cqdd_design.solids.throw import throw_of

if TYPE_CHECKING:
    from cqdd_design.gearbox.analysis import GearboxAnalysis
    from cqdd_design.gearbox.balance import StackBalance
    from cqdd_design.gearbox.bodies.compliance import ElasticBodies
    from cqdd_design.gearbox.contact.laws import LineModel
    from cqdd_design.gearbox.contact.model import ContactModel
    from cqdd_design.gearbox.contact.solved import ContactSweep
    from cqdd_design.gearbox.heat.expansion import PartTemperatures
    from cqdd_design.gearbox.life import LifeResult
    from cqdd_design.gearbox.losses import FrictionMachine, LossModel
    from cqdd_design.gearbox.losses.rolling import BearingFriction
    from cqdd_design.gearbox.pack_loads import PackLoads
    from cqdd_design.machine.capacity import LoadedContacts
    from cqdd_design.results import MassProperties
    from cqdd_design.solids.axial import AxialStack
    from cqdd_design.solids.inertia import GearboxInertia
    from cqdd_design.solids.retention import Retained
    from cqdd_design.solids.tool_access import ToolReach


_PEAK_ANGLES = 120
"""Crank angles over the period at which forces at the peak torque are looked at."""
_FEW_TORQUES = 6
"""Up to which the losses of a duty are swept at its own torques."""
_ROUGH_SHARES = (0.0, 1e-3, 5e-3, 0.02, 0.06, 0.15, 0.4, 1.0)
"""Of the peak torque, where losses of rigid bodies are swept: straight lines between them are good
to 3 %."""


_DRAWN = (
    *("seats", "layout", "parts", "retention", "axial_stacks", "told_stacks", "tool_access"),
    *("inertia", "balance", "analysis"),
)
"""What is the same at any temperature, whether bodies yield or not."""


class Cooling(NamedTuple):
    """Stated thermal resistance from winding to ambient, K/W; 0 where it is computed.

    Attributes
    ----------
    key : str
        Of the design, that states it.
    """

    value: float
    key: str


@dataclass(frozen=True, eq=False, repr=False)
class Machine:
    """A design made concrete, from `resolve`.

    What takes time is worked out when it is first asked for, and kept.

    Attributes
    ----------
    given : Design
        As it was written: what it left open is still "auto", and still counts as assumed.
    design : Design
        The same with its cam bearing named, and that of the carrier where external loads choose it.
    cam : Bearing
        The cam bearing.
    motor : Motor
        The catalogue's row, or what the design says instead.
    temperatures : PartTemperatures or None
        Of the parts, where they are not as drawn, at 20 deg C. Contacts, and what follows from
        them, are those of the warm parts; closed forms, solids and masses those of the drawing.
    stiff : bool
        Whether discs and ring count as rigid, which spares their finite elements, and losses are
        swept at few torques: a look at what the machine does.
    duty_share : float
        Of the torques of its duty, or of the continuous one, that `life` is of.

    Examples
    --------
    >>> import cqdd_design as cq
    >>> from cqdd_design.machine import resolve
    >>> machine = resolve(cq.load("cqdd-10"))
    >>> machine.cam.designation, machine.motor.name
    ('6902', 'CubeMars RO100 Lite KV55')
    """

    given: Design
    design: Design
    cam: Bearing
    motor: Motor
    temperatures: PartTemperatures | None = None
    stiff: bool = False
    duty_share: float = 1.0

    def __repr__(self) -> str:
        """The design, and what it leaves open that is chosen here."""
        warm = "" if self.temperatures is None else ", warm"
        return f"Machine of {self.given!r}; cam bearing {self.cam.designation}{warm}"

    def at(self, temperatures: PartTemperatures) -> Machine:
        """The machine with its parts at these temperatures."""
        return self._drawn_as(replace(self, temperatures=temperatures))

    @cached_property
    def rigid(self) -> Machine:
        """The machine with discs and ring that count as rigid: itself where they do."""
        return self if self.stiff else self._drawn_as(replace(self, stiff=True))

    def _drawn_as(self, other: Machine) -> Machine:
        """The other machine, which is drawn like this one, with what is known of that."""
        vars(other).update({name: vars(self)[name] for name in _DRAWN if name in vars(self)})
        return other

    @property
    def too_warm(self) -> tuple[str, ...]:
        """Sentences on parts that are warmer than their material bears, and on the lubricant."""
        if self.temperatures is None:
            return ()
        parts = self.temperatures.beyond(self.design)
        lubricant = find_lubricant(self.design.reducer.friction.lubricant)
        here, taken = self._between_ring_and_disc, self.lubricant_temperature
        if here == taken:
            return parts
        told = (
            f"between ring and discs at {here:.4g} degC {lubricant.name} is outside the "
            f"{lubricant.coldest:g} to {lubricant.hottest:g} degC at which it works; its films and "
            f"drag are those at {taken:g} degC."
        )
        return (*parts, told)

    @property
    def _between_ring_and_disc(self) -> float:
        """Temperature halfway between them, deg C."""
        if self.temperatures is None:
            return RUNNING_TEMPERATURE
        return 0.5 * (self.temperatures.ring + self.temperatures.disc)

    @property
    def lubricant_temperature(self) -> float:
        """Of films and drag, deg C: halfway between ring and discs, as far as it is sold to work.

        40 deg C where parts are as drawn: the temperature of the printed viscosities.
        """
        lubricant = find_lubricant(self.design.reducer.friction.lubricant)
        return min(max(self._between_ring_and_disc, lubricant.coldest), lubricant.hottest)

    def changed(self, changes: Mapping[str, Any]) -> Machine:
        """The machine with other values of some dotted keys, and the same bearing and motor."""
        return replace(self, design=self.design.replacing(changes))

    def under(
        self,
        *,
        peak: float | None = None,
        continuous: float | None = None,
        duty_share: float = 1.0,
    ) -> Machine:
        """The machine at other torques, N m, or at a share of the torques of its duty.

        A continuous torque above the peak torque is lowered with it. Contacts are those of the
        same parts, and not worked out again.
        """
        asked = self.design.requirements
        most = asked.peak_torque if peak is None else peak
        steady = min(asked.continuous_torque if continuous is None else continuous, most)
        torques = {"requirements.peak_torque": most, "requirements.continuous_torque": steady}
        other = replace(self.changed(torques), duty_share=duty_share)
        vars(other).update(contact=self.contact, bodies=self.bodies)
        if most == asked.peak_torque:
            other.loses_as(self)
        return other

    def loses_as(self, other: Machine) -> None:
        """Have the losses of the same parts up to the same peak torque, where they are known."""
        if "losses" in vars(other):
            vars(self).update(losses=other.losses)

    def loaded(self, peak: float) -> Machine:
        """The machine under another peak torque, N m, laid out as it is: dowels, screws, bearings.

        `under` is laid out anew. GeometryError as `layout`.
        """
        other = self.under(peak=peak)
        vars(other).update(seats=self.seats, layout=self.layout)
        return other

    def under_outside(self, share: float) -> Machine:
        """The machine under a share of the external loads of its requirements.

        What discs and pins put on it is the same, and not worked out again.
        """
        asked = self.design.requirements
        stated = {f"requirements.{key}": getattr(asked, key) for key in EXTERNAL_LOADS}
        other = self.changed({key: share * value for key, value in stated.items() if value})
        vars(other).update(contact=self.contact, bodies=self.bodies, peak_pack=self.peak_pack)
        return other

    @property
    def lasting_torque(self) -> float:
        """Greatest torque of the duty, or the continuous one, by `duty_share`, N m."""
        return self.duty_share * self.design.requirements.lasting_torque

    @property
    def cooling(self) -> Cooling:
        """From winding to ambient, as the design's drive or its motor's data state it."""
        stated = self.design.drive.thermal_resistance
        if stated == 0.0 and "thermal_resistance" in self.motor.stated:
            return Cooling(self.motor.thermal_resistance or 0.0, "motor.thermal_resistance")
        return Cooling(stated, "drive.thermal_resistance")

    @cached_property
    def seats(self) -> tuple[ChosenBearing, ChosenBearing]:
        """Bearings at both ends of the shaft, and of the carrier."""
        return seat_bearings(self.design, self.cam)

    @cached_property
    def layout(self) -> Layout:
        """Heights and turned dimensions of every part; GeometryError where nothing fits."""
        return lay_out(self.design, self.cam, self.motor)

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """Every part; GeometryError where they cannot exist or be put together."""
        return build_parts(self.design, self.layout)

    @cached_property
    def retention(self) -> tuple[Retained, ...]:
        """What holds every part along the axis; GeometryError as `parts`."""
        from cqdd_design.solids.retention import retention

        return retention(self.parts, self.layout)

    @cached_property
    def axial_stacks(self) -> tuple[AxialStack, ...]:
        """Tolerance stacks of the axial plays; GeometryError as `parts`."""
        from cqdd_design.solids.axial import axial_stacks

        return axial_stacks(self.parts, self.layout)

    @cached_property
    def told_stacks(self) -> tuple[AxialStack, ...]:
        """The same, and the ring's under its clamp, which has play by rule; GeometryError too."""
        from cqdd_design.solids.axial import ring_stack

        return (*self.axial_stacks, ring_stack(self.parts))

    @cached_property
    def tool_access(self) -> tuple[tuple[ToolReach, ...], bool]:
        """Keys at the screws as it is put together, and whether it can be; errors as `parts`."""
        from cqdd_design.solids.tool_access import tool_access

        return tool_access(self.design, self.parts)

    @cached_property
    def inertia(self) -> GearboxInertia:
        """Mass properties of the parts in closed form."""
        from cqdd_design.solids.inertia import closed_form, gearbox_inertia

        return gearbox_inertia(self.design, self.motor, self.parts, closed_form)

    @cached_property
    def balance(self) -> StackBalance:
        """Of the crank with all that turns with it, balance weights as drawn, in closed form.

        Weights that are asked for and cannot be drawn balance nothing; the result says why.
        """
        from cqdd_design.gearbox.balance import stack_balance

        reducer, missing = self.design.reducer, ""
        weights: tuple[MassProperties, ...] = ()
        if reducer.balance.counterweights:
            try:
                weights = drawn_weights(self.design, self.parts)
            except GeometryError as error:
                missing = error.message
        return stack_balance(
            throw_of(self.design, self.cam).mass,
            reducer.eccentricity,
            reducer.disc_thickness,
            reducer.disc_spacing,
            reducer.disc_count,
            self.design.requirements.fastest_speed,
            weights,
            weights_missing=missing,
        )

    @cached_property
    def analysis(self) -> GearboxAnalysis:
        """Closed forms and checks at the torques of the requirements."""
        return self.analyse()

    def analyse(self, *, torque: float | None = None, angles: int | None = None) -> GearboxAnalysis:
        """Closed forms and checks, see `gearbox.analyse_gearbox`."""
        from cqdd_design.gearbox.analysis import DEFAULT_ANGLES, analyse_gearbox

        return analyse_gearbox(
            self.design,
            self.motor,
            self.balance,
            torque=torque,
            angles=angles or DEFAULT_ANGLES,
        )

    @cached_property
    def contact(self) -> ContactModel:
        """What the contact equilibrium needs."""
        return self.contact_by("palmgren")

    def contact_by(self, line_model: LineModel) -> ContactModel:
        """The same with another law of approach at teeth and pins."""
        from cqdd_design.gearbox.contact.model import ContactModel

        model = ContactModel.from_design(self.design, line_model, self.lubricant_temperature)
        drawn = replace(model, bodies=self.bodies)
        if self.temperatures is None:
            return drawn
        from cqdd_design.gearbox.heat.expansion import heated

        return heated(drawn, self.design, self.temperatures)

    @cached_property
    def loaded_contacts(self) -> LoadedContacts:
        """Greatest forces and pressures of perfect parts over torques."""
        from cqdd_design.machine.capacity import LoadedContacts

        return LoadedContacts(self.contact)

    @cached_property
    def running_contacts(self) -> LoadedContacts:
        """The same while it turns at its input speed, which films ease."""
        from cqdd_design.machine.capacity import LoadedContacts

        return LoadedContacts(self.contact, self.contact.film_speed)

    @cached_property
    def life(self) -> LifeResult:
        """Over the duty of the requirements; ContactError where a case has no equilibrium."""
        from cqdd_design.gearbox.life import life

        return life(self.design, self.contact, share=self.duty_share)

    @cached_property
    def peak_pack(self) -> PackLoads:
        """Forces of the discs at the peak torque, see `pack_at`."""
        from cqdd_design.gearbox.pack_loads import PackLoads

        return PackLoads.of(self.peak_sweeps)

    def pack_at(self, torque: float) -> PackLoads:
        """Forces of the discs at an output torque, N m; see `peak_sweeps`."""
        from cqdd_design.gearbox.pack_loads import PackLoads

        return PackLoads.of(self._from_rest(torque))

    @cached_property
    def peak_sweeps(self) -> tuple[ContactSweep, ContactSweep]:
        """Contacts of both senses of the peak torque, driving from rest.

        Friction is then that of a gearbox without films, which is the most.

        ContactError where it has no equilibrium.
        """
        return self._from_rest(self.design.requirements.peak_torque)

    def _from_rest(self, torque: float) -> tuple[ContactSweep, ContactSweep]:
        from cqdd_design.gearbox.contact.rubbing import ContactFriction
        from cqdd_design.gearbox.contact.sweep import contact_sweep, perfect_angles

        model = self.contact
        rubbed = ContactFriction.of(model, "drive", 0.0)
        angles = perfect_angles(model, _PEAK_ANGLES)
        return (
            contact_sweep(model, torque, angles, friction=rubbed),
            contact_sweep(model, -torque, angles, friction=rubbed),
        )

    @cached_property
    def bodies(self) -> ElasticBodies | None:
        """Discs and ring as elastic bodies; None where material is too thin to mesh.

        Of discs with more lobes than there is memory for, likewise.
        """
        if self.stiff:
            return None
        from cqdd_design.gearbox.bodies.made import bodies_or_none

        return bodies_or_none(self.design)

    @cached_property
    def friction(self) -> FrictionMachine:
        """What friction and losses need."""
        from cqdd_design.gearbox.losses import FrictionMachine

        support, output = (self._seat_friction(seat) for seat in self.seats)
        return FrictionMachine.from_design(
            self.design, support=support, output=output, temperature=self.lubricant_temperature
        )

    def _seat_friction(self, seat: ChosenBearing) -> BearingFriction:
        from cqdd_design.gearbox.losses.rolling import BearingFriction
        from cqdd_design.gearbox.rolling_contacts import at_rest

        row = seat.bearing
        if seat.source == "bush":
            coefficient = at_rest(self.design.reducer.friction.pin)
            return BearingFriction.bush(row.bore_diameter, row.width, coefficient)
        return BearingFriction.of(row, sealed=self.design.reducer.friction.seals == "contact")

    @cached_property
    def losses(self) -> LossModel:
        """Losses over speed and torque; ContactError where a sweep has no equilibrium."""
        from cqdd_design.gearbox.losses import TORQUE_SHARES, loss_model

        shares = _ROUGH_SHARES if self.stiff else TORQUE_SHARES
        peak = self.design.requirements.peak_torque
        return loss_model(self.contact, self.friction, peak, shares)

    def losses_at(self, torques: Iterable[float]) -> LossModel:
        """As `losses`, but of warm parts swept at these torques alone, N m, where they are few."""
        from cqdd_design.gearbox.losses import loss_model

        peak = self.design.requirements.peak_torque
        shares = sorted({abs(torque) / peak for torque in torques})
        if self.temperatures is None or len(shares) > _FEW_TORQUES:
            return self.losses
        return loss_model(self.contact, self.friction, peak, shares)
