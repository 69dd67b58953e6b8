"""Workbooks of formulas, changed and recalculated by programs that are not ours."""

import random
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

import formulas
import numpy as np
import openpyxl
import pytest

from reports.lectures.drawing.workbook.formulas import ASSEMBLED, FormulaTable, evaluated
from reports.lectures.drawing.workbook.live_workbook import formulas_of
from tests.worlds.live_tables import (
    CHANGES,
    KINDS,
    STEP_DEG,
    held_to_the_reference,
    inputs_of,
    live,
    scene_of,
    write_changed,
)
from tests.worlds.tiers import at_length, few, slow, slowly

ALL_CHANGED = {
    "fourbar-lecture-1": {"BC": 0.28, "AD_deg": 20.0, "branch": -1.0, "omega": -7.0},
    "slider-crank-offset": {"L": 0.35, "e": 0.04, "line_deg": 30.0, "omega": -7.0},
    "slotted-lever": {"R": 0.12, "ACx": 0.05, "o": -0.02, "omega": -7.0},
}
INSTALL = "apt-get install libreoffice-calc"
SOFFICE = shutil.which("soffice")
EVERY = [(k, name, value) for k in KINDS for name in CHANGES[k] for value in CHANGES[k][name]]
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


ANEW = "the library reads each formula anew: seconds"


@pytest.mark.parametrize("kind", few(KINDS, {"slotted-lever"}, ANEW))
def test_a_library_recalculates_a_changed_workbook(kind: str, tmp_path: Path) -> None:
    table, file = live(kind)[1], tmp_path / "live.xlsx"
    inputs = inputs_of(table) | ALL_CHANGED[kind]
    write_changed(table, inputs, file)
    columns = by_library(table, file)
    assert set(columns["state"]) == {ASSEMBLED}
    held_to_the_reference(columns, scene_of(kind, inputs))


def test_every_input_of_every_kind_is_changed() -> None:
    for kind in KINDS:
        assert set(CHANGES[kind]) == set(inputs_of(live(kind)[1]))


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


@slow("a fault in one input is found by itself here; the quick test changes several at once")
@pytest.mark.skipif(SOFFICE is None, reason=INSTALL)
def test_libreoffice_follows_every_input_of_every_kind(tmp_path: Path) -> None:
    changes = [(kind, {name: value}) for kind, name, value in EVERY]
    for (kind, change), columns in zip(changes, _changed(changes, tmp_path), strict=True):
        scene = scene_of(kind, inputs_of(live(kind)[1]) | change)
        held_to_the_reference(columns, scene, f"{kind} {change}")


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


def drawn_inputs(kind: str, chance: random.Random) -> dict[str, float]:
    """Inputs of a mechanism that can be assembled all the way, well away from its limits."""
    table = live(kind)[1]
    own = inputs_of(table)
    while True:
        inputs = {
            name: chance.choice((-1.0, 1.0)) if name == "branch"
            else chance.uniform(-180.0, 180.0) if name in ("AD_deg", "line_deg", "start_deg")
            else chance.choice((-1.0, 1.0)) * chance.uniform(0.1, 20.0) if name == "omega"
            else chance.uniform(5.0, 30.0) if name == "step_deg"
            else chance.uniform(-0.2, 0.2) if name in ("e", "o", "X0", "rho0", "ACx", "ACy")
            else chance.uniform(0.05, 0.5)
            for name in own
        }  # fmt: skip
        close = formulas_of(scene_of(kind, inputs), 721, 0.5)
        if close is None:  # four lengths that no four-bar has
            continue
        if float(np.nanmin(evaluated(close)["inside"])) > 0.05:
            return inputs


MANY = "a second each: signs and places that no shipped scene has"


@pytest.mark.parametrize("count", [slowly(10, reason=MANY), at_length(30, reason=MANY)])
@pytest.mark.parametrize("kind", KINDS)
def test_random_mechanisms_are_right_in_a_workbook(kind: str, count: int, tmp_path: Path) -> None:
    chance = random.Random(17)
    for number in range(count):
        inputs = drawn_inputs(kind, chance)
        scene = scene_of(kind, inputs)
        table = formulas_of(scene, 7, STEP_DEG)
        assert table is not None
        file = tmp_path / f"{number}.xlsx"
        write_changed(table, inputs, file)
        held_to_the_reference(by_library(table, file), scene, str(inputs))
