"""Driving torque and reactions: three computations of them, and what is refused."""

from __future__ import annotations

import ast
import random
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import analytic
from analytic.check import multipliers, power
from analytic.check.constraints import Constraints
from analytic.check.moved_scene import moved, rotated
from analytic.dyads.plane import Vec
from analytic.forces import kinetostatics, virtual_power
from analytic.kinematics import reach, solve, solve_driven
from models.array import Array
from models.errors import CrankcheckError
from models.files import load_scene, parse_scene, shipped
from models.forces import Forces
from models.laws import Accelerating
from models.loads import Constant, Load, Polynomial, Tabulated
from models.scene import Driver, Scene
from tests.analytic.dyads.test_redundant import parallelogram, with_strut
from tests.worlds.loading import loaded, loaded_mechanism

AGREED = 1e-11
SAMPLES = 61


def turn(scene: Scene) -> Array:
    """Times over a period, none of them in a position of symmetry."""
    return np.linspace(0.0, scene.driver.law.period_s, SAMPLES) + 1e-3 * scene.driver.law.period_s


def series(found: Forces) -> Iterator[tuple[str, Array]]:
    """Everything, by name."""
    yield "torque", found.torque
    for point, by_body in found.pins.items():
        for body, force in by_body.items():
            yield f"pin {point} on {body}", force
    for name, one in found.sliders.items():
        yield f"normal {name}", one.normal
        yield f"moment {name}", one.moment


def apart(one: Forces, other: Forces) -> float:
    """The largest difference over the largest torque or force of either."""
    ours, theirs = dict(series(one)), dict(series(other))
    assert ours.keys() == theirs.keys()
    forces = max(float(np.abs(a).max()) for n, a in ours.items() if n[0] in "pn")
    moments = max(float(np.abs(a).max()) for n, a in ours.items() if n[0] in "tm")
    return max(
        float(np.abs(a - theirs[n]).max()) / (forces if n[0] in "pn" else moments)
        for n, a in ours.items()
    )


def out_of_balance(scene: Scene, time_s: Array, found: Forces) -> float:
    balance = power.power_balance(scene, solve(scene, time_s), found.torque)
    return float(np.max(np.abs(balance.put_in - balance.used)) / np.max(balance.scale))


@pytest.mark.parametrize("heavy", [False, True], ids=["as shipped", "loaded"])
@pytest.mark.parametrize("name", shipped())
def test_three_computations_agree_over_a_turn(name: str, heavy: bool) -> None:
    scene = load_scene(name)
    if heavy:
        scene = loaded(scene, random.Random(name))
    time_s = turn(scene)
    found = kinetostatics.forces(scene, time_s)
    other = multipliers.forces(scene, solve(scene, time_s))
    assert apart(found, other) <= AGREED
    assert out_of_balance(scene, time_s, found) <= AGREED
    assert not np.array_equal(found.torque, other.torque), "bit for bit: the same computation?"


def test_random_mechanisms_agree_with_the_multipliers() -> None:
    """Off their dead points."""
    for number in range(0, 60, 2):
        scene, _ = loaded_mechanism(number)
        time_s = np.linspace(0.01, 1.0, 5) * scene.driver.law.period_s
        found = kinetostatics.forces(scene, time_s)
        assert apart(found, multipliers.forces(scene, solve(scene, time_s))) <= AGREED, number
        assert out_of_balance(scene, time_s, found) <= AGREED, number


def reached(module: str) -> set[str]:
    """The modules of `analytic` that a module imports, directly or through others."""
    root, found, todo = Path(str(analytic.__file__)).parents[1], set(), [module]
    while todo:
        name = todo.pop()
        path = root.joinpath(*name.split(".")).with_suffix(".py")
        if name in found or not path.is_file():
            continue
        found.add(name)
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom) and str(node.module).startswith("analytic"):
                todo += [str(node.module), *(f"{node.module}.{a.name}" for a in node.names)]
    return found


