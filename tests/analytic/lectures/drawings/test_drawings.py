"""Polygons against the reference, centres by their definitions, graphs with ruler and pole."""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import reach, solve, solve_driven
from analytic.lectures.drawings import graphical
from analytic.lectures.drawings.drawn_polygons import DrawnPolygons, draw_polygons, similarity
from analytic.lectures.drawings.graphical import Plotted, by_chords
from analytic.lectures.drawings.instant_centres import centrodes, curvature_circles, instant_centres
from analytic.lectures.drawings.polygon import DriverState, Vector
from models.errors import CrankcheckError
from models.files.reading import load_scene, shipped
from models.motion import Motion
from models.scene import Scene
from reports.lectures.drawing.sheets.paper import round_scale
from tests.worlds.tiers import few, slowly

OMEGA, ALPHA = 10.0, 3.0
SCENES = sorted({*shipped(), "toggle-press", "compressor", "squeezer", "fourbar-chain"})
"""Of these the other kinds have the geometry."""


def angles_of(scene: Scene, count: int) -> list[float]:
    """Driver angles over what it reaches, clear of its ends."""
    low, high = reach(scene)[0]
    return (low + (high - low) * (np.arange(count) + 0.41) / count).tolist()


def with_third_points(scene: Scene) -> Scene:
    """Every link with a point off the line of its first two."""
    links = {}
    for name, link in scene.links.items():
        (ax, ay), (bx, by) = list(link.points.values())[:2]
        third = (0.5 * (ax + bx) - 0.7 * (by - ay), 0.5 * (ay + by) + 0.7 * (bx - ax))
        links[name] = replace(link, points=dict(link.points) | {f"{name}_third": third})
    return replace(scene, links=links)


def drawn_and_solved(scene: Scene, count: int) -> list[tuple[DrawnPolygons, Motion]]:
    pairs = []
    for theta in angles_of(scene, count):
        state = (theta, OMEGA, ALPHA)
        solved = solve_driven(scene, *(np.array([each]) for each in state), bound=False)
        pairs.append((draw_polygons(scene, DriverState(*state)), solved))
    return pairs


@pytest.mark.parametrize("count", [7, slowly(24, reason="angles nearer to a limit")])
@pytest.mark.parametrize("name", few(SCENES, SCENES[::3], "the same dyads"))
def test_every_image_is_the_reference_s_vector(name: str, count: int) -> None:
    for drawn, solved in drawn_and_solved(with_third_points(load_scene(name)), count):
        assert drawn.undetermined == ()
        for polygon in (drawn.velocity, drawn.acceleration):
            exact = {n: getattr(p, polygon.quantity)[0] for n, p in solved.points.items()}
            scale = max(float(np.hypot(*vector)) for vector in exact.values())
            for image in polygon.images.values():
                for point, vector in image.items():
                    assert np.abs(vector - exact[point]).max() < 1e-9 * scale, (point, polygon)
        for link, motion in solved.links.items():
            rates = drawn.rates[link]
            assert rates.omega == pytest.approx(motion.omega[0], rel=1e-9, abs=1e-9 * OMEGA)
            assert rates.alpha == pytest.approx(motion.alpha[0], rel=1e-8, abs=1e-8 * OMEGA**2)


@pytest.mark.parametrize("name", SCENES)
def test_every_vector_begins_at_the_pole_or_where_another_ends(name: str) -> None:
    scene = load_scene(name)
    drawn = draw_polygons(scene, DriverState(angles_of(scene, 7)[1], OMEGA, ALPHA))
    for polygon in (drawn.velocity, drawn.acceleration):
        ends, near = [np.zeros(2)], 1e-9 * polygon.largest
        for step in polygon.steps:
            for vector in step.vectors:
                assert nearest(vector.start, ends) < near
                ends.append(vector.end)
            for node in step.nodes.values():
                assert nearest(node, [vector.end for vector in step.vectors]) < near
            ends += step.nodes.values()


def nearest(place: np.ndarray, others: list[np.ndarray]) -> float:
    return min(float(np.hypot(*(place - other))) for other in others)


