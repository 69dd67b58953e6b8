"""What MJCF has of its own: classes, includes, frames, copies, inertia from geoms, mocap bodies,
keyframes; each says the same four-bar. And models that people published: what is said of each, run
or refused, with bounds that a prototype measured, within a factor of two."""

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from models.errors import CrankcheckError
from models.scene import Scene
from reports.judge.halving import worst_place
from reports.own_model import assembly
from reports.own_model.account import ModelAccount, read_here
from reports.own_model.assembly import ModelRequest
from tests.worlds.own_four_bar import BY_SITES, CLOSED, HEALTHY, ROCKER_JOINT, planted, tied
from tests.worlds.own_models import line, read_text, texts
from tests.worlds.tiers import few

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


LOOSE = f'<body pos="1 1 1"><freejoint/>{BALL}</body>'
HELD = f'<body name="held" pos="2 2 2"><freejoint/>{BALL}</body>'
AT_C = 'torquescale="0" anchor="-0.06626563 0 0.18870312"'
STAND = f'<body name="stand" mocap="true" pos="0.3 0 0">{BALL}</body>{BASE}'
ON_STAND = '<connect name="D" body1="stand" body2="rocker" anchor="0 0 0"/>'
MOCAP = (BASE, STAND, ROCKER_JOINT, SLIDING + ROCKER_JOINT, *tied(ON_STAND))
BODY = '<body pos="5 5 5"><joint name="x"/><geom fromto="0 0 0 0 0 0.1"/></body>'
COPIES = f'<replicate count="3" offset="0 1 0">{BODY}</replicate></worldbody>'
SAME: dict[str, tuple[str, ...]] = {
    "plain": (),
    "sites": (CLOSED, BY_SITES),
    "a class of its own for the rocker, whose hinge turns the other way": (
        '<joint axis="0 -1 0"/>',
        '<joint axis="0 -1 0"/><default class="back"><joint axis="0 1 0"/></default>',
        '<body name="rocker" ', '<body name="rocker" childclass="back" ',
    ),
    "degrees, and readings that are not 0": (
        'angle="radian"', 'angle="degree"', ROCKER_JOINT, '<joint name="D" ref="30"/>',
    ),
    "bodies that move beside it, one of them welded to the world": (
        "</worldbody>", f"{LOOSE}{HELD}</worldbody>", *tied('<weld body1="held"/>'),
    ),
    "the same pin said twice": tied(CLOSED.replace('name="C"', 'name="C2"')),
    "a pin of the rocker's own hinge": tied('<connect body1="rocker" anchor="0 0 0"/>'),
    "mocap bodies count as ground": MOCAP,
    "bodies beside the linkage: body4, body5, body6": ("</worldbody>", COPIES),
    "a weld without torque": (CLOSED, f'<weld name="C" body1="coupler" body2="rocker" {AT_C}/>'),
}  # fmt: skip


@pytest.mark.parametrize("case", SAME)
def test_it_is_the_same_four_bar_with_what_is_told_of_it(case: str, tmp_path: Path) -> None:
    found = read_text(tmp_path, planted(*SAME[case]))
    assert_four_bar(found.scene)
    is_told = case.startswith(("mocap bodies", "bodies beside"))
    assert not is_told or case in texts(found)


@pytest.mark.parametrize(("place", "pivot_m"), [("", 0.3), ('mpos="0.35 0 0"', 0.35)])
def test_a_mocap_body_is_where_a_key_has_it(place: str, pivot_m: float, tmp_path: Path) -> None:
    key = f'<keyframe><key name="moved" qpos="0 0 0 0 0" {place} mquat="2 0 0 0"/></keyframe>'
    text = planted(*MOCAP, "</mujoco>", f"{key}</mujoco>")
    found = read_text(tmp_path, text, key="moved", turns=0.2, converge=False)
    assert math.dist(*found.scene.ground.values()) == pytest.approx(pivot_m)
    assert line(found, "recommended").verdict == "within"
    if place:
        nowhere = text.replace(place, 'mpos="nan 0 0"')
        with pytest.raises(CrankcheckError, match="keyframe moved: its mpos is not finite"):
            read_text(tmp_path, nowhere, key="moved")


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
    apart = abs(complex(0.1, 0.3) - complex(-0.03313281, 0.09435156))
    added = 0.4 * 2.0 * 0.05**2 + 0.5 * 2.0 / 2.5 * apart**2
    assert rocker.inertia_kg_m2 == pytest.approx(alone.inertia_kg_m2 + added)
    assert math.dist(rocker.centre_m, alone.centre_m) == pytest.approx(2.0 / 2.5 * apart)


