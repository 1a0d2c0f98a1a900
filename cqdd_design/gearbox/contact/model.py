"""What the contact equilibrium needs of a design, read once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from cqdd_design.catalog.bearings import find_bearing
from cqdd_design.catalog.lubricants import RUNNING_TEMPERATURE
from cqdd_design.catalog.materials import Material, find_material
from cqdd_design.design import Design
from cqdd_design.gearbox.carrier import pin_of, tie_of
from cqdd_design.gearbox.contact import laws
from cqdd_design.gearbox.contact.laws import Bodies, CamSpring, LineLaw, LineModel
from cqdd_design.gearbox.film.of_design import ContactFilm, pin_film, tooth_film
from cqdd_design.gearbox.hertz import conformal_equivalent_radius, pair_modulus
from cqdd_design.gearbox.pin_beam import HELD, PinBeam, pin_in_stack, pin_section
from cqdd_design.gearbox.rolling_contacts import hole_friction, tooth_friction
from cqdd_design.gearbox.stages import Stages
from cqdd_design.geometry import kinematics
from cqdd_design.geometry.columns import column_offsets
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.geometry.cycloid import CycloidDisc
from cqdd_design.geometry.runners import Runner, pin_runner, ring_runner


class YieldingBodies(Protocol):
    """Discs and ring that give way: :class:`..bodies.compliance.ElasticBodies`."""

    def compliance(
        self,
        model: Any,
        states: Any,
        torque: float,
        tangential: FloatArray | None = None,
    ) -> FloatArray:
        """Closing (A, D, C, C) that contacts of a disc lose by unit forces of others, m/N.

        Parameters
        ----------
        model, states
            A :class:`ContactModel`, and the :class:`.states.NominalStates` of its perfect gearbox.
        torque : float
            On the carrier, N m.
        tangential : array (A, D, C), optional
            Force along the tangent over the normal force, signed.
        """
        ...


@dataclass(frozen=True, eq=False)
class ContactModel(Stages):
    """A gearbox as the contact equilibrium sees it: its stages and how they yield, SI.

    Attributes
    ----------
    disc : CycloidDisc
        Finished outline.
    ring_law, pin_law : LineLaw
        Law of either line contact.
    ring_bodies, pin_bodies : Bodies
        Of tooth and disc, and of pin and disc.
    pin_series : array (D,)
        Compliance of a pin at every disc, m/N, where plate and cap are one body and no disc's
        force reaches another: the state that every other starts from.
    cam : CamSpring
        Between bore and cam, of the bearing alone.
    tooth_friction, hole_friction : float
        Coulomb friction at ring teeth, and at the walls of the holes, as the design states it or
        without a film (:mod:`..rolling_contacts`).
    tooth_film, hole_film : ContactFilm or None
        What a film is made of there; None on needles.
    by_film : tuple of bool
        Whether the friction of teeth, and of holes, follows from the film.
    film_speed : float
        Speed of the crank at which it does unless asked otherwise, rad/s.
    carrier_stiffness : float or None
        Radial stiffness of the carrier's bearing, N/m; None where it is rigid.
    pin : PinBeam or None
        A pin between plate and cap, which turn apart; None where they are one body.
    pin_diameter : float
        Nominal, with which a pin's strength counts, m.
    tie : float
        Torque over turn between plate and cap by all but the pins, N m/rad.
    sleeve_play, roller_play : float
        Radial play of sleeves on output pins, and of rollers on the ring's, m; 0 without.
    sleeve_coefficient, roller_coefficient : float
        Between pin and sleeve or roller, the c of ``delta = c F^0.9``, N and m; 0 without.
    ring_pin_series : array (D, 1) or None
        Compliance at every disc of ring pins that rollers leave free between their ends, m/N.
    bodies : YieldingBodies or None
        Discs and ring, where plate and cap turn apart; None where they are rigid.
    pin_reach : float
        By how much further out pins stand than the middles of their holes, m: of a carrier that
        grew more than the discs.
    column_count : int
        Columns that pass through the discs, a divisor of the pins' number; 0 without.
    cam_support : float
        Compliance of what carries the cams, at a disc, m/N; 0 where it is rigid.
    """

    disc: CycloidDisc
    ring_law: LineLaw
    pin_law: LineLaw
    ring_bodies: Bodies
    pin_bodies: Bodies
    pin_series: FloatArray
    cam: CamSpring
    tooth_friction: float
    hole_friction: float
    tooth_film: ContactFilm | None = None
    hole_film: ContactFilm | None = None
    by_film: tuple[bool, bool] = (False, False)
    film_speed: float = 0.0
    carrier_stiffness: float | None = None
    pin: PinBeam | None = None
    pin_diameter: float = 0.0
    tie: float = 0.0
    sleeve_play: float = 0.0
    sleeve_coefficient: float = 0.0
    roller_play: float = 0.0
    roller_coefficient: float = 0.0
    ring_pin_series: FloatArray | None = None
    bodies: YieldingBodies | None = None
    pin_reach: float = 0.0
    column_count: int = 0
    cam_support: float = 0.0

    @classmethod
    def from_design(
        cls,
        design: Design,
        line_model: LineModel = "palmgren",
        temperature: float = RUNNING_TEMPERATURE,
    ) -> ContactModel:
        """Read a design that names its cam bearing; a sleeve is of the pin's material.

        Parameters
        ----------
        line_model : {"palmgren", "johnson", "linear"}
            Approach of teeth and pins. ``linear`` takes the secant of Palmgren's law at 50 N/mm.
        temperature : float
            Of the lubricant, deg C.

        Raises
        ------
        GeometryError
            When disc or holes cannot exist.
        UsageError
            When the lubricant does not work at the temperature.
        """
        reducer, pins = design.reducer, design.reducer.output_pins
        disc = CycloidDisc.from_design(design)
        stages = Stages.from_design(design)
        bearing = find_bearing(reducer.cam_bearing.designation)
        steel = find_material(reducer.disc_material)
        tooth = find_material(reducer.ring_material)
        pin = find_material(pins.material)
        housing = find_material(design.housing.material)
        runner, rollers = pin_runner(design), ring_runner(design)
        films = tooth_film(design, temperature), pin_film(design, temperature)
        supported = reducer.cam_bearing.support_stiffness
        behind_flank = disc.valley_distance - 0.5 * bearing.outer_diameter
        ring_bodies = (
            _body(stages.tooth_radius, tooth),
            _body(max(behind_flank, stages.tooth_radius), steel),
        )
        pin_bodies = (_body(stages.pin_contact_radius, pin), _body(stages.hole_radius, steel))
        # A pin that rollers leave free bends several times as far as its contact closes.
        ring_model = "linear" if rollers and line_model == "palmgren" else line_model
        logarithms = (0.0, 0.0)
        if line_model == "johnson":
            length = reducer.disc_thickness
            logarithms = (
                laws.johnson_coefficients(length, 1.0, stages.ring_modulus, ring_bodies)[1],
                laws.johnson_coefficients(length, 1.0, stages.pin_modulus, pin_bodies)[1],
            )
        return cls(
            **vars(stages),
            disc=disc,
            ring_law=LineLaw(ring_model, logarithms[0]),
            pin_law=LineLaw(line_model, logarithms[1]),
            ring_bodies=ring_bodies,
            pin_bodies=pin_bodies,
            pin_series=np.diag(pin_of(design, HELD[pins.support]).influence).copy(),
            cam=laws.cam_spring(bearing, reducer.cam_bearing.radial_clearance),
            tooth_friction=tooth_friction(design),
            hole_friction=hole_friction(design),
            tooth_film=films[0],
            hole_film=films[1],
            by_film=(
                reducer.friction.tooth == "film" and films[0] is not None,
                reducer.friction.pin == "film" and films[1] is not None,
            ),
            film_speed=design.requirements.input_speed,
            carrier_stiffness=reducer.carrier_bearing.stiffness or None,
            pin=pin_of(design),
            pin_diameter=pins.diameter,
            tie=tie_of(design),
            sleeve_play=0.0 if runner is None else 0.5 * runner.play,
            sleeve_coefficient=_inside(runner, pin),
            roller_play=0.0 if rollers is None else 0.5 * rollers.play,
            roller_coefficient=_inside(rollers, tooth),
            ring_pin_series=None if rollers is None else _ring_pin_series(design, tooth, housing),
            column_count=len(column_offsets(reducer)),
            cam_support=1.0 / supported if supported else 0.0,
        )

    @property
    def carried_cam(self) -> CamSpring:
        """Spring between a disc's bore and the housing: cam bearing, and what carries the cam.

        A support that yields makes it linear, the bearing by its secant at the line load that the
        linear law is made for. Each disc counts as carried by itself.
        """
        if self.cam_support == 0.0:
            return self.cam
        load = LINE_LOAD * self.contact_length
        secant = (load / self.cam.stiffness) ** (1.0 / self.cam.exponent) / load
        return CamSpring(1.0 / (secant + self.cam_support), 1.0, self.cam.play)

    @property
    def tooth_count(self) -> int:
        """Ring teeth n + 1."""
        return self.lobe_count + 1

    @property
    def period(self) -> float:
        """Crank angle after which a perfect gearbox repeats, holes for columns included, rad."""
        return kinematics.mesh_period(self.lobe_count, self.column_count or self.pin_count)

    @property
    def pin_gap(self) -> float:
        """Gap at an output pin in the nominal pose, m: half of the clearance of the hole.

        A sleeve's play opens it further: pin and hole can part by both. What `pin_reach` does is
        not in it, since that turns with the crank.
        """
        return self.hole_radius - self.pin_contact_radius - self.eccentricity + self.sleeve_play

    @property
    def pin_equivalent_radius(self) -> float:
        """R_eq of pin in hole, m."""
        return float(conformal_equivalent_radius(self.pin_contact_radius, self.hole_radius))

    def ring_coefficient(self, equivalent_radius: FloatArray) -> FloatArray:
        """Coefficient of the ring's law for contacts of the given R_eq (m)."""
        own = self._coefficient(
            self.ring_law, equivalent_radius, self.ring_modulus, self.ring_bodies
        )
        if self.ring_pin_series is None:
            return own
        # (D, 1) against (A, D, T): every disc has its place on the pins.
        return np.asarray(
            own
            + self._behind(self.ring_law, self.roller_coefficient, 0.9)
            + self._behind(self.ring_law, self.ring_pin_series, 1.0)
        )

    def pin_coefficient(self) -> float:
        """Coefficient of the pins' law, the contact of pin and sleeve in series."""
        radius = np.asarray(self.pin_equivalent_radius)
        own = float(self._coefficient(self.pin_law, radius, self.pin_modulus, self.pin_bodies))
        return own + float(self._behind(self.pin_law, self.sleeve_coefficient, 0.9))

    def _behind(self, law: LineLaw, coefficient: ArrayLike, power: float) -> FloatArray:
        """What gives as c F^power behind a contact, as a share of the contact's own coefficient.

        Exact where both are of one power; else by the secant at the line load that the linear law
        is made for.
        """
        own = 0.9 if law.model == "palmgren" else 1.0
        load = LINE_LOAD * self.contact_length
        return np.asarray(np.asarray(coefficient, dtype=float) * load ** (power - own))

    def _coefficient(
        self, law: LineLaw, equivalent_radius: FloatArray, modulus: float, bodies: Bodies
    ) -> FloatArray:
        if law.model == "johnson":
            return laws.johnson_coefficients(
                self.contact_length, equivalent_radius, modulus, bodies
            )[0]
        c = laws.palmgren_coefficient(self.contact_length, modulus)
        if law.model == "linear":
            # Palmgren's secant at a line load of 50 N/mm, a usual one at the rated torque.
            c *= (LINE_LOAD * self.contact_length) ** -0.1
        return np.full(np.shape(equivalent_radius), c)


LINE_LOAD = 50e3
"""Line load at which the linear law has Palmgren's secant stiffness, N/m."""


def _inside(runner: Runner | None, steel: Material) -> float:
    """Coefficient of the contact between a pin and what turns on it, of the same steel."""
    if runner is None:
        return 0.0
    own = laws.runner_coefficient(runner.cage, runner.length, pair_modulus(steel, steel))
    return own if runner.cage is None else float(own / runner.rows**0.9)


def _ring_pin_series(design: Design, pin: Material, housing: Material) -> FloatArray:
    """Compliance of a ring pin, held beyond the discs by housing and clamp, at every disc."""
    reducer = design.reducer
    beam = pin_in_stack(
        reducer.disc_count,
        reducer.disc_thickness,
        reducer.disc_spacing,
        pin_section(
            reducer.ring_pin_diameter,
            pin.youngs_modulus,
            pin.poisson_ratio,
            housing.youngs_modulus,
        ),
        ("hinged", "hinged"),
    )
    return np.diag(beam.influence)[:, None].copy()


def _body(depth: float, material: Material) -> tuple[float, float, float]:
    return depth, material.youngs_modulus, material.poisson_ratio
