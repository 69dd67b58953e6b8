"""Cells of which forces are asked for, and such as were let go: what is caught, what is not graded,
and what stands in their rows."""

import math
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from analytic.forces.late_impulses import LateImpulses
from models.files.reading import load_scene
from models.scene import Scene
from models.scene.characteristics import Constant
from models.scene.driver import let_go
from models.scene.loads import ConstantFriction, Load
from models.scene.moved import scaled
from reports.compare import free_facts
from reports.compare.errors import DRIVEN, Errors
from reports.judge.cell import Cell, Checked, check, examined
from reports.judge.rows import cell_row
from reports.judge.rules import FORCES
from reports.judge.rules.reference import too_good
from reports.judge.three_steps import AT_ROUNDING
from reports.judge.tolerance import default, in_passage
from reports.quantities.limits import DEFAULTS, FREE
from reports.quantities.places import WITHIN_A_STEP
from reports.ways.free.columns import precision
from sim.engine import Run
from sim.run import run
from tests.worlds.facts import with_facts
from tests.worlds.tiers import slow, slowly
from tests.worlds.turns import of_turns

ENGINES = ["mujoco", "pymunk", "exudyn"]
FOURBAR = "fourbar-lecture-1"


def checked(scene: Scene | str, engine: str, steps: int, **options: object) -> Checked:
    return check(of_turns(scene, engine, steps, **{"with_forces": True, **options}))


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("steps", [90, slowly(1440, reason="whether a budget is of that order")])
@pytest.mark.parametrize("name", [FOURBAR, "shaper"])
def test_forces_take_under_six_tenths_of_their_limits(name: str, steps: int, engine: str) -> None:
    found = [f for f in checked(name, engine, steps).findings if f.rule in FORCES]
    assert found
    for finding in found:
        assert finding.level == "pass", finding
        assert finding.number is not None
        assert finding.number / finding.limit < 0.6


def test_the_order_of_forces_and_their_floor_are_told_beside_those_of_places() -> None:
    soft = checked(FOURBAR, "mujoco", 720, converge=True)
    hard = checked(FOURBAR, "pymunk", 360, converge=True)
    assert 1e-6 < soft.force_convergence.floor < 1e-4
    assert hard.force_convergence.order == pytest.approx(2.0, abs=0.2)
    assert hard.convergence is not None
    row = cell_row(hard)
    assert row["force_trend"] == "shrinks"
    assert math.isnan(row["force_floor"])
    by_rule = {finding.rule: finding.level for finding in soft.findings}
    assert by_rule["CC125"] == "pass"  # a floor of the soft constraint's size is no news


def test_near_a_change_point_forces_are_not_judged_and_a_limit_that_was_given_stands() -> None:
    found = checked(FOURBAR, "mujoco", 90)
    limit = found.limits["reaction"]
    assert in_passage("reaction", limit, found.errors).number == math.inf
    given = replace(limit, origin="--tol")
    assert in_passage("reaction", given, found.errors) == given
    assert in_passage("velocity", found.limits["velocity"], found.errors).number < math.inf
    assert found.errors.of_forces.loading == 0.0  # without loads no limit is other than before
    assert not any(found.errors.of_forces.load_slopes.values())


@pytest.mark.parametrize("name", ["toggle-press", "shaper-cutting"])
def test_loads_that_come_on_within_a_few_steps_are_in_the_budget(name: str) -> None:
    found = checked(name, "mujoco", 720)
    assert found.verdict == "within", found.failures
    without = with_facts(found.errors, loading=0.0, load_slopes={})
    over = [
        row.quantity
        for row in found.errors.rows
        if row.kind == "total" and not row.pure <= default(DEFAULTS[row.tolerance], without)
    ]
    assert "acceleration" in over  # it is the loads that it takes


def test_of_where_a_slider_is_no_more_is_felt_than_its_limit() -> None:
    errors = checked("toggle-press", "mujoco", 360).errors
    tolerance, most = DEFAULTS["torque"], default(WITHIN_A_STEP, errors)
    slope = errors.of_forces.load_slopes["torque"] / errors.of_scene.conditioning
    plain = default(tolerance, with_facts(errors, load_slopes={}))
    silent = tuple(row for row in errors.rows if row.quantity != "displacement")
    places = (row for row in errors.rows if row.quantity == "displacement")
    far = (*silent, *(replace(row, maximum=row.scale) for row in places))
    for rows in (far, silent):
        found = default(tolerance, replace(errors, rows=rows))
        assert found == pytest.approx(min(plain + slope * most, tolerance.cap), rel=1e-3)
        assert found > default(tolerance, errors)


