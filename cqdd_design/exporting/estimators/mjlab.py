"""Estimators for mjlab's ``LearnedMlpActuator``: TorchScript over a history, newest sample first.

``NAME-mjlab.pt`` holds an MLP, or a GRU that was trained on windows and runs each of them from a
zero state; ``NAME-mjlab.json`` the fields of ``LearnedMlpActuatorCfg``. After a reset mjlab fills
its history with the first sample. (mjlab 1.6.0, ``actuator/learned_actuator.py``)
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cqdd_design.errors import UsageError
from cqdd_design.exporting.estimators.isaaclab import OF_HISTORY, write_shape
from cqdd_design.exporting.estimators.options import (
    Export,
    joint_settings,
    metadata,
    require_inputs,
)
from cqdd_design.exporting.estimators.torchscript import client_history
from cqdd_design.torque.networks.meaning import meaning

if TYPE_CHECKING:
    from pathlib import Path

    from cqdd_design.torque.networks.artefact import Artefact

_JOINT = {"armature": "armature", "frictionloss": "friction", "viscous_damping": "damping"}
"""Fields of the simulated joint, which are those of the robot's XML where none is given."""


def export_mjlab(artefact: Artefact, path: Path) -> Export:
    """Write the network and its settings.

    Raises
    ------
    UsageError
        For a GRU that needs its state kept, or inputs that mjlab does not give.
    """
    require_inputs(artefact, "mjlab", made=("acceleration",))
    if artefact.family == "gru" and artefact.mode == "streaming":
        raise UsageError(
            f"{artefact.name} keeps its state from step to step, and mjlab keeps a history of "
            "samples but no state; export it --to torchscript-isaaclab or newton, or train it in "
            "window mode."
        )
    place = path.with_name(f"{path.name}-mjlab.pt")
    settings = {
        **metadata(artefact, "window"),
        "client": "mjlab 1.6.0",
        "class": "LearnedMlpActuatorCfg",
        "configuration": {
            "network_file": place.name,
            **OF_HISTORY,
            "history_length": client_history(artefact),
            **meaning(artefact).envelope,
            **joint_settings(artefact, _JOINT),
        },
    }
    return Export(write_shape(artefact, place, "history", settings))
