"""Motors: winding, torque, size, drag. Rows at the output of a gearbox are comparison data."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

from cqdd_design.catalog.reader import column, find, read_records

_RPM = 2.0 * math.pi / 60.0

CONVENTIONS: dict[str, float] = {
    "dc": 1.0,
    "torque_per_peak": 0.5 * math.sqrt(3.0),
    "torque_per_rms": math.sqrt(1.5),
    "emf_line_peak": 1.0,
    "emf_line_rms": math.sqrt(0.5),
    "emf_phase_peak": math.sqrt(1.0 / 3.0),
    "emf_phase_rms": math.sqrt(1.0 / 6.0),
}
"""The constant of every convention over K: six-step DC or sinusoidal current, peak or r.m.s."""

DRAG = ("coulomb", "viscous", "hysteresis", "iron_loss")
"""Fields of a motor that say what it takes to turn it at a steady speed, no current flowing."""

COPPER_COEFFICIENT = 0.0039
"""Rise of copper's resistance per kelvin, at 25 deg C."""
COPPER_REFERENCE = 25.0
"""Temperature at which a catalogue's resistance holds, deg C."""
WINDING_MOST = 120.0
"""Winding, deg C: class E of IEC 60085, which enamelled wire and bonded magnets of robot motors
keep."""

_NEEDED = {
    "torque constant": "torque_constant",
    "resistance": "line_resistance",
    "rated torque": "rated_torque",
    "peak torque": "peak_torque",
    "rotor inertia": "rotor_inertia",
    "mass": "mass",
}


