"""Sessions of exudyn: its clock, its silence, its redundant joints, its drives."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from analytic.kinematics import solve
from models.errors import EngineError
from models.files.reading import load_scene
from models.scene import Scene
from models.scene.hard import double_parallelogram
from models.scene.laws import FromRest, Oscillating, SpeedChange
from sim.engine import Run, Settings
from sim.exudyn.crank_drive import CrankCourse
from sim.exudyn.engine import ENGINE, ExudynSession
from tests.worlds import runs
from tests.worlds.runs import driven_by

FOURBAR = load_scene("fourbar-lecture-1")
REDUNDANT = double_parallelogram("double-parallelogram", source="test")
LAWS = {
    "oscillating": Oscillating(1.6, 0.9, 10.0, 0.3),
    "from rest": FromRest(1.57, 10.0, 0.3),
    "jump": SpeedChange(1.57, 5.0, 10.0, 0.1, 0.0),
}
TRAPEZOIDAL: Settings = {"integrator": "TrapezoidalIndex2"}


def opened(scene: Scene = FOURBAR, profile: str = "tuned", **settings: object) -> ExudynSession:
    return runs.opened(scene, ENGINE, settings, profile=profile, dt_s=1e-3)


def ran(scene: Scene = FOURBAR, profile: str = "tuned", per_turn: int = 400, **given: Any) -> Run:
    """A turn, however it ends."""
    return runs.ran(scene, ENGINE, profile, per_turn=per_turn, well=False, **given)


def threads() -> int:
    """Of this process, where the system tells."""
    return len(list(Path("/proc/self/task").glob("*")))


def off(scene: Scene, done: Run, link: str, what: str) -> np.ndarray:
    """The errors of the angle of a link, or of a rate of it."""
    assert done.status == "ok", done.reason
    exact = solve(scene, done.motion.time_s)
    found: np.ndarray = getattr(done.motion.links[link], what) - getattr(exact.links[link], what)
    return np.abs(found)


@pytest.mark.parametrize("adaptive", ["enable", "disable"])
def test_clock_and_sensors_do_not_add_up_over_stretches(adaptive: str) -> None:
    """Late by 1e-10 s after some ten thousand steps, exudyn would do that as one more. Sensors keep
    each step once and begin anew at each stretch."""
    session = opened(adaptive_step=adaptive)
    session.step(2850)
    for steps in (100, 50):
        session.record(steps, 5)
        assert len(session._system.GetSensorStoredData(session._sensors[0])) == steps + 1
    assert session._solver.it.currentTime == pytest.approx(3.0, abs=1e-15)
    assert session._system.systemData.GetTime() == session._solver.it.currentTime


def test_steps_in_one_go_are_the_same_as_steps_one_by_one() -> None:
    one, other = (ran(settings={"adaptive_step": each}) for each in ("enable", "disable"))
    for name, link in one.motion.links.items():
        np.testing.assert_allclose(link.theta, other.motion.links[name].theta, atol=1e-11)


def test_nothing_is_said_written_or_left_running(
    capfd: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    before = threads()
    ran()
    failed = ran(REDUNDANT, "as-shipped")
    assert failed.status == "diverged"
    assert "zero initial accelerations" in failed.warnings[0]
    assert threads() == before
    shown = capfd.readouterr()
    assert shown.out + shown.err == ""
    assert list(tmp_path.iterdir()) == []


def test_redundant_joints_are_found_and_taken_by_tuned_alone() -> None:
    assert opened(REDUNDANT).facts().settings["linear_solver_used"] == "EigenDense"
    assert opened().facts().settings["linear_solver_used"] == "EXUdense"
    refused = ran(REDUNDANT, "as-shipped")
    assert refused.reason.startswith("stopped after 0 s: ")
    assert off(REDUNDANT, ran(REDUNDANT), "third", "theta").max() < 1e-9


def test_stepping_where_exudyn_goes_no_further_is_an_error_in_its_words() -> None:
    with pytest.raises(EngineError, match=r"exudyn: .*(singular|factorized)"):
        opened(REDUNDANT, "as-shipped").step(10)


def test_a_step_too_short_for_its_clock_is_refused() -> None:
    with pytest.raises(EngineError, match=r"dt: found 1e-10 s; exudyn .* takes 1e-09 s or"):
        runs.opened(FOURBAR, ENGINE, dt_s=1e-10)


def test_all_errors_of_the_trapezoidal_rule_are_of_second_order() -> None:
    for what in ("theta", "omega", "alpha"):
        coarse, fine = (
            off(FOURBAR, ran(settings=TRAPEZOIDAL, per_turn=n), "rocker", what).max()
            for n in (200, 800)
        )
        assert 10.0 < coarse / fine < 25.0, what


@pytest.mark.parametrize(("law", "settings"), [("oscillating", TRAPEZOIDAL), ("from rest", {})])
def test_a_law_that_starts_accelerating_leaves_nothing_that_rings(
    law: str, settings: Settings
) -> None:
    """The trapezoidal rule damps nothing: what is wrong at the start would be so ever after."""
    scene = driven_by(LAWS[law])
    coarse, fine = (
        off(scene, ran(scene, settings=settings, per_turn=n), "rocker", "alpha") for n in (200, 800)
    )
    assert fine[40:].max() < coarse[10:].max() / 4**1.6


def test_between_the_steps_the_crank_is_told_the_law_itself() -> None:
    law = LAWS["oscillating"]
    course = CrankCourse(law, 0.2, 1e-3)
    course.reach(10)
    turned, rate, _ = law.at(np.array([0.2, 0.2 + 4.3e-3, 0.2 + 5e-3]))
    assert course.angle(None, 4.3e-3, None, 0.0) == pytest.approx(turned[1] - turned[0], abs=1e-15)
    assert course.speed(None, 4.3e-3, None, 0.0) == rate[1]
    assert course.angle(None, 5e-3, None, 0.0) == pytest.approx(turned[2] - turned[0], abs=1e-15)
    assert course.speed(None, 5e-3, None, 0.0) == pytest.approx(rate[2], abs=1e-4)


def test_a_servo_lags_by_what_its_gain_leaves() -> None:
    scene = driven_by(LAWS["oscillating"])
    stiff, soft = (
        off(scene, ran(scene, settings={"servo_gain": gain}, drive="servo"), "crank", "theta").max()
        for gain in (1e3, 1e2)
    )
    assert 1e-7 < stiff < 1e-3
    assert soft == pytest.approx(10.0 * stiff, rel=0.2)
