"""The page of hard cases as a file: what its map says, also of odd matrices."""

import math
import re
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from reports.drawing.moving import embedded
from reports.page import build
from reports.page.build import page, stability_page
from reports.page.sections import SECTIONS
from reports.page.sections.hard import SHADES, SIGNS, hard, heat, same, shade
from reports.page.sections.section import fitting
from reports.stability.grades import MEANINGS
from reports.stability.matrix import FILE, OUTCOMES, Matrix, read_matrix, to_json
from reports.stability.running import command
from reports.store.reader import Stored
from tests.reports.page.hostile import EVIL, Outline, embedded_in, shown_and_not_read, stands_alone
from tests.reports.page.test_page import MEGABYTES_8


@pytest.fixture(scope="module")
def text(hard_page: Path) -> str:
    return hard_page.read_text(encoding="utf-8")


def buttons(text: str) -> dict[int, dict[str, str | None]]:
    """The cells of the map by the number of their run."""
    cells = [each for each in Outline(text).named("button") if "data-run" in each]
    return {int(each["data-run"]): each for each in cells}


def one_case(matrix: Matrix, **run: object) -> Matrix:
    """The first run of a matrix alone, changed, with its case of one value."""
    first = replace(matrix.runs[0], **run)
    case = replace(matrix.cases[0], values=(first.value,), labels=(first.label,))
    return Matrix(matrix.facts, (case,), (first,), ())


def test_the_page_stands_alone_with_a_sign_for_every_outcome(text: str, matrix: Matrix) -> None:
    assert set(SIGNS) == set(MEANINGS) == set(OUTCOMES)
    assert len(set(SIGNS.values())) == len(OUTCOMES)
    stands_alone(text, ["hard"])
    assert "3 cases, 60 runs" in text
    assert all(value in text for value in matrix.facts.values())
    assert len(text) < 500_000  # without Plotly


def test_there_is_a_cell_for_each_run_and_it_says_how_it_went(text: str, matrix: Matrix) -> None:
    found = buttons(text)
    grid = {number for number, run in enumerate(matrix.runs) if run.grid}
    assert set(found) == grid
    assert len(grid) < len(matrix.runs)
    for number in grid:
        run, cell = matrix.runs[number], found[number]
        words, classes = cell["aria-label"] or "", (cell["class"] or "").split()
        assert words == cell["title"]
        assert f"{run.value:g}, {run.engine} {run.profile}: {run.outcome}" in words
        assert ("(holds)" in words) == (run.outcome == "ok") == ("held" in classes)
        assert f"error {run.error:.1e}".replace("e-0", "e-").replace("e+00", "e0") in words
        assert run.reason in words
        assert f"s{shade(run.error)}" in classes
        assert f"o-{run.outcome}" in classes
        assert ("pictured" in classes) == (run.outcome != "ok")


def test_the_map_is_a_table_of_cases_by_engine_and_profile(text: str, matrix: Matrix) -> None:
    scopes = Counter(each.get("scope") for each in Outline(text).named("th"))
    counts = [scopes[each] for each in ("row", "rowgroup", "colgroup", "col")]
    assert counts == [len(matrix.cases), 2, 2, 1 + 4]
    found = heat(matrix)
    assert [column.name for column in found.columns][:2] == ["mujoco as-shipped", "mujoco tuned"]
    assert found.columns[1].words == "holds 3 of 3 throughout"
    assert found.columns[0].words == "holds 0 of 3 throughout"
    for one in matrix.critical:
        assert one.words in text


def test_each_failure_has_its_picture_and_a_truth_is_carried_once(
    text: str, matrix: Matrix
) -> None:
    found = embedded_in(text, "hard")
    failed = [n for n, run in enumerate(matrix.runs) if run.outcome != "ok"]
    assert sorted(picture["run"] for picture in found["pictures"]) == failed
    assert len(failed) > 10
    assert len(found["drawings"]) < len(failed)
    assert set(map(str, failed)) <= {each["value"] for each in Outline(text).named("option")}
    assert found["runs"][failed[0]]["command"] == command(matrix.runs[failed[0]])


def test_a_matrix_that_was_stored_gives_the_same_page(
    matrix: Matrix, text: str, tmp_path: Path
) -> None:
    (tmp_path / FILE).write_text(to_json(matrix))
    assert stability_page(read_matrix(tmp_path)) == text


def test_the_shade_follows_the_power_of_the_error() -> None:
    shades = {0.0: 0, 9e-7: 0, 1e-6: 1, 5e-3: 2, 1e-2: 3, 1.0: 4, 1e9: 4}
    assert {error: shade(error) for error in shades} == shades
    assert len(SHADES) == 4


def single(matrix: Matrix, **run: object) -> tuple[str, str, list[str]]:
    """The page of the first run alone, changed; what its cell says, and the classes of that."""
    text = stability_page(one_case(matrix, **run))
    (cell,) = buttons(text).values()
    return text, cell["title"] or "", (cell["class"] or "").split()


def test_what_is_no_number_is_shown(matrix: Matrix) -> None:
    for error in (math.nan, math.inf, None):
        _, told, classes = single(matrix, error=error)
        assert "blank" in classes
        assert "error \N{EN DASH}" in told
    lost = dict.fromkeys(
        ("error", "gap", "drive", "sine", "at_s", "at_driver_rad", "dt_s", "wall_s"), math.nan
    )
    for numbers in (lost, dict.fromkeys(lost)):
        found = embedded_in(single(matrix, **numbers)[0], "hard")["runs"][0]
        assert {found[name] for name in lost} == {None}
        assert found["at_driver"] is None
    assert [same(None, math.nan), same(1.0, math.nan), same(1.0, None)] == [True, False, False]
    assert single(matrix, value=math.nan)[1].startswith("nan, mujoco")


