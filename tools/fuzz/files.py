"""Files besides designs, drawn at random: motors, maps, calibrations, tables, arrays, manifests."""

from __future__ import annotations

import copy
import io
import json
import random
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from tools.fuzz.designs import STRANGE

REPOSITORY = Path(__file__).resolve().parents[2]
NETWORKS = sorted((REPOSITORY / "designs").rglob("*.npz"))
_VALUES: tuple[Any, ...] = (
    *(None, True, False, 0, -1, 1, 2, 10**12, 10**400, 0.5, -0.5, 1e308, float("nan")),
    *(float("inf"), "", "a", "1", "\x1b[2J", "../x", [], [1], ["a"], [[1]], {}, {"a": 1}),
)


def damaged(draw: random.Random, content: bytes) -> bytes:
    """A file after a fall: cut, flipped, doubled, or as it was."""
    kind = draw.randrange(5)
    if kind == 0 or not content:
        return content
    if kind == 1:
        return content[: draw.randrange(len(content))]
    if kind == 2:
        return content + draw.randbytes(draw.randint(1, 100))
    flipped = bytearray(content)
    for _ in range(draw.randint(1, 20)):
        flipped[draw.randrange(min(len(flipped), 4000))] ^= 1 << draw.randrange(8)
    return bytes(flipped)


def changed(draw: random.Random, content: Any) -> Any:
    """A JSON document with something else in one to three places."""
    own = json.loads(json.dumps(content))
    for _ in range(draw.randint(1, 3)):
        table: Any = own
        while True:
            keys = list(table) if isinstance(table, dict) else range(len(table))
            if not keys:
                break
            key = draw.choice(list(keys))
            if isinstance(table[key], dict | list) and table[key] and draw.random() < 0.7:
                table = table[key]
                continue
            kind = draw.random()
            if kind < 0.75:
                table[key] = copy.deepcopy(draw.choice(_VALUES))
            elif kind < 0.85 and isinstance(table, dict):
                del table[key]
            elif isinstance(table, dict):
                table[f"{key}x"] = copy.deepcopy(draw.choice(_VALUES))
            break
    return own


def json_bytes(draw: random.Random, content: Any) -> bytes:
    """A JSON document, changed and perhaps damaged."""
    kind = draw.randrange(8)
    if kind == 0:
        return draw.choice(["[", '{"a":', '"']).encode() * draw.choice([10, 100_000])
    if kind == 1:
        return b'{"a": 1' + b"0" * draw.choice([400, 5000]) + b"}"
    text = json.dumps(changed(draw, content)).encode()
    return damaged(draw, text) if kind == 2 else text


def archive(draw: random.Random, arrays: dict[str, Any], content: Any) -> bytes:
    """An ``.npz`` with metadata: changed, crafted or damaged."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", draw.choice([0, zipfile.ZIP_DEFLATED])) as out:
        kind = draw.randrange(10)
        told = content if kind < 3 else changed(draw, content)
        text: Any = np.array(json.dumps(told))
        if kind == 3:
            text = draw.choice([np.zeros(3), np.array(["a", "b"]), np.array("[" * 100_000)])
        if kind != 4:
            out.writestr("metadata.npy", _npy(text))
        for name, values in arrays.items():
            body = _npy(values)
            if draw.random() < 0.1:
                body = _crafted(draw, body)
            if draw.random() < 0.03:
                name = draw.choice([name + "x", "../" + name, "", "metadata"])
            if draw.random() > 0.02:
                out.writestr(f"{name}.npy", body)
    return damaged(draw, made.getvalue()) if kind < 3 else made.getvalue()


def _npy(values: Any) -> bytes:
    made = io.BytesIO()
    np.save(made, values, allow_pickle=True)
    return made.getvalue()


def _crafted(draw: random.Random, body: bytes) -> bytes:
    """An array whose header or values are another's."""
    shapes = ["(1099511627776,)", "(-1,)", "(2, 3)", "()", "(1.5,)", "'a'", "(((", "(9" * 50]
    kinds = ["<f8", "<f4", "|O", "<U4", "|V0", "<c16", "<M8[s]", "nonsense", "<i8", ">f4", "|b1"]
    kind = draw.randrange(4)
    if kind == 0:
        order = draw.choice(["True", "False", "3"])
        told = f"'descr': '{draw.choice(kinds)}', 'fortran_order': {order}"
        head = f"{{{told}, 'shape': {draw.choice(shapes)}, }}\n"
        return b"\x93NUMPY\x01\x00" + len(head).to_bytes(2, "little") + head.encode() + body[-64:]
    if kind == 1:
        return _npy(np.array([{}], object))
    if kind == 2:
        return _npy(np.full(3, draw.choice([np.nan, np.inf, 1e300])))
    return damaged(draw, body)


