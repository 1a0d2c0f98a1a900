"""The grammar of a unit: names, products, quotients and whole powers, and nothing else.

::

    expression = factor { ("*" | "·" | "/" | blank) factor }      from left to right
    factor     = atom [ ("^" | "**") whole number ]               powers to 9; also ² and ³
    atom       = name | "(" expression ")" | "1", as the first of all

What a name means is not known here. A text is read in one pass over at most `LONGEST` characters,
so no text takes long, whatever stands in it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

#: No unit that anybody writes is longer.
LONGEST = 40

_TOKEN = re.compile(
    r"\s*(\*\*|[*·/()^]|[^\W\d][\w°]*?(?=[²³]|[^\w°]|$)|[°%]\w*|[²³]|[+-]?\d+(?:\.\d*)?)"
)
_SUPERSCRIPTS = {"²": 2, "³": 3}
_GREATEST_POWER = 9


def parse_expression(text: str) -> Mapping[str, int]:
    """The names in a unit and their powers, which may be 0.

    Parameters
    ----------
    text : str
        Such as ``"N*m/rad"``.

    Raises
    ------
    ValueError
        When it is too long or does not follow the grammar; the message says what is wrong.

    Examples
    --------
    >>> parse_expression("N*m*s/rad")
    {'N': 1, 'm': 1, 's': 1, 'rad': -1}
    >>> parse_expression("kg m^2")
    {'kg': 1, 'm': 2}
    """
    if len(text) > LONGEST:
        raise ValueError(f"a unit has at most {LONGEST} characters")
    reader = _Reader(_tokens(text))
    powers = reader.expression(first=True)
    if reader.next():
        raise ValueError(f"'{reader.next()}' is out of place")
    return powers


def _tokens(text: str) -> list[str]:
    tokens, place, end = [], 0, len(text.rstrip())
    while place < end:
        found = _TOKEN.match(text, place)
        if found is None:
            raise ValueError(f"{text[place:].strip()[:1]!r} is out of place")
        tokens.append(found[1])
        place = found.end()
    return tokens


class _Reader:
    """The tokens and how far they have been read."""

    def __init__(self, tokens: list[str]) -> None:
        self._tokens = tokens
        self._place = 0

    def next(self) -> str:
        """The token to come, empty at the end."""
        return self._tokens[self._place] if self._place < len(self._tokens) else ""

    def take(self) -> str:
        token = self.next()
        self._place += 1
        return token

    def expression(self, *, first: bool = False) -> dict[str, int]:
        total = self.factor(first=first)
        while self.next() not in ("", ")"):
            sign = -1 if self.next() == "/" else 1
            if self.next() in ("*", "·", "/"):
                self.take()
            for name, power in self.factor().items():
                total[name] = total.get(name, 0) + sign * power
        return total

    def factor(self, *, first: bool = False) -> dict[str, int]:
        inner = self.atom(first=first)
        if self.next() in _SUPERSCRIPTS:
            exponent = _SUPERSCRIPTS[self.take()]
        elif self.next() in ("^", "**"):
            self.take()
            exponent = self.power()
        else:
            return inner
        raised = {name: exponent * power for name, power in inner.items()}
        if any(abs(power) > _GREATEST_POWER for power in raised.values()):
            raise ValueError(f"a power is past {_GREATEST_POWER}")
        return raised

    def atom(self, *, first: bool) -> dict[str, int]:
        token = self.take()
        if token == "(":
            inner = self.expression()
            if self.take() != ")":
                raise ValueError("a bracket is not closed")
            return inner
        if token == "1" and first:
            return {}
        if not token or not (token[0].isalpha() or token[0] in "_°%"):
            raise ValueError(f"'{token}' is out of place" if token else "a unit is missing")
        return {token: 1}

    def power(self) -> int:
        token = self.take()
        try:
            return int(token)
        except ValueError:
            raise ValueError("a power is a whole number, such as m^2") from None
