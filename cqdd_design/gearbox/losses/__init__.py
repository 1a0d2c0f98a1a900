"""Friction and losses of the gearbox, on top of frictionless contact forces.

Forces come from the contact equilibrium without friction; friction is laid over them: Coulomb
sliding at ring teeth and output pins, load torque and drag of the bearings, shear of the grease
between the discs. This is exact to first order in the coefficients. What it leaves out is measured
and reported as `tooth_force_change`: friction at the teeth turns the disc about its centre, so for
the same output torque the teeth press harder by that share while the motor drives, and less while
the output drives (see :meth:`.machine.FrictionMachine.tooth_force_change`).
"""

from cqdd_design.gearbox.losses.backdrive import Backdrive
from cqdd_design.gearbox.losses.machine import FrictionMachine
from cqdd_design.gearbox.losses.model import EfficiencyMap, LossModel, loss_model
from cqdd_design.gearbox.losses.result import Losses

__all__ = [
    "Backdrive",
    "EfficiencyMap",
    "FrictionMachine",
    "LossModel",
    "Losses",
    "loss_model",
]
