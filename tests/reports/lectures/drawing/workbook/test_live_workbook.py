"""Tables of formulas and families of them and of other mechanisms, against the reference; and what
a spreadsheet is given: names, functions, and cells that may and may not be changed; workbooks
recalculated by a library that is not ours."""

import io
import math
import random
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import formulas
import numpy as np
import openpyxl
import pytest

from analytic.kinematics import solve
from models.errors import CrankcheckError
from models.files.reading import load_scene, shipped
from models.scene import GROUND, Driver, Link, Point, Scene, Slider, span
from models.scene.laws import ConstantSpeed
from reports.lectures.drawing.workbook.family import (
    family,
    scene_curves,
    scene_family,
    varied_scene,
)
from reports.lectures.drawing.workbook.formulas import ASSEMBLED, FormulaTable, evaluated
from reports.lectures.drawing.workbook.live_workbook import (
    formulas_of,
    left_out,
    live_workbook,
    scene_family_workbook,
)
from tests.worlds.live_tables import (
    KINDS,
    held_to_the_reference,
    inputs_of,
    live,
    scene_of,
    write_changed,
)
from tests.worlds.tiers import slow

PARALLELOGRAM = {"AB": 0.1, "BC": 0.3, "CD": 0.1, "AD": 0.3, "start_deg": 0.0}


@pytest.mark.parametrize("name", [n for n in shipped() if formulas_of(load_scene(n), 2, 1.0)])
def test_formulas_are_the_reference(name: str) -> None:
    scene, table = live(name)
    columns = evaluated(table)
    motion = solve(scene, columns["time"], bound=False)
    bars = [name for name in motion.links if name != scene.driver.link and "omega_bc" in columns]
    for name in bars:
        off = [columns[f"omega_{key}"] - motion.links[name].omega for key in ("bc", "dc")]
        assert min(float(np.abs(each).max()) for each in off) < 1e-12 * 50
    for slider in motion.sliders.values():
        assert columns["s"] == pytest.approx(slider.displacement, abs=1e-12)


@pytest.mark.parametrize(
    ("scene", "name"),
    [("fourbar-lecture-1", "BC"), ("slotted-lever", "R"), ("slider-crank-offset", "e")],
)
def test_a_family_has_every_member_s_own_numbers_and_charts(scene: str, name: str) -> None:
    _, table = live(scene)
    (value,) = (each.value for each in table.inputs if each.name == name)
    whole = family(table, name, [value, 1.01 * value])
    columns = evaluated(whole)
    for k, length in enumerate((value, 1.01 * value), 1):
        inputs = [replace(i, value=length) if i.name == name else i for i in table.inputs]
        member = evaluated(replace(table, inputs=inputs))
        for title, names in table.charts.items():
            for column in names:
                assert columns[f"{column}_{k}"] == pytest.approx(member[column]), title
    book = openpyxl.load_workbook(io.BytesIO(live_workbook(whole, {})))
    drawn = [len(chart.series) for chart in book["charts"]._charts]
    assert drawn == [2 * len(names) for names in table.charts.values()]


@pytest.mark.parametrize(
    ("name", "values", "told"),
    [
        ("L", [3.5, 1.5], "L=1.5: this member cannot be assembled with its crank at"),
        ("L", [3.5, 2.0], "L=2: this member has no determined rates with its crank at 90 deg"),
        ("Q", [1.0, 2.0], "it has R, L, e, line_deg"),
        ("Omega", [1.0, 2.0], "did you mean omega"),
        ("L", [3.5, -1.0], "L=-1: length of the rod; give numbers that are above 0"),
        ("omega", [1.0, 0.0], "omega=0: angular velocity of the crank; give numbers that are not"),
        ("branch", [1.0, 2.0], "branch=2: "),
        ("L", [3.5, 2.5, 3.5], "3.5 is given twice"),
        ("L", [3.5], "1 values; give 2 to 20"),
        ("crank", [0.1, 0.5], r"--family crank=0.5: .* choose another crank"),
    ],
)
def test_a_wrong_family_is_refused_by_its_name(name: str, values: list[float], told: str) -> None:
    scene = "fourbar-lecture-1" if name == "crank" else "slider-crank-excel-350"
    with pytest.raises(CrankcheckError, match=told):
        family(live(scene)[1], name, values)


