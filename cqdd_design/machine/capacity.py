"""Torques at which the contact equilibrium reaches a force or pressure."""

from __future__ import annotations

import math

from cqdd_design.errors import ContactError
from cqdd_design.gearbox.contact.model import ContactModel
from cqdd_design.gearbox.contact.rubbing import ContactFriction
from cqdd_design.gearbox.contact.states import NominalStates, nominal_states
from cqdd_design.gearbox.contact.sweep import ANGLES, contact_sweep, perfect_angles

_SEARCHED_ANGLES = 120
"""Over the period while a torque is sought; they miss a greatest value by half a percent at most,
which the full number of angles at the torque where the search begins takes out."""
_MOST_TORQUE, _LEAST_TORQUE = 1e6, 1e-6
_TOLERANCE = 1e-6


class LoadedContacts:
    """Greatest forces and pressures of perfect parts over their period, in both senses.

    With friction at teeth and pins while the motor drives, which loads them most; at rest, where
    peak torques are reached and no film lowers it, unless a speed is given.

    Parameters
    ----------
    speed : float, optional
        Of the crank, rad/s.
    """

    def __init__(self, model: ContactModel, speed: float = 0.0) -> None:
        self._model = model
        self._friction = ContactFriction.of(model, "drive", speed)
        self._states: dict[int, NominalStates] = {}
        self._found: dict[tuple[float, int], dict[str, float]] = {}

    def greatest(self, torque: float, angles: int = ANGLES) -> dict[str, float]:
        """The maxima of a sweep by their JSON keys, of both senses of a torque, N m.

        Raises
        ------
        ContactError
            The torque has no equilibrium.
        """
        if angles not in self._states:
            points = perfect_angles(self._model, angles)
            self._states[angles] = nominal_states(self._model, points)
        if (torque, angles) not in self._found:
            forward, back = (
                contact_sweep(
                    self._model, one, states=self._states[angles], friction=self._friction
                ).maxima
                for one in (torque, -torque)
            )
            self._found[torque, angles] = {
                key: max(value, back[key]) for key, value in forward.items()
            }
        return self._found[torque, angles]

    def torque_at(self, key: str, value: float, torque: float) -> float:
        """The torque at which a greatest value reaches `value`, N m.

        Where the equilibrium ends before, the most torque that has one.

        Parameters
        ----------
        key : str
            Of :meth:`greatest`.
        value : float
            In the unit of the key.
        torque : float
            Where to look first: at this torque the answer is exact. One without an equilibrium is
            halved until it has one.

        Raises
        ------
        ContactError
            No torque has an equilibrium.
        """
        while not self._has_equilibrium(torque):
            torque *= 0.5
            if torque < _LEAST_TORQUE:
                raise ContactError("no torque has a contact equilibrium.")
        share = self.greatest(torque)[key] / self.greatest(torque, _SEARCHED_ANGLES)[key]

        def over(log_torque: float) -> float:
            found = self.greatest(math.exp(log_torque), _SEARCHED_ANGLES)
            return math.log(share * found[key] / value)

        low = high = math.log(torque)
        step = math.log(1.5)
        if over(low) > 0.0:
            while over(low) > 0.0:
                if low < math.log(_LEAST_TORQUE):
                    return 0.0
                high, low = low, low - step
        else:
            try:
                while over(high) <= 0.0:
                    if high > math.log(_MOST_TORQUE):
                        return math.inf
                    low, high = high, high + step
            except ContactError:
                return math.exp(self._last_with_equilibrium(low, high))
        from scipy.optimize import brentq

        return float(math.exp(brentq(over, low, high, xtol=_TOLERANCE)))

    def reach(self, torque: float) -> float:
        """The most torque up to `torque` (N m) that has an equilibrium; 0 where none has."""
        if self._has_equilibrium(torque):
            return torque
        low = 0.5 * torque
        while not self._has_equilibrium(low):
            low *= 0.5
            if low < _LEAST_TORQUE:
                return 0.0
        return math.exp(self._last_with_equilibrium(math.log(low), math.log(2.0 * low)))

    def _has_equilibrium(self, torque: float) -> bool:
        try:
            for angles in (_SEARCHED_ANGLES, ANGLES):
                self.greatest(torque, angles)
        except ContactError:
            return False
        return True

    def _last_with_equilibrium(self, low: float, high: float) -> float:
        while high - low > 1e-3:
            middle = 0.5 * (low + high)
            if self._has_equilibrium(math.exp(middle)):
                low = middle
            else:
                high = middle
        return low
