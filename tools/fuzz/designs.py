"""Designs drawn at random: sensible ones, ones with single wrong values, and broken files."""

from __future__ import annotations

import random
from typing import Any, get_args

from cqdd_design.catalog import bearings, materials, motors
from cqdd_design.design import Design
from cqdd_design.design.fields import Share, Whole
from cqdd_design.design.motor import MotorData
from cqdd_design.units import QuantityIn

#: What nobody should type, and somebody will.
STRANGE = (
    *('"1 9**9**9**9*N*m"', '"0.1 m^1.4"', '"nan mm"', '"inf mm"', '"1e999 mm"', '"-0 mm"', '""'),
    *('"1 mm\\u001b[2J"', '"\\u202e1 mm"', '"1 J"', '"1 Hz"', '"1"', '"mm"', '"1 mm mm"', '"auto"'),
    *("0", "-1", "1.5", "nan", "inf", "-inf", "true", "[]", "{}", "[[1]]", '["a"]', "{a = 1}"),
    *("1" + 400 * "0", "1" + 5000 * "0", "0x" + 500 * "f", "1e400", "1979-05-27T07:32:00Z"),
    *('"' + 1000 * "x" + '"', '"' + 100 * "é" + '"', '"1 ' + 300 * "(" + '"', '"6902"'),
)
_RARE_TEXT = ("a", "Knie", "名前", "a b", "..", "a/b", "a\\u0000b", "a\\u200bb", "\\ufeff", "CON")


def _rules() -> dict[str, Any]:
    """What each dotted key of a design may be."""
    found: dict[str, Any] = {}

    def walk(model: Any, prefix: str) -> None:
        for name, info in model.model_fields.items():
            if hasattr(info.annotation, "model_fields"):
                walk(info.annotation, f"{prefix}{name}.")
            elif name not in {"schema_version", "duty"}:
                rule = next(
                    (m for m in info.metadata if isinstance(m, QuantityIn | Whole | Share)), None
                )
                kinds = [one for one in get_args(info.annotation) if one is not type(None)]
                optional = len(kinds) == 1 and len(get_args(info.annotation)) == 2
                kind = kinds[0] if optional else info.annotation
                found[f"{prefix}{name}"] = rule or (kind, name)

    walk(Design, "")
    return found


RULES = _rules()


def allowed(draw: random.Random, key: str) -> str:
    """A value of a key within its range, as TOML."""
    rule = RULES[key]
    if isinstance(rule, QuantityIn):
        low, high = (float(text.split()[0]) for text in (rule.low, rule.high))
        unit = rule.high.split(" ", 1)[1]
        value = draw.uniform(low, high)
        if low > 0.0 and draw.random() < 0.5:
            value = low * (high / low) ** draw.random()
        return f'"{draw.choice([value, value, low, high]):.6g} {unit}"'
    if isinstance(rule, Whole):
        return str(draw.randint(rule.low, rule.high))
    if isinstance(rule, Share):
        return f"{draw.uniform(rule.low, rule.high):.6g}"
    kind, name = rule
    if kind is bool:
        return draw.choice(["true", "false"])
    if get_args(kind):
        return _quoted(str(draw.choice(get_args(kind))))
    if "material" in name:
        return _quoted(draw.choice(list(materials())))
    if name == "designation":
        return _quoted(draw.choice(["auto", *bearings()]))
    if name in ("motor", "based_on") or (name == "name" and key.startswith("motor")):
        bare = [name for name, one in motors().items() if one.torque_at == "motor"]
        return _quoted(draw.choice(bare))
    return f'"{draw.choice(_RARE_TEXT)}"' if draw.random() < 0.3 else '"something"'