def motor_file(draw: random.Random) -> bytes:
    """A motor file."""
    from cqdd_design.catalog.motors import CONVENTIONS
    from cqdd_design.design.motor import MotorData
    from cqdd_design.design.tables import field_dimension

    lines, others = [], []
    for key, field in MotorData.model_fields.items():
        dimension = field_dimension(field)
        if dimension is None:
            others.append(key)
        elif draw.random() < 0.15:
            value = f'"{10 ** draw.uniform(-4, 3):.3g} {dimension.unit}"'
            if key in ("torque_constant", "mass") and draw.random() < 0.8:
                continue
            lines.append(f"{key} = {value if draw.random() < 0.93 else draw.choice(STRANGE)}")
    words = [repr(word) for word in (*CONVENTIONS, "line", "phase", "CubeMars RO100 KV55")]
    for key in (*others, "x"):
        if draw.random() < 0.1:
            lines.append(f"{key} = {draw.choice(['4', '1', *words, draw.choice(STRANGE)])}")
    text = "\n".join(lines).encode()
    return damaged(draw, text) if draw.random() < 0.3 else text


def log_map(draw: random.Random) -> bytes:
    """A map of columns."""
    names = ["time", "position", "target", "velocity", "torque", "current", "wall", "x"]
    columns = {name: f'"{name}"' for name in names[:5]}
    if draw.random() < 0.4:
        columns[draw.choice(names)] = draw.choice(['"q"', *STRANGE])
    text = "[columns]\n" + "".join(f"{k} = {v}\n" for k, v in columns.items())
    if draw.random() < 0.5:
        unit = draw.choice(['"rad"', '"deg"', '"N*m"', '"1 9**9"', draw.choice(STRANGE)])
        text += f"[units]\n{draw.choice(names)} = {unit}\n"
    for part in ("constants", "group", "groups", "facts", "nonsense"):
        if draw.random() < 0.15:
            key = draw.choice(["a", "current_to_torque", "mass"])
            text += f"[{part}]\n{key} = {draw.choice(['1', draw.choice(STRANGE)])}\n"
    return damaged(draw, text.encode()) if draw.random() < 0.2 else text.encode()


def table(
    draw: random.Random, head: list[str], rows: int, cell: Callable[[int, int], str]
) -> bytes:
    """A CSV with wrong cells here and there."""
    wrong = [
        "",
        "nan",
        "inf",
        "-inf",
        "1e999",
        "a",
        "1,5",
        '"',
        "1 N",
        "\x00",
        "0x10",
        "9" * 400,
        "é",
    ]
    separator = draw.choice(",,,,;\t")
    lines = [separator.join(head if draw.random() < 0.9 else [*head[:-1], "x"])]
    share = draw.choice([0.0, 0.0, 0.01, 0.2])
    for row in range(rows):
        cells = [
            draw.choice(wrong) if draw.random() < share else cell(row, k) for k in range(len(head))
        ]
        lines.append(separator.join(cells[: len(cells) - (draw.random() < share)]))
    text = draw.choice(["\n", "\n", "\r\n"]).join(lines).encode(draw.choice(["utf-8", "utf-8-sig"]))
    return damaged(draw, text) if draw.random() < 0.3 else text


def log(draw: random.Random) -> bytes:
    """A log of a joint."""
    step = draw.choice([*(6 * [0.005]), 0.0, -0.005, 1e-9])
    return table(
        draw,
        ["time", "q", "q_des", "dq", "tau"],
        draw.choice([0, 1, 2, 50, 400, 400, 400]),
        lambda row, k: (
            f"{row * step:.4f}"
            if k == 0
            else f"{[np.sin, np.sin, np.cos, np.sin][k - 1](0.1 * row) * [1, 1, 20, 5][k - 1]:.5f}"
        ),
    )


def reference(draw: random.Random) -> bytes:
    """A command over time."""
    unit = draw.choice([*(6 * ["N*m"]), "J", "9**9**9", "m^1.4", "", "rad"])
    return table(
        draw,
        [draw.choice(["time [s]", "time [s]", "time [ms]", "time", "t"]), f"torque [{unit}]"],
        draw.choice([0, 1, 2, 60]),
        lambda row, k: f"{row * 0.01:.3f}" if k == 0 else f"{draw.uniform(-1, 1):.3f}",
    )


def measured(draw: random.Random) -> bytes:
    """A table of measurements."""
    from cqdd_design.actuator.bench.metric import METRICS

    names = draw.sample(list(METRICS), min(4, len(METRICS)))
    if draw.random() < 0.2:
        names[0] = draw.choice(["nonsense", "", names[-1]])
    units = [*METRICS.values(), "9**9**9", "m^1.4", "%"]
    return table(
        draw,
        ["name", "value", "unit"],
        len(names),
        lambda row, k: (
            names[row]
            if k == 0
            else f"{10 ** draw.uniform(-3, 3):.3g}"
            if k == 1
            else draw.choice(
                [METRICS.get(names[row], ""), METRICS.get(names[row], ""), draw.choice(units)]
            )
        ),
    )
