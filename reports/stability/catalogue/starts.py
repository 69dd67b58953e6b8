"""Bad starts: joints that are open, velocities that do not fit, the wrong assembly."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from analytic.kinematics import solve
from models.files.reading import load_scene
from models.motion import State
from models.scene import Scene
from reports.stability.case import Case, Trial

SOURCE = "fourbar-lecture-1"
SETTLED_TURNS = 1.0
"""Errors count from there on: an engine that mends its start has done so by then."""


def _started(scene: Scene, start: State, open_m: float = 0.0) -> Trial:
    return Trial(scene, start=start, open_m=open_m, settled_turns=SETTLED_TURNS)


def _assembled(scene: Scene) -> State:
    return solve(scene, np.zeros(1)).state()


def _open_joint(share: float) -> Trial:
    """The rocker turned until its pin C is off the coupler's by a share of the crank."""
    scene = load_scene(SOURCE)
    (a, b), (d, c) = (list(scene.links[n].points.values()) for n in ("crank", "rocker"))
    gap = share * abs(b[0] - a[0])
    state = _assembled(scene)
    theta = {**state.theta, "rocker": state.theta["rocker"] + gap / abs(c[0] - d[0])}
    return _started(scene, replace(state, theta=theta), open_m=1.01 * gap)


def _other_velocity(share: float) -> Trial:
    """The rocker turns faster, or slower, than fits by a share of the crank's speed."""
    scene = load_scene(SOURCE)
    state = _assembled(scene)
    more = share * scene.pace_rad_s
    omega = {**state.omega, "rocker": state.omega["rocker"] + more}
    return _started(scene, replace(state, omega=omega))


def _other_branch(_: float) -> Trial:
    scene = load_scene(SOURCE)
    other = replace(scene, branch={name: -sign for name, sign in scene.branch.items()})
    return _started(scene, _assembled(other))


_case = partial(Case, source=SOURCE)
CASES = (
    _case(
        name="open-joint",
        title="Started with a joint open",
        truth="closed form of the assembled linkage, from the second turn on",
        expected="closes the joint, and goes on as if it had been closed",
        parameter="gap at the start over the crank's length",
        values=(1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5),
        trial=_open_joint,
    ),
    _case(
        name="wrong-velocity",
        title="Started with a velocity that does not fit",
        truth="closed form, from the second turn on",
        expected="takes the wrong velocity away in the first steps",
        parameter="velocity of the rocker that is too much, over the crank's",
        values=(1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0),
        trial=_other_velocity,
    ),
    _case(
        name="wrong-branch",
        title="Started in the other assembly",
        truth="closed form of the scene's branch; no engine can know which one is meant",
        expected="branch-changed: the comparison says so",
        parameter="assembly",
        values=(-1.0,),
        trial=_other_branch,
        good=("branch-changed",),
    ),
)
