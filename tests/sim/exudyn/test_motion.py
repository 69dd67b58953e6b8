"""Motions in exudyn: of what is free, with springs, motors and jumps, all of second order; and of
its own beams: sag, first frequency, stretch, angles that count turns, what is refused.
"""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from analytic.elastic.engine_start import node_start, segment_start
from analytic.free.release import release
from models.array import Array
from models.errors import EngineError
from models.files.reading import load_scene
from models.motion import Motion
from models.scene import GROUND, Driver, Scene
from models.scene.characteristics import Characteristic, Polynomial, Staircase
from models.scene.cut_scenes import BeamedScene, SegmentedScene
from models.scene.driver import Released
from models.scene.elastic import Shape
from models.scene.laws import ConstantSpeed, Oscillating
from models.scene.loads import LineSpring, Load, Over, PinSpring, SlideSpring, Spring
from sim.engine import Run, Settings
from sim.exudyn import system
from sim.exudyn.engine import ENGINE
from sim.run import run
from tests.worlds import runs
from tests.worlds.let_go import released
from tests.worlds.runs import acted_on, driven_by, opened

UNTIL_S = 0.4


def let_go(name: str, start_rad: float, speed_rad_s: float = 0.0, *acting: Spring | Load) -> Scene:
    """A shipped scene with its driver free, in gravity, with what acts on it."""
    scene = load_scene(name)
    driver = Driver(scene.driver.link, Released(start_rad, speed_rad_s, UNTIL_S))
    return acted_on(replace(scene, driver=driver, gravity_m_s2=(0.0, -9.81)), *acting)


def torque(characteristic: Characteristic, over: Over = "time") -> Load:
    return Load("torque", "crank", None, characteristic, over)


SCENES = {
    "gravity": let_go("fourbar-lecture-1", 0.3),
    "springs": let_go(
        "fourbar-lecture-1", 0.3, 2.0, LineSpring("line", 50.0, 0.5, 0.1, ("B", "D")),
        LineSpring("slack at nothing", 20.0, 0.1, 0.0, ("A", "C")),
        PinSpring("knee", 0.3, 0.01, 0.5, "C", ("coupler", "rocker")),
        PinSpring("wound", 0.1, 0.0, 7.0, "A", (GROUND, "crank"))),
    "spring of a block without mass": let_go(
        "slider-crank-excel-210", 0.5, 1.0, SlideSpring("line", 300.0, 5.0, 2.0, "C")),
    "spring of a moving line": let_go(
        "slotted-lever", 0.5, 1.0, SlideSpring("line", 300.0, 5.0, 0.2, "B")),
    "jumps": let_go(
        "fourbar-lecture-1", -1.2, 0.0,
        torque(Staircase((-1.0, 0.0, 0.05, 0.0503, 0.25), (0.1, 0.3, 0.8, -0.5, 0.0)))),
    "motor": let_go("fourbar-lecture-1", 0.3, 1.0, torque(Polynomial((2.0, -0.2)), "omega")),
    "steep motor": let_go(
        "fourbar-lecture-1", 0.3, 10.0, torque(Polynomial((30.0, -3.0)), "omega")),
}  # fmt: skip


@cache
def exact(name: str) -> Array:
    """The driver's angle at 41 instants."""
    scene, samples = SCENES[name], np.linspace(0.0, UNTIL_S, 41)
    return release(scene, UNTIL_S).at(samples, bound=False).links[scene.driver.link].theta


