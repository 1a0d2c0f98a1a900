"""Torques at which the contact equilibrium reaches a force or pressure."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache
from types import MappingProxyType

from scipy.optimize import brentq

from cqdd_design.errors import ContactError
from cqdd_design.gearbox.contact.states import NominalStates, nominal_states
from cqdd_design.gearbox.contact.sweep import ANGLES, contact_sweep, perfect_angles
from cqdd_design.machine.machine import Machine

LOAD_OF_CHECK: Mapping[str, str] = MappingProxyType(
    {
        "CONTACT-RING-PEAK": "ring_pressure_max_MPa",
        "CONTACT-RING-CONTINUOUS": "ring_pressure_max_MPa",
        "CONTACT-PIN-PEAK": "output_pressure_max_MPa",
        "CONTACT-PIN-CONTINUOUS": "output_pressure_max_MPa",
        "PIN-SHEAR-PEAK": "output_pin_force_max_N",
        "PIN-BENDING-PEAK": "output_pin_force_max_N",
        "PIN-BENDING-CONTINUOUS": "output_pin_force_max_N",
        "PIN-BEARING-PEAK": "output_pin_force_max_N",
        "BEARING-STATIC": "cam_bearing_load_max_N",
    }
)
"""Strength checks, and the force or pressure of the equilibrium that their values go with."""

_SEARCHED_ANGLES = 120
"""Over the period while a torque is sought; they miss a greatest value by half a percent at most,
which the full number of angles at the machine's own torque takes out."""
_MOST_TORQUE = 1e6
_TOLERANCE = 1e-6


class LoadedContacts:
    """Greatest forces and pressures of a machine's perfect parts over its period, both senses."""

    def __init__(self, machine: Machine) -> None:
        self._model = machine.contact
        self._greatest = lru_cache(maxsize=None)(self._swept)

    def _swept(self, torque: float, angles: int) -> dict[str, float]:
        states = self._states(angles)
        forward, back = (
            contact_sweep(self._model, one, states=states).maxima for one in (torque, -torque)
        )
        return {key: max(value, back[key]) for key, value in forward.items()}

    @lru_cache(maxsize=2)  # noqa: B019 - as long as this object, which nothing keeps
    def _states(self, angles: int) -> NominalStates:
        return nominal_states(self._model, perfect_angles(self._model, angles))

    def greatest(self, torque: float) -> dict[str, float]:
        """The maxima of a sweep by their JSON keys, of both senses of a torque, N m.

        Raises
        ------
        ContactError
            The torque has no equilibrium.
        """
        return self._greatest(torque, ANGLES)

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
            Where to look first: at this torque the answer is exact.
        """
        share = self.greatest(torque)[key] / self._greatest(torque, _SEARCHED_ANGLES)[key]

        def over(log_torque: float) -> float:
            found = self._greatest(math.exp(log_torque), _SEARCHED_ANGLES)
            return math.log(share * found[key] / value)

        low = high = math.log(torque)
        step = math.log(1.5)
        if over(low) > 0.0:
            while over(low) > 0.0:
                if low < math.log(_TOLERANCE):
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
        return float(math.exp(brentq(over, low, high, xtol=_TOLERANCE)))

    def _last_with_equilibrium(self, low: float, high: float) -> float:
        while high - low > 1e-3:
            middle = 0.5 * (low + high)
            try:
                self._greatest(math.exp(middle), _SEARCHED_ANGLES)
                low = middle
            except ContactError:
                high = middle
        return low
