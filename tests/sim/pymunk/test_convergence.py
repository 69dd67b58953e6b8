"""How many iterations the joints of pymunk ask for: as Chipmunk's own iterations tell."""

from __future__ import annotations

import math

import numpy as np
import pymunk
import pytest

from analytic.elastic.segment_start import segment_start
from analytic.kinematics import solve
from models.errors import EngineError
from models.files import load_scene, parse_scene
from models.motion import State
from models.scene import Scene
from models.segmented import SegmentedScene
from sim.engine import Run
from sim.pymunk import convergence
from sim.pymunk.convergence import HALVINGS, chain_iterations, iterations, left_over
from sim.pymunk.engine import ENGINE, PymunkSession
from sim.pymunk.space import SpaceModel, build
from sim.remedies import remedies
from sim.run import run
from sim.settings import resolved

SEGMENTS = 6
NO_BIAS = 1.0


def chain_of(name: str, count: int = SEGMENTS) -> tuple[Scene, State]:
    own = SegmentedScene(load_scene(name), count)
    return own.rigid, segment_start(own, "straight")


def start_of(name: str) -> tuple[Scene, State]:
    if load_scene(name).elastic:
        return chain_of(name)
    return load_scene(name), solve(load_scene(name), np.zeros(1)).state()


def speeds(model: SpaceModel) -> float:
    """The largest speed at which a pin comes apart."""
    pins = [joint for joint in model.hinges.values() if isinstance(joint, pymunk.PivotJoint)]
    return max(
        abs(
            joint.a.velocity_at_local_point(joint.anchor_a)
            - joint.b.velocity_at_local_point(joint.anchor_b)
        )
        for joint in pins
    )


def left_after(iterations: int, scene: Scene, state: State) -> float:
    """Of bodies that are pushed, in one step without a bias."""
    model = build(scene, state)
    model.space.iterations, model.space.gravity = iterations, (0.0, 0.0)
    for joint in model.space.constraints:
        joint.error_bias = NO_BIAS
    for k, body in enumerate(model.bodies.values()):
        if body.body_type == pymunk.Body.DYNAMIC:
            body.velocity += (math.sin(k), math.cos(3.0 * k))
    model.space.step(1e-9)
    return speeds(model)


@pytest.mark.parametrize(
    "name", ["fourbar-elastic", "slider-crank-elastic", "sixbar-elastic", "shaper", "toggle-press"]
)
def test_chipmunk_s_iterations_leave_the_share_that_is_told(name: str) -> None:
    scene, state = start_of(name)
    told = left_over(build(scene, state))
    count = round(-4.0 / math.log(told))  # others have died off
    measured = (left_after(2 * count, scene, state) / left_after(count, scene, state)) ** (
        1.0 / count
    )
    assert math.log(measured) == pytest.approx(math.log(told), rel=0.02)


SLEEVES = """
name = "two-sleeves"
source = "Two sleeves on a slotted lever; the data are ours"

[ground]
points = { A = [0.0, 0.3], C = [0.0, 0.0] }

[links]
crank = { bar = ["A", "B"], length_m = 0.1 }
lever = { bar = ["C", "E"], length_m = 0.6 }

[sliders]
B = { on = "lever", mass_kg = 1.0, inertia_kg_m2 = 0.01 }
sleeve = { point = "P", on = "lever", mass_kg = 1.0, inertia_kg_m2 = 0.001 }
P = { on = "ground", through_m = [0.0, 0.5], mass_kg = 0.5 }

[driver]
link = "crank"
speed_rad_s = 10.0
start_deg = 0.0

[branch]
B = 1
"""


def test_the_share_is_that_of_the_joints_in_the_order_of_the_space() -> None:
    """The line and the gear of each slider by turns: all lines first would leave 0.3 % more."""
    scene = parse_scene(SLEEVES, "here")
    state = solve(scene, np.zeros(1)).state()
    told, count = left_over(build(scene, state)), 100
    measured = left_after(2 * count, scene, state) / left_after(count, scene, state)
    assert math.log(measured) / count == pytest.approx(math.log(told), rel=1e-4)


def test_the_iterations_grow_with_the_square_of_the_segments() -> None:
    few, many = (
        chain_iterations(build(scene, state))
        for scene, state in (chain_of("fourbar-elastic", count) for count in (8, 16))
    )
    assert many == pytest.approx(4.0 * few, rel=0.02)


