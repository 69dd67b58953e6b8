"""The page of a store of what was let go, or whose links bend, alone and beside what was driven."""

import json
import re
from dataclasses import replace
from io import StringIO
from pathlib import Path

import pandas as pd
import pytest
from rich.console import Console

from reports.page.build import page
from reports.page.comment import summary
from reports.page.sections import SECTIONS
from reports.page.sections.section import PageReport
from reports.results.recommend import Recommendation, recommendation_table, recommendations
from reports.store.manifest import Manifest
from reports.store.reader import Stored, read_store
from reports.ways.elastic import WAY
from tests.reports.page.conftest import Write, swept
from tests.reports.page.hostile import Outline
from tests.reports.page.tab import OUT, Tab
from tests.worlds.free_store import SCENE as FREE

ELASTIC = "fourbar-elastic"


@pytest.fixture(scope="module")
def free(free_store: Path) -> Stored:
    return read_store(free_store)


@pytest.fixture(scope="module")
def free_path(free: Stored, written: Write) -> Path:
    return written(page(free))


@pytest.fixture(scope="module")
def bent(tmp_path_factory: pytest.TempPathFactory) -> Stored:
    asked = (ELASTIC, "--engine", "mujoco", "--profile", "tuned", "--segments", "3,4")
    steps = ("--steps-per-turn", "360,720", "--turns", 1)
    return read_store(swept(tmp_path_factory.mktemp("elastic") / "store", *asked, *steps))


@pytest.fixture(scope="module")
def bent_path(bent: Stored, written: Write) -> Path:
    return written(page(bent))


def beside(small: Stored, other: Stored) -> Stored:
    cells = pd.concat([small.cells, other.cells], ignore_index=True)
    scenes = {**small.manifest.scenes, **other.manifest.scenes}
    runs = [*small.manifest.runs, *other.manifest.runs]
    both = replace(small, cells=cells, manifest=Manifest(scenes, runs))
    vars(both)["_traces"] = {**small._traces, **other._traces}
    return both


def embedded(report: PageReport, name: str) -> dict[str, object]:
    return json.loads(json.dumps(SECTIONS[name](report).embedded, default=list))


def told_before_provenance(path: Path, own: str) -> str:
    text = path.read_text(encoding="utf-8")
    assert Outline(text).sections() == ["verdict", own, "stability", "fairness", "provenance"]
    return text[: text.index('id="provenance"')]


def test_a_page_of_free_runs_has_no_section_that_speaks_of_turns(free_path: Path) -> None:
    told = told_before_provenance(free_path, "free")
    for words in ("free drive", "steps a turn", "closed form"):
        assert words not in told  # where all were let go it needs no word


def test_driven_stores_keep_their_sections(small: Stored, free: Stored, bent: Stored) -> None:
    report = PageReport(beside(beside(small, free), bent))
    assert not {FREE, ELASTIC} & set(report.driven.scenes)
    assert "segments" not in json.dumps(embedded(report, "convergence"))
    assert SECTIONS["elastic"](report) is not None
    driven, every = ({x.number for x in each.looks.values()} for each in (report.driven, report))
    assert driven <= every
    assert [each["name"] for each in embedded(report, "free")["scenes"]] == [FREE]
    for line in report.driven.lines:
        assert report.driven.look(line) == report.look(line)
    alone = PageReport(small)
    assert alone.driven is alone
    assert SECTIONS["free"](alone) is None


def test_every_free_run_moves_with_its_courses_under_its_engine(free: Stored) -> None:
    report = PageReport(free)
    shown = embedded(report, "free")["scenes"][0]
    assert len(shown["lines"]) == 4
    for line in shown["lines"]:
        assert [cell["dt"] for cell in line["cells"]] == ["4.00 ms", "2.00 ms"]
        for cell in line["cells"]:
            assert cell["off"] is not None
            assert {"phase", "phase_judged", "angle", "speed", "energy"} <= set(cell["names"])
    words = SECTIONS["stability"](report).words
    assert dict(words["engines"]) == {"mujoco": 2, "pymunk": 2}
    assert [look.engine for look in words["looks"]] == ["mujoco"] * 2 + ["pymunk"] * 2


