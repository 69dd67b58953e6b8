"""Workbooks of formulas, recalculated after changes, against the reference."""

from __future__ import annotations

import io
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import formulas
import numpy as np
import openpyxl
import pytest

from analytic.kinematics import solve
from models.errors import CrankcheckError
from models.files import load_scene, shipped
from models.motion import Motion
from models.scene import Scene
from reports.workbook.evaluated import evaluated
from reports.workbook.family import family
from reports.workbook.formula_table import FormulaTable
from reports.workbook.live_workbook import formulas_of, live_workbook

ROWS, STEP_DEG = 13, 27.5
KINDS = ("fourbar-lecture-1", "slider-crank-offset", "slotted-lever")
Columns = dict[str, np.ndarray]


def live(name: str) -> tuple[Scene, FormulaTable]:
    scene = load_scene(name)
    table = formulas_of(scene, ROWS, STEP_DEG)
    assert table is not None
    return scene, table


def scaled_links(scene: Scene, link: str, factor: float) -> Scene:
    """The scene with a link longer by a factor."""
    old = scene.links[link]
    points = {name: (factor * x, factor * y) for name, (x, y) in old.points.items()}
    return replace(scene, links=dict(scene.links) | {link: replace(old, points=points)})


CHANGED = {
    "fourbar-lecture-1": ("coupler", "BC"),
    "slider-crank-offset": ("rod", "L"),
    "slotted-lever": ("crank", "R"),
}
FACTOR = 1.125


def changed(scene: Scene, table: FormulaTable) -> tuple[Scene, FormulaTable]:
    """A length and the speed changed in both."""
    link, name = CHANGED[scene.name]
    longer = scaled_links(scene, link, FACTOR)
    law = replace(longer.driver.law, speed_rad_s=7.0)
    inputs = [
        replace(each, value=each.value * FACTOR) if each.name == name
        else replace(each, value=7.0) if each.name == "omega"
        else each
        for each in table.inputs
    ]  # fmt: skip
    faster = replace(longer, driver=replace(longer.driver, law=law))
    return faster, replace(table, inputs=inputs)


def held_to_the_reference(columns: Columns, scene: Scene) -> None:
    """Every output of the columns is the reference's to 1e-12."""
    motion = solve(scene, np.asarray(columns["time"], float), bound=False)
    for name, exact in outputs(columns, scene, motion):
        scale = max(1.0, float(np.abs(exact).max()))
        assert np.asarray(columns[name], float) == pytest.approx(exact, abs=1e-12 * scale), name


def outputs(columns: Columns, scene: Scene, motion: Motion) -> list[tuple[str, np.ndarray]]:
    if "omega_bc" in columns:
        names = {"bc": "coupler", "dc": "rocker"}
        return [
            (f"{kind}_{key}", getattr(motion.links[link], kind))
            for key, link in names.items()
            for kind in ("theta", "omega", "alpha")
        ]
    (slider,) = motion.sliders.values()
    rates = ("s", slider.displacement), ("X_rate", slider.speed), ("X_gain", slider.acceleration)
    if "X" in columns:
        rod = motion.links["rod"]
        return [*rates, ("omega_rod", rod.omega), ("alpha_rod", rod.alpha)]
    lever = motion.links["lever"]
    return [
        ("s", slider.displacement), ("slide", slider.speed), ("gain", slider.acceleration),
        ("theta", lever.theta), ("omega3", lever.omega), ("alpha3", lever.alpha),
    ]  # fmt: skip


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


@pytest.mark.parametrize("name", KINDS)
def test_a_library_recalculates_a_changed_workbook_to_the_reference(
    name: str, tmp_path: Path
) -> None:
    scene, table = live(name)
    file = tmp_path / "live.xlsx"
    write_changed(scene, table, file)
    model = formulas.ExcelModel().loads(str(file)).finish()
    solution = model.calculate()
    columns = {}
    for column in table.columns:
        letter = table.letter(column.name)
        cells = [f"'[{file.name}]LIVE'!{letter}{row}" for row in range(2, ROWS + 2)]
        columns[column.name] = np.array([solution[cell].value[0, 0] for cell in cells])
    held_to_the_reference(columns, changed(scene, table)[0])


def write_changed(scene: Scene, table: FormulaTable, file: Path) -> None:
    """The shipped workbook with two of its cells changed, as a user would."""
    book = openpyxl.load_workbook(io.BytesIO(live_workbook(table, {"scene": scene.name})))
    wanted = {each.name: each.value for each in changed(scene, table)[1].inputs}
    for row in book["inputs"].iter_rows(min_row=2, max_row=1 + len(wanted)):
        row[1].value = wanted[row[0].value]
    book.save(file)


@pytest.mark.skipif(shutil.which("soffice") is None, reason="apt-get install libreoffice-calc")
def test_libreoffice_recalculates_changed_workbooks_to_the_reference(tmp_path: Path) -> None:
    """One start of it, which takes seconds, for all: what a user's own program computes."""
    files = []
    for name in KINDS:
        files.append(tmp_path / f"{name}.xlsx")
        write_changed(*live(name), files[-1])
    where = ["--headless", f"-env:UserInstallation={(tmp_path / 'profile').as_uri()}"]
    convert = ["--convert-to", "xlsx", "--outdir", str(tmp_path / "out")]
    subprocess.run(["soffice", *where, *convert, *map(str, files)], check=True, capture_output=True)
    for name in KINDS:
        scene, table = live(name)
        sheet = openpyxl.load_workbook(tmp_path / "out" / f"{name}.xlsx", data_only=True)["live"]
        rows = list(zip(*sheet.iter_rows(min_row=2, values_only=True), strict=True))
        columns = {each.name: np.array(r) for each, r in zip(table.columns, rows, strict=True)}
        held_to_the_reference(columns, changed(scene, table)[0])


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


def test_other_mechanisms_have_no_formulas() -> None:
    assert formulas_of(load_scene("shaper"), 3, 1.0) is None
    assert formulas_of(load_scene("scotch-yoke"), 3, 1.0) is None
