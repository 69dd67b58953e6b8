"""Light bodies that hold heavy ones, a four-bar of other sizes and elsewhere, and bad starts."""

import math
from dataclasses import replace
from functools import partial

import numpy as np

from analytic.kinematics import solve
from models.files.reading import load_scene
from models.motion import State
from models.scene import Scene
from models.scene.moved import moved, of_mass, rotated, scaled
from reports.stability.case import Case, Trial

SOURCE = "fourbar-lecture-1"
SLIDER_CRANK = "slider-crank-offset"
RATIOS = (1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6)
LIGHT = (1.0, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 0.0)


def _link(name: str, factor: float) -> Trial:
    """Return the four-bar with the mass of one link times ``factor``, of the same shape."""
    return Trial(of_mass(load_scene(SOURCE), name, factor))


def _block(factor: float) -> Trial:
    scene = load_scene(SLIDER_CRANK)
    rod = scene.links["rod"].mass_kg
    sliders = {n: replace(s, mass_kg=rod * factor) for n, s in scene.sliders.items()}
    return Trial(replace(scene, sliders=sliders))


_heavy = partial(
    Case,
    truth="closed form: the masses do not matter to a driven mechanism",
    expected="holds, with more iterations if need be",
)
_ratio = partial(_heavy, parameter="mass ratio", values=RATIOS)
MASSES = (
    _ratio(
        name="heavy-rocker",
        title="Heavy rocker behind a light coupler",
        source=SOURCE,
        trial=lambda ratio: _link("rocker", ratio),
    ),
    _ratio(
        name="light-rocker",
        title="Light rocker behind a heavy coupler",
        source=SOURCE,
        trial=lambda ratio: _link("rocker", 1.0 / ratio),
    ),
    _ratio(
        name="heavy-block",
        title="Heavy block behind a light rod",
        source=SLIDER_CRANK,
        trial=_block,
    ),
    _ratio(
        name="light-block",
        title="Light block behind a heavy rod",
        source=SLIDER_CRANK,
        trial=lambda ratio: _block(1.0 / ratio),
    ),
    _heavy(
        name="massless-coupler",
        title="Coupler with less and less mass, finally none",
        source=SOURCE,
        trial=lambda share: _link("coupler", share),
        parameter="mass of the coupler, over that of a slender rod",
        values=LIGHT,
    ),
)


LONGEST_M = 0.3


def _offset(lengths: float) -> Trial:
    scene = load_scene(SOURCE)
    return Trial(moved(scene, (lengths * scene.longest_m, -0.7 * lengths * scene.longest_m)))


def _turned(angle_deg: float) -> Trial:
    return Trial(rotated(load_scene(SOURCE), math.radians(angle_deg)))


_same = partial(
    Case,
    source=SOURCE,
    truth="closed form; place and size of a mechanism do not matter",
    expected="the same error as a pure number",
)
_size = partial(
    _same,
    parameter="longest link",
    unit="m",
    trial=lambda longest_m: Trial(scaled(load_scene(SOURCE), longest_m / LONGEST_M)),
)
SCALES = (
    _size(name="small", title="Smaller and smaller", values=(1.0, 0.1, 1e-2, 1e-3, 1e-4)),
    _size(name="large", title="Larger and larger", values=(1.0, 10.0, 100.0, 1e3, 1e4)),
    _same(
        name="far-away",
        title="Far from the origin",
        parameter="distance over the longest link",
        values=(1.0, 1e3, 1e6, 1e8, 1e10),
        trial=_offset,
    ),
    _same(
        name="turned",
        title="The plane turned",
        parameter="angle",
        unit="deg",
        values=(0.0, 30.0, 45.0, 90.0, 137.0, 180.0, 270.0),
        trial=_turned,
        scale="linear",
    ),
)


SETTLED_TURNS = 1.0
"""Turns after which errors count: an engine that corrects its start has done so by then."""


def _started(scene: Scene, start: State, open_m: float = 0.0) -> Trial:
    return Trial(scene, start=start, open_m=open_m, settled_turns=SETTLED_TURNS)


def _assembled(scene: Scene) -> State:
    return solve(scene, np.zeros(1)).state()


def _open_joint(share: float) -> Trial:
    """Turn the rocker until its pin C is off the coupler's by a share of the crank."""
    scene = load_scene(SOURCE)
    (a, b), (d, c) = (list(scene.links[n].points.values()) for n in ("crank", "rocker"))
    gap = share * abs(b[0] - a[0])
    state = _assembled(scene)
    theta = {**state.theta, "rocker": state.theta["rocker"] + gap / abs(c[0] - d[0])}
    return _started(scene, replace(state, theta=theta), open_m=1.01 * gap)


def _other_velocity(share: float) -> Trial:
    """Turn the rocker faster, or slower, than fits by a share of the crank's speed."""
    scene = load_scene(SOURCE)
    state = _assembled(scene)
    more = share * scene.pace_rad_s
    omega = {**state.omega, "rocker": state.omega["rocker"] + more}
    return _started(scene, replace(state, omega=omega))


def _other_branch(_: float) -> Trial:
    scene = load_scene(SOURCE)
    other = replace(scene, branch={name: -sign for name, sign in scene.branch.items()})
    return _started(scene, _assembled(other))


_start = partial(Case, source=SOURCE)
STARTS = (
    _start(
        name="open-joint",
        title="Start with an open joint",
        truth="closed form of the assembled linkage, from the second turn on",
        expected="closes the joint, and continues as if it had been closed",
        parameter="gap at the start over the crank's length",
        values=(1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5),
        trial=_open_joint,
    ),
    _start(
        name="wrong-velocity",
        title="Start with a wrong velocity of the rocker",
        truth="closed form, from the second turn on",
        expected="removes the wrong velocity in the first steps",
        parameter="excess velocity of the rocker, over the crank's",
        values=(1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0),
        trial=_other_velocity,
    ),
    _start(
        name="wrong-branch",
        title="Start in the other assembly",
        truth="closed form of the scene's branch; no engine can know which one is meant",
        expected="branch-changed: the comparison says so",
        parameter="assembly",
        values=(-1.0,),
        trial=_other_branch,
        good=("branch-changed",),
    ),
)
