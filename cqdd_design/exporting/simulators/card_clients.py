"""Simulators that the actuator card speaks to: ``data/clients.toml``."""

from __future__ import annotations

import dataclasses
import functools
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import resources
from typing import TYPE_CHECKING

from cqdd_design.actuator.joint_side import JointSide
from cqdd_design.exporting.simulators.stated import effort_limit, value_of

if TYPE_CHECKING:
    from cqdd_design.actuator.parameters import ActuatorParameters


@dataclass(frozen=True)
class Client:
    """A simulator.

    Attributes
    ----------
    key, title : str
        For programs and for people.
    version : str
        Whose names these are.
    checked : str
        How they were checked.
    missing : str
        What of the card it cannot express.
    settings : mapping
        Configuration to setting to what it is set to: a field of `JointSide`, ``stribeck``,
        ``effort_limit``, a dotted name of the parameters, or a number.
    """

    key: str
    title: str
    version: str
    checked: str
    missing: str
    settings: Mapping[str, Mapping[str, str | float]]


@functools.cache
def clients() -> tuple[Client, ...]:
    """Every client, in the order of the card."""
    text = (resources.files(__package__) / "data" / "clients.toml").read_text("utf-8")
    document = tomllib.loads(text)
    mechanics = document.pop("mechanics")
    return tuple(
        Client(key, **{**row, "missing": row["missing"].format(mechanics=mechanics)})
        for key, row in document.items()
    )


def client_settings(
    parameters: ActuatorParameters, side: JointSide
) -> dict[str, dict[str, dict[str, float]]]:
    """Return client to configuration to setting to value, ready to be copied.

    Values stand at the joint, but for those of `mujoco`'s dcmotor and Drake's rotor inertia.
    """
    known = {
        **dataclasses.asdict(side),
        "stribeck": side.breakaway - side.coulomb,
        "effort_limit": effort_limit(parameters),
    }

    def value(of: str | float) -> float:
        if isinstance(of, float):
            return of
        return known[of] if of in known else value_of(parameters, of)

    return {
        client.key: {
            configuration: {name: value(of) for name, of in settings.items()}
            for configuration, settings in client.settings.items()
        }
        for client in clients()
    }
