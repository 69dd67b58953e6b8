"""The forces that exudyn reports, against the reference; loads and friction that it is given."""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from analytic.forces import kinetostatics
from analytic.kinematics import solve
from models.array import Array
from models.characteristics import Constant, Polynomial, Sine
from models.errors import EngineError
from models.files import load_scene, shipped
from models.forces import Forces
from models.friction import ConstantFriction, CoulombFriction
from models.loads import Load
from models.scene import Scene
from models.tabulated import Tabulated
from reports.contract.clauses.reactions import named
from sim.engine import Drive, Settings
from sim.exudyn.engine import ENGINE
from sim.exudyn.session import ExudynSession
from sim.force_recipes import force_recipe
from sim.run import run
from sim.settings import resolved
from tests.sim.test_force_recipes import printed
from tests.worlds.loading import loaded_mechanism
from tests.worlds.tiers import few, slowly

FOURBAR = load_scene("fourbar-lecture-1")
MASSLESS = load_scene("slider-crank-excel-210")
TRAPEZOIDAL: Settings = {"integrator": "TrapezoidalIndex2"}
SETTLED = 40
"""Samples after which nothing of the start is left in forces."""
WITHIN: Mapping[str, float] = {
    "fourbar-double-crank": 6e-4,
    "slider-crank-excel-210": 9e-4,
    "slider-crank-excel-220": 5e-4,
    "whitworth": 8e-4,
}
"""Of the largest force, and of the largest torque, where it is not 2.5e-4: what generalised alpha
leaves of accelerations at 720 steps a turn. It shrinks as the step squared."""
KINDS = ("sixbar-watt", "slider-crank-excel-210", "shaper", "scotch-yoke", "slotted-lever")
WAVE = Sine(1.0, 0.1, 0.4)


def opened(
    scene: Scene,
    steps: int = 720,
    settings: Settings | None = None,
    drive: Drive = "prescribed",
    start_s: float = 0.0,
) -> ExudynSession:
    state = solve(scene, np.array([start_s])).state()
    asked = resolved(ENGINE.profiles["tuned"], settings)
    return ENGINE.open(scene, state, asked, scene.driver.law.period_s / steps, drive)


def off(scene: Scene, forces: Forces) -> tuple[Array, Array]:
    """At each sample the largest error of all reactions over the largest of them, a moment over the
    largest moment, and the error of the torque over the largest torque."""
    true = kinetostatics.forces(scene, forces.time_s, bound=False, skip_dead_points=True)
    exact = dict(named(true))
    assert [name for name, _ in named(forces)] == list(exact)
    sizes = {}
    for kind in ("force", "moment", "torque"):
        each = [float(np.nanmax(np.abs(s))) for name, s in exact.items() if kind in name]
        sizes[kind] = max(each, default=1.0)
    sizes["moment"] = max(sizes["moment"], 1e-9 * sizes["force"])
    wrong = {"reaction": np.zeros(len(forces.time_s)), "torque": np.zeros(0)}
    for name, series in named(forces):
        kind = next(kind for kind in sizes if kind in name)
        error = np.abs(series - exact[name]).reshape(len(series), -1).max(axis=1) / sizes[kind]
        if kind == "torque":
            wrong["torque"] = error
        else:
            wrong["reaction"] = np.fmax(wrong["reaction"], error)
    return wrong["reaction"], wrong["torque"]


@pytest.mark.parametrize("name", few(shipped(), KINDS, "shapes of the same kinds"))
def test_reactions_and_torque_are_those_of_the_reference(name: str) -> None:
    scene = load_scene(name)
    limit = WITHIN.get(name, 2.5e-4)
    for wrong in off(scene, opened(scene).record_forces(720, 1).forces):
        assert wrong[0] < 1e-6
        assert np.nanmax(wrong[SETTLED:]) < limit


