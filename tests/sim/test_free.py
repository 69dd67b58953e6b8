"""Free motion: nothing drives the crank, and the engines still have to follow the closed form; a
flywheel that was worked out does in an engine what it was worked out for."""

import math
from dataclasses import replace
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from analytic.free.exact_motions import ChainMotion
from analytic.lectures.regulation.flywheel import wanted_flywheel
from analytic.lectures.regulation.steady_cycle import cycle_scene
from analytic.lectures.regulation.turning_machine import TurningMachine
from models.errors import EngineError
from models.files.reading import load_scene
from models.motion import State
from models.scene import Driver
from models.scene.hard import WindowChain
from models.scene.laws import ConstantSpeed, Oscillating
from reports.contract.subject import numbers
from sim.engine import Engine, Poses, Run
from sim.engine.drive import pace, period
from sim.run import run
from sim.run.check import refuse_other_model
from tests.worlds import runs
from tests.worlds.engines import FULL
from tests.worlds.tiers import slow

DT_S = 1e-3


def start_of(chain: WindowChain) -> State:
    return ChainMotion(chain).motion(np.zeros(1)).state()


def ran(chain: WindowChain, engine: Any, profile: str = "tuned", **given: Any) -> Run:
    """A free run of 0.4 s of 1 ms steps unless told otherwise: the rods lean by 55 deg then."""
    given = {"dt_s": DT_S, "steps": 400, "drive": "free", **given}
    return run(chain.scene(), start_of(chain), engine, profile, **given)


def angle_error(chain: WindowChain, dt_s: float, name: str) -> float:
    """The largest error of any rod, in rad."""
    result = ran(chain, name, dt_s=dt_s, steps=round(0.4 / dt_s))
    assert (result.status, result.reason) == ("ok", "")
    exact = ChainMotion(chain).motion(result.motion.time_s)
    rods = result.motion.links.items()
    return max(float(np.abs(rod.theta - exact.links[k].theta).max()) for k, rod in rods)


def opened(adapter: Engine | str, chain: WindowChain) -> Any:
    given = {"dt_s": DT_S, "drive": "free", "start": start_of(chain)}
    return runs.opened(chain.scene(), adapter, **given)


@pytest.mark.parametrize("name", FULL)
def test_free_sessions_step_as_they_record_and_go_on_where_they_were(name: str) -> None:
    stepped, recorded, whole = (opened(name, WindowChain(2)) for _ in range(3))
    stepped.step(60)
    first, second = recorded.record(20, 1), recorded.record(40, 1)
    one = numbers(whole.record(60, 1).poses)
    two = np.concatenate([numbers(first.poses), numbers(second.poses)[1:]])
    np.testing.assert_allclose(two, one, rtol=0, atol=1e-10)
    np.testing.assert_allclose(numbers(stepped.read()), one[-1:], rtol=0, atol=1e-10)


@pytest.mark.parametrize(("name", "count", "order", "most"), [
    ("mujoco", 0, 4.0, 1e-10),  # no loop to close: the order is that of the integrator
    ("pymunk", 0, 2.0, 2e-5),
    ("mujoco", 2, 2.0, 2e-8),
    ("pymunk", 2, 2.0, 5e-6),
])  # fmt: skip
def test_rods_and_windows_fall_as_their_equation_says(
    name: str, count: int, order: float, most: float
) -> None:
    rough, fine = (angle_error(WindowChain(count), dt_s, name) for dt_s in (8e-3, 2e-3))
    assert np.log(rough / fine) / np.log(4.0) > order - 0.2
    assert fine < most


@pytest.mark.parametrize("name", FULL)
def test_the_law_of_the_driver_plays_no_part(name: str) -> None:
    """Neither in the motion, nor in what step is too long or what speed is too high."""
    chain = WindowChain(1)
    motions = []
    for law in (ConstantSpeed(0.0, 1e-9), Oscillating(3.0, 0.1, 1e6)):
        scene = replace(chain.scene(), driver=Driver("rocker0", law))
        result = run(scene, start_of(chain), name, dt_s=DT_S, steps=300, drive="free")
        assert result.status == "ok"
        motions.append(result.motion.links["rocker1"].theta)
    np.testing.assert_array_equal(*motions)


def test_what_hangs_on_the_crank_of_a_free_model_is_refused(fake_engine: ModuleType) -> None:
    chain = WindowChain(1)
    fake = fake_engine.FakeEngine(lambda _, t: ChainMotion(chain).motion(t))
    facts = opened(fake, chain).facts()
    told = (chain.scene(), start_of(chain))
    without = {k: v for k, v in facts.mass_kg.items() if k != "rocker0"}
    refuse_other_model(*told, replace(facts, mass_kg=without), DT_S, "prescribed")
    with pytest.raises(EngineError, match="rocker0 has no mass_kg"):
        refuse_other_model(*told, replace(facts, mass_kg=without), DT_S, "free")
    session = opened("mujoco", chain)
    session._model.dof_armature[session._crank] = 0.01
    with pytest.raises(EngineError, match=r"rocker0 has inertia_kg_m2 0\.0933333, not 0\.0833333"):
        refuse_other_model(*told, session.facts(), DT_S, "free")


