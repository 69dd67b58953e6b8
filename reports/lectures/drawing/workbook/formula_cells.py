"""A table of formulas as the cells of a workbook: a sheet of inputs, and one of the columns.

Inputs are named cells, so that a formula reads as in a book. The sheets are protected without a
password: cells that may be changed are coloured and open.
"""

import math
import re

import numpy as np
from openpyxl import Workbook  # type: ignore[import-untyped]  # ships no stubs
from openpyxl.formatting.rule import FormulaRule  # type: ignore[import-untyped]  # as above
from openpyxl.styles import (  # type: ignore[import-untyped]  # as above
    Alignment,
    Font,
    PatternFill,
    Protection,
)
from openpyxl.workbook.defined_name import DefinedName  # type: ignore[import-untyped]  # as above
from openpyxl.worksheet.datavalidation import (  # type: ignore[import-untyped]  # as above
    DataValidation,
)
from openpyxl.worksheet.properties import (  # type: ignore[import-untyped]  # as above
    PageSetupProperties,
)
from openpyxl.worksheet.worksheet import Worksheet  # type: ignore[import-untyped]  # as above

from models.array import Array
from reports.lectures.drawing.workbook import formulas

INPUTS, TABLE = "inputs", "live"
TAKEN = re.compile(r"[rc]|[a-z]{1,3}\d+", re.IGNORECASE)
"""Names that a spreadsheet takes for a row, a column, or a cell."""
FACE = "Calibri"
BOLD, SOFT = Font(name=FACE, bold=True), Font(color="9AA3AD")
RED = Font(color="C00000", bold=True)
OPEN, HEAD = PatternFill("solid", "FFF2CC"), PatternFill("solid", "E8ECF1")
WIDTHS = (22, 16, 9, 62, 13)
ON_A_PAGE = 20
"""Columns that are printed side by side."""
DIGITS, FEWEST, MOST = 7, 1e-4, 1e7
"""Significant digits shown, and the sizes between which no power of ten is shown."""


def cell_name(name: str) -> str:
    """The name of an input's cell: R and C are words of spreadsheets, X0 is a cell."""
    return f"{name}_" if TAKEN.fullmatch(name) else name


def write_inputs(book: Workbook, table: formulas.FormulaTable) -> None:
    """Write the sheet of inputs, one a row: name, value, unit, meaning, and its name in formulas;
    below them the outcome of the table of columns."""
    sheet = book.create_sheet(INPUTS)
    sheet.append(["name", "value", "unit", "meaning", "in formulas"])
    for row, each in enumerate(table.inputs, 2):
        name = cell_name(each.name)
        sheet.append([each.name, each.value, each.unit or None, each.told, name])
        sheet.cell(row, 1).data_type = "s"  # a name is no formula
        book.defined_names[name] = DefinedName(name, attr_text=f"'{INPUTS}'!$B${row}")
        _open(sheet, row, each)
    sheet.append([])
    _append_outcome(sheet, table)
    for letter, width in zip("ABCDE", WIDTHS, strict=True):
        sheet.column_dimensions[letter].width = width
    _finish(sheet, "A2", len(WIDTHS))


def _open(sheet: Worksheet, row: int, each: formulas.Input) -> None:
    """Let the value of an input be changed, within its range."""
    cell = sheet.cell(row, 2)
    cell.fill, cell.protection = OPEN, Protection(locked=False)
    where = f"$B${row}"
    rule = {
        "any": f"ISNUMBER({where})",
        "above 0": f"AND(ISNUMBER({where}),{where}>0)",
        "not 0": f"AND(ISNUMBER({where}),{where}<>0)",
        "1 or -1": f"AND(ISNUMBER({where}),ABS({where})=1)",
    }[each.range]
    validation = DataValidation("custom", rule, showErrorMessage=True)
    takes = "a number" if each.range == "any" else f"a number that is {each.range}"
    validation.errorTitle, validation.error = each.name, f"{each.told}: give {takes}"
    validation.add(cell)
    sheet.add_data_validation(validation)