@pytest.mark.parametrize("name", ["scotch-yoke", "sixbar-watt", "fourbar-chain"])
def test_the_image_of_a_link_is_told_to_be_similar_to_the_link_and_turned(name: str) -> None:
    scene = with_third_points(load_scene(name))
    for drawn, _ in drawn_and_solved(scene, 7):
        for link in scene.links:
            rates = drawn.rates[link]
            for polygon, turn in (
                (drawn.velocity, 1j * rates.omega),
                (drawn.acceleration, 1j * rates.alpha - rates.omega**2),
            ):
                said = similarity(drawn, link, polygon.quantity)
                if said.is_point:
                    size = max(polygon.largest, abs(turn) * scene.longest_m)
                    assert abs(turn) * scene.longest_m < 1e-11 * size
                else:
                    assert cmath.rect(said.scale, said.turn_rad) == pytest.approx(turn, rel=1e-12)


def test_where_omega_is_0_but_for_rounding_the_image_of_velocities_is_one_point() -> None:
    theta = math.acos((0.35**2 + 0.3**2 - 0.2**2) / (2 * 0.35 * 0.3))  # crank and coupler in line
    drawn = draw_polygons(load_scene("fourbar-lecture-1"), DriverState(theta, OMEGA))
    assert similarity(drawn, "rocker", "velocity").is_point
    assert not similarity(drawn, "rocker", "acceleration").is_point
    assert not similarity(drawn, "crank", "velocity").is_point


def test_lecture_1_at_90_degrees_and_coriolis_as_the_sliding_turned_by_omega() -> None:
    drawn = draw_polygons(load_scene("fourbar-lecture-1"), DriverState(math.pi / 2, 10.0))
    named = vectors(drawn)
    assert named["v_BA"].size == pytest.approx(1.0)
    assert named["a^n_BA"].size == pytest.approx(10.0)
    # AB = 0.1, BC = 0.25, CD = 0.2, AD = 0.3 m: B stands over A, so v_B lies along AD
    assert named["v_BA"].value == pytest.approx([-1.0, 0.0], abs=1e-15)
    assert named["v_CD"].size == pytest.approx(0.2 * abs(drawn.rates["rocker"].omega))
    assert named["a^n_CD"].size == pytest.approx(0.2 * drawn.rates["rocker"].omega ** 2)
    # Of Coriolis: the sliding, turned in the sense of omega.
    drawn = draw_polygons(load_scene("slotted-lever"), DriverState(0.8, OMEGA))
    named = vectors(drawn)
    sliding = named["v_B(lever)B"].value @ (1.0, 1j)
    coriolis = named["a^k_B(lever)B"].value @ (1.0, 1j)
    assert coriolis == pytest.approx(2.0 * drawn.rates["lever"].omega * 1j * sliding)


def vectors(drawn: DrawnPolygons) -> dict[str, Vector]:
    both = (*drawn.velocity.vectors, *drawn.acceleration.vectors)
    return {vector.name: vector for vector in both}


def test_what_is_not_determined_is_named_and_the_rest_is_drawn() -> None:
    scene = load_scene("fourbar-double-rocker")
    end = reach(scene)[0][1]  # coupler and rocker in line
    drawn = draw_polygons(scene, DriverState(end - 1e-19, OMEGA))
    assert len(drawn.undetermined) == 1
    assert "RRR (coupler, rocker): both directions" in drawn.undetermined[0]
    assert [step.title for step in drawn.velocity.steps] == ["driver driver"]


def test_scales_are_one_two_five_times_a_power_of_ten_and_of_nothing_there_is_none() -> None:
    for size, room, scale in (
        (1.0, 100.0, 0.01), (1.01, 100.0, 0.02), (0.3, 10.0, 0.05), (7e-4, 7.0, 1e-4),
    ):  # fmt: skip
        assert round_scale(size, room) == pytest.approx(scale, rel=1e-12)
    for sizes in ((0.0, 10.0), (1.0, 0.0), (math.nan, 10.0)):
        with pytest.raises(ValueError, match="both above 0"):
            round_scale(*sizes)


def drawn_at(name: str, theta: float, alpha: float = 0.0) -> DrawnPolygons:
    return draw_polygons(load_scene(name), DriverState(theta, 10.0, alpha))


