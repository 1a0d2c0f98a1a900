"""A data set in one file, for a machine that trains: ``.npz``, no pickle, neither pyarrow nor CAD.

Besides the episodes it can hold the actuator's parameters, which take the contact engine to make.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from cqdd_design.actuator.parameters import ActuatorParameters
from cqdd_design.errors import UsageError, shown
from cqdd_design.files import WrittenFile, read_arrays, write_with
from cqdd_design.torque.data.episodes import DataSet, Episode
from cqdd_design.torque.features.physics import actuator_from_dict, actuator_to_dict
from cqdd_design.torque.stored import DATA, require

FORMAT = "cqdd-design packed torque data 1"
_MOST_BYTES = 2_000_000_000


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
    arrays, content = read_arrays(path, _MOST_BYTES, "a packed data set; `pack_data` writes one")
    told = content.get("format") if isinstance(content, dict) else None
    if told != FORMAT:
        raise UsageError(f"{path} is {shown(told)}, not '{FORMAT}'; write it anew.")
    require(DATA, content, str(path), "write it anew")
    episodes = []
    for k, one in enumerate(content["episodes"]):
        values = arrays.get(str(k))
        if values is None or values.ndim != 2 or len(values) != len(one["columns"]):
            raise UsageError(f"{path}: episode {one['name']} has other columns; write it anew.")
        columns = dict(zip(one["columns"], values.astype(np.float64), strict=True))
        episodes.append(Episode(one["name"], one["group"], content["dt"], columns))
    low, high = content["torque_range"]
    data = DataSet(
        episodes=tuple(episodes),
        position_gain=content["position_gain"],
        velocity_gain=content["velocity_gain"],
        torque_range=(low, high),
        facts=content["facts"],
    )
    actuator = content["actuator"]
    return data, None if actuator is None else actuator_from_dict(actuator)
