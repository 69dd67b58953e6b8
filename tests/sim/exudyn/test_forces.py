"""Sessions of exudyn: its clock, its silence, its redundant joints, its drives; and the forces that
it reports, against the reference, with loads and friction that it is given.
"""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from analytic.forces import kinetostatics
from analytic.kinematics import solve
from models.array import Array
from models.errors import EngineError
from models.files.reading import load_scene
from models.motion import Forces
from models.scene import Scene
from models.scene.characteristics import Constant, Polynomial, Sine
from models.scene.hard import double_parallelogram
from models.scene.laws import FromRest, Oscillating
from models.scene.loads import CoulombFriction, Load
from models.scene.tabulated import Tabulated
from sim.engine import Run, Settings
from sim.exudyn.crank_drive import CrankCourse
from sim.exudyn.engine import ENGINE, ExudynSession
from tests.worlds import runs
from tests.worlds.loading import loaded_mechanism
from tests.worlds.reported_forces import misses
from tests.worlds.runs import acted_on, driven_by, ran, rubbing

FOURBAR = load_scene("fourbar-lecture-1")
REDUNDANT = double_parallelogram("double-parallelogram", source="test")
LAWS = {
    "oscillating": Oscillating(1.6, 0.9, 10.0, 0.3),
    "from rest": FromRest(1.57, 10.0, 0.3),
}
TRAPEZOIDAL: Settings = {"integrator": "TrapezoidalIndex2"}


def session_of(scene: Scene = FOURBAR, profile: str = "tuned", **settings: object) -> ExudynSession:
    return runs.opened(scene, ENGINE, settings, profile=profile, dt_s=1e-3)


def turned(
    scene: Scene = FOURBAR, profile: str = "tuned", per_turn: int = 400, **given: Any
) -> Run:
    """A turn, however it ends."""
    return runs.ran(scene, ENGINE, profile, per_turn=per_turn, well=False, **given)


def threads() -> int:
    """Of this process, where the system tells."""
    return len(list(Path("/proc/self/task").glob("*")))


def off_by(scene: Scene, done: Run, link: str, what: str) -> np.ndarray:
    """The errors of the angle of a link, or of a rate of it."""
    assert done.status == "ok", done.reason
    exact = solve(scene, done.motion.time_s)
    found: np.ndarray = getattr(done.motion.links[link], what) - getattr(exact.links[link], what)
    return np.abs(found)


@pytest.mark.parametrize("adaptive", ["enable", "disable"])
def test_clock_and_sensors_do_not_add_up_over_stretches(adaptive: str) -> None:
    """Late by 1e-10 s after some ten thousand steps, exudyn would do that as one more. Sensors keep
    each step once and begin anew at each stretch."""
    session = session_of(adaptive_step=adaptive)
    session.step(2850)
    for steps in (100, 50):
        session.record(steps, 5)
        assert len(session._system.GetSensorStoredData(session._sensors[0])) == steps + 1
    assert session._solver.it.currentTime == pytest.approx(3.0, abs=1e-15)
    assert session._system.systemData.GetTime() == session._solver.it.currentTime


def test_steps_in_one_go_are_the_same_as_steps_one_by_one() -> None:
    one, other = (turned(settings={"adaptive_step": each}) for each in ("enable", "disable"))
    for name, link in one.motion.links.items():
        np.testing.assert_allclose(link.theta, other.motion.links[name].theta, atol=1e-11)


