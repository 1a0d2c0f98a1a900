"""Motors: winding, torque, size, drag. Rows at the output of a gearbox are comparison data."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

from cqdd_design.catalog.reader import column, find, read_records
from cqdd_design.errors import DesignError

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
MAGNET_COEFFICIENT = 0.0011
"""Fall of the flux of NdFeB per kelvin (remanence of common grades: 0.09 to 0.12 % a kelvin)."""
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
    stated : tuple of str
        Names of the fields that a design or a motor file says of this motor; none of a catalogue's
        own row.
    stated_in : str
        Where it says so, in words.
    based_on : str
        The catalogue's row that gives all other fields; empty where they are not known.
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
    stated: tuple[str, ...] = ()
    stated_in: str = ""
    based_on: str = ""
    rotor_mass: float | None = None

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
    def is_inrunner(self) -> bool:
        """Whether its rotor turns inside its stator: it then stands behind the gearbox."""
        return "inrunner" in self.kind

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
        if self.bore_diameter is None and not self.is_inrunner:
            lacking.append("stator bore")
        return tuple(lacking)

    @property
    def speed_told(self) -> str:
        """How fast it turns, in words: over its voltage, else without load; empty if unknown."""
        if self.torque_constant:
            return f"{1.0 / (self.torque_constant * _RPM):.4g} rpm/V"
        if self.no_load_speed is None:
            return ""
        at = "" if self.rated_voltage is None else f" at {self.rated_voltage:g} V"
        return f"{self.no_load_speed / _RPM:.4g} rpm{at}"

    @property
    def winding_most(self) -> float:
        """Greatest temperature of the winding that is designed to, deg C.

        What a design or a motor file states holds; the class of wire of a catalogue's row does not,
        because magnets and bond bear less.
        """
        if "winding_limit" in self.stated and self.winding_limit is not None:
            return self.winding_limit
        return WINDING_MOST

    def told_by(self, field: str) -> str:
        """The row that gives a field, in words: this one, or the one that it is taken over from."""
        row = self.based_on or self.name
        if field in self.taken_over.split():
            return f"{row}, taken over from {self.taken_from}"
        return row

    def origin(self, field: str) -> str:
        """Where a field comes from, in words: what states it, or the catalogue's row."""
        if field in self.stated:
            return self.stated_in
        if field in DRAG and not set(DRAG).isdisjoint(self.stated):
            # Drag that is stated is all of it: what is left out is 0.
            return f"{self.stated_in}, which gives the drag without it"
        return f"catalogue: {self.told_by(field)}"

    @property
    def remark(self) -> str:
        """A sentence on a motor that is not as a catalogue's row has it; empty of one that is."""
        if not self.stated:
            return ""
        rest = (
            f"what is left out is that of {self.based_on}"
            if self.based_on
            else "nothing else is known of it"
        )
        return f"the motor is {self.name} of {self.stated_in.partition(': ')[2]}; {rest}."


def torque_constant_from(value: float, convention: str) -> float:
    """K of the DC machine from a constant (N m/A or V s/rad) in another one of `CONVENTIONS`.

    Raises
    ------
    DesignError
        For an unknown convention or a value that is not positive.

    Examples
    --------
    >>> round(torque_constant_from(0.2126, "torque_per_rms"), 4)
    0.1736
    """
    if convention not in CONVENTIONS:
        known = ", ".join(CONVENTIONS)
        raise DesignError(
            f"there is no convention {convention!r} of a motor constant; use {known}."
        )
    if not (math.isfinite(value) and value > 0.0):
        raise DesignError(f"a motor constant of {value:g} is not above zero; 1/KV in SI is one.")
    return value / CONVENTIONS[convention]


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


def find_bare_motor(name: str) -> Motor:
    """The motor called `name`, for the crank of a reducer.

    Raises
    ------
    CatalogError
        With the nearest names, when there is none.
    DesignError
        With bare motors of about its size, when it is a geared actuator.
    """
    row = find_motor(name)
    if row.torque_at == "motor":
        return row
    gear = f" a gear of {row.gear_ratio:g}" if row.gear_ratio else " its gear"
    near = ", ".join(f"'{one.name}'" for one in _bare_motors_of_size(row))
    raise DesignError(
        f"'{row.name}' is a geared actuator: its torque, speed and inertia count behind{gear}, and "
        f"a reducer needs a bare motor on its crank; choose one of about its size, such as {near} "
        "(`cqdd-design catalog motors` shows all), or give the data of the motor inside it with "
        "--motor-file or in [motor], under a name of your own."
    )


def _bare_motors_of_size(geared: Motor, most: int = 2) -> list[Motor]:
    """Bare motors that can be judged, those nearest in diameter first."""
    judged = ("torque_constant", "line_resistance", "rated_torque", "peak_torque", "rotor_inertia")
    known = [
        one
        for one in motors().values()
        if one.torque_at == "motor"
        and one.outer_diameter
        and one.bore_diameter
        and all(getattr(one, field) for field in judged)
    ]
    size = geared.outer_diameter or 0.1
    return sorted(known, key=lambda one: abs((one.outer_diameter or 0.0) - size))[:most]
