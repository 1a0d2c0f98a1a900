"""Random gearboxes for the contact tests, and a contact model as the oracles' plain numbers."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from backlash_oracle import Rigid
from contact_oracle import Faults, Machine, Spring, johnson, linear, palmgren
from hypothesis import assume
from hypothesis import strategies as st

from cqdd_design.catalog.bearings import bearings
from cqdd_design.design import Design, load_design
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.part_errors import GearboxErrors
from cqdd_design.geometry.trochoid import undercut_radius_limit

PAPER_FILE = Path(__file__).resolve().parents[2] / "designs" / "cqdd-10.toml"
PIN_DIAMETERS = (2e-3, 3e-3, 4e-3, 5e-3, 6e-3, 8e-3, 10e-3)
ARCMIN = math.pi / 180.0 / 60.0


def paper_design() -> Design:
    """The paper's actuator."""
    return load_design(PAPER_FILE)


def peer_design(**changes: object) -> Design:
    """R 40, r 3, e 1.5, n 10, two discs, 6 pins of 8 mm on R 23: the case of the notes."""
    reducer = {
        "ratio": 10,
        "ring_pitch_radius": 0.040,
        "eccentricity": 0.0015,
        "ring_pin_diameter": 0.006,
        "disc_thickness": 0.008,
        "output_pins": {
            "count": 6,
            "diameter": 0.008,
            "circle_radius": 0.023,
            "hole_clocking": 0.0,
        },
        "cam_bearing": {"designation": "6904"},
    }
    return Design.from_mapping({"reducer": reducer | changes}, si=True)


@st.composite
def contact_designs(
    draw: st.DrawFn,
    *,
    modified: bool = True,
    clearances: bool = True,
    most_lobes: int = 30,
    disc_counts: tuple[int, ...] = (1, 2, 3),
) -> Design:
    """Gearboxes that exist: 4 to 30 lobes, 3 to 12 pins, one to three discs, every clearance.

    `modified` False leaves the equidistant offset as the only modification, so that every ring
    normal passes through the pitch point.
    """
    n = draw(st.integers(4, most_lobes))
    R = draw(st.floats(0.02, 0.08))
    e = draw(st.floats(0.3, 0.85)) * R / (n + 1)
    most = min(float(undercut_radius_limit(n, R, e)), R * math.sin(math.pi / (n + 1)))
    r = draw(st.floats(0.3, 0.85)) * most
    thickness = draw(st.floats(0.1, 0.3)) * R
    diameter = draw(st.sampled_from([d for d in PIN_DIAMETERS if 0.08 * R < d < 0.16 * R]))
    sleeve = draw(st.sampled_from([0.0, 0.0, diameter + 1.5e-3]))
    hole = (sleeve or diameter) + 2.0 * e
    rated = [
        row
        for row in bearings().values()
        if row.kind in {"ball", "needle"}
        and row.width <= thickness
        and row.outer_diameter + 2.0 * hole + 4e-3 < 2.0 * (R - r - e)
    ]
    assume(rated)
    bearing = draw(st.sampled_from(rated))
    least = bearing.outer_diameter / 2.0 + hole / 2.0 + 1e-3
    farthest = R - r - e - hole / 2.0 - 1e-3
    assume(least < farthest)
    circle = least + (farthest - least) * draw(st.floats(0.0, 1.0))
    fits = int(math.pi / math.asin(min(1.0, (hole + 1e-3) / (2.0 * circle))))
    assume(fits >= 3)
    # Whole tenths of a micron, zero among them; never more than a twentieth of the throw.
    widest = int(min(300.0, 0.05 * e * 1e7))
    gap = st.integers(0, widest if clearances else 0).map(lambda tenths: tenths * 1e-7)
    change = gap if modified else st.just(0.0)
    small = 0.05 * (most - r)
    reducer = {
        "ratio": n,
        "ring_pitch_radius": R,
        "eccentricity": e,
        "ring_pin_diameter": 2.0 * r,
        "disc_count": draw(st.sampled_from(disc_counts)),
        "disc_thickness": thickness,
        "modification": {
            "equidistant": min(draw(gap), small),
            "radial": min(draw(change), small),
            "rotation": draw(st.sampled_from([0.0, 0.0, 3e-4, 1.5e-3])) / n if modified else 0.0,
        },
        "output_pins": {
            "count": draw(st.integers(3, min(fits, 12))),
            "diameter": diameter,
            "sleeve_diameter": sleeve,
            "sleeve_play": draw(gap),
            "circle_radius": circle,
            "hole_clocking": draw(st.floats(0.0, 2.0)),
            "hole_clearance": draw(gap),
            "support": draw(st.sampled_from(["both", "cantilever"])),
        },
        "cam_bearing": {
            "designation": bearing.designation,
            "radial_clearance": draw(gap),
        },
    }
    return Design.from_mapping({"reducer": reducer}, si=True)


