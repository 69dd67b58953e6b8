"""The stranger's integration is a second opinion: it shares no line with ours, and agrees."""

from __future__ import annotations

import ast
import math
from pathlib import Path

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files import load_scene
from tests.worlds import stranger
from tests.worlds.stranger import LINKAGES, course
from tests.worlds.stranger_log import uneven

CLOSE = 1e-8
"""Of an angle, a length or a velocity [SI]; accelerations are ten times those."""


def test_it_imports_nothing_of_ours() -> None:
    tree = ast.parse(Path(stranger.__file__).read_text(encoding="utf-8"))
    modules: list[str] = []
    for each in ast.walk(tree):
        if isinstance(each, ast.ImportFrom):
            modules.append(str(each.module))
        elif isinstance(each, ast.Import):
            modules += [name.name for name in each.names]
    ours = {"models", "analytic", "sim", "reports", "crankcheck", "tests"}
    assert "numpy.typing" in modules
    assert not ours & {name.split(".")[0] for name in modules}


@pytest.mark.parametrize("name", LINKAGES)
def test_it_moves_as_the_reference_does(name: str) -> None:
    linkage = LINKAGES[name]
    motion = course(linkage, uneven(linkage, samples_per_turn=90))
    reference = solve(load_scene(name), motion.time_s, bound=False)
    assert set(linkage.bars) == set(reference.links)
    for bar, link in reference.links.items():
        theta, omega, alpha = motion.angle(bar)
        off = theta - link.theta
        assert np.ptp(off) < CLOSE
        assert abs(math.remainder(off[0], math.tau)) < CLOSE
        np.testing.assert_allclose(omega, link.omega, rtol=0.0, atol=CLOSE)
        np.testing.assert_allclose(alpha, link.alpha, rtol=0.0, atol=10.0 * CLOSE)
    for pin in set(reference.points) - set(linkage.ground):
        ours = reference.points[pin]
        position, velocity, acceleration = motion.point(pin)
        np.testing.assert_allclose(position, ours.position, rtol=0.0, atol=CLOSE)
        np.testing.assert_allclose(velocity, ours.velocity, rtol=0.0, atol=CLOSE)
        np.testing.assert_allclose(acceleration, ours.acceleration, rtol=0.0, atol=10.0 * CLOSE)


@pytest.mark.parametrize("name", LINKAGES)
def test_put_together_the_other_way_it_is_elsewhere_and_as_long(name: str) -> None:
    linkage = LINKAGES[name]
    time_s = np.linspace(0.0, linkage.period_s, 61)
    one, other = course(linkage, time_s), course(linkage.otherwise(), time_s)
    bar, points = list(linkage.bars.items())[-1]
    for motion in (one, other):
        (first, *_), (last, *_) = (motion.point(end, on=bar) for end in list(points)[:2])
        length = math.dist(*list(points.values())[:2])
        np.testing.assert_allclose(np.hypot(*(last - first).T), length, atol=1e-15, rtol=1e-12)
    assert np.min(np.abs(one.angle(bar)[0] - other.angle(bar)[0])) > 0.1


def test_copies_of_a_pin_come_together() -> None:
    motion = course(stranger.SIXBAR, np.linspace(0.0, 1.0, 101))
    for pin, bars in {"C": ("coupler", "rocker"), "F": ("rod", "lever")}.items():
        one, other = (motion.point(pin, on=bar)[0] for bar in bars)
        np.testing.assert_allclose(one, other, rtol=0.0, atol=CLOSE)