def test_no_computation_imports_another() -> None:
    assert not any(".check" in name for name in reached("analytic.forces.kinetostatics"))
    for opinion in ("analytic.check.multipliers", "analytic.check.power"):
        rooms = {name.split(".")[1] for name in reached(opinion)}
        assert rooms <= {"check", "structure"}
    assert "analytic.check.constraints" not in reached("analytic.check.power")


def test_a_fault_in_one_of_them_makes_them_disagree(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = load_scene("shaper")
    time_s = turn(scene)
    motion = solve(scene, time_s)
    right = kinetostatics.forces(scene, time_s)
    jacobian = Constraints.jacobian

    def spoilt(self: Constraints, q: Array) -> Array:
        rows = jacobian(self, q)
        rows[:, 5] *= 1.0 + 1e-9  # the arms of the lever
        return rows

    with monkeypatch.context() as m:
        m.setattr(Constraints, "jacobian", spoilt)
        assert apart(right, multipliers.forces(scene, motion)) > AGREED
    heavier = replace(scene, gravity_m_s2=(0.0, 1e-8))
    wrong = kinetostatics.forces(heavier, time_s)
    assert apart(wrong, multipliers.forces(scene, motion)) > AGREED
    assert out_of_balance(scene, time_s, wrong) > AGREED


def test_forces_of_a_motion_are_those_of_its_times() -> None:
    scene = loaded(load_scene("sixbar-stephenson"), random.Random(3))
    time_s = turn(scene)
    by_time = kinetostatics.forces(scene, time_s)
    of_motion = kinetostatics.forces(scene, solve(scene, time_s))
    bare = kinetostatics.forces(scene, time_s, bound=False)
    assert apart(by_time, of_motion) < 1e-14
    assert by_time.bound is not None
    assert of_motion.bound is not None
    assert np.all(of_motion.bound.torque < 3.0 * by_time.bound.torque)
    assert np.all(by_time.bound.torque < 3.0 * of_motion.bound.torque)
    assert bare.bound is None
    for (name, a), (_, b) in zip(series(by_time), series(bare), strict=True):
        np.testing.assert_array_equal(a, b, err_msg=name)


def test_chunks_make_no_difference() -> None:
    scene = load_scene("slider-crank-offset")
    time_s = np.linspace(0.0, 3.0, 30_000)
    whole = kinetostatics.forces(scene, time_s, bound=False)
    part = kinetostatics.forces(scene, time_s[25_000:25_010], bound=False)
    np.testing.assert_allclose(whole.torque[25_000:25_010], part.torque, rtol=1e-14)


def test_all_forces_of_a_pin_add_up_to_nothing() -> None:
    """Of three bodies too; the ground stands first: what it exerts on the link is the second."""
    scene = replace(parse_scene(SHARED, "shared"), gravity_m_s2=(0.0, -9.81))
    assert len(scene.pins["B"]) == 3
    found = kinetostatics.forces(scene, turn(scene))
    largest = max(np.abs(force).max() for name, force in series(found) if name.startswith("pin"))
    for by_body in found.pins.values():
        assert np.abs(sum(by_body.values())).max() < 1e-14 * largest
    assert next(iter(found.pins["A"])) == "ground"


def test_a_hanging_weight_pulls_its_pin_down() -> None:
    """A crank that hangs: the pin holds m g - m omega^2 r up, the drive keeps it where it is."""
    scene = parse_scene(HANGING, "hanging")
    found = kinetostatics.forces(
        scene, solve_driven(scene, np.radians([-90.0, 0.0]), np.array(2.0), np.array(0.0))
    )
    down, level = found.pins["A"]["crank"]
    assert down == pytest.approx([0.0, 3.0 * (9.81 + 4.0 * 0.2)], abs=1e-14)
    assert level == pytest.approx([-3.0 * 4.0 * 0.2, 3.0 * 9.81], abs=1e-14)
    assert found.torque == pytest.approx([0.0, 3.0 * 9.81 * 0.2], abs=1e-14)
    np.testing.assert_array_equal(found.pins["A"]["ground"], -found.pins["A"]["crank"])


SHARED = """
name = "shared"
source = "test"
[ground]
points = { A = [0.0, 0.0], D = [0.3, 0.0] }
[links]
crank = { bar = ["A", "B"], length_m = 0.1 }
coupler = { bar = ["B", "C"], length_m = 0.25 }
rocker = { bar = ["D", "C"], length_m = 0.2 }
rod = { bar = ["B", "E"], length_m = 0.3 }
[sliders.E]
on = "ground"
mass_kg = 0.5
[driver]
link = "crank"
speed_rad_s = 10.0
"""
HANGING = """
name = "hanging"
source = "test"
gravity_m_s2 = [0.0, -9.81]
[ground]
points = { A = [0.0, 0.0] }
[links]
crank = { bar = ["A", "B"], length_m = 0.4, mass_kg = 3.0 }
[driver]
link = "crank"
speed_rad_s = 1.0
"""


def test_force_on_a_central_slider_crank_is_that_of_the_textbook() -> None:
    """Massless rod, a force on the piston: side thrust F tan(psi), torque F r sin(phi + psi) /
    cos(psi), with the rod's lean psi (Shigley and Uicker, Theory of Machines, slider-crank)."""
    scene = load_scene("slider-crank-central")
    links = {n: replace(k, mass_kg=0.0, inertia_kg_m2=0.0) for n, k in scene.links.items()}
    sliders = {n: replace(s, mass_kg=1e-9) for n, s in scene.sliders.items()}
    gas = Load("gas", "block C", "C", Constant(1000.0), direction_rad=np.pi)
    scene = replace(scene, links=links, sliders=sliders, loads={"gas": gas})
    phi = np.radians(np.linspace(10.0, 350.0, 18))
    found = kinetostatics.forces(scene, solve_driven(scene, phi, np.array(1e-3), np.array(0.0)))
    r, length = scene.links["crank"].points["B"][0], scene.links["rod"].points["C"][0]
    psi = np.arcsin(r * np.sin(phi) / length)
    torque = -1000.0 * r * np.sin(phi + psi) / np.cos(psi)
    np.testing.assert_allclose(found.torque, torque, atol=1e-9)
    np.testing.assert_allclose(
        np.abs(found.sliders["C"].normal), 1000.0 * np.abs(np.tan(psi)), atol=1e-9
    )
    np.testing.assert_allclose(found.sliders["C"].moment, 0.0, atol=1e-9)


@pytest.mark.parametrize("name", ["shaper", "scotch-yoke", "sixbar-watt"])
def test_turned_and_moved_mechanisms_have_turned_forces(name: str) -> None:
    scene = loaded(load_scene(name), random.Random(2))
    loads = {n: one for n, one in scene.loads.items() if one.over != "angle"}
    scene = replace(scene, loads=loads)
    time_s = turn(scene)
    here = kinetostatics.forces(scene, time_s)
    there = kinetostatics.forces(moved(rotated(scene, 0.7), (3.0, -2.0)), time_s)
    c, s = np.cos(0.7), np.sin(0.7)
    turned = {
        p: {b: f @ np.array([[c, s], [-s, c]]) for b, f in held.items()}
        for p, held in here.pins.items()
    }
    assert apart(replace(here, pins=turned), there) < 1e-12


@pytest.mark.parametrize("number", range(6))
def test_redundant_links_leave_the_torque(number: int) -> None:
    """The balance of power holds for it, to rounding."""
    rng = random.Random(number)
    scene = parallelogram(2) if number % 2 else with_strut(parallelogram(1), "B0", "B1")
    scene = replace(loaded(scene, rng), loads={}, gravity_m_s2=(0.0, -9.81))
    time_s = np.linspace(0.0, 1.0, 9)
    found = kinetostatics.forces(scene, time_s)
    assert not found.pins
    assert not found.sliders
    assert "redundant links" in found.undetermined
    assert "stiffness" in found.undetermined
    assert out_of_balance(scene, time_s, found) <= AGREED
    assert found.bound is not None
    assert np.all(found.bound.torque < 1e-9 * np.abs(found.torque).max())


def test_a_redundant_link_without_mass_changes_no_torque() -> None:
    """Within both bounds, which go on along two ways."""
    scene = replace(loaded(parallelogram(1), random.Random(5)), gravity_m_s2=(0.0, -9.81))
    strutted = with_strut(scene, "B0", "B1")
    strut = replace(strutted.links["strut"], mass_kg=0.0, inertia_kg_m2=0.0)
    strutted = replace(strutted, links={**strutted.links, "strut": strut})
    time_s = np.linspace(0.0, 1.0, 9)
    plain, spare = (kinetostatics.forces(each, time_s) for each in (scene, strutted))
    assert plain.bound is not None
    assert spare.bound is not None
    most = plain.bound.torque + spare.bound.torque
    assert np.all(np.abs(plain.torque - spare.torque) <= most)
    assert np.all(most < 1e-9 * np.abs(plain.torque).max())


@pytest.mark.parametrize("name", ["shaper", "sixbar-watt", "tangent"])
def test_virtual_power_gives_the_torque_of_the_reactions(name: str) -> None:
    """Within the bounds of both; at rest too, where power says nothing."""
    scene = loaded(load_scene(name), random.Random(name))
    loads = {n: one for n, one in scene.loads.items() if one.stroke == "both"}
    law = Accelerating(0.3, 0.0, 5.0)
    scene = replace(scene, driver=Driver(scene.driver.link, law), loads=loads)
    time_s = np.linspace(0.0, 0.3, 7)
    found = kinetostatics.forces(scene, time_s)
    parts = list(kinetostatics.chunks(scene, time_s, bound=True))
    (_, chunk), unit = parts[0], kinetostatics.unit_chunk(scene, parts[0][1].theta, bound=True)
    free = kinetostatics.free_bodies(scene, chunk)
    kinetostatics.apply_loads(scene, chunk, time_s, free)
    own = virtual_power.torque_by_power(free, unit, chunk)
    assert found.bound is not None
    assert np.all(np.abs(own.value - found.torque) <= own.error + found.bound.torque)
    assert np.all(own.error < 1e-10 * np.abs(found.torque).max())


def test_a_dead_point_is_told_with_its_place() -> None:
    scene = parallelogram(1)
    scene = replace(scene, gravity_m_s2=(0.0, -9.81))
    angles = np.radians([30.0, 0.0])
    with pytest.raises(CrankcheckError, match=r"crank at 0 deg .* dead point: the dyad at B1"):
        kinetostatics.forces(scene, solve_driven(scene, angles, np.array(1.0), np.array(0.0)))


def test_a_dead_point_may_be_left_out() -> None:
    scene = replace(parallelogram(1), gravity_m_s2=(0.0, -9.81))
    motion = solve_driven(scene, np.radians([30.0, 0.0]), np.array(1.0), np.array(0.0))
    found = kinetostatics.forces(scene, motion, skip_dead_points=True)
    assert found.bound is not None
    for _, array in series(found):
        assert np.isnan(array).reshape(2, -1).all(axis=1).tolist() == [False, True]
    assert np.isinf(found.bound.torque).tolist() == [False, True]
    assert np.isinf(found.bound.pins["B1"]["coupler"]).tolist() == [False, True]


def test_beside_a_dead_point_nothing_is_certain() -> None:
    scene = load_scene("fourbar-double-rocker")
    low, _ = reach(scene)[0]
    near = solve_driven(scene, np.array([low + 1e-14]), np.array(1.0), np.array(0.0))
    found = kinetostatics.forces(scene, near)
    assert found.bound is not None
    assert np.isinf(found.bound.torque).all()
    assert np.isinf(found.bound.pins["C"]["coupler"]).all()


def test_the_end_of_a_range_is_a_dead_point() -> None:
    scene = load_scene("fourbar-double-rocker")
    end = solve_driven(scene, np.array([reach(scene)[0][0]]), np.array(1.0), np.array(0.0))
    with pytest.raises(CrankcheckError, match=r"driver at -65.3757 deg .* the dyad at C"):
        kinetostatics.forces(scene, end)


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda m: replace(m, points={}), "point A is not in it; solve it without a choice"),
        (lambda m: replace(m, sliders={}), "slider C is not in it"),
        (lambda m: replace(m, bound=None), "carries no bounds"),
        (
            lambda m: replace(m.each_series(lambda a: np.full_like(a, np.nan)), conditioning={}),
            "no acceleration of link crank",
        ),
    ],
)
def test_a_motion_that_lacks_something_is_refused(spoil: object, words: str) -> None:
    scene = load_scene("slider-crank-central")
    motion = solve(scene, np.array([0.1, 0.2]))
    with pytest.raises(CrankcheckError, match=words):
        kinetostatics.forces(scene, spoil(motion))  # type: ignore[operator]


