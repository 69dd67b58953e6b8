"""Tables of formulas and families of them, against the reference."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import openpyxl
import pytest

from analytic.kinematics import solve
from models.errors import CrankcheckError
from models.files import load_scene, shipped
from reports.workbook.beside_values import left_out
from reports.workbook.evaluated import evaluated
from reports.workbook.family import family
from reports.workbook.live_workbook import formulas_of, live_workbook
from tests.worlds.live_tables import inputs_of, live, scene_of

PARALLELOGRAM = {"AB": 0.1, "BC": 0.3, "CD": 0.1, "AD": 0.3, "start_deg": 0.0}


@pytest.mark.parametrize("name", [n for n in shipped() if formulas_of(load_scene(n), 2, 1.0)])
def test_formulas_are_the_reference(name: str) -> None:
    scene, table = live(name)
    columns = evaluated(table)
    motion = solve(scene, columns["time"], bound=False)
    for link, body in motion.links.items():
        if link == scene.driver.link or "omega_bc" not in columns:
            continue
        found = [columns[f"omega_{key}"] for key in ("bc", "dc")]
        assert min(float(np.abs(each - body.omega).max()) for each in found) < 1e-12 * 50
    for slider in motion.sliders.values():
        assert columns["s"] == pytest.approx(slider.displacement, abs=1e-12)


def test_the_paper_s_own_form_where_the_line_meets_the_crank() -> None:
    """X'' = -w^2 R [cos t + (f''/w^2) sin t + (f'/w) cos t] of the paper, e = 0."""
    _, table = live("slider-crank-excel-350")
    c = evaluated(table)
    (radius, rod), w, t = [i.value for i in table.inputs][:2], 1.0, c["t"]
    assert (radius, rod) == (2.0, 3.5)
    f1 = w * (radius / rod) * np.cos(t) / np.sqrt(1 - (radius / rod * np.sin(t)) ** 2)
    f2 = w**2 * (radius / rod) * np.sin(t) * ((radius / rod) ** 2 - 1)
    f2 = f2 / (1 - (radius / rod * np.sin(t)) ** 2) ** 1.5
    assert c["f_rate"] == pytest.approx(f1, abs=1e-12)
    assert c["f_gain"] == pytest.approx(f2, abs=1e-12)
    assert c["X_rate"] == pytest.approx(-(w + f1) * radius * np.sin(t), abs=1e-12)
    x2 = -(w**2) * radius * (np.cos(t) + f2 / w**2 * np.sin(t) + f1 / w * np.cos(t))
    assert c["X_gain"] == pytest.approx(x2, abs=1e-12)


def test_a_family_has_every_member_s_own_numbers_and_three_charts() -> None:
    _, table = live("slider-crank-excel-350")
    lengths = [3.5, 2.5, 2.2, 2.1]
    whole = family(table, "L", lengths)
    columns = evaluated(whole)
    for k, length in enumerate(lengths, 1):
        member = replace(
            table, inputs=[replace(i, value=length) if i.name == "L" else i for i in table.inputs]
        )
        assert columns[f"X_{k}"] == pytest.approx(evaluated(member)["X"], abs=0.0)
    assert [len(drawn) for drawn in whole.charts.values()] == [4, 4, 4]
    book = openpyxl.load_workbook(io.BytesIO(live_workbook(whole, {})))
    assert len(book["charts"]._charts) == 3


@pytest.mark.parametrize(
    ("scene", "name"),
    [("fourbar-lecture-1", "BC"), ("slotted-lever", "R"), ("slider-crank-offset", "e")],
)
def test_every_kind_has_families(scene: str, name: str) -> None:
    _, table = live(scene)
    (value,) = (each.value for each in table.inputs if each.name == name)
    columns = evaluated(family(table, name, [value, 1.01 * value]))
    for title, drawn in table.charts.items():
        for column in drawn:
            assert columns[f"{column}_1"] == pytest.approx(evaluated(table)[column]), title


@pytest.mark.parametrize(
    ("name", "values", "told"),
    [
        ("L", [3.5, 1.5], "L=1.5: this member cannot be assembled with its crank at"),
        ("L", [3.5, 2.0], "L=2: this member has no determined rates with its crank at 90 deg"),
        ("Q", [1.0, 2.0], "it has R, L, e, line_deg"),
        ("step_deg", [1.0, 2.0], "did you mean line_deg"),
        ("Omega", [1.0, 2.0], "did you mean omega"),
        ("L", [3.5, -1.0], "L=-1: length of the rod; give numbers that are above 0"),
        ("omega", [1.0, 0.0], "omega=0: angular velocity of the crank; give numbers that are not"),
        ("L", [3.5, 2.5, 3.5], "3.5 stands there twice"),
        ("L", [3.5], "1 values; give 2 to 20"),
        ("L", [3.5] * 21, "21 values; give 2 to 20"),
    ],
)
def test_a_family_that_can_not_be_is_refused(name: str, values: list[float], told: str) -> None:
    with pytest.raises(CrankcheckError, match=told):
        family(live("slider-crank-excel-350")[1], name, values)


def test_a_refusal_has_the_name_that_was_given() -> None:
    with pytest.raises(CrankcheckError, match=r"--family crank=0.5: .* choose another crank"):
        family(live("fourbar-lecture-1")[1], "crank", [0.1, 0.5])


def test_a_row_at_a_change_point_is_not_called_open() -> None:
    """Rounding leaves the square of a sine a little below 0 there."""
    _, table = live("fourbar-lecture-1")
    inputs = [replace(i, value=PARALLELOGRAM.get(i.name, i.value)) for i in table.inputs]
    columns = evaluated(replace(table, inputs=inputs))
    assert columns["inside"][0] < 0.0
    assert columns["state"][0] == "rates not determined"


def test_formulas_are_left_out_where_the_motion_goes_over_to_the_other_branch() -> None:
    scene = scene_of("fourbar-lecture-1", inputs_of(live("fourbar-lecture-1")[1]) | PARALLELOGRAM)
    assert formulas_of(scene, 3, 1.0) is None


def test_other_mechanisms_have_no_formulas() -> None:
    assert formulas_of(load_scene("shaper"), 3, 1.0) is None
    assert formulas_of(load_scene("scotch-yoke"), 3, 1.0) is None


def test_a_workbook_of_very_many_rows_says_what_it_has_not() -> None:
    assert left_out(20_000) == ""
    assert left_out(20_001).endswith("formulas are of at most 20000 rows")
    assert left_out(100_001).endswith("rows, and charts of 100000")
