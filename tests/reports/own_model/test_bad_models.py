"""Models that can not be read or held to a closed form: one message, with place, fault and cure."""

import os
import re
from dataclasses import replace
from pathlib import Path

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np
import pytest

from analytic.kinematics import solve
from models.errors import CrankcheckError
from models.files.reading import load_scene
from models.mjcf.document import build
from reports.own_model.account import read, read_here
from reports.own_model.assembly import ModelRequest
from reports.own_model.judged import run_lines
from reports.workers.isolated import Limits
from tests.worlds.own_four_bar import CLOSED, HEALTHY, ROCKER_JOINT, planted, rocker, tied
from tests.worlds.own_models import line, read_text
from tests.worlds.tiers import slow

PLATES = """<mujoco>
  <option gravity="0 0 0"/>
  <default><geom type="capsule" size="0.01" contype="0" conaffinity="0"/></default>
  <worldbody>
    <body name="crank"><joint name="A"/><geom fromto="0 0 0 0 0.1 0"/>
      <body name="bar" pos="0 0.1 0"><joint name="B"/><geom fromto="0 0 0 0.4 0 0"/></body>
    </body>
    <body name="rocker" pos="0.4 0 0"><joint name="D"/><geom fromto="0 0 0 0 0.1 0"/></body>
    <!-- more -->
  </worldbody>
  <equality><connect name="C" body1="bar" body2="rocker" anchor="0.4 0 0"/><!-- ties --></equality>
</mujoco>
"""
"""A parallelogram."""
THIRD = (
    '<body name="third" pos="0.2 {off} 0"><joint name="F"/><geom fromto="0 0 0 0 0.1 0"/></body>'
)
TIED = '<connect name="G" body1="bar" body2="third" anchor="0.2 0 0"/>'


def included(file: str) -> str:
    return planted("<worldbody>", f'<include file="{file}"/><worldbody>')


