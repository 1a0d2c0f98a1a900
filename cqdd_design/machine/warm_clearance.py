"""What temperatures of its parts leave of a gearbox's clearances, with rigid parts."""

from __future__ import annotations

from dataclasses import dataclass

from cqdd_design.gearbox.heat.expansion import PartTemperatures
from cqdd_design.gearbox.precision.backlash import Backlash, backlash
from cqdd_design.machine.machine import Machine

_GAP_ANGLES = 41


@dataclass(frozen=True, eq=False)
class WarmClearance:
    """Rigid parts at some temperatures.

    Attributes
    ----------
    temperatures : PartTemperatures
    free : Backlash
    least_gap : float
        In the nominal pose, m; negative where parts have to move out of each other's way.
    """

    temperatures: PartTemperatures
    free: Backlash
    least_gap: float

    @property
    def overlap(self) -> float:
        """That no motion removes, m; 0 where parts are free."""
        return float(self.free.overlap.max()) if self.free.preloaded else 0.0


def warm_clearance(machine: Machine, temperatures: PartTemperatures) -> WarmClearance:
    """Backlash, gap and overlap of rigid parts at some temperatures.

    Raises
    ------
    DesignError
        When the thermal expansion of a part is not known.
    """
    from cqdd_design.gearbox.contact.states import nominal_states
    from cqdd_design.gearbox.contact.sweep import perfect_angles

    model = machine.at(temperatures).contact
    states = nominal_states(model, perfect_angles(model, _GAP_ANGLES))
    found = backlash(model, states=states)
    return WarmClearance(temperatures, found, float(states.gaps.min()))
