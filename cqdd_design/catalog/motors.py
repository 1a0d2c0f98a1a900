"""Motors: winding, torque, size. Rows at the output of a gearbox are comparison data."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

from cqdd_design.catalog.reader import column, find, read_records

_RPM = 2.0 * math.pi / 60.0


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
        N*m/A as the source prints it (conventions differ, see `torque_constant`).
    line_resistance, line_inductance : float or None
        Line to line, ohm and H.
    pole_pairs : int or None
        Number of pole pairs.
    rotor_inertia, mass : float or None
        kg m^2 and kg.
    rated_torque, peak_torque, rated_current, peak_current : float or None
        N*m, A.
    gear_ratio : float or None
        Of a geared actuator.
    outer_diameter, length, bore_diameter : float or None
        m; the bore is that of the stator, inside which the gearbox sits.
    gap_diameter, stack_length, rotor_length, slot_depth : float or None
        Of the magnetic circuit, m: the air gap, the stator's laminations, the rotor's ring of
        magnets, the slots.
    no_load_speed : float or None
        rad/s, as printed.
    bore_note, note, source : str
        How sure the bore is; remarks; where the row comes from.
    """

    name: str = column("name")
    kind: str = column("kind")
    torque_at: str = column("torque_at")
    speed_constant: float | None = column("kv_rpm_V", _RPM)
    torque_constant_printed: float | None = column("kt_Nm_A")
    line_resistance: float | None = column("r_ll_ohm")
    line_inductance: float | None = column("l_ll_uH", 1e-6)
    pole_pairs: int | None = column("pole_pairs")
    rotor_inertia: float | None = column("rotor_J_kgm2")
    mass: float | None = column("mass_kg")
    rated_torque: float | None = column("t_rated_Nm")
    peak_torque: float | None = column("t_peak_Nm")
    rated_current: float | None = column("i_rated_A")
    peak_current: float | None = column("i_peak_A")
    gear_ratio: float | None = column("ratio")
    outer_diameter: float | None = column("od_mm", 1e-3)
    length: float | None = column("len_mm", 1e-3)
    bore_diameter: float | None = column("bore_mm", 1e-3)
    gap_diameter: float | None = column("gap_mm", 1e-3)
    stack_length: float | None = column("stack_mm", 1e-3)
    rotor_length: float | None = column("rotor_mm", 1e-3)
    slot_depth: float | None = column("slot_mm", 1e-3)
    no_load_speed: float | None = column("noload_rpm", _RPM)
    bore_note: str = column("bore_note")
    note: str = column("note")
    source: str = column("source")

    @property
    def torque_constant(self) -> float | None:
        """Torque per DC (six-step) ampere, 1/KV in SI; the printed value where KV is missing."""
        if self.speed_constant:
            return 1.0 / self.speed_constant
        return self.torque_constant_printed


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
