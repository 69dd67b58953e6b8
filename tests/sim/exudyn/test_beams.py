"""exudyn's own beams: sag, first frequency, stretch, angles that count turns, what is refused."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.elastic.node_start import node_start
from analytic.elastic.segment_start import segment_start
from models.beamed import BeamedScene
from models.elastic import Shape
from models.errors import EngineError
from models.files import load_scene
from models.laws import ConstantSpeed, Oscillating
from models.motion import Motion
from models.scene import Scene
from models.segmented import SegmentedScene
from models.springs import PinSpring
from sim.engine import Run
from sim.exudyn import session
from sim.exudyn.engine import ENGINE
from sim.run import run
from tests.worlds import runs
from tests.worlds.runs import acted_on, driven_by, opened
from tests.worlds.tiers import slowly


def still(*, start_rad: float = 0.0, **changes: float) -> Scene:
    """The rod of the slider-crank, level, driven so slowly that it lies still; its end slides."""
    scene = load_scene("slider-crank-elastic")
    rod = replace(scene.elastic["rod"], **changes)
    law = ConstantSpeed(start_rad, 1e-4)
    return replace(scene, driver=replace(scene.driver, law=law), elastic={"rod": rod})


def ran(
    scene: Scene, count: int, start: Shape, dt_s: float, steps: int, profile: str = "tuned"
) -> tuple[Motion, Run]:
    own, given = BeamedScene(scene, count), {"dt_s": dt_s, "steps": steps}
    done = runs.ran(own.given, ENGINE, profile, start=node_start(own, start), **given)
    return own.folded(done.motion), done


def numbers(scene: Scene) -> tuple[float, float]:
    """Sag in the middle under its own weight [m], and the first angular frequency [rad/s]."""
    rod, own = scene.elastic["rod"], scene.links["rod"]
    length = math.dist(*own.points.values())
    density = own.mass_kg / length
    sag = 5.0 * density * 9.81 * length**4 / (384.0 * rod.flexural_n_m2)
    return sag, rod.bending_rad_s(length, density)


@pytest.mark.parametrize("count", [2, 5, slowly(8, reason="as five")])
def test_a_straight_rod_swings_about_its_sag_with_its_first_frequency(count: int) -> None:
    """Its middle: -sag and, of the modes of an even load, those that ring."""
    scene = still()
    sag, omega = numbers(scene)
    steps, period = 1500, math.tau / omega
    motion, _ = ran(scene, count, "straight", 1.5 * period / steps, steps)
    time_s, middle = motion.time_s, motion.elastic["rod"].middle
    modes = np.stack([np.ones_like(time_s), *(np.cos(k**2 * omega * time_s) for k in (1, 3))])
    shares, *_ = np.linalg.lstsq(modes.T, middle, rcond=None)
    first = 4.0 * 384.0 / (5.0 * math.pi**5)  # of the sag, of sin(pi x / l)
    assert shares[0] == pytest.approx(-sag, rel=1e-3 if count > 2 else 5e-3)
    assert shares[1] == pytest.approx(first * sag, rel=3e-3 if count > 2 else 1e-2)
    assert np.abs(middle - shares @ modes).max() < (0.02 if count > 2 else 0.06) * sag


def test_a_pulled_rod_is_longer_by_what_hangs_on_it() -> None:
    """Crank and rod hang straight down, the slider on them."""
    scene = load_scene("slider-crank-elastic")
    rod = replace(scene.elastic["rod"], axial_n=2e3)
    slider = replace(scene.sliders["C"], direction_rad=-0.5 * math.pi)
    law = ConstantSpeed(-0.5 * math.pi, 1e-4)
    scene = replace(
        scene, driver=replace(scene.driver, law=law), sliders={"C": slider}, elastic={"rod": rod}
    )
    motion, _ = ran(scene, 4, "quasi-static", 1e-3, 50)
    hung = 9.81 * (slider.mass_kg + 0.5 * scene.links["rod"].mass_kg) * 0.6 / 2e3
    assert motion.elastic["rod"].extension == pytest.approx(hung, rel=1e-4)


def test_rounding_sets_how_far_newton_goes() -> None:
    scene = load_scene("fourbar-elastic")
    period = scene.driver.law.period_s
    _, done = ran(scene, 8, "straight", period / 720, 20)
    assert done.settings["absolute_tolerance"] == 1e-10
    assert 1e-8 < done.settings["absolute_tolerance_used"] < 1e-5
    _, shipped = ran(scene, 2, "straight", period / 720, 1, "as-shipped")
    assert "absolute_tolerance_used" not in shipped.settings


def test_rounding_of_beams_is_told_where_there_are_beams_alone() -> None:
    scene = load_scene("fourbar-elastic")
    _, done = ran(scene, 4, "straight", 1e-3, 5)
    assert done.settings["beam_rounding"] == 16.0
    chain = SegmentedScene(scene, 4)
    rigid = run(chain.given, segment_start(chain, "straight"), ENGINE, dt_s=1e-4, steps=5)
    assert "beam_rounding" not in rigid.settings


def test_a_link_counts_its_turns_from_stretch_to_stretch() -> None:
    """A coupler at half a turn, whose tangents pass from pi to -pi."""
    scene = load_scene("fourbar-elastic")
    ground = {"A": (0.0, 0.0), "D": (-1.0, 0.0)}
    mirrored = replace(scene, ground=ground, branch={"C": -1})
    own = BeamedScene(mirrored, 8)
    state = node_start(own, "quasi-static")
    period = scene.driver.law.period_s
    done = run(own.given, state, ENGINE, dt_s=period / 360, steps=720)
    theta = own.folded(done.motion).links["coupler"].theta
    assert np.abs(np.diff(theta)).max() < 0.1
    angle = done.motion.links["coupler-node-8"].theta
    assert angle[0] == pytest.approx(state.theta["coupler-node-8"], abs=1e-12)
    assert np.abs(np.diff(angle)).max() < 0.1


def test_a_link_counts_its_turns_however_seldom_it_is_logged() -> None:
    """A rocker that goes round with its crank, by more than half a turn from sample to sample."""
    scene = load_scene("fourbar-elastic")
    bar = replace(scene.links["crank"], points={"A": (0.0, 0.0), "B": (0.8, 0.0)})
    links, elastic = {**scene.links, "crank": bar}, {"rocker": scene.elastic["coupler"]}
    ground = {"A": (0.0, 0.0), "D": (0.2, 0.0)}
    round_ = replace(scene, ground=ground, links=links, elastic=elastic)
    own = BeamedScene(round_, 4)
    state = node_start(own, "quasi-static")
    period = round_.driver.law.period_s
    ends = []
    for every in (10, 240):
        done = run(own.given, state, ENGINE, dt_s=period / 360, steps=720, every=every)
        ends.append(done.motion.links["rocker-node-4"].theta[-1])
    turned = ends[0] - state.theta["rocker-node-4"]
    assert turned == pytest.approx(2.0 * math.tau, abs=1e-2)
    assert ends[1] == pytest.approx(ends[0], abs=1e-9)


def test_reading_a_state_changes_nothing() -> None:
    scene = load_scene("fourbar-elastic")
    own = BeamedScene(scene, 4)
    reading = opened(own.given, ENGINE, start=node_start(own, "straight"), dt_s=1e-3)
    first, second = (reading.read().bodies["coupler-node-4"].theta[0] for _ in range(2))
    assert first == second


def test_a_spring_that_turns_a_beam_is_refused() -> None:
    scene = load_scene("fourbar-elastic")
    spring = PinSpring("pin", 1.0, 0.0, 0.0, "C", ("rocker", "coupler"))
    own = BeamedScene(acted_on(scene, spring), 4)
    start = node_start(BeamedScene(scene, 4), "straight")
    done = runs.ran(own.given, ENGINE, start=start, dt_s=1e-3, steps=10, well=False)
    assert done.status == "unsupported"
    assert "coupler-node-4: something turns it" in done.reason


@pytest.mark.parametrize("key", ["flexural_n_m2", "axial_n", "damping_s", "density_kg_m"])
def test_a_beam_that_is_not_that_of_the_scene_is_refused(
    key: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = BeamedScene(load_scene("fourbar-elastic"), 2)
    held = session.held_beams
    monkeypatch.setattr(
        session,
        "held_beams",
        lambda *args: {
            name: tuple(replace(one, **{key: getattr(one, key) * 1.001 + 1e-9}) for one in beam)
            for name, beam in held(*args).items()
        },
    )
    with pytest.raises(EngineError, match=f"element 1 of coupler has {key}"):
        run(own.given, node_start(own, "straight"), ENGINE, dt_s=1e-3, steps=10)


@pytest.mark.parametrize("beams", [True, False])
def test_a_crank_that_speeds_up_starts_links_that_bend_with_their_own_accelerations(
    *, beams: bool
) -> None:
    """What the constraints leave free follows by its inertia, and not in the shortest way."""
    scene = driven_by(Oscillating(1.57, 0.6, 7.4, 0.4), "fourbar-elastic")
    own = BeamedScene(scene, 8) if beams else SegmentedScene(scene, 4)
    state = node_start(own, "quasi-static") if beams else segment_start(own, "periodic")
    first = opened(own.given, ENGINE, start=state, dt_s=1e-3).facts().start.bodies
    scale = max(abs(alpha) for alpha in state.alpha.values())
    for name, alpha in state.alpha.items():
        assert first[name].alpha[0] == pytest.approx(alpha, abs=1e-2 * scale)
