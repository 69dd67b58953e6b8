"""Gradients of the reference against differences of the mechanism in fifty digits and more."""

import math
import zlib
from dataclasses import replace

import numpy as np
import pytest

from analytic.forces.kinetostatics import forces
from analytic.gradients.dimensions import dimensions, with_dimensions
from analytic.gradients.gradient import Gradient, gradient, gradient_at, masses
from analytic.kinematics import solve
from models.array import Array
from models.errors import CrankcheckError, ReachError
from models.files.assemble import scene_text
from models.files.reading import load_scene, parse_scene, shipped
from models.scene import Scene
from models.scene.loads import CoulombFriction
from tests.analytic.dyads.test_redundant import parallelogram
from tests.analytic.gradients.differences import differences
from tests.analytic.gradients.drawn import ALL, drawn
from tests.analytic.test_bounds import errors, over
from tests.worlds.strategies import OF_EACH_KIND
from tests.worlds.tiers import at_length, few, slowly

NOTHING = 1e-18
"""Error of the differences themselves, of what is 0."""
SOME = ["sixbar-watt", "shaper", "tangent"]


def shares(found: Gradient, name: str, index: int = 0) -> Array:
    """Errors over bounds of everything that moves, by one dimension (n, 3)."""
    exact, own = differences(found.scene, found.motion, index, name), found.by[name]
    rows = []
    for kind in ("links", "points", "sliders"):
        for key, wanted in getattr(exact, kind).items():
            mine, bound = vars(getattr(own, kind)[key]), vars(getattr(own.bound, kind)[key])
            if kind == "points":
                x, y = ({k: v[:, axis] for k, v in mine.items()} for axis in (0, 1))
                ends = (
                    errors(w, v, index, nothing=NOTHING) for w, v in ((wanted.x, x), (wanted.y, y))
                )
                off = list(map(math.hypot, *ends))
            else:
                off = errors(wanted, mine, index, nothing=NOTHING)
            rows.append(over(off, bound, index))
    return np.array(rows)


@pytest.mark.parametrize("near", [False, True], ids=["anywhere", "near a singular position"])
@pytest.mark.parametrize(
    "count",
    [1, slowly(10, reason="rare shapes"), at_length(250, reason="ten thousand mechanisms")],
)
@pytest.mark.parametrize("form", few(ALL, OF_EACH_KIND, "one of each kind of dyad shows it"))
def test_no_bound_is_broken(form: str, count: int, near: bool) -> None:
    rng = np.random.default_rng([zlib.crc32(form.encode()), near])
    for _ in range(count):
        found = gradient(drawn(form, rng, near=near), np.zeros(1))
        lines = [n for n in found.by if n.endswith((".direction", ".angle"))]
        for name in (*rng.choice(list(found.by), 1), *rng.choice(lines, 1)):
            assert shares(found, str(name)).max() <= 1.0, (name, found.scene)


@pytest.mark.parametrize("name", few(shipped(), SOME, "scenes of the same dyads"))
def test_no_bound_is_broken_in_shipped_scenes_and_bounds_say_something(name: str) -> None:
    scene = load_scene(name)
    found = gradient(scene, np.array([0.1, 0.63]) * scene.driver.law.period_s)
    rng = np.random.default_rng(4)
    for one in rng.choice(list(found.by), 3, replace=False):
        assert shares(found, str(one), 1).max() <= 1.0, one
        largest = [np.abs(m.omega).max() for m in found.by[one].links.values()]
        bounds = [m.omega.max() for m in found.by[one].bound.links.values()]
        assert max(bounds) <= 1e-9 * max(1.0, *largest)


def test_nothing_is_certain_in_a_dead_point_and_names_of_dimensions_are_those_of_links() -> None:
    scene = load_scene("fourbar-lecture-1")
    assert list(dimensions(scene)) == ["ground", "crank", "coupler", "rocker", "driver.angle"]
    scene = with_dimensions(scene, {"ground": 3.0, "crank": 2.0, "coupler": 3.0, "rocker": 2.0})
    start = replace(scene.driver.law, start_rad=0.0)  # all links in line
    scene = replace(scene, driver=replace(scene.driver, law=start))
    bound = gradient(scene, np.zeros(1), "crank").by["crank"].bound
    assert bound.links["rocker"].omega[0] == math.inf
    assert bound.links["crank"].omega[0] == 0.0


def other(scene: Scene, name: str, by: float) -> Scene:
    """A scene with gears or cams, one of its dimensions changed, as its file says it."""
    one = dimensions(scene)[name]
    if name == "driver.angle":
        law = replace(scene.driver.law, start_rad=one.value + by)
        return replace(scene, driver=replace(scene.driver, law=law))
    if name.endswith(".base"):
        pair = scene.cams[name.removesuffix(".base")]
        cam = replace(pair, profile=replace(pair.profile, base_m=one.value + by))
        return parse_scene(scene_text(replace(scene, cams={pair.name: cam})), "test")
    gears = {n: replace(gear, module_m=None) for n, gear in scene.gears.items()}
    made = with_dimensions(replace(scene, cams={}, gears=gears), {name: one.value + by})
    return parse_scene(scene_text(replace(made, cams=scene.cams)), "test")


ASIDE = "cam-roller, its line elsewhere"


