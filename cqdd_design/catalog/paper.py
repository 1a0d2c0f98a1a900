"""Every figure of the paper that this package stands beside, once, with its place there.

S. Zhu, Y. Tanaka, A. Rafeedi and D. Hong, "Cycloidal Quasi-Direct Drive Actuator Designs with
Learning-based Torque Estimation for Legged Robotics", arXiv:2410.16591 (2024). SI units, but for
the table of measurements, which has those of the virtual test bench.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

SOURCE = "Zhu, Tanaka, Rafeedi and Hong 2024, arXiv:2410.16591"


class Figure(NamedTuple):
    """A printed value.

    Attributes
    ----------
    place : str
        Where the paper has it.
    spread : float or None
        Printed behind a plus-minus.
    """

    value: float
    place: str
    spread: float | None = None


_TABLE = "table I"
_PEAK = Figure(89.9, f"{_TABLE}, section V-A: measured at an output held still")
METRICS: Mapping[str, Figure] = MappingProxyType(
    {
        "continuous_torque": Figure(37.5, f"{_TABLE}, section V-A"),
        # What was measured is what a stalled output gives; the identity K I n has it as its limit.
        "peak_torque": _PEAK,
        "stall_torque": _PEAK,
        "no_load_speed": Figure(128.6, f"{_TABLE}, at 24 V"),
        "rated_power": Figure(960.0, _TABLE),
        "output_resolution": Figure(0.00219, _TABLE),
        "efficiency_peak": Figure(0.823, f"{_TABLE}, section V-A"),
        "torque_density": Figure(64.2, "table II; table I prints 64.21"),
        "actuator_inertia": Figure(5.01e-4, _TABLE),
        "mass": Figure(1.40, _TABLE),
        "backlash": Figure(7.03, f"{_TABLE}; section V-B prints 7.0", 1.3),
        "backdrive_static": Figure(1.99, f"{_TABLE}, section V-B"),
        "backdrive_dynamic": Figure(1.36, f"{_TABLE}, section V-B"),
        "torque_ripple": Figure(1.5, f"{_TABLE}, half of the swing"),
        "torque_bandwidth": Figure(34.3, f"{_TABLE}, section V-A, at 5 N m"),
        "position_bandwidth_45deg": Figure(3.3, _TABLE),
        "position_bandwidth_5deg": Figure(22.13, _TABLE),
    }
)
"""What was measured of the actuator, in the units of the virtual test bench."""
SUPPLY_VOLTAGE = 24.0
"""Of the speed without load, V (table I)."""


RATIO = 10
"""Table I, and of the planetary, section III-A."""


class Compared(NamedTuple):
    """One column of the paper's comparison; torque density as it prints it, N m/kg."""

    name: str
    gearing: str
    ratio: float
    peak_torque: float
    mass: float
    torque_density: str
    efficiency: float | None


COMPARISON: tuple[Compared, ...] = (
    Compared(
        "C-QDD (paper)",
        "cycloid",
        float(RATIO),
        METRICS["peak_torque"].value,
        METRICS["mass"].value,
        "64.2",
        METRICS["efficiency_peak"].value,
    ),
    Compared("BEAR", "planetary", 10.0, 32.0, 0.670, "47.7", None),
    Compared("PULSE115-60", "planetary", 5.0, 62.5, 1.25, "50", None),
    Compared("Lee et al.", "cycloid", 11.0, 155.32, 1.85, "83.7", 0.9),
)
"""Table II: N m, kg, N m/kg."""

PEAK_TORQUE, CONTINUOUS_TORQUE = 120.0, 40.0
"""Loads that the gearing was sized for, N m (section III-A)."""
PIN_TORQUE, PINS_TORQUE = 59.13, 295.65
"""Capacity of one output pin and of all, N m (section III-A)."""
PLANETARY_TEETH = (12, 36, 22, 70)
"""Sun, both planets, ring of the compound planetary (section III-A)."""
PLANETARY_MODULE, PLANETARY_FACE_WIDTH, PLANETARY_PLANETS = 1e-3, 12e-3, 6
"""m, m, and how many it is said to need (section III-A)."""