def test_a_scene_without_mass_and_load_is_refused() -> None:
    scene = load_scene("fourbar-lecture-1")
    links = {n: replace(k, mass_kg=0.0, inertia_kg_m2=0.0) for n, k in scene.links.items()}
    light = replace(scene, links=links)
    with pytest.raises(CrankcheckError, match="no link or slider has a mass and nothing loads"):
        kinetostatics.forces(light, [0.0])
    push = Load("push", "rocker", "C", Constant(1.0))
    assert kinetostatics.forces(replace(light, loads={"push": push}), [0.0]).torque[0] != 0.0


@pytest.mark.parametrize(
    ("load", "words"),
    [
        (Load("x", "door", "C", Constant(1.0)), r"loads.x.body: found door; use one of crank, rod"),
        (Load("x", "rod", "Q", Constant(1.0)), r"loads.x.point: found Q; use one of B, C"),
        (
            Load("x", "rod", "C", Constant(1.0), slider="Z", stroke="forward"),
            r"loads.x.slider: found Z; use one of C",
        ),
        (
            Load("x", "rod", "C", Polynomial((1.0,)), "displacement"),
            r"loads.x.slider: found none; use one of C",
        ),
        (
            Load("x", "rod", "C", Tabulated((0.0, 0.1), (1.0, 2.0)), "time"),
            r"loads.x: over the time \[s\] the table goes from 0 to 0.1, and 0.2 is asked for",
        ),
    ],
)
def test_a_load_that_is_not_there_is_refused(load: Load, words: str) -> None:
    scene = replace(load_scene("slider-crank-central"), loads={"x": load})
    with pytest.raises(CrankcheckError, match=words):
        kinetostatics.forces(scene, [0.1, 0.2])


