"""The figures of what is solved: of forces, regulation, vibration and families of rods."""

import math
import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from analytic.elastic.control import control_elastic
from analytic.elastic.discretisation import Modes
from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve
from analytic.lectures.regulation.flywheel import WantedFlywheel, wanted_flywheel
from analytic.lectures.regulation.turning_machine import TurningMachine
from analytic.lectures.vibration.over_speeds import over_inertia, over_speeds
from analytic.lectures.vibration.steady_vibration import SteadyVibration, steady_vibration
from models.files.reading import load_scene
from models.scene import Scene
from models.scene.loads import ConstantFriction, CoulombFriction, Load
from models.scene.tabulated import Tabulated
from reports.describe.elastic_course import drawn_course
from reports.figures.elastic_figures import ELASTIC_FIGURES
from reports.figures.force_figures import FORCE_FIGURES, mean_torque
from reports.figures.force_turn import force_turn
from reports.lectures.drawing.workbook.family import FamilyCurves, family_curves
from reports.lectures.drawing.workbook.live_workbook import formulas_of
from reports.lectures.drawing.workbook.solve_family import (
    draw_family,
    family_drawing,
    family_page_of,
)
from reports.lectures.machine import vibration_figures as figures
from reports.lectures.machine.regulation_figures import REGULATION_FIGURES, Regulated
from tests.reports.figures.test_files import has_room, texts
from tests.worlds.tiers import few, slow

FOUR_STROKES = Tabulated((0.0, 3.0, 6.0, 12.0), (0.0, 5.0, -2.0, 0.0), period=4.0 * math.pi)
WORK = Load("work", "crank", None, FOUR_STROKES, "angle")
turn_of = cache(lambda name: force_turn(load_scene(name)))
DRAWN = [
    (name, figure)
    for name in ("shaper", "tangent", "slider-crank-self-locking")
    for figure in FORCE_FIGURES.draws
    if figure != "efficiency" or load_scene(name).friction
]
QUICK = {case for case in DRAWN if case[0] == "shaper" or case[1] == "efficiency"}
ONE = Modes(1, 0)
UNTIL_S = 0.4
"""By then the vibration is out, or is not."""
SLIDER_CRANK, RODS = "slider-crank-excel-350", [3.5, 2.5, 2.2, 2.1]


@pytest.mark.usefixtures("any_width")
@pytest.mark.parametrize("drawn", few(DRAWN, QUICK, "the same figures, other curves"), ids=str)
def test_words_of_forces_have_room(drawn: tuple[str, str]) -> None:
    name, figure = drawn
    has_room(FORCE_FIGURES.draws[figure], turn_of(name))


def test_a_turn_is_drawn_from_0_to_360_deg_and_two_from_their_start_on(fourbar: Scene) -> None:
    turn = force_turn(fourbar)
    assert turn.ends == (0.0, 360.0)
    assert turn.x[0] <= 0.0 < 360.0 <= turn.x[-1]
    law = fourbar.driver.law
    time_s = (np.radians(turn.x) - law.start_rad) / law.speed_rad_s
    again = forces(fourbar, time_s).torque
    np.testing.assert_allclose(turn.acting.torque[turn.order], again, atol=1e-9)
    two = force_turn(replace(fourbar, loads={"work": WORK}))
    np.testing.assert_allclose(two.ends, (90.0, 450.0))  # the next turn is another


def test_the_mean_is_the_work_of_the_loads(fourbar: Scene) -> None:
    """Over a turn inertia takes none: what the reduced torque does, the drive does against it."""
    steady = replace(WORK, characteristic=replace(FOUR_STROKES, values=(2.0, 2.0, 2.0, 2.0)))
    turn = force_turn(replace(fourbar, loads={"work": steady}))
    assert mean_torque(turn) == pytest.approx(-2.0, rel=1e-9)
    assert mean_torque(force_turn(fourbar)) == 0.0