class Estimated(NamedTuple):
    """A torque network as measured on the paper's hardware: N m, N^2 m^2 and us.

    `model` is our name of it. The variance is printed in N m; by its meaning it is a square.
    """

    model: str
    title: str
    rmse: float
    variance: float
    cycle_time: float

    @property
    def bias(self) -> float | None:
        """Size of the bias that the other two imply, N m; None where they contradict."""
        square = self.rmse**2 - self.variance
        return square**0.5 if square >= 0.0 else None

    def cells(self, none: str) -> list[str]:
        """Title, RMSE, bias, variance and cycle time as text; `none` where there is no bias."""
        numbers = (self.rmse, self.bias, self.variance, self.cycle_time)
        return [self.title, *(none if one is None else f"{one:.2f}" for one in numbers)]


NETWORKS_SOURCE = "C-QDD paper, Table III and section IV-A (hardware)"
NETWORKS: tuple[Estimated, ...] = (
    Estimated("pva-gru", "PVA-GRU", 0.97, 0.92, 1.49),
    Estimated("pv-gru", "PV-GRU", 1.00, 0.85, 3.10),
    Estimated("mlp", "MLP (tuned)", 1.71, 2.90, 0.72),
    Estimated("mlp-baseline", "MLP (baseline)", 2.46, 3.62, 0.22),
)
"""To stand beside ours, never to be read against them: of hardware that nobody here has."""

ACTUATOR: Mapping[str, float | str] = MappingProxyType(
    {
        "reducer.ratio": RATIO,
        # Section III-C.
        "reducer.ring_type": "solid",
        # Section III-B: two discs for an even ratio.
        "reducer.disc_count": 2,
        # Section III-A; count and diameter follow from the capacities printed.
        "reducer.output_pins.circle_radius": 19.5e-3,
        "reducer.output_pins.count": round(PINS_TORQUE / PIN_TORQUE),
        "reducer.output_pins.diameter": 4e-3,
        # Not printed: Z_r, Z_e and Z_p as this package assumes them, see designs/cqdd-10.toml.
        "reducer.ring_pitch_radius": 32e-3,
        "reducer.eccentricity": 1.6e-3,
        "reducer.ring_pin_diameter": 7e-3,
        # By 24 V x 55 rpm/V, 12 N m x 10 and its maker's driver (section V-A).
        "motor.name": "CubeMars RO100",
        # 89.9 N m over ten times 0.178 N m/A, which 128.6 rpm at 24 V stand for (table I).
        "motor.current_limit": 50.5,
    }
)
"""What makes a design the paper's actuator: dotted keys, SI; a motor's name by its beginning.

Clearances, tolerances, friction and cooling are not among them: the paper prints none, and they are
what a user fits.
"""

CASE: Mapping[str, float | str] = MappingProxyType(
    {
        **ACTUATOR,
        "name": "cqdd-10",
        "requirements.ratio": RATIO,
        "requirements.peak_torque": PEAK_TORQUE,
        "requirements.continuous_torque": CONTINUOUS_TORQUE,
        "requirements.input_speed": RATIO * METRICS["no_load_speed"].value * math.pi / 30.0,
        # Of both RO100 the one that the whole actuator's mass and inertia allow.
        "motor.name": "CubeMars RO100 Lite KV55",
        # 4140 alloy steel (section III-C), its temper not printed; 18-8 screws (section III-A).
        "reducer.disc_material": "AISI 4140 Q&T 540C",
        "reducer.ring_material": "AISI 4140 Q&T 540C",
        "reducer.output_pins.material": "18-8 shoulder screw (seed-consistent)",
        # Not printed, as in designs/cqdd-10.toml.
        "reducer.cam_bearing.designation": "6902",
        "reducer.carrier.joint": "hinged",
        "reducer.ring.outer_diameter": 72e-3,
        "reducer.friction.tooth": 0.08,
        "reducer.friction.pin": 0.08,
        "drive.thermal_resistance": 1.2,
    }
)
"""The paper's actuator with the loads it was sized for: what its claims are judged on."""


def is_papers_actuator(design: object) -> bool:
    """Whether a design is that of the paper's actuator, whatever it is called.

    Parameters
    ----------
    design : Design
        Whose keys of `ACTUATOR` are compared.
    """
    for key, wanted in ACTUATOR.items():
        found: object = design
        for part in key.split("."):
            found = getattr(found, part)
        if isinstance(wanted, str):
            same = str(found).startswith(wanted)
        else:
            same = math.isclose(float(found), wanted, rel_tol=1e-9)  # type: ignore[arg-type]
        if not same:
            return False
    return True
