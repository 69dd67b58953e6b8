"""The verdict of a cell that was let go: what is caught, what is not graded, and its class."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.forces.late_impulses import LateImpulses
from models.files import load_scene, parse_scene
from models.released import let_go
from models.scene import Scene
from reports.judge.cell import Cell, Checked, check, examined
from reports.judge.precision import precision
from reports.judge.rows import cell_row
from reports.judge.three_steps import convergence
from reports.judge.tolerance import FREE, numbers_for
from reports.judge.too_good import too_good
from sim.engine import Run
from sim.run import run
from tests.worlds.tiers import slowly


def cell(engine: str = "pymunk", seconds: float = 0.3, **changed: object) -> Cell:
    scene = load_scene("fourbar-swing")
    plain = Cell(scene, engine, "tuned", 1e-3, round(seconds / 1e-3), drive="free", converge=False)
    return replace(plain, **changed)


def with_fault(change: object, **options: object) -> Checked:
    """What is said of a run in which something is not as it should be."""

    def runner(scene: Scene, state: object, *names: str, **asked: object) -> Run:
        return change(scene, state, names, asked)  # type: ignore[operator]

    return examined(cell(**options), runner)[0]


def rules(checked: Checked) -> set[str]:
    return {finding.rule for finding in checked.failures}


def test_engines_are_told_apart_by_the_class_that_they_reach() -> None:
    coarse, fine = (check(cell(engine)) for engine in ("pymunk", "mujoco"))
    assert (coarse.verdict, fine.verdict) == ("within", "within")
    assert precision(coarse).startswith("common")
    assert precision(fine) == "fine, 1e-3"
    row = cell_row(fine)
    assert row["precision"] == "fine, 1e-3"
    assert row["judged_until_s"] == pytest.approx(0.3)
    assert row["energy_pure"] is not None
    assert "drive_pure" not in row


def test_the_truth_in_the_place_of_an_engine_is_caught() -> None:
    truth = cell().truth

    def taken(scene: Scene, state: object, names: tuple[str, str], asked: dict[str, object]) -> Run:
        done = run(scene, state, *names, **asked)  # type: ignore[arg-type]
        motion = truth.at(done.motion.time_s)  # type: ignore[union-attr]
        return replace(done, motion=replace(motion, bound=None), velocity_time_s=motion.time_s)

    assert "CC111" in rules(with_fault(taken))


def test_a_mass_that_is_off_shows_in_the_phase_and_not_in_the_geometry() -> None:
    def heavy(scene: Scene, state: object, names: tuple[str, str], asked: dict[str, object]) -> Run:
        rod = scene.links["rocker"]
        more = replace(rod, mass_kg=1.2 * rod.mass_kg)
        other = replace(scene, links={**scene.links, "rocker": more})
        return run(other, state, *names, **asked)  # type: ignore[arg-type]

    found = rules(with_fault(heavy, seconds=0.5))
    assert "CC127" in found
    assert not found & {"CC128", "CC105"}


def test_energy_that_is_fed_in_is_a_drift() -> None:
    def fed(scene: Scene, state: object, names: tuple[str, str], asked: dict[str, object]) -> Run:
        done = run(scene, state, *names, **asked)  # type: ignore[arg-type]
        more = 1.0 + 0.02 * done.motion.time_s
        return replace(done, energy=replace(done.energy, kinetic_j=more * done.energy.kinetic_j))

    assert rules(with_fault(fed, seconds=1.0)) == {"CC129"}


@pytest.mark.parametrize(
    ("name", "seconds"),
    [("scotch-yoke", 1.4), slowly("shaper", 2.0, reason="the worst of them, which takes longer")],
)
def test_driven_scenes_that_are_let_go_are_held_to_what_their_masses_shake_by(
    name: str, seconds: float
) -> None:
    """Light cranks with heavy sliders: over the step and the curvature alone, pymunk was out by up
    to 19 times the limit of a drift that shrinks with the third order of the step."""
    scene = let_go(load_scene(name))
    assert check(cell(scene=scene, steps=round(seconds / 1e-3))).verdict == "within"


HELD = """
name = "held"
source = "a test"
[ground]
points = { A = [0.0, 0.0] }
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
[loads.feed]
block = "C"
force_n = 2.0
[loads.cut]
block = "C"
direction_deg = 180.0
stroke = "forward"
slider = "C"
force_n = 5.0
"""


def test_loads_of_one_stroke_that_hold_the_truth_are_named() -> None:
    """A ram that is fed with 2 N and cuts with 5 N stops, and stays: 3 N push it back where it goes
    on, and 2 N forward where it goes back."""
    errors = check(cell("mujoco", scene=parse_scene(HELD, "held"), steps=400)).errors
    assert errors
    (note,) = [note for note in errors.notes if "held at rest" in note]
    assert "loads of one stroke (cut)" in note
    swings = check(cell("mujoco")).errors
    assert swings
    assert not swings.notes


def test_the_energy_is_held_to_what_late_impulses_make_of_it() -> None:
    from reports.judge.tolerance import default

    errors = check(cell()).errors
    assert errors
    more = replace(errors, late=LateImpulses(0.01, 0.02, 0.03))
    assert default(FREE["energy"], more) == pytest.approx(4.0 * 0.02 + 0.5 * 0.03, rel=1e-6)
    assert default(FREE["phase"], more) > default(FREE["phase"], errors)
    assert default(FREE["geometry"], more) == default(FREE["geometry"], errors)


def test_limits_at_a_time_grow_with_what_lasts_and_drifts() -> None:
    errors = check(cell()).errors
    assert errors
    assert numbers_for(errors) is FREE
    assert {"phase", "geometry", "energy", "momentum", "angle", "gap", "velocity"} <= set(FREE)
    assert "drive" not in FREE
    longer = replace(errors, travel_rad=100.0 * errors.travel_rad)
    kept = replace(errors, drifted_rad=100.0)
    from reports.judge.tolerance import default

    for each in (longer, kept):
        assert default(FREE["phase"], each) > default(FREE["phase"], errors)
        assert default(FREE["geometry"], each) == default(FREE["geometry"], errors)


def test_an_order_is_not_graded_where_the_start_grows_a_thousandfold(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from reports.judge import halving

    assert check(cell(converge=True)).convergence is not None
    monkeypatch.setattr(halving, "MOST_GROWTH", 0.5)
    assert check(cell(converge=True)).convergence is None


def test_errors_that_cancel_at_one_step_make_no_floor() -> None:
    error = (5.8e-4, 5.4e-5, 1.5e-5)
    steps = (1e-3, 5e-4, 2.5e-4)
    assert convergence(steps, error, "rad").trend == "levels off"
    assert convergence(steps, error, "rad", cancels=True).trend == "shrinks"
    stays = (5.8e-4, 5.4e-5, 5.0e-5)
    assert convergence(steps, stays, "rad", cancels=True).trend == "levels off"


def test_limits_that_the_truth_passes_are_no_departure() -> None:
    """Through limits of the driver, which takes a longer truth: only there assemblies change."""
    scene = load_scene("fourbar-double-rocker-swing")
    checked = check(Cell(scene, "mujoco", "tuned", 1e-3, 1300, drive="free", converge=False))
    assert checked.errors
    assert checked.errors.free
    assert checked.errors.free.passages >= 1
    assert (checked.status, checked.verdict) == ("ok", "within")
    assert any("limits of its angle" in note for note in checked.errors.notes)


def test_what_is_let_go_may_be_as_near_as_the_fourth_order_of_the_step() -> None:
    """MuJoCo's loops, as tuned for that, do not give way; driven ones always do."""
    errors = check(cell("mujoco")).errors
    assert too_good(errors, "integrated", 2) == []
    assert too_good(replace(errors, free=None), "integrated", 2) != []


def test_forces_are_judged_where_they_are_asked_for() -> None:
    checked = check(cell("mujoco", with_forces=True))
    assert checked.verdict == "within"
    row = cell_row(checked)
    assert row["reaction_pure"] < row["reaction_limit_pure"]  # type: ignore[operator]
    assert np.isfinite(row["reaction_limit_pure"])  # type: ignore[arg-type]
