"""A data set in one file, for a machine that trains: ``.npz``, no pickle, neither pyarrow nor CAD.

Besides the episodes it can hold the actuator's parameters, which take the contact engine to make.
"""

from __future__ import annotations

import json
import zipfile
from pathlib import Path

import numpy as np

from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.errors import UsageError
from cqdd_design.files import WrittenFile, write_with
from cqdd_design.torque.data.episodes import DataSet, Episode
from cqdd_design.torque.features.physics import actuator_from_dict, actuator_to_dict

FORMAT = "cqdd-design packed torque data 1"


def pack_data(data: DataSet, path: Path, actuator: ActuatorParameters | None = None) -> WrittenFile:
    """Write a data set, and the actuator where given, as one ``.npz``; values as float32."""
    content = {
        "format": FORMAT,
        "dt": data.dt,
        "position_gain": data.position_gain,
        "velocity_gain": data.velocity_gain,
        "torque_range": list(data.torque_range),
        "facts": dict(data.facts),
        "episodes": [
            {"name": one.name, "group": dict(one.group), "columns": list(one.columns)}
            for one in data.episodes
        ],
        "actuator": None if actuator is None else actuator_to_dict(actuator),
    }
    arrays = {
        str(k): np.stack([np.asarray(values, np.float32) for values in one.columns.values()])
        for k, one in enumerate(data.episodes)
    }
    text = json.dumps(content, allow_nan=False)

    def write(place: Path) -> None:
        with place.open("wb") as stream:
            np.savez_compressed(stream, allow_pickle=False, metadata=np.array(text), **arrays)

    return write_with(path, "npz", write)


def unpack_data(path: Path) -> tuple[DataSet, ActuatorParameters | None]:
    """Read what `pack_data` wrote.

    Raises
    ------
    UsageError
        For anything else.
    """
    try:
        with np.load(path, allow_pickle=False) as found:
            arrays = {
                name: found[name].astype(np.float64) for name in found.files if name != "metadata"
            }
            content = json.loads(str(found["metadata"]))
    except FileNotFoundError as error:
        raise UsageError(f"there is no {path}; `pack_data` writes one.") from error
    except (OSError, ValueError, KeyError, zipfile.BadZipFile, EOFError) as error:
        raise UsageError(f"{path} is not a packed data set; write it anew.") from error
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise UsageError(f"{path} is not '{FORMAT}'; write it anew.")
    episodes = tuple(
        Episode(
            one["name"],
            one["group"],
            content["dt"],
            dict(zip(one["columns"], arrays[str(k)], strict=True)),
        )
        for k, one in enumerate(content["episodes"])
    )
    low, high = content["torque_range"]
    data = DataSet(
        episodes=episodes,
        position_gain=content["position_gain"],
        velocity_gain=content["velocity_gain"],
        torque_range=(low, high),
        facts=content["facts"],
    )
    actuator = content["actuator"]
    return data, None if actuator is None else actuator_from_dict(actuator)