def test_a_cutting_force_acts_on_the_working_stroke_alone() -> None:
    scene = load_scene("shaper")
    cut = Load("cut", "block F", "F", Constant(500.0), "time", "F", "forward", np.pi)
    time_s = turn(scene)
    idle = kinetostatics.forces(scene, time_s, bound=False)
    cutting = kinetostatics.forces(replace(scene, loads={"cut": cut}), time_s, bound=False)
    works = solve(scene, time_s, bound=False).sliders["F"].speed > 0.0
    more = cutting.torque - idle.torque
    assert np.all(np.abs(more[works]) > 0.0)
    assert np.all(more[~works] == 0.0)
    assert 0.3 < np.mean(works) < 0.8


def test_where_a_stroke_turns_the_bound_holds_the_whole_force() -> None:
    """Rounding may have the speed on either side of 0."""
    scene = load_scene("slider-crank-central")
    cut = Load("cut", "block C", "C", Constant(500.0), "time", "C", "forward")
    scene = replace(
        scene, loads={"cut": cut}, sliders={"C": replace(scene.sliders["C"], mass_kg=1.0)}
    )
    still = solve_driven(scene, np.array([np.pi, 1.0]), np.array(1.0), np.array(0.0))
    found = kinetostatics.forces(scene, still)
    assert found.bound is not None
    assert found.bound.pins["C"]["block C"][0] >= 500.0
    assert found.bound.pins["C"]["block C"][1] < 1e-9


def test_vectors_of_no_length_cost_nothing() -> None:
    scene = load_scene("slider-crank-central")
    chunk = next(iter(kinetostatics.chunks(scene, np.zeros(3), bound=True)))[1]
    body = kinetostatics.free_bodies(scene, chunk)["rod"]
    assert body.vector((0.1, 0.2), (0.1, 0.2)).v.x == 0.0
    assert isinstance(body.vector((0.0, 0.0), (0.1, 0.2)).v, Vec)