def test_nothing_is_said_written_or_left_running(
    capfd: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    before = threads()
    turned()
    failed = turned(REDUNDANT, "as-shipped")
    assert failed.status == "diverged"
    assert "zero initial accelerations" in failed.warnings[0]
    assert threads() == before
    shown = capfd.readouterr()
    assert shown.out + shown.err == ""
    assert list(tmp_path.iterdir()) == []


def test_redundant_joints_are_found_and_taken_by_tuned_alone_others_are_told_in_its_words() -> None:
    assert session_of(REDUNDANT).facts().settings["linear_solver_used"] == "EigenDense"
    assert session_of().facts().settings["linear_solver_used"] == "EXUdense"
    refused = turned(REDUNDANT, "as-shipped")
    assert refused.reason.startswith("stopped after 0 s: ")
    assert off_by(REDUNDANT, turned(REDUNDANT), "third", "theta").max() < 1e-9
    with pytest.raises(EngineError, match=r"exudyn: .*(singular|factorized)"):
        session_of(REDUNDANT, "as-shipped").step(10)


@pytest.mark.parametrize(("law", "settings"), [("oscillating", TRAPEZOIDAL), ("from rest", {})])
def test_a_law_that_starts_accelerating_leaves_nothing_that_rings(
    law: str, settings: Settings
) -> None:
    """The trapezoidal rule damps nothing: fault at the start would be so ever after."""
    scene = driven_by(LAWS[law])
    coarse, fine = (
        off_by(scene, turned(scene, settings=settings, per_turn=n), "rocker", "alpha")
        for n in (200, 800)
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
        off_by(
            scene, turned(scene, settings={"servo_gain": gain}, drive="servo"), "crank", "theta"
        ).max()
        for gain in (1e3, 1e2)
    )
    assert 1e-7 < stiff < 1e-3
    assert soft == pytest.approx(10.0 * stiff, rel=0.2)


MASSLESS = load_scene("slider-crank-excel-210")
SETTLED = 40
"""Samples after which nothing of the start is left in forces."""
WITHIN: Mapping[str, float] = {"slider-crank-excel-210": 9e-4}
"""Of the largest force, and of the largest torque, where it is not 2.5e-4: what generalised alpha
leaves of accelerations at 720 steps a turn. It shrinks as the step squared."""
KINDS = ("sixbar-watt", "slider-crank-excel-210", "shaper", "scotch-yoke", "slotted-lever")
WAVE = Sine(1.0, 0.1, 0.4)


def opened(scene: Scene, steps: int = 720, settings: Settings | None = None, **given: Any) -> Any:
    return runs.opened(scene, ENGINE, settings, steps=steps, **given)


def off(scene: Scene, forces: Forces) -> tuple[Array, Array]:
    """At each sample the largest error of all reactions, and the error of the torque, as shares."""
    wrong = misses(scene, forces, over_moments=True)
    return np.maximum(wrong["force"], wrong.get("moment", 0.0)), wrong["torque"]


@pytest.mark.parametrize("name", KINDS)
def test_reactions_and_torque_are_those_of_the_reference(name: str) -> None:
    scene = load_scene(name)
    limit = WITHIN.get(name, 2.5e-4)
    for wrong in off(scene, opened(scene).record_forces(720, 1).forces):
        assert wrong[0] < 1e-6
        assert np.nanmax(wrong[SETTLED:]) < limit


@pytest.mark.parametrize("settings", [{}, {"adaptive_step": "disable"}])
def test_forces_of_two_stretches_are_those_of_one(settings: Settings) -> None:
    scene = load_scene("fourbar-double-rocker")
    whole, parts = (opened(scene, settings=settings) for _ in range(2))
    log = whole.record_forces(90, 3)
    parts.record_forces(30, 3)
    later = parts.record_forces(60, 3).forces.torque
    np.testing.assert_allclose(later, log.forces.torque[10:], rtol=1e-7)


def test_a_motor_and_nothing_at_all_have_the_torque_that_they_have() -> None:
    heavy = replace(FOURBAR, gravity_m_s2=(0.0, -9.81))
    motor = opened(heavy, drive="servo").record_forces(720, 1).forces
    assert off(heavy, motor)[1][200:].max() < 5e-3
    assert np.all(opened(heavy, drive="free").record_forces(20, 1).forces.torque == 0.0)


@pytest.mark.parametrize("number", [4, 8])
def test_loads_of_every_kind_are_felt_in_mechanisms_of_every_dyad(number: int) -> None:
    scene, _ = loaded_mechanism(number)
    for wrong in off(scene, opened(scene, 1440).record_forces(720, 1).forces):
        assert wrong[0] < 1e-5
        assert np.nanmax(wrong[SETTLED:]) < 1e-4


LOADED = (
    Load("force", "block C", "C", Sine(800.0, 0.1, 0.3), direction_rad=0.7),
    Load("turning", "block C", "C", Constant(300.0), direction_rad=0.7, frame="body"),
    Load("torque", "block C", None, Polynomial((30.0, 500.0)), "displacement", "C"),
)


def test_what_acts_on_a_block_without_mass_goes_to_its_pin_and_its_guide() -> None:
    loaded = acted_on(MASSLESS, *LOADED)
    forces = opened(loaded).record_forces(720, 1).forces
    for wrong in off(loaded, forces):
        assert np.nanmax(wrong[SETTLED:]) < 1e-4
    assert float(np.abs(forces.sliders["C"].moment).max()) > 10.0
    moving = load_scene("slotted-lever")
    along = Load("along", "block B", "B", WAVE, direction_rad=0.7, frame="body")
    turned = acted_on(moving, along)
    wrong, _ = off(turned, opened(turned).record_forces(720, 1).forces)
    assert np.nanmax(wrong[SETTLED:]) < 2.5e-4


@pytest.mark.parametrize(("name", "sizes"), [
    ("fourbar-lecture-1", {"A": 0.01, "B": 0.01, "C": 0.02}),
    ("slotted-lever", {"B": 1.0, "C": 0.1}),
    ("slider-crank-excel-210", {"C": 50.0}),
])  # fmt: skip
def test_constant_friction_takes_the_power_that_it_has_to(
    name: str, sizes: Mapping[str, float]
) -> None:
    plain = load_scene(name)
    rubbed = rubbing(plain, **sizes)
    felt, bare = (opened(s).record_forces(720, 1).forces for s in (rubbed, plain))
    times = plain.driver.law.period_s / 720 * np.arange(721)
    exact = partial(kinetostatics.forces, bound=False, skip_dead_points=True)
    taken = exact(rubbed, times).torque - exact(plain, times).torque
    same = np.abs((felt.torque - bare.torque) - taken) < 1e-6 * np.abs(taken).max()
    assert same.mean() > 0.99  # but where a joint turns back on a sample
    reactions, _ = off(rubbed, felt)
    assert np.nanquantile(reactions[SETTLED:], 0.99) < 1e-3


def test_what_it_can_not_be_given_is_refused_with_the_reason() -> None:
    done = ran(rubbing(FOURBAR, C=0.1), ENGINE, steps=10, drive="free", well=False)
    assert done.status == "unsupported"
    assert "joints without a drive come to rest and stick" in done.reason
    with pytest.raises(EngineError, match="none that follows the reactions"):
        opened(acted_on(FOURBAR, CoulombFriction("C", 0.1, 0.01)))
    with pytest.raises(EngineError, match=r"loads.l: found body wheel; use one of crank, coupler"):
        opened(acted_on(FOURBAR, Load("l", "wheel", None, WAVE)))
    with pytest.raises(EngineError, match=r"dt: found 1e-10 s; exudyn .* takes 1e-09 s or"):
        runs.opened(FOURBAR, ENGINE, dt_s=1e-10)
    table = "loads.short: over the time [s] the table"
    for from_s, until_s, status, said in (
        (0.0, 0.05, "diverged", f"stopped after 0.05 s: {table}"),
        (1.0, 2.0, "unsupported", f"{table} goes from 1 to 2, and 0 is requested"),
    ):
        short = Load("short", "rocker", None, Tabulated((from_s, until_s), (1.0, 2.0)))
        done = ran(acted_on(FOURBAR, short), ENGINE, dt_s=1e-3, steps=100, well=False)
        assert (done.status, done.reason.startswith(said)) == (status, True)