def ran(scene: Scene, dt_s: float, settings: Settings | None = None) -> Run:
    steps = round(UNTIL_S / dt_s)
    given = {"dt_s": dt_s, "steps": steps, "every": steps // 40, "settings": settings}
    return runs.ran(scene, ENGINE, start=released(scene)[0], drive="free", **given)


@pytest.mark.parametrize("name", ["spring of a moving line", "jumps", "motor"])
def test_whatever_acts_the_motion_is_of_second_order(name: str) -> None:
    scene, errors = SCENES[name], []
    for dt_s in (2e-3, 5e-4):
        theta = ran(scene, dt_s).motion.links[scene.driver.link].theta
        errors.append(float(np.abs(theta - exact(name)).max()))
    coarse, fine = errors
    assert fine < 5e-3
    assert 11.0 < coarse / fine < 22.0


def test_the_start_has_the_accelerations_of_what_acts_and_settings_show_a_steep_motor() -> None:
    for name in ("springs", "steep motor", "spring of a block without mass"):
        scene = SCENES[name]
        done = ran(scene, 2e-3)
        for link, alpha in released(scene)[0].alpha.items():
            scale = max(abs(each) for each in released(scene)[0].alpha.values())
            assert done.motion.links[link].alpha[0] == pytest.approx(alpha, abs=1e-6 * scale)
    assert "loads_jacobian_used" not in ran(SCENES["springs"], 2e-3).settings
    assert ran(SCENES["steep motor"], 2e-3).settings["loads_jacobian_used"] == "enable"


def test_what_damps_is_less_where_nothing_drives_and_loses_less_energy() -> None:
    scene, lost = SCENES["gravity"], []
    for radius in (0.9, 0.4):
        done = ran(scene, 1e-3, {"free_spectral_radius": radius})
        assert done.settings["spectral_radius"] == radius
        swing = np.ptp(done.energy.potential_j)
        lost.append(abs(done.energy.total_j[-1] - done.energy.total_j[0]) / swing)
    assert ENGINE.profiles["tuned"].settings["free_spectral_radius"].value == 0.9
    assert lost[0] < 0.2 * lost[1] < 1e-3


def test_the_spring_of_a_block_without_mass_goes_to_its_pin() -> None:
    scene = SCENES["spring of a block without mass"]
    given = {"dt_s": 1e-3, "steps": 60, "drive": "free", "with_forces": True}
    done = runs.ran(scene, ENGINE, start=released(scene)[0], **given)
    forces, slid = done.motion.forces, done.motion.sliders["C"]
    (line,) = (one for one in scene.springs.values() if isinstance(one, SlideSpring))
    pull = line.rate * (slid.displacement - line.free) + line.damping * slid.speed
    angle = scene.sliders["C"].direction_rad
    along, across = np.array(
        [[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]]
    )
    left = forces.pins["C"]["block C"] + forces.sliders["C"].normal[:, None] * across
    np.testing.assert_allclose(left, pull[:, None] * along, atol=1e-9 * np.abs(pull).max())


def bent(
    scene: Scene, count: int, start: Shape, dt_s: float, steps: int, profile: str = "tuned"
) -> tuple[Motion, Run]:
    own, given = BeamedScene(scene, count), {"dt_s": dt_s, "steps": steps}
    done = runs.ran(own.given, ENGINE, profile, start=node_start(own, start), **given)
    return own.folded(done.motion), done


def test_a_straight_rod_swings_about_its_sag_with_its_first_frequency() -> None:
    """Its middle: -sag by its weight and, of the modes of an even load, those that ring. It lies
    level and is driven so slowly that it lies still; its end slides."""
    scene = load_scene("slider-crank-elastic")
    scene = replace(scene, driver=replace(scene.driver, law=ConstantSpeed(0.0, 1e-4)))
    rod, own = scene.elastic["rod"], scene.links["rod"]
    length = math.dist(*own.points.values())
    density = own.mass_kg / length
    sag = 5.0 * density * 9.81 * length**4 / (384.0 * rod.flexural_n_m2)
    omega = rod.bending_rad_s(length, density)
    steps, period = 1500, math.tau / omega
    motion, _ = bent(scene, 5, "straight", 1.5 * period / steps, steps)
    time_s, middle = motion.time_s, motion.elastic["rod"].middle
    modes = np.stack([np.ones_like(time_s), *(np.cos(k**2 * omega * time_s) for k in (1, 3))])
    shares, *_ = np.linalg.lstsq(modes.T, middle, rcond=None)
    first = 4.0 * 384.0 / (5.0 * math.pi**5)  # of the sag, of sin(pi x / l)
    assert shares[0] == pytest.approx(-sag, rel=1e-3)
    assert shares[1] == pytest.approx(first * sag, rel=3e-3)
    assert np.abs(middle - shares @ modes).max() < 0.02 * sag


def test_a_pulled_rod_is_longer_by_what_hangs_on_it() -> None:
    """Crank and rod hang straight down, the slider on them."""
    scene = load_scene("slider-crank-elastic")
    rod = replace(scene.elastic["rod"], axial_n=2e3)
    slider = replace(scene.sliders["C"], direction_rad=-0.5 * math.pi)
    law = ConstantSpeed(-0.5 * math.pi, 1e-4)
    scene = replace(
        scene, driver=replace(scene.driver, law=law), sliders={"C": slider}, elastic={"rod": rod}
    )
    motion, _ = bent(scene, 4, "quasi-static", 1e-3, 50)
    hung = 9.81 * (slider.mass_kg + 0.5 * scene.links["rod"].mass_kg) * 0.6 / 2e3
    assert motion.elastic["rod"].extension == pytest.approx(hung, rel=1e-4)


def test_rounding_of_beams_sets_how_far_newton_goes() -> None:
    scene = load_scene("fourbar-elastic")
    period = scene.driver.law.period_s
    _, done = bent(scene, 8, "straight", period / 720, 20)
    assert done.settings["absolute_tolerance"] == 1e-10
    assert 1e-8 < done.settings["absolute_tolerance_used"] < 1e-5
    assert done.settings["beam_rounding"] == 16.0
    chain = SegmentedScene(scene, 4)
    rigid = run(chain.given, segment_start(chain, "straight"), ENGINE, dt_s=1e-4, steps=5)
    assert "beam_rounding" not in rigid.settings
    _, shipped = bent(scene, 2, "straight", period / 720, 1, "as-shipped")
    assert "absolute_tolerance_used" not in shipped.settings


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
    assert "coupler-node-4: a moment acts on it" in done.reason


@pytest.mark.parametrize("key", ["flexural_n_m2", "axial_n", "damping_s", "density_kg_m"])
def test_a_beam_that_is_not_that_of_the_scene_is_refused(
    key: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = BeamedScene(load_scene("fourbar-elastic"), 2)
    held = system.held_beams
    monkeypatch.setattr(
        system,
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
