"""A scene, drawn as a model in any way, is read off it again: lengths, masses, and the verdict."""

import cmath
import itertools
import math
import random
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from analytic.kinematics import solve
from models.errors import EngineError
from models.files.reading import load_scene, shipped
from models.mjcf.document import build
from models.motion import State
from models.scene import Driver, Scene
from models.scene.laws import ConstantSpeed
from reports.judge.cell import Cell, check
from reports.own_model.assembly import ModelRequest, assembled
from sim.mujoco.own_model.file import ModelError
from sim.mujoco.own_model.read_model import read_model
from sim.mujoco.own_model.variants import advice, patched
from sim.registry.own_models import Advised
from tests.worlds.drawn_model import HALF, UPRIGHT, Drawing, drawn, rotation
from tests.worlds.own_four_bar import planted
from tests.worlds.own_models import line, read_text
from tests.worlds.strategies import Designed, mechanisms
from tests.worlds.tiers import few, slowly

SAME = 1e-12
TILTED = rotation(random.Random(5))
DRAWINGS = {
    "as laid out": Drawing(),
    "far away": Drawing(turn=TILTED, shift_m=(300.0, -200.0, 100.0)),
    "frames, order and axes anyhow": Drawing(turn=TILTED, askew=3),
    "closed between bodies, anyhow": Drawing(turn=UPRIGHT, askew=2, sites=False),
    "all bodies free, anyhow": Drawing(turn=TILTED, askew=4, free=True),
    "balanced": Drawing(free=True, balanced=True),
    "another zero, in degrees": Drawing(degrees=True, reads=1.0),
}
"""All that may be done to every four-bar and slider-crank."""


def start_of(scene: Scene) -> State:
    return solve(scene, np.zeros(1), bound=False).state()


def joint_of(scene: Scene) -> str:
    return f"{scene.driver.link}.{scene.driver_pivot}"


def read_back(folder: Path, scene: Scene, drawing: Drawing | None = None) -> Scene:
    """What a drawing of a scene, or its export, is read as, held in poses to what MuJoCo makes of
    it."""
    path, start = folder / "model.xml", start_of(scene)
    path.write_text(drawn(scene, start, drawing) if drawing else build(scene, start))
    asked = ModelRequest(path, joint_of(scene), 10.0)
    own = read_model(path, asked.joint)
    back = assembled(own, asked)[0]
    motion = solve(back, np.linspace(0.0, 0.01, 3), bound=False)
    own.tour(back, [motion.state(index) for index in range(3)])
    return back


def assert_same(back: Scene, scene: Scene, size_m: float = 0.0) -> None:
    """Distances between the points of each link that the model has, masses, inertias; and the
    motion that follows from them."""
    scale = max(scene.longest_m, size_m)
    for name, link in scene.links.items():
        own = back.links.get(name) or back.links.get(name + HALF)
        if own is None:  # a sliding link with one point, where its mass is: a block
            slider = next(each for key, each in back.sliders.items() if key.endswith(name))
            assert slider.mass_kg == pytest.approx(link.mass_kg, rel=SAME)
            continue
        assert own.mass_kg == pytest.approx(link.mass_kg, rel=SAME)
        assert own.inertia_kg_m2 == pytest.approx(link.inertia_kg_m2, rel=SAME)
        for a, b in itertools.combinations(own.points.keys() & link.points.keys(), 2):
            found = math.dist(own.points[a], own.points[b])
            assert abs(found - math.dist(link.points[a], link.points[b])) < SAME * scale
    assert_moves_alike(back, scene)


def assert_moves_alike(back: Scene, scene: Scene) -> None:
    """The rates of all links and sliders at the start, at one driver speed, are the same."""
    speed = back.driver.law.peak_speed_rad_s
    theta = float(scene.driver.law.at(np.zeros(1))[0][0])
    driver = Driver(scene.driver.link, ConstantSpeed(theta, speed))
    wanted = solve(replace(scene, driver=driver), np.zeros(1), bound=False)
    found = solve(back, np.zeros(1), bound=False)
    for name in scene.links:
        key = name if name in found.links else name + HALF
        if key in found.links:
            omega = float(wanted.links[name].omega[0])
            assert float(found.links[key].omega[0]) == pytest.approx(omega, abs=1e-8 * speed)
    for name, slider in scene.sliders.items():
        for key in {name, f"block-{name}", slider.link or name} & back.sliders.keys():
            if back.sliders[key].on != slider.on:  # the other way about
                continue
            moved = float(wanted.sliders[name].speed[0])
            assert float(found.sliders[key].speed[0]) == pytest.approx(moved, abs=1e-7 * speed)


