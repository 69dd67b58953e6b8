"""Faults planted in a healthy model: each is named with its joint or body, or refused with it. What
is recommended was seen to gain: contacts off, the integrator, or nothing at all. And the verdict on
the terminal: all that matters, short, in a narrow one as well."""

import io
import math
from dataclasses import replace
from pathlib import Path

import pytest
from rich.console import Console

from models.errors import CrankcheckError
from reports.judge.cell import unfinished
from reports.output.numbers import short
from reports.own_model import account, table
from reports.own_model.account import CheckedLine, ModelAccount
from reports.own_model.judged import JudgedModel, errors_of, judged_model
from reports.own_model.table import show
from reports.page.model_page import model_page
from tests.worlds.own_four_bar import BY_SITES, CLOSED, planted, rocker
from tests.worlds.own_models import (
    ACTUATORS,
    CROWDED,
    FACTS,
    SLIDER_CRANK,
    judged,
    line,
    read_text,
    texts,
)
from tests.worlds.tiers import slow, slowly


def read(folder: Path, *edits: str) -> ModelAccount:
    return read_text(folder, planted(*edits), converge=False)


OFF, SOLREF = 'anchor="0.23373437', 'solref="0.005 0.6"'
HOME = '<keyframe><key name="home" qpos="0 0 0"/></keyframe>'
BELT = '<tendon><fixed name="belt" armature="1"><joint joint="D" coef="1"/></fixed></tendon>'
TIP = "0 0 0 -0.06626563 0 0.18870312"
INERTIAL = '<inertial pos="-0.033 0 0.094" mass="0.2" diaginertia="7e-4 7e-4 7e-4"/>'
LIFTED = ('<body name="rocker"', '<body name="rocker" gravcomp="-5"')
NAMED = {
    "anchor 1 mm off": ((OFF, 'anchor="0.23473437'), "loop C: its pin is 0.001 m off"),
    "a contact that rubs": (
        ('contype="0" conaffinity="0"', ""), "coupler-bar touches rocker-bar in 100% of the poses"
    ),
    "a spring": (rocker('stiffness="5"'), "joint D: a spring of 5 N m/rad"),
    "a heavy rotor": (rocker('armature="1000"'), "joint D: an armature of 1e+03 kg m^2"),
    "solref of a twentieth of a second": (
        (SOLREF, 'solref="0.05 1"'), "loop C: solref gives it a time constant of 0.05 s"
    ),
    "solref of a soft spring": (
        (SOLREF, 'solref="-100 -1000"'),
        "loop C: solref gives it a stiffness of 100 1/s^2 and a damping of 1000 1/s; MuJoCo's own "
        "are 2500 and 100",
    ),
    "a rotor on a tendon": (
        ("<equality>", f"{BELT}<equality>"),
        "tendon belt goes over the linkage: an armature of 1, which moves with it",
    ),
    "a weight that is lifted": (
        ('gravity="0 0 0"', 'gravity="0 0 -9.81"', *LIFTED),
        "body rocker: gravcomp lifts it by -5 x its weight",
    ),
    "a limit that is hit": (
        rocker('limited="true" range="-0.2 0.2"'), "joint D is led past its limit by 32.8 deg"
    ),
    "gravity across the plane": (
        ('gravity="0 0 0"', 'gravity="0 -9.81 0"'), "gravity of 9.81 m/s^2 across the plane"
    ),
    "a ref that opens a keyframe": (
        ('<joint name="B"/>', '<joint name="B" ref="0.5"/>', "</equality>", f"</equality>{HOME}"),
        "keyframe home: loop C is open by 0.124 m",
    ),
    "a ref outside the limits": (
        rocker('ref="5" limited="true" range="-3 3"'),
        "joint D: it reads 286.5 deg as it is drawn, outside its limits; is its ref right?",
    ),
    "two points of a link that were meant to be one": (
        ('<joint name="B"/>', '<joint name="B" pos="0.001 0 0"/>'),
        "joint B: its pin is 0.001 m off",
    ),
}  # fmt: skip


@pytest.mark.parametrize("fault", NAMED)
def test_it_is_named_with_its_joint(fault: str, tmp_path: Path) -> None:
    edits, words = NAMED[fault]
    told = texts(read(tmp_path, *edits))
    assert any(text.startswith(words) for text in told), told