def test_the_pace_of_free_motion_comes_from_the_state_and_from_gravity() -> None:
    """And what steps are too long for it."""
    chain = WindowChain(1)
    for name in FULL:
        with pytest.raises(EngineError, match=r"dt: 0\.5 s leaves 4 steps in a period of 2\.006 s"):
            ran(chain, name, dt_s=0.5)
    scene, state = chain.scene(), start_of(chain)
    assert pace(scene, state, "prescribed") == 1.0
    assert pace(scene, state, "free") == pytest.approx(np.sqrt(9.81))
    fast = replace(state, omega={**state.omega, "rocker1": -50.0})
    assert pace(scene, fast, "free") == 50.0
    pushed = replace(state, alpha={**state.alpha, "rocker1": -400.0})
    assert pace(scene, pushed, "free") == 20.0
    assert period(scene, fast, "free") == pytest.approx(2.0 * np.pi / 50.0)
    still = replace(state, omega=dict.fromkeys(state.omega, 0.0))
    weightless = replace(scene, gravity_m_s2=(0.0, 0.0))
    assert (pace(weightless, still, "free"), period(weightless, still, "free")) == (0.0, np.inf)


def test_a_free_run_that_spins_away_is_diverged(fake_engine: ModuleType) -> None:
    """Measured by the pace of the fall, 3.1 rad/s, and not by the driver's 1 rad/s."""

    def spun(by: float) -> Any:
        def faster(poses: Poses) -> Poses:
            rod = poses.bodies["rocker1"]
            at = np.where(poses.time_s > 0.2, by, rod.omega)
            return replace(poses, bodies={**poses.bodies, "rocker1": replace(rod, omega=at)})

        exact = ChainMotion(WindowChain(1))
        return fake_engine.FakeEngine(lambda _, t: exact.motion(t), disturb=faster)

    assert ran(WindowChain(1), spun(2e6)).status == "ok"
    apart = ran(WindowChain(1), spun(4e6))
    assert (apart.status, apart.stopped_at_s) == ("diverged", pytest.approx(0.2))


@pytest.mark.parametrize(
    ("name", "profile"), [("mujoco", "tuned"), ("mujoco", "as-shipped"), ("pymunk", "tuned")]
)
def test_the_energy_of_a_run_is_that_of_the_closed_form_at_the_instants_of_the_velocities(
    name: str, profile: str
) -> None:
    """MuJoCo's Euler steps have velocities half a step early, pymunk's are half a step late."""
    turning, offs = ChainMotion(WindowChain(0)), []
    for dt_s in (4e-3, 1e-3):
        result = ran(WindowChain(0), name, profile, dt_s=dt_s, steps=round(0.4 / dt_s))
        theta, omega, _ = turning.at(result.velocity_time_s)
        kinetic, height = omega**2 / 6, 0.5 * np.sin(theta)
        pairs = (
            (result.energy.kinetic_j, kinetic),
            (result.energy.potential_j, 9.81 * height),
            (result.energy.total_j, turning.energy(theta, omega)),
        )
        offs.append(max(float(np.abs(found - exact).max()) for found, exact in pairs))
    assert offs[1] < min(2e-4, offs[0] / 12.0)


def test_of_a_driven_mechanism_no_energy_is_told() -> None:
    for name in FULL:
        assert runs.ran(load_scene("shaper"), name, dt_s=1e-3, steps=10).energy is None


@slow("two seconds: loads that hang on the angle are asked for at every stage of a step")
def test_an_engine_runs_the_cycle_that_the_flywheel_is_for() -> None:
    """The drive a constant torque, two cycles: nothing settles, so that the second is as the
    first."""
    cycle = wanted_flywheel(TurningMachine.of(load_scene("engine-four-stroke")), 0.02).cycle
    scene = cycle_scene(cycle, 2.05)
    link = runs.ran(scene, "mujoco", per_turn=1400, drive="free").motion.links[scene.driver.link]
    turned, whole = np.abs(link.theta - link.theta[0]), cycle.machine.cycle_rad
    assert math.floor(turned[-1] / whole) == 2
    for k in range(2):
        inside = (turned >= k * whole) & (turned <= (k + 1) * whole)
        speed, theta = np.abs(link.omega[inside]), link.theta[inside]
        high, low = speed.max(), speed.min()
        assert 2.0 * (high - low) / (high + low) == pytest.approx(0.02, rel=0.01)
        for at, u in ((speed.argmax(), cycle.fastest), (speed.argmin(), cycle.slowest)):
            off = math.remainder(theta[at] - cycle.driver_rad(u), whole)
            assert abs(math.degrees(off)) < 0.5
