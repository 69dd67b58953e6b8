"""Runs: how they end, what they refuse, and what they cost; with a redundant link too."""

import gc
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from analytic.kinematics import solve
from models.errors import EngineError
from models.files.reading import load_scene
from models.scene import Scene
from models.scene.characteristics import Constant
from models.scene.hard import double_parallelogram
from models.scene.loads import Load
from sim.engine import Facts, Run
from sim.registry import ENGINES, available, declaration, engine, other_version
from sim.run import time_run
from tests.worlds import runs
from tests.worlds.engines import FULL, HERE
from tests.worlds.runs import acted_on, massless, start_of

FOURBAR = load_scene("fourbar-lecture-1")


def ran(
    scene: Scene = FOURBAR, engine: Any = "mujoco", profile: str = "tuned", **given: Any
) -> Run:
    """A run of a second of 1 ms steps unless told otherwise, however it ends."""
    return runs.ran(scene, engine, profile, well=False, **{"dt_s": 1e-3, "steps": 1000, **given})


@pytest.mark.parametrize("name", HERE)
def test_sample_times_are_multiples_of_the_step(name: str) -> None:
    samples, steps = 200, 601
    result = ran(engine=name, steps=steps, every=3)
    np.testing.assert_array_equal(result.motion.time_s, 1e-3 * (3.0 * np.arange(samples + 1)))
    assert result.stopped_at_s == result.motion.time_s[-1]
    assert result.cost.steps == steps
    assert result.cost.logged
    assert result.cost.us_per_step == pytest.approx(1e6 * result.cost.wall_s / steps)


@pytest.mark.parametrize("name", HERE)
def test_a_scene_with_loads_is_not_run_as_if_it_had_none(name: str) -> None:
    lacking = replace(engine(name), applies_loads=False, forces_of="nothing", no_forces="")
    pushed = acted_on(FOURBAR, Load("push", "rocker", None, Constant(1.0)))
    done = ran(pushed, lacking, steps=10)
    assert done.status == "unsupported"
    assert f"{name} gets no loads (loads.push) here; remove them" in done.reason
    with pytest.raises(EngineError, match=f"{name} gets no loads"):
        time_run(pushed, start_of(pushed), lacking, dt_s=1e-3, steps=10)
    silent = ran(FOURBAR, lacking, steps=10, with_forces=True)
    assert silent.status == "unsupported"
    assert silent.reason == f"{name} reports no forces; run it without, or another engine"
    told = ran(FOURBAR, replace(lacking, no_forces="it is soft"), steps=10, with_forces=True)
    assert told.reason.startswith(f"{name} reports no forces: it is soft; run it without")