@pytest.mark.parametrize("name", [n for n in shipped() if "double-rocker" not in n])
def test_in_an_instant_centre_both_bodies_have_one_velocity(name: str) -> None:
    for theta in (0.31, 1.07, 2.2):
        drawn = drawn_at(name, theta)
        centres = instant_centres(drawn.placement)
        bodies = len(drawn.placement.structure.bodies) + 1
        assert len(centres) == bodies * (bodies - 1) // 2
        for pair, centre in centres.items():
            one, other = (drawn.rates[body] for body in pair)
            scale = 10.0 * drawn.placement.scene.longest_m
            if centre.place is None or np.hypot(*centre.place) > 1e6:
                assert abs(one.omega - other.omega) < 1e-6 * 10.0  # no turning against each other
                continue
            gap = one.velocity_at(centre.place) - other.velocity_at(centre.place)
            away = 1.0 + float(np.hypot(*centre.place)) / drawn.placement.scene.longest_m
            assert np.hypot(*gap) < 1e-9 * scale * away**2, (pair, centre)


@pytest.mark.parametrize("name", ["slider-crank-offset", "sixbar-watt"])
@pytest.mark.parametrize("alpha", [0.0, 7.0])
def test_circles_by_their_definitions(name: str, alpha: float) -> None:
    drawn = drawn_at(name, 1.0, alpha)
    for link in drawn.placement.scene.links:
        body = drawn.rates[link]
        circles = curvature_circles(drawn, link)
        assert body.velocity_at(circles.pole) == pytest.approx([0.0, 0.0], abs=1e-12)
        assert body.acceleration_at(circles.acceleration_pole) == pytest.approx([0, 0], abs=1e-9)
        round_about = np.linspace(0.3, 6.0, 9)
        ways = np.stack([np.cos(round_about), np.sin(round_about)], axis=1)
        for place in circles.inflection.middle + circles.inflection.radius * ways:
            v, a = body.velocity_at(place), body.acceleration_at(place)
            assert v[0] * a[1] - v[1] * a[0] == pytest.approx(0.0, abs=1e-9 * (1 + v @ v) * 100)
        if circles.still_speed is None:
            assert body.alpha == 0.0
            continue
        for place in circles.still_speed.middle + circles.still_speed.radius * ways:
            v, a = body.velocity_at(place), body.acceleration_at(place)
            assert v @ a == pytest.approx(0.0, abs=1e-9 * (np.hypot(*v) * np.hypot(*a) + 1.0))


def test_the_moving_centrode_rolls_on_the_fixed_one() -> None:
    """Ways of the pole on both are equally long: it rolls, and does not slide."""
    scene = load_scene("fourbar-lecture-1")
    times = np.linspace(0.0, 0.2, 2001)
    both = centrodes(solve(scene, times, bound=False), "coupler", "B")
    steps = [np.hypot(*np.diff(way, axis=0).T) for way in (both.fixed, both.moving)]
    assert steps[0] == pytest.approx(steps[1], rel=1e-4)
    still = replace(solve(scene, times[:3], bound=False))
    assert np.isfinite(centrodes(still, "rocker", "D").fixed).all()


def test_a_link_that_turns_by_rounding_alone_does_not_turn() -> None:
    """The coupler of a parallelogram is carried round: its circles would be 1e14 m large."""
    drawn = drawn_at("fourbar-lecture-1", math.pi / 2)
    coupler = replace(drawn.rates["coupler"], omega=1e-15)
    drawn = replace(drawn, rates={**drawn.rates, "coupler": coupler})
    with pytest.raises(CrankcheckError, match="coupler does not turn at this instant"):
        curvature_circles(drawn, "coupler")
    motion = solve(drawn.placement.scene, np.linspace(0.0, 0.1, 9), bound=False)
    still = replace(motion.links["coupler"], omega=np.full(9, 1e-15))
    with pytest.raises(CrankcheckError, match="coupler never turns"):
        centrodes(replace(motion, links={**motion.links, "coupler": still}), "coupler", "B")


def test_a_straight_graph_is_differentiated_to_rounding_and_a_parabola_by_tangents() -> None:
    x = np.array([0.0, 1.0, 3.0, 4.0, 8.0])
    assert by_chords(Plotted(x, 3.0 * x - 1.0)).y == pytest.approx(3.0)
    tangents = graphical.by_tangents(Plotted(x, x**2))
    assert tangents.x == pytest.approx(x[1:-1])
    assert tangents.y == pytest.approx(2.0 * x[1:-1])
    y = np.array([2.0, -1.0, 5.0, 5.5, 0.0])  # which is integrated back from its start
    assert graphical.integrated(x, by_chords(Plotted(x, y)).y, start=2.0).y == pytest.approx(y)
