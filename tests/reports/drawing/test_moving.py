"""What a drawing holds: the reference, errors small enough to be magnified, and elastic links; what
is embedded of it can neither leave its script nor lose what a diagram shows."""

import base64
import hashlib
import json
import math
import re
from dataclasses import replace
from xml.etree import ElementTree as Xml

import numpy as np
import pytest

from analytic.elastic.discretisation import Modes
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.kinematics import solve
from models.array import Array
from models.files.reading import load_scene
from models.scene import Scene
from reports.describe.elastic_course import ElasticCourse, elastic_course
from reports.drawing import moving, shape
from reports.drawing.force_arrows import CUT, LONGEST, force_arrows, rounded
from reports.drawing.svg import HEIGHT, WIDTH, svg
from reports.output import numbers
from reports.output.numbers import DIGITS, NONE, finite
from tests.analytic.dyads.test_redundant import parallelogram, with_strut
from tests.worlds.tiers import few

SCENES = ("fourbar-lecture-1", "slider-crank-offset", "shaper", "scotch-yoke", "sixbar-stephenson")
FOURBAR = load_scene("fourbar-lecture-1")
TIME_S = moving.instants(FOURBAR)


def unpacked(held: dict[str, object]) -> Array:
    """Rows as the page reads them."""
    whole = np.frombuffer(base64.b64decode(str(held["base64"])), "<i2")
    rows = whole.reshape(len(np.asarray(held["scales"])), -1).astype(np.float64)
    rows[rows == -32768] = np.nan
    return rows * np.asarray(held["scales"])[:, None]


def traced(
    scene: Scene, time_s: Array, shift_m: float = 0.0, turn_rad: float = 0.0
) -> dict[str, Array]:
    """The trace of a run that is off the reference by a shift in x, and links by a turn."""
    motion = solve(scene, time_s, bound=False)
    found = {"time_s": time_s}
    for name, point in motion.points.items():
        found[f"x.{name}"], found[f"y.{name}"] = (point.position + np.array([shift_m, 0.0])).T
    return found | {f"theta.{name}": link.theta + turn_rad for name, link in motion.links.items()}


def rows_off(trace: dict[str, Array], time_s: Array = TIME_S, scene: Scene = FOURBAR) -> Array:
    return unpacked(moving.displacements(scene, trace, time_s))


@pytest.mark.parametrize("name", SCENES)
def test_the_reference_is_the_closed_form(name: str) -> None:
    scene = load_scene(name)
    time_s = moving.instants(scene)
    drawn = moving.drawing(scene, time_s)
    motion = solve(scene, time_s)
    rows = unpacked(drawn["places"])
    assert drawn["points"] == moving.moving_points(scene)
    for i, point in enumerate(moving.moving_points(scene)):
        exact = motion.points[point].position.T
        level = np.max(np.abs(exact)) / 32767
        np.testing.assert_allclose(rows[2 * i : 2 * i + 2], exact, atol=level)
    named = {p for link in drawn["links"] for p in link["points"]}
    assert named <= {*drawn["points"], *drawn["ground"]}


@pytest.mark.parametrize("shift_m", [1e-3, 1e-9])
@pytest.mark.parametrize("name", SCENES[:2])
def test_small_errors_are_kept_apart_from_large_places(name: str, shift_m: float) -> None:
    scene = load_scene(name)
    time_s = moving.instants(scene)
    rows = rows_off(traced(scene, time_s, shift_m, turn_rad=2e-8), time_s, scene)
    points = len(moving.moving_points(scene))
    np.testing.assert_allclose(rows[0 : 2 * points : 2], shift_m, rtol=1e-4)
    np.testing.assert_allclose(rows[1 : 2 * points : 2], 0.0, atol=1e-16)
    np.testing.assert_allclose(rows[2 * points :], 2e-8, rtol=1e-4)