def test_an_outcome_of_good_engines_is_held_and_an_unknown_one_shown(matrix: Matrix) -> None:
    text, told, classes = single(matrix, outcome=f"{EVIL} exploded")
    assert "o-strange" in classes
    assert "exploded (fails)" in told
    assert "not known to this page" in text
    assert Outline(text).named("img") == []
    locked = one_case(matrix, outcome="locked")
    right = replace(locked, cases=(replace(locked.cases[0], good=("locked",)),))
    for one, state in ((locked, "failed"), (right, "held")):
        text, _, classes = single(one)
        assert {state, "o-locked"} <= set(classes)
    assert "right: locked" in text


def test_a_value_that_was_not_run_or_only_by_a_bisection_says_so(matrix: Matrix) -> None:
    first, *others = matrix.runs
    for runs in (others, [replace(first, grid=False), *others]):
        found = replace(matrix, runs=tuple(runs))
        assert 'title="360: not run"' in stability_page(found)
        assert heat(found).columns[0].words == "holds 0 of 3 throughout"


def test_a_matrix_of_no_run_has_a_page_and_of_one_with_its_long_reason(matrix: Matrix) -> None:
    nothing = stability_page(Matrix({}, (), (), ()))
    assert "0 cases, 0 runs" in nothing
    reason = "it broke " * 300
    text, told, _ = single(matrix, reason=reason)
    assert Outline(text).open == Outline(nothing).open == []
    assert "hard-failures" not in text.split("<script>")[2]
    assert "1 case, 1 run;" in text
    assert len(told) < 400  # in the map it is cut
    assert embedded_in(text, "hard")["runs"][0]["reason"] == reason


def evil(matrix: Matrix) -> Matrix:
    def marked(one: Any, *fields: str, **other: object) -> Any:
        names = {name: f"{EVIL}{getattr(one, name)}" for name in (*fields, "engine", "profile")
                 if hasattr(one, name)}  # fmt: skip
        return replace(one, **names, **other)

    told = ("name", "group", "title", "source", "truth", "expected", "parameter", "unit")
    labels = [tuple(f"{EVIL}{label}" for label in case.labels) for case in matrix.cases]
    drawings = [{**one.drawing, "name": EVIL} for one in matrix.pictures]
    return Matrix(
        {EVIL: EVIL, "made": EVIL},
        tuple(marked(x, *told, labels=own) for x, own in zip(matrix.cases, labels, strict=True)),
        tuple(marked(x, "case", label=EVIL, reason=EVIL) for x in matrix.runs),
        tuple(marked(x, "case", words=EVIL) for x in matrix.critical),
        tuple(marked(x, "case", title=EVIL, drawing=own)
              for x, own in zip(matrix.pictures, drawings, strict=True)),
    )  # fmt: skip


def test_hostile_text_is_shown_and_not_read(matrix: Matrix) -> None:
    text = stability_page(evil(matrix))
    shown_and_not_read(text, scripts=2)  # the theme, ours
    assert len(buttons(text)) == 48


def test_the_hard_cases_stand_in_the_report_and_change_no_other_section(
    paged: tuple[Stored, Path], both_page: Path
) -> None:
    without, found = (path.read_text(encoding="utf-8") for path in (paged[1], both_page))
    # Neither were forces asked for, nor was one let go, nor has one elastic links.
    there = [name for name in SECTIONS if name not in ("reading_forces", "free", "elastic")]
    assert Outline(found).sections() == there
    parts = [re.findall(r"<section.*?</section>", text, re.DOTALL) for text in (without, found)]
    assert parts[0] == [part for part in parts[1] if not part.startswith('<section id="hard"')]


def test_what_does_not_fit_makes_way_and_the_first_failures_stay(matrix: Matrix) -> None:
    room = 30_000
    section = hard(matrix, room)
    numbers = [picture["run"] for picture in section.embedded["pictures"]]
    assert 0 < len(numbers) < len(matrix.pictures)
    lines = {matrix.runs[n].case + matrix.runs[n].profile for n in numbers}
    assert len(lines) > len(numbers) / 3
    shown = [section.embedded[name] for name in ("pictures", "drawings")]
    assert len(embedded(shown)) < room + 40 * len(numbers)
    assert section.words["thinned"]
    assert not hard(matrix).words["thinned"]
    assert fitting([0, 1, 2], [5, 5, 1], 6) == [0, 2]
    assert fitting([1, 2, 0], [5, 5, 1], 6) == [1, 2]


def test_a_page_of_many_large_pictures_is_below_8_megabytes(
    matrix: Matrix, monkeypatch: pytest.MonkeyPatch
) -> None:
    wide = {**matrix.pictures[0].drawing, "places": {"base64": "A" * 200_000}}
    twice = enumerate(matrix.pictures * 2)
    many = tuple(replace(one, drawing={**wide, "name": str(i)}) for i, one in twice)
    heavy = replace(matrix, pictures=many)
    text = stability_page(heavy)
    assert 4_000_000 < len(text.encode()) < MEGABYTES_8
    monkeypatch.setattr(build, "MOST_BYTES", 2_000_000)
    assert 1_500_000 < len(stability_page(heavy).encode()) < 2_000_000


def test_pictures_give_way_where_the_report_gets_too_large(
    paged: tuple[Stored, Path], matrix: Matrix, both_page: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = both_page.read_text(encoding="utf-8")
    most = len(whole.encode()) - 30_000
    monkeypatch.setattr(build, "MOST_BYTES", most)
    found = page(paged[0], matrix)
    assert len(found.encode()) <= most
    kept, every = (embedded_in(each, "hard")["pictures"] for each in (found, whole))
    assert 0 < len(kept) < len(every)
    assert "to keep the page small" in found.lower()
