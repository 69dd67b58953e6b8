"""How hard loads are on an engine: what they shake, and how steep they are over a displacement."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve
from models.characteristics import Constant, Polynomial, Sine
from models.files import load_scene
from models.loads import Load
from models.motion import Motion
from models.scene import Scene
from models.tabulated import Tabulated
from reports.compare.loading import inertia_share, load_slopes, loading

SLIDER = load_scene("slider-crank-offset")
STEPS = 360


def _with(load: Load, scene: Scene = SLIDER) -> Scene:
    return replace(scene, loads={load.name: load})


def _motion(scene: Scene, steps: int = STEPS) -> Motion:
    period = scene.driver.law.period_s
    return solve(scene, np.linspace(0.0, period, steps + 1), bound=False)


def _push(law: Constant | Polynomial | Sine | Tabulated, **more: object) -> Load:
    return Load("push", "block C", "C", law, **more)  # type: ignore[arg-type]


def test_without_loads_there_is_nothing_and_no_slope() -> None:
    motion = _motion(SLIDER)
    assert loading(SLIDER, motion) == 0.0
    assert load_slopes(SLIDER, motion, 1.0, 1.0) == {"reaction": 0.0, "torque": 0.0}


@pytest.mark.parametrize("law", [Constant(100.0), Polynomial((3.0, 100.0))])
def test_a_load_that_stays_or_grows_evenly_shakes_nothing(law: Constant | Polynomial) -> None:
    assert loading(_with(_push(law)), _motion(SLIDER)) < 1e-10


def test_a_sine_shakes_by_its_second_difference_over_the_mass_of_its_body() -> None:
    period = SLIDER.driver.law.period_s
    found = loading(_with(_push(Sine(100.0, period))), _motion(SLIDER))
    w, h = SLIDER.driver.law.peak_speed_rad_s, 2 * np.pi / STEPS
    mass = SLIDER.sliders["C"].mass_kg
    assert found == pytest.approx(100.0 * h**2 / (mass * w**2 * SLIDER.longest_m), rel=1e-3)


def test_a_torque_counts_by_the_inertia_of_its_link_and_not_where_a_guide_holds_it() -> None:
    period = SLIDER.driver.law.period_s
    free = _with(Load("turn", "rod", None, Sine(1.0, period)))
    h, rod = 2 * np.pi / STEPS, SLIDER.links["rod"]
    w = SLIDER.driver.law.peak_speed_rad_s
    by = h**2 / (rod.inertia_kg_m2 * w**2)
    assert loading(free, _motion(free)) == pytest.approx(by, rel=1e-3)
    shaper = load_scene("shaper-cutting")
    held = _with(Load("turn", "ram", None, Sine(1.0, period)), shaper)
    assert loading(held, _motion(held)) == 0.0


def test_a_constant_load_in_the_frame_of_a_body_shakes_as_that_turns() -> None:
    load = Load("push", "crank", "B", Constant(10.0), frame="body")
    scene = _with(load)
    w, h = scene.driver.law.peak_speed_rad_s, 2 * np.pi / STEPS
    by = 10.0 * h**2 / (scene.links["crank"].mass_kg * w**2 * scene.longest_m)
    assert loading(scene, _motion(scene)) == pytest.approx(by, rel=1e-3)


def test_a_body_without_mass_counts_as_the_lightest() -> None:
    sliders = {"C": replace(SLIDER.sliders["C"], mass_kg=0.0)}
    period = SLIDER.driver.law.period_s
    light = replace(_with(_push(Sine(1.0, period))), sliders=sliders)
    assert 0.0 < loading(light, _motion(light)) < np.inf


def test_a_table_that_ends_before_the_motion_says_nothing() -> None:
    scene = _with(_push(Tabulated((0.0, 1e-3), (0.0, 1.0))))
    assert loading(scene, _motion(scene)) == 0.0


def test_the_slope_is_that_of_the_stroke_on_which_the_load_acts() -> None:
    press = load_scene("toggle-press")
    motion = _motion(press, 720)
    both = load_slopes(press, motion, 1e5, 1e3)
    work = replace(press, loads={"work": press.loads["work"]})
    one = load_slopes(work, motion, 1e5, 1e3)
    chord = 1e5 / 3e-3  # N/m; a cubic is taken to be three times as steep as its chord
    assert one["reaction"] == pytest.approx(3 * chord * press.longest_m / 1e5, rel=1e-6)
    assert both["reaction"] == pytest.approx(6 * one["reaction"], rel=1e-6)  # over 0.5 mm


def test_the_slope_of_the_torque_is_by_the_speed_of_what_is_loaded() -> None:
    scene = _with(_push(Polynomial((0.0, 50.0)), over="displacement", slider="C"))
    motion = _motion(scene)
    found = load_slopes(scene, motion, 2.0, 4.0)
    speed = np.max(np.abs(motion.sliders["C"].speed)) / scene.driver.law.peak_speed_rad_s
    assert found["reaction"] == pytest.approx(50.0 * scene.longest_m / 2.0)
    assert found["torque"] == pytest.approx(50.0 * scene.longest_m * speed / 4.0, rel=1e-6)


def test_loads_over_time_have_no_slope() -> None:
    scene = _with(_push(Sine(100.0, 0.1)))
    assert load_slopes(scene, _motion(scene), 1.0, 1.0)["reaction"] == 0.0


def test_inertia_has_a_share_of_one_at_most() -> None:
    assert inertia_share(SLIDER, 1e-3) == 1.0
    assert inertia_share(SLIDER, 1e6) == pytest.approx(inertia_share(SLIDER, 1e5) / 10)
