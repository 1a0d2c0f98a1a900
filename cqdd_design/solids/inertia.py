"""Mass and inertia of the whole gearbox, and what the motor feels of it.

With the crank at speed w, perfect parts move so::

    shaft, cams          spin at w
    disc d               centre runs round at w on radius e, spins at -w/n
    carrier and its pins spin at -w/n
    ring, housing        stand still

so the kinetic energy 1/2 J w^2 has ``J = J_rotor + J_shaft + sum(m_disc e^2 + J_disc/n^2) +
J_carrier/n^2``, the reflected inertia at the input; at the output it is n^2 times that. A rolling
bearing counts half to each of its rings, divided at the pitch circle.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from cqdd_design.catalog.motors import Motor
from cqdd_design.design import Design
from cqdd_design.geometry.contours import FloatArray
from cqdd_design.results import MassProperties
from cqdd_design.solids import counterweights
from cqdd_design.solids.mesh import mass_properties, mesh_volume
from cqdd_design.solids.motor_rules import drawn_motor, light_rotor
from cqdd_design.solids.part import Instance, Part
from cqdd_design.solids.poses import Body

MassSource = Callable[[Part], MassProperties]

ROTOR, BELL, HUB = "motor rotor", "rotor bell", "rotor hub"
ROTOR_PARTS = (ROTOR, BELL)
"""The rotor of an outrunner: magnets, and the cup that carries them. A catalogue's inertia and mass
of a motor count both, so both stand for it together and neither comes on top."""


def rotor_scope(motor: Motor) -> str:
    """What a catalogue's inertia of a rotor counts beside its magnets, in words."""
    return "without the hub that carries it" if motor.is_inrunner else "its bell included"


GROUPS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "motor": (*ROTOR_PARTS, "motor stator"),
        "cover and encoder": (
            "motor cover",
            "encoder magnet",
            "encoder board",
            *counterweights.NAMES,
        ),
        "discs and ring": (
            "disc",
            "disc 1",
            "disc 2",
            "disc 3",
            "ring",
            "ring pin",
            "ring roller",
            "ring needle cage",
        ),
        "shaft and bearings": (
            "eccentric shaft",
            "eccentric cam",
            HUB,
            "cam bearing",
            "shaft bearing",
            "output bearing",
        ),
        "carrier": (
            "carrier plate",
            "carrier cap",
            "carrier column",
            "column screw",
            "bearing nut",
            "shaft shim",
            "shoulder screw",
            "dowel pin",
            "pin sleeve",
            "pin needle cage",
        ),
        "housing": ("housing", "ring clamp", "output cover", "output shim"),
        "fasteners": (),
    }
)
"""Parts by what they belong to; what is not named is a fastener."""


def group_of(part: str) -> str:
    """Group of a part of this name."""
    return next((group for group, names in GROUPS.items() if part in names), "fasteners")


@dataclass(frozen=True)
class PartInertia:
    """Mass properties of one part.

    Attributes
    ----------
    count : int
        Pieces in the machine.
    volume, exact_volume : float
        Of one piece, from its mesh and in closed form, m^3.
    properties : MassProperties
        Of the first piece in the ring's frame at crank angle 0.
    reflected : float
        Share of all pieces in the inertia at the input, kg m^2.
    catalogue_mass : bool
        Whether the mass is the catalogue's, not volume times density.
    """

    name: str
    material: str
    count: int
    volume: float
    exact_volume: float
    properties: MassProperties
    reflected: float
    catalogue_mass: bool

    def to_dict(self) -> dict[str, object]:
        """The JSON form: volume, mass, centre and inertia are those of one piece."""
        own = self.properties
        return {
            "name": self.name,
            "material": self.material,
            "count": self.count,
            "volume_mm3": self.volume * 1e9,
            "mass_kg": own.mass,
            "centre_of_mass_mm": [float(c) * 1e3 for c in own.centre],
            "inertia_kgm2": [[float(v) for v in row] for row in own.inertia],
            "exact_volume_mm3": self.exact_volume * 1e9,
            "reflected_inertia_input_kgm2": self.reflected,
            "mass_from_catalogue": self.catalogue_mass,
        }