def test_a_run_of_other_turns_is_shown_at_the_same_crank_angles() -> None:
    period, own = FOURBAR.driver.law.period_s, moving.instants(FOURBAR, turns=4.0)
    trace = traced(FOURBAR, own)
    trace["x.C"] = trace["x.C"] + 1e-3 * np.sin(2 * np.pi * own / period)
    row = rows_off(trace, moving.instants(FOURBAR, turns=2.0))[
        2 * moving.moving_points(FOURBAR).index("C")
    ]
    np.testing.assert_allclose(row, 1e-3 * np.sin(2 * np.pi * TIME_S / period), atol=1e-7)
    angles = np.asarray(moving.drawing(FOURBAR, moving.instants(FOURBAR, turns=3.0))["told"]["at"])
    assert angles[[0, -1]] == pytest.approx([90.0, 450.0])  # it starts in its first turn


def test_a_run_is_drawn_as_far_as_it_was_logged_and_cut_off_where_it_came_apart() -> None:
    assert np.isfinite(rows_off(traced(FOURBAR, TIME_S[:40], 1e-3))[0]).sum() == 40
    assert np.isfinite(rows_off(traced(FOURBAR, TIME_S * (1.0 - 1e-14)))).all()  # by rounding
    trace = traced(FOURBAR, TIME_S)
    trace["x.C"] = trace["x.C"] + np.linspace(0.0, 1e200, len(TIME_S))
    trace["y.C"] = np.full_like(TIME_S, math.nan)
    x, y = rows_off(trace)[2 * moving.moving_points(FOURBAR).index("C") :][:2]
    assert np.max(x) == pytest.approx(20 * FOURBAR.longest_m, rel=1e-4)
    assert np.isnan(y).all()
    assert moving.displacements(FOURBAR, {}, TIME_S) is None
    assert moving.displacements(FOURBAR, {"time_s": TIME_S}, TIME_S) is None


@pytest.fixture(scope="module")
def course() -> ElasticCourse:
    scene = load_scene("fourbar-elastic")
    motion = DrivenElasticMotion(scene, 1.0, Modes(3), "periodic", stiffened=True)
    return elastic_course(motion, np.linspace(0.0, 0.8, 9))


def bent(course: ElasticCourse, factor: float) -> moving.Magnified:
    return moving.Magnified(course.scene, course.motion, course.rigid, course.bent, factor)


def test_everything_is_where_it_is_and_magnified_by_the_factor(course: ElasticCourse) -> None:
    own = bent(course, 1.0)
    outline = own.outline("coupler", 2)
    ends = [course.motion.points[pin].position[2] for pin in ("B", "C")]
    np.testing.assert_allclose(outline[[0, -1]], ends, rtol=0, atol=1e-15)
    chord, aside = ends[1] - ends[0], outline[20] - ends[0]
    off = (chord[0] * aside[1] - chord[1] * aside[0]) / np.hypot(*chord)
    assert off == pytest.approx(course.motion.elastic["coupler"].middle[2], rel=1e-9)
    np.testing.assert_allclose(own.outline("rocker", 2)[1], ends[1], rtol=0, atol=1e-15)
    exact = course.rigid.points["C"].position[2]
    far = bent(course, 1000.0).place("C", 2) - exact
    np.testing.assert_allclose(far, 1000.0 * (own.place("C", 2) - exact), rtol=1e-9)


@pytest.mark.parametrize("size_m", [1e-3, 0.3, 1.0, 40.0])
def test_a_magnification_is_a_round_number_that_fits(course: ElasticCourse, size_m: float) -> None:
    factor = moving.magnification(course.motion, course.rigid, course.bent, size_m)
    assert f"{factor:e}"[0] in "125"
    largest = np.max(np.abs(course.bent["coupler"]))
    assert factor == 1.0 or 0.02 < factor * largest / size_m <= 0.06
    assert moving.magnification(course.rigid, course.rigid, {}, 1.0) == 1.0  # nothing bends


HOSTILE = "</script><script>alert(1)</script><!--\u2028\u2029&'\""


def test_hostile_text_stays_in_its_script_and_what_is_no_number_is_null() -> None:
    text = str(moving.embedded({HOSTILE: [HOSTILE, {"deep": HOSTILE}]}))
    assert not re.search("[<>&\u2028\u2029]", text)
    assert json.loads(text) == {HOSTILE: [HOSTILE, {"deep": HOSTILE}]}
    text = str(
        moving.embedded({"a": np.array([1 / 3, math.nan, math.inf, 2.0]), "b": True, "c": None})
    )
    assert text == '{"a":[0.333333,null,null,2],"b":true,"c":null}'
    assert finite(np.float64(-1.23456789e-9), DIGITS) == -1.23457e-9
    assert finite(np.int64(7), DIGITS) == 7


