"""Every engine adapter holds the contract; a model is looked at."""

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np
import pytest

from models.errors import EngineError
from models.files.reading import load_scene
from reports.contract.clauses import CLAUSES
from reports.contract.ruling import SCENES, put_to
from reports.contract.subject import Subject, numbers
from sim.engine import BodyPose, Facts
from sim.registry import FIRST, engine
from sim.run.check import refuse_other_model
from tests.worlds.engines import FULL, HERE
from tests.worlds.runs import opened, start_of
from tests.worlds.tiers import slowly

DT_S = 1e-3
FOURBAR = load_scene("fourbar-lecture-1")
REFUSED = {
    ("mujoco", "EC86"): ("slotted-lever",),
    ("dart", "EC86"): ("slotted-lever",),
    ("bullet", "EC86"): ("slotted-lever",),
    ("drake", "EC86"): SCENES,
    ("simbody", "EC86"): SCENES,
}
"""Scenes that an engine refuses in one clause alone: friction in the pin that closes its loop, or
in all pins."""
DECLARED = "placing", "in_seconds", "floor", "forces_of", "applies_"
"""Declarations by which a clause does not apply."""
QUICK = (*FULL, "rapier", "box2d", "dart")
"""Engines that install in a minute."""
AT_LENGTH = (
    "EC37", "EC53", "EC54", "EC55", "EC57", "EC61", "EC71", "EC85", "EC86", "EC92", "EC93", "EC94",
)  # fmt: skip
"""Clauses that take long in these, on what they share or what others show too."""
SLOW = "rapier"
OF_MOTION = ("EC14", "EC41", "EC51", "EC52", "EC56", "EC82", "EC83", "EC84")
"""Clauses for which `SLOW` runs for half a second each: verdicts on its motion and its forces are
in tests/sim/test_simple_engines.py, and of its precision there is box2d."""


def _cases() -> Iterator[object]:
    """Yield engine, clause and scenes. The shaper has pins, a block on a line that moves, and a
    link that slides."""
    for name, clause in itertools.product(HERE, CLAUSES):
        lengthy = (*AT_LENGTH, *(OF_MOTION if name == SLOW else ()))
        if name == FIRST or (name in QUICK and clause not in lengthy):
            yield pytest.param(name, clause, ("shaper",))
        yield slowly(name, clause, SCENES, reason="joints of one kind are alike, and engines share")


@pytest.mark.parametrize(("name", "clause", "scenes"), [*_cases()])
def test_every_engine_holds_the_contract(name: str, clause: str, scenes: Sequence[str]) -> None:
    ruling = put_to(engine(name), CLAUSES[clause], scenes)
    assert ruling.breaches == ()
    refused = REFUSED.get((name, clause), ())
    wanted = [scene for scene in scenes if scene not in refused]
    if ruling.scenes or not wanted:
        assert list(ruling.scenes) == (wanted if CLAUSES[clause].of_scenes else wanted[:1])
    else:
        assert ruling.untried[0].partition(": ")[2].startswith(DECLARED)


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
    bodies = {**facts.start.bodies, "rocker": change(facts.start.bodies["rocker"])}
    return replace(facts, start=replace(facts.start, bodies=bodies))
