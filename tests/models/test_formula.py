"""Formulas of one variable: what a text says, and what is refused."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

from models.errors import CrankcheckError
from models.formula import DEEPEST, FUNCTIONS, LONGEST_TEXT, parse_formula

X = np.linspace(0.3, 0.9, 7)


@pytest.mark.parametrize(("text", "value"), [
    ("x^1.6", X**1.6),
    ("x**1.6", X**1.6),
    ("-x^2", -(X**2)),
    ("(-x)^2", X**2),
    ("2^3^2", np.full(7, 512.0)),
    ("2^-x", 2.0**-X),
    ("1 - 2 - x", -1.0 - X),
    ("8/4/x", 2.0 / X),
    ("2+3*x", 2.0 + 3.0 * X),
    ("--x", X),
    ("1e-2*x + .5 + 3.", 0.01 * X + 3.5),
    ("e^(pi*x)", np.exp(np.pi * X)),
    ("2*sin(x) + cos(2*x)/tan(x)", 2 * np.sin(X) + np.cos(2 * X) / np.tan(X)),
    ("log10(x) - log(x)/log(10)", np.zeros(7)),
    ("sqrt(abs(-x))*exp(-x)", np.sqrt(X) * np.exp(-X)),
    ("asin(x)+acos(x)-atan(x)", np.pi / 2 - np.arctan(X)),
    ("5", np.full(7, 5.0)),
])  # fmt: skip
def test_a_text_has_the_value_that_a_reader_expects(text: str, value: object) -> None:
    np.testing.assert_allclose(parse_formula(text).at(X), value, rtol=1e-14, atol=1e-15)


def test_every_function_is_that_of_mathematics() -> None:
    for name in FUNCTIONS:
        own = {"abs": abs}.get(name) or getattr(math, name)
        value = parse_formula(f"{name}(x)").at(np.array([0.37]))[0]
        assert value == pytest.approx(own(0.37), rel=1e-15), name


@pytest.mark.parametrize(("text", "says"), [
    ("", "at character 1 stands the end, where a number"),
    ("x +", "at character 4 stands the end, where a number"),
    ("2x", "at character 2 stands 'x', where an operator"),
    ("sinh(x)", "'sinh' at character 1 is not understood; did you mean sin"),
    ("y^2", "'y' at character 1 is not understood; it may name x, pi, e, sin"),
    ("sin x", "at character 5 stands 'x', where \"(\" after sin"),
    ("(x", "at character 3 stands the end, where an operator or"),
    ("x)", "at character 2 stands ')'"),
    ("x,5", "at character 2 stands ','"),
    ("x^^2", "at character 3 stands '^'"),
    ("1_000", "at character 2 stands '_000'"),
    ("1j*x", "at character 2 stands 'j'"),
    ("0x10", "at character 2 stands 'x10'"),
    ("__import__('os')", "'__import__' at character 1 is not understood"),
    ("x.real", "at character 2 stands '.'"),
    ("x²", "at character 2 stands '²'"),
    ("(" * (DEEPEST + 1) + "x", "stand within each other"),
    ("-" * (DEEPEST + 1) + "x", "stand within each other"),
    ("x+" * LONGEST_TEXT, f"at most {LONGEST_TEXT} are read"),
])  # fmt: skip
def test_what_is_no_formula_is_refused_with_its_place(text: str, says: str) -> None:
    with pytest.raises(CrankcheckError) as told:
        parse_formula(text)
    assert says in str(told.value)


def test_where_it_is_not_defined_it_is_no_number() -> None:
    for text, at in (("1/x", 0.0), ("log(x)", 0.0), ("sqrt(x)", -1.0), ("x^0.5", -1.0)):
        assert not np.isfinite(parse_formula(text).at(np.array([at]))[0]), text
    assert not np.isfinite(parse_formula("9^9^9^9").at(np.array([1.0]))[0])


def test_no_text_does_anything_but_be_read_or_refused() -> None:
    rng = random.Random(7)
    parts = ["x", "2", "1.5", "(", ")", "+", "-", "*", "/", "^", "**", "sin(", "e", " ", "pi", "?"]
    read = 0
    for _ in range(3000):
        text = "".join(rng.choices(parts, k=rng.randrange(1, 25)))
        try:
            formula = parse_formula(text)
        except CrankcheckError:
            continue
        assert formula.at(X).shape == X.shape
        read += 1
    assert read > 50
