"""The drawn polygons against the reference, which they share no rates with."""

from __future__ import annotations

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.drawings.drawn_polygons import DrawnPolygons, draw_polygons
from analytic.drawings.paper_scale import book_scales, round_scale
from analytic.drawings.placed_mechanism import DriverState
from analytic.drawings.polygon import Polygon
from analytic.drawings.similarity import similarity
from analytic.kinematics import reach, solve_driven
from models.files import load_scene, shipped
from models.motion import Motion
from models.scene import Scene
from tests.worlds.tiers import slowly

OMEGA, ALPHA = 10.0, 3.0
SCENES = sorted({*shipped(), "toggle-press", "compressor", "squeezer", "fourbar-chain"})
"""Of these the other kinds have the geometry."""
few_angles = pytest.mark.parametrize("count", [7, slowly(24, reason="angles nearer to a limit")])


def angles_of(scene: Scene, count: int) -> np.ndarray:
    """Driver angles over what it reaches, clear of its ends."""
    low, high = reach(scene)[0]
    return low + (high - low) * (np.arange(count) + 0.41) / count


def drawn_and_solved(scene: Scene, count: int) -> list[tuple[DrawnPolygons, Motion]]:
    theta = angles_of(scene, count)
    ones = np.ones(1)
    return [
        (
            draw_polygons(scene, DriverState(float(each), OMEGA, ALPHA)),
            solve_driven(scene, each * ones, OMEGA * ones, ALPHA * ones, bound=False),
        )
        for each in theta
    ]


@few_angles
@pytest.mark.parametrize("name", SCENES)
def test_every_image_is_the_reference_s_vector(name: str, count: int) -> None:
    for drawn, solved in drawn_and_solved(load_scene(name), count):
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
    drawn = draw_polygons(scene, DriverState(float(angles_of(scene, 7)[1]), OMEGA, ALPHA))
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


def with_third_points(scene: Scene) -> Scene:
    """Every link with a point off the line of its first two."""
    links = {}
    for name, link in scene.links.items():
        (ax, ay), (bx, by) = list(link.points.values())[:2]
        third = (0.5 * (ax + bx) - 0.7 * (by - ay), 0.5 * (ay + by) + 0.7 * (bx - ax))
        links[name] = replace(link, points=dict(link.points) | {f"{name}_third": third})
    return replace(scene, links=links)


def turned_and_scaled(link: np.ndarray, image: np.ndarray) -> tuple[complex, float]:
    """The one factor, as a complex number, that makes the image of the link; and what is left."""
    one = (link - link[0]) @ (1.0, 1j)
    other = (image - image[0]) @ (1.0, 1j)
    factor = complex((one.conj() @ other) / (one.conj() @ one))
    return factor, float(np.abs(other - factor * one).max())


@few_angles
@pytest.mark.parametrize("name", SCENES)
def test_the_image_of_a_link_is_similar_to_the_link_and_turned(name: str, count: int) -> None:
    scene = with_third_points(load_scene(name))
    for drawn, _ in drawn_and_solved(scene, count):
        for link in scene.links:
            rates, places = drawn.rates[link], drawn.placement.points
            for polygon, turn in (
                (drawn.velocity, 1j * rates.omega),
                (drawn.acceleration, 1j * rates.alpha - rates.omega**2),
            ):
                image = polygon.images[link]
                shape = np.array([places[point] for point in image])
                factor, left = turned_and_scaled(shape, np.array(list(image.values())))
                size = max(polygon.largest, abs(turn) * scene.longest_m)
                assert left < 1e-12 * size
                assert abs(factor - turn) * scene.longest_m < 1e-12 * size
                said = similarity(drawn, link, polygon.quantity)
                if said.is_point:
                    assert abs(turn) * scene.longest_m < 1e-11 * size
                else:
                    assert cmath.rect(said.scale, said.turn_rad) == pytest.approx(turn, rel=1e-12)


