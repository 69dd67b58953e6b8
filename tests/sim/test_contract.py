"""What every engine adapter must do, and the fake one as well."""

from __future__ import annotations

from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

from analytic.kinematics import solve
from models.errors import EngineError
from models.files import load_scene
from models.scene import Same, Scene
from reports.compare.beside import Beside, truth_of
from reports.compare.compare import compare
from reports.compare.errors import Error, Errors
from reports.judge.too_good import too_good
from reports.quantities import named
from sim.check import refuse_other_model
from sim.engine import BodyPose, Engine, Poses, Session
from sim.measure import gaps, motion
from sim.registry import ENGINES, engine
from sim.run import run
from sim.settings import resolved

SCENES = ("fourbar-lecture-1", "slider-crank-offset", "slotted-lever", "shaper", "scotch-yoke")
DT_S = 1e-3


@pytest.fixture(params=[*ENGINES, "fake", "fake-staggered"])
def adapter(request: pytest.FixtureRequest, fake_engine: ModuleType) -> Engine:
    name = str(request.param)
    if name in ENGINES:
        return engine(name)
    made: Engine = fake_engine.FakeEngine(solve, velocity_shift=0.5 * (name != "fake"))
    return made


@pytest.fixture(params=SCENES)
def scene(request: pytest.FixtureRequest) -> Scene:
    return load_scene(str(request.param))


def opened(adapter: Engine, scene: Scene, profile: str = "tuned") -> Session:
    state = solve(scene, np.array([0.0])).state(0)
    return adapter.open(scene, state, resolved(adapter.profiles[profile], None), DT_S, "prescribed")


def numbers(poses: Poses) -> np.ndarray:
    """All positions and velocities of all bodies, one row per sample."""
    rows = []
    for body in poses.bodies.values():
        rows += [body.origin, body.velocity, body.theta[:, None], body.omega[:, None]]
    return np.concatenate(rows, axis=1)


def test_a_session_starts_as_the_scene_with_closed_loops(adapter: Engine, scene: Scene) -> None:
    facts = opened(adapter, scene).facts()
    state = solve(scene, np.array([0.0])).state(0)
    refuse_other_model(scene, state, facts, DT_S, "prescribed")
    assert max(gap[0] for gap in gaps(scene, facts.start).values()) < 1e-12
    start = motion(scene, facts.start).state(0)
    for point, place in state.position.items():
        np.testing.assert_allclose(start.position[point], place, atol=1e-14)


@pytest.mark.parametrize("profile", ["tuned", "as-shipped"])
def test_stepping_and_recording_come_to_the_same_state(
    adapter: Engine, scene: Scene, profile: str
) -> None:
    stepped, recorded = opened(adapter, scene, profile), opened(adapter, scene, profile)
    stepped.step(60)
    log = recorded.record(60, 1)
    scale = np.abs(numbers(log.poses)).max()
    np.testing.assert_allclose(
        numbers(stepped.read()), numbers(recorded.read()), atol=1e-10 * scale
    )
    np.testing.assert_array_equal(numbers(log.poses)[-1:], numbers(recorded.read()))


def test_a_log_holds_the_current_sample_and_every_nth_after_it(
    adapter: Engine, scene: Scene
) -> None:
    full, thin = opened(adapter, scene).record(40, 1), opened(adapter, scene).record(40, 8)
    np.testing.assert_allclose(thin.poses.time_s, DT_S * 8 * np.arange(6), rtol=1e-15)
    np.testing.assert_array_equal(numbers(thin.poses), numbers(full.poses)[::8])
    assert thin.steps_done == full.steps_done == 40
    assert not full.diverged
    assert full.wall_s > 0.0


def test_two_stretches_equal_one(adapter: Engine, scene: Scene) -> None:
    whole, parts = opened(adapter, scene), opened(adapter, scene)
    one = whole.record(50, 1)
    parts.record(20, 1)
    two = parts.record(30, 1)
    scale = np.abs(numbers(one.poses)).max()
    np.testing.assert_allclose(two.poses.time_s, one.poses.time_s[20:], rtol=1e-15)
    np.testing.assert_allclose(numbers(two.poses), numbers(one.poses)[20:], atol=1e-10 * scale)


def test_two_stretches_equal_one_for_a_solver_that_has_not_converged() -> None:
    """Such a solver goes on from the last step's answer, and has to over the seam as well."""
    scene, mujoco = load_scene("fourbar-lecture-1"), engine("mujoco")
    state = solve(scene, np.array([0.0])).state(0)
    rough = resolved(mujoco.profiles["as-shipped"], {"solver": "CG", "iterations": 1})
    whole, parts = (mujoco.open(scene, state, rough, DT_S, "prescribed") for _ in range(2))
    one = whole.record(500, 1)
    parts.record(200, 1)
    np.testing.assert_array_equal(numbers(parts.record(300, 1).poses), numbers(one.poses)[200:])


def test_angles_are_continuous_over_turns(adapter: Engine) -> None:
    scene = load_scene("whitworth")
    log = opened(adapter, scene).record(1500, 1)
    for body in log.poses.bodies.values():
        assert np.abs(np.diff(body.theta)).max() < 0.1
    assert log.poses.bodies["crank"].theta[-1] > 14.0