@pytest.mark.parametrize(
    ("name", "settings"), [("sixbar-watt", {}), ("shaper", {}), ("fourbar-lecture-1", TRAPEZOIDAL)]
)
def test_errors_shrink_as_the_step_squared(name: str, settings: Settings) -> None:
    scene = load_scene(name)
    coarse, fine = (
        off(scene, opened(scene, n, settings).record_forces(n, 1).forces) for n in (360, 1440)
    )
    for one, other in zip(coarse, fine, strict=True):
        assert 12.0 < np.nanmax(one[SETTLED:]) / np.nanmax(other[SETTLED:]) < 20.0


def test_what_the_start_shakes_is_a_share_of_the_step_and_gone_soon() -> None:
    coarse, fine = (
        off(FOURBAR, opened(FOURBAR, n).record_forces(60, 1).forces)[0] for n in (360, 1440)
    )
    assert 3.0 < coarse.max() / fine.max() < 5.0
    assert fine.max() == fine[1]
    assert fine[SETTLED:].max() < 0.03 * fine[1]


@pytest.mark.parametrize("settings", [{}, {"adaptive_step": "disable"}])
def test_the_motion_is_the_same_to_the_bit_and_two_stretches_are_one(settings: Settings) -> None:
    scene = load_scene("fourbar-double-rocker")
    plain, whole, parts = (opened(scene, settings=settings) for _ in range(3))
    moved, log = plain.record(90, 3).poses, whole.record_forces(90, 3)
    for one, other in zip(moved.bodies.values(), log.poses.bodies.values(), strict=True):
        assert all(np.array_equal(vars(one)[key], vars(other)[key]) for key in vars(one))
    parts.record_forces(30, 3)
    later = parts.record_forces(60, 3).forces.torque
    np.testing.assert_allclose(later, log.forces.torque[10:], rtol=1e-7)


def test_a_motor_and_nothing_at_all_have_the_torque_that_they_have() -> None:
    heavy = replace(FOURBAR, gravity_m_s2=(0.0, -9.81))
    motor = opened(heavy, drive="servo").record_forces(720, 1).forces
    assert off(heavy, motor)[1][200:].max() < 5e-3
    assert np.all(opened(heavy, drive="free").record_forces(20, 1).forces.torque == 0.0)


@pytest.mark.parametrize("number", few([0, 4, 6, 8, 18, 36], {4, 8}, "more of them at random"))
def test_loads_of_every_kind_are_felt_in_mechanisms_of_every_dyad(number: int) -> None:
    scene, _ = loaded_mechanism(number)
    for wrong in off(scene, opened(scene, 1440).record_forces(720, 1).forces):
        assert wrong[0] < 1e-5
        assert np.nanmax(wrong[SETTLED:]) < 1e-4


LOADED = {
    "force": Load("force", "block C", "C", Sine(800.0, 0.1, 0.3), direction_rad=0.7),
    "turning": Load("turning", "block C", "C", Constant(300.0), direction_rad=0.7, frame="body"),
    "torque": Load("torque", "block C", None, Polynomial((30.0, 500.0)), "displacement", "C"),
}


def test_what_acts_on_a_block_without_mass_goes_to_its_pin_and_its_guide() -> None:
    loaded = replace(MASSLESS, loads=LOADED)
    forces = opened(loaded).record_forces(720, 1).forces
    for wrong in off(loaded, forces):
        assert np.nanmax(wrong[SETTLED:]) < 1e-4
    assert float(np.abs(forces.sliders["C"].moment).max()) > 10.0
    moving = load_scene("slotted-lever")
    along = Load("along", "block B", "B", WAVE, direction_rad=0.7, frame="body")
    turned = replace(moving, loads={"along": along})
    wrong, _ = off(turned, opened(turned).record_forces(720, 1).forces)
    assert np.nanmax(wrong[SETTLED:]) < 2.5e-4


