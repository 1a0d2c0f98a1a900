"""What an actuator was measured under when something was fitted to it, and where that matters."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

AT_VOLTAGE = (
    "no_load_speed",
    "efficiency_peak",
    "position_bandwidth_45deg",
    "position_bandwidth_5deg",
)
"""Measurements at the supply of the bench; others are torques, whatever drives them."""
_ON_RIG = ("torque_bandwidth",)
_OF_PARTS = ("backlash", "torque_ripple", "backdrive_static", "backdrive_dynamic")
"""Measurements that are another gearbox's with another seed."""


class FittedUnder(NamedTuple):
    """Conditions of measured rows.

    Attributes
    ----------
    voltage : float
        Supply of the dynamic rows, V.
    ambient : float
        Of the air, deg C.
    rig_stiffness : float or None
        Of what held the output, N m/rad; None for a torque sensor's.
    seed : int or None
        Of the gearbox drawn from the tolerances; None for perfect parts.
    other : str
        The design where it is another one, in words.
    """

    voltage: float
    ambient: float
    rig_stiffness: float | None = None
    seed: int | None = None
    other: str = ""

    @property
    def told(self) -> str:
        """In words."""
        return ", ".join(
            (
                f"a supply of {self.voltage:g} V",
                f"air of {self.ambient:g} degC",
                _rig(self.rig_stiffness),
                _gearbox(self.seed),
            )
        )

    def differs(self, row: str, here: FittedUnder) -> str:
        """What of a measurement is otherwise here, in words; nothing where all is the same."""
        return "; ".join(self._differences(row, here))

    def _differences(self, row: str, here: FittedUnder) -> Iterator[str]:
        if self.other:
            yield f"fitted to {self.other}"
        if row in AT_VOLTAGE and self.voltage != here.voltage:
            yield f"fitted at {self.voltage:g} V, measured here at {here.voltage:g} V"
        if self.ambient != here.ambient:
            yield f"fitted in air of {self.ambient:g} degC, here {here.ambient:g} degC"
        if row in _ON_RIG and self.rig_stiffness != here.rig_stiffness:
            yield f"fitted on {_rig(self.rig_stiffness)}, here {_rig(here.rig_stiffness)}"
        if row in _OF_PARTS and self.seed != here.seed:
            yield f"fitted to {_gearbox(self.seed)}, here {_gearbox(here.seed)}"

    def to_dict(self) -> dict[str, Any]:
        """The JSON form (``measured_under``)."""
        return {
            "voltage_V": self.voltage,
            "ambient_degC": self.ambient,
            "rig_stiffness_Nm_per_rad": self.rig_stiffness,
            "gearbox_seed": self.seed,
        }


def _rig(stiffness: float | None) -> str:
    return "a torque sensor" if stiffness is None else f"a rig of {stiffness:g} N*m/rad"


def _gearbox(seed: int | None) -> str:
    return "perfect parts" if seed is None else f"the gearbox of seed {seed}"