@st.composite
def torques(draw: st.DrawFn, low: float = 1e-6, high: float = 1e3) -> float:
    """Both senses, evenly over the decades, N m."""
    return draw(st.sampled_from([1.0, -1.0])) * 10.0 ** draw(
        st.floats(math.log10(low), math.log10(high))
    )


def usual_torque(model: ContactModel, strain: float = 1.0) -> float:
    """A torque that loads a gearbox of this size about as the paper's is at 40 N m, N m."""
    return strain * 5e6 * model.disc.ring_pitch_radius**2 * model.contact_length


def random_errors(
    model: ContactModel, rng: np.random.Generator, size: float = 3e-6, harmonics: int = 12
) -> GearboxErrors:
    """Normal errors of this standard deviation on every feature."""
    D, P, teeth = model.disc_count, model.pin_count, model.lobe_count + 1

    def normal(*shape: int) -> np.ndarray:
        return size * rng.normal(size=shape)

    return GearboxErrors(
        tooth_position=normal(teeth, 2),
        tooth_radius=normal(teeth),
        disc_profile=normal(D, 2, harmonics) / math.sqrt(harmonics),
        hole_position=normal(D, P, 2),
        hole_radius=normal(D, P),
        pin_position=normal(P, 2),
        pin_radius=normal(P),
        cam_centre=normal(D, 2),
        # A bearing keeps a play, whatever its ring is pressed into.
        cam_play=np.maximum(normal(D), -model.cam.play),
        output_axis=normal(2),
    )


def machine_of(model: ContactModel, errors: GearboxErrors | None = None) -> Machine:
    """The model's numbers with the oracle's own springs."""

    def modulus(bodies: tuple[tuple[float, float, float], ...]) -> float:
        return 1.0 / sum((1.0 - nu * nu) / E for _, E, nu in bodies)

    def spring(
        kind: str,
        bodies: tuple[tuple[float, float, float], tuple[float, float, float]],
        radius: np.ndarray,
        series: float,
        inside: float = 0.0,
    ) -> Spring:
        b = model.contact_length
        # The secant of Palmgren's law at 50 N/mm.
        load = 50.0 * 1e3 * b
        secant = 3.84e-8 / (1e3 * b) ** 0.8 * load**-0.1
        if kind == "johnson":
            (d1, E1, nu1), (d2, E2, nu2) = bodies
            more = series + inside * secant
            return johnson(b, radius, ((E1, nu1, d1), (E2, nu2, d2)), more)
        softness = steel / modulus(bodies) + inside
        if kind == "palmgren":
            return palmgren(b, series, softness)
        return linear(1.0 / (secant * softness), series)

    # A plain sleeve is one more line contact, of the pin's steel on itself.
    steel = 206e9 / (2.0 * (1.0 - 0.3**2))
    pin = (model.pin_bodies[0], model.pin_bodies[0])
    inside = steel / modulus(pin) if model.sleeve_coefficient else 0.0

    between = 1.0 / (1.0 / model.pin_contact_radius - 1.0 / model.hole_radius)
    return Machine(
        disc=model.disc,
        disc_count=model.disc_count,
        pin_count=model.pin_count,
        pin_circle_radius=model.pin_circle_radius,
        clocking=model.hole_clocking,
        hole_radius=model.hole_radius + model.sleeve_play,
        pin_radius=model.pin_contact_radius,
        ring_spring=lambda radius: spring(model.ring_law.model, model.ring_bodies, radius, 0.0),
        pin_springs=tuple(
            spring(model.pin_law.model, model.pin_bodies, np.asarray(between), float(c), inside)
            for c in model.pin_series
        ),
        cam_stiffness=model.cam.stiffness,
        cam_exponent=model.cam.exponent,
        cam_play=model.cam.play,
        carrier_stiffness=model.carrier_stiffness,
        faults=faults_of(errors),
    )


def faults_of(errors: GearboxErrors | None) -> Faults:
    """Part errors as the oracles take them."""
    if errors is None:
        return Faults()
    return Faults(
        **{name: np.asarray(getattr(errors, name)) for name in Faults.__dataclass_fields__}
    )


def rigid_of(model: ContactModel, errors: GearboxErrors | None = None) -> Rigid:
    """The model as rigid bodies."""
    return Rigid(
        disc=model.disc,
        disc_count=model.disc_count,
        pin_count=model.pin_count,
        pin_circle_radius=model.pin_circle_radius,
        clocking=model.hole_clocking,
        hole_radius=model.hole_radius + model.sleeve_play,
        pin_radius=model.pin_contact_radius,
        cam_play=model.cam.play,
        faults=faults_of(errors),
    )