@pytest.mark.parametrize(
    ("size_m", "times", "crank", "speed", "steps_per_turn", "drive"),
    [
        (0.05, 1.0, 1.0, 0.5, 360, "prescribed"),
        (0.25, 1e-2, 1e3, 0.3, 360, "prescribed"),
        (5.0, 1e3, 1.0, 300.0, 2880, "prescribed"),
        (3.0, 1e2, 1.0, 300.0, 1440, "free"),
    ],
)
def test_newtons_method_ends_by_one_measure_for_all_sizes_masses_and_speeds(
    size_m: float, times: float, crank: float, speed: float, steps_per_turn: int, drive: Any
) -> None:
    """Forces and gaps below 1e-10 N and m end it too soon where forces are small, and never where
    they are rounded by more than that."""
    plain = load_scene(FOURBAR)
    scene = scaled(plain, size_m / plain.longest_m)
    links = {
        name: replace(link, mass_kg=link.mass_kg * by, inertia_kg_m2=link.inertia_kg_m2 * by)
        for name, link in scene.links.items()
        for by in [times * (crank if name == "crank" else 1.0)]
    }
    law = replace(scene.driver.law, speed_rad_s=speed)
    scene = replace(scene, links=links, driver=replace(scene.driver, law=law))
    scene = let_go(scene) if drive == "free" else replace(scene, gravity_m_s2=(0.0, -9.81))
    asked = Cell(scene, "exudyn", "tuned", math.tau / speed / steps_per_turn, 240, drive=drive)
    found = check(asked)
    assert (found.verdict, found.convergence.faults) == ("within", ()), found.failures
    if drive == "prescribed":
        assert max(found.convergence.error) < AT_ROUNDING
    used = "increments" if drive == "prescribed" else "forces"
    assert found.settings["residual_used"] == used


@pytest.mark.parametrize(
    ("name", "engine", "joint", "size"),
    [
        (FOURBAR, "pymunk", "D", 0.05),
        (FOURBAR, "exudyn", "D", 0.05),
        ("slider-crank-offset", "mujoco", "C", 0.5),
    ],
)
def test_forces_beside_jumps_are_left_out(name: str, engine: str, joint: str, size: float) -> None:
    scene = replace(load_scene(name), friction={joint: ConstantFriction(joint, size)})
    found = checked(scene, engine, 360)
    assert found.verdict == "within", found.failures
    assert any("12 samples of 36" in note for note in found.errors.notes)
    assert engine != "mujoco" or found.settings["iterations_of_friction"] == 20


def cell(engine: str = "pymunk", seconds: float = 0.3, **changed: Any) -> Cell:
    scene = load_scene("fourbar-swing")
    plain = Cell(scene, engine, "tuned", 1e-3, round(seconds / 1e-3), drive="free", converge=False)
    return replace(plain, **changed)


@cache
def errors_of(engine: str = "pymunk") -> Errors:
    return check(cell(engine)).errors


def test_engines_are_told_apart_by_the_class_that_they_reach() -> None:
    coarse, fine = (check(cell(engine)) for engine in ("pymunk", "mujoco"))
    assert (coarse.verdict, fine.verdict) == ("within", "within")
    assert precision(coarse).startswith("common")
    row = cell_row(fine)
    assert precision(fine) == row["precision"] == "fine, 1e-3"
    assert row["judged_until_s"] == pytest.approx(0.3)
    assert row["energy_pure"] is not None
    assert "drive_pure" not in row


def test_the_truth_in_the_place_of_an_engine_is_caught() -> None:
    truth = cell().truth

    def taken(*names: Any, **asked: Any) -> Run:
        done = run(*names, **asked)
        motion = truth.at(done.motion.time_s)
        return replace(done, motion=replace(motion, bound=None), velocity_time_s=motion.time_s)

    assert "CC111" in {finding.rule for finding in examined(cell(), taken)[0].failures}