def _append_outcome(sheet: Worksheet, table: formulas.FormulaTable) -> None:
    """Write the outcome of the inputs: the range of the rows, and whether all can be assembled."""
    first, last = 2, table.count + 1

    def column(name: str) -> str:
        letter = table.letter(name)
        return f"'{TABLE}'!${letter}${first}:${letter}${last}"

    steps = f"{table.count - 1} steps; take another step_deg for more of them or finer ones"
    sheet.append(["turns of the crank", f"={table.count - 1}*step_deg/360", None, steps])
    for name in table.states:
        row = sheet.max_row + 1
        member = name.partition("_")[2]
        head = f"rows {formulas.ASSEMBLED}" + (f", member {member}" if member else "")
        sheet.append(
            [head, f'=COUNTIF({column(name)},"{formulas.ASSEMBLED}")', f"of {table.count}"]
        )
        told = f'=IF(B{row}={table.count},"all","#N/A: no position, or no rates, with this crank")'
        sheet.cell(row, 4, told)
        rule = FormulaRule([f"$B${row}<{table.count}"], font=RED)
        sheet.conditional_formatting.add(f"A{row}:D{row}", rule)


def write_columns(book: Workbook, table: formulas.FormulaTable) -> None:
    """Write the sheet of columns; rows not assembled have #N/A, which charts leave out."""
    sheet = book.create_sheet(TABLE)
    sheet.append([_head(each.head, table) for each in table.columns])
    for row in range(2, table.count + 2):
        cells = []
        for column in table.columns:
            plain = column.first if row == 2 and column.first is not None else column.formula
            cells.append("=" + _placed(plain, table, row))
        sheet.append(cells)
    values = formulas.evaluated(table)
    for place, column in enumerate(table.columns, 1):
        shape = _number_format(values[column.name])
        says = column.name in table.states
        sheet.column_dimensions[table.letter(column.name)].width = 20 if says else 15
        for (cell,) in sheet.iter_rows(min_row=2, min_col=place, max_col=place):
            cell.number_format = shape
            if says:
                cell.alignment = Alignment(horizontal="center")
    whole = f"A2:{table.letter(table.columns[-1].name)}{table.count + 1}"
    sheet.conditional_formatting.add(whole, FormulaRule(["ISNA(A2)"], font=SOFT))
    for letter in map(table.letter, table.states):
        rule = FormulaRule([f'{letter}2<>"{formulas.ASSEMBLED}"'], font=RED)
        sheet.conditional_formatting.add(f"{letter}2:{letter}{table.count + 1}", rule)
    _finish(sheet, "D2", len(table.columns))


def _finish(sheet: Worksheet, frozen: str, columns: int) -> None:
    """Format a sheet: heads that are distinct and stay in sight, legible pages, and cells that can
    not be changed by accident."""
    for cell in sheet[1]:
        cell.font, cell.fill = BOLD, HEAD
        cell.alignment = Alignment(wrap_text=True, vertical="top")
    sheet.freeze_panes = frozen
    sheet.sheet_properties.pageSetUpPr = PageSetupProperties(fitToPage=True)
    sheet.page_setup.orientation, sheet.page_setup.fitToHeight = "landscape", 0
    sheet.page_setup.fitToWidth = math.ceil(columns / ON_A_PAGE)
    sheet.print_title_rows, sheet.row_dimensions[1].height = "1:1", 30
    sheet.protection.sheet = True
    sheet.protection.formatColumns = sheet.protection.formatCells = False  # these are allowed


def _number_format(values: Array) -> str:
    if values.dtype.kind != "f":
        return "General"
    if np.all(values == np.round(values)):
        return "0"
    largest = float(np.nanmax(np.abs(values), initial=0.0, where=np.isfinite(values)))
    if not FEWEST < largest < MOST:
        return f"0.{'0' * (DIGITS - 1)}E+00"
    return "0." + "0" * (DIGITS - 1 - math.floor(math.log10(largest)))


def _head(head: str, table: formulas.FormulaTable) -> str:
    """A head; a head with an input in it shows its present value."""
    return _placed(head, table, 0) if head.startswith("=") else head


def _placed(formula: str, table: formulas.FormulaTable, row: int) -> str:
    """The formula with cells in place of columns, and the names of cells in place of inputs."""

    def cell(match: re.Match[str]) -> str:
        given, column, before = match.groups()
        if given:
            return cell_name(given)
        return f"{table.letter(column)}{row - 1 if before else row}"

    return formulas.NAME.sub(cell, formula)