@pytest.mark.parametrize("scale", [1.0, 1e-12, 1e300, 5e-324])
def test_packed_samples_come_back_to_a_part_of_their_row(scale: float) -> None:
    rows = np.vstack([np.sin(np.linspace(0, 7, 91)), np.linspace(-1e-6, 1e-7, 91)]) * scale
    found = moving.packed(rows)
    largest = np.max(np.abs(rows), axis=1, keepdims=True)
    room = largest / moving.LEVELS if scale > 1e-300 else np.full_like(largest, scale)
    assert np.all(np.abs(unpacked(found) - rows) <= room)
    assert found["samples"] == 91


def test_single_samples_come_back_to_seven_digits() -> None:
    row = np.array([0.0, 123.456789, -1e-30, 1e300, np.nan])
    told = moving.singles(row)
    found = np.frombuffer(base64.b64decode(str(told["singles"])), dtype="<f4")
    assert told["samples"] == 5
    assert found[:3] == pytest.approx(row[:3], rel=1e-7, abs=1e-38)
    assert np.isposinf(found[3])
    assert np.isnan(found[4])


def test_missing_samples_are_told_from_zero_and_the_size_of_rows_is_known_beforehand() -> None:
    found = moving.packed(np.array([[math.nan, 0.0, math.inf, 1.0], [0.0, 0.0, 0.0, math.nan]]))
    whole = np.frombuffer(base64.b64decode(str(found["base64"])), "<i2").reshape(2, 4)
    assert whole.tolist() == [[-32768, 0, -32768, moving.LEVELS], [0, 0, 0, -32768]]
    rows = np.random.default_rng(1).normal(size=(17, 91))
    assert moving.size_of(17, 91) == pytest.approx(
        len(str(moving.embedded(moving.packed(rows)))), rel=0.05
    )


def test_the_policy_lets_the_own_scripts_run_and_nothing_else() -> None:
    script = "let a = 1;"
    found = moving.policy([script])
    own = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert f"script-src 'sha256-{own}';" in found
    assert "default-src 'none'" in found
    assert "http" not in found
    assert "unsafe-eval" not in found


@pytest.mark.parametrize(
    ("way", "value", "text"),
    [
        *[("readable", value, text) for value, text in {
            0.0: "0", 0.001: "0.001", 0.01234: "0.0123", 12345.6: "12346", 1e-4: "1e-4",
            -4.567e-9: "-4.57e-9", 1e5: "1e5", math.inf: "inf"}.items()],
        *[("error_text", value, text) for value, text in {
            2.66e-4: "2.7e-4", 0.0: "0", math.nan: NONE, None: NONE}.items()],
        *[("duration", value, text) for value, text in {
            14.06e-3: "14.1 ms", 0.99996e-3: "1.00 ms", 4.84e-4: "484 µs",
            12.0: "12.0 s", None: NONE, math.inf: NONE}.items()],
    ],
)  # fmt: skip
def test_numbers_are_written_by_their_kind(way: str, value: float | None, text: str) -> None:
    assert getattr(numbers, way)(value) == text


SAMPLES = 37
SVG = "{http://www.w3.org/2000/svg}"
KINDS = ("fourbar-lecture-1", "shaper", "scotch-yoke", "tangent", "sixbar-stephenson",
         "planetary", "cam-flat")  # fmt: skip
"""A chain, blocks on a lever and on the ground, a link that slides, a crank that locks, a plate, a
ring around wheels, a cam with a face."""


