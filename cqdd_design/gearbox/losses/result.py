"""Losses at one speed and torque."""

from __future__ import annotations

from dataclasses import dataclass

from cqdd_design.gearbox.losses.backdrive import Backdrive


@dataclass(frozen=True)
class Losses:
    """Mean power losses over a period at one operating point.

    Attributes
    ----------
    torque, input_speed : float
        On the carrier (N m) and of the crank (rad/s).
    output_speed : float
        rad/s, size only.
    by_source : mapping
        Mean power while the motor drives, W, by the names of :data:`.machine.SOURCES` in the order
        of the tables.
    load_independent : float
        Part of the total that does not depend on the load, W.
    loss_torque, loss_torque_backward : float
        Loss as a torque at the output, N m, the motor driving and the output; finite at zero speed,
        the limit of slow motion.
    efficiency_forward : float or None
        T w/(T w + P), the motor driving; None at zero torque.
    efficiency_backward : float or None
        1 - P/(T w), the output driving, or 0 where it does not turn; None at zero torque.
    backdrives : bool or None
        Whether this torque at the output turns the gearbox; None at zero torque.
    backdrive : Backdrive
        Torque that the output needs with no motor.
    bearings : mapping
        Names of the bearings that were counted: cam, support, output.
    lubricant : str
        Name of the lubricant whose drag was counted.
    """

    torque: float
    input_speed: float
    output_speed: float
    by_source: dict[str, float]
    load_independent: float
    loss_torque: float
    loss_torque_backward: float
    efficiency_forward: float | None
    efficiency_backward: float | None
    backdrives: bool | None
    backdrive: Backdrive
    bearings: dict[str, str]
    lubricant: str
    warnings: tuple[str, ...]

    @property
    def total(self) -> float:
        """All losses, W."""
        return sum(self.by_source.values())

    def to_dict(self) -> dict[str, object]:
        """Return the JSON form (``losses``)."""
        return {
            "torque_Nm": self.torque,
            "input_speed_rad_per_s": self.input_speed,
            "output_speed_rad_per_s": self.output_speed,
            "efficiency_forward": self.efficiency_forward,
            "efficiency_backward": self.efficiency_backward,
            "backdrives": self.backdrives,
            **{f"{name}_W": power for name, power in self.by_source.items()},
            "total_W": self.total,
            "load_independent_W": self.load_independent,
            "loss_torque_Nm": self.loss_torque,
            "loss_torque_backward_Nm": self.loss_torque_backward,
            "bearings": dict(self.bearings),
            "lubricant": self.lubricant,
            **self.backdrive.to_dict(),
        }