def test_a_diverging_run_stops_early_quietly_and_says_when(
    capfd: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    explicit = {"servo_integrator": "RK4", "servo_gain": 1e4}
    result = ran(drive="servo", settings=explicit, steps=100_000)
    assert result.status == "diverged"
    assert "came apart at 0.00" in result.reason
    assert result.stopped_at_s < 0.05
    assert result.motion.time_s[-1] == result.stopped_at_s
    assert np.isfinite(result.motion.links["rocker"].theta).all()
    assert result.cost.steps < 10_000
    assert len(result.warnings) >= 1
    assert "unstable" in result.warnings[0]
    assert len(set(result.warnings)) == len(result.warnings)
    shown = capfd.readouterr()
    assert shown.out + shown.err == ""
    assert list(tmp_path.iterdir()) == []


def test_warnings_go_back_to_whom_they_went_before() -> None:
    import mujoco  # type: ignore[import-untyped]  # ships no stubs

    heard: list[str] = []
    mujoco.set_mju_user_warning(heard.append)
    try:
        ran(drive="servo", settings={"servo_integrator": "RK4"})
        assert heard == []
        model = mujoco.MjModel.from_xml_string(
            "<mujoco><worldbody><body><freejoint/><geom size='1'/></body></worldbody></mujoco>"
        )
        data = mujoco.MjData(model)
        data.qvel[:] = 1e300
        mujoco.mj_step(model, data)
        assert len(heard) == 1
    finally:
        mujoco.set_mju_user_warning(None)


STOPPED = {"diverges_after": 120, "stopped": "no step was small enough"}


def apart(fake: ModuleType, from_s: float) -> dict[str, object]:
    """A fake engine whose loop is open by more than the longest link from some instant on."""
    return {"disturb": fake.turned_link("rocker", lambda t: np.where(t > from_s, 3.0, 0.0))}


@pytest.mark.parametrize(("given", "apart_s", "stopped_s", "reason"), [
    ({"diverges_after": 120}, None, 0.12, "came apart at 0.12 s"),
    (STOPPED, None, 0.12, "stopped after 0.12 s: no step was small enough"),
    (STOPPED, 0.1, 0.1, "came apart at 0.10"),  # which was first
    ({}, 0.2, 0.2, "came apart at 0.20"),
])  # fmt: skip
def test_a_run_that_ends_too_early_says_when_and_why(
    given: dict[str, object],
    apart_s: float | None,
    stopped_s: float,
    reason: str,
    fake_engine: ModuleType,
) -> None:
    given = given | ({} if apart_s is None else apart(fake_engine, apart_s))
    result = ran(engine=fake_engine.FakeEngine(solve, **given), steps=9000)
    assert (result.status, result.stopped_at_s) == ("diverged", pytest.approx(stopped_s))
    assert result.reason == reason if apart_s is None else result.reason.startswith(reason)


def test_an_engine_that_raises_or_refuses_is_a_row_but_another_model(
    fake_engine: ModuleType,
) -> None:
    result = ran(engine=fake_engine.FakeEngine(solve, fails_after=5000), steps=9000)
    assert result.status == "crashed"
    assert "RuntimeError: the fake engine fails" in result.reason
    assert result.motion is not None
    assert result.stopped_at_s == pytest.approx(4.0)
    refused = ran(engine=fake_engine.FakeEngine(solve, refuses="no such joint here"))
    assert (refused.status, refused.reason) == ("unsupported", "no such joint here")
    assert refused.motion is None

    def heavier(facts: Facts) -> Facts:
        return replace(facts, mass_kg={**facts.mass_kg, "rocker": 1.0})

    with pytest.raises(EngineError, match=r"does not hold fourbar-lecture-1: rocker has mass_kg 1"):
        ran(engine=fake_engine.FakeEngine(solve, changes=heavier))


@pytest.mark.parametrize("name", FULL)
@pytest.mark.parametrize(
    ("link", "drive"), [("rocker", "prescribed"), ("crank", "servo"), ("crank", "free")]
)
def test_a_link_without_mass_is_unsupported_and_named_unless_it_is_driven(
    link: str, drive: str, name: str
) -> None:
    bare = replace(FOURBAR.links[link], mass_kg=0.0, inertia_kg_m2=0.0)
    scene = replace(FOURBAR, links={**FOURBAR.links, link: bare})
    result = ran(scene, name, drive=drive)
    assert result.status == "unsupported"
    assert f"{link}: mass_kg 0" in result.reason
    if drive == "servo" and name != "mujoco":  # which moves no body without
        assert ran(scene, name, steps=100).status == "ok"


@pytest.mark.parametrize("name", FULL)
def test_a_point_that_only_massless_blocks_share_is_named(name: str) -> None:
    result = ran(massless(load_scene("tangent")), name)
    assert result.status == "unsupported"
    assert "mass_kg" in result.reason


@pytest.mark.parametrize(("given", "message"), [
    ({"dt_s": 0.0}, "dt: found 0 s; it takes a step above 0"),
    ({"dt_s": float("nan")}, "dt: found nan s"),
    ({"dt_s": 0.1}, r"dt: 0.1 s leaves 6.3 steps in a period .* dt up to 0.0785 s"),
    ({"steps": 0}, "steps: found 0"),
    ({"every": 0}, "logged every 0"),
    ({"engine": "mujocco"}, "engine 'mujocco': unknown; did you mean mujoco"),
    ({"engine": "qqq"}, "engine 'qqq': unknown; there are mujoco, pymunk"),
    ({"profile": "best"}, "profile 'best': mujoco has none .* as-shipped or tuned"),
    ({"settings": {"iteration": 3}}, "setting 'iteration': .* did you mean iterations"),
    ({"settings": {"iterations": "many"}}, "setting iterations: found 'many'; .* whole number"),
    ({"settings": {"tolerance": ""}}, "setting tolerance: found ''; it takes a number"),
    ({"settings": {"integrator": "rk5"}}, "setting integrator: found 'rk5'; use Euler or RK4"),
    ({"settings": {"close": "A"}}, "close = A: not a pin .* one of D, B, C; by default C"),
    ({"settings": {"close": "C,D"}}, "close = D: no loop of fourbar-lecture-1 closes there"),
])  # fmt: skip
def test_bad_input_raises_with_the_cure(given: dict[str, Any], message: str) -> None:
    with pytest.raises(EngineError, match=message):
        ran(**given)


def test_settings_are_overridden_one_by_one_and_stored_as_the_engine_holds_them() -> None:
    result = ran(settings={"iterations": "7", "solref_timeconst_steps": 10})
    assert result.settings["iterations"] == 7
    assert result.settings["solref_timeconst_s"] == pytest.approx(0.01)
    assert result.settings["integrator"] == "RK4"
    assert result.settings["timestep_s"] == 1e-3
    assert result.settings["close"] == "C"
    shipped = ran(engine="pymunk", profile="as-shipped", settings={"error_bias": 0.5})
    assert shipped.settings["error_bias"] == 0.5
    assert shipped.settings["iterations"] == 10


@pytest.mark.parametrize("name", FULL)
def test_what_was_asked_for_runs_again_to_the_same_end(name: str) -> None:
    first = ran(engine=name, profile="as-shipped", settings={"iterations": 9})
    again = ran(engine=name, profile="tuned", settings=first.asked)
    assert again.asked == first.asked
    assert again.settings == first.settings
    np.testing.assert_array_equal(
        first.motion.links["rocker"].theta, again.motion.links["rocker"].theta
    )


@pytest.mark.parametrize("name", ENGINES)
def test_an_engine_that_is_not_installed_names_the_command_and_its_systems(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = declaration(name)
    install = f"'crankcheck[{name}]'" if own.extra else own.distribution
    install += f" (wheels: {own.wheels})" if own.wheels else ""
    monkeypatch.setitem(sys.modules, own.package, None)
    rooms = (f"sim.{name}.", "sim.mujoco_warp.", "sim.mjx.")  # these two import MuJoCo's adapter
    for module in [each for each in sys.modules if each.startswith(rooms)]:
        monkeypatch.delitem(sys.modules, module)
    missing = rf"engine {name}: not installed; .* -m pip install {re.escape(install)}"
    with pytest.raises(EngineError, match=missing):
        engine(name)
    told = {info.name: info for info in available()}
    assert told[name].version is None
    assert told[name].install.endswith(f" -m pip install {install}")
    without = [each for each in HERE if own.package not in declaration(each).roots]
    assert all(told[other].version for other in without)


@pytest.mark.parametrize("name", HERE)
def test_a_version_that_was_never_tried_is_named(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert other_version(name) == ""
    if not declaration(name).tried:
        return
    newer = replace(engine(name), version=lambda: "99.1")
    monkeypatch.setattr(sys.modules[f"sim.{name}.engine"], "ENGINE", newer)
    assert other_version(name).startswith(f"{name} 99.1: tried with {declaration(name).tried}")


def test_importing_sim_loads_no_engine() -> None:
    packages = [declaration(name).package for name in ENGINES]
    code = f"import sim.run, sys; print([n for n in {packages} if n in sys.modules])"
    root = Path(__file__).parents[3]
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=root, capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "[]"


@pytest.mark.parametrize("name", FULL)
def test_timing_repeats_and_says_whether_it_logged(name: str) -> None:
    start = start_of(FOURBAR)
    bare = time_run(FOURBAR, start, name, dt_s=1e-3, steps=200, repeats=3)
    logged = time_run(FOURBAR, start, name, dt_s=1e-3, steps=200, repeats=3, every=1)
    assert (len(bare.walls_s), bare.logged, logged.logged) == (3, False, True)
    assert 0.0 < bare.best.wall_s <= bare.median.wall_s
    assert bare.best.steps == 200
    free = time_run(FOURBAR, start, name, dt_s=1e-3, steps=100, repeats=2, drive="free")
    assert free.best.us_per_step == pytest.approx(1e6 * min(free.walls_s) / 100)


def test_the_collector_is_off_while_timing_and_as_before_afterwards(
    fake_engine: ModuleType,
) -> None:
    seen: list[bool] = []

    def exact(scene: Scene, time_s: Any) -> Any:
        seen.append(gc.isenabled())
        return solve(scene, time_s)

    own, given = fake_engine.FakeEngine(exact), {"dt_s": 1e-3, "steps": 9, "repeats": 2}
    time_run(FOURBAR, start_of(FOURBAR), own, every=1, **given)
    assert set(seen) == {False}
    assert gc.isenabled()
    held = replace(own, drives=("prescribed",))
    with pytest.raises(EngineError, match="free"):
        time_run(FOURBAR, start_of(FOURBAR), held, drive="free", **given)
    assert gc.isenabled()


SCENE = double_parallelogram("double-parallelogram", source="test")


@pytest.mark.parametrize("name", FULL)
def test_engines_carry_a_redundant_link_along(name: str) -> None:
    """From 31 to 146 deg of the crank, between the flat positions."""
    result = runs.ran(SCENE, name, dt_s=1e-3, steps=200)
    exact = solve(SCENE, result.motion.time_s)
    assert result.motion.links["crank"].theta[-1] < np.pi
    for link in ("rocker", "third", "coupler"):
        off = result.motion.links[link].theta - exact.links[link].theta
        assert np.abs(off).max() < 1e-4
    assert set(result.gaps) == {"A", "B", "C", "D", "F", "G"}
    assert max(float(gap.max()) for gap in result.gaps.values()) < 2e-5


def test_settings_may_choose_the_precision_of_an_engine() -> None:
    chosen = replace(engine("pymunk"), numbers_with=lambda _: ("single", 1e-6))
    done = ran(engine=chosen, steps=10)
    assert (done.precision, done.floor) == ("single", 1e-6)
    assert engine("pymunk").numbers({}) == (engine("pymunk").precision, engine("pymunk").floor)