@pytest.mark.parametrize(("name", "sizes"), [
    ("fourbar-lecture-1", {"A": 0.01, "B": 0.01, "C": 0.02}),
    slowly("shaper", {"B": 5.0, "F": 3.0, "E": 0.3}, reason="joints of the others, half a second"),
    ("slotted-lever", {"B": 1.0, "C": 0.1}),
    ("slider-crank-excel-210", {"C": 50.0}),
])  # fmt: skip
def test_constant_friction_takes_the_power_that_it_has_to(
    name: str, sizes: Mapping[str, float]
) -> None:
    plain = load_scene(name)
    rubbing = {joint: ConstantFriction(joint, size) for joint, size in sizes.items()}
    rubbed = replace(plain, friction=rubbing)
    felt, bare = (opened(s).record_forces(720, 1).forces for s in (rubbed, plain))
    times = plain.driver.law.period_s / 720 * np.arange(721)
    true = [
        kinetostatics.forces(s, times, bound=False, skip_dead_points=True).torque
        for s in (rubbed, plain)
    ]
    taken = true[0] - true[1]
    same = np.abs((felt.torque - bare.torque) - taken) < 1e-6 * np.abs(taken).max()
    assert same.mean() > 0.99  # but where a joint turns back on a sample
    reactions, _ = off(rubbed, felt)
    assert np.nanquantile(reactions[SETTLED:], 0.99) < 1e-3


def test_what_it_can_not_be_given_is_refused_with_the_reason() -> None:
    state = solve(FOURBAR, np.zeros(1)).state()
    rubbing = replace(FOURBAR, friction={"C": ConstantFriction("C", 0.1)})
    done = run(rubbing, state, ENGINE, dt_s=1e-3, steps=10, drive="free")
    assert done.status == "unsupported"
    assert "joints that nothing drives come to rest and stick" in done.reason
    with pytest.raises(EngineError, match="none that follows the reactions"):
        opened(replace(FOURBAR, friction={"C": CoulombFriction("C", 0.1, 0.01)}))
    with pytest.raises(EngineError, match=r"loads.l: found body wheel; use one of crank, coupler"):
        opened(replace(FOURBAR, loads={"l": Load("l", "wheel", None, WAVE)}))


def test_a_table_that_ends_too_soon_is_told_without_exudyns_words_about_it() -> None:
    state = solve(FOURBAR, np.zeros(1)).state()
    short = Load("short", "rocker", None, Tabulated((0.0, 0.05), (1.0, 2.0)))
    done = run(replace(FOURBAR, loads={"short": short}), state, ENGINE, dt_s=1e-3, steps=100)
    assert done.status == "diverged"
    assert done.reason.startswith("stopped after 0.05 s: loads.short: over the time [s] the table")
    late = replace(short, characteristic=Tabulated((1.0, 2.0), (1.0, 2.0)))
    done = run(replace(FOURBAR, loads={"short": late}), state, ENGINE, dt_s=1e-3, steps=100)
    assert done.status == "unsupported"
    assert "the table goes from 1 to 2, and 0 is asked for" in done.reason


@pytest.mark.parametrize("name", ["fourbar-lecture-1", "shaper", "slotted-lever"])
def test_the_recipe_prints_what_is_reported(name: str) -> None:
    scene = replace(load_scene(name), gravity_m_s2=(0.5, -9.81))
    state, settings = solve(scene, np.zeros(1)).state(), resolved(ENGINE.profiles["tuned"], None)
    text = force_recipe("exudyn", scene, state, settings, 180)
    assert "crankcheck" not in text
    assert max(len(line) for line in text.splitlines() if line.startswith("#")) <= 100
    log = np.genfromtxt(io.StringIO(printed(text)), delimiter=",", names=True, deletechars="")
    forces = opened(scene, 180).record_forces(180, 1).forces
    assert len(log) == 181
    scale = float(np.abs(forces.torque).max())
    np.testing.assert_allclose(log["torque_n_m"], forces.torque, atol=1e-6 * scale)
    for column in log.dtype.names[1:-1]:
        point, body, axis = column.replace("block_", "block ").rsplit(".", 2)
        force = forces.pins[point][body][:, int(axis == "y_n")]
        np.testing.assert_allclose(log[column], force, atol=1e-6 * np.abs(force).max())


def test_a_recipe_that_would_leave_something_out_is_refused() -> None:
    state = solve(MASSLESS, np.zeros(1)).state()
    settings = resolved(ENGINE.profiles["tuned"], None)
    with pytest.raises(EngineError, match="does not cover loads; take that out"):
        force_recipe("exudyn", replace(MASSLESS, loads=LOADED), state, settings, 90)