DEEP = "<mujoco><worldbody>" + "<body>" * 5000 + "</body>" * 5000 + "</worldbody></mujoco>"
BOMB = '<!DOCTYPE m [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;">]><mujoco model="&b;"/>'
BESIDE = '<body name="far"><freejoint/><geom size="1" type="sphere"/></body></worldbody>'
FAR = '<connect body1="far" anchor="0 0 0"/>'
BELT = '<tendon><fixed name="t"><joint joint="D" coef="1"/></fixed></tendon>'
TILTING = '<weld body1="coupler" body2="rocker" relpose="0 0 0 0.9 0.1 0 0"/>'
AGAIN = '<connect body1="coupler" body2="rocker" anchor="0.1 0 0"/>'
OFF = ('tolerance="1e-16"/>', 'tolerance="1e-16"><flag equality="disable"/></option>')
MESH = '<asset><mesh file="no.stl"/></asset><worldbody>'
WHEEL = '<body name="wheel"><joint name="spin"/><geom size="0.02 0.01" type="cylinder"/></body>'
TWICE = '<joint joint1="spin" joint2="A"/><joint name="E2" joint1="spin" joint2="D"/>'
SLIDE = '<joint name="sled" type="slide" axis="1 0 0"/>'
SLED = f'<worldbody><body name="sled">{SLIDE}<geom fromto="0 0 0 1 0 0"/>'
LOOSE = PLATES.replace("<!-- more -->", THIRD.format(off=0.001)).replace("<!-- ties -->", TIED)
REFUSED: dict[str, tuple[str | bytes, str]] = {
    "empty": ("", "no XML: no element found"),
    "urdf": ('<robot name="x"/>', "its root is <robot>, that of MJCF is <mujoco>"),
    "deep": (DEEP, "more than 300 elements within each other"),
    "bomb": (BOMB, "it declares entities"),
    "controls": (HEALTHY.replace("rocker", "ro&#27;ck"), "no XML: reference to invalid character"),
    "no mesh": (
        planted("<worldbody>", MESH), "MuJoCo refuses the model: Error: Error opening file 'no.stl'"
    ),
    "nan": (planted('pos="0 0 0.1"', 'pos="0 0 nan"'), "body_pos of coupler is not finite"),
    "nan in an anchor": (
        planted('or="0.23373437', 'or="nan'), "<connect> C: its anchor or pose is not finite"
    ),
    "no mass": (planted('"rocker-bar"', '"rocker-bar" mass="0"'), "mass and inertia of moving"),
    "outside": (
        included("../x.xml"),
        "<include file='../x.xml'> is outside the folder of the model; copy it into",
    ),
    "itself": (included("model.xml"), "more than 20 files that include one another"),
    "not there": (included("x.xml"), "x.xml: not there"),
    "loop that is off": (
        planted('<connect name', '<connect active="false" name'), "no loop: no equality is active"
    ),
    "loops switched off": (planted(*OFF), 'no loop: <flag equality="disable"/>'),
    "loop elsewhere": (
        planted("</worldbody>", BESIDE, CLOSED, FAR),
        "no equality ties a body that moves with the driven joint",
    ),
    "free": (planted(ROCKER_JOINT, '<freejoint name="D"/>'), "joint D of body rocker: a free"),
    "slide across": (
        planted(*rocker('type="slide" axis="0 1 0"')), "it slides 90 deg off the plane"
    ),
    "two hinges": (
        planted(ROCKER_JOINT, f'{ROCKER_JOINT}<joint name="D2" pos="0 0 0.05"/>'),
        "body rocker: its joints are hinge hinge",
    ),
    "held": (
        planted(*tied('<weld body1="crank"/>')),
        "joint A can not turn: a weld ties its body to the ground",
    ),
    "tilting weld": (planted(*tied(TILTING)), "deg out of the plane"),
    "tendon": (
        planted("<equality>", f'{BELT}<equality><tendon tendon1="t"/>'),
        "a <tendon> equality couples coordinates",
    ),
    "an equality within the loop": (
        planted(*tied('<joint name="E" joint1="D" joint2="B"/>')),
        "E: a <joint> equality couples coordinates of rocker (hinge D), coupler (hinge B) in the "
        "loop, of which no closed form is known; remove it",
    ),
    "a joint of the loop that an equality holds": (
        planted(*tied('<joint name="E" joint1="D"/>')), "couples coordinates of rocker (hinge D) in"
    ),
    "a body that follows twice": (
        planted("</worldbody>", f"{WHEEL}</worldbody>", *tied(TWICE)),
        "E2: a <joint> equality couples coordinates of wheel (hinge spin) twice with the loop",
    ),
    "a base that its loop moves": (
        planted("<worldbody>", SLED, '<body name="rocker" pos="0.3 0 0"',
                '</body><body name="rocker" pos="0.3 0 0"', "</worldbody>", "</worldbody>"),
        "it turns against body sled, and not against the ground, which its loop meets too; fix "
        "that body: remove slide sled; drivable: D",
    ),
    "a hinge far round": (
        planted(*rocker('ref="1e12"')),
        "model.xml: joint D reads 1.59e+11 turns in this pose; take whole turns off it",
    ),
    "no step": (planted('timestep="0.001"', 'timestep="0"'), "its timestep is 0 s; give it one"),
    "a third link that does not fit": (LOOSE, "redundant link third fits in place only"),
    "held twice": (planted(*tied(AGAIN)), "= -1; one driver needs mobility 1"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_it_is_refused_in_one_message(name: str, tmp_path: Path) -> None:
    text, words = REFUSED[name]
    with pytest.raises(CrankcheckError) as refused:
        read_text(tmp_path, text)
    assert words in str(refused.value)
    assert ".xml" in str(refused.value)
    assert [each.name for each in tmp_path.iterdir()] == ["model.xml"]


def test_what_is_no_plain_file_is_not_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with (tmp_path / "large.xml").open("wb") as file:
        file.truncate(100_000_000)
    compiled = tmp_path / "model.mjb"
    mujoco.mj_saveModel(mujoco.MjModel.from_xml_string(HEALTHY), str(compiled), None)
    for name, words in {
        "": "a folder",
        "nothing.xml": "not there",
        "pipe": "a pipe",
        "large.xml": "100000000 bytes; at most 20000000",
        "model.mjb": "no XML: not well-formed",
    }.items():
        with pytest.raises(CrankcheckError, match="give an MJCF file") as refused:
            read_here(ModelRequest(tmp_path / name, "A", 10.0))
        assert words in str(refused.value)


def test_a_link_to_a_file_elsewhere_is_not_included(tmp_path: Path) -> None:
    mine, other = tmp_path / "mine", tmp_path / "other"
    mine.mkdir()
    other.mkdir()
    (other / "x.xml").write_text("<mujoco/>", encoding="utf-8")
    (mine / "x.xml").symlink_to(other / "x.xml")
    with pytest.raises(CrankcheckError, match="outside the folder of the model"):
        read_text(mine, included("x.xml"))


ASKED = {
    "not against the ground": (
        {"joint": "B"},
        "body crank, and not against the ground; drivable: A, D",
    ),
    "no such choice": ({"branch": {"X": 1}}, "--branch X: it separates no assemblies"),
    "far round": ({"start_deg": 36001.0}, "--start 36001: that is more than 100 turns"),
    "too coarse": ({"dt_s": 0.5}, "a turn needs at least 8"),
    "too short": ({"turns": 0.1}, "take 0.127 turns or more"),
}


@pytest.mark.parametrize("case", ASKED)
def test_what_is_asked_for_is_checked(case: str, tmp_path: Path) -> None:
    more, words = ASKED[case]
    with pytest.raises(CrankcheckError, match=re.escape(words)):
        read_text(tmp_path, HEALTHY, **more)


NAMES = {
    "none": (' name="B"', "", ' name="D"', "", ' name="C"', ""),
    "of other things": ('name="B"', 'name="crank"', 'name="D"', 'name="ground"'),
    "alike": ('name="B"', 'name="p 1"', 'name="D"', 'name="p_1"', 'name="C"', 'name="p-1"'),
    "long": ('name="B"', f'name="{"b" * 5000}"'),
    "letters": ('name="B"', 'name="\u202eB\u00df"'),
}


@pytest.mark.parametrize("case", NAMES)
def test_any_names_make_a_scene(case: str, tmp_path: Path) -> None:
    scene = read_text(tmp_path, planted(*NAMES[case])).scene
    assert len({point for link in scene.links.values() for point in link.points}) == 4
    assert all(len(name) <= 40 and name.isascii() for name in scene.pins)


def test_a_parallelogram_passes_its_change_points(tmp_path: Path) -> None:
    text = PLATES.replace("<!-- more -->", THIRD.format(off=0)).replace("<!-- ties -->", TIED)
    account = read_text(tmp_path, text, converge=False)
    assert "continued smoothly through the change points of C" in account.notes[-1]
    assert line(account, "recommended").verdict == "within"


def test_it_runs_from_many_turns_away_and_backwards_from_whole_turns(tmp_path: Path) -> None:
    account = read_text(tmp_path, HEALTHY, converge=False, start_deg=-36000.0, turns=0.3)
    assert line(account, "recommended").verdict == "within"
    turned = '</equality><keyframe><key name="turned" qpos="6.5 0 6.3"/></keyframe>'
    asked = {"converge": False, "key": "turned", "speed_rad_s": -10.0}
    account = read_text(tmp_path, planted("</equality>", turned), **asked)
    assert line(account, "as-written").verdict == "within"


def test_a_reading_that_takes_too_long_or_too_much_ends(tmp_path: Path) -> None:
    """In a process of its own (0.4 s each): its limit is named."""
    beside = '<body pos="0 0 9"><freejoint/><geom size="0.1" type="sphere"/></body>'
    path = tmp_path / "model.xml"
    path.write_text(planted("</worldbody>", beside * 1000 + "</worldbody>"), encoding="utf-8")
    with pytest.raises(CrankcheckError, match=r"reading it crashed: .* and --memory-gb 1"):
        read(ModelRequest(path, "A", 10.0), Limits(600.0, 1.0))
    with pytest.raises(CrankcheckError, match=r"reading it did not finish: .* --limit-s 0\.0001 s"):
        read(ModelRequest(path, "A", 10.0), Limits(1e-4, 8.0))


@slow("a process; readings that end so are above, rows with such a reason in sweeps")
def test_a_line_that_hangs_is_a_row_with_its_reason(tmp_path: Path) -> None:
    """In a process of its own (0.4 s), which is ended."""
    account = replace(read_text(tmp_path, HEALTHY, converge=False), profiles=["as-written"])
    (one,) = run_lines(account, Limits(1e-4, 2.0)).lines
    assert (one.verdict, one.status, one.reason) == ("out", "timeout", "no end within 0.0001 s")


def test_a_run_to_a_singular_position_is_refused_with_what_sets_the_range(tmp_path: Path) -> None:
    scene = load_scene("tangent")
    state = solve(scene, np.zeros(1), bound=False).state()
    told = "at driver 90 deg the dyad of .*--start and --turns set the range of joint lever.A"
    with pytest.raises(CrankcheckError, match=told):
        read_text(tmp_path, build(scene, state), joint="lever.A")
