"""Faults planted in a healthy model: each is named with its joint or body, or refused with it. What
is recommended was seen to gain: contacts off, the integrator, or nothing at all."""

import io
from pathlib import Path

import pytest
from rich.console import Console

from models.errors import CrankcheckError
from reports.own_model.account import ModelAccount
from reports.own_model.judged import JudgedModel
from reports.own_model.table import NO_HELP, show, verdict_text
from reports.page.model_page import model_page
from tests.worlds.own_four_bar import BY_SITES, CLOSED, planted, rocker
from tests.worlds.own_models import FACTS, judged, line, read_text, texts


def read(folder: Path, *edits: str) -> ModelAccount:
    return read_text(folder, planted(*edits), converge=False)


OFF, SOLREF = 'anchor="0.23373437', 'solref="0.005 0.6"'
HOME = '<keyframe><key name="home" qpos="0 0 0"/></keyframe>'
BELT = '<tendon><fixed name="belt" armature="1"><joint joint="D" coef="1"/></fixed></tendon>'
LIFTED = ('<body name="rocker"', '<body name="rocker" gravcomp="-5"')
NAMED = {
    "anchor 1 mm off": ((OFF, 'anchor="0.23473437'), "loop C: its pin is 0.001 m off"),
    "a contact that rubs": (
        ('contype="0" conaffinity="0"', ""), "coupler-bar touches rocker-bar in 100% of the poses"
    ),
    "a spring": (rocker('stiffness="5"'), "joint D: a spring of 5 N m/rad"),
    "damping": (rocker('damping="0.5"'), "joint D: damping of 0.5 N m s/rad"),
    "a heavy rotor": (rocker('armature="1000"'), "joint D: an armature of 1e+03 kg m^2"),
    "dry friction": (rocker('frictionloss="0.5"'), "joint D: dry friction of 0.5 N m"),
    "solref of a twentieth of a second": (
        (SOLREF, 'solref="0.05 1"'), "loop C: solref gives it a time constant of 0.05 s"
    ),
    "solref of a soft spring": (
        (SOLREF, 'solref="-100 -1000"'),
        "loop C: solref gives it a stiffness of 100 1/s^2 and a damping of 1000 1/s; MuJoCo's own "
        "are 2500 and 100",
    ),
    "solref of a soft damper": (
        (SOLREF, 'solref="-1e6 0"'),
        "loop C: solref gives it a stiffness of 1e+06 1/s^2 and a damping of 0 1/s",
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
        # MuJoCo replaces what is half of each kind, and says so of its own accord.
        (SOLREF, 'solref="0.05 -1"'),
    ],
    ids=["plain", "no gravity to lift", "neither kind of solref"],
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
    ("soft", "off"), [('solref="100 1" solimp="1e-4 1e-4 1"', False), ('solref="0.02 1"', True)]
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
    assert verdict_text(one).endswith(NO_HELP)
    stream = io.StringIO()
    show(Console(file=stream, width=200), one, FACTS)
    assert "Recommended" not in stream.getvalue()
    assert NO_HELP.capitalize() in stream.getvalue()
    page = model_page(one, FACTS)
    assert "No settings help" in page
    assert "With them the model" not in page


def test_the_solver_is_newton_with_iterations_enough() -> None:
    again = CLOSED.replace('name="C"', 'name="again"')
    solver = ' gravity="0 0 0" solver="CG" iterations="1"/>'
    one = of(' gravity="0 0 0"/>', solver, CLOSED, CLOSED + again)
    assert one.lines[-1].verdict == "within"
    assert 'solver="Newton" iterations="100"' in one.patch
