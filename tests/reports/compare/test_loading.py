"""How hard loads are on an engine: what they shake, how steep they are over a displacement, and the
samples beside jumps of forces, as of friction where its joint turns."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve
from models.characteristics import Characteristic, Constant, Polynomial, Sine
from models.files import load_scene
from models.friction import ConstantFriction
from models.loads import Load
from models.motion import Motion
from models.scene import Scene
from models.tabulated import Tabulated
from reports.compare.jumps import NEAR, near_jumps
from reports.compare.loading import inertia_share, load_slopes, loading

SLIDER = load_scene("slider-crank-offset")
PERIOD_S, SPEED_RAD_S = SLIDER.driver.law.period_s, SLIDER.driver.law.peak_speed_rad_s
STEP_RAD = 2 * np.pi / 360


def _with(load: Load, scene: Scene = SLIDER) -> Scene:
    return replace(scene, loads={load.name: load})


def _pushed(law: Characteristic, **more: object) -> Scene:
    return _with(Load("push", "block C", "C", law, **more))  # type: ignore[arg-type]


def _motion(scene: Scene, steps: int = 360) -> Motion:
    return solve(scene, np.linspace(0.0, scene.driver.law.period_s, steps + 1), bound=False)


def _loading(scene: Scene) -> float:
    return loading(scene, _motion(scene))


@pytest.mark.parametrize(
    ("law", "most"),
    [
        (Constant(100.0), 1e-10),
        (Polynomial((3.0, 100.0)), 1e-10),
        (Tabulated((0.0, 1e-3), (0.0, 1.0)), 0.0),  # it ends before the motion
    ],
)
def test_a_load_that_stays_or_grows_evenly_or_is_none_shakes_nothing(
    law: Characteristic, most: float
) -> None:
    assert _loading(_pushed(law)) <= most


def test_without_loads_over_a_displacement_there_is_no_slope() -> None:
    assert _loading(SLIDER) == 0.0
    for scene in (SLIDER, _pushed(Sine(100.0, 0.1))):
        assert load_slopes(scene, _motion(scene), 1.0, 1.0) == {"reaction": 0.0, "torque": 0.0}


def test_a_sine_shakes_by_its_second_difference_over_the_mass_of_its_body() -> None:
    mass = SLIDER.sliders["C"].mass_kg
    by = 100.0 * STEP_RAD**2 / (mass * SPEED_RAD_S**2 * SLIDER.longest_m)
    sine = _pushed(Sine(100.0, PERIOD_S))
    assert _loading(sine) == pytest.approx(by, rel=1e-3)
    light = replace(sine, sliders={"C": replace(SLIDER.sliders["C"], mass_kg=0.0)})
    assert 0.0 < _loading(light) < np.inf  # a body without mass counts as the lightest


def test_a_torque_counts_by_the_inertia_of_its_link_and_not_where_a_guide_holds_it() -> None:
    sine = Sine(1.0, PERIOD_S)
    by = STEP_RAD**2 / (SLIDER.links["rod"].inertia_kg_m2 * SPEED_RAD_S**2)
    assert _loading(_with(Load("turn", "rod", None, sine))) == pytest.approx(by, rel=1e-3)
    held = _with(Load("turn", "ram", None, sine), load_scene("shaper-cutting"))
    assert _loading(held) == 0.0


def test_a_constant_load_in_the_frame_of_a_body_shakes_as_that_turns() -> None:
    scene = _with(Load("push", "crank", "B", Constant(10.0), frame="body"))
    mass = SLIDER.links["crank"].mass_kg
    by = 10.0 * STEP_RAD**2 / (mass * SPEED_RAD_S**2 * SLIDER.longest_m)
    assert _loading(scene) == pytest.approx(by, rel=1e-3)


def test_the_slope_is_that_of_the_stroke_on_which_the_load_acts() -> None:
    press = load_scene("toggle-press")
    work = replace(press, loads={"work": press.loads["work"]})
    both, one = (load_slopes(scene, _motion(press, 720), 1e5, 1e3) for scene in (press, work))
    chord = 1e5 / 3e-3  # N/m; a cubic is taken to be three times as steep as its chord
    assert one["reaction"] == pytest.approx(3 * chord * press.longest_m / 1e5, rel=1e-6)
    assert both["reaction"] == pytest.approx(6 * one["reaction"], rel=1e-6)  # over 0.5 mm


def test_the_slope_of_the_torque_is_by_the_speed_of_what_is_loaded() -> None:
    scene = _pushed(Polynomial((0.0, 50.0)), over="displacement", slider="C")
    motion = _motion(scene)
    found = load_slopes(scene, motion, 2.0, 4.0)
    speed = np.max(np.abs(motion.sliders["C"].speed)) / SPEED_RAD_S
    assert found["reaction"] == pytest.approx(50.0 * scene.longest_m / 2.0)
    assert found["torque"] == pytest.approx(50.0 * scene.longest_m * speed / 4.0, rel=1e-6)


def test_inertia_has_a_share_of_one_at_most() -> None:
    assert inertia_share(SLIDER, 1e-3) == 1.0
    assert inertia_share(SLIDER, 1e6) == pytest.approx(inertia_share(SLIDER, 1e5) / 10)


def _near(scene: Scene, steps: int = 360) -> list[int]:
    """The samples that are beside a jump."""
    motion = _motion(scene, steps)
    motion = replace(motion, forces=forces(scene, motion, bound=False))
    return np.flatnonzero(near_jumps(scene, motion)).tolist()


TURNS = np.flatnonzero(np.diff(np.sign(_motion(SLIDER).sliders["C"].speed))).tolist()
"""The samples after which the slider turns back."""


def _beside(turns: list[int]) -> list[int]:
    return sorted(k + by for k in turns for by in range(1 - NEAR, 1 + NEAR))


def test_nothing_jumps_without_friction_and_loads_of_strokes() -> None:
    assert _near(SLIDER) == []
    assert _near(_pushed(Constant(1.0))) == []


def test_friction_jumps_where_its_joint_turns_back() -> None:
    scene = replace(SLIDER, friction={"C": ConstantFriction("C", 0.5)})
    assert len(TURNS) == 2
    assert _near(scene) == _beside(TURNS)
    assert _near(scene, 2) == [0, 1, 2]  # of few samples all are beside a jump


def test_so_does_a_load_of_a_stroke_where_it_is_other_than_0() -> None:
    stroke = {"slider": "C", "stroke": "forward"}
    assert _near(_pushed(Constant(1.0), **stroke)) == _beside(TURNS)
    ends = Tabulated((-1.0, 0.3, 0.35, 1.0), (0.0, 0.0, 1.0, 1.0))  # at the outer end alone
    assert _near(_pushed(ends, over="displacement", **stroke)) == _beside(TURNS[1:])
