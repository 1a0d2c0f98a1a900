"""Formulas of the checks as MathML: ``p0 = sqrt(F E*/(pi b R_eq))`` drawn with roots and fractions.

The checks write their rules as plain text, for the terminal. This small parser reads that text::

    relation := sum (("=" | "<=" | ">=" | "<" | ">" | ",") sum)*
    sum      := term (("+" | "-") term)*
    term     := factor (("x" | "*" | "/" | nothing) factor)*
    factor   := atom ("^" atom)*
    atom     := number | name | "(" relation ")" | "|" sum "|" | "sqrt" "(" sum ")"

``/`` divides everything that stands before it in its term, as in print: ``4 F/(pi d^2)``. Names
may carry an index after ``_``; longer words are upright text. What does not parse stays text.
"""

from __future__ import annotations

import html
import re
from unicodedata import lookup

_LETTERS = "alpha beta delta gamma eta kappa mu nu omega phi pi psi rho sigma tau theta"
_GREEK = {name: lookup(f"GREEK SMALL LETTER {name}") for name in _LETTERS.split(" ")}
_FUNCTIONS = {"sin", "cos", "tan", "min", "max", "ln"}
_UPRIGHT = {"HB", "HRC", "MPa", "mm", "rpm", "h", "N", "W", "um", "KV"}
_RELATIONS = {"=": "=", "<=": "\u2264", ">=": "≥", "<": "<", ">": ">", ",": ","}

_TOKEN = re.compile(
    r"\s*(?:"
    r"(?P<number>\d+(?:\.\d+)?(?:e[+-]?\d+)?)"
    r"|(?P<name>E\*|[A-Za-z]{2,}(?:-[a-z]{2,})+|[A-Za-z]+\d*[a-z]?(?:_(?:[A-Za-z0-9]+(?:,[a-z]+)*))?(?:\.[a-z_]+)*)"
    r"|(?P<op><=|>=|[-+*/^()=<>|,])"
    r")"
)


class _NotAFormula(Exception):
    """The text is prose, or uses a sign this parser does not know."""


def mathml(formula: str) -> str:
    """A formula as HTML with MathML; a side that is prose, or does not parse, stays text.

    Each clause and each side of a relation is an element of its own, so long rules wrap.

    Examples
    --------
    >>> mathml("C >= P")
    '<math displaystyle="true"><mi>C</mi></math> ≥ <math displaystyle="true"><mi>P</mi></math>'
    """
    return ", ".join(_clause(clause) for clause in _split(formula, ", "))


def _clause(clause: str) -> str:
    pieces = []
    for piece in re.split(r" (<=|>=|=|<|>) ", clause):
        sign = _RELATIONS.get(piece)
        pieces.append(html.escape(sign) if sign else _side(piece))
    return " ".join(pieces)


def _side(side: str) -> str:
    words = re.findall(r"(?<![\w_])[A-Za-z][a-z-]+(?![\w_(])", side)
    if sum(word not in _GREEK and word != "sum" for word in words) <= 3:
        try:
            return f'<math displaystyle="true">{_Parser(side).whole()}</math>'
        except _NotAFormula:
            pass
    return f'<span class="prose-formula">{lowered(signs(side))}</span>'


def signs(prose: str) -> str:
    """Letters, powers, degrees and minus signs as print has them, in prose with some symbols.

    Examples
    --------
    >>> signs("tau_B = F/(pi/4 d^2) along its seam, 30deg")
    'τ_B = F/(π/4 d²) along its seam, 30°'
    """
    prose = re.sub(rf"(?<![\w.])({'|'.join(_GREEK)})(?=_|\b)", lambda name: _GREEK[name[1]], prose)
    prose = prose.replace("^2", "²").replace("^3", "³").replace(" - ", " \u2212 ")
    return re.sub(r"(?<=\d) ?deg\b", "°", prose)


