"""What faults plant whose runs `make slow` has (`test_faults.py`): here no engine runs, and what it
would be given, or what stands in the place of its log, is looked at."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from analytic.elastic.discretisation import REFERENCE
from analytic.free.release import release
from models.files.reading import load_scene
from models.scene import Link, Scene
from models.scene.cut_scenes import SegmentedScene
from reports.selftest import elastic_changes, elastic_faults
from reports.selftest.elastic_changes import BEAM_RUNS, BENT, LOOSE, elastic_cell
from reports.selftest.free_faults import SWING
from reports.selftest.trial import FAULTS

ENGINE = "mujoco"
CHAIN = elastic_cell(LOOSE, ENGINE).given
"""Segments that are let go, as an engine is given them."""
ELASTIC = elastic_cell(BENT, ENGINE)
STEP_S = 0.4 / 1440
Given = Callable[[str, Scene], tuple[Any, Any]]


@pytest.fixture
def given(monkeypatch: pytest.MonkeyPatch) -> Given:
    """The scene and the start that an engine is given with a fault of its own size; one of 0
    gives it the right scene."""

    def find(name: str, scene: Scene) -> tuple[Any, Any]:
        asked: list[tuple[object, ...]] = []
        for module in ("fault", "segment_changes"):
            monkeypatch.setattr(
                f"reports.selftest.{module}.run", lambda *given, **_: asked.append(given)
            )
        for size in (FAULTS[name].planted, 0.0):
            FAULTS[name].plant(size)(scene, "the start", ENGINE, "tuned", dt_s=STEP_S)
        (wrong, start, *names), (right, *_) = asked
        assert right == scene
        assert names == [ENGINE, "tuned"]
        return wrong, start

    return find


def heavier(link: Link) -> Link:
    return replace(link, mass_kg=1.01 * link.mass_kg, inertia_kg_m2=1.01 * link.inertia_kg_m2)


@pytest.mark.parametrize(
    ("name", "times", "late_s"),
    [("loose-torque-late", 1.0, STEP_S), ("loose-torque-back", -1.0, 0)],
)
def test_a_torque_of_links_that_are_let_go_is_late_or_turns_the_other_way(
    name: str, times: float, late_s: float, given: Given
) -> None:
    wrong, start = given(name, CHAIN)
    time_s = np.linspace(0.0, 1.5, 98)
    right = CHAIN.loads["pulse"].magnitude(time_s)
    assert np.ptp(right) > 0.0
    assert wrong.loads["pulse"].magnitude(time_s + late_s) == pytest.approx(times * right)
    assert (replace(wrong, loads=CHAIN.loads), start) == (CHAIN, "the start")
    assert (FAULTS[name].scenes, FAULTS[name].rule) == ((LOOSE,), "CC127")


ROCKER = list(CHAIN.links)[-1]
HEAVY = {**CHAIN.links, ROCKER: heavier(CHAIN.links[ROCKER])}
STIFF = {n: replace(s, rate=1.01 * s.rate) for n, s in CHAIN.springs.items()}
DAMPED = {n: replace(s, damping=1e-3 * s.rate) for n, s in CHAIN.springs.items()}


@pytest.mark.parametrize(
    ("name", "other", "rule"),
    [
        ("loose-modulus-off", {"springs": STIFF}, "CC132"),
        ("loose-damping", {"springs": DAMPED}, "CC132"),
        ("loose-rocker-heavy", {"links": HEAVY}, "CC127"),
    ],
)
def test_links_that_are_let_go_have_other_springs_or_masses_and_the_same_start(
    name: str, other: dict[str, object], rule: str, given: Given
) -> None:
    assert given(name, CHAIN) == (replace(CHAIN, **other), "the start")
    assert (FAULTS[name].scenes, FAULTS[name].rule) == ((LOOSE,), rule)


def softer_and_heavier(scene: Scene) -> Scene:
    ((name, own),) = scene.elastic.items()
    soft = replace(own, flexural_n_m2=own.flexural_n_m2 / 1.01)
    links = {**scene.links, name: heavier(scene.links[name])}
    return replace(scene, links=links, elastic={name: soft})


def longer(scene: Scene) -> Scene:
    (name,) = scene.elastic
    link = scene.links[name]
    points = {point: (1.01 * x, 1.01 * y) for point, (x, y) in link.points.items()}
    x, y = link.centre_m
    long = replace(link, points=points, centre_m=(1.01 * x, 1.01 * y))
    return replace(scene, links={**scene.links, name: long})


@pytest.mark.parametrize(
    ("name", "change", "rule"),
    [("elastic-other", softer_and_heavier, "CC132"), ("elastic-long", longer, "CC103")],
)
def test_another_elastic_machine_starts_on_its_own_periodic_motion(
    name: str,
    change: Callable[[Scene], Scene],
    rule: str,
    given: Given,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(elastic_faults, "segment_start", lambda *asked: asked)
    wrong, (chain, shape) = given(name, ELASTIC.given)
    other = SegmentedScene(change(ELASTIC.scene), 4)
    assert (chain.scene, chain.count, shape) == (other.scene, 4, "periodic")
    assert wrong == other.rigid
    assert (FAULTS[name].scenes, FAULTS[name].rule) == ((BENT,), rule)


def test_gravity_that_is_hardly_too_strong_is_looked_for_at_finer_steps(given: Given) -> None:
    scene, fault = load_scene(SWING), FAULTS["gravity-hardly"]
    wrong, start = given(fault.name, scene)
    assert wrong.gravity_m_s2 == pytest.approx((0.0, -9.81 * 1.0001))
    assert replace(wrong, gravity_m_s2=scene.gravity_m_s2) == scene
    assert start == release(wrong, STEP_S).at(np.zeros(1)).state()
    assert (fault.finer, fault.rule) == (True, "CC110")


@dataclass(frozen=True)
class Logged:
    motion: Any


@pytest.mark.parametrize(
    ("name", "stiffened", "rule"),
    [
        ("linear-given", False, "CC132"),
        ("beam-given", True, "CC132"),
        ("beam-linear-given", False, "CC131"),
        ("beam-theory-given", True, "CC111"),
    ],
)
def test_a_theory_stands_in_the_place_of_the_log(
    name: str, stiffened: bool, rule: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    fault, logged = FAULTS[name], SimpleNamespace(time_s="the instants of the log")
    runs = {"runs": BEAM_RUNS} if fault.kind == "beam" else {}
    cell = elastic_cell(BENT, "exudyn", **runs)
    theories: list[tuple[object, ...]] = []

    def theory(*asked: object) -> SimpleNamespace:
        theories.append(asked)
        return SimpleNamespace(at=lambda time_s: ("the theory at", time_s))

    monkeypatch.setattr(elastic_changes, "DrivenElasticMotion", theory)
    monkeypatch.setattr(elastic_changes, "sound_run", lambda *_: Logged(logged))
    monkeypatch.setattr(elastic_changes, "_given_back", lambda *asked: asked)
    done = fault.plant(1.0)(cell.given, "the start", "exudyn", "tuned", dt_s=1.0)
    cut, own, other = done.motion
    assert (cut.given, own, other) == (cell.given, logged, ("the theory at", logged.time_s))
    assert theories == [(cell.scene, 1.0, REFERENCE, "periodic", stiffened)]
    assert fault.plant(0.0)(cell.given, "the start", "exudyn", "tuned").motion is logged
    assert (fault.scenes, fault.rule, fault.size) == ((BENT,), rule, None)