@pytest.mark.parametrize(
    "name",
    few(
        [*sorted(shipped()), "triad-platform"],
        [*sorted(shipped())[::2], "triad-platform"],
        "the same joints",
    ),
)
def test_each_shipped_scene_is_read_back_off_its_export(name: str, tmp_path: Path) -> None:
    scene = load_scene(name)
    assert_same(read_back(tmp_path, scene), scene)


RANGES = {"fourbar-double-rocker": {"turns": 0.09, "start_deg": 25.0}, "tangent": {"turns": 0.2}}
"""Where the driver of an export swings, a part of a turn is run at constant speed."""
FEW = {"fourbar-double-rocker", "shaper", "sixbar-watt"}


@pytest.mark.parametrize("name", few(sorted(shipped()), FEW, "joints and plates that few have"))
def test_its_verdict_is_that_of_the_scene(name: str, tmp_path: Path) -> None:
    scene = load_scene(name)
    asked = {"speed_rad_s": scene.driver.law.peak_speed_rad_s, **RANGES.get(name, {})}
    text = build(scene, start_of(scene))
    account = read_text(tmp_path, text, joint=joint_of(scene), converge=False, **asked)
    own = line(account, "as-written")
    cell = Cell(scene, "mujoco", "tuned", account.dt_s, account.steps, converge=False)
    assert own.verdict == check(cell).verdict == "within"
    assert own.errors is not None


@pytest.mark.parametrize("drawing", list(DRAWINGS.values()), ids=list(DRAWINGS))
@pytest.mark.parametrize("name", ["fourbar-lecture-2", "slider-crank-offset"])
def test_it_is_read_back_however_it_is_drawn(name: str, drawing: Drawing, tmp_path: Path) -> None:
    scene = load_scene(name)
    size_m = float(np.linalg.norm(drawing.shift_m))
    assert_same(read_back(tmp_path, scene, drawing), scene, size_m)


@pytest.mark.parametrize(
    ("name", "cut"),
    [("fourbar-lecture-1", "coupler"), ("fourbar-lecture-1", "crank"), ("sixbar-watt", "rod")],
)
def test_a_link_a_weld_cuts_is_one(name: str, cut: str, tmp_path: Path) -> None:
    scene, drawing = load_scene(name), Drawing(cut=cut, sites=False, askew=3)
    assert_same(read_back(tmp_path, scene, drawing), scene)


BALL = '<geom type="sphere" size="0.01" pos="{} {} 0"/>'
APART = f"""<mujoco>
  <compiler angle="radian"/>
  <option gravity="0 0 0"/>
  <default>
    <geom type="capsule" size="0.004" contype="0" conaffinity="0"/><joint axis="0 0 1"/>
  </default>
  <worldbody>
    <body name="near" pos="0.5 0.7 0" euler="0 0 0.4">
      <joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/><joint/>
      {BALL.format(0, 0)}<site name="near.C"/>
    </body>
    <body name="crank"><joint name="A"/><geom fromto="0 0 0 0.1 0 0"/>
      <body name="rod" pos="0.1 0 0"><joint name="B"/><geom fromto="0 0 0 0.3 0 0"/>
        <site name="rod.C" pos="0.3 0 0"/>
      </body>
    </body>
    <body name="far" pos="0.4 0 0" euler="0 0 0.3">
      <joint name="S" type="slide" axis="{math.cos(0.3)!r} {-math.sin(0.3)!r} 0"/>
      {BALL.format(-0.1 * math.cos(0.2), 0.1 * math.sin(0.2))}
    </body>
  </worldbody>
  <equality><connect site1="rod.C" site2="near.C"/>{{}}</equality>
</mujoco>
"""
"""A slider-crank whose sliding link is two bodies, drawn apart, with the slide on the second one;
what a weld asks for is that ``far`` is 0.1 m ahead of ``near``, turned by 0.2 rad."""


