"""Task files, and formulas of one variable: what they say, and what is refused in one message."""

import math
import random
from pathlib import Path

import numpy as np
import pytest

from models.errors import CrankcheckError, SceneError
from models.lectures.formula import DEEPEST, FUNCTIONS, LONGEST_TEXT, parse_formula
from models.lectures.tasks import find_task, load_task, shipped_tasks
from models.lectures.tasks.positions import CouplerTask

HEAD = 'name = "x"\nsource = "a test"\n'
A, B = "{ point_m = [0.0, 0.0], angle_deg = 0.0 }", "{ point_m = [0.1, 0.0], angle_deg = 10.0 }"
C, D = "{ point_m = [0.2, 0.1], angle_deg = 30.0 }", "{ point_m = [0.3, 0.1], angle_deg = 50.0 }"
MOVING = "moving_m = [[0.0, 0.0], [0.1, 0.0]]"
TWO, THREE = f"positions = [{A}, {B}]", f"positions = [{A}, {B}, {C}]"
BODY = "positions = [{{ points = {{ {0} = [0.0, 0.0], D = [1.0, 0.0] }} }}, {1}]"
QUICK = "time_ratio = 2.0\nmechanism = "


@pytest.mark.parametrize(
    ("kind", "name"), [(kind, name) for kind, names in shipped_tasks().items() for name in names]
)
def test_shipped_tasks_are_named_as_their_files_and_have_a_source(kind: str, name: str) -> None:
    task = load_task(kind, name)
    assert task.name == name
    assert task.source


FAULTS: dict[str, list[tuple[str, str]]] = {
    "coupler": [
        (f"positions = [{A}]", "at least 2"),
        (TWO, "moving_m: missing"),
        (f"positions = [{A}, {B}, {C}, {D}, {A}, {B}]", "at most 5"),
        (f"positions = [{A}, {B}, {C}, {D}]\n{MOVING}", "leave it out"),
        (f"{TWO}\nfixed_m = [[0.0, 0.0], [1.0, 0.0]]", "for three"),
        (f"{THREE}\n{MOVING}\ndistances_m = [0.1, 0.2]", "leave it out"),
        (f"{THREE}\n{MOVING}\ndriving_dyad = true", "between two"),
        (BODY.format("C", A), "in the same form"),
        (BODY.format("C", "{ points = { C = [0.0, 0.0], D = [0.0, 1.1] } }"),
         "1 m apart in position 1 and 1.1 m in position 2; a body is rigid"),
        (BODY.format("O2", "{ points = { O2 = [0.0, 0.0], D = [0.0, 1.0] } }"),
         "O2: solutions have pivots and links of that name"),
        ("positions = [{ point_m = [0.0, 0.0] }, { angle_deg = 1.0 }]", "point_m and angle"),
        (f"{TWO}\n{MOVING}\npivots_in = {{ from_m = [1, 0.0], to_m = [0.0, 1] }}", "lower left"),
    ],
    "rocker": [
        ("rocker_m = 0.1", "swing_deg, or two positions"),
        ("swing_deg = 200.0\nrocker_m = 0.1", "less than 180"),
    ],
    "stroke": [
        ("stroke_m = 0.1\ntime_ratio = 1.2", 'belong to form = "offset"'),
        ('stroke_m = 0.1\nform = "offset"', "give offset_m, or time_ratio"),
        ('stroke_m = 0.1\nform = "isosceles"\nrod_m = 1.0', "a quarter of the stroke"),
        ('stroke_m = 0.1\nform = "offset"\ntime_ratio = 0.9', "greater than 1"),
    ],
    "quick-return": [
        (f'{QUICK}"whitworth"', "found no size"),
        (f'{QUICK}"whitworth"\ncrank_m = 0.1\npivots_m = 0.1', "crank_m and pivots_m"),
        (f'{QUICK}"crank-rocker"\nrocker_m = 0.1', "swing_deg: a crank-rocker needs it"),
        (f'{QUICK}"shaper"\ncrank_m = 0.1', "slotted-lever"),
    ],
}  # fmt: skip


@pytest.mark.parametrize(
    ("kind", "text", "says"),
    [(kind, *fault) for kind, faults in FAULTS.items() for fault in faults],
)
def test_faults_are_said(tmp_path: Path, kind: str, text: str, says: str) -> None:
    file = tmp_path / "task.toml"
    file.write_text(HEAD + text, encoding="utf-8")
    with pytest.raises(SceneError) as found:
        load_task(kind, str(file))
    assert says in str(found.value)


def test_near_names_are_suggested() -> None:
    with pytest.raises(CrankcheckError, match="did you mean coupler"):
        find_task("couplers", "x")
    with pytest.raises(CrankcheckError, match="Did you mean three-positions"):
        find_task("coupler", "three-position")


def test_a_body_by_two_points_has_the_first_as_its_origin() -> None:
    task = load_task("coupler", "three-positions")
    assert isinstance(task, CouplerTask)
    assert task.own_points["C"] == 0j
    assert task.own_points["D"] == pytest.approx(0.14, abs=1e-6)
    place, angle = task.poses[1]
    assert place == 0.08 + 0.24j
    assert angle == pytest.approx(-0.1745329, abs=1e-5)


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
])  # fmt: skip
def test_a_text_has_the_value_that_a_reader_expects(text: str, value: object) -> None:
    np.testing.assert_allclose(parse_formula(text).at(X), value, rtol=1e-14, atol=1e-15)


def test_functions_are_those_of_mathematics_and_no_number_where_they_are_not_defined() -> None:
    for name in FUNCTIONS:
        own = {"abs": abs}.get(name) or getattr(math, name)
        value = parse_formula(f"{name}(x)").at(np.array([0.37]))[0]
        assert value == pytest.approx(own(0.37), rel=1e-15), name
    for text, at in (("1/x", 0.0), ("log(x)", 0.0), ("sqrt(x)", -1.0), ("x^0.5", -1.0)):
        assert not np.isfinite(parse_formula(text).at(np.array([at]))[0]), text
    assert not np.isfinite(parse_formula("9^9^9^9").at(np.array([1.0]))[0])


@pytest.mark.parametrize(("text", "says"), [
    ("", "at character 1 stands the end, where a number"),
    ("2x", "at character 2 stands 'x', where an operator"),
    ("sinh(x)", "'sinh' at character 1 is not understood; did you mean sin"),
    ("y^2", "'y' at character 1 is not understood; it may name x, pi, e, sin"),
    ("sin x", "at character 5 stands 'x', where \"(\" after sin"),
    ("(x", "at character 3 stands the end, where an operator or"),
    ("1_000", "at character 2 stands '_000'"),
    ("__import__('os')", "'__import__' at character 1 is not understood"),
    ("x.real", "at character 2 stands '.'"),
    ("(" * (DEEPEST + 1) + "x", "stand within each other"),
    ("-" * (DEEPEST + 1) + "x", "stand within each other"),
    ("x+" * LONGEST_TEXT, f"at most {LONGEST_TEXT} are read"),
])  # fmt: skip
def test_what_is_no_formula_is_refused_with_its_place(text: str, says: str) -> None:
    with pytest.raises(CrankcheckError) as told:
        parse_formula(text)
    assert says in str(told.value)


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