@dataclass(frozen=True)
class GearboxInertia:
    """Mass properties of a gearbox.

    Attributes
    ----------
    total : MassProperties
        All pieces drawn, at crank angle 0 in the ring's frame; the motor is one where it is drawn.
    ratio : int
        n.
    motor_missing : str
        Why the motor is not among the parts; empty where it is.
    """

    parts: tuple[PartInertia, ...]
    total: MassProperties
    ratio: int
    motor: Motor
    motor_missing: str

    @property
    def rotor_inertia(self) -> float | None:
        """Of the motor as its data have it, kg m^2; None where they do not say."""
        return self.motor.rotor_inertia

    @property
    def motor_by_catalogue(self) -> float | None:
        """Mass of a motor that is not drawn, kg; None where it is drawn or not known."""
        return self.motor.mass if self.motor_missing else None

    @property
    def mass(self) -> float:
        """Mass of the actuator as far as it is known, kg: `mass_scope` says how far."""
        return self.total.mass + (self.motor_by_catalogue or 0.0)

    @property
    def whole_mass(self) -> float | None:
        """Mass of the actuator with its motor, kg; None where the motor's is not known."""
        unknown = self.motor_missing and self.motor_by_catalogue is None
        return None if unknown else self.mass

    @property
    def mass_scope(self) -> str:
        """What `mass` counts, in words."""
        motor = f"{self.motor.name} {self._by('mass')}, stator and rotor, {rotor_scope(self.motor)}"
        if not self.motor_missing:
            return (
                f"gearbox{self._carrier}, housing, cover and encoder as drawn, and {motor}, "
                f"{self.group_masses['motor']:.4g} kg"
            )
        drawn = f"gearbox{self._carrier} and housing as drawn, {self.total.mass:.4g} kg"
        if self.motor_by_catalogue is None:
            return f"{drawn}; without the motor, cover and encoder, which are not drawn"
        return (
            f"{drawn}, and {motor}, {self.motor_by_catalogue:.4g} kg; without cover and encoder, "
            "which are not drawn"
        )

    @property
    def _carrier(self) -> str:
        """Of what the carrier is, where it is not of what the housing is."""
        of = {one.name: one.material for one in self.parts}
        plate = of.get("carrier plate")
        return "" if plate in (None, of.get("housing")) else f" with a carrier of {plate}"

    def _by(self, field: str) -> str:
        return "as stated" if field in self.motor.stated else "by its catalogue"

    @property
    def crank_scope(self) -> str:
        """What `gearbox_reflected` counts, in words."""
        if self.motor.is_inrunner:
            return "gearbox as drawn, with the rotor's hub and without the motor's rotor"
        return "gearbox as drawn, without the motor's rotor and its bell"

    @property
    def inertia_scope(self) -> str:
        """What `reflected_input` counts, in words."""
        scope = f"{rotor_scope(self.motor)}, and gearbox as drawn"
        if self.rotor_inertia is not None:
            return f"rotor {self._by('rotor_inertia')}, {scope}"
        if self.rotor_drawn > 0.0:
            return f"rotor, {scope}"
        return f"not known: neither is the inertia of the rotor of {self.motor.name}"

    @property
    def rotor_drawn(self) -> float:
        """Inertia of the rotor's solids, magnets and bell, kg m^2; 0 where it is not drawn."""
        return sum(part.reflected for part in self.parts if part.name in ROTOR_PARTS)

    @property
    def gearbox_reflected(self) -> float:
        """Inertia at the input without the motor's rotor and its bell, kg m^2."""
        return sum(part.reflected for part in self.parts if part.name not in ROTOR_PARTS)

    @property
    def reflected_input(self) -> float | None:
        """Inertia at the input, rotor included, kg m^2; None where the rotor's is not known."""
        rotor = self.rotor_drawn or self.rotor_inertia
        return self.gearbox_reflected + rotor if rotor else None

    @property
    def group_masses(self) -> dict[str, float]:
        """Share of every group of parts in `mass`, kg: motor, gears, housing and so on."""
        masses = dict.fromkeys(GROUPS, 0.0) | {"motor": self.motor_by_catalogue or 0.0}
        for part in self.parts:
            masses[group_of(part.name)] += part.count * part.properties.mass
        return {name: mass for name, mass in masses.items() if mass > 0.0}

    @property
    def group_inertias(self) -> dict[str, float | None]:
        """Share of every group in the inertia at the input, kg m^2; None of a rotor not known."""
        shares = dict.fromkeys(self.group_masses, 0.0)
        for part in self.parts:
            shares[group_of(part.name)] += part.reflected
        if not self.motor_missing:
            return {**shares}
        return {**shares, **({"motor": self.rotor_inertia} if "motor" in shares else {})}

    @property
    def reflected_output(self) -> float | None:
        """Inertia at the output, n^2 times that at the input, kg m^2."""
        return None if self.reflected_input is None else self.ratio**2 * self.reflected_input

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the figures leave out."""
        found = []
        if self.motor_missing:
            found.append(f"the motor is not drawn: {self.motor_missing}. Mass: {self.mass_scope}.")
        if light := light_rotor(self.motor):
            found.append(f"{light}.")
        if self.rotor_inertia is None:
            found.append(
                f"the rotor inertia of {self.motor.name} is not known; "
                + (
                    "that of the rotor as drawn is used."
                    if self.rotor_drawn > 0.0
                    else "the reflected inertia is not either: give rotor_inertia in [motor] or "
                    "with --motor-file, or name a motor that has it."
                )
            )
        return tuple(found)

    def to_dict(self) -> dict[str, object]:
        """The JSON form (``results`` of ``inertia``, without ``balance``)."""
        return {
            "parts": [part.to_dict() for part in self.parts],
            "total_mass_kg": self.whole_mass,
            "total_mass_scope": self.mass_scope,
            "drawn_mass_kg": self.total.mass,
            "motor_mass_from_catalogue_kg": self.motor_by_catalogue,
            "centre_of_mass_mm": [float(c) * 1e3 for c in self.total.centre],
            "motor_included": not self.motor_missing,
            "group_mass_kg": self.group_masses,
            "group_reflected_inertia_input_kgm2": self.group_inertias,
            "rotor_inertia_kgm2": self.rotor_inertia,
            "gearbox_reflected_inertia_input_kgm2": self.gearbox_reflected,
            "reflected_inertia_input_kgm2": self.reflected_input,
            "reflected_inertia_output_kgm2": self.reflected_output,
            "reflected_inertia_scope": self.inertia_scope,
        }


def gearbox_inertia(
    design: Design, motor: Motor, parts: Sequence[Part], source: MassSource = mass_properties
) -> GearboxInertia:
    """Compose the mass properties of all pieces.

    Parameters
    ----------
    parts : sequence of Part
        From `build_parts`.
    source : callable
        Mass properties of one piece in its own frame: `mass_properties` (from meshes, needs
        CadQuery) or `closed_form`.
    """
    rows = []
    total = MassProperties(0.0)
    meshed = source is mass_properties
    for part in parts:
        own = source(part)
        placed = [_in_machine(design, own, piece) for piece in part.instances]
        for one in placed:
            total = total + one
        rows.append(
            PartInertia(
                name=part.name,
                material=part.material,
                count=part.count,
                volume=mesh_volume(part) if meshed else part.volume,
                exact_volume=part.exact_volume,
                properties=placed[0],
                reflected=sum(_reflected(design, part, own, piece) for piece in part.instances),
                catalogue_mass=part.catalogue_mass is not None,
            )
        )
    drawn = any(part.name == ROTOR for part in parts)
    return GearboxInertia(
        parts=tuple(rows),
        total=total,
        ratio=design.reducer.ratio,
        motor=motor,
        motor_missing="" if drawn else _why(motor),
    )


def _why(motor: Motor) -> str:
    """Why the parts hold no motor."""
    return drawn_motor(motor)[1] or f"{motor.name} leaves no room for a hub on a shaft of this size"


def closed_form(part: Part) -> MassProperties:
    """Mass properties of one piece from exact integrals, without CadQuery."""
    return part.exact_properties


def _along_axis(height: float) -> FloatArray:
    return np.array([0.0, 0.0, height])


def _in_machine(design: Design, own: MassProperties, piece: Instance) -> MassProperties:
    pose = piece.pose(design)
    return own.moved(pose[:3, 3], pose[:3, :3])


def _spin(design: Design, body: Body) -> float:
    """Speed of a body over that of the crank."""
    speeds = {"shaft": 1.0, "carrier": -1.0 / design.reducer.ratio, "housing": 0.0}
    return speeds.get(body.kind, -1.0 / design.reducer.ratio)


def _reflected(design: Design, part: Part, own: MassProperties, piece: Instance) -> float:
    """Inertia that one piece adds at the input, kg m^2."""
    orbit = design.reducer.eccentricity if piece.body.kind == "disc" else 0.0
    # In the body's frame the spin axis is the z axis.
    placed = own.moved(piece.placement[:3, 3], piece.placement[:3, :3])
    about_axis = float(placed.inertia_about(_along_axis(placed.centre[2]))[2, 2])
    outer = _spin(design, piece.body) ** 2
    if part.inner_body is None:
        return about_axis * outer + own.mass * orbit**2
    inner_share = _inner_ring_share(part)
    inner = _spin(design, part.inner_body) ** 2
    spin = about_axis * (inner_share * inner + (1.0 - inner_share) * outer)
    return spin + own.mass * orbit**2


def _inner_ring_share(part: Part) -> float:
    """Share of a bearing's polar inertia inside its pitch circle."""
    inner, outer = part.shape.inside_radius, part.shape.outside_radius
    pitch = 0.5 * (inner + outer)
    return (pitch**4 - inner**4) / (outer**4 - inner**4)
