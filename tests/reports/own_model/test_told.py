"""An own model on the terminal: all that matters, short, in a narrow one as well."""

import io
import math
from dataclasses import replace

import pytest
from rich.console import Console

from reports.judge.cell import unfinished
from reports.output.console import short
from reports.own_model import account, table
from reports.own_model.account import CheckedLine
from reports.own_model.judged import JudgedModel, errors_of, judged_model
from reports.own_model.table import show
from tests.worlds.own_models import ACTUATORS, CROWDED, FACTS, SLIDER_CRANK, judged


@pytest.fixture(scope="module")
def rubbing() -> JudgedModel:
    """A slider-crank whose rod rubs."""
    return judged(SLIDER_CRANK, "motor")


@pytest.fixture(scope="module")
def crowded() -> JudgedModel:
    """Forty actuators, and a limit that is hit."""
    return judged(CROWDED, "hip")


def printed(one: JudgedModel, width: int = 100) -> list[str]:
    stream = io.StringIO()
    show(Console(file=stream, width=width), one, FACTS)
    return [line.rstrip() for line in stream.getvalue().splitlines()]


def place(lines: list[str], words: str) -> int:
    """The first line with these words."""
    return next(number for number, line in enumerate(lines) if words in line)


def with_own(one: JudgedModel, status: str) -> JudgedModel:
    """The same, but that nothing came of it as written."""
    lost = CheckedLine(**vars(unfinished(one.own.cell, status, "it [red]fell[/] apart")))
    return judged_model(one.account, [lost, *one.lines[1:]])


@pytest.mark.parametrize("width", [40, 60, 140])
def test_lines_and_their_gains_are_whole_at_every_width(rubbing: JudgedModel, width: int) -> None:
    lines = printed(rubbing, width)
    start, end = place(lines, "Recommended"), place(lines, "OUT OF TOLERANCE")
    assert max(len(line) for line in (*lines[:start], *lines[end:])) <= width
    assert "\u2026" not in "\n".join(lines)
    if width >= 60:
        cells = [line.split() for line in lines[:start]]
        for one in rubbing.three:
            row = next(words for words in cells if words[1:2] == [one.cell.profile])
            numbers = [f"{float(word):.1e}" for word in row[2:5]]
            assert numbers == [f"{error:.1e}" for error in errors_of(one)]
        for one in rubbing.three[1:]:
            assert ["gain", *map(table.factor_text, rubbing.gains(one))] in cells


def test_failures_come_first_and_the_verdict_last(rubbing: JudgedModel) -> None:
    lines = printed(rubbing)
    assert lines[0].startswith("OUT  ")
    assert lines[1].startswith("  CC103 angle: link rod: ")
    verdict = lines.index(table.verdict_text(rubbing))
    order = ["CC103", "read as:", "as-written ", "joints:", "can disturb", "Recommended,", "+++ "]
    places = [*(place(lines, word) for word in order), verdict]
    assert places == sorted(places)
    assert "crankcheck 0.0.0" in "\n".join(lines[verdict:])
    assert "recommended: within, " in lines[verdict]
    # Gains are the error as written over that of a line.
    last = rubbing.lines[-1]
    errors = zip(errors_of(rubbing.own), errors_of(last), strict=True)
    assert list(rubbing.gains(last)) == [own / other for own, other in errors]
    assert min(rubbing.gains(last)) > 100


def test_what_disturbs_is_told_by_kind_and_short(crowded: JudgedModel) -> None:
    found = {group.kind: group for group in table.groups(crowded)}
    assert len(found["actuators"].texts) == ACTUATORS
    assert f"and {ACTUATORS - table.EACH} more" in found["actuators"].short()
    lines = printed(crowded)
    assert sum("acts on" in line for line in lines) <= 2
    assert "less error" in found["limits"].effect
    assert found["actuators"].effect == "without: the same error"
    text = " ".join(" ".join(lines).split())
    assert "joint knee is led past its limit by" in text
    assert " limits-off " in text  # it says something
    assert " actuators-off " not in text
    # And how open the pose is, and which joint is worst.
    worst = crowded.joints()[0]
    assert (worst.name, f"{worst.open_m:.1e}") == ("toe", "1.0e-03")
    assert worst.share > 1.0
    assert "open at toe by 1.00e-3 m" in table.reading(crowded.account)["pose"]
    assert "joints: the widest as written is toe, " in text