def test_a_row_at_a_change_point_is_not_called_open() -> None:
    """Rounding leaves the square of a sine a little below 0 there."""
    _, table = live("fourbar-lecture-1")
    inputs = [replace(i, value=PARALLELOGRAM.get(i.name, i.value)) for i in table.inputs]
    columns = evaluated(replace(table, inputs=inputs))
    assert columns["inside"][0] < 0.0
    assert columns["state"][0] == "rates not determined"


def test_a_motion_over_to_the_other_branch_and_other_mechanisms_have_no_formulas() -> None:
    folds = scene_of("fourbar-lecture-1", inputs_of(live("fourbar-lecture-1")[1]) | PARALLELOGRAM)
    for scene in (folds, load_scene("shaper"), load_scene("scotch-yoke")):
        assert formulas_of(scene, 3, 1.0) is None


def test_a_workbook_of_very_many_rows_says_what_it_has_not() -> None:
    assert left_out(20_000) == ""
    assert left_out(20_001).endswith("formulas are of at most 20000 rows")
    assert left_out(100_001).endswith("rows, and charts of 100000")


KNOWN = {"ABS", "ACOS", "ATAN2", "COS", "COUNTIF", "IF", "ISNUMBER", "NA", "PI", "RADIANS",
         "ROUND", "SIN", "SQRT"}  # fmt: skip
"""In every spreadsheet, by one value a cell, and none that is worked out anew without a reason."""


@pytest.fixture(scope="module", params=KINDS)
def book(request: pytest.FixtureRequest) -> openpyxl.Workbook:
    both = family(live(request.param)[1], "omega", [2.0, -3.0])
    return openpyxl.load_workbook(io.BytesIO(live_workbook(both, {"source": "=1+1"})))


def formulas_in(book: openpyxl.Workbook) -> list[str]:
    cells = [cell for sheet in book.worksheets for row in sheet.iter_rows() for cell in row]
    return [cell.value for cell in cells if cell.data_type == "f"]


def test_formulas_have_common_functions_alone_and_no_text_is_one(book: openpyxl.Workbook) -> None:
    texts = formulas_in(book)
    assert texts
    assert all(isinstance(text, str) for text in texts)  # and no array formula
    assert {word for text in texts for word in re.findall(r"([A-Z0-9]+)\(", text)} <= KNOWN
    assert book["source"]["B2"].data_type == "s"


def test_inputs_alone_can_be_changed_and_have_names_of_no_cell(book: openpyxl.Workbook) -> None:
    inputs, table = book["inputs"], book["live"]
    rows = range(2, 2 + len(book.defined_names))
    for row in rows:
        name = inputs.cell(row, 5).value
        assert book.defined_names[name].attr_text == f"'inputs'!$B${row}"
        assert not re.fullmatch(r"[A-Za-z]{1,3}\d+|[RrCc]|[Rr]\d*[Cc]\d*", name)
    assert {text for text in formulas_in(book) if "omega_1" in text}
    assert inputs.protection.sheet
    assert table.protection.sheet
    assert not inputs.protection.password
    for sheet in (inputs, table):
        cells = [cell for row in sheet.iter_rows() for cell in row]
        free = {cell.coordinate for cell in cells if not cell.protection.locked}
        assert free == ({f"B{row}" for row in rows} if sheet is inputs else set())
    checked = {str(each.sqref) for each in inputs.data_validations.dataValidation}
    assert checked == {f"B{row}" for row in rows}
    assert (inputs.freeze_panes, table.freeze_panes) == ("A2", "D2")


TIMES = np.linspace(0.0, 0.6, 5)


def test_a_length_a_pin_and_the_speed_are_varied() -> None:
    scene = load_scene("shaper")
    assert span(varied_scene(scene, "rod", 0.27).links["rod"].points) == pytest.approx(0.27)
    assert varied_scene(scene, "A.y", 0.31).ground["A"] == (0.0, 0.31)
    assert varied_scene(scene, "omega", -2.0).driver.law.at(np.ones(1))[1] == -2.0