def test_beside_where_friction_locks_nothing_is_drawn_but_the_efficiency() -> None:
    turn = turn_of("slider-crank-self-locking")
    degrees = np.degrees(turn.motion.links["crank"].theta) % 360.0
    is_drawn = np.isfinite(turn.acting.torque)
    # It locks from 80.6 to 99.4 and from 260.6 to 279.4 deg.
    assert not is_drawn[(np.abs(degrees - 90.0) < 14.0) | (np.abs(degrees - 270.0) < 14.0)].any()
    far = np.abs(np.abs(degrees - 180.0) - 90.0) > 15.5
    assert np.sum(far & ~is_drawn) <= 3  # where the load turns round
    figure = FORCE_FIGURES.draws["efficiency"](turn)
    curve = np.ravel(figure.axes[0].lines[-1].get_ydata())
    assert np.nanmin(curve) < 0.05
    assert np.nanmax(curve) <= 1.0
    assert len(figure.axes[0].collections) == 1


def test_a_locked_turn_has_no_forces_and_driving_loads_no_efficiency(fourbar: Scene) -> None:
    """With mu = 10 only some degrees near the ends of the stroke are not locked."""
    scene = load_scene("slider-crank-self-locking")
    turn = force_turn(replace(scene, friction={"piston": CoulombFriction("piston", 10.0)}))
    assert np.isfinite(turn.motion.forces.torque).any()
    left = {name for name, draw in FORCE_FIGURES.draws.items() if draw(turn) is not None}
    assert left == {"reduced", "efficiency"}
    assert "within 5 deg of it are not drawn, which is all of the turn" in turn.notes[-1]
    assert FORCE_FIGURES.draws["efficiency"](force_turn(fourbar)) is None  # without friction
    turned = {
        k: replace(x, direction_rad=x.direction_rad + math.pi) for k, x in scene.loads.items()
    }
    helped = force_turn(replace(scene, loads=turned))
    assert helped.acting.has_equilibria(2).any()
    assert FORCE_FIGURES.draws["efficiency"](helped) is None


def test_the_shares_of_the_torque_are_the_torque(fourbar: Scene) -> None:
    """Inertia, weights and loads, and friction: constant friction of the drive's pin is its own."""
    rubbing = replace(fourbar, friction={"A": ConstantFriction("A", 0.25)})
    figure = FORCE_FIGURES.draws["torque"](force_turn(rubbing))
    curves = [np.ravel(line.get_ydata()) for line in figure.axes[0].lines]
    inertia, held, friction, torque = (c for c in curves if c.size > 2)
    np.testing.assert_allclose(friction, 0.25, rtol=1e-12)
    np.testing.assert_allclose(inertia + held + friction, torque, atol=1e-12)


@pytest.fixture(scope="module")
def wanted() -> WantedFlywheel:
    return wanted_flywheel(TurningMachine.of(load_scene("engine-four-stroke")), 0.02)


@pytest.mark.usefixtures("any_width")
@pytest.mark.parametrize("name", REGULATION_FIGURES.draws)
def test_words_of_regulation_have_room(wanted: WantedFlywheel, name: str) -> None:
    has_room(REGULATION_FIGURES.draws[name], Regulated(wanted.cycle, wanted))


def test_a_wanted_flywheel_has_a_panel_of_its_speed_and_tangents(wanted: WantedFlywheel) -> None:
    figure = REGULATION_FIGURES.draws["speed"](Regulated(wanted.cycle, wanted))
    far, near = (np.ptp(axes.get_ylim()) for axes in figure.axes)
    assert far > 20.0 * near
    assert len(REGULATION_FIGURES.draws["speed"](Regulated(wanted.cycle)).axes) == 1
    diagram = wanted.diagram
    for slope, above in zip(wanted.slopes, (True, False), strict=True):
        height, at = diagram.tangent(slope, above=above)
        off = (height + slope * diagram.inertia - diagram.work) / np.ptp(diagram.work)
        assert off[at] == pytest.approx(0.0, abs=1e-9)
        assert np.all(off >= -1e-9 if above else off <= 1e-9)


@pytest.fixture(scope="module")
def vibration() -> SteadyVibration:
    return steady_vibration(load_scene("fourbar-elastic"), ONE)