@pytest.mark.parametrize("name", few(KINDS, [*KINDS][::3], "drawn as another"))
def test_every_link_point_and_block_is_drawn_in_the_frame(name: str) -> None:
    scene = load_scene(name)
    root = Xml.fromstring(svg(scene))
    wide, tall = float(root.get("width", 0)), float(root.get("height", 0))
    assert max(wide / WIDTH, tall / HEIGHT) == pytest.approx(1.0, abs=0.01)
    texts = list(root.iter(f"{SVG}text"))
    slid = {slider.point for slider in scene.sliders.values()}
    assert sorted(str(x.text) for x in texts) == sorted([*{*scene.pins, *slid}, *scene.links])
    bars = [each for each in root.iter(f"{SVG}polygon") if each.get("stroke-width") == "5"]
    assert len(bars) == len(scene.links)
    assert len({each.get("stroke") for each in bars}) == len(scene.links)
    for element in root.iter():
        for x, y in re.findall(
            r"(-?[\d.]+),(-?[\d.]+)", element.get("points", element.get("d", ""))
        ):
            assert -1 <= float(x) <= wide + 1
            assert -1 <= float(y) <= tall + 1
    for text in texts:
        assert 0 <= float(text.get("x", -1)) <= wide
        assert 0 <= float(text.get("y", -1)) <= tall


def test_the_path_of_a_run_is_drawn_as_far_as_it_is_finite(fourbar: Scene) -> None:
    def half(series: Array) -> Array:
        return np.concatenate([series[:200], np.full_like(series[200:], np.nan)])

    text = svg(fourbar, solve(fourbar, np.linspace(0.0, 0.6, 400)).each_series(half))
    assert "nan" not in "".join(re.findall('points="(.*?)"', text))
    assert text.count("stroke-dasharray") == 2


def test_an_arrow_goes_from_its_pin_along_its_force(fourbar: Scene) -> None:
    turn = shape.turn_of(fourbar, SAMPLES, with_forces=True)
    arrows = force_arrows(fourbar, turn)
    for index in range(SAMPLES):
        by_tail = {tuple(arrow.tail): arrow for arrow in arrows.at(turn, index)}
        for point, bodies in turn.forces.pins.items():
            tail = tuple(turn.points[point].position[index])
            if tail in by_tail:
                arrow, force = by_tail[tail], list(bodies.values())[1][index]
                assert arrow.body == list(bodies)[1]
                np.testing.assert_allclose(arrow.tip - arrow.tail, arrows.m_per_n * force)


@pytest.mark.parametrize("name", ["shaper", "tangent"])
def test_all_arrows_of_a_turn_are_in_the_box(name: str) -> None:
    scene = load_scene(name)
    turn = shape.turn_of(scene, SAMPLES, with_forces=True)
    arrows = force_arrows(scene, turn)
    low, high = arrows.box(turn)
    every = [arrow for k in range(SAMPLES) for arrow in arrows.at(turn, k)]
    tips = np.array([arrow.tip for arrow in every])
    assert (tips > low).all()
    assert (tips < high).all()
    assert max(np.hypot(*(x.tip - x.tail)) for x in every) >= LONGEST * arrows.size


def test_beside_a_dead_point_an_arrow_is_cut_off_and_has_no_head() -> None:
    scene = replace(parallelogram(1), gravity_m_s2=(0.0, -9.81))
    turn = shape.turn_of(scene, 721, with_forces=True)
    arrows = force_arrows(scene, turn)
    every = [arrow for k in range(721) for arrow in arrows.at(turn, k)]
    cut = [np.hypot(*(x.tip - x.tail)) for x in every if not x.is_whole]
    assert cut
    assert cut == pytest.approx([CUT * LONGEST * arrows.size] * len(cut))


def test_a_picture_has_arrows_and_a_bar_where_forces_act(fourbar: Scene) -> None:
    plain, forced = svg(fourbar), svg(fourbar, with_forces=True)
    assert plain == svg(fourbar, with_forces=False)
    assert any(str(each.text).endswith(" N") for each in Xml.fromstring(forced).iter(f"{SVG}text"))
    bars = {0.7: 0.5, 1.0: 1.0, 199.0: 100.0, 4e-3: 2e-3}
    assert {value: rounded(value) for value in bars} == pytest.approx(bars, rel=1e-12)
    no_reactions = with_strut(parallelogram(1), "B0", "B1")
    assert " N<" not in plain + svg(no_reactions, with_forces=True)
