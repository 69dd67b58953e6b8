"""Bounds along whole chains, against the whole mechanism in fifty digits."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mp, mpf

from analytic.kinematics import solve
from models.array import Array
from models.files.reading import load_scene, shipped
from models.motion import Motion
from models.scene import GROUND, Driver, Point, Scene
from models.scene.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating
from models.scene.moved import moved
from tests.analytic.chain import Chain, Solved, coordinates
from tests.analytic.change_points.jets import Jet
from tests.worlds.strategies import FORMS, OF_EACH_KIND, examples, mechanisms
from tests.worlds.tiers import few, slowly

Data = st.DataObject
TIMES = "an instant at which rounding adds up"
SIX = ["fourbar-lecture-1", "slider-crank-offset", "shaper", "scotch-yoke", "tangent"]
SIX += ["sixbar-watt"]
EACH_KIND = "a form of each kind of dyad shows it"
NOTHING = 1e-38
"""What is left of an error of the oracle itself."""


def shares(scene: Scene, time_s: Array) -> Array:
    """Error over bound, (levels, everything that moves); a quantity that is exact counts as 0."""
    motion, chain = solve(scene, time_s), Chain(scene)
    rows = []
    for i, t in enumerate(time_s):
        solved = chain.solve(float(t), coordinates(scene, motion, i))
        rows.append(_shares_at(motion, solved, i))
    return np.concatenate(rows, axis=1)


def _shares_at(motion: Motion, solved: Solved, i: int) -> Array:
    columns = []
    for kind in ("links", "sliders", "points"):
        exact, found, bound = (getattr(one, kind) for one in (solved, motion, motion.bound))
        assert exact.keys() == found.keys() == bound.keys()
        for name, wanted in exact.items():
            own = vars(found[name])
            if kind == "points":
                x = errors(wanted.x, {k: v[:, 0] for k, v in own.items()}, i)
                y = errors(wanted.y, {k: v[:, 1] for k, v in own.items()}, i)
                off = list(map(math.hypot, x, y))
            else:
                off = errors(wanted, own, i, turning=kind == "links")
            columns.append(over(off, vars(bound[name]), i))
    return np.array(columns).T


def errors(
    jet: Jet, found: dict[str, Array], i: int, *, turning: bool = False, nothing: float = NOTHING
) -> list[float]:
    """The errors at the three levels, but for the oracle's own; of angles modulo whole turns."""
    exact = (jet.value, jet.rate, jet.second)
    apart = [mpf(float(array[i])) - e for array, e in zip(found.values(), exact, strict=True)]
    if turning:
        apart[0] -= 2 * mp.pi * mp.nint(apart[0] / (2 * mp.pi))
    return [0.0 if abs(a) <= nothing else float(abs(a)) for a in apart]


def over(off: list[float], bounds: dict[str, Array], i: int) -> list[float]:
    """Errors over bounds; 0 / 0 is 0, and a bound of 0 is broken by any error."""
    limits = [float(array[i]) for array in bounds.values()]
    assert not any(math.isnan(limit) for limit in limits)
    return [e / b if b else (math.inf if e else 0.0) for e, b in zip(off, limits, strict=True)]


def random_times(scene: Scene, count: int, turns: float, seed: int = 1) -> Array:
    span = turns * scene.driver.law.period_s
    return np.sort(np.random.default_rng(seed).uniform(-0.1 * span, span, count))


@pytest.mark.parametrize("count", [4, slowly(200, reason=TIMES)])
@pytest.mark.parametrize("name", few(shipped(), SIX, "scenes of the same dyads"))
def test_error_stays_below_the_bound_in_every_scene(name: str, count: int) -> None:
    scene = load_scene(name)
    found = shares(scene, random_times(scene, count, 1.0))
    assert found.max() <= 1.0
    assert found.max() > 1e-3, "a bound a thousand times the largest error says little"


@pytest.mark.parametrize("count", [2, slowly(100, reason=TIMES)])
@pytest.mark.parametrize("name", few(shipped(), SIX, "scenes of the same dyads"))
def test_error_stays_below_the_bound_after_ten_thousand_turns_and_a_million_lengths_away(
    name: str, count: int
) -> None:
    scene = load_scene(name)
    assert shares(scene, random_times(scene, count, 1e4)).max() <= 1.0
    far = 1e6 * scene.longest_m
    there = moved(scene, (far, -0.7 * far))
    assert shares(there, random_times(there, count, 1.0)).max() <= 1.0


@pytest.mark.parametrize(
    "law",
    [
        ConstantSpeed(0.3, -500.0),
        ConstantSpeed(1e5, 1e-3),
        FromRest(0.4, -3.0, 2.0),
        Accelerating(0.4, 0.0, -80.0),
        Accelerating(-0.4, 30.0, -29.0),
        Oscillating(0.2, 3.0, 7.0, 0.5),
        Oscillating(-0.2, 0.01, 200.0, math.radians(36_000.0)),
    ],
    ids=str,
)
def test_error_stays_below_the_bound_under_every_law(law: Law) -> None:
    scene = load_scene("sixbar-watt")
    scene = replace(scene, driver=Driver(scene.driver.link, law))
    assert shares(scene, random_times(scene, 3, 2.0)).max() <= 1.0


@pytest.mark.parametrize("form", few(FORMS, OF_EACH_KIND, EACH_KIND))
@examples(2)
@given(data=st.data())
def test_error_stays_below_the_bound_in_every_form_of_dyad(form: str, data: Data) -> None:
    """Also where lengths are small differences of large local coordinates, rounded too."""
    scene = data.draw(mechanisms([form])).scene
    for each in (scene, with_far_frames(scene, (700.0, -3000.0))):
        assert shares(each, random_times(each, 2, 1.0)).max() <= 1.0


def with_far_frames(scene: Scene, by: Point) -> Scene:

    def shift(p: Point) -> Point:
        return (p[0] + by[0], p[1] + by[1])

    links, sliders = dict(scene.links), dict(scene.sliders)
    for name, link in links.items():
        links[name] = replace(link, points={point: shift(p) for point, p in link.points.items()})
    for name, slider in sliders.items():
        if slider.on != GROUND:
            sliders[name] = replace(slider, through_m=shift(slider.through_m))
    return replace(scene, links=links, sliders=sliders)
