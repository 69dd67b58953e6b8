"""A formula of one variable, read from a text such as ``x^1.6`` or ``2*sin(x) - 1``.

::

    sum      product (("+" | "-") product)*
    product  signed (("*" | "/") signed)*
    signed   ("-" | "+") signed | power
    power    atom (("^" | "**") signed)?          from the right: 2^3^2 = 2^9, and -x^2 = -(x^2)
    atom     number | "x" | "pi" | "e" | name "(" sum ")" | "(" sum ")"

No text is executed: anything outside these rules is refused.
"""

import math
import operator
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from models.array import Array
from models.errors import CrankcheckError, cut, suggestion

LONGEST_TEXT = 200
"""Largest number of characters of a formula: no function of a textbook comes near it."""
DEEPEST = 30
"""Largest depth of parentheses, signs and powers."""
VARIABLE = "x"
CONSTANTS: Mapping[str, float] = {"pi": math.pi, "e": math.e}
FUNCTIONS: Mapping[str, Callable[[Array], Array]] = {
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "exp": np.exp,
    "log": np.log,
    "log10": np.log10,
    "sqrt": np.sqrt,
    "abs": np.abs,
}
OPERATORS: Mapping[str, Callable[[Array, Array], Array]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    "^": operator.pow,
    "**": operator.pow,
}
TOKEN = re.compile(
    r"(?P<number>(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?)"
    r"|(?P<name>[A-Za-z_]\w*)|(?P<sign>\*\*|[-+*/^()])|(?P<space>\s+)|(?P<other>.)",
    re.ASCII | re.DOTALL,
)

Evaluation = Callable[[Array], Array]


@dataclass(frozen=True)
class Formula:
    """A text and its values over ``x``; made by `parse_formula`."""

    text: str
    evaluation: Evaluation = field(repr=False, compare=False)

    def at(self, x: Array) -> Array:
        """Return its values, the shape of ``x``; nan or inf where undefined. Angles are rad."""
        with np.errstate(all="ignore"):
            values = self.evaluation(np.asarray(x, dtype=np.float64))
        return np.array(np.broadcast_to(values, np.shape(x)), dtype=np.float64)


def parse_formula(text: str) -> Formula:
    """Parse a formula by the rules above. Raises CrankcheckError for text that is none: the message
    gives the character, its place and the expected tokens."""
    if len(text) > LONGEST_TEXT:
        raise CrankcheckError(
            f"a formula of {len(text)} characters was given; at most {LONGEST_TEXT} are read: "
            "give a table of the function instead"
        )
    return Formula(text.strip(), _Reader(text).read())


@dataclass(frozen=True)
class _Token:
    kind: str
    text: str
    place: int


class _Reader:
    """A reader of a text from left to right by the rules."""

    def __init__(self, text: str) -> None:
        self.text = text
        matches = [m for m in TOKEN.finditer(text) if m.lastgroup != "space"]
        self.tokens = [_Token(str(m.lastgroup), m[0], m.start() + 1) for m in matches]
        self.tokens.append(_Token("end", "", len(text) + 1))
        self.next = 0
        self.depth = 0

    def read(self) -> Evaluation:
        """Read the whole text."""
        whole = self._sum()
        if self._look().kind != "end":
            raise self._fault("an operator (+ - * / ^) or the end")
        return whole

    def _look(self) -> _Token:
        return self.tokens[self.next]

    def _take(self, *texts: str) -> str | None:
        token = self._look()
        if token.kind != "sign" or token.text not in texts:
            return None
        self.next += 1
        return token.text

    def _sum(self) -> Evaluation:
        left = self._product()
        while sign := self._take("+", "-"):
            left = _joined(sign, left, self._product())
        return left

    def _product(self) -> Evaluation:
        left = self._signed()
        while sign := self._take("*", "/"):
            left = _joined(sign, left, self._signed())
        return left

    def _signed(self) -> Evaluation:
        self.depth += 1
        if self.depth > DEEPEST:
            raise CrankcheckError(
                f"formula {cut(self.text)!r}: more than {DEEPEST} parentheses, signs or powers "
                "stand within each other; write it flatter"
            )
        sign = self._take("-", "+")
        inner = self._signed() if sign else self._power()
        self.depth -= 1
        return _applied(np.negative, inner) if sign == "-" else inner

    def _power(self) -> Evaluation:
        base = self._atom()
        sign = self._take("^", "**")
        return _joined(sign, base, self._signed()) if sign else base

    def _atom(self) -> Evaluation:
        token = self._look()
        if token.kind == "number":
            self.next += 1
            return _constant(float(token.text))
        if token.kind == "name":
            return self._named(token)
        if self._take("(") is None:
            raise self._fault('a number, "x", a function or "("')
        return self._closed()

    def _named(self, token: _Token) -> Evaluation:
        self.next += 1
        if token.text == VARIABLE:
            return lambda x: x
        if token.text in CONSTANTS:
            return _constant(CONSTANTS[token.text])
        if token.text not in FUNCTIONS:
            names = [VARIABLE, *CONSTANTS, *FUNCTIONS]
            cure = suggestion(token.text, names, "it may name", cutoff=0.6)
            raise CrankcheckError(
                f"formula {cut(self.text)!r}: {cut(token.text)!r} at character {token.place} is "
                f"not understood; {cure}"
            )
        if self._take("(") is None:
            raise self._fault(f'"(" after {token.text}')
        return _applied(FUNCTIONS[token.text], self._closed())

    def _closed(self) -> Evaluation:
        """Read the inside of parentheses, of which the first is read."""
        inner = self._sum()
        if self._take(")") is None:
            raise self._fault('an operator or ")"')
        return inner

    def _fault(self, wanted: str) -> CrankcheckError:
        token = self._look()
        there = "the end" if token.kind == "end" else repr(cut(token.text))
        return CrankcheckError(
            f"formula {cut(self.text)!r}: at character {token.place} stands {there}, where "
            f"{wanted} was expected"
        )


def _constant(value: float) -> Evaluation:
    number = np.array(value)
    return lambda x: number


def _applied(function: Callable[[Array], Array], inner: Evaluation) -> Evaluation:
    return lambda x: function(inner(x))


def _joined(sign: str, left: Evaluation, right: Evaluation) -> Evaluation:
    join = OPERATORS[sign]
    return lambda x: join(left(x), right(x))
