"""Motors: winding, torque, size. Rows at the output of a gearbox are comparison data."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

from cqdd_design.catalog.reader import find, optional_number, read_rows


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

    name: str
    kind: str
    torque_at: str
    speed_constant: float | None
    torque_constant_printed: float | None
    line_resistance: float | None
    line_inductance: float | None
    pole_pairs: int | None
    rotor_inertia: float | None
    mass: float | None
    rated_torque: float | None
    peak_torque: float | None
    rated_current: float | None
    peak_current: float | None
    gear_ratio: float | None
    outer_diameter: float | None
    length: float | None
    bore_diameter: float | None
    gap_diameter: float | None
    stack_length: float | None
    rotor_length: float | None
    slot_depth: float | None
    no_load_speed: float | None
    bore_note: str
    note: str
    source: str

    @property
    def torque_constant(self) -> float | None:
        """Torque per DC (six-step) ampere, 1/KV in SI; the printed value where KV is missing."""
        if self.speed_constant:
            return 1.0 / self.speed_constant
        return self.torque_constant_printed


@functools.lru_cache(maxsize=1)
def motors() -> dict[str, Motor]:
    """All motors by name, in file order."""
    rpm = 2.0 * math.pi / 60.0
    table = {}
    for row in read_rows("motors.csv"):
        pairs = optional_number(row, "pole_pairs")
        table[row["name"]] = Motor(
            name=row["name"],
            kind=row["kind"],
            torque_at=row["torque_at"],
            speed_constant=optional_number(row, "kv_rpm_V", rpm),
            torque_constant_printed=optional_number(row, "kt_Nm_A"),
            line_resistance=optional_number(row, "r_ll_ohm"),
            line_inductance=optional_number(row, "l_ll_uH", 1e-6),
            pole_pairs=None if pairs is None else round(pairs),
            rotor_inertia=optional_number(row, "rotor_J_kgm2"),
            mass=optional_number(row, "mass_kg"),
            rated_torque=optional_number(row, "t_rated_Nm"),
            peak_torque=optional_number(row, "t_peak_Nm"),
            rated_current=optional_number(row, "i_rated_A"),
            peak_current=optional_number(row, "i_peak_A"),
            gear_ratio=optional_number(row, "ratio"),
            outer_diameter=optional_number(row, "od_mm", 1e-3),
            length=optional_number(row, "len_mm", 1e-3),
            bore_diameter=optional_number(row, "bore_mm", 1e-3),
            gap_diameter=optional_number(row, "gap_mm", 1e-3),
            stack_length=optional_number(row, "stack_mm", 1e-3),
            rotor_length=optional_number(row, "rotor_mm", 1e-3),
            slot_depth=optional_number(row, "slot_mm", 1e-3),
            no_load_speed=optional_number(row, "noload_rpm", rpm),
            bore_note=row["bore_note"],
            note=row["note"],
            source=row["source"],
        )
    return table


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
