"""Plain data as YAML 1.1 that 1.2 readers take alike: block style, strings in JSON's quotes."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping, Sequence

_PLAIN = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_WORDS = {"y", "n", "yes", "no", "on", "off", "true", "false", "null", "none"}


def yaml_text(document: Mapping[str, object]) -> str:
    """Return `document` of mappings, sequences, strings, numbers and None as YAML.

    Numbers that are not finite become null.
    """
    return "\n".join(_mapping(document, 0)) + "\n"


def _mapping(mapping: Mapping[str, object], depth: int) -> list[str]:
    lines: list[str] = []
    for key, value in mapping.items():
        lines += _entry(f"{'  ' * depth}{_key(key)}:", value, depth)
    return lines


def _entry(head: str, value: object, depth: int) -> list[str]:
    if isinstance(value, Mapping) and value:
        return [head, *_mapping(value, depth + 1)]
    if isinstance(value, Sequence) and not isinstance(value, str) and value:
        return [head, *(f"{'  ' * (depth + 1)}- {_scalar(one)}" for one in value)]
    return [f"{head} {_scalar(value)}"]


def _key(key: str) -> str:
    return key if _PLAIN.fullmatch(key) and key.lower() not in _WORDS else _scalar(key)


def _scalar(value: object) -> str:
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return _float(value)
    if isinstance(value, Mapping):
        return "{}" if not value else json.dumps(value, ensure_ascii=False)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    return json.dumps(list(value), ensure_ascii=False)  # type: ignore[call-overload]


def _float(value: float) -> str:
    """With a point, as YAML 1.1 takes 1e-05 for text."""
    if not math.isfinite(value):
        return "null"
    mantissa, mark, exponent = f"{value:.12g}".partition("e")
    return mantissa + ("" if "." in mantissa else ".0") + mark + exponent
