"""Random mechanisms, designed in an assembled position so that every one of them closes.

Bodies, pins and lines are laid out at the first instant; lengths, lines and angles in the bodies'
own frames follow from that layout, and so does the branch: the one assembly that is the layout.
Every dyad is laid out with a conditioning of at least 0.5, and the driver swings as far as
all of them keep `MARGIN`.
"""

from __future__ import annotations

import cmath
import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st

from analytic.kinematics import solve
from analytic.nearness import nearness
from analytic.structure.mobility import analyse
from models.errors import ReachError
from models.laws import ConstantSpeed, Law, Oscillating
from models.motion import Motion
from models.scene import GROUND, Driver, Link, Scene
from tests.worlds.layouts import LAYOUTS, Layout

MARGIN = 0.25
SWINGS = [0.6 * 0.5**k for k in range(8)]
"""Amplitudes of the driver [rad] that are tried, the largest first."""

FORMS = tuple(LAYOUTS)
"""Kind of the dyad and how it slides: a block; a link that slides; a link that is the guide of what
slides (for PRP the two ends, for RPP the inner pair and the outer one)."""
OF_EACH_KIND = list({form[:3]: form for form in FORMS}.values())
"""The last form of each kind."""


@dataclass(frozen=True)
class Designed:
    """A random mechanism, with the frames (x, y [m], theta) in which its bodies were laid out.

    That layout is the mechanism's position at time 0; blocks are named as in
    `analytic.check.newton`.
    """

    scene: Scene
    frames: Mapping[str, tuple[float, float, float]]
    forms: tuple[str, ...]


def examples(count: int) -> settings:
    """So many examples, the same ones every time."""
    return settings(max_examples=count, deadline=None, derandomize=True, database=None)


@st.composite
def mechanisms(draw: st.DrawFn, forms: Sequence[str] | None = None) -> Designed:
    """A crank with the dyads of the given forms in that order (None: one or two of any form)."""
    if forms is None:
        forms = draw(st.lists(st.sampled_from(FORMS), min_size=1, max_size=2))

    def number(low: float, high: float) -> float:
        return draw(st.floats(low, high))

    at = Layout(number, lambda names: draw(st.sampled_from(names)))
    pivot = at.arm(0.0, 1.0)
    crank = at.link(pivot)
    at.pin(pivot, GROUND, crank)
    at.pin(pivot + at.arm(0.3, 0.8), crank)
    law = Oscillating(at.frames[crank][1], SWINGS[0], number(0.5, 20.0))
    return _with_margin(with_dyads(at, forms, crank, law))


def with_dyads(at: Layout, forms: Sequence[str], crank: str, law: Law) -> Designed:
    """The dyads of the given forms hung on a crank and on each other, on the branch laid out."""
    laid_out = []
    turning = frozenset([crank]) if isinstance(law, ConstantSpeed) else frozenset()
    for form in forms:
        at.barred = turning if form.startswith("PRP") else frozenset()
        if form == "PRP guide, guide" and len(at.free(GROUND)) < 2:
            LAYOUTS["RRR"](at)  # both of its guides ride on moving links
            laid_out.append("RRR")
        LAYOUTS[form](at)
        laid_out.append(form)
    links = {
        name: Link(name, points, 1.0, (0.0, 0.0), 1.0)
        for name, points in at.points.items()
        if name != GROUND
    }
    scene = Scene(
        "random",
        "tests/worlds/strategies.py",
        at.points[GROUND],
        links,
        at.sliders,
        Driver(crank, law),
    )
    frames = {b: (p.real, p.imag, a) for b, (p, a) in {**at.frames, **at.blocks}.items()}
    del frames[GROUND]
    return _on_its_branch(Designed(scene, frames, tuple(laid_out)))


def _on_its_branch(designed: Designed) -> Designed:
    """With the one choice of assemblies whose position is the layout."""
    keys = [g.branch_key for g in analyse(designed.scene).groups if g.assemblies == 2]
    choices = [
        dict(zip(keys, s, strict=True)) for s in itertools.product((1, -1), repeat=len(keys))
    ]
    scenes = [replace(designed.scene, branch=choice) for choice in choices]
    fitting = [scene for scene in scenes if _is_layout(scene, designed.frames)]
    assert len(fitting) == 1, f"{len(fitting)} of {len(scenes)} assemblies are the layout"
    return replace(designed, scene=fitting[0])


def _is_layout(scene: Scene, frames: Mapping[str, tuple[float, float, float]]) -> bool:
    try:
        motion = solve(scene, np.zeros(1), bound=False)
    except ReachError:
        return False
    return all(
        abs(math.remainder(float(motion.links[name].theta[0]) - frames[name][2], math.tau)) < 1e-9
        and all(
            abs(complex(*motion.points[point].position[0]) - place) < 1e-9
            for point, place in _places(scene.links[name], frames[name]).items()
        )
        for name in scene.links
    )


def _places(link: Link, frame: tuple[float, float, float]) -> dict[str, complex]:
    x, y, angle = frame
    turn = cmath.rect(1.0, angle)
    return {name: complex(x, y) + turn * complex(*local) for name, local in link.points.items()}


def _with_margin(designed: Designed, margin: float = MARGIN) -> Designed:
    """With the largest swing of the driver that keeps every dyad off its singular positions."""
    scene = designed.scene
    law = scene.driver.law
    assert isinstance(law, Oscillating)
    for swing in SWINGS:
        tried = replace(scene, driver=replace(scene.driver, law=replace(law, amplitude_rad=swing)))
        if _worst(tried) >= margin:
            return replace(designed, scene=tried)
    raise AssertionError("laid out too near to a singular position")


def swinging(designed: Designed, frequency_rad_s: float, margin: float = MARGIN) -> Designed:
    """The same mechanism under a driver that swings as far as the margin lets it."""
    driver = designed.scene.driver
    theta = designed.frames[driver.link][2]
    law = Oscillating(theta, SWINGS[0], frequency_rad_s)
    scene = replace(designed.scene, driver=replace(driver, law=law))
    return _with_margin(replace(designed, scene=scene), margin)


def _worst(scene: Scene) -> float:
    """The nearest singular position over a swing; 0 where it does not close."""
    try:
        motion: Motion = solve(scene, swing_times(scene, 65), bound=False)
    except ReachError:
        return 0.0
    return min(float(sine.min()) for sine in nearness(scene, motion).values())


def swing_times(scene: Scene, count: int) -> np.ndarray:
    """Times over a whole period of the driver's law, from 0."""
    return np.linspace(0.0, scene.driver.law.period_s, count)
