"""What MJCF has of its own: classes, includes, frames, copies, inertia from geoms, mocap bodies,
keyframes; each says the same four-bar."""

from __future__ import annotations

import math
import textwrap
from pathlib import Path

import numpy as np
import pytest

from reports.own_model.account import Account, read_here
from reports.own_model.request import ModelRequest
from tests.worlds.own_four_bar import BY_SITES, CLOSED, HEALTHY, ROCKER_JOINT, planted
from tests.worlds.own_models import texts

LENGTHS = {"crank": 0.1, "coupler": 0.25, "rocker": 0.2}
BASE = '<body name="crank">'
BALL = '<geom size="0.1" type="sphere"/>'


def account(folder: Path, text: str, **more: object) -> Account:
    path = folder / "model.xml"
    path.write_text(text, encoding="utf-8")
    asked = {"joint": "A", "speed_rad_s": 10.0, **more}
    return read_here(ModelRequest(path, **asked))  # type: ignore[arg-type]


def assert_four_bar(found: Account) -> None:
    links = found.scene.links
    assert list(links) == list(LENGTHS)
    for name, length in LENGTHS.items():
        points = list(links[name].points.values())
        assert math.dist(*points) == pytest.approx(length, rel=1e-7)
    assert math.dist(*found.scene.ground.values()) == pytest.approx(0.3)


@pytest.mark.parametrize(
    "edits",
    [
        (),
        (CLOSED, BY_SITES),
        # A class of its own for the rocker, whose hinge turns the other way.
        (
            '<joint axis="0 -1 0"/>',
            '<joint axis="0 -1 0"/><default class="back"><joint axis="0 1 0"/></default>',
            '<body name="rocker" ',
            '<body name="rocker" childclass="back" ',
        ),
        # The frame of the coupler is turned, what is on it turned back.
        (
            '<joint name="B"/>',
            '<joint name="B"/><frame euler="0 0.4 0"><frame euler="0 -0.4 0">',
            '<site name="coupler-tip" pos="0.23373437 0 0.08870312"/>',
            '<site name="coupler-tip" pos="0.23373437 0 0.08870312"/></frame></frame>',
        ),
        # A base that does not move, and one that is moved from outside.
        (BASE, f'<body name="base">{BALL}{BASE}', "</worldbody>", "</body></worldbody>"),
        # Angles in degrees, and readings that are not 0.
        ('angle="radian"', 'angle="degree"', ROCKER_JOINT, '<joint name="D" ref="30"/>'),
        # Bodies that move beside it, one of them welded to the world.
        (
            "</worldbody>",
            f'<body pos="1 1 1"><freejoint/>{BALL}</body>'
            f'<body name="held" pos="2 2 2"><freejoint/>{BALL}</body>'
            "</worldbody>",
            "</equality>",
            '<weld body1="held"/></equality>',
        ),
        # A closure that is off, and one that has nothing to do with it.
        (
            "</equality>",
            '<connect active="false" body1="crank" body2="rocker" anchor="0 0 0"/></equality>',
        ),
        # The same pin said twice.
        ("</equality>", CLOSED.replace('name="C"', 'name="C2"') + "</equality>"),
        # A pin of the rocker's own hinge: MuJoCo gives it no row.
        ("</equality>", '<connect body1="rocker" anchor="0 0 0"/></equality>'),
        # A weld without torque is a pin.
        (
            CLOSED,
            '<weld name="C" body1="coupler" body2="rocker" torquescale="0" '
            'anchor="-0.06626563 0 0.18870312"/>',
        ),
    ],
    ids=[
        "plain", "sites", "class", "frame", "base", "degrees", "beside", "inactive", "twice",
        "idle", "weld without torque",
    ],
)  # fmt: skip
def test_it_is_the_same_four_bar(edits: tuple[str, ...], tmp_path: Path) -> None:
    assert_four_bar(account(tmp_path, planted(*edits)))


def test_a_mocap_body_is_ground(tmp_path: Path) -> None:
    free = '<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>' + ROCKER_JOINT
    text = planted(
        BASE,
        f'<body name="stand" mocap="true" pos="0.3 0 0">{BALL}</body>{BASE}',
        ROCKER_JOINT,
        free,
        "</equality>",
        '<connect name="D" body1="stand" body2="rocker" anchor="0 0 0"/></equality>',
    )
    found = account(tmp_path, text)
    assert_four_bar(found)
    assert "mocap bodies count as ground" in texts(found)


def test_masses_and_inertias_come_from_geoms(tmp_path: Path) -> None:
    text = planted('size="0.004"', 'size="0.004" mass="0.5"')
    rocker = account(tmp_path, text).scene.links["rocker"]
    assert rocker.mass_kg == pytest.approx(0.5)
    # Nearly a slender rod: the capsule is 2 mm longer at each end, and as thick.
    assert rocker.inertia_kg_m2 == pytest.approx(0.5 * 0.2**2 / 12, rel=0.06)
    assert math.hypot(*rocker.centre_m) == pytest.approx(0.1)


