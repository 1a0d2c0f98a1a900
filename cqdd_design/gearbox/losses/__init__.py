"""Friction and losses of the gearbox.

Forces come from the contact equilibrium with Coulomb friction at ring teeth and output pins, with
the motor driving and with the output driving; the work of that friction is theirs. Laid over them
are load torque and drag of the bearings, and the shear of the grease between the discs.
"""

from cqdd_design.gearbox.losses.backdrive import Backdrive
from cqdd_design.gearbox.losses.machine import FrictionMachine
from cqdd_design.gearbox.losses.model import EfficiencyMap, LossModel
from cqdd_design.gearbox.losses.result import Losses
from cqdd_design.gearbox.losses.swept import TORQUE_SHARES, loss_model

__all__ = [
    "TORQUE_SHARES",
    "Backdrive",
    "EfficiencyMap",
    "FrictionMachine",
    "LossModel",
    "Losses",
    "loss_model",
]
