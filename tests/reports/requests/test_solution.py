"""`crankcheck.solve`: of what is driven, of what is in free motion, and of elastic links."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import crankcheck
from analytic.free.free_motion import loosened
from models.files.reading import load_scene, shipped
from models.scene.hard import double_parallelogram
from tests.worlds.tiers import slowly

SCENE, FREE, ELASTIC = "fourbar-lecture-1", "fourbar-swing", "fourbar-elastic"


def test_a_solution_is_a_motion_of_the_times_asked_for() -> None:
    solution = crankcheck.solve(SCENE, [0.2, 0.1])
    assert isinstance(solution, crankcheck.Motion)
    assert solution.time_s.tolist() == [0.2, 0.1]
    assert crankcheck.solve(SCENE).time_s.size == 361
    assert solution.scene is crankcheck.solve(SCENE).scene
    one = crankcheck.solve_driven(SCENE, np.float64(0.5), 1, 0)
    assert one.state().theta["crank"] == pytest.approx(0.5)
    assert "theta" in str(one)
    assert "rocker" in str(crankcheck.solve(SCENE, [0, 0.1], links="rocker", points=(), sliders=()))
    assert "mobility 1" in str(crankcheck.solve(SCENE, 0.0, links=(), points="C"))


def test_arrays_are_the_callers_own() -> None:
    """Nothing that is worked out later looks at them, and they are not those that were given."""
    time_s = np.array([0.1, 0.2])
    first = crankcheck.solve(SCENE, time_s)
    kept = first.links["rocker"].theta.copy()
    first.links["rocker"].theta[:] = first.points["C"].position[:] = first.time_s[:] = 0.0
    assert time_s.tolist() == [0.1, 0.2]
    assert crankcheck.solve(SCENE, time_s).links["rocker"].theta.tolist() == kept.tolist()
    log = {"time_s": time_s, "rocker_rad": kept}
    assert crankcheck.judge(SCENE, log, target=1e-12).verdict == "within"


def test_names_from_files_are_no_html(tmp_path: Path) -> None:
    path, name = tmp_path / "own.toml", "<b onclick=alert(1)>[red]x[/red]</b>"
    text = shipped()[SCENE].read_text(encoding="utf-8")
    path.write_text(re.sub("^source.*", f'source = "{name}"', text, flags=re.M), encoding="utf-8")
    solution = crankcheck.solve(path, [0.0, 0.1])
    assert "<b onclick" not in solution._repr_html_()
    assert name in str(solution).replace("\n", "")


def test_of_what_is_let_go_it_is_the_free_motion_over_the_scenes_duration() -> None:
    solution = crankcheck.solve("fourbar-pulse")
    assert isinstance(solution, crankcheck.FreeSolution)
    assert np.array_equal(solution.time_s, np.linspace(0.0, 5.0, 361))
    assert solution.bound is not None
    assert solution.sensitivity[-1] == pytest.approx(12.5, rel=0.01)
    assert np.all(solution.error_rad < 1e-10)
    frame = solution.frame()
    assert frame["kinetic_j"].iloc[-1] == pytest.approx(frame["work_j"].iloc[-1], rel=1e-9)
    assert "13 of 361 samples" in str(solution)
    assert "<svg" in solution._repr_html_()


def test_of_free_motion_there_is_what_was_asked_for_from_the_start_on() -> None:
    solution = crankcheck.solve(FREE, [0.2, 0.1], links="rocker", points=(), bound=False)
    assert list(solution.links) == ["rocker"]
    assert not solution.points
    assert solution.bound is None
    whole = crankcheck.solve(FREE, [0.1, 0.2]).links["rocker"].theta
    assert solution.links["rocker"].theta == pytest.approx(whole[::-1], abs=1e-11)
    scene = load_scene(FREE)  # which is released for as long as it goes on, so for a moment here
    law = replace(scene.driver.law, duration_s=0.1)
    start = crankcheck.solve(replace(scene, driver=replace(scene.driver, law=law)), 0.0)
    assert start.links["crank"].alpha[0] == pytest.approx(-77.20667, rel=1e-6)


@pytest.mark.parametrize(
    ("name", "until_s"),
    [
        (FREE, 0.3),
        slowly("fourbar-double-rocker-swing", 0.5, reason="0.8 s: through limits"),
        slowly("double-pendulum", 0.3, reason="two seconds: two freedoms, by all bodies"),
        ("slider-crank-spring", 0.2),
        slowly(
            "fourbar-elastic-pulse", 0.02, reason="a second: elastic reactions are driven below"
        ),
    ],
)
def test_free_motion_has_reactions_and_no_driving_torque(name: str, until_s: float) -> None:
    """The ground holds all that moves: the sum of m (a - g), beside loads and springs."""
    more = {"modes": 1} if "elastic" in name else {}
    found = crankcheck.solve(name, [0.0, until_s, 0.5 * until_s], forces=True, **more)
    scene, acting = found.scene, found.forces
    assert acting is not None
    assert not acting.torque.any()
    if not (scene.loads or scene.springs):
        needed = np.zeros(2)
        for link in scene.links.values():
            point, local = next(iter(link.points.items()))
            at, own = found.links[link.name], np.subtract(link.centre_m, local)
            arm = own @ [1.0, 1j] * np.exp(1j * at.theta)  # x + i y
            pull = found.points[point].acceleration @ [1.0, 1j]
            pull = pull + (1j * at.alpha - at.omega**2) * arm - scene.gravity_m_s2[1] * 1j
            needed = needed + link.mass_kg * np.column_stack([pull.real, pull.imag])
        held = sum(-force["ground"] for force in acting.pins.values() if "ground" in force)
        assert held == pytest.approx(needed, abs=1e-9 * np.abs(needed).max())
    columns = found.frame().columns
    assert {"A_crank_fx_n", "A_upper_fx_n", "A_driver_fx_n"} & {*columns}
    assert "torque_n_m" not in columns
    text = " ".join(str(found).split())
    assert "A on " in text
    assert "driving torque" not in text


def test_reactions_that_redundant_links_leave_open_are_refused() -> None:
    scene = loosened(double_parallelogram("parallel", source="three rockers"))
    with pytest.raises(crankcheck.CrankcheckError, match=r"^forces: parallel .*redundant links"):
        crankcheck.solve(scene, [0.0, 0.1], forces=True)


def test_of_elastic_links_it_is_the_elastic_motion_beside_the_rigid_one() -> None:
    solution = crankcheck.solve(ELASTIC)
    assert isinstance(solution, crankcheck.ElasticSolution)
    assert solution.time_s.size == 361
    middle = solution.elastic["coupler"].middle
    assert np.max(np.abs(middle)) == pytest.approx(1.05e-3, rel=0.01)
    assert middle[-1] == pytest.approx(middle[0], abs=1e-13)  # it comes back
    apart = solution.links["rocker"].theta - solution.rigid.links["rocker"].theta
    assert 1e-6 < np.max(np.abs(apart)) < 1e-5
    assert solution.forces is None
    assert "13 of 361 samples" in str(solution)
    assert "<svg" in solution._repr_html_()


def test_of_elastic_motion_there_is_what_was_asked_for() -> None:
    forces = crankcheck.solve(ELASTIC, [0.2, -0.1], links="coupler", points=(), forces=True)
    assert list(forces.links) == list(forces.elastic) == ["coupler"]
    assert not forces.points
    assert forces.forces is not None
    assert not crankcheck.solve(ELASTIC, 0.1, links="rocker", modes=1).elastic
    linear = crankcheck.solve(ELASTIC, [0.2], elements=2, linear=True)
    assert linear.elastic["coupler"].extension == pytest.approx(0.0, abs=1e-15)


def test_a_straight_start_rings() -> None:
    """On one mode, and a tenth of a turn: a few tenths of a second."""
    solution = crankcheck.solve(ELASTIC, np.linspace(0.0, 0.085, 50), shape="straight", modes=1)
    middle = solution.elastic["coupler"].middle
    assert abs(middle[0]) < 1e-18
    assert np.max(np.abs(middle)) > 1.2e-3
    assert "Starts straight: it vibrates" in " ".join(str(solution).split())


@pytest.mark.parametrize(
    ("name", "asked"),
    [
        (ELASTIC, {"elements": 1, "shape": "straight"}),
        slowly("fourbar-elastic-pulse", {"modes": 1}, reason="0.6 s: in free motion"),
    ],
)
def test_the_coarsest_description_is_no_own_witness(name: str, asked: dict[str, object]) -> None:
    (told,) = crankcheck.solve(name, [0.0, 0.02], **asked).certainty
    found = re.search(r"next finer description: deflections (\S+) of", told)
    assert found, told
    assert float(found[1]) > 1e-3


@pytest.mark.parametrize(
    ("name", "asked", "said"),
    [
        (FREE, {"time_s": [-0.1, 0.1]}, "its free motion starts at 0"),
        (ELASTIC, {"shape": "straight", "time_s": [-0.1, 0.1]}, "starts at 0, straight"),
        (ELASTIC, {"modes": 2.5}, "modes: found"),
        (ELASTIC, {"modes": 2, "elements": 2}, "elements with modes"),
        (ELASTIC, {"shape": 3}, "shape 3: unknown"),
        (ELASTIC, {"linear": "yes"}, "linear: found"),
        (ELASTIC, {"links": "rokcer"}, "rokcer"),
        # Times that have lost their place in a turn.
        (SCENE, {"time_s": [0.0, 1e300]}, f"time_s: t = .* turns of {SCENE}"),
        (SCENE, {"time_s": [0.0, -1e8]}, f"time_s: t = .* turns of {SCENE}"),
    ],
)
def test_what_can_not_be_asked_is_refused(name: str, asked: dict[str, object], said: str) -> None:
    with pytest.raises(crankcheck.CrankcheckError, match=said):
        crankcheck.solve(name, **asked)
