"""Every engine adapter holds the contract, and the fake ones as well; a model is looked at."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

from analytic.kinematics import solve
from models.errors import EngineError
from models.files.reading import load_scene
from reports.contract.clauses import CLAUSES
from reports.contract.ruling import SCENES, put_to
from reports.contract.subject import Subject, numbers
from sim.engine import BodyPose, Engine, Facts, SettingValue
from sim.registry import ENGINES, engine
from sim.run.check import refuse_other_model
from tests.worlds.runs import all_series, opened, start_of
from tests.worlds.tiers import slowly

DT_S = 1e-3
FOURBAR = load_scene("fourbar-lecture-1")
NOT_OF_FAKES = {
    "EC52": "placing is solved",
    "EC55": "told to refuse drive free",
    "EC93": "told to refuse drive free",
}
"""What the fake engines do not promise."""
OF_FORCES = {"EC81", "EC82", "EC83", "EC84", "EC85", "EC86"}
OF_LOADS, OF_SPRINGS = {"EC85", "EC94"}, {"EC91", "EC92"}
"""Clauses of what an engine need not declare."""
REFUSED = {("mujoco", "EC86"): "slotted-lever"}
"""A scene that an engine refuses in one clause alone: friction in the pin that closes its loop."""
DEAR = ("EC54", "EC55", "EC61", "EC85", "EC86", "EC93")
"""Clauses of many runs each, which take half of all clauses' time."""
FEW = ("shaper",)
"""Pins, a block on a line that moves, a link that slides: what the others are made of too."""
SOLVERS, NOT_OF_SOLVERS = ("exudyn",), {"EC52": "placing is solved"}
"""Engines that solve for their joints, and what that leaves nothing to try of."""


@pytest.fixture(params=[*ENGINES, "fake-staggered"])
def adapter(request: pytest.FixtureRequest, fake_engine: ModuleType) -> Engine:
    name = str(request.param)
    if name in ENGINES:
        return engine(name)
    shift, drives = 0.5 * (name != "fake"), ("prescribed", "servo")
    made: Engine = fake_engine.FakeEngine(solve, velocity_shift=shift, drives=drives)
    return made


@pytest.mark.parametrize(("clause", "scenes"), [
    *(pytest.param(id, SCENES[2:3] if id in DEAR else FEW, id=id) for id in CLAUSES),
    *(
        slowly(
            id, SCENES, id=f"{id} all", reason="kinds of joints of which others test the parts"
        )
        for id, clause in CLAUSES.items()
        if clause.of_scenes
    ),
])  # fmt: skip
def test_every_engine_holds_the_contract(
    adapter: Engine, clause: str, scenes: Sequence[str]
) -> None:
    ours = adapter.name in ENGINES
    scenes = scenes if ours else scenes[:3]
    ruling = put_to(adapter, CLAUSES[clause], scenes)
    assert ruling.breaches == ()
    untried = NOT_OF_SOLVERS if adapter.name in SOLVERS else {} if ours else NOT_OF_FAKES
    if clause in OF_FORCES | OF_LOADS | OF_SPRINGS and not declares(adapter, clause):
        assert ruling.answer == "not tried"
    elif clause in untried:
        assert untried[clause] in ruling.untried[0]
    else:
        wanted = [name for name in scenes if name != REFUSED.get((adapter.name, clause))]
        assert list(ruling.scenes) == (wanted if CLAUSES[clause].of_scenes else wanted[:1])


def declares(adapter: Engine, clause: str) -> bool:
    """Whether an engine declares what a clause of forces, loads or springs is of."""
    if clause in OF_SPRINGS:
        return adapter.applies_springs
    if clause in OF_LOADS:
        return adapter.applies_loads
    return adapter.forces_of != "nothing" and (
        adapter.applies_constant_friction or clause != "EC86"
    )


@pytest.mark.parametrize(("name", "drive", "settings"), [
    ("pymunk", "servo", {}),
    ("pymunk", "free", {}),
    ("exudyn", "prescribed", {"adaptive_step": "disable"}),
])  # fmt: skip
def test_forces_change_no_number_of_the_motion(
    name: str, drive: str, settings: dict[str, SettingValue]
) -> None:
    """Accelerations too, which the contract leaves open."""
    scene = load_scene("slider-crank-offset")
    plain, beside = (opened(scene, name, settings, dt_s=DT_S, drive=drive) for _ in range(2))
    for every in (3, 1):
        alone, log = plain.record(60, every), beside.record_forces(60, every)
        assert alone.forces is None
        np.testing.assert_array_equal(all_series(alone.poses), all_series(log.poses))
        np.testing.assert_array_equal(log.forces.time_s, log.poses.time_s)


def test_two_stretches_equal_one_for_a_solver_that_has_not_converged() -> None:
    """Such a solver goes on from the last step's answer, and has to over the seam as well."""
    given = {"profile": "as-shipped", "dt_s": DT_S}
    rough = {"solver": "CG", "iterations": 1}
    whole, parts = (opened(FOURBAR, "mujoco", rough, **given) for _ in range(2))
    one = whole.record(500, 1)
    parts.record(200, 1)
    np.testing.assert_array_equal(numbers(parts.record(300, 1).poses), numbers(one.poses)[200:])


@pytest.mark.parametrize(("wrong", "named"), [
    (lambda f: replace(f, mass_kg={**f.mass_kg, "rocker": 7.0}), "rocker has mass_kg 7"),
    (lambda f: replace(f, mass_kg={}), "rocker has no mass_kg"),
    (
        lambda f: replace(f, centre_m={**f.centre_m, "rocker": (0.1, 1e-6)}),
        r"rocker has centre_m \(0.1, 1e-06\), not \(0.1, 0.0\)"),
    (
        lambda f: replace(f, inertia_kg_m2={**f.inertia_kg_m2, "coupler": 7.0}),
        "coupler has inertia_kg_m2 7"),
    (lambda f: replace(f, gravity_m_s2=(0.0, -9.81)), "gravity is"),
    (lambda f: with_rocker(f, lambda b: replace(b, theta=b.theta + 1e-6)), "rocker stands at"),
    (lambda f: with_rocker(f, lambda b: replace(b, origin=b.origin + 1e-6)), "rocker lies at"),
    (lambda f: with_rocker(f, lambda b: replace(b, omega=b.omega * 1.1)), "rocker turns at"),
    (lambda f: with_rocker(f, lambda b: replace(b, velocity=b.velocity + 1.0)), "rocker moves"),
    (lambda f: with_rocker(f, lambda b: replace(b, theta=b.theta * np.nan)), "rocker stands"),
    (lambda f: with_rocker(f, lambda b: replace(b, origin=b.origin + 1e-11)),
     r"[CD] is open by 1\.4\de-11 m"),
])  # fmt: skip
def test_a_model_that_is_not_the_scene_is_refused_by_name(
    wrong: Callable[[Facts], Facts], named: str
) -> None:
    facts = wrong(Subject(engine("pymunk"), FOURBAR).opened().facts())
    with pytest.raises(EngineError, match=named):
        refuse_other_model(FOURBAR, start_of(FOURBAR), facts, DT_S, "prescribed")


def with_rocker(facts: Facts, change: Callable[[BodyPose], BodyPose]) -> Facts:
    """The facts with another rocker at the start."""
    bodies = {**facts.start.bodies, "rocker": change(facts.start.bodies["rocker"])}
    return replace(facts, start=replace(facts.start, bodies=bodies))