@pytest.mark.parametrize(
    "name",
    few(
        [*shipped("gears"), *shipped("cams"), ASIDE],
        ["planetary", "cam-flat", ASIDE],
        "as one of gears, one of cams and one aside",
    ),
)
def test_gears_keep_their_teeth_and_followers_their_law(name: str) -> None:
    """Profiles follow from the dimensions; differences of scenes that are read again."""
    scene, step = load_scene(name.partition(",")[0]), 1e-7
    if name == ASIDE:
        (slider,) = scene.sliders.values()
        line = replace(slider, through_m=(0.007, -0.011))
        scene = parse_scene(scene_text(replace(scene, sliders={slider.name: line})), "test")
    times = np.array([0.31, 0.7, 1.13]) * scene.driver.law.period_s
    found = gradient(scene, times)
    assert found.by
    for one, own in found.by.items():
        ahead, back = (solve(other(scene, one, way * step), times) for way in (1, -1))
        size = 1.0 / scene.longest_m if dimensions(scene)[one].unit == "m" else 1.0
        for kind, unit in (("links", 1.0), ("sliders", scene.longest_m)):
            for body, moved in getattr(own, kind).items():
                pace = np.abs(found.motion.links[scene.driver.link].omega).max() + 1.0
                for n, (level, series) in enumerate(vars(moved).items()):
                    ends = (vars(getattr(m, kind)[body])[level] for m in (ahead, back))
                    wrong = series - np.subtract(*ends) / (2.0 * step)
                    assert np.abs(wrong).max() < 2e-5 * size * unit * pace**n, (one, body, level)


def test_followers_have_a_derivative_with_a_bound_between_the_knots_of_their_law() -> None:
    for name in shipped("cams"):
        scene = load_scene(name)
        found = gradient(scene, np.array([0.31]) * scene.driver.law.period_s, "driver.angle")
        (pair,) = scene.cams.values()
        body = (
            found.by["driver.angle"].bound.sliders.get(pair.slider)
            or (found.by["driver.angle"].bound.links[pair.follower])
        )
        assert all(0.0 < float(each[0]) < 1e-6 for each in vars(body).values())


def test_a_redundant_link_locks_the_dimensions_that_it_fits_alone() -> None:
    scene = parallelogram(2)
    found = gradient(scene, np.linspace(0.1, 1.0, 5))
    assert {"crank", "rocker1", "lever", "ground.A2.x"} <= set(found.locked)
    assert "driver.angle" in found.by
    turned = found.by["driver.angle"].links
    assert np.abs(turned["lever"].theta - 1.0).max() < 1e-9
    assert np.abs(turned["coupler"].theta).max() < 1e-9


def test_forces_are_the_sum_of_masses_times_their_derivatives() -> None:
    scene = load_scene("slider-crank-offset")
    scene = replace(scene, loads={}, gravity_m_s2=(0.0, -9.81))
    times = np.linspace(0.05, 0.9, 7) * scene.driver.law.period_s
    found, exact = gradient(scene, times, forces=True), forces(scene, times)
    assert set(found.forces) == set(masses(scene))
    weights = {}
    for name, (body, field) in masses(scene).items():
        holder = scene.links.get(body) or scene.sliders[body]
        weights[name] = getattr(holder, field)
    torque = sum(weights[name] * found.forces[name].torque for name in weights)
    assert np.abs(torque - exact.torque).max() < 1e-12 * np.abs(exact.torque).max()
    pin = sum(weights[name] * found.forces[name].pins["B"]["crank"] for name in weights)
    assert np.abs(pin - exact.pins["B"]["crank"]).max() < 1e-12 * np.abs(pin).max()


def test_the_angle_at_given_driver_angles_has_the_same_gradient() -> None:
    scene, times = load_scene("fourbar-lecture-1"), np.linspace(0.0, 0.5, 9)
    found = gradient(scene, times)
    names = ["crank", "ground"]
    motion, by = gradient_at(scene, found.motion.links["crank"].theta, names)
    assert np.abs(motion.links["rocker"].theta - found.motion.links["rocker"].theta).max() < 1e-12
    for name in names:
        off = by[name].links["rocker"].theta - found.by[name].links["rocker"].theta
        assert np.abs(off).max() < 1e-12


def test_faulty_requests_are_refused() -> None:
    scene = load_scene("fourbar-lecture-1")
    with pytest.raises(CrankcheckError, match="no dimension, mass or inertia rockr; did you mean"):
        gradient(scene, np.zeros(1), "rockr")
    with pytest.raises(CrankcheckError, match="crank: found -1; give a length above 0"):
        with_dimensions(scene, {"crank": -1.0})
    with pytest.raises(CrankcheckError, match="belongs to its law"):
        with_dimensions(scene, {"driver.angle": 1.0})
    rough = replace(scene, friction={"C": CoulombFriction("C", 0.1, radius_m=0.01)})
    with pytest.raises(CrankcheckError, match="Coulomb's friction"):
        gradient(rough, np.zeros(1), "rocker.mass")
    far = with_dimensions(scene, {"coupler": 2.0})
    with pytest.raises(ReachError):
        gradient(far, np.zeros(1))


TRIPLE = """
name = "triple"
source = "test"
ground.points = { A = [0.0, 0.0], D = [0.3, 0.0] }
links.crank.points = { A = [0.0, 0.0], B = [0.1, 0.0] }
links.rod.points = { C = [0.0, 0.0], E = [0.15, 0.0] }
links.coupler.points = { B = [0.0, 0.0], C = [0.25, 0.0] }
links.rocker.points = { C = [0.0, 0.0], D = [0.2, 0.0] }
driver = { link = "crank", speed_rad_s = 3.0, start_deg = 60.0 }
sliders.E = { on = "ground", through_m = [0.4, 0.3], direction_deg = 80.0 }
"""


def test_several_groups_hang_on_one_pin() -> None:
    """The rod stands first in the file, and is placed last."""
    found = gradient(parse_scene(TRIPLE, "test"), np.array([0.05]))
    for name in ("coupler", "rod"):
        assert shares(found, name).max() <= 1.0
