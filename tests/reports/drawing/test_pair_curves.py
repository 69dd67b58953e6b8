"""Curves of gears and cams on a drawing: they touch and turn as the solved motion has it."""

import numpy as np
import pytest

from analytic.kinematics import solve
from models.array import Array
from models.files.reading import load_scene
from reports.drawing import moving, shape
from reports.drawing.pair_curves import SPOKES, TICKS, BodyCurves, pair_curves
from tests.sim.test_cams_by_contact import KINDS
from tests.worlds.touching_cams import sprung

ASIDE = {"swings": True, "flat": True, "kind": "harmonic", "more": "face_m = 0.01"}
LEFT = ASIDE | {"left": True, "more": "face_m = -0.01"}
CAMS = {name: sprung(**more) for name, more in (KINDS | {"aside": ASIDE, "left": LEFT}).items()} | {
    name: load_scene(name) for name in ("cam-roller", "cam-rocker", "cam-flat")
}
TRAINS = ("gear-train", "planetary", "differential", "sun-and-planet", "geared-five-bar")


TIME_S = np.linspace(0.0, 0.6, 13)


def gap_to(follower: Array, profile: Array) -> float:
    """The least room between a drawn profile and a drawn roller or face, from the pictures."""
    ends = np.stack([profile, np.roll(profile, -1, axis=0)])
    fine = np.concatenate([ends[0] + share * (ends[1] - ends[0]) for share in np.linspace(0, 1, 9)])
    if len(follower) > 4:
        middle = follower.mean(axis=0)
        radius = np.hypot(*(follower[0] - middle))
        return float(np.min(np.hypot(*(fine - middle).T))) - float(radius)
    along, away = follower[3] - follower[0], follower[1] - follower[0]
    share = (fine - follower[0]) @ along / (along @ along)
    room = (follower[0] - fine) @ away / np.hypot(*away)
    assert 0.0 < share[int(np.argmin(room))] < 1.0  # it is touched between its ends
    return float(np.min(room))


@pytest.mark.parametrize("name", CAMS)
def test_a_drawn_follower_touches_the_drawn_profile_all_around(name: str) -> None:
    scene = CAMS[name]
    motion = solve(scene, TIME_S, bound=False)
    (profiles,), (followers,) = (own.at(motion, slice(None)) for own in pair_curves(scene))
    for profile, follower in zip(profiles, followers, strict=True):
        assert gap_to(follower, profile) == pytest.approx(0.0, abs=1.5e-5)  # base radius 4e-2


def pitch_m(own: BodyCurves) -> float:
    """The radius at the outer end of a spoke, or at the inner end of a tick of a ring."""
    inner, outer = np.hypot(*own.curves[-1].T)
    assert len(own.curves) == (1 + TICKS if inner else 1 + SPOKES)
    return float(inner or outer)


@pytest.mark.parametrize("name", TRAINS)
def test_pitch_circles_of_a_pair_touch_in_the_ratio_of_teeth(name: str) -> None:
    scene = load_scene(name)
    motion, curves = solve(scene, TIME_S, bound=False), pair_curves(scene)
    for gear in scene.gears.values():
        at = gear.pivots(scene.points_of)
        apart = np.hypot(*np.subtract(*(motion.points[point].position for point in at)).T)
        first, second = (
            [pitch_m(own) for own in curves if (own.body, own.point) == each]
            for each in zip(gear.bodies, at, strict=True)
        )
        sign = -1 if gear.internal else 1
        touching = [
            np.allclose(apart, sign * r + q) and np.isclose(r / q, gear.teeth[0] / gear.teeth[1])
            for r in first
            for q in second
        ]
        assert touching.count(True) == 1


@pytest.mark.parametrize("name", TRAINS[:3])
def test_spokes_turn_with_their_links(name: str) -> None:
    """The scenes have a point of each wheel on its x-axis, and so has the drawing a spoke."""
    scene = load_scene(name)
    motion = solve(scene, TIME_S, bound=False)
    on_circle = 0
    for own in pair_curves(scene):
        for point, (x, _) in scene.points_of[own.body].items():
            if x == pytest.approx(pitch_m(own)):
                ends = own.at(motion, slice(None))[-SPOKES if len(own.curves) < 9 else -TICKS]
                end = ends[:, 1 if len(own.curves) < 9 else 0]
                np.testing.assert_allclose(end, motion.points[point].position, atol=1e-12)
                on_circle += 1
    assert on_circle >= 2


def test_a_page_gets_each_curve_once_and_room_for_it() -> None:
    scene = load_scene("planetary")
    time_s = moving.instants(scene)
    drawn = moving.drawing(scene, time_s)
    assert [(x["body"], x["point"], x["on"]) for x in drawn["curves"]] == [
        ("sun", "O", "sun"), ("planet", "P", "planet"), ("ground", "O", "ground"),
    ]  # fmt: skip
    assert drawn["guides"] == ["sun", "planet"]
    np.testing.assert_allclose(drawn["box"], [-0.108, -0.108, 0.108, 0.108], atol=1e-9)
    low, high = shape.box_of(scene, shape.turn_of(scene, 13))
    assert (high - low > 0.216).all()
    plain = moving.drawing(load_scene("slider-crank-offset"), time_s)
    assert "curves" not in plain
    assert "bare" not in plain["sliders"][0]
    lifted = moving.drawing(load_scene("cam-roller"), time_s)
    assert lifted["sliders"][0]["bare"]
    assert [x["on"] for x in lifted["curves"]] == ["cam", "ground"]
