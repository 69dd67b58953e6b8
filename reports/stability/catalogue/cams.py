"""Cams by contact: the speed at which a follower leaves its cam."""

from dataclasses import replace
from functools import cache, partial

from analytic.cams.contact_force import FollowerLoad, lift_off
from analytic.cams.outline import outlined
from models.scene import Scene, hard
from models.scene.laws import ConstantSpeed
from reports.stability.case import Case, Trial

SOURCE = "made up"
STEPS, FACETS = 2000.0, 720
OPEN = 4e-4
"""Opening over the longest link beyond which a follower has left: at lower speeds it flies over the
corners of the facets by a third of that."""


@cache
def _cam(ratio: float) -> Scene:
    """Return the cam at a speed over that of lift-off, by the closed form."""
    scene = hard.sprung_cam("sprung-cam", source=SOURCE, facets=FACETS)
    pair, spring = scene.cams["C"], scene.springs["C"]
    preload = spring.rate * (pair.lowest(scene.points_of, scene.sliders) - spring.free)
    load = FollowerLoad(scene.links[pair.follower].mass_kg, spring.rate, preload)
    law = ConstantSpeed(0.0, ratio * lift_off(pair.profile, load)[0])
    return outlined(replace(scene, driver=replace(scene.driver, law=law)))


_case = partial(
    Case,
    source=SOURCE,
    truth="the speed at which spring and inertia leave no contact force, in closed form",
    parameter="speed over that of lift-off",
    within=OPEN,
    scale="linear",
    trial=lambda ratio: Trial(_cam(ratio), steps_per_turn=STEPS, turns=1.0),
)
CAMS = (
    _case(
        name="cam-on",
        title="Follower below the speed at which it leaves its cam",
        expected="stays on up to 1; it leaves at the engine's own speed of lift-off",
        values=(0.5, 0.7, 0.9, 0.95, 0.98),
    ),
    _case(
        name="cam-off",
        title="Follower above the speed at which it leaves its cam",
        expected="leaves down to 1: a joint that stays closed pulls, which no contact does",
        values=(1.5, 1.25, 1.1, 1.05, 1.02),
        good=("silently-open",),
    ),
)
