"""Workbooks of formulas, changed and recalculated by programs that are not ours."""

import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

import formulas
import numpy as np
import openpyxl
import pytest

from reports.lectures.drawing.workbook.formulas import ASSEMBLED, FormulaTable
from tests.worlds.live_tables import (
    KINDS,
    held_to_the_reference,
    inputs_of,
    live,
    scene_of,
    write_changed,
)
from tests.worlds.tiers import few, slow

ALL_CHANGED = {
    "fourbar-lecture-1": {"BC": 0.28, "AD_deg": 20.0, "branch": -1.0, "omega": -7.0},
    "slider-crank-offset": {"L": 0.35, "e": 0.04, "line_deg": 30.0, "omega": -7.0},
    "slotted-lever": {"R": 0.12, "ACx": 0.05, "o": -0.02, "omega": -7.0},
}
INSTALL = "apt-get install libreoffice-calc"
SOFFICE = shutil.which("soffice")
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


@pytest.mark.parametrize("kind", few(KINDS, {"slotted-lever"}, "seconds: each formula anew"))
def test_a_library_recalculates_a_changed_workbook(kind: str, tmp_path: Path) -> None:
    table, file = live(kind)[1], tmp_path / "live.xlsx"
    inputs = inputs_of(table) | ALL_CHANGED[kind]
    write_changed(table, inputs, file)
    columns = by_library(table, file)
    assert set(columns["state"]) == {ASSEMBLED}
    held_to_the_reference(columns, scene_of(kind, inputs))


def columns_in(file: Path, table: FormulaTable) -> dict[str, np.ndarray]:
    """The columns of a workbook as their cells hold them."""
    sheet = openpyxl.load_workbook(file, data_only=True)["live"]
    rows = zip(*sheet.iter_rows(min_row=2, values_only=True), strict=True)
    names = [each.name for each in table.columns]
    return {name: np.array(r, object) for name, r in zip(names, rows, strict=True)}


@pytest.mark.skipif(SOFFICE is None, reason=INSTALL)
def test_libreoffice_recalculates_changed_workbooks_and_says_what_is_open(tmp_path: Path) -> None:
    """One start of it, which takes seconds, for all: what a user's own program computes."""
    found = _changed(list(ALL_CHANGED.items()) + list(OPEN.items()), tmp_path)
    for kind, columns, opened in zip(KINDS, found[:3], found[3:], strict=True):
        held_to_the_reference(columns, scene_of(kind, inputs_of(live(kind)[1]) | ALL_CHANGED[kind]))
        _says_what_is_open(opened, live(kind)[1])


def _changed(
    changes: Sequence[tuple[str, Mapping[str, float]]], folder: Path
) -> list[dict[str, np.ndarray]]:
    """The columns of changed workbooks, as one start of LibreOffice recalculates them."""
    files = [folder / f"{number}.xlsx" for number in range(len(changes))]
    for (kind, change), file in zip(changes, files, strict=True):
        write_changed(live(kind)[1], inputs_of(live(kind)[1]) | change, file)
    where = ["--headless", f"-env:UserInstallation={(folder / 'profile').as_uri()}"]
    convert = ["--convert-to", "xlsx", "--outdir", str(folder / "out")]
    assert SOFFICE is not None
    subprocess.run([SOFFICE, *where, *convert, *map(str, files)], check=True, capture_output=True)
    found = zip(changes, files, strict=True)
    return [columns_in(folder / "out" / file.name, live(kind)[1]) for (kind, _), file in found]


def _says_what_is_open(columns: Mapping[str, np.ndarray], table: FormulaTable) -> None:
    """Rows that cannot be assembled say so, and have no numbers; the others have all."""
    wrong = columns["state"] != ASSEMBLED
    assert 0 < wrong.sum() < wrong.size
    assert set(columns["state"][wrong]) == {"cannot be assembled"}
    for drawn in table.charts.values():
        for name in drawn:
            assert {str(v) for v in columns[name][wrong]} == {"#N/A"}, name
            assert np.isfinite(columns[name][~wrong].astype(float)).all(), name


@slow("LibreOffice, which starts once for all, is asked for the same")
def test_a_library_says_what_is_open(tmp_path: Path) -> None:
    table, file = live("slotted-lever")[1], tmp_path / "live.xlsx"
    write_changed(table, inputs_of(table) | OPEN["slotted-lever"], file)
    _says_what_is_open(by_library(table, file), table)
