"""The forces that exudyn reports, against the reference; loads and friction that it is given."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pytest

from analytic.forces import kinetostatics
from models.array import Array
from models.errors import EngineError
from models.files.reading import load_scene
from models.motion import Forces
from models.scene import Scene
from models.scene.characteristics import Constant, Polynomial, Sine
from models.scene.loads import CoulombFriction, Load
from models.scene.tabulated import Tabulated
from sim.engine import Settings
from sim.exudyn.engine import ENGINE
from tests.worlds import runs
from tests.worlds.loading import loaded_mechanism
from tests.worlds.reported_forces import misses
from tests.worlds.runs import acted_on, ran, rubbing

FOURBAR = load_scene("fourbar-lecture-1")
MASSLESS = load_scene("slider-crank-excel-210")
TRAPEZOIDAL: Settings = {"integrator": "TrapezoidalIndex2"}
SETTLED = 40
"""Samples after which nothing of the start is left in forces."""
WITHIN: Mapping[str, float] = {
    "slider-crank-excel-210": 9e-4,
}
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


@pytest.mark.parametrize(("name", "settings"), [("shaper", {}), ("fourbar-lecture-1", TRAPEZOIDAL)])
def test_errors_shrink_as_the_step_squared(name: str, settings: Settings) -> None:
    scene = load_scene(name)
    coarse, fine = (
        off(scene, opened(scene, n, settings).record_forces(n, 1).forces) for n in (360, 1440)
    )
    for one, other in zip(coarse, fine, strict=True):
        assert 12.0 < np.nanmax(one[SETTLED:]) / np.nanmax(other[SETTLED:]) < 20.0


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
    assert "joints that nothing drives come to rest and stick" in done.reason
    with pytest.raises(EngineError, match="none that follows the reactions"):
        opened(acted_on(FOURBAR, CoulombFriction("C", 0.1, 0.01)))
    with pytest.raises(EngineError, match=r"loads.l: found body wheel; use one of crank, coupler"):
        opened(acted_on(FOURBAR, Load("l", "wheel", None, WAVE)))


def test_a_table_that_ends_too_soon_is_told_without_exudyns_words_about_it() -> None:
    table = "loads.short: over the time [s] the table"
    for from_s, until_s, status, said in (
        (0.0, 0.05, "diverged", f"stopped after 0.05 s: {table}"),
        (1.0, 2.0, "unsupported", f"{table} goes from 1 to 2, and 0 is asked for"),
    ):
        short = Load("short", "rocker", None, Tabulated((from_s, until_s), (1.0, 2.0)))
        done = ran(acted_on(FOURBAR, short), ENGINE, dt_s=1e-3, steps=100, well=False)
        assert (done.status, done.reason.startswith(said)) == (status, True)
