"""The page as a file, and the summary for a comment on a pull request: whole, escaped and small
enough, also for odd stores, and telling what matters."""

import itertools
import re
from dataclasses import replace
from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console

from models.errors import CrankcheckError
from reports.page import build, comment
from reports.page.build import HERE, page
from reports.page.comment import summary
from reports.page.sections import SECTIONS
from reports.requests.report import ReportRequest
from reports.store.manifest import Manifest
from reports.store.reader import Stored, read_store
from tests.reports.output.test_output import NASTY
from tests.reports.page.conftest import part_of
from tests.reports.page.hostile import Outline, shown_and_not_read, stands_alone
from tests.reports.results.made import Row, cell, stored, untimed

ABSENT = ("engines", "hard", "reading_forces", "free", "elastic", "cams")
STORED = [name for name in SECTIONS if name not in ABSENT]
"""The sections of a driven store of two engines without forces, cams, or hard cases beside it."""


def test_every_section_is_there_in_its_order_and_nothing_is_loaded(small_page: Path) -> None:
    stands_alone(small_page.read_text(encoding="utf-8"), STORED)


def test_our_scripts_make_no_html_of_strings() -> None:
    for path in sorted((HERE / "assets").glob("*.js")):
        script = path.read_text(encoding="utf-8")
        for way in ("innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", "eval("):
            assert way not in script, f"{path.name}: {way}"
        assert "https:" not in script


def test_hostile_text_is_shown_and_not_read(evil_page: Path) -> None:
    shown_and_not_read(evil_page.read_text(encoding="utf-8"), scripts=3)  # theme, Plotly, ours


def test_stores_that_lack_much_have_a_page(small: Stored, tiny: Stored, tiny_page: Path) -> None:
    text = tiny_page.read_text(encoding="utf-8")
    assert Outline(text).sections() == STORED
    assert "Over all scenes" not in text
    found = part_of(small, small.cells["status"] != "ok")
    assert not found.cells.empty
    assert "stability" in Outline(page(found)).sections()
    outline = Outline(page(replace(tiny, manifest=Manifest({}, tiny.manifest.runs))))
    assert outline.sections() == [name for name in STORED if name != "motion"]


