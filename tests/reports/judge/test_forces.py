"""Forces are held to a budget at every step, their columns are there where they were asked for, and
nowhere else."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from models.files import load_scene
from models.friction import ConstantFriction
from models.scene import Scene
from reports.judge.cell import Checked, check
from reports.judge.rows import FORCE_COLUMNS, cell_row
from reports.judge.rules import FORCES
from reports.judge.tolerance import DEFAULTS, default, in_passage
from reports.quantities.places import WITHIN_A_STEP
from tests.worlds.tiers import slowly
from tests.worlds.turns import of_turns

ENGINES = ["mujoco", "pymunk", "exudyn"]
FOURBAR = "fourbar-lecture-1"


def checked(scene: Scene | str, engine: str, steps: int, **options: object) -> Checked:
    return check(of_turns(scene, engine, steps, **{"with_forces": True, **options}))


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("steps", [90, slowly(1440, reason="whether a budget is of that order")])
@pytest.mark.parametrize("name", [FOURBAR, "shaper", "slider-crank-excel-210"])
def test_forces_take_under_six_tenths_of_their_limits(name: str, steps: int, engine: str) -> None:
    found = [f for f in checked(name, engine, steps).findings if f.rule in FORCES]
    assert found
    for finding in found:
        assert finding.level == "pass", finding
        assert finding.number is not None
        assert finding.number / finding.limit < 0.6


@pytest.mark.parametrize(("engine", "most"), [("mujoco", 1e-4), ("exudyn", 2e-4), ("pymunk", 1e-3)])
def test_what_is_reached_at_720_steps_a_turn(engine: str, most: float) -> None:
    errors = checked(FOURBAR, engine, 720).errors
    assert max(errors.worst(quantity).pure for quantity in ("reaction", "torque")) < most


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


def test_columns_of_forces_are_there_where_they_were_asked_for() -> None:
    asked = cell_row(checked("slider-crank-offset", "mujoco", 90))
    plain = cell_row(checked("slider-crank-offset", "mujoco", 90, with_forces=False))
    more = {*FORCE_COLUMNS, "force_pure", "force_trend", "force_order", "force_floor"}
    for name in ("reaction", "normal", "moment", "torque"):
        more |= {f"{name}_pure", f"{name}_limit_pure"}
    assert asked.keys() - plain.keys() == more
    assert list(plain) == [name for name in asked if name not in more]
    assert all(isinstance(asked[name], float) for name in FORCE_COLUMNS)


def test_near_a_change_point_forces_are_not_judged_and_a_limit_that_was_given_stands() -> None:
    found = checked(FOURBAR, "mujoco", 90)
    limit = found.limits["reaction"]
    assert in_passage("reaction", limit, found.errors).number == math.inf
    given = replace(limit, origin="--tol")
    assert in_passage("reaction", given, found.errors) == given
    assert in_passage("velocity", found.limits["velocity"], found.errors).number < math.inf
    assert found.errors.loading == 0.0  # without loads no limit is other than before
    assert not any(found.errors.load_slopes.values())


@pytest.mark.parametrize("name", ["toggle-press", "shaper-cutting"])
def test_loads_that_come_on_within_a_few_steps_are_in_the_budget(name: str) -> None:
    found = checked(name, "mujoco", 720)
    assert found.verdict == "within", found.failures
    without = replace(found.errors, loading=0.0, load_slopes={})
    over = [
        row.quantity
        for row in found.errors.rows
        if row.kind == "total" and not row.pure <= default(DEFAULTS[row.tolerance], without)
    ]
    assert "acceleration" in over  # it is the loads that it takes


def test_of_where_a_slider_is_no_more_is_felt_than_its_limit() -> None:
    errors = checked("toggle-press", "mujoco", 360).errors
    tolerance, most = DEFAULTS["torque"], default(WITHIN_A_STEP, errors)
    slope = errors.load_slopes["torque"] / errors.conditioning
    plain = default(tolerance, replace(errors, load_slopes={}))
    silent = tuple(row for row in errors.rows if row.quantity != "displacement")
    places = (row for row in errors.rows if row.quantity == "displacement")
    far = (*silent, *(replace(row, maximum=row.scale) for row in places))
    for rows in (far, silent):
        found = default(tolerance, replace(errors, rows=rows))
        assert found == pytest.approx(min(plain + slope * most, tolerance.cap), rel=1e-3)
        assert found > default(tolerance, errors)


@pytest.mark.parametrize("engine", ENGINES)
def test_forces_beside_jumps_of_constant_friction_are_left_out_and_counted(engine: str) -> None:
    for name, joint, size in ((FOURBAR, "D", 0.05), ("slider-crank-offset", "C", 0.5)):
        scene = replace(load_scene(name), friction={joint: ConstantFriction(joint, size)})
        found = checked(scene, engine, 360)
        assert found.verdict == "within", found.failures
        assert any("12 samples of 36" in note for note in found.errors.notes)