@pytest.mark.parametrize("turned_round", [False, True])
def test_bodies_that_a_weld_has_to_pull_together_are_one_link(
    turned_round: bool, tmp_path: Path
) -> None:
    # In the frame of the first body the pose of the second, either way round.
    place, turn = (-0.1 * cmath.exp(-0.2j), -0.2) if turned_round else (0.1 + 0j, 0.2)
    pose = f"{place.real!r} {place.imag!r} 0 {math.cos(turn / 2)!r} 0 0 {math.sin(turn / 2)!r}"
    first, second = ("far", "near") if turned_round else ("near", "far")
    weld = f'<weld body1="{first}" body2="{second}" relpose="{pose}"/>'
    account = read_text(tmp_path, APART.format(weld), converge=False, turns=0.3)
    (slider,) = account.scene.sliders.values()
    assert slider.mass_kg > 0.0  # both masses are in the pin of a block
    assert math.sin(slider.direction_rad) == pytest.approx(0.0, abs=1e-12)
    assert line(account, "recommended").verdict == "within"


@pytest.mark.parametrize(
    ("kind", "error"),
    [("far away", 2e-6), ("balanced", 5e-6), ("cut", 2e-6)],
)  # fmt: skip
def test_it_runs_as_advised_however_it_is_drawn(kind: str, error: float, tmp_path: Path) -> None:
    scene = load_scene("fourbar-lecture-1")
    drawing = DRAWINGS.get(kind, Drawing(cut="coupler", sites=False))
    text = drawn(scene, start_of(scene), drawing)
    account = read_text(tmp_path, text, joint=joint_of(scene), converge=False, turns=0.5)
    done = line(account, "recommended")
    assert done.verdict == "within", done.failures
    assert done.errors.worst("angle").pure < error


LINES_ONLY = ("RRR", "RPP block on guide")
"""With a link that carries lines and has no pin."""


@pytest.mark.parametrize("examples", [6, slowly(200, reason="rare shapes and drawings")])
def test_any_mechanism_is_read_back_off_any_drawing(
    tmp_path_factory: pytest.TempPathFactory, examples: int
) -> None:
    @settings(max_examples=examples, deadline=None, suppress_health_check=[HealthCheck.too_slow])
    @given(mechanisms() | mechanisms(LINES_ONLY), st.integers(0, 10**6), st.booleans())
    def drawn_anyhow(designed: Designed, seed: int, sites: bool) -> None:
        check_read_back(tmp_path_factory.mktemp("drawn"), designed, seed, sites)

    drawn_anyhow()


def check_read_back(folder: Path, designed: Designed, seed: int, sites: bool) -> None:
    scene, chance = designed.scene, random.Random(seed)
    drawing = Drawing(
        turn=rotation(chance),
        shift_m=tuple(chance.uniform(-3.0, 3.0) for _ in "xyz"),
        askew=seed,
        sites=sites,
        reads=chance.uniform(-1.0, 1.0),
    )
    try:
        back = read_back(folder, scene, drawing)
    except (EngineError, ModelError) as error:
        # Loops that no engine can close without a mass, and links that are all one point.
        assume(not any(words in str(error) for words in ("mass_kg above 0", "have no length")))
        raise
    assert_same(back, scene, size_m=5.0)


def test_the_patched_file_runs_as_the_line_recommended(tmp_path: Path) -> None:
    text = planted('solref="0.005 0.6"', 'solref="0.05 1"')
    account = read_text(tmp_path, text, converge=False, turns=0.3)
    own = read_model(tmp_path / "model.xml", "A")
    advised = advice(own.planar.model, account.dt_s, Advised())
    recommended = line(account, "recommended")  # before the file is another one
    better = patched(text.encode(), [0], 1, advised)
    written = line(read_text(tmp_path, better, converge=False, turns=0.3), "as-written")
    for quantity in ("angle", "gap", "acceleration"):
        assert written.errors.worst(quantity) == recommended.errors.worst(quantity)