def test_members_are_the_reference_and_their_columns_and_charts_stand_in_a_workbook() -> None:
    scene = load_scene("sixbar-stephenson")
    family = scene_family(scene, "omega", [2.0, -5.0], TIMES)
    book = openpyxl.load_workbook(io.BytesIO(scene_family_workbook(family, {})))
    turned_rad = TIMES[-1] * scene.driver.law.peak_speed_rad_s
    columns = {column[0]: column[1:] for column in book["family"].iter_cols(values_only=True)}
    for value in (2.0, -5.0):
        times, lever = (
            columns[f"{name}, omega = {value:g}"] for name in ("time_s", "lever_alpha_rad_s2")
        )
        assert times[-1] * abs(value) == pytest.approx(turned_rad)
        motion = solve(varied_scene(scene, "omega", value), np.array(times))
        assert lever == pytest.approx(motion.links["lever"].alpha)
    assert len(book["charts"]._charts) == 3 * (len(scene.links) - 1)
    assert [len(chart.series) for chart in book["charts"]._charts] == [2] * 12


def test_what_is_driven_is_drawn() -> None:
    shaper = scene_curves(scene_family(load_scene("shaper"), "rod", [0.2, 0.3], TIMES))
    assert shaper.charts[0].label == "F: displacement [m]"
    six = scene_curves(scene_family(load_scene("sixbar-watt"), "D.x", [0.3, 0.301], TIMES))
    assert six.charts[2].label == "lever: alpha [rad/s²]"


@pytest.mark.parametrize(
    ("name", "values", "told"),
    [
        ("lever", [0.2, 0.05], "lever=0.05: this member cannot be assembled: sixbar-stephenson: c"),
        ("levr", [0.2, 0.3], "did you mean lever"),
        ("coupler", [0.2, 0.3], "it has crank, rocker, rod, lever, A.x|did you mean"),
        ("rod", [0.2, -0.3], "rod=-0.3: a length; give numbers above 0"),
        ("omega", [2.0, 0.0], "omega=0: a speed"),
        ("rod", [0.2], "1 values; give 2 to 20"),
    ],
)
def test_a_wrong_family_of_a_scene_is_refused(name: str, values: list[float], told: str) -> None:
    with pytest.raises(CrankcheckError, match=told):
        scene_family(load_scene("sixbar-stephenson"), name, values, TIMES)


def test_a_member_that_is_open_between_rows_alone_is_refused() -> None:
    told = "rod=0.184977: this member cannot be assembled: sixbar-watt: crank at 216"
    with pytest.raises(CrankcheckError, match=told):
        scene_family(load_scene("sixbar-watt"), "rod", [0.3, 0.184977], np.linspace(0.0, 0.6, 2))


class Drawn:
    """Scenes by chance, with frames, angles and pins that no shipped one has."""

    def __init__(self, seed: int) -> None:
        self.chance = random.Random(seed)

    def place(self, size: float = 0.3) -> Point:
        return self.chance.uniform(-size, size), self.chance.uniform(-size, size)

    def angle(self) -> float:
        return self.chance.uniform(-math.pi, math.pi)

    def sign(self) -> int:
        return self.chance.choice((-1, 1))

    def bar(self, name: str, pins: str, low: float, high: float) -> Link:
        """A link with a third point, whose first two are so far apart."""
        (x, y), length, angle = self.place(), self.chance.uniform(low, high), self.angle()
        far = x + length * math.cos(angle), y + length * math.sin(angle)
        return self.link(name, {pins[0]: (x, y), pins[1]: far, f"of {name}": self.place()})

    def link(self, name: str, points: dict[str, Point]) -> Link:
        return Link(name, points, 1.0, (0.0, 0.0), 1.0)

    def near(self, centre: Point, size: float) -> Point:
        x, y = self.place(size)
        return centre[0] + x, centre[1] + y

    def scene(self, ground: dict[str, Point], links: list[Link], slider: Slider | None) -> Scene:
        crank = self.bar("crank", "AB", 0.05, 0.15)
        law = ConstantSpeed(self.sign() * self.chance.uniform(0.5, 20.0), self.angle())
        name = "C" if slider is None else slider.name
        order = self.chance.sample([crank, *links], 1 + len(links))
        sliders = {} if slider is None else {slider.name: slider}
        bodies = {each.name: each for each in order}
        branch = {name: self.sign()}
        return Scene("drawn", "here", ground, bodies, sliders, Driver("crank", law), branch)


def ram(drawn: Drawn) -> Scene:
    """A slider that is a link, with the rod's pin off its line."""
    pivot, rod = drawn.place(), drawn.bar("rod", "BC", 0.4, 0.6)
    slides = drawn.link("ram", {"C": drawn.place(0.1), "T": drawn.place(0.1)})
    point, through = drawn.chance.choice("CT"), drawn.near(pivot, 0.1)
    slider = Slider("s", point, GROUND, through, drawn.angle(), "ram", drawn.angle())
    return drawn.scene({"A": pivot}, [rod, slides], slider)


