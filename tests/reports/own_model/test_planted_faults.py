"""Faults planted in a healthy model: each is named with its joint or body, or refused with it."""

from __future__ import annotations

from pathlib import Path

import pytest

from models.errors import CrankcheckError
from reports.own_model.account import Account, Line, checked_line, read_here
from reports.own_model.request import ModelRequest
from tests.worlds.own_four_bar import BY_SITES, CLOSED, ROCKER_JOINT, planted
from tests.worlds.own_models import texts


def read(folder: Path, *edits: str) -> Account:
    path = folder / "model.xml"
    path.write_text(planted(*edits), encoding="utf-8")
    return read_here(ModelRequest(path, "A", 10.0, converge=False))


def rocker(attributes: str) -> tuple[str, str]:
    return ROCKER_JOINT, f'<joint name="D" {attributes}/>'


OFF = 'anchor="0.23373437'
NAMED = {
    "anchor 1 mm off": ((OFF, 'anchor="0.23473437'), "loop C: its pin is 0.001 m off"),
    "hinge 1 mm off": (rocker('pos="0 0 0.001"'), "joint D: its pin is 0.001 m off an end of geom"),
    "a contact that rubs": (
        ('contype="0" conaffinity="0"', ""),
        "coupler-bar touches rocker-bar in 100% of the poses",
    ),
    "a spring": (rocker('stiffness="5"'), "joint D: a spring of 5 N m/rad"),
    "damping": (rocker('damping="0.5"'), "joint D: damping of 0.5 N m s/rad"),
    "a heavy rotor": (rocker('armature="1000"'), "joint D: an armature of 1e+03 kg m^2"),
    "dry friction": (rocker('frictionloss="0.5"'), "joint D: dry friction of 0.5 N m"),
    "solref of a twentieth of a second": (
        ('solref="0.005 0.6"', 'solref="0.05 1"'),
        "loop C: solref gives it a time constant of 0.05 s",
    ),
    "a limit that is hit": (
        rocker('limited="true" range="-0.2 0.2"'),
        "joint D is led past its limit by 32.8 deg",
    ),
    "a limit of the driven joint": (
        ('<joint name="A"/>', '<joint name="A" limited="true" range="-3.1416 3.1416"/>'),
        "joint A is led past its limit by 18",
    ),
    "gravity across the plane": (
        ('gravity="0 0 0"', 'gravity="0 -9.81 0"'),
        "gravity of 9.81 m/s^2 across the plane",
    ),
    "a ref that opens a keyframe": (
        ('<joint name="B"/>', '<joint name="B" ref="0.5"/>', "</equality>",
         '</equality><keyframe><key name="home" qpos="0 0 0"/></keyframe>'),
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


def test_a_healthy_model_has_none(tmp_path: Path) -> None:
    account = read(tmp_path)
    assert not account.disturbances
    assert checked_line(Line(account, "as-written")).verdict == "within"
    assert account.profiles == ["as-written", "contacts-off", "recommended"]


REFUSED = {
    "axis 1 degree off the plane": (
        rocker('axis="0 -0.99985 0.01745"'),
        "joint D of body rocker: its axis is 1 deg off that of the driven hinge",
    ),
    "weld where a pin is meant": (
        (CLOSED, '<weld name="C" body1="coupler" body2="rocker"/>'),
        "a weld makes two bodies one: coupler and rocker; use <connect> for a pin",
    ),
}


@pytest.mark.parametrize("fault", REFUSED)
def test_it_is_refused_with_its_joint(fault: str, tmp_path: Path) -> None:
    edits, words = REFUSED[fault]
    with pytest.raises(CrankcheckError) as refused:
        read(tmp_path, *edits)
    assert words in str(refused.value)


def test_sites_that_do_not_meet_are_told_by_the_pose(tmp_path: Path) -> None:
    moved = 'name="rocker-tip" pos="-0.06726563'
    account = read(tmp_path, CLOSED, BY_SITES, 'name="rocker-tip" pos="-0.06626563', moved)
    assert account.open_m["C"] == pytest.approx(0.001, rel=1e-3)


@pytest.mark.parametrize(
    ("edits", "off"),
    [
        (rocker('damping="0.5"'), "damping-off"),
        (rocker('limited="true" range="-0.2 0.2"'), "limits-off"),
        (rocker('stiffness="200"'), "springs-off"),
    ],
)
def test_the_verdict_shows_it_and_the_line_without_it_does_not(
    edits: tuple[str, str], off: str, tmp_path: Path
) -> None:
    account = read(tmp_path, *edits)
    assert off in account.profiles
    written = checked_line(Line(account, "as-written"))
    assert written.verdict == "out"
    assert checked_line(Line(account, off)).verdict == "within"


def test_an_axis_within_rounding_is_taken(tmp_path: Path) -> None:
    read(tmp_path, *rocker('axis="0 -1 8.7e-5"'))  # 0.005 deg
    with pytest.raises(CrankcheckError, match=r"its axis is 0\.02\d* deg off"):
        read(tmp_path, *rocker('axis="0 -1 3.5e-4"'))
