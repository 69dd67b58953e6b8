"""The page of a judged model: whole, escaped, small enough, and alive in a browser."""

import re
from dataclasses import replace
from html import escape
from pathlib import Path

import pytest

from reports.judge.cell import unfinished
from reports.own_model.account import CheckedLine
from reports.own_model.judged import JudgedModel, judged_model
from reports.page.build import _plotly
from reports.page.model_page import model_page
from sim.registry.own_models import Disturbance
from tests.reports.page.conftest import Write
from tests.reports.page.hostile import Outline, embedded_in, stands_alone
from tests.reports.page.tab import Tab
from tests.reports.page.test_log_page import NASTY, words
from tests.worlds.own_models import ACTUATORS, CROWDED, FACTS, SLIDER_CRANK, judged

SECTIONS = ["verdict", "lines", "motion", "disturbing", "recommended", "made"]
MEGABYTE = 1_000_000


@pytest.fixture(scope="module")
def rubbing() -> JudgedModel:
    return judged(SLIDER_CRANK, "motor")


@pytest.fixture(scope="module")
def text(rubbing: JudgedModel) -> str:
    return model_page(rubbing, FACTS)


def lost(one: JudgedModel) -> JudgedModel:
    """The same, with no line that logged anything."""
    lines = [CheckedLine(**vars(unfinished(line.cell, "crashed", NASTY))) for line in one.lines]
    return judged_model(one.account, lines)


def test_it_stands_alone_is_small_and_tells_all_parts(text: str, rubbing: JudgedModel) -> None:
    stands_alone(text, SECTIONS)
    assert len(text.encode()) - len(_plotly().encode()) < MEGABYTE
    told = words(text)
    for part in ("as-written", "contacts-off", "recommended", "gain", "Every joint and loop"):
        assert part in told
    for joint in rubbing.joints():
        assert joint.name in told
    for line in rubbing.patch.splitlines():
        assert escape(line).replace("&quot;", "&#34;") in text
    assert "piston touches rod in 100% of the poses" in told
    lines = embedded_in(text, "lines")["lines"]
    assert len(lines) == 3
    assert all(line["course"]["error"]["samples"] > 100 for line in lines)
    assert [line["look"] for line in embedded_in(text, "motion")["lines"]] == [0, 1, 2]
    account = replace(rubbing.account, request=replace(rubbing.account.request, converge=False))
    without_finer = model_page(replace(rubbing, account=account), FACTS)
    assert [len(re.findall('class="chart', each)) for each in (text, without_finer)] == [2, 1]


def test_many_disturbances_of_a_kind_stand_in_a_drawer() -> None:
    text = model_page(judged(CROWDED, "hip"), FACTS)
    assert f"and {ACTUATORS - 1} more</summary>" in text
    assert text.count("acts on joint knee</li>") == ACTUATORS


def test_a_model_of_which_nothing_ran_has_a_page_that_no_file_acts_on(rubbing: JudgedModel) -> None:
    account, bare = rubbing.account, lost(rubbing)
    request = replace(account.request, path=Path(f"{NASTY.replace('/', '')}.xml"), joint=NASTY)
    hostile = replace(
        account, request=request, notes=[NASTY], disturbances=[Disturbance("contacts", NASTY)],
        recommended=replace(account.recommended, patch=f"--- {NASTY}\n"),
        open_m={NASTY: 1.0, **account.open_m},
    )  # fmt: skip
    text = model_page(JudgedModel(account=hostile, lines=bare.lines), FACTS)
    calm = model_page(bare, FACTS)
    outline, plain = Outline(text), Outline(calm)
    assert plain.sections() == [name for name in SECTIONS if name != "lines"]
    assert "Not drawn, as nothing was logged" in calm
    assert outline.open == []
    assert outline.sections()[0] == "verdict"
    assert not {"\u202e", "\x1b"} & set(text)
    assert len(outline.named("script")) == len(plain.named("script"))


def test_the_scripts_draw_each_line_switched_on(wide: Tab, written: Write, text: str) -> None:
    page = wide.open(written(text), "lines", "motion").page
    course, steps = (f"document.getElementById('lines-{each}')" for each in ("course", "steps"))
    names = ["as-written", "contacts-off", "recommended", "limit"]
    assert page.evaluate(f"{course}.data.map(each => each.name)") == names
    assert page.evaluate(f"{steps}.data.map(each => each.y.length)") == [3, 3, 3]
    assert page.locator("#motion-picture .run").count() == 3
    assert "as-written" in wide.text("#motion-readout")
    wide.every_control_has_a_name(is_reached_by_tab=False)
    page.locator("#motion-legend [data-item='0']").click()
    page.locator("#lines-legend [data-item='0']").click()
    page.select_option("#lines-what", "gap")
    page.wait_for_function(f"{course}.data.length === 3")
    assert page.locator("#motion-picture .run").count() == 2
    page.locator("#lines-legend [data-item='1']").click()
    low, high = page.evaluate(f"{steps}.layout.yaxis.range")
    assert high - low >= 1.0
    assert "gap" in page.evaluate(f"{course}.layout.yaxis.title.text")