def _quoted(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def sensible(draw: random.Random) -> dict[str, str]:
    """Keys of a design that is likely to exist."""
    ratio = draw.choice([draw.randint(4, 40), draw.randint(4, 119)])
    radius = draw.uniform(15.0, 60.0)
    share = draw.uniform(0.2, 0.85)
    pitch = 2.0 * radius * 3.14159 / (ratio + 1)
    values = {
        "reducer.ratio": str(ratio),
        "reducer.ring_pitch_radius": f'"{radius:.4g} mm"',
        "reducer.eccentricity": f'"{max(share * radius / (ratio + 1), 0.011):.4g} mm"',
        "reducer.ring_pin_diameter": f'"{max(pitch * draw.uniform(0.2, 0.6), 0.31):.4g} mm"',
    }
    if draw.random() < 0.6:
        values["requirements.peak_torque"] = f'"{draw.uniform(1.0, 150.0):.4g} N*m"'
    if draw.random() < 0.6:
        values["requirements.outer_diameter"] = f'"{2.3 * radius:.4g} mm"'
    for key in draw.sample(CALM, draw.randint(0, 4)):
        values[key] = allowed(draw, key)
    if draw.random() < 0.5:
        values["reducer.output_pins.count"] = str(draw.randint(3, 12))
        values["reducer.output_pins.diameter"] = f'"{radius * draw.uniform(0.05, 0.2):.3g} mm"'
    if draw.random() < 0.3:
        joint = draw.choice(["clamped", "hinged", "columns"])
        values["reducer.carrier.joint"] = f'"{joint}"'
        if joint == "columns":
            diameter = f'"{draw.uniform(3.0, 0.25 * radius):.3g} mm"'
            values["reducer.carrier.column_diameter"] = diameter
    return values


_OF_MOTOR = {f"motor.{name}" for name in MotorData.model_fields if name != "name"}

#: Keys that may be anything in their range and leave most designs possible.
CALM = [
    key
    for key, rule in RULES.items()
    if (
        isinstance(rule, tuple | Share)
        or key.startswith(("motor.", "drive.", "tolerances.", "edm."))
        or key.endswith("disc_count")
    )
    # These go together.
    and not key.startswith("reducer.carrier.")
    and key not in _OF_MOTOR
]


def toml(values: dict[str, str]) -> str:
    """A design file of dotted keys and TOML values."""
    return "".join(f"{key} = {value}\n" for key, value in values.items())


def duty(draw: random.Random, *, wrong: bool) -> str:
    """Steps of a duty cycle."""
    count = draw.randint(1, 4)
    lines = []
    for _ in range(count):
        share = 1.0 / count if not wrong else draw.choice([0.3, -1, 2, "nan", '"a"'])
        speed = '"10 rad/s"' if not wrong else draw.choice(['"10 rad/s"', *STRANGE])
        key = "share" if not wrong or draw.random() < 0.5 else draw.choice(["shares", "time", "x"])
        lines.append(
            f'[[requirements.duty]]\ntorque = "{draw.uniform(-20, 20):.3g} N*m"\n'
            f"speed = {speed}\n{key} = {share}\n"
        )
    return "".join(lines)


def with_strange_values(draw: random.Random) -> str:
    """A design with one to three values, keys or tables that are wrong."""
    values = sensible(draw)
    for _ in range(draw.randint(1, 3)):
        key = draw.choice(list(RULES))
        kind = draw.random()
        if kind < 0.5:
            values[key] = draw.choice(STRANGE)
        elif kind < 0.7:
            values[key] = allowed(draw, draw.choice(list(RULES)))
        elif kind < 0.8:
            values[key + draw.choice("sx_1")] = "1"
        elif kind < 0.9:
            values[draw.choice(["reducer", "name", "schema_version", "edm", "x"])] = draw.choice(
                STRANGE
            )
        else:
            values.pop(draw.choice(list(values)))
    text = toml(values)
    return text + duty(draw, wrong=True) if draw.random() < 0.2 else text


def broken_bytes(draw: random.Random) -> bytes:
    """A file that is hardly a design: cut, flipped, in another coding, or very large."""
    whole = toml(sensible(draw)).encode()
    kind = draw.randrange(12)
    if kind == 0:
        return whole[: draw.randrange(len(whole))]
    if kind == 1:
        damaged = bytearray(whole)
        for _ in range(draw.randint(1, 8)):
            damaged[draw.randrange(len(damaged))] ^= 1 << draw.randrange(8)
        return bytes(damaged)
    if kind == 2:
        return whole.decode().encode(draw.choice(["utf-16", "utf-16-le", "utf-32", "utf-8-sig"]))
    if kind == 3:
        return draw.randbytes(draw.randint(0, 4000))
    if kind == 4:
        dots = draw.choice([".", " . ", '"."']) if draw.random() < 0.5 else "."
        return ("a" + (dots + "a") * draw.choice([50, 5000, 50_000]) + " = 1\n").encode() + whole
    if kind == 5:
        bracket = draw.choice(["[", "{a=", "[[", "(", '"', "'", '"""', "#"])
        return whole + b"x = " + bracket.encode() * draw.choice([100, 10_000, 100_000])
    if kind == 6:
        digits = draw.choice(["1", "9_9", "0x" + "f" * 99, "-1", "1.1", "1e9"]) + draw.choice(
            "0123"
        ) * draw.choice([400, 5000, 900_000])
        return whole + f"edm.spark_gap = {digits}\n".encode()
    if kind == 7:
        return (
            whole
            + (draw.choice(["k{i} = 1\n", "[t{i}]\n", "[[t]]\n", "#{i}\n"]) * 1).encode() * 1
            + "".join(f"q{i} = {i}\n" for i in range(draw.choice([10, 20_000]))).encode()
        )
    if kind == 8:
        word = draw.choice(["name", "reducer.friction.lubricant", "motor.name"])
        code = draw.choice([*range(32), 127, 0x85, 0x200B, 0x202E, 0x2066, 0xFEFF, 0x2028, 0xE000])
        return f'{word} = "a\\u{code:04x}b"\n'.encode() + whole
    if kind == 9:
        return whole + whole
    if kind == 10:
        return whole.replace(b"\n", draw.choice([b"\r\n", b"\r", b"\x00\n", b"\x0b\n", b" \n"]))
    return whole + b'name = "' + "é".encode() * draw.choice([10, 100, 400_000]) + b'"\n'
