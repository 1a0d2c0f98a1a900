"""What a network's torque is, by its own file: where on the joint, filtered how, in which range.

A joint that a network drives must not count twice what the labels have already. Labels of simulated
data are the torque on the load, at the output flange: the inertia of rotor, gearbox and output side
is left of it, and friction and damping are. Labels of logs are what their owner measured; those
made of the motor's current are before the gearbox.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from cqdd_design.torque.data.episodes import DataSet, Episode
from cqdd_design.torque.data.sensing import Filter
from cqdd_design.torque.networks.artefact import Artefact

_FILTER = ("filter_frequency_Hz", "filter_damping_ratio")
Range = tuple[float, float]


@dataclass(frozen=True)
class Meaning:
    """What is known of a network's labels.

    Attributes
    ----------
    on_load : bool or None
        True where they are the torque on the load, False where they are the motor's; None where
        the file does not say.
    passed : Filter or None
        What all signals, labels too, passed before they were sampled.
    labels, speeds : tuple of float or None
        Least and greatest torque (N m) and velocity (rad/s) of the training.
    limit : tuple of float
        Least and greatest torque that the actuator can be asked for, N m; labels go beyond it
        where load or wall push.
    """

    on_load: bool | None
    passed: Filter | None
    labels: Range | None
    speeds: Range | None
    limit: Range

    @property
    def joint(self) -> dict[str, float] | None:
        """What the driven joint is to have besides, in a simulator; None where that is unknown."""
        names = ("armature", "damping", "friction")
        return dict.fromkeys(names, 0.0) if self.on_load else None

    @property
    def joint_told(self) -> str:
        """The same for people."""
        if self.on_load:
            return (
                "The torque is that on the load, at the output flange: inertia, friction and "
                "damping of motor, gearbox and output side are in it already. Set armature, "
                "damping and friction of the joint to 0 with this network, and give its link the "
                "load's inertia alone; else they count twice."
            )
        if self.on_load is None:
            return (
                "The torque is that of the training's labels, and the file does not say where it "
                "was measured. If that was between actuator and load, set armature, damping and "
                "friction of the joint to 0 with this network; else they count twice."
            )
        return (
            "The torque is the motor's current times a constant: inertia, friction and damping of "
            "the actuator are not in it, and the joint needs its armature, damping and friction."
        )

    @property
    def filter_told(self) -> str:
        """What to feed; of signals that were not filtered, or of which it is unknown, that."""
        if self.passed is None:
            return (
                "Signals are those of the training's records as they were; feed such as passed the "
                "same filters, and as late."
            )
        return (
            "In training all signals, the torque too, passed one causal low-pass of second order "
            f"({self.passed.frequency:g} Hz, damping ratio {self.passed.damping:g}), which delays "
            f"them by {1e3 * self.passed.delay:.3g} ms. Feed position error and velocity that "
            "passed the same, not raw ones; the torque is that much late."
        )

    @property
    def range(self) -> Range:
        """Of the labels, N m; the limit where their own is not in the file."""
        return self.limit if self.labels is None else self.labels

    @property
    def range_of(self) -> str:
        """Whose range that is."""
        if self.labels is not None:
            return "of the training's labels"
        return "limit of the actuator; the labels' own range is not in the network's file"

    @property
    def envelope(self) -> dict[str, float]:
        """Limits for a client that clips by a DC motor's line, such that they leave labels alone.

        ``saturation_effort (1 - speed/velocity_limit)`` is the greatest label at the greatest
        speed of the training; empty where either is unknown.
        """
        if self.labels is None or self.speeds is None:
            return {}
        effort, speed = (max(map(abs, both)) for both in (self.labels, self.speeds))
        if not (min(effort, speed) > 0.0 and math.isfinite(2.0 * max(effort, speed))):
            return {}
        return {
            "effort_limit": effort,
            "saturation_effort": 2.0 * effort,
            "velocity_limit": 2.0 * speed,
        }

    def to_dict(self) -> dict[str, Any]:
        """The JSON form, units in the names."""
        kept = self.passed
        return {
            "torque_is": self.joint_told,
            "joint": self.joint,
            "signals_are": self.filter_told,
            **dict(
                zip(_FILTER, (kept.frequency, kept.damping) if kept else (None,) * 2, strict=True)
            ),
            "filter_delay_s": kept.delay if kept else None,
            "torque_range_Nm": list(self.range),
            "torque_range_is": self.range_of,
            "torque_limit_Nm": list(self.limit),
            "speed_range_rad_per_s": None if self.speeds is None else list(self.speeds),
        }


def meaning(artefact: Artefact) -> Meaning:
    """What a network's file says of its labels."""
    facts = artefact.facts
    data = facts.get("data")
    data = data if isinstance(data, Mapping) else {}
    simulated = data.get("source") == "simulated"
    on_load: bool | None = True if simulated else None
    if data.get("torque_from") == "current":
        on_load = False
    passed = _filter(facts.get("signals_filter"))
    if "signals_filter" not in facts and simulated:
        # Files of before it was written down: no simulated data have passed another.
        passed = Filter()
    return Meaning(
        on_load=on_load,
        passed=passed,
        labels=_range(facts.get("label_range_Nm")),
        speeds=_range(facts.get("speed_range_rad_per_s")),
        limit=artefact.validity.torque_range,
    )


def label_facts(data: DataSet, episodes: tuple[Episode, ...]) -> dict[str, Any]:
    """What `meaning` reads, of the episodes that a network is trained on."""
    facts = data.facts
    # Of simulated data the whole chain is in one table; logs were filtered where it says so.
    told = facts.get("sensors") if facts.get("source") == "simulated" else facts
    unfiltered = facts.get("source") == "logs" and not facts.get("filtered_logs")
    kept = None
    if isinstance(told, Mapping) and not unfiltered:
        values = {key: told.get(key) for key in _FILTER}
        known = all(isinstance(one, int | float) for one in values.values())
        kept = values if known else None
    ranges = {
        name: [
            float(min(np.min(one.columns[column]) for one in episodes)),
            float(max(np.max(one.columns[column]) for one in episodes)),
        ]
        for name, column in (("label_range_Nm", "torque"), ("speed_range_rad_per_s", "velocity"))
    }
    return {"signals_filter": kept, **ranges}


def _filter(told: object) -> Filter | None:
    if not isinstance(told, Mapping):
        return None
    found = Filter(*(float(told[key]) for key in _FILTER))
    return found if math.isfinite(found.delay) else None


def _range(told: object) -> Range | None:
    if not isinstance(told, list | tuple) or len(told) != 2:
        return None
    return float(told[0]), float(told[1])