def lever(drawn: Drawn) -> Scene:
    pivot, turns = drawn.place(), drawn.bar("lever", "CE", 0.1, 0.3)
    through = drawn.near(turns.points["C"], 0.1)
    ground = {"A": pivot, "C": drawn.near((pivot[0] + 0.45, pivot[1]), 0.1)}
    return drawn.scene(ground, [turns], Slider("s", "B", "lever", through, drawn.angle()))


def fourbar(drawn: Drawn) -> Scene:
    pivot, angle = drawn.place(), drawn.angle()
    ground = {"D": (pivot[0] + 0.4 * math.cos(angle), pivot[1] + 0.4 * math.sin(angle)), "A": pivot}
    bars = [drawn.bar("coupler", "BC", 0.35, 0.5), drawn.bar("rocker", "DC", 0.3, 0.4)]
    return drawn.scene(ground, bars, None)


@pytest.mark.parametrize("draw", [ram, lever, fourbar])
def test_formulas_are_the_reference_wherever_frames_lie(draw: Callable[[Drawn], Scene]) -> None:
    drawn = Drawn(17)
    for number in range(8):
        scene = draw(drawn)
        table = formulas_of(scene, 13, 27.5)
        assert table is not None, number
        held_to_the_reference(evaluated(table), scene, f"{number}: {scene}", turned=True)


def test_what_hangs_otherwise_has_values() -> None:
    """Its groups are of the same kinds, yet no sheet is its."""
    drawn = Drawn(1)
    pivot, turns = {"A": drawn.place()}, drawn.bar("lever", "BE", 0.2, 0.3)
    slider = Slider("s", "A", "lever", turns.points["B"], drawn.angle())
    bars = [drawn.bar("coupler", "BC", 0.3, 0.3), drawn.bar("rocker", "AC", 0.3, 0.3)]
    for scene in (drawn.scene(pivot, [turns], slider), drawn.scene(pivot, bars, None)):
        assert formulas_of(scene, 3, 1.0) is None


ALL_CHANGED = {
    "fourbar-lecture-1": {"BC": 0.28, "AD_deg": 20.0, "branch": -1.0, "omega": -7.0},
    "slider-crank-offset": {"L": 0.35, "e": 0.04, "line_deg": 30.0, "omega": -7.0},
    "slotted-lever": {"R": 0.12, "ACx": 0.05, "o": -0.02, "omega": -7.0},
}
OPEN = {"fourbar-lecture-1": {"BC": 0.15}, "slider-crank-offset": {"L": 0.1},
        "slotted-lever": {"o": 0.3}}  # fmt: skip
"""Changes after which some rows cannot be assembled."""


def by_library(table: FormulaTable, file: Path) -> Mapping[str, np.ndarray]:
    """The columns of a workbook as the library `formulas` evaluates them."""
    solution = formulas.ExcelModel().loads(str(file)).finish().calculate()
    columns = {}
    for column in table.columns:
        letter = table.letter(column.name)
        cells = [f"'[{file.name}]LIVE'!{letter}{row}" for row in range(2, table.count + 2)]
        columns[column.name] = np.array([solution[cell].value[0, 0] for cell in cells], object)
    return columns


@slow("seconds of each kind: each formula anew, which `evaluated` does as well")
@pytest.mark.parametrize("kind", KINDS)
def test_a_library_recalculates_changes_and_says_what_is_open(kind: str, tmp_path: Path) -> None:
    table, file = live(kind)[1], tmp_path / "live.xlsx"
    inputs = inputs_of(table) | ALL_CHANGED[kind]
    write_changed(table, inputs, file)
    columns = by_library(table, file)
    assert set(columns["state"]) == {ASSEMBLED}
    held_to_the_reference(columns, scene_of(kind, inputs))
    write_changed(table, inputs_of(table) | OPEN[kind], file)
    columns = by_library(table, file)
    wrong = columns["state"] != ASSEMBLED
    assert 0 < wrong.sum() < wrong.size
    assert set(columns["state"][wrong]) == {"cannot be assembled"}
    for drawn in table.charts.values():
        for name in drawn:
            assert {str(v) for v in columns[name][wrong]} == {"#N/A"}, name
            assert np.isfinite(columns[name][~wrong].astype(float)).all(), name