@pytest.mark.parametrize(
    "edits",
    [
        (),
        ('<body name="rocker"', '<body name="rocker" gravcomp="1"'),
        # A pin without a mark, as long as a bar of another body, on one that has only a ball.
        (
            f'fromto="{TIP}"',
            'type="sphere" size="0.01"',
            f'<site name="rocker-tip" pos="{TIP[6:]}"/>',
            "",
        ),
        # MuJoCo replaces what is half of each kind, and says so of its own accord.
        (SOLREF, 'solref="0.05 -1"'),
    ],
    ids=["plain", "no gravity to lift", "a ball for a bar", "neither kind of solref"],
)
def test_what_disturbs_nothing_is_not_named(edits: tuple[str, ...], tmp_path: Path) -> None:
    account = read(tmp_path, *edits)
    assert not account.disturbances
    assert account.profiles == ["as-written", "contacts-off", "recommended"]


def test_sites_that_do_not_meet_are_told_by_the_pose(tmp_path: Path) -> None:
    moved = 'name="rocker-tip" pos="-0.06726563'
    account = read(tmp_path, CLOSED, BY_SITES, 'name="rocker-tip" pos="-0.06626563', moved)
    assert account.open_m["C"] == pytest.approx(0.001, rel=1e-3)


@pytest.mark.parametrize(
    ("edits", "off"),
    [
        (rocker('damping="0.5"'), "damping-off"),
        (rocker('limited="true" range="-0.2 0.2"'), "limits-off"),
    ],
)
def test_the_verdict_shows_it_and_the_line_without_it_does_not(
    edits: tuple[str, str], off: str, tmp_path: Path
) -> None:
    account = read(tmp_path, *edits)
    assert off in account.profiles
    assert line(account, "as-written").verdict == "out"
    assert line(account, off).verdict == "within"


def test_a_model_whose_axis_is_rounded_is_within_and_one_whose_axis_is_off_is_refused(
    tmp_path: Path,
) -> None:
    rounded = read(tmp_path, *rocker('axis="0 -1 8.7e-5"'))  # 0.005 deg
    assert line(rounded, "as-written").verdict == "within"
    told = r"joint D of body rocker: its axis is 0\.02\d* deg off that of the driven hinge"
    with pytest.raises(CrankcheckError, match=told):
        read(tmp_path, *rocker('axis="0 -1 3.5e-4"'))


FAR = {
    "a body far from the pin that it gets": (
        ('pos="0.3 0 0"', 'pos="3 0 0"'),
        "m away from all else on body rocker, whose geoms and other joints reach 0.1",
    ),
    "an anchor in the frame of the world": (
        (OFF, 'anchor="1.3'), "loop C: its pin is 1.06 m away from all else on body coupler"
    ),
    "a near anchor in the frame of the world": (
        ('0.08870312"/>\n  </eq', '0.18870312"/>\n  </eq'),
        "in the frame of the world the same numbers lie on both bodies, and the file may give it "
        "in that: it is 0.23373 0 0.088703 in the frame of coupler",
    ),
    "a hinge in the frame of the world": (
        ('<joint name="B"/>', '<joint name="B" pos="1 0 0"/>'),
        "m away from all else on body coupler, whose geoms and other joints reach 0.129 m; its pos",
    ),
    "a pin far off a body that has no geom": (
        (f'<geom name="rocker-bar" fromto="{TIP}"/>', INERTIAL, 'pos="0.3 0 0"', 'pos="3 0 0"'),
        "loop C: its pin is 2.7",
    ),
}  # fmt: skip


@pytest.mark.parametrize("fault", FAR)
def test_a_pin_far_off_its_body_is_named_with_its_cure(fault: str, tmp_path: Path) -> None:
    """Whether the linkage that nobody meant can turn or not."""
    edits, words = FAR[fault]
    try:
        told = "; ".join(texts(read_text(tmp_path, planted(*edits), converge=False, turns=0.2)))
    except CrankcheckError as refused:
        told = str(refused)
    assert words in told
    assert "; give it there" in told or "; connect two sites, one on each body" in told


LAID = (
    *(CLOSED, BY_SITES, 'fromto="0 0 0 -0.06626563 0 0.18870312"', 'fromto="0 0 0 -0.2 0 0"'),
    *('name="rocker-tip" pos="-0.06626563 0 0.18870312"', 'name="rocker-tip" pos="-0.2 0 0"'),
)
"""The rocker is drawn flat: its joint reads -71 deg in one assembly, 34 deg in the other."""
WITHIN = {
    "the nearer is within": ("-2 0", {}, 1, "C +1, nearest to the pose of those within all ranges"),
    "the other is within": (
        "0 2", {}, -1,
        "nearer is C +1, where joint D reads -70.65 deg, outside its range of 0 deg to 114.6 deg",
    ),
    "a whole turn further": ("-6.2 -4.5", {}, -1, "nearer is C +1, where joint D reads -70.65 deg"),
    "the one that is named": ("0 2", {"branch": {"C": -1}}, -1, "C -1, as --branch names it"),
    "named and without": (
        "0 2", {"branch": {"C": 1}}, 1,
        "start: C +1, where joint D reads -70.65 deg, outside its range of 0 deg to 114.6 deg; "
        "C -1 stays within all ranges",
    ),
    "none is within": ("-0.1 0.1", {"branch": {"C": 1}}, 1, "no assembly found is within"),
}  # fmt: skip