@pytest.mark.parametrize(
    ("name", "link", "theta"),
    [
        ("scotch-yoke", "yoke", 1.0),  # it slides on the ground
        # crank and coupler in line: cos theta = (0.35^2 + 0.3^2 - 0.2^2) / (2 0.35 0.3)
        ("fourbar-lecture-1", "rocker", math.acos(0.1725 / 0.21)),
    ],
)
def test_where_omega_is_0_the_image_of_velocities_is_one_point(
    name: str, link: str, theta: float
) -> None:
    drawn = draw_polygons(with_third_points(load_scene(name)), DriverState(theta, OMEGA))
    assert similarity(drawn, link, "velocity").is_point
    assert similarity(drawn, link, "acceleration").is_point == (name == "scotch-yoke")
    assert not similarity(drawn, "crank", "velocity").is_point


def test_a_link_that_does_not_turn_has_one_point_as_its_image() -> None:
    drawn = draw_polygons(load_scene("scotch-yoke"), DriverState(1.0, OMEGA))
    (link,) = set(drawn.velocity.images) - {"crank"}
    assert drawn.rates[link].omega == 0.0
    image = np.array(list(drawn.velocity.images[link].values()))
    assert np.ptp(image, axis=0).max() == 0.0


def test_lecture_1_at_90_degrees() -> None:
    drawn = draw_polygons(load_scene("fourbar-lecture-1"), DriverState(math.pi / 2, 10.0))
    named = {vector.name: vector for vector in vectors(drawn.velocity, drawn.acceleration)}
    assert named["v_BA"].size == pytest.approx(1.0)
    assert named["a^n_BA"].size == pytest.approx(10.0)
    # AB = 0.1, BC = 0.25, CD = 0.2, AD = 0.3 m: B stands over A, so v_B lies along AD
    assert named["v_BA"].value == pytest.approx([-1.0, 0.0], abs=1e-15)
    assert named["v_CD"].size == pytest.approx(0.2 * abs(drawn.rates["rocker"].omega))
    assert named["a^n_CD"].size == pytest.approx(0.2 * drawn.rates["rocker"].omega ** 2)


def vectors(*polygons: Polygon) -> list:
    return [vector for polygon in polygons for vector in polygon.vectors]


def test_coriolis_component_is_the_sliding_turned_in_the_sense_of_omega() -> None:
    drawn = draw_polygons(load_scene("slotted-lever"), DriverState(0.8, OMEGA))
    named = {vector.name: vector.value for vector in vectors(drawn.velocity, drawn.acceleration)}
    sliding = named["v_B(lever)B"] @ (1.0, 1j)
    coriolis = named["a^k_B(lever)B"] @ (1.0, 1j)
    assert coriolis == pytest.approx(2.0 * drawn.rates["lever"].omega * 1j * sliding)


def test_what_is_not_determined_is_named_and_the_rest_is_drawn() -> None:
    scene = load_scene("fourbar-double-rocker")
    end = reach(scene)[0][1]  # coupler and rocker in line
    drawn = draw_polygons(scene, DriverState(end - 1e-19, OMEGA))
    assert len(drawn.undetermined) == 1
    assert "RRR (coupler, rocker): both directions" in drawn.undetermined[0]
    assert [step.title for step in drawn.velocity.steps] == ["driver driver"]


@pytest.mark.parametrize(
    ("size", "room", "scale"),
    [
        (1.0, 100.0, 0.01),
        (1.01, 100.0, 0.02),
        (0.3, 10.0, 0.05),
        (51.0, 100.0, 1.0),
        (7e-4, 7, 1e-4),
    ],
)
def test_scales_are_one_two_five_times_a_power_of_ten(
    size: float, room: float, scale: float
) -> None:
    assert round_scale(size, room) == pytest.approx(scale, rel=1e-12)


def test_the_book_s_scales_make_the_crank_s_vectors_k_times_the_crank() -> None:
    velocity, acceleration = book_scales(0.005, -10.0, 2.0)
    assert 0.1 * 10.0 / velocity == pytest.approx(2.0 * 0.1 / 0.005)
    assert 0.1 * 100.0 / acceleration == pytest.approx(2.0 * 0.1 / 0.005)


@pytest.mark.parametrize(("size", "room"), [(0.0, 1.0), (1.0, 0.0), (math.nan, 1.0)])
def test_a_scale_needs_a_size_and_a_room(size: float, room: float) -> None:
    with pytest.raises(ValueError, match="both above 0"):
        round_scale(size, room)