def lowered(prose: str) -> str:
    """Escaped prose in which symbols such as ``S_y`` and ``K_Hbeta`` have their index lowered.

    Examples
    --------
    >>> lowered("S_y/1.2 of the weaker part")
    '<i>S</i><sub>y</sub>/1.2 of the weaker part'
    """

    def shown(found: re.Match[str]) -> str:
        index = re.sub(r"(alpha|beta|gamma)$", lambda name: _GREEK[name[1]], found[2])
        return f"<i>{_GREEK.get(found[1], found[1])}</i><sub>{index}</sub>"

    symbol = r"\b([^\W\d_]|sigma|tau|rho|eta)_([A-Za-z0-9]+)\b"
    return re.sub(symbol, shown, html.escape(prose))


def _split(text: str, separator: str) -> list[str]:
    """The parts between separators that stand outside parentheses."""
    parts, depth, start = [], 0, 0
    for index, sign in enumerate(text):
        depth += (sign == "(") - (sign == ")")
        if depth == 0 and text.startswith(separator, index):
            parts.append(text[start:index])
            start = index + len(separator)
    return [*parts, text[start:]]


def _tokens(text: str) -> list[tuple[str, str]]:
    found, position = [], 0
    text = text.rstrip()
    while position < len(text):
        match = _TOKEN.match(text, position)
        if match is None:
            raise _NotAFormula(text)
        kind = match.lastgroup or ""
        found.append((kind, match.group(kind)))
        position = match.end()
    return found


class _Parser:
    """Recursive descent over the tokens; every method returns MathML."""

    def __init__(self, text: str) -> None:
        self.tokens = _tokens(text)
        self.at = 0

    def whole(self) -> str:
        result = self.relation()
        if self.at < len(self.tokens):
            raise _NotAFormula
        return result

    def peek(self) -> tuple[str, str]:
        return self.tokens[self.at] if self.at < len(self.tokens) else ("end", "")

    def take(self) -> tuple[str, str]:
        token = self.peek()
        self.at += 1
        return token

    def expect(self, sign: str) -> None:
        if self.take() != ("op", sign):
            raise _NotAFormula

    def relation(self) -> str:
        parts = [self.sum()]
        while self.peek()[0] == "op" and self.peek()[1] in _RELATIONS:
            sign = self.take()[1]
            space = ' lspace="0" rspace="0.9em"' if sign == "," else ""
            parts.append(f"<mo{space}>{html.escape(_RELATIONS[sign])}</mo>")
            if self.peek()[0] == "end":
                raise _NotAFormula
            parts.append(self.sum())
        return "".join(parts)

    def sum(self) -> str:
        parts = []
        if self.peek() == ("op", "-"):
            self.take()
            parts.append("<mo>\u2212</mo>")
        parts.append(self.term())
        while self.peek() in (("op", "+"), ("op", "-")):
            sign = "+" if self.take()[1] == "+" else "\u2212"
            parts += [f"<mo>{sign}</mo>", self.term()]
        return "".join(parts)

    def term(self) -> str:
        above = [self.factor()]
        while True:
            kind, value = self.peek()
            if (kind, value) == ("op", "/"):
                self.take()
                if len(above) == 1:
                    above = [_without_parentheses(above[0])]
                below = self.factor(bare=True)
                above = [f"<mfrac>{_row(_joined(above))}{_row(below)}</mfrac>"]
            elif (kind, value) in (("op", "*"), ("name", "x")):
                self.take()
                above += ["<mo>\u00d7</mo>", self.factor()]
            elif kind in ("number", "name") or value in ("(",) or self._opens_bars(value):
                above.append(self.factor())
            else:
                return _joined(above)

    def _opens_bars(self, value: str) -> bool:
        return value == "|" and not self.inside_bars

    inside_bars = False

    def factor(self, *, bare: bool = False) -> str:
        """An atom with its powers; `bare` drops the parentheses of a lone denominator."""
        base = self.atom(bare=bare)
        while self.peek() == ("op", "^"):
            self.take()
            base = f"<msup>{_row(base)}{_row(self.atom(bare=True))}</msup>"
        return base

    def atom(self, *, bare: bool) -> str:
        kind, value = self.take()
        if kind == "number":
            return _number(value)
        if kind == "name":
            return self.named(value)
        if value == "(":
            inside = self.relation()
            self.expect(")")
            if bare and self.peek() != ("op", "^"):
                return inside
            return f"{_OPEN}{inside}{_CLOSE}"
        if value == "|":
            self.inside_bars = True
            inside = self.sum()
            self.inside_bars = False
            self.expect("|")
            return f"<mrow><mo>|</mo>{inside}<mo>|</mo></mrow>"
        raise _NotAFormula

    def named(self, name: str) -> str:
        if name == "sqrt":
            self.expect("(")
            inside = self.relation()
            self.expect(")")
            return f"<msqrt>{inside}</msqrt>"
        if name == "sum":
            return "<mo>\u2211</mo>"
        if name in _FUNCTIONS and self.peek() == ("op", "("):
            return f"<mi>{name}</mi>"
        return _symbol(name)