@pytest.mark.usefixtures("any_width")
@slow("drawn whole: 2 s; words of other figures remain")
def test_words_of_vibration_have_room(vibration: SteadyVibration) -> None:
    factors, few_rad_s = np.array([1.0, 30.0]), np.linspace(17.0, 19.0, 3)
    speeds = over_speeds(vibration.scene, ONE, np.linspace(8.0, 60.0, 14))
    for draw, shown in (
        (figures.draw_over_turn, vibration),
        (figures.draw_spectrum, vibration),
        (figures.draw_over_speed, speeds),
        (figures.draw_waterfall, speeds),
        (figures.draw_over_inertia,
         over_inertia(vibration.scene, ONE, few_rad_s, "rocker", factors)),
    ):  # fmt: skip
        has_room(draw, shown)


def test_the_curve_is_the_deflection(vibration: SteadyVibration) -> None:
    (axes,) = figures.draw_over_turn(vibration).axes
    curve = np.asarray(axes.lines[0].get_ydata(), dtype=float)
    swing = vibration.swings["coupler"]
    assert np.abs(curve).max() == pytest.approx(1e3 * swing.largest_m, rel=2e-3)
    assert curve[[0, -1]] == pytest.approx(1e3 * swing.middle[0], abs=1e-9)


@slow("a second: that control does is tests/analytic/elastic")
def test_control_takes_out_what_rings_without_it() -> None:
    scene = load_scene("fourbar-elastic-controlled")
    motion = control_elastic(scene, UNTIL_S, Modes(1))
    course = drawn_course(motion, np.linspace(0.0, UNTIL_S, 201))
    late = course.time_s > 0.9 * UNTIL_S
    both = [each.links[scene.driver.link] for each in (course.motion, course.uncontrolled)]
    with_it, without = (np.ptp(link.omega[late]) for link in both)
    assert with_it < 0.2 * without
    _, speeds, ahead = ELASTIC_FIGURES.draws["control"](course).axes
    assert [len(line.get_ydata()) for line in speeds.lines[:2]] == [201, 201]
    assert ahead.get_ylabel() == "crank ahead by [deg]"
    assert ELASTIC_FIGURES.draws["control"](replace(course, uncontrolled=None)) is None


@pytest.fixture(scope="module")
def curves() -> FamilyCurves:
    return family_curves(formulas_of(load_scene(SLIDER_CRANK), 73, 5.0), "L", RODS)


def test_the_paper_s_four_rods_are_the_reference_of_their_scenes(curves: FamilyCurves) -> None:
    figure = draw_family(curves, "", [])
    for k, rod in enumerate(RODS):
        scene = load_scene(f"slider-crank-excel-{100 * rod:.0f}")
        drawn = [axes.lines[-len(RODS) + k] for axes in figure.axes]
        angle = np.radians(np.asarray(drawn[0].get_xdata()))  # at 1 rad/s it is the time
        (slider,) = solve(scene, angle, bound=False).sliders.values()
        series = (slider.displacement, slider.speed, slider.acceleration)
        for line, exact in zip(drawn, series, strict=True):
            assert line.get_ydata() == pytest.approx(exact, abs=1e-11)


def test_three_panels_have_one_legend_and_their_page_loads_nothing(curves: FamilyCurves) -> None:
    scene = load_scene(SLIDER_CRANK)
    found = texts(family_drawing(scene, curves, "svg")).split("\n")
    axes = ["X [m]", "X' [m/s]", "X'' [m/s²]", "angle of the crank [deg]"]
    for words in (*axes, *(f"L = {rod} m" for rod in RODS)):
        assert found.count(words) == 1
    table = formulas_of(load_scene("fourbar-lecture-1"), 5, 5.0)
    fourbar = draw_family(family_curves(table, "rocker", [0.2, 0.21]), "", [])
    beside = [one.get_ylabel() for one in fourbar.axes]
    assert (len(beside), beside[:2]) == (6, ["theta of BC [rad]", "theta of DC [rad]"])
    text = family_page_of(scene, curves)
    assert text.count("data:image/svg+xml;base64,") == 3
    assert not re.search(r'(src|href)="https?:', text)
    assert all(f"L = {rod} m" in text for rod in RODS)
