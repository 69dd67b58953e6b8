"""Models that people published: what is said of each, run or refused.

The bounds are those that a prototype measured, within a factor of two; none is to the digit.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from models.errors import CrankcheckError
from reports.judge.halving import worst_place
from reports.own_model.account import Account, read_here
from reports.own_model.request import ModelRequest
from tests.worlds.own_models import line, read_text, texts

FOLDER = Path(__file__).parents[2] / "worlds" / "public_models"


def read(name: str, joint: str, **more: object) -> Account:
    asked = {"speed_rad_s": 10.0, "converge": False, **more}
    return read_here(ModelRequest(FOLDER / f"{name}.xml", joint, **asked))  # type: ignore[arg-type]


def error_of(account: Account, profile: str) -> float:
    """The largest error of place of a line."""
    return float(worst_place(line(account, profile).errors).pure)  # type: ignore[arg-type]


QUARTER: Mapping[str, object] = {"start_deg": -90.0, "turns": 0.26}
LESS: Mapping[str, object] = {"start_deg": -70.0, "turns": 0.19, "dt_s": 1e-3}
RUNS: Mapping[str, tuple[str, Mapping[str, object], tuple[float, float, float]]] = {
    # As written, with contacts off, recommended.
    "rhombus": ("drive", {}, (1.7, 2.2e-2, 8.8e-5)),
    "slider-crank": ("shaft", {}, (6.4e-3, 1.4e-3, 8.7e-7)),
    "open-four-bar": ("j0", {"branch": {"coupler-tip": 1}}, (4.3e-3, 4.3e-3, 3.6e-5)),
    "chebyshev": ("left-pivot", QUARTER, (1.2e-1, 3.0e-2, 9.2e-5)),
    "watt": ("left-pivot", LESS, (9.3e-2, 2.5e-2, 8.7e-6)),
}


@pytest.mark.parametrize("name", RUNS)
def test_its_lines_are_as_measured(name: str) -> None:
    joint, more, (written, off, recommended) = RUNS[name]
    account = read(name, joint, **more)
    assert error_of(account, "as-written") == pytest.approx(written, rel=0.5)
    assert error_of(account, "contacts-off") == pytest.approx(off, rel=0.5)
    best = line(account, "recommended")
    assert best.verdict == "within", best.failures
    assert error_of(account, "recommended") < 2.0 * recommended


def test_the_rhombus_touches_the_floor_and_itself_and_passes_change_points() -> None:
    account = read("rhombus", "drive")
    told = "\n".join(texts(account))
    for words in ("floor", "a geom of upper"):
        assert f"a geom of lower touches {words}" in told
    for name in ("motor", "position-servo", "velocity-servo"):
        assert f"actuator {name} acts on joint drive" in told
    assert "change points of far-corner at driver 90, 270 deg" in account.notes[-1]
    assert '<flag contact="disable"/>' in account.recommended.patch


def test_the_slider_crank_starts_at_a_dead_point_with_its_rod_in_the_slider() -> None:
    account = read("slider-crank", "shaft")
    assert "piston-box touches rod-bar in 100% of the poses" in texts(account)
    assert "joint guide: limited to -4 m to 4 m" in texts(account)
    assert not any("past its limit" in text for text in texts(account))


REFUSED = {
    ("chebyshev", "left-pivot"): (
        "joint left-pivot would turn from 0 to 360 deg, and reaches -95.66 to 5.663 deg",
        "--turns 0.015 at most",
    ),
    ("watt", "left-pivot"): ("reaches -76.81 to 3.066 deg",),
    ("scotch-yoke", "shaft"): ("a weld makes two bodies one: pin and yoke; use <connect>",),
    ("four-bar-never-closed", "crank-pivot"): ("no loop: the model has no <equality>",),
    ("open-four-bar", "j0"): ("two assemblies equally well, coupler-tip", "--branch", "--key"),
    ("gripper", "right-driver"): ("equality 2: a <joint> equality couples coordinates",),
    ("leg", "knee"): ("joint rod of body rod: a ball joint leaves the plane",),
    ("jansen-global", "top"): ("global coordinates no longer supported",),
    ("rhombus", "corner"): ("turns against body lower", "drivable: drive"),
    ("rhombus", "driver"): ("did you mean drive or corner?",),
}


@pytest.mark.parametrize(("name", "joint"), REFUSED)
def test_its_refusal_says_why(name: str, joint: str) -> None:
    with pytest.raises(CrankcheckError) as refused:
        read(name, joint)
    for words in REFUSED[name, joint]:
        assert words in str(refused.value)
    assert f"{name}.xml" in str(refused.value)


def test_a_finger_of_mobility_two_names_what_is_loose(tmp_path: Path) -> None:
    text = (FOLDER / "gripper.xml").read_text(encoding="utf-8")
    lines = [each for each in text.splitlines() if "<joint joint1" not in each]
    with pytest.raises(CrankcheckError) as refused:
        read_text(tmp_path, "\n".join(lines), joint="right-driver")
    held = "with right-driver held these still move: right-coupler, right-spring-link"
    assert held in str(refused.value)
    assert "= 2; one driver needs mobility 1" in str(refused.value)


def test_the_open_four_bar_may_start_from_a_keyframe_or_a_branch() -> None:
    raised = read("open-four-bar", "j0", key="raised")
    assert raised.scene.branch == {"coupler-tip": 1}
    assert 0.1 < max(raised.open_m.values()) < 0.5
    other = read("open-four-bar", "j0", branch={"coupler-tip": -1})
    assert max(other.open_m.values()) == pytest.approx(2.0)
    assert "keyframe first-only: loop coupler-tip: follower-tip is open" in "\n".join(texts(other))


@pytest.mark.parametrize("speed", [10.0, -10.0])
def test_a_part_of_a_turn_runs_both_ways(speed: float) -> None:
    start = -90.0 if speed > 0.0 else 2.0
    account = read("chebyshev", "left-pivot", start_deg=start, turns=0.256, speed_rad_s=speed)
    assert line(account, "recommended").verdict == "within"


WAYS = {
    (280.0, 10.0): "from 280 to 640 deg, and reaches 264.3 to 365.7 deg",
    (0.0, -10.0): "from 0 to -360 deg, and reaches -95.66 to 5.663 deg, where the loops close; "
    "take less of a turn, --turns 0.265 at most",
    (50.0, 10.0): "start in between with --start, and take less of a turn with --turns",
}


@pytest.mark.parametrize(("start", "speed"), WAYS)
def test_the_reach_is_told_from_where_the_joint_starts(start: float, speed: float) -> None:
    with pytest.raises(CrankcheckError) as refused:
        read("chebyshev", "left-pivot", start_deg=start, speed_rad_s=speed)
    assert WAYS[start, speed] in str(refused.value)