@pytest.mark.parametrize("beside", ["main", "includer"])
def test_includes_are_read_from_the_main_or_including_folder(beside: str, tmp_path: Path) -> None:
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


def starts(found: ModelAccount) -> float:
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


HULL = '<geom type="sphere" size="0.05"/>'


def on(joints: str, inner: str = "") -> tuple[str, ...]:
    """Edits that set the four-bar on a body with joints, or on one that this carries."""
    base = f'<worldbody><body name="base" pos="0 0 1">{joints}{HULL}{inner}'
    ends = "</body>" * (1 + inner.count("<body"))
    return "<worldbody>", base, "</worldbody>", f"{ends}</worldbody>"


def foot(joint: str) -> tuple[str, str]:
    body = (
        f'<body name="foot" pos="0.2 0 0.1">{joint}<geom type="box" size="0.02 0.02 0.1"/></body>'
    )
    return '<site name="coupler-tip"', body + '<site name="coupler-tip"'


COUPLER = '<body name="coupler" pos="0 0 0.1">\n        <joint name="B"/>'
ROD = '</body><body name="coupler" pos="0 0 0.1"><freejoint name="B"/>'
ENDS = '</body>\n    </body>\n    <body name="rocker"'
FREE_ROD = (
    *(COUPLER, ROD, ENDS, '</body>\n    <body name="rocker"'),
    *("<equality>", '<equality><connect name="B" body1="crank" body2="coupler" anchor="0 0 0.1"/>'),
)
SLIDE = '<joint name="go" type="slide" axis="1 0 0"/>'
WAIST = f'<body name="hull"><joint name="waist" type="ball"/>{HULL}'
FLOATING = f'<body name="foot" pos="0.2 0 0.2"><freejoint name="toe"/>{HULL}</body></worldbody>'
SPIN = '<body name="wheel"><joint name="spin"/><geom type="cylinder" size="0.05 0.01"/></body>'
GEARS = '<joint name="gears" joint1="{}" joint2="{}" polycoef="0 -2 0.1 0 0"/>'
AT = 'qpos="1 2 3 0.8 0.3 0.4 0.33166248 0 0 0" qvel="1 1 1 1 1 1 1 1 1"'
PLACED = f'<keyframe><key name="home" {AT}/></keyframe>'
CARRIED = {
    "on a slide": (on(SLIDE), "base: body base is held (slide go)"),
    "on a free body, from a keyframe in which it moves": (
        (*on("<freejoint/>"), "</equality>", f"</equality>{PLACED}"),
        "body base is held (a free)",
    ),
    "on a body that a free one carries": (
        on("<freejoint/>", WAIST), "base: body hull is held (a free, ball waist)"
    ),
    "on a slide that follows it": (
        (*on(SLIDE), *tied(GEARS.format("go", "D"))), "left out: gears, by which base follows"
    ),
    "with a rod on a free joint": (FREE_ROD, "assembly: C +1"),
    "with a rod on a ball joint": (('<joint name="B"/>', '<joint name="B" type="ball"/>'), "C +1"),
    "with a foot": (foot('<joint name="ankle"/>'), "left out: foot (hinge ankle), hanging on the"),
    "with a foot that leaves the plane": (foot('<joint type="ball"/>'), "left out: foot (a ball)"),
    "with a tool welded on": (
        ("</worldbody>", FLOATING, *tied('<weld body1="coupler" body2="foot"/>')),
        "left out: foot (free toe)",
    ),
    "with a wheel beside it": (
        ("</worldbody>", f"{SPIN}</worldbody>", *tied(GEARS.format("spin", "A"))),
        "left out: gears, by which wheel follows the loop",
    ),
    "with a gear on it": (
        (*foot('<joint name="gear"/>'), *tied(GEARS.format("D", "gear"))), "by which foot follows"
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", few(CARRIED, list(CARRIED)[::3], "carried or followed otherwise"))
def test_the_loop_is_judged_whatever_carries_it_hangs_on_it_or_follows_it(
    case: str, tmp_path: Path
) -> None:
    edits, words = CARRIED[case]
    text = planted('gravity="0 0 0"', 'gravity="0 0 -9.81"', *edits)
    key = "home" if "<key " in text else None
    account = read_text(tmp_path, text, converge=False, turns=0.2, key=key)
    assert_four_bar(account.scene)
    assert words in "; ".join(account.notes)
    assert line(account, "as-written").verdict == "within"


FOLDER = Path(__file__).parents[2] / "worlds" / "public_models"


def read(name: str, joint: str, **more: object) -> ModelAccount:
    asked = {"speed_rad_s": 10.0, "converge": False, **more}
    return read_here(ModelRequest(FOLDER / f"{name}.xml", joint, **asked))  # type: ignore[arg-type]


def error_of(account: ModelAccount, profile: str) -> float:
    """The largest error of place of a line."""
    return float(worst_place(line(account, profile).errors).pure)  # type: ignore[arg-type]


QUARTER: Mapping[str, object] = {"start_deg": -90.0, "turns": 0.26}
RUNS: Mapping[str, tuple[str, Mapping[str, object], tuple[float, float, float]]] = {
    # As written, with contacts off, recommended.
    "rhombus": ("drive", {}, (1.7, 2.2e-2, 8.8e-5)),
    "open-four-bar": ("j0", {"branch": {"coupler-tip": 1}}, (4.3e-3, 4.3e-3, 3.6e-5)),
    "chebyshev": ("left-pivot", QUARTER, (1.2e-1, 3.0e-2, 9.2e-5)),
}


@pytest.mark.parametrize("name", few(RUNS, ["chebyshev"], "other public models"))
def test_lines_of_a_public_model_are_as_measured(name: str) -> None:
    joint, more, (written, off, recommended) = RUNS[name]
    account = read(name, joint, **more)
    assert error_of(account, "as-written") == pytest.approx(written, rel=0.5)
    assert error_of(account, "contacts-off") == pytest.approx(off, rel=0.5)
    best = line(account, "recommended")
    assert best.verdict == "within", best.failures
    assert error_of(account, "recommended") < 2.0 * recommended


LEFT, TURNS = "left-pivot", "joint left-pivot would turn from"
REFUSED: list[tuple[str, str, Mapping[str, object], str]] = [
    ("watt", LEFT, {}, "reaches -76.81 to 3.066 deg"),
    ("scotch-yoke", "shaft", {}, "a weld makes two bodies one: pin and yoke; use <connect>"),
    ("four-bar-never-closed", "crank-pivot", {}, "no loop: the model has no <equality>"),
    ("open-four-bar", "j0", {}, "two assemblies equally well, coupler-tip.*--branch.*--key"),
    ("gripper", "right-driver", {}, "one driver needs mobility 1"),
    ("leg", "knee", {}, "joint heel of body heel: its axis is 4.48 deg off that of"),
    ("rhombus", "driver", {}, "did you mean drive or corner[?]"),
    ("chebyshev", LEFT, {}, f"{TURNS} 0 to 360 deg, .* -95.66 to 5.663 deg.*--turns 0.015 at"),
    ("chebyshev", LEFT, {"speed_rad_s": -10.0}, "0 to -360 deg, and .*--turns 0.265 at most"),
    (
        "chebyshev", LEFT, {"start_deg": 50.0},
        "start in between with --start, and use less of a turn with --turns",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("name", "joint", "way", "words"), REFUSED)
def test_the_refusal_of_a_public_model_says_why_and_what_it_reaches(
    name: str, joint: str, way: Mapping[str, object], words: str
) -> None:
    with pytest.raises(CrankcheckError, match=f"(?s){name}.xml.*{words}"):
        read(name, joint, **way)


def test_a_finger_of_mobility_two_names_what_is_loose(tmp_path: Path) -> None:
    text = (FOLDER / "gripper.xml").read_text(encoding="utf-8")
    lines = [each for each in text.splitlines() if "<joint joint1" not in each]
    held = "with right-driver held these still move: right-coupler, right-spring-link"
    with pytest.raises(CrankcheckError, match=f"= 2; one driver needs mobility 1.*{held}"):
        read_text(tmp_path, "\n".join(lines), joint="right-driver")


def test_the_open_four_bar_may_start_from_a_keyframe_or_a_branch() -> None:
    raised = read("open-four-bar", "j0", key="raised")
    assert raised.scene.branch == {"coupler-tip": 1}
    assert 0.1 < max(raised.open_m.values()) < 0.5
    other = read("open-four-bar", "j0", branch={"coupler-tip": -1})
    assert max(other.open_m.values()) == pytest.approx(2.0)
    assert "keyframe first-only: loop coupler-tip: follower-tip is open" in "\n".join(texts(other))


def test_more_choices_than_are_tried_are_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(assembly, "MOST_CHOICES", 0)
    with pytest.raises(CrankcheckError, match=r"1 choices .* choose 1 or more .*, of coupler-tip"):
        read("open-four-bar", "j0")
    chosen = {"coupler-tip": 1}
    assert read("open-four-bar", "j0", branch=chosen).scene.branch == chosen


def test_a_part_of_a_turn_runs_backwards_too() -> None:
    account = read("chebyshev", LEFT, start_deg=2.0, turns=0.256, speed_rad_s=-10.0)
    assert line(account, "recommended").verdict == "within"
