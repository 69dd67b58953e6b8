"""A stranger's log of a linkage that is right is within, in whatever dress it comes.

The limit is 1e-3 rad, or of a length; what a dress takes away is less.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import openpyxl
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from tests.reports.own_log.conftest import Judge
from tests.worlds.fuzzing import ACTING
from tests.worlds.stranger import FOURBAR, LINKAGES, SIXBAR, SLIDER_CRANK, Linkage
from tests.worlds.stranger_faults import COLUMNS
from tests.worlds.stranger_guises import GERMAN, GUISES, PER_TURN, SHORT, disguised
from tests.worlds.stranger_log import (
    DEG,
    Dress,
    Log,
    even,
    logged,
    single,
    uneven,
)
from tests.worlds.stranger_map import map_text

PLAIN = "fourbar-lecture-1"


@pytest.mark.parametrize("name", GUISES)
def test_a_healthy_log_is_within_in_every_guise(name: str, judge: Judge) -> None:
    guise = GUISES[name]
    text = guise.dress.text(guise.log(FOURBAR))
    result = judge(PLAIN, text, mapped=guise.map(FOURBAR), name=guise.name)
    assert result.exit_code == 0, result.output + result.stderr


@pytest.mark.parametrize("scene", LINKAGES)
def test_a_healthy_log_is_within_in_all_guises_at_once(scene: str, judge: Judge) -> None:
    guise, linkage = disguised(scene), LINKAGES[scene]
    dress = replace(GERMAN, comments=("# made by nobody",), digits=12)
    file = 'decimal = ","\nseparator = ";"'
    log = dress.text(guise.log(linkage))
    result = judge(scene, log, mapped=map_text(linkage, guise.columns, guise.clock, file))
    assert result.exit_code == 0, result.output + result.stderr


@pytest.mark.parametrize("scene", LINKAGES)
def test_the_plain_log_of_every_linkage_is_within(scene: str, judge: Judge) -> None:
    linkage = LINKAGES[scene]
    log = logged(linkage, even(linkage, 1.5, PER_TURN), COLUMNS[scene])
    result = judge(scene, Dress().text(log), target=("--target", "1e-6"))
    assert result.exit_code == 0, result.output + result.stderr
    assert "WITHIN TOLERANCE" in result.output


def test_with_a_step_limits_follow_from_it(judge: Judge) -> None:
    log = Dress().text(logged(FOURBAR, even(FOURBAR), COLUMNS[PLAIN]))
    result = judge(PLAIN, log, target=("--step", "0.001"))
    assert result.exit_code == 0, result.output + result.stderr


def _as_parquet(log: Log, path: Path) -> None:
    pq.write_table(pa.table(dict(log)), path)


def _as_workbook(log: Log, path: Path) -> None:
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.append(list(log))
    for row in np.stack(list(log.values()), axis=1).tolist():
        sheet.append(row)
    book.save(path)


@pytest.mark.parametrize(
    ("ending", "write"), [(".parquet", _as_parquet), (".xlsx", _as_workbook)], ids=["p", "x"]
)
def test_a_table_of_another_kind_is_read_too(
    ending: str, write: Callable[[Log, Path], None], judge: Judge, tmp_path: Path
) -> None:
    path = tmp_path / f"log{ending}"
    write(GUISES["dots"].log(FOURBAR, 1.0), path)
    result = judge(PLAIN, path)
    assert result.exit_code == 0, result.output + result.stderr


def test_single_precision_is_within_what_it_keeps(judge: Judge, tmp_path: Path) -> None:
    path = tmp_path / "log.parquet"
    _as_parquet(single(GUISES["dots"].log(FOURBAR)), path)
    result = judge(PLAIN, path, target=("--target", "1e-4"))
    assert result.exit_code == 0, result.output + result.stderr


def test_what_is_not_of_the_scene_is_left_out_and_listed(judge: Judge) -> None:
    log = logged(FOURBAR, even(FOURBAR, 1.0, PER_TURN), SHORT)
    lines = Dress().text(log).decode().splitlines()
    more = [f"{line},ok,,torque {n}\n" for n, line in enumerate(lines)]
    more[0] = f"{lines[0]},state,empty,motor current [A]\n"
    result = judge(PLAIN, "".join(more).encode())
    assert result.exit_code == 0, result.output + result.stderr
    for column in ("state", "empty", "motor current [A]"):
        assert column in result.output


def test_what_a_log_lacks_is_not_judged_unless_it_is_required(judge: Judge) -> None:
    log = Dress().text(logged(FOURBAR, even(FOURBAR, 1.0, PER_TURN), SHORT[1:2]))
    result = judge(PLAIN, log)
    assert result.exit_code == 0, result.output + result.stderr
    assert "not judged" in result.output.lower()
    assert "coupler" in result.output
    for name in ("coupler", "C"):
        assert judge(PLAIN, log, "--require", name).exit_code == 1
    assert judge(PLAIN, log, "--require", "rocker.angle").exit_code == 0


@pytest.mark.parametrize("linkage", [FOURBAR, SLIDER_CRANK, SIXBAR], ids=list(LINKAGES))
def test_another_speed_and_start_are_fitted(linkage: Linkage, judge: Judge) -> None:
    scene = next(name for name, one in LINKAGES.items() if one is linkage)
    moved = replace(linkage, speed_rad_s=9.3, start_deg=linkage.start_deg + 2.0)
    log = Dress().text(logged(moved, uneven(moved, 1.0, PER_TURN), COLUMNS[scene]))
    result = judge(scene, log, "--drive", "fitted")
    assert result.exit_code == 0, result.output + result.stderr
    assert "9.3" in result.output


def test_a_crank_that_turns_as_it_likes_is_taken_as_it_is_logged(judge: Judge) -> None:
    log = logged(FOURBAR, even(FOURBAR, 1.5, PER_TURN), SHORT)
    clock = log["time_s"]
    log["time_s"] = clock + 0.02 * np.sin(10.0 * clock) ** 2
    text = Dress().text(log)
    assert judge(PLAIN, text).exit_code == 1
    assert judge(PLAIN, text, "--drive", "fitted").exit_code == 1
    result = judge(PLAIN, text, "--drive", "logged")
    assert result.exit_code == 0, result.output + result.stderr


def test_a_log_that_begins_late_in_a_later_turn_is_the_same(judge: Judge) -> None:
    time_s = 4.0 + even(FOURBAR, 1.0, PER_TURN) / 3.0
    log = Dress().text(logged(FOURBAR, time_s, SHORT))
    result = judge(PLAIN, log)
    assert result.exit_code == 0, result.output + result.stderr


@pytest.mark.parametrize("name", ["units in brackets", "decimal commas", "names that say nothing"])
def test_the_map_that_is_written_reads_the_log_in_the_same_way(
    name: str, judge: Judge, tmp_path: Path
) -> None:
    guise = GUISES[name]
    text = guise.dress.text(guise.log(FOURBAR, 1.0))
    written, first, again = (tmp_path / each for each in ("written.toml", "1.json", "2.json"))
    mapped = guise.map(FOURBAR)
    assert judge(PLAIN, text, "--write-map", str(written), mapped=mapped).exit_code == 0
    judge(PLAIN, text, "--json", str(first), mapped=mapped)
    result = judge(PLAIN, text, "--map", str(written), "--json", str(again))
    assert result.exit_code == 0, result.output + result.stderr
    one, other = (json.loads(each.read_text(encoding="utf-8"))["errors"] for each in (first, again))
    assert one == other


def test_a_column_that_a_map_ignores_is_ignored_by_the_map_that_is_written(
    judge: Judge, tmp_path: Path
) -> None:
    log = logged(FOURBAR, even(FOURBAR, 1.0, PER_TURN), SHORT)
    text = Dress().text({**log, "rocker.theta_rad": log["rocker_deg"]})
    written = tmp_path / "written.toml"
    mapped = '[[channel]]\ncolumn = "rocker.theta_rad"\nignore = true'
    assert judge(PLAIN, text, "--write-map", str(written), mapped=mapped).exit_code == 0
    result = judge(PLAIN, text, "--map", str(written))
    assert result.exit_code == 0, result.output + result.stderr


@pytest.mark.parametrize(
    "name", ["rocker_deg" * 10_000, "rocker \x1b[31m [deg] \u202e", "=cmd|'/c'!A1 rocker"]
)
def test_a_strange_name_does_no_harm(name: str, judge: Judge) -> None:
    log = logged(FOURBAR, even(FOURBAR, 1.0, PER_TURN), SHORT)
    text = Dress(quoted=True).text({**log, name: log["rocker_deg"]})
    for format_ in ("text", "md"):
        result = judge(PLAIN, text, "--format", format_)
        assert result.exit_code == 0, result.output + result.stderr
        assert not ACTING.search(result.output)
        assert len(result.output) < 6000


@pytest.mark.parametrize("name", ["rocker" + "_" * 90_000 + "deg", "rocker \x1b[31m [deg] \u202e"])
def test_nor_does_that_of_a_column_that_is_out(name: str, judge: Judge) -> None:
    log = logged(FOURBAR, even(FOURBAR, 1.0, PER_TURN), [replace(SHORT[1], per=-DEG)])
    text = Dress(quoted=True).text({"time_s": log["time_s"], name: log["rocker_deg"]})
    told = f"column = {json.dumps(name)}\nof = 'rocker'\nkind = 'angle'\nunit = 'deg'"
    mapped = f"[[channel]]\n{told}" if len(name) < 400 else ""
    for format_ in ("text", "md"):
        result = judge(PLAIN, text, "--format", format_, mapped=mapped)
        assert result.exit_code == 1, result.output + result.stderr
        assert not ACTING.search(result.output)
        assert len(result.output) < 6000
