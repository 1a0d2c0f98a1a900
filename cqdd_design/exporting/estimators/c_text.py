"""Pieces of C: templates of this chapter, what fills them, and arrays of numbers.

Templates stand in ``templates/``, with the network's name for ``@name@`` and ``@NAME@`` and other
words between signs for what is filled in.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from importlib import resources

ACTIVATIONS = {
    "relu": "return x > 0.0f ? x : 0.0f;",
    "tanh": "return @name@_tanh(x);",
    "softsign": "return x / (1.0f + (x < 0.0f ? -x : x));",
    "elu": """\
/* exp(x) - 1 by the tangent of half of it, without loss near zero */
    const float t = @name@_tanh(0.5f * (x < -15.0f ? -15.0f : x));
    return x > 0.0f ? x : 2.0f * t / (1.0f - t);""",
}
"""What a dense layer's activation returns."""


@functools.cache
def template(name: str) -> str:
    """The text of ``templates/NAME.h``."""
    return (resources.files(__package__) / "templates" / f"{name}.h").read_text("utf-8")


def filled(text: str, values: Mapping[str, str]) -> str:
    """`text` with a value for every ``@KEY@``, one after the other."""
    for key, value in values.items():
        text = text.replace(f"@{key}@", value)
    return text


def array(declared: str, numbers: Sequence[str], per_line: int) -> str:
    """A constant array, such as ``float name[3]``, of numbers that are literals already."""
    rows = ["    " + ", ".join(numbers[i : i + per_line]) for i in range(0, len(numbers), per_line)]
    return f"static const {declared} = {{\n" + ",\n".join(rows) + "\n};\n"
