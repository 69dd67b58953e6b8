"""Tolerances: defaults that follow step and scene, overrides, and mistakes in them; how far engines
jump in their first step, as theory says; and the rounding of the drive's own sum in long runs."""

from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve
from models.errors import CrankcheckError
from models.files.reading import load_scene
from models.scene import Scene
from models.scene.joints import mass_ratio
from models.scene.laws import ConstantSpeed, Oscillating
from reports.compare.compare import SETTLING, Truth, compare
from reports.compare.errors import Errors, SceneFacts
from reports.compare.whole_errors import OF_STEPS, summed
from reports.judge.cell import check
from reports.judge.rules.limits import allowance
from reports.judge.tolerance import check_names, limits, parse
from sim.run import run
from tests.worlds.facts import with_facts
from tests.worlds.tiers import few, slowly
from tests.worlds.turns import of_turns

ERRORS = Errors((), (), (), SceneFacts(curvature=1.0, conditioning=0.8, step_rad=0.01))


def numbers(scene: Scene, **changed: float) -> dict[str, float]:
    """The limits of errors of which something else is said."""
    return {
        n: limit.number for n, limit in limits(scene, with_facts(ERRORS, **changed), {}).items()
    }


def test_defaults_go_with_the_square_of_the_step_and_the_conditioning(fourbar: Scene) -> None:
    coarse, fine = (numbers(fourbar, step_rad=step) for step in (0.02, 0.01))
    for name in ("angle", "displacement", "position", "gap", "velocity"):
        assert coarse[name] / fine[name] == pytest.approx(4.0, rel=0.02)
    assert coarse["drive"] == pytest.approx(fine["drive"])
    near, far = (numbers(fourbar, conditioning=sine) for sine in (0.1, 1.0))
    assert near["angle"] == pytest.approx(10 * far["angle"], rel=1e-3)
    assert near["gap"] == far["gap"]


def test_places_have_room_for_what_closing_the_pins_sets_off(fourbar: Scene) -> None:
    """Where bodies turn fast about a centre that is far from their pins, beyond the curvature."""
    slow, fast = (numbers(fourbar, worst_jolt=jolt) for jolt in (0.4, 3.0))
    for name in ("angle", "displacement", "position", "gap"):
        assert fast[name] == pytest.approx(2.0 * 3.0 * ERRORS.of_scene.step_rad**2, rel=1e-4)
        assert slow[name] < fast[name] / 4
    assert all(fast[name] == slow[name] for name in ("velocity", "acceleration"))


def test_no_default_grows_beyond_the_plainly_wrong_or_falls_below_rounding(fourbar: Scene) -> None:
    found = numbers(fourbar, conditioning=1e-9, curvature=1e9)  # near a singular position
    assert found["angle"] == found["position"] == pytest.approx(2e-2)
    assert found["velocity"] == pytest.approx(5e-2)
    assert found["acceleration-differenced"] == pytest.approx(0.5, rel=1e-3)
    assert all(number < 1.0 for number in found.values())
    tiny = numbers(fourbar, step_rad=1e-7)
    assert tiny["velocity"] >= 1e-3 * 1e-7  # the share of an acceleration, over a step
    assert tiny["angle"] >= 1e-11
    assert tiny["acceleration-differenced"] >= 1e-11 / 1e-14


def test_the_command_line_beats_the_scene_and_the_scene_beats_the_default(fourbar: Scene) -> None:
    scene = replace(fourbar, tolerance={"angle": 1e-3, "gap": 2e-3})
    found = limits(scene, ERRORS, {"angle": 5e-5})
    assert (found["angle"].number, found["angle"].origin) == (5e-5, "--tol")
    assert (found["gap"].number, found["gap"].origin) == (2e-3, "scene")
    assert found["position"].origin == "default"
    with pytest.raises(CrankcheckError, match=r"\[tolerance\] positon.*did you mean position"):
        check_names(replace(fourbar, tolerance={"positon": 1.0}))


def test_tolerances_are_read_one_by_one_or_with_commas() -> None:
    found = parse(["angle=1e-4", "gap=1e-6, velocity-differenced = 0.5"])
    assert found == {"angle": 1e-4, "gap": 1e-6, "velocity-differenced": 0.5}
    for text, parts in (
        ("angle", ["--tol 'angle'", "no `=`", "angle=1e-4"]),
        ("angle=small", ["'small' is not a number above 0"]),
        ("angle=0", ["not a number above 0"]),
        ("angle=nan", ["not a number above 0"]),
        ("angle=inf", ["not a number above 0"]),
        ("angel=1e-4", ["'angel' is not a quantity", "did you mean angle"]),
        ("zzz=1", ["use one of drive, angle"]),
    ):
        with pytest.raises(CrankcheckError) as caught:
            parse([text])
        assert all(part in str(caught.value) for part in parts), str(caught.value)


@pytest.mark.parametrize("steps", [360, 1440])
@pytest.mark.parametrize("name", ["fourbar-lecture-1", "slotted-lever"])
def test_the_first_velocities_jump_by_no_more_than_the_jolt(name: str, steps: int) -> None:
    """In pymunk, which starts half a step away from where its joints want it."""
    errors = check(of_turns(name, "pymunk", steps)).errors
    velocity = errors.worst("velocity", "reported", "start")
    differenced = errors.worst("acceleration", "differenced", "start")
    assert 0.3 < velocity.pure / (errors.of_scene.jolt * errors.of_scene.step_rad) < 1.1
    assert 0.3 < differenced.pure / errors.of_scene.jolt < 1.1


