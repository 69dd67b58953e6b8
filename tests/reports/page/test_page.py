"""The page as a file: whole, escaped, small enough, also for odd stores."""

import itertools
import re
from collections.abc import Mapping
from dataclasses import replace
from io import StringIO
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from rich.console import Console

from models.array import Array
from models.errors import CrankcheckError
from reports.page import build, comment
from reports.page.build import HERE, page
from reports.page.sections import SECTIONS
from reports.requests.report import ReportRequest, format_of
from reports.store.manifest import Manifest
from reports.store.reader import Stored
from tests.reports.page.conftest import part_of
from tests.reports.page.hostile import Outline, shown_and_not_read, stands_alone
from tests.worlds.tiers import slow

MEGABYTES_8 = 8_000_000
STORED = [name for name in SECTIONS if name not in ("hard", "reading_forces", "free", "elastic")]
"""The sections of a driven store without forces and without hard cases beside it."""


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


def test_a_store_of_one_line_or_of_failures_alone_has_a_page(
    small: Stored, tiny_page: Path
) -> None:
    text = tiny_page.read_text(encoding="utf-8")
    assert Outline(text).sections() == STORED
    assert "Over all scenes" not in text
    found = part_of(small, small.cells["status"] != "ok")
    assert not found.cells.empty
    assert "stability" in Outline(page(found)).sections()


def test_a_store_without_texts_of_scenes_has_no_drawings(paged: tuple[Stored, Path]) -> None:
    stored, _ = paged
    outline = Outline(page(replace(stored, manifest=Manifest({}, stored.manifest.runs))))
    assert outline.sections() == [name for name in STORED if name != "motion"]


class Large(Stored):
    """A store as large as that of the default study: the small one, over and over."""

    def trace(self, key: str) -> Mapping[str, Array]:
        return super().trace(key.partition(" ")[0])


@slow("560 cells, of which a page takes 8 s: other tests make pages give way that are over")
def test_the_page_of_the_default_study_is_below_8_megabytes(small: Stored) -> None:
    one = small.cells[(small.cells["scene"] == "shaper") & (small.cells["status"] == "ok")]
    lines = one[one["variant"] == "tuned"].iloc[[0, 1, 2, 0, 1, 2, 0]]
    rows = []
    for scene, variant in itertools.product(range(10), range(8)):
        line, steps = f"{scene} {variant}", 90.0 * 2.0 ** np.arange(7)
        names = {"line": line, "scene": f"shaper{scene}", "variant": f"variant {variant}"}
        keys = [f"{key} {line} {i}" for i, key in enumerate(lines["key"])]
        dt_s = 0.6283185307179586 / steps
        rows.append(lines.assign(**names, key=keys, steps_per_turn=steps, dt_s=dt_s))
    scene = small.manifest.scenes["shaper"]
    texts = {f"shaper{n}": scene.replace('"shaper"', f'"shaper{n}"') for n in range(10)}
    cells = pd.concat(rows, ignore_index=True)
    manifest = replace(small.manifest, scenes=texts)
    found = page(Large(small.folder, manifest, cells, small.timings, small.examined))
    assert len(cells) == 560
    assert len(re.findall('"base64"', found)) > 560
    assert len(found.encode()) < MEGABYTES_8


def test_drawings_give_way_where_the_page_gets_too_large(
    paged: tuple[Stored, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = paged[1].read_text(encoding="utf-8")
    monkeypatch.setattr(build, "MOST_BYTES", len(whole.encode()) - build.BUDGET + 1000)
    thinned = page(paged[0])
    assert len(re.findall('"base64"', thinned)) < len(re.findall('"base64"', whole))


def report(*asked: object) -> str:
    said = StringIO()
    assert ReportRequest(*asked).run(Console(file=said, width=200), Console()) == 0
    return said.getvalue()


def test_the_command_writes_the_page_and_says_so(small_folder: Path, tmp_path: Path) -> None:
    target = tmp_path / "report.html"
    said = report(small_folder, target, "html")
    assert target.read_text(encoding="utf-8").startswith("<!doctype html>")
    assert re.search(r"report\.html: 24 cells, \d\.\d MB", said)


def test_the_command_names_a_file_itself_and_gives_text_to_the_terminal_or_to_a_file(
    small_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(build, "page", lambda *_: "<!doctype html>")
    report(small_folder, None, "html")
    assert (tmp_path / "report.html").read_text() == "<!doctype html>"
    monkeypatch.setattr(comment, "summary", lambda stored: f"# {len(stored.cells)} cells [red]\n")
    assert report(small_folder, None, "md") == "# 24 cells [red]\n"
    report(small_folder, tmp_path / "a.md", "md")
    assert (tmp_path / "a.md").read_text() == "# 24 cells [red]\n"


@pytest.mark.parametrize(
    ("name", "format", "message"),
    [
        ("report.html", "md", "found '.html'; use .md"),
        ("nowhere/report.html", "html", "create it first"),
    ],
)
def test_a_file_that_can_not_be_written_is_refused_before_the_store_is_read(
    name: str, format: str, message: str, tmp_path: Path
) -> None:
    with pytest.raises(CrankcheckError, match=re.escape(message)):
        report(tmp_path / "no store", tmp_path / name, format)
    assert not list(tmp_path.iterdir())


def test_a_format_is_known_by_its_name() -> None:
    assert [format_of("html"), format_of("MD")] == ["html", "md"]
    with pytest.raises(CrankcheckError, match="--format 'pdf': unknown; use html or md"):
        format_of("pdf")