@pytest.mark.parametrize("case", WITHIN)
def test_an_assembly_that_breaks_a_range_is_left_out_or_told(case: str, tmp_path: Path) -> None:
    ends, more, sign, words = WITHIN[case]
    text = planted(*LAID, *rocker(f'range="{ends}"'))
    account = read_text(tmp_path, text, converge=False, turns=0.5, **more)
    assert account.scene.branch == {"C": sign}
    told = "; ".join(account.notes)
    assert words in told
    assert ("led past" not in "".join(texts(account))) == ("start: " not in told)


STIFF = 'solref="0.005 0.6" solimp="0.9999 0.9999 0.001 0.5 2"/>'
SOFT = (' tolerance="1e-16"', "", f"<equality {STIFF}", "")
RK4 = ' integrator="RK4"'
PENDULUM = '<body pos="0 3 0"><joint damping="50"/><geom fromto="0 0 0 0.1 0 0"/></body>'


def of(*edits: str) -> JudgedModel:
    return judged(planted(*SOFT, *edits), "A")


def test_the_integrator_stays_where_another_one_diverges() -> None:
    """RK4 can not hold a body beside the linkage that implicitfast damps."""
    fast = (RK4, ' integrator="implicitfast"', ' gravity="0 0 0"', "")
    one = of(*fast, "</worldbody>", PENDULUM + "</worldbody>")
    assert not one.account.recommended.advised.integrator
    assert 'integrator="RK4"' not in one.patch
    assert one.lines[-1].status == "ok"
    assert one.gains(one.lines[-1])[0] > 1.0


@pytest.mark.parametrize(
    ("soft", "off"),
    [
        slowly('solref="100 1" solimp="1e-4 1e-4 1"', False, reason="half a second: no gain"),
        ('solref="0.02 1"', True),
    ],
)
def test_contacts_are_off_only_where_that_gains(soft: str, off: bool) -> None:
    """A ball in the way of the rocker that pushes it, or gives way."""
    ball = (
        '<geom name="ball" type="sphere" size="0.02" pos="0.3 0 0.2" contype="1" conaffinity="1" '
        f'priority="1" {soft}/>'
    )
    hit = ('name="rocker-bar"', 'name="rocker-bar" contype="1" conaffinity="1"')
    one = of("<worldbody>", f"<worldbody>{ball}", *hit)
    assert "contacts" in {each.kind for each in one.account.disturbances}
    assert one.account.recommended.advised.contacts_off == off
    assert ('contact="disable"' in one.patch) == off


def test_where_nothing_helps_nothing_is_recommended() -> None:
    """RK4 is refused beside a flag, and the loops are as stiff as they can be."""
    stiff = CLOSED.replace("/>", f" {STIFF}")
    flags = '<flag fwdinv="enable" invdiscrete="enable"/>'
    option = f' gravity="0 0 0" tolerance="1e-16" iterations="99">{flags}</option>'
    one = of(CLOSED, stiff, RK4, "", ' gravity="0 0 0"/>', option)
    assert not one.account.helps
    assert one.patch == ""
    assert table.verdict_text(one).endswith(table.NO_HELP)
    told = "\n".join(printed(one, 200))
    assert "Recommended" not in told
    assert table.NO_HELP.capitalize() in told
    page = model_page(one, FACTS)
    assert "No settings help" in page
    assert "With them the model" not in page


def test_the_solver_is_newton_with_iterations_enough() -> None:
    again = CLOSED.replace('name="C"', 'name="again"')
    solver = ' gravity="0 0 0" solver="CG" iterations="1"/>'
    one = of(' gravity="0 0 0"/>', solver, CLOSED, CLOSED + again)
    assert one.lines[-1].verdict == "within"
    assert 'solver="Newton" iterations="100"' in one.patch


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


def test_factors_and_shares_of_a_limit_in_words() -> None:
    told = [table.factor_words(factor) for factor in (1.0, 1.2e5, 0.25, math.inf)]
    assert told == ["the same error", "1.2e5 x less error", "4 x more error", "no error at all"]
    told = [table.share_text(share) for share in (0.0, 137.2)]
    assert told == ["0 of its limit", "137 times its limit"]


@slow("0.4 s: a long course")
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
