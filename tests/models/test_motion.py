"""Motions one after the other."""

from dataclasses import replace

import numpy as np

from analytic.kinematics import solve
from models.files import load_scene
from models.motion import Crossing, Motion

TIMES = np.linspace(0.0, 0.3, 7)


def test_parts_of_a_motion_joined_are_the_whole() -> None:
    scene = load_scene("slider-crank-offset")
    whole = solve(scene, TIMES)
    parts = [solve(scene, times) for times in (TIMES[:2], TIMES[2:3], TIMES[3:])]
    joined = Motion.joined(parts)
    assert (joined.time_s == TIMES).all()
    assert joined.bound is not None
    assert whole.bound is not None
    for own, other in ((joined, whole), (joined.bound, whole.bound)):
        for kind in ("links", "points", "sliders"):
            assert getattr(own, kind).keys() == getattr(other, kind).keys()
            for name, body in getattr(own, kind).items():
                for key, series in vars(body).items():
                    wanted = getattr(getattr(other, kind)[name], key)
                    np.testing.assert_allclose(series, wanted, rtol=1e-9, atol=1e-12)
    assert {name: sine.shape for name, sine in joined.conditioning.items()} == {
        name: sine.shape for name, sine in whole.conditioning.items()
    }


def test_what_a_part_lacks_is_left_out() -> None:
    motion = solve(load_scene("fourbar-lecture-1"), TIMES)
    bare = replace(motion, points={}, conditioning={}, bound=None)
    for parts in ([motion, bare], [bare, motion]):
        joined = Motion.joined(parts)
        assert joined.points == {}
        assert joined.conditioning == {}
        assert joined.bound is None
        assert joined.forces is None
        assert joined.links["crank"].theta.shape == (14,)


def test_change_points_of_all_parts_are_kept_once() -> None:
    motion = solve(load_scene("fourbar-lecture-1"), TIMES)
    one, other = Crossing("C", 0.1), Crossing("C", 3.2)
    parts = [replace(motion, crossings=seen) for seen in ((one,), (one, other), ())]
    assert Motion.joined(parts).crossings == (one, other)