def test_drawings_give_way_where_the_page_gets_too_large(
    tiny: Stored, tiny_page: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = tiny_page.read_text(encoding="utf-8")
    monkeypatch.setattr(build, "MOST_BYTES", len(whole.encode()) - build.BUDGET + 1000)
    thinned = page(tiny)
    assert len(re.findall('"base64"', thinned)) < len(re.findall('"base64"', whole))


def report(*asked: object) -> str:
    said = StringIO()
    assert ReportRequest(*asked).run(Console(file=said, width=200), Console()) == 0
    return said.getvalue()


def test_the_command_names_a_file_itself_and_gives_text_to_the_terminal_or_to_a_file(
    small_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(build, "page", lambda *_: "<!doctype html>")
    said = report(small_folder, None, "html")
    assert (tmp_path / "report.html").read_text() == "<!doctype html>"
    assert re.search(r"report\.html: 24 cells, \d\.\d MB", said)
    monkeypatch.setattr(
        comment, "summary", lambda stored, _: f"# {len(stored.cells)} cells [red]\n"
    )
    assert report(small_folder, None, "md") == "# 24 cells [red]\n"
    report(small_folder, tmp_path / "a.md", "md")
    assert (tmp_path / "a.md").read_text() == "# 24 cells [red]\n"


@pytest.mark.parametrize(
    ("name", "format", "message"),
    [
        ("report.html", "MD", "found '.html'; use .md"),
        ("nowhere/report.html", "HTML", "create it first"),
        ("report.pdf", "pdf", "--format 'pdf': unknown; use html or md"),
    ],
)
def test_bad_files_are_refused_first(name: str, format: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(CrankcheckError, match=re.escape(message)):
        report(tmp_path / "no store", tmp_path / name, format)
    assert not list(tmp_path.iterdir())


JUDGED: Row = {"gated": False, "verdict": "within", "reason": "", "failed_rules": "",
               "crankcheck": "0.0.0", "turns": 2.0}  # fmt: skip


def made(number: int, variant: str = "v", **other: object) -> Stored:
    """A store of ``number`` lines with three steps each; other columns are those of the finest."""
    rows = []
    for i, steps in itertools.product(range(number), (90, 180, 360)):
        more = JUDGED | (other if steps == 360 else {})
        more["asked"] = {f"setting_{k}": i for k in range(12)}
        error, name = 1e-3 * (90 / steps) ** 2, f"{variant}{i // 40}"
        rows.append(cell(f"scene-{i % 40}", name, steps, error, 1.0, **more))
    return stored(rows)


def tables(text: str) -> list[list[str]]:
    return [block.split("\n") for block in re.findall(r"(?:^\|.*\n)*^\|.*", text, re.MULTILINE)]


def assert_whole(text: str) -> None:
    assert len(text.encode()) < 60_000
    assert tables(text)
    for rows in tables(text):
        cells = {len(re.split(r"(?<!\\)\|", row)) for row in rows}
        assert len(cells) == 1, rows[0]
        assert re.fullmatch(r"\|( (---|--:) \|)+", rows[1])
    assert text.count("<details>") == text.count("</details>") > 0
    assert len(re.findall("^```", text, re.MULTILINE)) % 2 == 0


def test_it_is_whole_and_says_what_a_reviewer_asks(store: Path) -> None:
    text = summary(read_store(store))
    assert_whole(text)
    head, *_ = text.split("### What to set")
    assert head.startswith("## crankcheck: within tolerance\n")
    assert "all 8 tuned cells" in head
    assert "1 did not end well" in head
    assert "space.step(dt)" in text
    assert "<option timestep" in text
    unseen = r"a floor below \S+ rad is not excluded by these steps"
    assert re.search(rf"\| slotted-lever \| mujoco tuned \| order 2\.\d; {unseen} \|", text)
    assert "| fourbar-lecture-1 | pymunk as-shipped | order 1.0; a floor below " in text
    failed = r"| slotted-lever | pymunk no bias | diverged | 720 | came apart \| \`at\` 1 s |"
    assert failed in text
    assert "crankcheck 0.0.0, mujoco" in text
    assert "abacus" in text
    assert "| pymunk no bias | error\\_bias 0 |" in text


@pytest.mark.parametrize(
    ("number", "finest"),
    [
        (1, {"gated": True, "verdict": "out", "failed_rules": "CC103", "reason": "r" * 3000}),
        (80, {"variant": f"{NASTY} " * 4, "status": "diverged", "reason": NASTY * 40}),
    ],
)
def test_a_large_store_fits_into_a_comment(number: int, finest: dict[str, object]) -> None:
    text = summary(made(number, **finest))
    assert_whole(text)
    assert ("more" in text) == (number > 1)


def test_what_is_out_of_tolerance_is_named_with_its_rules() -> None:
    text = summary(made(2, gated=True, verdict="out", failed_rules="CC103"))
    assert text.startswith("## crankcheck: OUT OF TOLERANCE\n")
    (row,) = [r for r in tables(text)[0] if r.startswith("| scene-1 ")]
    assert {part for part in ("mujoco v0", "360", "CC103 ") if part not in row} == set()
    inside = summary(made(2))
    assert "### Out of tolerance" not in inside
    assert inside.startswith("## crankcheck: no verdict")


def test_the_time_to_reach_an_error_is_given_or_on_how_many_scenes_it_is_reached() -> None:
    def line(scene: str, variant: str, first: float) -> list[Row]:
        errors = {n: first * (90 / n) ** 2 for n in (90, 180, 360)}
        return [cell(scene, variant, n, error, 2.0, **JUDGED) for n, error in errors.items()]

    rows = line("a", "name [of]", 1e-2) + line("b", "name [of]", 1e-2)
    rows += line("a", "late", 1e-2) + [untimed(row) for row in line("b", "late", 1e-1)]
    text = summary(stored(rows))
    assert r"| mujoco name \[of\] | 2.00 | 2.20 | 0.18 | 0.569 | 0/2 | 0/2 |" in text
    assert "| mujoco late | 2.00 (1/2) | 2.20 |  | 1/2 | 0/2 | 0/2 |" in text
    assert "Time to reach" not in summary(stored(map(untimed, rows)))