_OPEN, _CLOSE = "<mrow><mo>(</mo>", "<mo>)</mo></mrow>"


def _without_parentheses(atom: str) -> str:
    """The inside of a lone parenthesis, which a fraction bar makes superfluous."""
    if not (atom.startswith(_OPEN) and atom.endswith(_CLOSE)):
        return atom
    return f"<mrow>{atom[len(_OPEN) : -len(_CLOSE)]}</mrow>"


def _row(content: str) -> str:
    return f"<mrow>{content}</mrow>" if content.count("<") > 2 else content


def _joined(factors: list[str]) -> str:
    pieces: list[str] = []
    for factor in factors:
        both_text = bool(pieces) and pieces[-1].startswith("<mtext") and factor.startswith("<mtext")
        if both_text:
            pieces[-1] = pieces[-1].replace("</mtext>", "") + "\u00a0" + factor[len("<mtext>") :]
            continue
        if pieces and not pieces[-1].startswith("<mo") and not factor.startswith("<mo"):
            wide = pieces[-1].startswith("<mtext") or factor.startswith("<mtext")
            pieces.append(f'<mspace width="{0.25 if wide else 0.17}em"></mspace>')
        pieces.append(factor)
    return "".join(pieces)


def _number(value: str) -> str:
    if "e" in value:
        mantissa, _, power = value.partition("e")
        exponent = f"<msup><mn>10</mn><mn>{int(power)}</mn></msup>"
        return exponent if mantissa == "1" else f"<mn>{mantissa}</mn><mo>\u00d7</mo>{exponent}"
    return f"<mn>{value}</mn>"


def _symbol(name: str) -> str:
    if name == "E*":
        return "<msup><mi>E</mi><mo>*</mo></msup>"
    head, _, index = name.partition("_")
    digits = re.fullmatch(r"([A-Za-z])(\d+[a-z]?)", head)
    if digits and not index:
        head, index = digits.group(1), digits.group(2)
    is_symbol = len(head) == 1 or head in _GREEK
    if name in _UPRIGHT or (not index and not is_symbol) or "." in name:
        return f"<mtext>{html.escape(name)}</mtext>"
    if len(head) > 1 and head not in _GREEK:
        base = f'<mi mathvariant="normal">{html.escape(head)}</mi>'
    else:
        base = f"<mi>{_GREEK.get(head, head)}</mi>"
    if not index:
        return base
    if index.isdigit():
        return f"<msub>{base}<mn>{index}</mn></msub>"
    shown = ",\u202f".join(index.split(","))
    lowered = f"<mi>{shown}</mi>" if len(shown) == 1 else f"<mtext>{html.escape(shown)}</mtext>"
    return f"<msub>{base}{lowered}</msub>"
