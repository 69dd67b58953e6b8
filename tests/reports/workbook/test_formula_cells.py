"""What a spreadsheet is given: names, functions, and cells that may and may not be changed."""

from __future__ import annotations

import io
import re

import openpyxl
import pytest

from reports.workbook.family import family
from reports.workbook.formula_table import Input
from reports.workbook.live_workbook import live_workbook
from tests.worlds.live_tables import KINDS, live

KNOWN = {
    "ABS", "ACOS", "ATAN2", "COS", "COUNTIF", "IF", "ISNUMBER", "NA", "PI", "RADIANS", "ROUND",
    "SIN", "SQRT",
}  # fmt: skip
"""In every spreadsheet, by one value a cell, and none that is worked out anew without a reason."""
CELL = re.compile(r"[A-Za-z]{1,3}\d+|[RrCc]|[Rr]\d*[Cc]\d*")


@pytest.fixture(scope="module", params=KINDS)
def book(request: pytest.FixtureRequest) -> openpyxl.Workbook:
    table = live(request.param)[1]
    both = family(table, "omega", [2.0, -3.0])
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


def test_every_input_is_a_cell_of_a_name_that_no_cell_has(book: openpyxl.Workbook) -> None:
    sheet = book["inputs"]
    count = len(book.defined_names)
    for row in range(2, 2 + count):
        name = sheet.cell(row, 5).value
        assert book.defined_names[name].attr_text == f"'inputs'!$B${row}"
        assert not CELL.fullmatch(name)
    assert {text for text in formulas_in(book) if "omega_1" in text}


def test_inputs_alone_can_be_changed(book: openpyxl.Workbook) -> None:
    inputs, table = book["inputs"], book["live"]
    rows = range(2, 2 + len(book.defined_names))
    assert inputs.protection.sheet
    assert table.protection.sheet
    assert not inputs.protection.password
    for sheet in (inputs, table):
        open_cells = {c.coordinate for row in sheet.iter_rows() for c in row
                      if not c.protection.locked}  # fmt: skip
        assert open_cells == ({f"B{row}" for row in rows} if sheet is inputs else set())
    checked = {str(each.sqref) for each in inputs.data_validations.dataValidation}
    assert checked == {f"B{row}" for row in rows}
    assert (inputs.freeze_panes, table.freeze_panes) == ("A2", "D2")


@pytest.mark.parametrize(
    ("kind", "allowed", "refused"),
    [("above 0", (1e-9,), (0.0, -1.0)), ("not 0", (-1.0, 2.0), (0.0,)),
     ("1 or -1", (1.0, -1.0), (0.0, 2.0)), ("any", (0.0, -5.0), ())],
)  # fmt: skip
def test_an_input_knows_its_range(
    kind: str, allowed: tuple[float, ...], refused: tuple[float, ...]
) -> None:
    one = Input("x", 1.0, "m", "a length", kind)  # type: ignore[arg-type]  # one of the literals
    assert all(map(one.allows, allowed))
    assert not any(map(one.allows, refused))
