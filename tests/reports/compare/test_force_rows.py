"""The forces of a run beside kinetostatics: at their own instants, and with a word for what is not
compared."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from models.array import Array
from models.files import load_scene, parse_scene
from models.forces import Forces
from models.scene import Scene
from reports.compare.beside import Beside, Truth
from reports.compare.compare import compare
from reports.compare.errors import Errors
from reports.compare.force_rows import force_rows
from reports.judge.rules import RULES
from reports.judge.rules.rule import Evidence
from reports.stability.catalogue import CATALOGUE
from sim.engine import Run
from sim.run import run

FOURBAR = load_scene("fourbar-lecture-1")


@cache
def _run(engine: str, name: str = "fourbar-lecture-1", steps: int = 360) -> Run:
    return _of(load_scene(name), engine, steps)


def _of(scene: Scene, engine: str, steps: int = 360, *, with_forces: bool = True) -> Run:
    dt_s = scene.driver.law.period_s / steps
    start = Truth(scene).start
    return run(scene, start, engine, dt_s=dt_s, steps=steps, with_forces=with_forces)


def _errors(scene: Scene, done: Run) -> Errors:
    return compare(Beside.of(Truth(scene), done))


def _with(done: Run, change: Callable[[Forces], Forces]) -> Run:
    return replace(done, motion=replace(done.motion, forces=change(done.motion.forces)))


def test_without_forces_the_errors_are_the_same_to_the_bit() -> None:
    plain = _errors(FOURBAR, _of(FOURBAR, "mujoco", with_forces=False))
    asked = _errors(FOURBAR, _run("mujoco"))
    names = {"reaction", "normal", "moment", "torque"}
    assert [row for row in asked.rows if row.quantity not in names] == list(plain.rows)
    assert {row.quantity for row in asked.rows} & names == {"reaction", "torque"}
    assert plain.unbalanced is None


def test_forces_of_steps_have_none_at_the_start_and_that_is_no_error() -> None:
    done = _run("pymunk")
    assert done.forces_of == "steps"
    assert np.isnan(done.motion.forces.torque[0])
    rows = [row for row in force_rows(_beside(FOURBAR, done)).rows if row.quantity == "torque"]
    assert all(row.finite for row in rows)
    assert sum(row.samples for row in rows) == 360


def _beside(scene: Scene, done: Run) -> Beside:
    return Beside.of(Truth(scene), done)


@pytest.mark.parametrize("engine", ["mujoco", "pymunk"])
def test_a_number_that_is_missing_later_is_an_error(engine: str) -> None:
    def broken(own: Forces) -> Forces:
        torque = own.torque.copy()
        torque[200] = np.nan
        return replace(own, torque=torque)

    worst = _errors(FOURBAR, _with(_run(engine), broken)).worst("torque")
    assert not worst.finite


def test_a_stamp_half_a_step_off_is_an_error_of_first_order() -> None:
    sizes = []
    for steps in (360, 720):
        done = _run("mujoco", steps=steps)
        late = _with(done, lambda own, by=done.dt_s: replace(own, time_s=own.time_s + 0.5 * by))
        worst = _errors(FOURBAR, late).worst("reaction")
        sizes.append(worst.pure)
    assert sizes[0] / sizes[1] == pytest.approx(2.0, rel=0.05)


def test_stamps_that_are_over_a_step_away_are_told() -> None:
    done = _run("mujoco")
    assert not _errors(FOURBAR, done).incomplete
    off = _with(done, lambda own: replace(own, time_s=own.time_s + 1.01 * done.dt_s))
    assert "over a step away (361 samples of 361)" in _errors(FOURBAR, off).incomplete


def test_forces_that_are_not_there_are_errors_of_every_pin() -> None:
    done = _run("mujoco")
    rows = _errors(FOURBAR, replace(done, motion=replace(done.motion, forces=None))).rows
    broken = {row.body for row in rows if row.quantity == "reaction" and not row.finite}
    assert broken == {"A", "B", "C", "D"}


def test_a_pin_of_three_bodies_is_compared_on_each_of_them() -> None:
    scene = load_scene("sixbar-watt")
    bodies = {row.body for row in _errors(scene, _run("mujoco", "sixbar-watt")).rows}
    three = [p for p, names in scene.pins.items() if len(names) > 2]
    assert {f"{p} on {name}" for p in three for name in scene.pins[p]} <= bodies


def test_of_a_sum_that_is_not_zero_the_pin_is_told() -> None:
    def pushed(own: Forces) -> Forces:
        return replace(
            own, pins={**own.pins, "C": {**own.pins["C"], "rocker": own.pins["C"]["rocker"] + 0.1}}
        )

    assert _errors(FOURBAR, _run("mujoco")).unbalanced.share < 1e-12  # type: ignore[union-attr]
    found = _errors(FOURBAR, _with(_run("mujoco"), pushed)).unbalanced
    assert (found.point, found.share) == ("C", pytest.approx(0.1 * 2**0.5 / 5.75, rel=0.01))


def test_redundant_links_leave_the_torque_alone_with_a_note() -> None:
    case = CATALOGUE["double-parallelogram"]
    scene = case.trial(case.values[0]).scene
    errors = _errors(scene, _of(scene, "mujoco"))
    assert errors.worst("reaction") is None
    assert errors.worst("torque") is not None
    assert any("redundant links (third)" in note for note in errors.notes)


def test_samples_in_dead_points_are_left_out_and_counted() -> None:
    case = CATALOGUE["isosceles"]
    scene = case.trial(case.values[0]).scene
    done = _of(scene, "exudyn")
    truth = Truth(scene)
    motion = truth.with_forces_at(done.motion.time_s)

    def dead(series: Array) -> Array:
        changed = series.copy()
        changed[100:103] = np.nan
        return changed

    truth._loaded[done.motion.time_s.tobytes()] = replace(
        motion, forces=motion.forces.each_series(dead)
    )
    beside = Beside.of(truth, done)
    found = force_rows(beside)
    assert all(row.finite for row in found.rows)
    samples = sum(row.samples for row in found.rows if row.quantity == "torque")
    assert samples == done.motion.time_s.size - 3
    assert any("3 samples of 361 in dead points left out" in note for note in found.notes)


def test_the_torque_of_a_parallelogram_at_constant_speed_is_held_to_an_arm() -> None:
    case = CATALOGUE["parallelogram"]
    scene = case.trial(case.values[0]).scene
    worst = _errors(scene, _of(scene, "mujoco")).worst("torque")
    assert worst.scale > 1e-3  # N m, of a torque that is 0
    assert worst.pure < 1e-2


YOKE = """
name = "yoke"
source = "made here: two bodies at R that never turn against each other"
gravity_m_s2 = [0.0, -9.81]
ground = { points = { A = [0.0, 0.0] } }
friction = { R = { torque_n_m = 0.05 } }
branch = { S = 1 }

