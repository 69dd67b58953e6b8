"""Springs in the pins of a chain, all at once: as one by one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.elastic.segment_start import segment_start
from analytic.kinematics import solve
from models.files import load_scene
from models.motion import State
from models.scene import GROUND, Scene
from models.segmented import SegmentedScene
from models.springs import LineSpring, PinSpring, Spring
from sim.engine import Run
from sim.pymunk import acting
from sim.pymunk.chain_springs import chain_springs
from sim.pymunk.engine import ENGINE
from sim.run import run
from sim.settings import resolved

PULL = LineSpring("pull", 3.0, 0.1, 0.5, ("A", "C"))


def chain(*, damping_s: float = 0.0, beside: bool = False) -> tuple[Scene, State]:
    """Four segments for the coupler of a four-bar; another spring ``beside`` them."""
    scene = load_scene("fourbar-elastic")
    damped = replace(scene.elastic["coupler"], damping_s=damping_s)
    own = SegmentedScene(replace(scene, elastic={"coupler": damped}), 4)
    start = segment_start(own, "straight")
    springs = own.rigid.springs | ({"pull": PULL} if beside else {})
    return replace(own.rigid, springs=springs), start


def ran(scene: Scene, state: State) -> Run:
    dt_s = scene.driver.law.period_s / 720
    return run(scene, state, "pymunk", dt_s=dt_s, steps=200)


@pytest.mark.parametrize("beside", [False, True])
@pytest.mark.parametrize("damping_s", [0.0, 1e-3])
def test_they_move_a_chain_as_springs_one_by_one(
    damping_s: float, beside: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene, state = chain(damping_s=damping_s, beside=beside)
    own = ran(scene, state)
    monkeypatch.setattr(acting, "chain_springs", lambda scene: ())
    other = ran(scene, state)
    for name, link in own.motion.links.items():
        theirs = other.motion.links[name]
        np.testing.assert_allclose(link.theta, theirs.theta, rtol=0.0, atol=1e-12)
        np.testing.assert_allclose(link.omega, theirs.omega, rtol=0.0, atol=1e-10)


@pytest.mark.parametrize("damping_s", [0.0, 1e-3])
def test_a_run_tells_of_each(damping_s: float) -> None:
    scene, state = chain(damping_s=damping_s)
    dt_s = scene.driver.law.period_s / 720
    session = ENGINE.open(scene, state, resolved(ENGINE.profiles["tuned"], {}), dt_s, "prescribed")
    told = session.facts().springs
    assert told == {n: (s.rate, s.damping, s.free) for n, s in scene.springs.items()}


def in_pins(**bodies: tuple[str, str]) -> dict[str, Spring]:
    """Springs of a user in the pins of these names."""
    return {pin: PinSpring(pin, 1.0, 0.01, 0.3, pin, pair) for pin, pair in bodies.items()}


@pytest.mark.parametrize("springs", [
    in_pins(A=(GROUND, "crank"), D=(GROUND, "rocker")),
    in_pins(B=("crank", "coupler"), C=("coupler", "rocker")),
], ids=["in the ground", "of a link"])  # fmt: skip
def test_two_springs_in_pins_of_rigid_links_are_no_chain(springs: dict[str, Spring]) -> None:
    """With a light coupler and a heavy rocker, for which a chain would be given 343 iterations."""
    scene = load_scene("fourbar-lecture-1")
    links = {name: replace(link, mass_kg=0.005) for name, link in scene.links.items()}
    links["rocker"] = replace(links["rocker"], mass_kg=3.0)
    scene = replace(scene, links=links, springs=springs)
    done = ran(scene, solve(scene, np.zeros(1)).state())
    assert done.status == "ok", done.reason
    assert done.settings["iterations"] == 150
    assert "iterations_of_segments" not in done.settings
    assert chain_springs(scene) == ()


def test_a_spring_in_a_ground_pin_acts_beside_a_chain() -> None:
    scene = load_scene("fourbar-elastic")
    own = SegmentedScene(replace(scene, springs=in_pins(D=(GROUND, "rocker"))), 4)
    assert len(chain_springs(own.rigid)) == 3
    done = ran(own.rigid, segment_start(own, "straight"))
    assert done.status == "ok", done.reason
    assert max(float(gap.max()) for gap in done.gaps.values()) < 1e-5


def test_springs_alone_make_no_chain() -> None:
    assert len(chain_springs(chain(beside=True)[0])) == 3
    assert chain_springs(load_scene("slider-crank-spring")) == ()
    assert chain_springs(load_scene("squeezer")) == ()
