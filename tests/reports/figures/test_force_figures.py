"""The figures of forces: nothing over something else, the right numbers, and all of a turn."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from analytic.forces.kinetostatics import forces
from models.files import load_scene
from models.friction import ConstantFriction, CoulombFriction
from models.laws import ConstantSpeed
from models.loads import Load
from models.scene import Scene
from models.tabulated import Tabulated
from reports.figures.forces.all_figures import FORCE_FIGURES
from reports.figures.forces.force_turn import force_turn
from reports.figures.forces.torque import mean_torque
from reports.figures.style import styled
from tests.reports.figures.room import has_room
from tests.worlds.tiers import few

FOUR_STROKES = Tabulated((0.0, 3.0, 6.0, 12.0), (0.0, 5.0, -2.0, 0.0), period=4.0 * math.pi)
WORK = Load("work", "crank", None, FOUR_STROKES, "angle")


turn_of = cache(lambda name: force_turn(load_scene(name)))
DRAWN = [
    (name, figure)
    for name in ("shaper", "tangent", "slider-crank-self-locking")
    for figure in FORCE_FIGURES
    if figure != "efficiency" or load_scene(name).friction
]
QUICK = {case for case in DRAWN if case[0] == "shaper" or case[1] == "efficiency"}


@pytest.mark.parametrize("drawn", few(DRAWN, QUICK, "the same figures, other curves"), ids=str)
def test_words_of_a_figure_keep_off_each_other_and_off_the_edge(drawn: tuple[str, str]) -> None:
    name, figure = drawn
    with styled():
        has_room(FORCE_FIGURES[figure](turn_of(name)))


def test_a_turn_like_every_other_is_drawn_from_0_to_360_deg(fourbar: Scene) -> None:
    turn = force_turn(fourbar)
    assert turn.ends == (0.0, 360.0)
    assert turn.x[0] <= 0.0
    assert turn.x[-1] >= 360.0
    assert np.all(np.diff(turn.x) > 0.0)
    law = fourbar.driver.law
    assert isinstance(law, ConstantSpeed)
    time_s = (np.radians(turn.x) - law.start_rad) / law.speed_rad_s
    again = forces(fourbar, time_s).torque
    np.testing.assert_allclose(turn.acting.torque[turn.order], again, atol=1e-9)


def test_a_load_of_two_turns_is_drawn_over_the_angles_that_it_is_of(fourbar: Scene) -> None:
    """From 90 to 450 deg: the next turn is another."""
    loaded = replace(fourbar, loads={"work": WORK})
    turn = force_turn(loaded)
    np.testing.assert_allclose(turn.ends, (90.0, 450.0))


def test_the_mean_is_the_work_of_the_loads(fourbar: Scene) -> None:
    """Over a whole turn inertia takes none: what the reduced torque does, the drive does
    against it."""
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
    assert any("within 5 deg" in note for note in turn.notes)
    figure = FORCE_FIGURES["efficiency"](turn)
    curve = np.ravel(figure.axes[0].lines[-1].get_ydata())
    assert np.nanmin(curve) < 0.05
    assert np.nanmax(curve) <= 1.0
    assert len(figure.axes[0].collections) == 1


def test_a_turn_locked_nearly_everywhere_draws_no_forces_and_says_so() -> None:
    """With mu = 10 only some degrees near the ends of the stroke are not locked."""
    scene = load_scene("slider-crank-self-locking")
    turn = force_turn(replace(scene, friction={"piston": CoulombFriction("piston", 10.0)}))
    assert np.isfinite(turn.motion.forces.torque).any()
    left = {name for name, draw in FORCE_FIGURES.items() if draw(turn) is not None}
    assert left == {"reduced", "efficiency"}
    assert "within 5 deg of it are not drawn, which is all of the turn" in turn.notes[-1]


def test_without_friction_and_where_the_loads_drive_there_is_no_efficiency(fourbar: Scene) -> None:
    assert FORCE_FIGURES["efficiency"](force_turn(fourbar)) is None
    scene = load_scene("slider-crank-self-locking")
    loads = {
        name: replace(one, direction_rad=one.direction_rad + math.pi)
        for name, one in scene.loads.items()
    }
    helped = force_turn(replace(scene, loads=loads))
    assert helped.acting.has_equilibria(2).any()
    assert FORCE_FIGURES["efficiency"](helped) is None


def test_the_shares_of_the_torque_are_the_torque(fourbar: Scene) -> None:
    """Inertia, weights and loads, and friction: constant friction of the drive's pin is its own."""
    rubbing = replace(fourbar, friction={"A": ConstantFriction("A", 0.25)})
    figure = FORCE_FIGURES["torque"](force_turn(rubbing))
    curves = [np.ravel(line.get_ydata()) for line in figure.axes[0].lines]
    friction, inertia, held, torque = (c for c in curves if c.size > 2)
    np.testing.assert_allclose(friction, 0.25, rtol=1e-12)
    np.testing.assert_allclose(inertia + held + friction, torque, atol=1e-12)
    bare = FORCE_FIGURES["torque"](force_turn(fourbar))
    alone = [np.ravel(line.get_ydata()) for line in bare.axes[0].lines]
    np.testing.assert_allclose(inertia, next(c for c in alone if c.size > 2), atol=1e-9)
