"""The joints of the pymunk space, how many iterations they need, and the springs of a chain."""

from dataclasses import replace

import numpy as np
import pymunk
import pytest

from analytic.elastic.engine_start import segment_start
from models.errors import EngineError
from models.files.reading import load_scene, parse_scene
from models.motion import State
from models.scene import GROUND, Scene
from models.scene.cut_scenes import SegmentedScene
from models.scene.loads import LineSpring, PinSpring, Spring
from sim.engine import Run
from sim.pymunk import acting, convergence
from sim.pymunk.bodies import chain_springs
from sim.pymunk.convergence import HALVINGS, chain_iterations, iterations
from sim.pymunk.space import build
from sim.registry.offers import remedies
from sim.run import run
from tests.worlds.runs import ran, start_of


def test_joints_follow_from_what_slides_on_what() -> None:
    def made(name: str, **given: bool) -> list[str]:
        scene = load_scene(name)
        constraints = build(scene, start_of(scene), **given).space.constraints
        return sorted(type(constraint).__name__ for constraint in constraints)

    assert made("slider-crank-excel-350", exact_lines=False) == ["GrooveJoint", "PivotJoint"]
    assert made("slider-crank-excel-350") == ["PinJoint", "PivotJoint"]
    assert made("slider-crank-offset") == ["GrooveJoint", "PivotJoint", "PivotJoint"]
    assert made("slotted-lever") == ["GrooveJoint", "PivotJoint"]
    assert made("scotch-yoke") == ["GearJoint", "GrooveJoint", "GrooveJoint", "PivotJoint"]


DIE = """
name = "die"
source = "test"
ground = { points = { A = [0.0, 0.0], C = [0.0, -0.3] } }
sliders = { B = { on = "lever", link = "die", direction_deg = 20.0, angle_deg = 320.0 } }
driver = { link = "crank", speed_rad_s = 10.0 }
[links]
crank = { bar = ["A", "B"], length_m = 0.1 }
lever = { bar = ["C", "E"], length_m = 0.5 }
die = { bar = ["B", "F"], length_m = 0.05 }
"""


def test_a_gear_holds_a_sliding_link_where_it_starts_whole_turns_or_not() -> None:
    """The angles of links, and of a line and a link on it, are counted each for itself."""
    scene = parse_scene(DIE, "test")
    for time_s in np.linspace(0.0, scene.driver.law.period_s, 7):
        model = build(scene, start_of(scene, float(time_s)))
        (gear,) = (c for c in model.space.constraints if isinstance(c, pymunk.GearJoint))
        assert gear.b.angle - gear.a.angle - gear.phase == pytest.approx(0.0, abs=1e-12)


def chain_of(name: str, count: int = 6) -> tuple[Scene, State]:
    own = SegmentedScene(load_scene(name), count)
    return own.rigid, segment_start(own, "straight")


def placed(name: str) -> tuple[Scene, State]:
    scene = load_scene(name)
    return chain_of(name) if scene.elastic else (scene, start_of(scene))


def ended(name: str, iterations: int, *, error_bias: float = 0.0, steps: int = 720) -> Run:
    scene, state = placed(name)
    settings = {"iterations": iterations, "error_bias": error_bias}
    dt_s = scene.driver.law.period_s / 1440
    return run(scene, state, "pymunk", dt_s=dt_s, steps=steps, settings=settings)


def test_a_chain_is_given_what_it_needs_and_a_run_tells_both_numbers() -> None:
    scene, state = chain_of("fourbar-elastic")
    needed = chain_iterations(build(scene, state))
    done = ended("fourbar-elastic", 10)
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
    scene, start = placed(name)
    done = ran(scene, "pymunk", per_turn=1440, start=start, steps=8, settings=asked)
    assert done.settings["iterations"] == asked["iterations"]
    assert "iterations_of_segments" not in done.settings


def test_a_chain_that_needs_too_many_is_unsupported_with_the_number(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(convergence, "MOST", 50)
    scene, state = chain_of("fourbar-elastic")
    settings = {"iterations": 1, "error_bias": 0.0}
    with pytest.raises(EngineError, match=r"need \d+ iterations .* 50 are done at most.* fewer"):
        iterations(settings, build(scene, state))
    done = ended("fourbar-elastic", 1)
    assert done.status == "unsupported"
    assert "need" in done.reason
    assert ended("fourbar-elastic", 100).status == "ok"


def offered(asked: int, error_bias: float = 0.0) -> list[object]:
    """The iterations of the remedies of a long chain."""
    scene, state = chain_of("slider-crank-elastic", 16)
    settings = {"iterations": asked, "error_bias": error_bias}
    return [remedy["iterations"] for remedy in remedies("pymunk", scene, state, settings)]


def test_the_remedies_of_a_chain_are_more_than_it_has_and_can_be_run(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    scene, state = chain_of("slider-crank-elastic", 16)
    held = iterations({"iterations": 150, "error_bias": 0.0}, build(scene, state))
    assert held > 1000
    assert offered(150) == [2 * held, 5 * held]
    assert offered(10, 0.0018) == [300, 700, 2000]  # as with any scene, where there is a bias
    monkeypatch.setattr(convergence, "MOST", 500)
    assert offered(150) == []
    assert offered(300_000) == [600_000]


def chain() -> tuple[Scene, State]:
    """Four damped segments for the coupler of a four-bar, and another spring beside them."""
    scene = load_scene("fourbar-elastic")
    damped = replace(scene.elastic["coupler"], damping_s=1e-3)
    own = SegmentedScene(replace(scene, elastic={"coupler": damped}), 4)
    springs = own.rigid.springs | {"pull": LineSpring("pull", 3.0, 0.1, 0.5, ("A", "C"))}
    return replace(own.rigid, springs=springs), segment_start(own, "straight")


def test_they_move_a_chain_as_springs_one_by_one(monkeypatch: pytest.MonkeyPatch) -> None:
    scene, start = chain()
    own = ran(scene, "pymunk", start=start, steps=200)
    monkeypatch.setattr(acting.bodies, "chain_springs", lambda scene: ())
    other = ran(scene, "pymunk", start=start, steps=200)
    for name, link in own.motion.links.items():
        theirs = other.motion.links[name]
        np.testing.assert_allclose(link.theta, theirs.theta, rtol=0.0, atol=1e-12)
        np.testing.assert_allclose(link.omega, theirs.omega, rtol=0.0, atol=1e-10)


def in_pins(**bodies: tuple[str, str]) -> dict[str, Spring]:
    """Springs of a user in the pins of these names."""
    return {pin: PinSpring(pin, 1.0, 0.01, 0.3, pin, pair) for pin, pair in bodies.items()}


def test_chains_alone_have_springs_of_their_own_and_users_springs_act_beside_them() -> None:
    scene = load_scene("fourbar-elastic")
    own = SegmentedScene(replace(scene, springs=in_pins(D=(GROUND, "rocker"))), 4)
    assert len(chain_springs(own.rigid)) == 3
    done = ran(own.rigid, "pymunk", start=segment_start(own, "straight"), steps=200)
    assert max(float(gap.max()) for gap in done.gaps.values()) < 1e-5
    assert len(chain_springs(chain()[0])) == 3
    assert chain_springs(load_scene("slider-crank-spring")) == ()
    of_links = in_pins(B=("crank", "coupler"), C=("coupler", "rocker"))
    assert chain_springs(replace(load_scene("fourbar-lecture-1"), springs=of_links)) == ()