@pytest.mark.parametrize(("halvings", "holds"), [(0.85, False), (1.15, True)])
def test_a_chain_holds_from_one_halving_on(
    halvings: float, holds: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The position of the start is the worst of the turn here, but for 7 %."""
    monkeypatch.setattr(convergence, "HALVINGS", halvings)
    done = ran("fourbar-elastic", iterations=1)
    opened = max(float(gap.max()) for gap in done.gaps.values())
    assert (done.status == "ok" and opened < 1e-5) == holds


def ran(name: str, *, iterations: int, error_bias: float = 0.0) -> Run:
    scene, state = start_of(name)
    settings = {"iterations": iterations, "error_bias": error_bias}
    dt_s = scene.driver.law.period_s / 1440
    return run(scene, state, "pymunk", dt_s=dt_s, steps=720, settings=settings)


def test_a_chain_is_given_what_it_needs_and_a_run_tells_both_numbers() -> None:
    scene, state = chain_of("fourbar-elastic")
    needed = chain_iterations(build(scene, state))
    done = ran("fourbar-elastic", iterations=10)
    assert (done.settings["iterations"], done.settings["iterations_of_segments"]) == (10, needed)
    assert needed == pytest.approx(HALVINGS * 18.0, rel=0.1)


@pytest.mark.parametrize(("name", "asked"), [
    ("shaper", {"iterations": 10}),  # no chain
    ("fourbar-elastic", {"iterations": 400}),  # enough of them
    ("fourbar-elastic", {"iterations": 10, "error_bias": 0.5}),  # mends little at a time
])  # fmt: skip
def test_all_else_has_the_iterations_that_were_asked_for(
    name: str, asked: dict[str, float]
) -> None:
    scene, state = start_of(name)
    settings = {"iterations": int(asked["iterations"]), **asked}
    dt_s = scene.driver.law.period_s / 1440
    done = run(scene, state, "pymunk", dt_s=dt_s, steps=8, settings=settings)
    assert done.settings["iterations"] == asked["iterations"]
    assert "iterations_of_segments" not in done.settings


def test_a_chain_that_needs_too_many_is_unsupported_with_the_number(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(convergence, "MOST", 50)
    scene, state = chain_of("fourbar-elastic")
    settings = {"iterations": 1, "error_bias": 0.0}
    with pytest.raises(EngineError, match=r"need \d+ iterations .* 50 are done at most.* fewer"):
        iterations(scene, settings, build(scene, state))
    done = ran("fourbar-elastic", iterations=1)
    assert done.status == "unsupported"
    assert "need" in done.reason
    assert ran("fourbar-elastic", iterations=100).status == "ok"


def test_the_remedies_of_a_chain_are_more_than_it_has_anyway() -> None:
    scene, state = chain_of("slider-crank-elastic", 16)
    settings = {"iterations": 150, "error_bias": 0.0}
    held = iterations(scene, settings, build(scene, state))
    assert held > 1000
    assert [remedy["iterations"] for remedy in remedies("pymunk", scene, state, settings)] == [
        2 * held,
        5 * held,
    ]


def test_the_remedies_of_a_chain_with_a_bias_are_those_of_any_scene() -> None:
    scene, state = chain_of("slider-crank-elastic", 16)
    settings = {"iterations": 10, "error_bias": 0.0018}
    found = [remedy["iterations"] for remedy in remedies("pymunk", scene, state, settings)]
    assert found == [300, 700, 2000]


@pytest.mark.parametrize(("asked", "found"), [(150, []), (300_000, [600_000])])
def test_a_chain_has_no_remedy_that_can_not_be_run(
    asked: int, found: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(convergence, "MOST", 500)
    scene, state = chain_of("slider-crank-elastic", 16)
    settings = {"iterations": asked, "error_bias": 0.0}
    assert [one["iterations"] for one in remedies("pymunk", scene, state, settings)] == found


def opened(scene: Scene, state: State, **settings: float) -> PymunkSession:
    profile = resolved(ENGINE.profiles["tuned"], settings)
    return PymunkSession(scene, state, profile, 1e-3, "prescribed")


@pytest.mark.parametrize("name", ["shaper", "fourbar-elastic"])
@pytest.mark.parametrize("found", [3, 160])
def test_a_space_tells_the_iterations_that_it_has(name: str, found: int) -> None:
    session = opened(*start_of(name))
    session._space.iterations = found
    told = session.facts().settings
    assert told["iterations"] == found
    assert "iterations_of_segments" not in told