def test_the_cure_of_a_model_names_its_own_settings(rubbing: JudgedModel) -> None:
    cures = {finding.cure for one in rubbing.lines for finding in one.findings}
    assert not any("profile tuned" in cure for cure in cures)
    best = errors_of(rubbing.lines[-1])[0]
    less = {short(errors_of(one)[0] / best) for one in rubbing.lines if one.verdict == "out"}
    told = {f"The recommended settings: {n} times less error, within tolerance." for n in less}
    assert told
    assert told <= cures


@pytest.mark.parametrize("status", ["timeout", "unsupported"])
def test_a_line_that_did_not_end_has_its_reason(rubbing: JudgedModel, status: str) -> None:
    one = with_own(rubbing, status)
    text = " ".join(" ".join(printed(one)).split())
    assert "it [red]fell[/] apart" in text
    assert "nan" not in text
    assert one.verdict == ("unsupported" if status == "unsupported" else "out")
    assert all(math.isnan(gain) for gain in one.gains(one.lines[-1]))
    assert one.joints()
    assert {group.effect for group in table.groups(one)} == {"without: it runs to its end"}


def test_settings_that_are_there_already_and_those_in_words_are_told(rubbing: JudgedModel) -> None:
    already = "The file has the recommended settings already."
    for patch, told in (("", already), ("set in <option>: [bold]x", "Recommended:")):
        proposal = replace(rubbing.account.recommended, patch=patch)
        one = replace(rubbing, account=replace(rubbing.account, recommended=proposal))
        lines = printed(one)
        assert told in lines
        assert not patch or patch in lines


@pytest.mark.parametrize(
    ("told", "words"),
    [
        (table.factor_words(1.0), "the same error"),
        (table.factor_words(1.2e5), "1.2e5 x less error"),
        (table.factor_words(0.25), "4 x more error"),
        (table.factor_words(math.inf), "no error at all"),
        (table.factor_words(math.nan), "not to be told"),
        (table.share_text(0.0), "below 0.1% of its limit"),
        (table.share_text(137.2), "137 times its limit"),
    ],
)
def test_factors_and_shares_of_a_limit_in_words(told: str, words: str) -> None:
    assert told == words


def test_a_long_course_keeps_its_largest_error(
    rubbing: JudgedModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(account, "MOST", 30)
    long = judged.__wrapped__(SLIDER_CRANK, "motor").own
    whole, course = rubbing.own.course, long.course
    assert whole.time_s.size == long.cell.steps + 1
    assert course.time_s.size <= 30
    assert (course.time_s[0], course.time_s[-1]) == (0.0, whole.time_s[-1])
    assert course.error.max() == whole.error.max() == errors_of(long)[0]
    assert set(course.error) <= set(whole.error)
    gap = long.errors.worst("gap")
    assert whole.gap.max() == pytest.approx(gap.pure, rel=1e-12)


def test_why_the_recommended_settings_are_out_is_told(rubbing: JudgedModel) -> None:
    assert table.still_out(rubbing) == ""
    own, last = rubbing.own, rubbing.lines[-1]
    failing = replace(last, findings=own.findings)
    one = replace(rubbing, lines=[*rubbing.lines[:-1], failing])
    worst = max(own.failures, key=lambda finding: finding.number / finding.limit)
    assert table.still_out(one).startswith(f"out by {worst.rule} ")
    assert table.still_out(one).endswith(f"; and by {len(own.failures) - 1} more rules")
    text = " ".join(" ".join(printed(one)).split())
    assert f"recommended: out by {worst.rule}" in text