def test_a_free_run_is_drawn_and_every_choice_has_curves(wide: Tab, free_path: Path) -> None:
    seen = wide.open(free_path, "free").page
    chart = "document.getElementById('free-chart')"
    for course in ("phase_judged", "phase", "energy", "speed", "angle", "portrait"):
        seen.select_option("#free-course", course)
        seen.wait_for_function(f"() => {chart}.data.some(each => each.x.length > 50)")
        assert seen.evaluate(f"() => {chart}.layout.yaxis.title.text")
    before = wide.drawn("#free-picture .overlays path")[0]
    wide.slide("free-slider", 300)
    assert wide.drawn("#free-picture .overlays path")[0] != before
    assert "0.250 s" in wide.text("#free-angle")
    row = seen.locator("#free-cells tbody tr").last
    row.locator("a.known").click()
    _, dt, verdict, phase, *_ = row.locator("td").all_inner_texts()
    known = wide.text("#free-known")
    assert f"dt {dt}: {verdict}." in known
    shown = re.search(r"phase: .*?sensitivity\s+(\S+) rad", known)
    assert shown
    assert float(shown[1]) == pytest.approx(float(phase), rel=0.05)
    command = wide.text("#free-command")
    assert command.startswith(f"crankcheck sweep -o again {FREE} --free --duration 0.6 --engine")
    assert command.endswith("--no-timing --dt 0.002")


def test_settings_of_free_motion_are_to_be_copied(free: Stored) -> None:
    """Each is led by what it promises, has the step that was run, and no speed of a crank."""
    timed = replace(free, cells=free.cells.assign(us_per_step=1.0, s_per_turn=1e-3))
    found = [one for one in recommendations(timed) if not one.reason]
    assert {one.best.engine for one in found} == {"mujoco", "pymunk"}
    for one in found:
        text = one.snippet()
        assert repr(1.0 / one.best.steps_per_turn) in text
        assert "place over the sensitivity" in " ".join(text.split())
        assert "Drive: none." in text
        assert "crank at" not in text
        assert "speed)" not in text
    assert "copying.js" in SECTIONS["free"](PageReport(timed)).scripts
    assert "To be copied" in page(timed)


def test_elastic_cells_have_a_section_with_their_own_heads(bent_path: Path) -> None:
    told = told_before_provenance(bent_path, "elastic")
    assert "closed form" not in told
    assert "beam / D" in told
    assert "As tuned, 3 segments, it is within tolerance" in told


def test_the_course_of_the_beam_is_that_of_the_engine_less_its_error(bent: Stored) -> None:
    last = PageReport(bent).of_kind("elastic")[-1].cells.iloc[-1]
    trace = bent.trace(str(last["key"]))
    largest = abs(trace["deflection.coupler"] - trace["deflection_error.coupler"]).max()
    off = abs(trace["deflection_error.coupler"]).max() / largest
    assert off == pytest.approx(last["deflection_pure"], rel=0.02)


def told(found: tuple[Recommendation, ...]) -> str:
    console = Console(file=StringIO(), width=100)
    console.print(recommendation_table(found, 100))
    return console.file.getvalue()


def test_settings_are_recommended_by_the_deflection(small: Stored, bent: Stored) -> None:
    found = recommendations(bent)
    assert [one.target for one in found] == list(WAY.results.targets)
    assert "/ D" in told(found)
    assert "rad" not in told(found)
    text = found[0].snippet()
    assert "deflection (of the largest) within 0.1" in text
    assert "rigid segments, with a spring of rate EI n / l" in " ".join(text.split())
    assert "over the largest" in summary(bent)
    both = told(recommendations(beside(small, bent)))
    assert "rad" in both
    assert "/ D" in both


def test_the_section_draws_on_a_phone_within_its_window(phone: Tab, bent_path: Path) -> None:
    seen = phone.open(bent_path, "elastic").page
    seen.locator("#elastic-course").select_option("error")
    seen.locator("#elastic-error").select_option("segments_pure")
    names = "() => document.getElementById('elastic-chart').data.map(each => each.name)"
    assert any("mujoco tuned, 4 segments" in name for name in seen.evaluate(names))
    seen.locator("#elastic-cells a.known").first.click()
    assert "mujoco tuned, 3 segments, 360 steps a turn" in phone.text("#elastic-known")
    assert "--segments 3 --turns 1 --springs plain" in phone.text("#elastic-command")
    assert not seen.evaluate(OUT)