[links]
crank = { bar = ["A", "B"], length_m = 0.1 }
yoke = { points = { Q = [0.0, 0.0], R = [0.0, 0.3] }, mass_kg = 1.0 }
tool = { points = { R = [0.0, 0.0], S = [0.1, 0.0] }, mass_kg = 1.0 }

[sliders]
Q = { on = "ground", link = "yoke" }
B = { on = "yoke", direction_deg = 90.0 }
S = { on = "ground", through_m = [0.0, 0.3] }

[driver]
link = "crank"
speed_rad_s = 10.0
start_deg = 30.0
"""


def test_forces_that_the_reference_knows_at_no_sample_are_not_taken_for_judged() -> None:
    """Friction in a joint that never turns may be either way."""
    yoke = parse_scene(YOKE, "here")
    errors = _errors(yoke, _of(yoke, "pymunk"))
    assert errors.uncertain["moment", "Q"] > 0.01
    assert not any((row.quantity, row.body) == ("moment", "Q") for row in errors.rows)


def test_what_the_engine_says_against_its_forces_fails_a_rule() -> None:
    said = ("at 1 s the impulse on pin C is 2, and 3 by the momentum of the bodies",)
    done = _with(_run("pymunk"), lambda forces: replace(forces, contradictions=said))
    errors = _errors(FOURBAR, done)
    assert errors.contradictions == said
    finding = RULES["CC126"].check(Evidence("ok", "", 1.0, errors, {}))
    assert finding.level == "fail"
    assert said[0] in finding.text
    assert (
        RULES["CC126"].check(Evidence("ok", "", 1.0, replace(errors, contradictions=()), {}))
        is None
    )
