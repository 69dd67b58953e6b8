"""The verdict of a cell that was let go: what is caught, what is not graded, and its class."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from analytic.forces.late_impulses import LateImpulses
from models.files import load_scene, parse_scene
from models.released import let_go
from reports.compare.errors import Errors
from reports.judge import halving
from reports.judge.cell import Cell, CellRunner, check, examined
from reports.judge.precision import precision
from reports.judge.rows import cell_row
from reports.judge.tolerance import FREE, default, numbers_for
from reports.judge.too_good import too_good
from sim.engine import Run
from sim.run import run
from tests.worlds.tiers import slowly


def cell(engine: str = "pymunk", seconds: float = 0.3, **changed: Any) -> Cell:
    scene = load_scene("fourbar-swing")
    plain = Cell(scene, engine, "tuned", 1e-3, round(seconds / 1e-3), drive="free", converge=False)
    return replace(plain, **changed)


@cache
def errors_of(engine: str = "pymunk") -> Errors:
    return check(cell(engine)).errors


def broken(runner: CellRunner, **options: float) -> set[str]:
    """The rules that fail where something is not as it should be."""
    return {finding.rule for finding in examined(cell(**options), runner)[0].failures}


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

    assert "CC111" in broken(taken)


def test_a_mass_that_is_off_shows_in_the_phase_and_not_in_the_geometry() -> None:
    def heavy(scene: Any, *names: Any, **asked: Any) -> Run:
        more = replace(scene.links["rocker"], mass_kg=1.2 * scene.links["rocker"].mass_kg)
        return run(replace(scene, links={**scene.links, "rocker": more}), *names, **asked)

    found = broken(heavy, seconds=0.5)
    assert "CC127" in found
    assert not found & {"CC128", "CC105"}


def test_energy_that_is_fed_in_is_a_drift() -> None:
    def fed(*names: Any, **asked: Any) -> Run:
        done = run(*names, **asked)
        more = 1.0 + 0.02 * done.motion.time_s
        return replace(done, energy=replace(done.energy, kinetic_j=more * done.energy.kinetic_j))

    assert broken(fed, seconds=1.0) == {"CC129"}


@pytest.mark.parametrize(
    ("name", "seconds"),
    [("scotch-yoke", 1.4), slowly("shaper", 2.0, reason="the worst of them, which takes longer")],
)
def test_driven_scenes_let_go_are_held_to_what_masses_shake_by(name: str, seconds: float) -> None:
    """Light cranks with heavy sliders: over the step and the curvature alone, pymunk was out by up
    to 19 times the limit of a drift that shrinks with the third order of the step."""
    assert check(cell(seconds=seconds, scene=let_go(load_scene(name)))).verdict == "within"


HELD = """
name = "held"
source = "a test"
ground = { points = { A = [0.0, 0.0] } }
[links]
crank = { bar = ["A", "B"], length_m = 0.1 }
rod = { bar = ["B", "C"], length_m = 0.3 }
[sliders]
C = { on = "ground", mass_kg = 1.0 }
[driver]
link = "crank"
law = "free"
start_deg = -90.0
speed_rad_s = 2.0
duration_s = 0.4
[loads]
feed = { block = "C", force_n = 2.0 }
cut = { block = "C", direction_deg = 180.0, stroke = "forward", slider = "C", force_n = 5.0 }
"""


def test_loads_of_one_stroke_that_hold_the_truth_are_named() -> None:
    """A ram that is fed with 2 N and cuts with 5 N stops, and stays: 3 N push it back where it goes
    on, and 2 N forward where it goes back."""
    errors = check(cell("mujoco", seconds=0.4, scene=parse_scene(HELD, "held"))).errors
    (note,) = [note for note in errors.notes if "held at rest" in note]
    assert "loads of one stroke (cut)" in note
    assert not errors_of("mujoco").notes


def test_limits_grow_with_late_impulses_and_with_what_lasts_and_drifts() -> None:
    errors = errors_of()
    assert numbers_for(errors) is FREE
    assert {"phase", "geometry", "energy", "momentum", "angle", "gap", "velocity"} <= set(FREE)
    assert "drive" not in FREE
    late = replace(errors, late=LateImpulses(0.01, 0.02, 0.03))
    assert default(FREE["energy"], late) == pytest.approx(4.0 * 0.02 + 0.5 * 0.03, rel=1e-6)
    longer = replace(errors, travel_rad=100.0 * errors.travel_rad)
    for each in (late, longer, replace(errors, drifted_rad=100.0)):
        assert default(FREE["phase"], each) > default(FREE["phase"], errors)
        assert default(FREE["geometry"], each) == default(FREE["geometry"], errors)


def test_no_order_is_graded_where_a_start_grows_much(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert check(cell(converge=True)).convergence is not None
    monkeypatch.setattr(halving, "MOST_GROWTH", 0.5)
    assert check(cell(converge=True)).convergence is None


def test_limits_that_the_truth_passes_are_no_departure() -> None:
    """Through limits of the driver, which takes a longer truth: only there assemblies change."""
    scene = load_scene("fourbar-double-rocker-swing")
    checked = check(cell("mujoco", seconds=1.3, scene=scene))
    assert checked.errors.free.passages >= 1
    assert (checked.status, checked.verdict) == ("ok", "within")
    assert any("limits of its angle" in note for note in checked.errors.notes)


def test_what_is_let_go_may_be_as_near_as_the_fourth_order_of_the_step() -> None:
    """MuJoCo's loops, as tuned for that, do not give way; driven ones always do."""
    errors = errors_of("mujoco")
    assert too_good(errors, "integrated", 2) == []
    assert too_good(replace(errors, free=None), "integrated", 2) != []


def test_forces_are_judged_where_they_are_asked_for() -> None:
    checked = check(cell("mujoco", with_forces=True))
    assert checked.verdict == "within"
    row = cell_row(checked)
    assert row["reaction_pure"] < row["reaction_limit_pure"]
    assert np.isfinite(row["reaction_limit_pure"])