def test_two_sessions_side_by_side_do_not_disturb_each_other(adapter: Engine) -> None:
    scene = load_scene("fourbar-lecture-1")
    alone = opened(adapter, scene).record(30, 1)
    a, b = opened(adapter, scene), opened(adapter, scene)
    first = a.record(15, 1)
    b.record(30, 1)
    second = a.record(15, 1)
    joined = np.concatenate([numbers(first.poses), numbers(second.poses)[1:]])
    np.testing.assert_allclose(joined, numbers(alone.poses), atol=1e-11)


@pytest.mark.parametrize(
    ("wrong", "named"),
    [
        (lambda f: replace(f, mass_kg={**f.mass_kg, "rocker": 7.0}), "rocker has mass_kg 7"),
        (lambda f: replace(f, mass_kg={}), "rocker has no mass_kg"),
        (
            lambda f: replace(f, centre_m={**f.centre_m, "rocker": (0.1, 1e-6)}),
            r"rocker has centre_m \(0.1, 1e-06\), not \(0.1, 0.0\)",
        ),
        (
            lambda f: replace(f, inertia_kg_m2={**f.inertia_kg_m2, "coupler": 7.0}),
            "coupler has inertia_kg_m2 7",
        ),
        (lambda f: replace(f, gravity_m_s2=(0.0, -9.81)), "gravity is"),
        (lambda f: with_rocker(f, lambda b: replace(b, theta=b.theta + 1e-6)), "rocker stands at"),
        (lambda f: with_rocker(f, lambda b: replace(b, origin=b.origin + 1e-6)), "rocker lies at"),
        (lambda f: with_rocker(f, lambda b: replace(b, omega=b.omega * 1.1)), "rocker turns at"),
        (lambda f: with_rocker(f, lambda b: replace(b, velocity=b.velocity + 1.0)), "rocker moves"),
        (lambda f: with_rocker(f, lambda b: replace(b, theta=b.theta * np.nan)), "rocker stands"),
    ],
)
def test_a_model_that_is_not_the_scene_is_refused_by_name(
    adapter: Engine, wrong: object, named: str
) -> None:
    scene = load_scene("fourbar-lecture-1")
    state = solve(scene, np.array([0.0])).state(0)
    facts = wrong(opened(adapter, scene).facts())  # type: ignore[operator]  # a lambda above
    with pytest.raises(EngineError, match=named):
        refuse_other_model(scene, state, facts, DT_S, "prescribed")


def with_rocker(facts: object, change: object) -> object:
    """The facts with another rocker at the start."""
    start = facts.start  # type: ignore[attr-defined]  # Facts
    body: BodyPose = change(start.bodies["rocker"])  # type: ignore[operator]  # a lambda
    changed = replace(start, bodies={**start.bodies, "rocker": body})
    return replace(facts, start=changed)  # type: ignore[type-var]  # Facts


def test_a_model_with_open_loops_is_refused(adapter: Engine) -> None:
    scene = load_scene("fourbar-lecture-1")
    state = solve(scene, np.array([0.0])).state(0)
    facts = opened(adapter, scene).facts()
    ajar = with_rocker(facts, lambda b: replace(b, origin=b.origin + 1e-11))
    with pytest.raises(EngineError, match=r"[CD] is open by 1\.4\de-11 m"):
        refuse_other_model(scene, state, ajar, DT_S, "prescribed")  # type: ignore[arg-type]


def test_profiles_are_complete_and_say_why(adapter: Engine) -> None:
    assert set(adapter.profiles) == {"as-shipped", "tuned"}
    shipped, tuned = adapter.profiles["as-shipped"], adapter.profiles["tuned"]
    assert set(shipped.settings) == set(tuned.settings)
    for profile in (shipped, tuned):
        assert profile.engine == adapter.name
        assert all(setting.reason for setting in profile.settings.values())


def test_places_come_about_as_the_adapter_says(adapter: Engine, scene: Scene) -> None:
    """Integrated: off by what a step leaves out, which shrinks no faster than its order. Solved:
    off by rounding, at any step."""
    coarse, fine = (_errors(adapter, scene, steps) for steps in (180, 720))
    largest = [max(row.pure for row in errors.rows if _of_place(row)) for errors in (coarse, fine)]
    placing = adapter.placing(resolved(adapter.profiles["tuned"], None))
    if placing == "solved":
        assert max(largest) < 1e-10
        return
    for errors in (coarse, fine):
        assert errors.uneven
        assert too_good(errors, placing, adapter.order) == []
    assert largest[0] < largest[1] * 4.0 ** (adapter.order + 0.3)


def _errors(adapter: Engine, scene: Scene, steps: int) -> Errors:
    truth = truth_of(Same(scene))
    dt_s = scene.driver.law.period_s / steps
    errors = compare(Beside.of(truth, run(scene, truth.start, adapter, dt_s=dt_s, steps=steps)))
    assert errors is not None
    return errors


def _of_place(row: Error) -> bool:
    return row.quantity in named("place") and row.kind == "total"


def test_an_engine_says_what_it_holds_of_its_settings(adapter: Engine, scene: Scene) -> None:
    state = solve(scene, np.zeros(1)).state()
    for profile in adapter.profiles.values():
        settings = resolved(profile, None)
        facts = adapter.open(scene, state, settings, DT_S, "prescribed").facts()
        held = adapter.holds(settings, DT_S, "prescribed")
        assert held
        assert {name: facts.settings.get(name) for name in held} == pytest.approx(held)