def test_the_jolt_of_a_crank_alone_is_half_of_what_keeps_its_end_on_its_circle() -> None:
    """With a long rod the slider's acceleration is the crank's, and nothing turns but the crank."""
    scene = load_scene("slider-crank-central")
    crank = 0.5 * 0.1 / scene.longest_m  # half of omega^2 r of its end, over w^2 L
    assert crank < check(of_turns(scene, "pymunk")).errors.of_scene.jolt < 5.0 * crank


JOLTED = with_facts(ERRORS, curvature=2.0, conditioning=0.5, jolt=3.0)
FINE = with_facts(JOLTED, step_rad=0.005)
WILD = 1e9


def test_the_allowance_follows_the_step_and_halves_where_two_steps_are_differenced() -> None:
    assert allowance("velocity", JOLTED) == pytest.approx(2.0 * allowance("velocity", FINE))
    half = allowance("velocity-differenced", JOLTED)
    assert half == pytest.approx(allowance("velocity", JOLTED) / 2)
    accelerated = allowance("acceleration-differenced", JOLTED)
    assert accelerated == pytest.approx(allowance("acceleration-differenced", FINE))
    assert allowance("angle", JOLTED) == 0.0
    # Light bodies that hold heavy ones may part faster at the start, and not without end.
    apart = allowance("acceleration", with_facts(JOLTED, mass_ratio=100.0))
    assert apart == pytest.approx(100.0 * allowance("acceleration", JOLTED))
    wild = with_facts(JOLTED, mass_ratio=WILD, jolt=WILD)
    assert max(allowance("acceleration", wild), allowance("velocity", wild)) <= 0.1


def test_joints_closed_in_places_may_start_with_the_accelerations_of_a_step_beside() -> None:
    change, half = (
        allowance("acceleration", errors, "solved") - allowance("acceleration", errors)
        for errors in (JOLTED, FINE)
    )
    assert change == pytest.approx(2.0 * half)
    assert change == pytest.approx(1.4 * 0.01 * 2.0**1.5)
    for rate in ("velocity", "velocity-differenced", "acceleration-differenced"):
        assert allowance(rate, JOLTED, "solved") == allowance(rate, JOLTED)
    assert allowance("acceleration", with_facts(JOLTED, curvature=WILD), "solved") <= 0.1


def test_the_mass_ratio_leaves_out_what_has_no_mass(slider_crank: Scene) -> None:
    (slider,) = slider_crank.sliders.values()
    masses = [link.mass_kg for link in slider_crank.links.values()]
    without = replace(slider_crank, sliders={slider.name: replace(slider, mass_kg=0.0)})
    assert mass_ratio(without) == pytest.approx(max(masses) / min(masses))


def test_forces_of_steps_start_for_a_dozen_steps_and_those_of_states_for_forty() -> None:
    for engine, samples in (("pymunk", OF_STEPS), ("mujoco", SETTLING)):
        # The scene in which pymunk rings longest.
        checked = check(of_turns("shaper", engine, 720, with_forces=True))
        assert checked.verdict == "within", checked.failures
        rows = [row for row in checked.errors.rows if row.quantity == "reaction"]
        assert {row.samples for row in rows if row.kind == "start"} == {samples}


ENGINES = ("mujoco", "pymunk")
LAWS = {
    "constant": ConstantSpeed(0.3, 10.0),
    "backwards": ConstantSpeed(-3.0, -7.3),
    "oscillating": Oscillating(1.0, 0.5, 10.0),
}


def share(scene: Scene, errors: Errors) -> float:
    return errors.worst("drive").pure / limits(scene, errors, {})["drive"].number


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("law", few(LAWS, ["backwards", "oscillating"], "forth as backwards"))
@pytest.mark.parametrize(
    ("steps_per_turn", "steps"),
    [
        (977.3, 10_000),
        slowly(90.0, 10_000, reason="steps that divide a turn"),
        slowly(90.0, 1_000_000, reason="what grows with their square is seen in a sum that long"),
    ],
)
def test_the_drive_of_a_long_run_is_within_what_rounding_explains(
    steps_per_turn: float, steps: int, law: str, engine: str, fourbar: Scene
) -> None:
    scene = replace(fourbar, driver=replace(fourbar.driver, law=LAWS[law]))
    state = solve(scene, np.zeros(1)).state()
    dt_s = LAWS[law].period_s / steps_per_turn
    done = run(scene, state, engine, dt_s=dt_s, steps=steps, every=max(steps // 2000, 1))
    assert done.status == "ok"
    assert share(scene, compare(Truth(scene).beside(done))) < 0.7


@pytest.mark.parametrize("engine", ENGINES)
def test_a_hundred_turns_are_within_tolerance_as_one_turn_is(engine: str, fourbar: Scene) -> None:
    found = check(of_turns(fourbar, engine, 90, 100))
    assert found.failures == ()
    assert found.limits["drive"].number > 1e-10


def test_the_sum_goes_with_the_square_of_the_steps_and_more_if_no_line(fourbar: Scene) -> None:
    short, long = (summed(LAWS["constant"], 1e-3, steps) for steps in (10_000, 100_000))
    assert long / short == pytest.approx(100.0, rel=0.03)
    swing = LAWS["oscillating"]
    line = ConstantSpeed(swing.offset_rad, swing.peak_speed_rad_s)
    assert summed(swing, 1e-3, 1000) == pytest.approx(4.0 * summed(line, 1e-3, 1000))
    # Every limit leaves room for what the driver passes on.
    hard = {"curvature": 2.0, "conditioning": 0.5, "step_rad": 1e-6}
    short, long = (numbers(fourbar, **hard, summed_rad=off) for off in (0.0, 1e-4))
    for name in ("drive", "angle", "gap", "velocity", "acceleration"):
        assert long[name] - short[name] >= 1e-4