def test_what_is_fixed_to_a_body_adds_to_its_mass(tmp_path: Path) -> None:
    weight = '<body name="weight" pos="0.1 0 0.3"><geom size="0.05" type="sphere" mass="2"/></body>'
    bare = planted('size="0.004"', 'size="0.004" mass="0.5"')
    alone = account(tmp_path, bare).scene.links["rocker"]
    both = bare.replace('<site name="rocker-tip"', weight + '<site name="rocker-tip"')
    rocker = account(tmp_path, both).scene.links["rocker"]
    assert rocker.mass_kg == pytest.approx(2.5)
    apart = abs(complex(0.1, 0.3) - complex(-0.03313281, 0.09435156))
    sphere = 0.4 * 2.0 * 0.05**2
    assert rocker.inertia_kg_m2 == pytest.approx(
        alone.inertia_kg_m2 + sphere + 0.5 * 2.0 / 2.5 * apart**2
    )
    assert math.dist(rocker.centre_m, alone.centre_m) == pytest.approx(2.0 / 2.5 * apart)


@pytest.mark.parametrize("beside", ["main", "includer"])
def test_includes_are_read_from_the_main_folder_or_that_of_the_includer(
    beside: str, tmp_path: Path
) -> None:
    (tmp_path / "parts").mkdir()
    inner = "<mujoco><equality>" + CLOSED + "</equality></mujoco>"
    where = tmp_path if beside == "main" else tmp_path / "parts"
    (where / "closures.xml").write_text(inner, encoding="utf-8")
    (tmp_path / "parts" / "all.xml").write_text(
        '<mujoco><include file="closures.xml"/></mujoco>', encoding="utf-8"
    )
    text = HEALTHY[: HEALTHY.index("  <equality>\n")] + '<include file="parts/all.xml"/></mujoco>'
    found = account(tmp_path, text)
    assert_four_bar(found)
    assert found.patch.startswith("0 of its 1 equalities stand in the file itself: set in each")


def test_an_attached_model_is_read(tmp_path: Path) -> None:
    (tmp_path / "part.xml").write_text(HEALTHY, encoding="utf-8")
    text = textwrap.dedent("""\
        <mujoco>
          <option gravity="0 0 0"/>
          <asset><model name="part" file="part.xml"/></asset>
          <worldbody>
            <frame pos="1 2 3" euler="10 20 30"><attach model="part" prefix="mine/"/></frame>
          </worldbody>
        </mujoco>
    """)
    found = account(tmp_path, text, joint="mine/A")
    assert [name.removeprefix("mine-") for name in found.scene.links] == list(LENGTHS)
    for name, length in LENGTHS.items():
        points = list(found.scene.links[f"mine-{name}"].points.values())
        assert math.dist(*points) == pytest.approx(length, rel=1e-7)


def test_copies_of_a_body_are_told_apart(tmp_path: Path) -> None:
    beside = '<replicate count="3" offset="0 1 0"><body pos="5 5 5"><joint name="x"/>' + (
        '<geom fromto="0 0 0 0 0 0.1"/></body></replicate></worldbody>'
    )
    found = account(tmp_path, planted("</worldbody>", beside))
    assert_four_bar(found)
    assert any("bodies beside the linkage" in text for text in texts(found))


def starts(found: Account) -> float:
    """What the driven joint reads at the start [rad]."""
    return float(found.scene.driver.law.at(np.zeros(1))[0][0])


KEYS = (
    "</equality>",
    '</equality><keyframe><key name="home" qpos="0 0 0"/>'
    '<key name="open" qpos="0.5 0.1 0"/><key name="turned" qpos="6.5 0 0"/></keyframe>',
)


def test_a_run_starts_from_a_keyframe(tmp_path: Path) -> None:
    found = account(tmp_path, planted(*KEYS), key="open")
    assert starts(found) == pytest.approx(0.5)
    assert max(found.open_m.values()) > 0.01
    assert any(text.startswith("keyframe open: loop C is open by") for text in texts(found))
    assert not any(text.startswith("keyframe home") for text in texts(found))


def test_a_keyframe_may_read_whole_turns(tmp_path: Path) -> None:
    found = account(tmp_path, planted(*KEYS), key="turned")
    assert starts(found) == pytest.approx(6.5)


def test_the_driver_is_told_in_the_coordinate_of_its_joint(tmp_path: Path) -> None:
    text = planted('<joint name="A"/>', '<joint name="A" ref="0.3"/>')
    assert starts(account(tmp_path, text)) == pytest.approx(0.3)
    turned = account(tmp_path, text, start_deg=40.0)
    assert starts(turned) == pytest.approx(math.radians(40.0))
