"""The start of a run: engines jump in their first step as far as theory says, and may do so."""

from __future__ import annotations

from dataclasses import replace

import pytest

from models.files import load_scene
from models.poses import mass_ratio
from models.scene import Scene
from reports.compare.beside import SETTLING
from reports.compare.errors import Errors
from reports.compare.force_rows import OF_STEPS
from reports.judge.cell import Cell, Checked, check
from reports.judge.start_allowance import allowance

ERRORS = Errors((), (), (), curvature=2.0, conditioning=0.5, step_rad=0.01, jolt=3.0)


def started(name: str, steps: int) -> Checked:
    """A turn in pymunk, which starts half a step away from where its joints want it."""
    scene = load_scene(name)
    dt_s = scene.driver.law.period_s / steps
    return check(Cell(scene, "pymunk", "tuned", dt_s, steps, converge=False))


@pytest.mark.parametrize("steps", [360, 1440])
@pytest.mark.parametrize("name", ["fourbar-lecture-1", "shaper", "slotted-lever"])
def test_the_first_velocities_jump_by_no_more_than_the_jolt(name: str, steps: int) -> None:
    errors = started(name, steps).errors
    velocity = errors.worst("velocity", "reported", "start")
    differenced = errors.worst("acceleration", "differenced", "start")
    assert 0.3 < velocity.pure / (errors.jolt * errors.step_rad) < 1.1
    assert 0.3 < differenced.pure / errors.jolt < 1.1


def test_the_jolt_of_a_crank_alone_is_half_of_what_keeps_its_end_on_its_circle() -> None:
    """With a long rod the slider's acceleration is the crank's, and nothing turns but the crank."""
    scene = load_scene("slider-crank-central")
    errors = started(scene.name, 360).errors
    crank = 0.5 * 0.1 / scene.longest_m  # half of omega^2 r of its end, over w^2 L
    assert crank < errors.jolt < 5.0 * crank


def test_the_allowance_follows_the_step_and_halves_where_two_steps_are_differenced() -> None:
    fine = replace(ERRORS, step_rad=ERRORS.step_rad / 2)
    assert allowance("velocity", ERRORS) == pytest.approx(2.0 * allowance("velocity", fine))
    half = allowance("velocity-differenced", ERRORS)
    assert half == pytest.approx(allowance("velocity", ERRORS) / 2)
    accelerated = allowance("acceleration-differenced", ERRORS)
    assert accelerated == pytest.approx(allowance("acceleration-differenced", fine))
    assert allowance("angle", ERRORS) == 0.0


def test_light_bodies_that_hold_heavy_ones_may_part_faster_at_the_start() -> None:
    heavy = replace(ERRORS, mass_ratio=100.0)
    alike, apart = (allowance("acceleration", errors) for errors in (ERRORS, heavy))
    assert apart == pytest.approx(100.0 * alike)
    wild = replace(ERRORS, mass_ratio=1e9, jolt=1e9)
    assert max(allowance("acceleration", wild), allowance("velocity", wild)) <= 0.1


def test_joints_closed_in_places_may_start_with_the_accelerations_of_a_step_beside() -> None:
    fine = replace(ERRORS, step_rad=ERRORS.step_rad / 2)
    changes = [
        allowance("acceleration", errors, "solved") - allowance("acceleration", errors)
        for errors in (ERRORS, fine)
    ]
    assert changes[0] == pytest.approx(2.0 * changes[1])
    assert changes[0] == pytest.approx(1.4 * ERRORS.step_rad * ERRORS.curvature**1.5)
    for rate in ("velocity", "velocity-differenced", "acceleration-differenced"):
        assert allowance(rate, ERRORS, "solved") == allowance(rate, ERRORS)
    wild = replace(ERRORS, curvature=1e9)
    assert allowance("acceleration", wild, "solved") <= 0.1


def test_the_mass_ratio_leaves_out_what_has_no_mass(slider_crank: Scene) -> None:
    (slider,) = slider_crank.sliders.values()
    masses = [link.mass_kg for link in slider_crank.links.values()]
    without = replace(slider_crank, sliders={slider.name: replace(slider, mass_kg=0.0)})
    assert mass_ratio(without) == pytest.approx(max(masses) / min(masses))


def test_forces_of_steps_start_for_a_dozen_steps_and_those_of_states_for_forty() -> None:
    scene = load_scene("shaper")  # where pymunk rings longest
    for name, samples in (("pymunk", OF_STEPS), ("mujoco", SETTLING)):
        dt_s = scene.driver.law.period_s / 720
        cell = Cell(scene, name, "tuned", dt_s, 720, converge=False, with_forces=True)
        checked = check(cell)
        assert checked.verdict == "within", checked.failures
        rows = [row for row in checked.errors.rows if row.quantity == "reaction"]
        assert {row.samples for row in rows if row.kind == "start"} == {samples}
