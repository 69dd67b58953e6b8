"""The forces of a run beside kinetostatics, at their own instants, and with a word for what is not
compared; how hard loads are on an engine, and the samples beside jumps of forces."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve
from models.array import Array
from models.files.reading import load_scene, parse_scene
from models.motion import Forces, Motion
from models.scene import Scene
from models.scene.characteristics import Characteristic, Constant, Polynomial, Sine
from models.scene.loads import ConstantFriction, Load
from models.scene.tabulated import Tabulated
from reports.compare.compare import Truth, compare
from reports.compare.errors import Errors
from reports.compare.hardness import inertia_share, load_slopes, loading
from reports.compare.whole_errors import NEAR, force_rows, near_jumps
from reports.judge.rules import RULES
from reports.judge.rules.rule import Evidence
from reports.stability.grading import CATALOGUE
from sim.engine import Run, Unreported
from sim.run import run
from tests.worlds.facts import with_facts

FOURBAR = load_scene("fourbar-lecture-1")


def _of(scene: Scene, engine: str, steps: int = 360, *, with_forces: bool = True) -> Run:
    dt_s = scene.driver.law.period_s / steps
    start = Truth(scene).start
    return run(scene, start, engine, dt_s=dt_s, steps=steps, with_forces=with_forces)


@cache
def _run(engine: str, steps: int = 360) -> Run:
    return _of(FOURBAR, engine, steps)


def _case(name: str) -> Scene:
    case = CATALOGUE[name]
    return case.trial(case.values[0]).scene


def _errors(done: Run, scene: Scene = FOURBAR) -> Errors:
    return compare(Truth(scene).beside(done))


def _with(done: Run, change: Callable[[Forces], Forces]) -> Run:
    return replace(done, motion=replace(done.motion, forces=change(done.motion.forces)))


def _late(done: Run, steps: float) -> Errors:
    """With stamps of forces that are so many steps off."""
    by_s = steps * done.dt_s
    return _errors(_with(done, lambda own: replace(own, time_s=own.time_s + by_s)))


def test_a_stamp_half_a_step_off_is_an_error_of_first_order_and_one_of_over_a_step_told() -> None:
    coarse, fine = (
        _late(_run("mujoco", steps), 0.5).worst("reaction").pure for steps in (360, 720)
    )
    assert coarse / fine == pytest.approx(2.0, rel=0.05)
    assert not _errors(_run("mujoco")).incomplete
    told = _late(_run("mujoco"), 1.01).incomplete
    assert "over a step away (361 samples of 361)" in told


def test_forces_that_an_engine_does_not_report_are_not_compared_and_named() -> None:
    done = replace(_run("mujoco"), unreported=Unreported(pins=frozenset("A"), torque=True))
    for each in (done, _with(done, lambda own: replace(own, torque=own.torque * np.nan))):
        errors = _errors(each)
        forces = {row.body for row in errors.rows if row.quantity in ("reaction", "torque")}
        assert forces == {"B", "C", "D"}
        assert errors.not_reported == ("reaction of point A", "torque of driver crank")
        assert "forces: mujoco does not report those of pin A and the drive" in errors.notes
    sliding = load_scene("slider-crank-offset")
    done = replace(_of(sliding, "mujoco"), unreported=Unreported(sliders=frozenset("C")))
    errors = _errors(done, sliding)
    assert {row.quantity for row in errors.rows if row.body == "C"} >= {"reaction", "displacement"}
    assert errors.worst("normal") is None


def test_forces_that_are_not_there_are_errors_of_every_pin() -> None:
    done = _run("mujoco")
    rows = _errors(replace(done, motion=replace(done.motion, forces=None))).rows
    broken = {row.body for row in rows if row.quantity == "reaction" and not row.finite}
    assert broken == {"A", "B", "C", "D"}


def test_of_a_sum_that_is_not_zero_the_pin_is_told() -> None:
    def pushed(own: Forces) -> Forces:
        more = {**own.pins["C"], "rocker": own.pins["C"]["rocker"] + 0.1}
        return replace(own, pins={**own.pins, "C": more})

    assert _errors(_run("mujoco")).of_forces.unbalanced.share < 1e-12  # type: ignore[union-attr]
    found = _errors(_with(_run("mujoco"), pushed)).of_forces.unbalanced
    assert (found.point, found.share) == ("C", pytest.approx(0.1 * 2**0.5 / 5.75, rel=0.01))


def test_redundant_links_leave_the_torque_alone_with_a_note() -> None:
    scene = _case("double-parallelogram")
    errors = _errors(_of(scene, "mujoco"), scene)
    assert errors.worst("reaction") is None
    assert errors.worst("torque") is not None
    assert any("redundant links (third)" in note for note in errors.notes)


def test_samples_in_dead_points_are_left_out_and_counted() -> None:
    scene = _case("isosceles")
    done = _of(scene, "exudyn")
    time_s, truth = done.motion.time_s, Truth(scene)

    def dead(series: Array) -> Array:
        changed = series.copy()
        changed[100:103] = np.nan
        return changed

    motion = truth.with_forces_at(time_s)
    truth._loaded[time_s.tobytes()] = replace(motion, forces=motion.forces.each_series(dead))
    found = force_rows(truth.beside(done))
    assert all(row.finite for row in found.rows)
    samples = sum(row.samples for row in found.rows if row.quantity == "torque")
    assert samples == time_s.size - 3
    assert any("left out 3 samples of 361, in dead points" in note for note in found.notes)


def test_the_torque_of_a_parallelogram_at_constant_speed_is_held_to_an_arm() -> None:
    scene = _case("parallelogram")
    worst = _errors(_of(scene, "mujoco"), scene).worst("torque")
    assert worst.scale > 1e-3  # N m, of a torque that is 0
    assert worst.pure < 1e-2


YOKE = """
name = "yoke"
source = "made here: two bodies at R that never turn against each other"
gravity_m_s2 = [0.0, -9.81]
ground = { points = { A = [0.0, 0.0] } }
friction = { R = { torque_n_m = 0.05 } }
branch = { S = 1 }
driver = { link = "crank", speed_rad_s = 10.0, start_deg = 30.0 }
[links]
crank = { bar = ["A", "B"], length_m = 0.1 }
yoke = { points = { Q = [0.0, 0.0], R = [0.0, 0.3] }, mass_kg = 1.0 }
tool = { points = { R = [0.0, 0.0], S = [0.1, 0.0] }, mass_kg = 1.0 }
[sliders]
Q = { on = "ground", link = "yoke" }
B = { on = "yoke", direction_deg = 90.0 }
S = { on = "ground", through_m = [0.0, 0.3] }
"""


def test_forces_that_the_reference_knows_at_no_sample_are_not_taken_for_judged() -> None:
    """Friction in a joint that never turns may be either way."""
    yoke = parse_scene(YOKE, "here")
    errors = _errors(_of(yoke, "pymunk"), yoke)
    assert errors.uncertain["moment", "Q"] > 0.01
    assert not any((row.quantity, row.body) == ("moment", "Q") for row in errors.rows)


def test_what_the_engine_says_against_its_forces_fails_a_rule() -> None:
    said = ("at 1 s the impulse on pin C is 2, and 3 by the momentum of the bodies",)
    errors = _errors(_with(_run("pymunk"), lambda forces: replace(forces, contradictions=said)))
    assert errors.of_forces.contradictions == said
    finding = RULES["CC126"].check(Evidence("ok", "", 1.0, errors, {}))
    assert finding.level == "fail"
    assert said[0] in finding.text
    silent = Evidence("ok", "", 1.0, with_facts(errors, contradictions=()), {})
    assert RULES["CC126"].check(silent) is None


SLIDER = load_scene("slider-crank-offset")
PERIOD_S, SPEED_RAD_S = SLIDER.driver.law.period_s, SLIDER.driver.law.peak_speed_rad_s
STEP_RAD = 2 * np.pi / 360


def _loaded(load: Load, scene: Scene = SLIDER) -> Scene:
    return replace(scene, loads={load.name: load})


def _pushed(law: Characteristic, **more: object) -> Scene:
    return _loaded(Load("push", "block C", "C", law, **more))  # type: ignore[arg-type]


def _motion(scene: Scene, steps: int = 360) -> Motion:
    return solve(scene, np.linspace(0.0, scene.driver.law.period_s, steps + 1), bound=False)


def _shaken(force: float, inertia: float) -> object:
    """The second difference of a force, or a torque, that swings once a turn."""
    return pytest.approx(force / inertia * (STEP_RAD / SPEED_RAD_S) ** 2, rel=1e-3)


SINE = Sine(1.0, PERIOD_S)
BLOCK = SLIDER.sliders["C"]
SHAKES = {
    "no load": (SLIDER, 0.0),
    "one that grows evenly": (
        _pushed(Polynomial((3.0, 100.0))), pytest.approx(0.0, abs=1e-10),
    ),
    "a table that ends before the motion": (_pushed(Tabulated((0.0, 1e-3), (0.0, 1.0))), 0.0),
    "a sine, by the mass of its body": (
        _pushed(Sine(100.0, PERIOD_S)), _shaken(100.0, BLOCK.mass_kg * SLIDER.longest_m),
    ),
    "a torque, by the inertia of its link": (
        _loaded(Load("turn", "rod", None, SINE)), _shaken(1.0, SLIDER.links["rod"].inertia_kg_m2),
    ),
    "a torque on a link that a guide holds": (
        _loaded(Load("turn", "ram", None, SINE), load_scene("shaper-cutting")), 0.0,
    ),
    "a constant in the frame of a body, as that turns": (
        _loaded(Load("push", "crank", "B", Constant(10.0), frame="body")),
        _shaken(10.0, SLIDER.links["crank"].mass_kg * SLIDER.longest_m),
    ),
}  # fmt: skip


def test_a_load_shakes_bodies_by_its_second_difference() -> None:
    for load, (scene, expected) in SHAKES.items():
        assert loading(scene, _motion(scene)) == expected, load
    # A body without mass counts as the lightest.
    light = replace(_pushed(SINE), sliders={"C": replace(BLOCK, mass_kg=0.0)})
    assert 0.0 < loading(light, _motion(light)) < np.inf


def test_the_slope_is_that_of_the_stroke_on_which_the_load_acts() -> None:
    press = load_scene("toggle-press")
    work = replace(press, loads={"work": press.loads["work"]})
    both, one = (load_slopes(scene, _motion(press, 720), 1e5, 1e3) for scene in (press, work))
    chord = 1e5 / 3e-3  # N/m; a cubic is taken to be three times as steep as its chord
    assert one["reaction"] == pytest.approx(3 * chord * press.longest_m / 1e5, rel=1e-6)
    assert both["reaction"] == pytest.approx(6 * one["reaction"], rel=1e-6)  # over 0.5 mm
    for scene in (SLIDER, _pushed(Sine(100.0, 0.1))):  # without loads over a displacement
        assert load_slopes(scene, _motion(scene), 1.0, 1.0) == {"reaction": 0.0, "torque": 0.0}


def test_the_slope_of_the_torque_is_by_the_speed_of_what_is_loaded() -> None:
    scene = _pushed(Polynomial((0.0, 50.0)), over="displacement", slider="C")
    motion = _motion(scene)
    found = load_slopes(scene, motion, 2.0, 4.0)
    speed = np.max(np.abs(motion.sliders["C"].speed)) / SPEED_RAD_S
    assert found["reaction"] == pytest.approx(50.0 * scene.longest_m / 2.0)
    assert found["torque"] == pytest.approx(50.0 * scene.longest_m * speed / 4.0, rel=1e-6)


def test_inertia_has_a_share_of_one_at_most() -> None:
    assert inertia_share(SLIDER, 1e-3) > 1.0
    assert inertia_share(SLIDER, 1e6) == pytest.approx(inertia_share(SLIDER, 1e5) / 10)


def _near(scene: Scene, steps: int = 360) -> list[int]:
    motion = _motion(scene, steps)
    motion = replace(motion, forces=forces(scene, motion, bound=False))
    return np.flatnonzero(near_jumps(scene, motion)).tolist()


TURNS = np.flatnonzero(np.diff(np.sign(_motion(SLIDER).sliders["C"].speed))).tolist()
"""The samples after which the slider turns back."""


def _beside(turns: list[int]) -> list[int]:
    return sorted(k + by for k in turns for by in range(1 - NEAR, 1 + NEAR))


def test_friction_jumps_where_its_joint_turns_and_a_load_of_a_stroke_where_it_is_not_0() -> None:
    assert _near(SLIDER) == _near(_pushed(Constant(1.0))) == []
    scene = replace(SLIDER, friction={"C": ConstantFriction("C", 0.5)})
    assert len(TURNS) == 2
    assert _near(scene) == _beside(TURNS)
    assert _near(scene, 2) == [0, 1, 2]  # of few samples all are beside a jump
    stroke = {"slider": "C", "stroke": "forward"}
    assert _near(_pushed(Constant(1.0), **stroke)) == _beside(TURNS)
    ends = Tabulated((-1.0, 0.3, 0.35, 1.0), (0.0, 0.0, 1.0, 1.0))  # at the outer end alone
    assert _near(_pushed(ends, over="displacement", **stroke)) == _beside(TURNS[1:])