@slow("seconds of the light cranks with heavy sliders that shake most")
@pytest.mark.parametrize(("name", "seconds"), [("scotch-yoke", 1.4), ("shaper", 2.0)])
def test_driven_scenes_let_go_are_held_to_what_masses_shake_by(name: str, seconds: float) -> None:
    """Light cranks with heavy sliders: over the step and the curvature alone, pymunk was out by up
    to 19 times the limit of a drift that shrinks with the third order of the step."""
    assert check(cell(seconds=seconds, scene=let_go(load_scene(name)))).verdict == "within"


def test_loads_of_one_stroke_that_hold_the_truth_are_named() -> None:
    """A ram that is fed with 2 N and cuts with 5 N stops, and stays: 3 N push it back where it goes
    on, and 2 N forward where it goes back."""
    scene = let_go(load_scene("slider-crank-central"))
    back = {"direction_rad": math.pi, "stroke": "forward", "slider": "C"}
    loads = {
        "feed": Load("feed", "block C", "C", Constant(2.0)),
        "cut": Load("cut", "block C", "C", Constant(5.0), **back),  # type: ignore[arg-type]
    }
    law = replace(scene.driver.law, start_rad=-0.5 * math.pi, speed_rad_s=2.0)
    held = replace(scene, loads=loads, driver=replace(scene.driver, law=law))
    errors = check(cell("mujoco", seconds=0.4, scene=held)).errors
    (note,) = [note for note in errors.notes if "hold it at rest" in note]
    assert "loads of one stroke (cut)" in note
    assert not errors_of("mujoco").notes


def test_limits_grow_with_late_impulses_and_with_what_lasts_and_drifts() -> None:
    errors = errors_of()
    assert errors.limits == FREE
    assert {"phase", "geometry", "energy", "momentum", "angle", "gap", "velocity"} <= set(FREE)
    assert "drive" not in FREE
    late = with_facts(errors, late=LateImpulses(0.01, 0.02, 0.03))
    assert default(FREE["energy"], late) == pytest.approx(4.0 * 0.02 + 0.5 * 0.03, rel=1e-6)
    longer = with_facts(errors, travel_rad=100.0 * errors.of_motion.travel_rad)
    for each in (late, longer, with_facts(errors, drifted_rad=100.0)):
        assert default(FREE["phase"], each) > default(FREE["phase"], errors)
        assert default(FREE["geometry"], each) == default(FREE["geometry"], errors)

    def lasted(**changed: float) -> float:
        own = with_facts(errors, **changed)
        longer = with_facts(own, travel_rad=100.0 * own.of_motion.travel_rad)
        return default(FREE["phase"], longer) - default(FREE["phase"], own)

    assert lasted(step_rad=0.01) == pytest.approx(8.0 * lasted(step_rad=0.005))
    assert lasted(curvature=4.0) == pytest.approx(8.0 * lasted(curvature=1.0))


def test_no_order_is_graded_where_a_start_grows_much(monkeypatch: pytest.MonkeyPatch) -> None:
    assert check(cell(converge=True)).convergence is not None
    monkeypatch.setattr(free_facts, "MOST_GROWTH", 0.5)
    assert check(cell(converge=True)).convergence is None


@slow("0.6 s: rare, a driver that turns back at its limits")
def test_limits_that_the_truth_passes_are_no_departure() -> None:
    """Through limits of the driver, which takes a longer truth: only there assemblies change."""
    scene = load_scene("fourbar-double-rocker-swing")
    checked = check(cell("mujoco", seconds=0.5, scene=scene))
    assert checked.errors.of_motion.passages >= 1
    assert (checked.status, checked.verdict) == ("ok", "within")
    assert any("limits of its angle" in note for note in checked.errors.notes)


def test_what_is_let_go_may_be_as_near_as_the_fourth_order_of_the_step() -> None:
    """MuJoCo's loops, as tuned for that, do not give way; driven ones always do."""
    errors = errors_of("mujoco")
    assert too_good(errors, "integrated", 2) == []
    assert too_good(replace(errors, of_motion=DRIVEN), "integrated", 2) != []


def test_forces_are_judged_where_they_are_asked_for() -> None:
    checked = check(cell("mujoco", with_forces=True))
    assert checked.verdict == "within"
    row = cell_row(checked)
    assert row["reaction_pure"] < row["reaction_limit_pure"]
    assert np.isfinite(row["reaction_limit_pure"])
