"""What MJCF has of its own: classes, includes, frames, copies, inertia from geoms, mocap bodies,
keyframes; each says the same four-bar."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from models.errors import CrankcheckError
from models.scene import Scene
from reports.own_model.account import Account
from tests.worlds.own_four_bar import BY_SITES, CLOSED, HEALTHY, ROCKER_JOINT, planted, tied
from tests.worlds.own_models import line, read_text, texts

LENGTHS = {"crank": 0.1, "coupler": 0.25, "rocker": 0.2}
BASE = '<body name="crank">'
SLIDING = '<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>'
BALL = '<geom size="0.1" type="sphere"/>'


def assert_four_bar(scene: Scene, prefix: str = "") -> None:
    bars = {name.removeprefix(prefix): link.points.values() for name, link in scene.links.items()}
    lengths = {name: math.dist(*points) for name, points in bars.items()}
    assert list(lengths) == list(LENGTHS)
    assert lengths == pytest.approx(LENGTHS, rel=1e-7)
    assert math.dist(*scene.ground.values()) == pytest.approx(0.3)


TIP = '<site name="coupler-tip" pos="0.23373437 0 0.08870312"/>'
LOOSE = f'<body pos="1 1 1"><freejoint/>{BALL}</body>'
HELD = f'<body name="held" pos="2 2 2"><freejoint/>{BALL}</body>'
AT_C = 'torquescale="0" anchor="-0.06626563 0 0.18870312"'
SAME: dict[str, tuple[str, ...]] = {
    "plain": (),
    "sites": (CLOSED, BY_SITES),
    "a class of its own for the rocker, whose hinge turns the other way": (
        '<joint axis="0 -1 0"/>',
        '<joint axis="0 -1 0"/><default class="back"><joint axis="0 1 0"/></default>',
        '<body name="rocker" ', '<body name="rocker" childclass="back" ',
    ),
    "the frame of the coupler is turned, what is on it turned back": (
        '<joint name="B"/>',
        '<joint name="B"/><frame euler="0 0.4 0"><frame euler="0 -0.4 0">',
        TIP, f"{TIP}</frame></frame>",
    ),
    "a base that does not move": (
        BASE, f'<body name="base">{BALL}{BASE}', "</worldbody>", "</body></worldbody>",
    ),
    "degrees, and readings that are not 0": (
        'angle="radian"', 'angle="degree"', ROCKER_JOINT, '<joint name="D" ref="30"/>',
    ),
    "bodies that move beside it, one of them welded to the world": (
        "</worldbody>", f"{LOOSE}{HELD}</worldbody>", *tied('<weld body1="held"/>'),
    ),
    "a closure that is off": tied(
        '<connect active="false" body1="crank" body2="rocker" anchor="0 0 0"/>'
    ),
    "the same pin said twice": tied(CLOSED.replace('name="C"', 'name="C2"')),
    "a pin of the rocker's own hinge, for which there is no row": tied(
        '<connect body1="rocker" anchor="0 0 0"/>'
    ),
    "a weld without torque": (CLOSED, f'<weld name="C" body1="coupler" body2="rocker" {AT_C}/>'),
}  # fmt: skip


@pytest.mark.parametrize("case", SAME)
def test_it_is_the_same_four_bar(case: str, tmp_path: Path) -> None:
    assert_four_bar(read_text(tmp_path, planted(*SAME[case])).scene)


STAND = f'<body name="stand" mocap="true" pos="0.3 0 0">{BALL}</body>{BASE}'
ON_STAND = '<connect name="D" body1="stand" body2="rocker" anchor="0 0 0"/>'
MOCAP = (BASE, STAND, ROCKER_JOINT, SLIDING + ROCKER_JOINT, *tied(ON_STAND))


def test_a_mocap_body_is_ground(tmp_path: Path) -> None:
    found = read_text(tmp_path, planted(*MOCAP))
    assert_four_bar(found.scene)
    assert "mocap bodies count as ground" in texts(found)


@pytest.mark.parametrize(("place", "pivot_m"), [("", 0.3), ('mpos="0.35 0 0"', 0.35)])
def test_a_mocap_body_is_where_a_key_has_it(place: str, pivot_m: float, tmp_path: Path) -> None:
    key = f'<keyframe><key name="moved" qpos="0 0 0 0 0" {place} mquat="2 0 0 0"/></keyframe>'
    text = planted(*MOCAP, "</mujoco>", f"{key}</mujoco>")
    found = read_text(tmp_path, text, key="moved", turns=0.2, converge=False)
    assert math.dist(*found.scene.ground.values()) == pytest.approx(pivot_m)
    assert line(found, "recommended").verdict == "within"


def test_a_keyframe_that_puts_a_mocap_body_nowhere_is_refused(tmp_path: Path) -> None:
    key = '<keyframe><key name="off" qpos="0 0 0" mpos="nan 0 0"/></keyframe>'
    with pytest.raises(CrankcheckError, match="keyframe off: its mpos is not finite"):
        read_text(tmp_path, planted(BASE, STAND, "</mujoco>", f"{key}</mujoco>"), key="off")


def test_masses_and_inertias_come_from_geoms_and_what_is_fixed_to_a_body(tmp_path: Path) -> None:
    bare = planted('size="0.004"', 'size="0.004" mass="0.5"')
    alone = read_text(tmp_path, bare).scene.links["rocker"]
    assert alone.mass_kg == pytest.approx(0.5)
    # Nearly a slender rod: the capsule is 2 mm longer at each end, and as thick.
    assert alone.inertia_kg_m2 == pytest.approx(0.5 * 0.2**2 / 12, rel=0.06)
    assert math.hypot(*alone.centre_m) == pytest.approx(0.1)
    weight = '<body name="weight" pos="0.1 0 0.3"><geom size="0.05" type="sphere" mass="2"/></body>'
    both = bare.replace('<site name="rocker-tip"', weight + '<site name="rocker-tip"')
    rocker = read_text(tmp_path, both).scene.links["rocker"]
    assert rocker.mass_kg == pytest.approx(2.5)
    apart = abs(complex(0.1, 0.3) - complex(-0.03313281, 0.09435156))
    added = 0.4 * 2.0 * 0.05**2 + 0.5 * 2.0 / 2.5 * apart**2
    assert rocker.inertia_kg_m2 == pytest.approx(alone.inertia_kg_m2 + added)
    assert math.dist(rocker.centre_m, alone.centre_m) == pytest.approx(2.0 / 2.5 * apart)


@pytest.mark.parametrize("beside", ["main", "includer"])
def test_includes_are_read_from_the_main_or_the_including_folder(
    beside: str, tmp_path: Path
) -> None:
    parts = tmp_path / "parts"
    parts.mkdir()
    inner = f"<mujoco><equality>{CLOSED}</equality></mujoco>"
    where = tmp_path if beside == "main" else parts
    (where / "closures.xml").write_text(inner, encoding="utf-8")
    (parts / "all.xml").write_text('<mujoco><include file="closures.xml"/></mujoco>')
    text = HEALTHY[: HEALTHY.index("  <equality>\n")] + '<include file="parts/all.xml"/></mujoco>'
    found = read_text(tmp_path, text)
    assert_four_bar(found.scene)
    said = "0 of its 1 equalities stand in the file itself: set in each"
    assert found.recommended.patch.startswith(said)


def test_an_attached_model_is_read(tmp_path: Path) -> None:
    (tmp_path / "part.xml").write_text(HEALTHY, encoding="utf-8")
    text = """<mujoco>
      <option gravity="0 0 0"/>
      <asset><model name="part" file="part.xml"/></asset>
      <worldbody>
        <frame pos="1 2 3" euler="10 20 30"><attach model="part" prefix="mine/"/></frame>
      </worldbody>
    </mujoco>"""
    assert_four_bar(read_text(tmp_path, text, joint="mine/A").scene, "mine-")


def test_copies_of_a_body_are_told_apart(tmp_path: Path) -> None:
    body = '<body pos="5 5 5"><joint name="x"/><geom fromto="0 0 0 0 0 0.1"/></body>'
    beside = f'<replicate count="3" offset="0 1 0">{body}</replicate></worldbody>'
    found = read_text(tmp_path, planted("</worldbody>", beside))
    assert_four_bar(found.scene)
    assert any("bodies beside the linkage" in text for text in texts(found))


def starts(found: Account) -> float:
    """What the driven joint reads at the start [rad]."""
    return float(found.scene.driver.law.at(np.zeros(1))[0][0])


KEYS = planted(
    "</equality>",
    '</equality><keyframe><key name="home" qpos="0 0 0"/>'
    '<key name="open" qpos="0.5 0.1 0"/><key name="turned" qpos="6.5 0 0"/></keyframe>',
)


def test_a_run_starts_from_a_keyframe_which_may_read_whole_turns(tmp_path: Path) -> None:
    found = read_text(tmp_path, KEYS, key="open")
    assert starts(found) == pytest.approx(0.5)
    assert max(found.open_m.values()) > 0.01
    assert any(text.startswith("keyframe open: loop C is open by") for text in texts(found))
    assert not any(text.startswith("keyframe home") for text in texts(found))
    assert starts(read_text(tmp_path, KEYS, key="turned")) == pytest.approx(6.5)


def test_the_driver_is_told_in_the_coordinate_of_its_joint(tmp_path: Path) -> None:
    text = planted('<joint name="A"/>', '<joint name="A" ref="0.3"/>')
    assert starts(read_text(tmp_path, text)) == pytest.approx(0.3)
    turned = read_text(tmp_path, text, start_deg=40.0)
    assert starts(turned) == pytest.approx(math.radians(40.0))