@dataclass(frozen=True)
class Motor:
    """A motor (``torque_at == "motor"``) or a whole geared actuator (``"output"``).

    Attributes
    ----------
    name, kind, torque_at : str
        Catalogue name; construction; where torque, current and speed are quoted.
    speed_constant : float or None
        No-load speed per volt, rad/s/V (KV).
    torque_constant_printed : float or None
        N*m/A as the source prints it (see `torque_constant`).
    torque_constant_convention : str
        Which of `CONVENTIONS` that is; empty where the source does not say its ampere.
    line_resistance, line_inductance : float or None
        Line to line, ohm and H; values of a phase are doubled, as in a star.
    pole_pairs, slots : int or None
        Number of pole pairs, and of the stator's slots.
    rotor_inertia, mass : float or None
        kg m^2 and kg. The rotor of an outrunner is its magnets in their cup, which is the bell;
        `scope` says what else a row counts.
    rated_torque, peak_torque, rated_current, peak_current : float or None
        N*m, A.
    rated_voltage, no_load_speed, no_load_current : float or None
        V, rad/s and A, as printed.
    coulomb, viscous : float or None
        What the motor alone, bearings and magnets, takes to turn: N*m independent of speed, and
        N*m*s/rad at its shaft. A measured value holds hysteresis and eddy currents too, which are
        then 0 in their own columns.
    hysteresis, iron_loss : float or None
        Magnetic drag where it is known apart: N*m, and N*m*s/rad from eddy currents.
    cogging_amplitude, cogging_order : float or None, int or None
        Amplitude (half of peak to peak), N*m, and periods in a turn: the least common multiple of
        slots and poles.
    drag_source, cogging_source : str
        Where drag and cogging come from, and what was decided about them.
    thermal_resistance, winding_limit : float or None
        Winding to ambient as the source measured it, K/W; greatest winding temperature, deg C.
    gear_ratio : float or None
        Of a geared actuator.
    outer_diameter, length, bore_diameter : float or None
        m; the bore is that of the stator, inside which the gearbox sits.
    hollow_diameter : float or None
        Hole through the rotor or shaft of another kind of motor, m.
    gap_diameter, stack_length, rotor_length, slot_depth : float or None
        Of the magnetic circuit, m: the air gap, the stator's laminations, the rotor's ring of
        magnets, the slots.
    bore_note : str
        How sure the bore is.
    scope : str
        What mass and inertia count, where the source says it.
    taken_over, taken_from : str
        Names of fields, with blanks between, that stand here by another row; that row.
    quality : str
        What the row rests on: datasheet, listing, measured, or quoted at second hand.
    source, note : str
        Where the row comes from; remarks.
    """

    name: str = column("name")
    kind: str = column("kind")
    torque_at: str = column("torque_at")
    speed_constant: float | None = column("kv_rpm_V", _RPM)
    torque_constant_printed: float | None = column("kt_Nm_A")
    torque_constant_convention: str = column("kt_convention")
    line_resistance: float | None = column("r_ll_ohm")
    line_inductance: float | None = column("l_ll_uH", 1e-6)
    pole_pairs: int | None = column("pole_pairs")
    slots: int | None = column("slots")
    rotor_inertia: float | None = column("rotor_J_kgm2")
    mass: float | None = column("mass_kg")
    rated_torque: float | None = column("t_rated_Nm")
    peak_torque: float | None = column("t_peak_Nm")
    rated_current: float | None = column("i_rated_A")
    peak_current: float | None = column("i_peak_A")
    rated_voltage: float | None = column("volt_V")
    no_load_speed: float | None = column("noload_rpm", _RPM)
    no_load_current: float | None = column("noload_A")
    coulomb: float | None = column("coulomb_Nm")
    viscous: float | None = column("viscous_Nms_rad")
    hysteresis: float | None = column("hysteresis_Nm")
    iron_loss: float | None = column("iron_Nms_rad")
    cogging_amplitude: float | None = column("cogging_Nm")
    cogging_order: int | None = column("cogging_order")
    drag_source: str = column("drag_source")
    cogging_source: str = column("cogging_source")
    thermal_resistance: float | None = column("thermal_K_W")
    winding_limit: float | None = column("winding_max_C")
    gear_ratio: float | None = column("ratio")
    outer_diameter: float | None = column("od_mm", 1e-3)
    length: float | None = column("len_mm", 1e-3)
    bore_diameter: float | None = column("bore_mm", 1e-3)
    hollow_diameter: float | None = column("hollow_mm", 1e-3)
    gap_diameter: float | None = column("gap_mm", 1e-3)
    stack_length: float | None = column("stack_mm", 1e-3)
    rotor_length: float | None = column("rotor_mm", 1e-3)
    slot_depth: float | None = column("slot_mm", 1e-3)
    bore_note: str = column("bore_note")
    scope: str = column("scope")
    taken_over: str = column("taken_over")
    taken_from: str = column("taken_from")
    quality: str = column("quality")
    source: str = column("source")
    note: str = column("note")

    @property
    def torque_constant(self) -> float | None:
        """Torque per DC (six-step) ampere, 1/KV in SI.

        Without KV the printed constant in its convention; None where that is not said.
        """
        if self.speed_constant:
            return 1.0 / self.speed_constant
        if self.torque_constant_printed is None or not self.torque_constant_convention:
            return None
        return self.torque_constant_printed / CONVENTIONS[self.torque_constant_convention]

    @property
    def lacks_drag(self) -> bool:
        """Whether nothing is known of what the motor alone takes to turn."""
        return all(getattr(self, name) is None for name in DRAG)

    @property
    def missing(self) -> tuple[str, ...]:
        """What the row lacks of a motor that is simulated and drawn, in words."""
        if self.torque_at != "motor":
            return ()
        lacking = [what for what, field in _NEEDED.items() if not getattr(self, field)]
        if self.lacks_drag:
            lacking.append("drag")
        if self.cogging_amplitude is None:
            lacking.append("cogging")
        if self.bore_diameter is None and "inrunner" not in self.kind:
            lacking.append("stator bore")
        return tuple(lacking)

    def told_by(self, field: str) -> str:
        """The row that gives a field, in words: this one, or the one that it is taken over from."""
        if field in self.taken_over.split():
            return f"{self.name}, taken over from {self.taken_from}"
        return self.name


@functools.lru_cache(maxsize=1)
def motors() -> dict[str, Motor]:
    """All motors by name, in file order."""
    return {one.name: one for one in read_records("motors.csv", Motor)}


def find_motor(name: str) -> Motor:
    """The motor called `name`.

    Raises
    ------
    CatalogError
        With the nearest names, when there is none.

    Examples
    --------
    >>> find_motor("CubeMars RO100 KV55").peak_torque
    12.0
    """
    return find(name, motors(), "motor")
