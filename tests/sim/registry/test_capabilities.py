"""What an engine has and lacks, and engines that are not installed or whose files have faults; the
knobs of the engines, and what they cost.
"""

import itertools
import math
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

from benchmarks.step_cost import start
from models.errors import EngineError
from models.files.reading import load_scene
from sim import registry
from sim.exudyn import knobs as exudyn_knobs
from sim.exudyn.engine import ExudynSession
from sim.mujoco import knobs as mujoco_knobs
from sim.mujoco.knobs import EVALUATIONS
from sim.mujoco.settings import INTEGRATORS
from sim.pymunk import knobs as pymunk_knobs
from sim.pymunk.knobs import RAIL_US
from sim.registry import engine, offering
from sim.registry.offers import Knob, Work, rungs, search_space, snippet, viewer
from sim.run.spoil import spoiler
from tests.test_architecture import ROOT
from tests.worlds.engines import HERE
from tests.worlds.runs import ran, tuned


@pytest.mark.parametrize(("ask", "lacks"), [
    (lambda: search_space("fake"), "it has no knobs; use mujoco or pymunk or exudyn"),
    (lambda: snippet("fake", {}, 100), "it has no snippet; use mujoco or pymunk or exudyn"),
    (lambda: spoiler("fake"), "it has no spoiler; use mujoco or pymunk"),
    (lambda: registry.capability("pymunk", "viewer"), "it has no viewer; use mujoco"),
    (lambda: snippet("chrono", {}, 100), "'chrono': unknown; there are mujoco, pymunk, exudyn"),
])  # fmt: skip
def test_a_capability_that_is_lacking_is_named_with_who_has_it(
    ask: Callable[[], object], lacks: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(registry.ENGINES, "fake", "tests.worlds.fake")
    assert engine("fake").version() == "1.0"
    with pytest.raises(EngineError, match=lacks):
        ask()


def test_what_is_declared_is_there_or_said_to_be_nowhere(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in HERE:
        for what in registry.declaration(name).offers:
            assert registry.capability(name, what)
    monkeypatch.setattr(registry, "ENGINES", {"fake": "tests.worlds.fake"})
    with pytest.raises(EngineError, match="it has no viewer; no engine has one"):
        registry.capability("fake", "viewer")
    with pytest.raises(EngineError, match="no engine has a window of its own"):
        viewer()


def package(folder: Path, name: str, needs: str, text: str) -> Path:
    """The files of an engine: a declaration, and an adapter with this text."""
    own = folder / name
    own.mkdir()
    declared = (
        f"from sim.registry import Declaration\nDECLARATION = Declaration({needs!r}, extra=False)\n"
    )
    (own / "__init__.py").write_text(declared)
    (own / "engine.py").write_text(text)
    return own


def test_a_fault_in_the_files_of_an_engine_is_not_taken_for_a_missing_package(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = package(tmp_path, "wrong_engine", "json", "import math\nmath.nothing_there\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setitem(registry.ENGINES, "wrong", "wrong_engine")
    with pytest.raises(AttributeError, match="nothing"):
        engine("wrong")
    for lacking in ("json.nothing", "json.JSONDecoder.nothing", "json.JSONDecoder().nothing"):
        (folder / "engine.py").write_text(f"import json\n{lacking}\n")
        with pytest.raises(EngineError, match="engine wrong: not installed"):
            engine("wrong")


def test_a_package_that_can_not_be_imported_is_no_missing_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package(tmp_path, "broken_engine", "brkn", "import brkn\n")
    (tmp_path / "brkn.py").write_text("raise RuntimeError('no screen\\nhere')\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(registry, "ENGINES", {"broken": "broken_engine"})
    monkeypatch.setenv("BRKN_GL", "foo")
    words = "brkn can not be imported here: RuntimeError: no screen; check BRKN_GL=foo, or install"
    with pytest.raises(EngineError, match=words):
        engine("broken")
    (entry,) = registry.available()
    assert entry.version is None
    assert words in entry.broken


def test_a_snippet_is_made_where_the_engine_is_not_installed() -> None:
    code = (
        "import sys; sys.modules.update(mujoco=None, pymunk=None, exudyn=None)\n"
        "from sim.registry.offers import snippet\n"
        "for name in ('mujoco', 'pymunk', 'exudyn'): print(snippet(name, {}, 90))"
    )
    printed = subprocess.check_output([sys.executable, "-c", code], cwd=ROOT, text=True)
    for part in ("<option timestep=", "space.step(dt)", "stepping.numberOfSteps"):
        assert part in printed


TUNABLE = offering("knobs")


@pytest.mark.parametrize("name", TUNABLE)
def test_a_search_starts_at_the_profile_and_its_knobs_reach_every_start(name: str) -> None:
    space = search_space(name).around(tuned(name))
    assert space.settings(tuned(name), space.starts[0]) == tuned(name)
    assert len(space.starts) > 1
    for knob in space.knobs:
        assert all(start[knob.name] in knob.values for start in space.starts)
        assert len(set(knob.values)) == len(knob.values)
        if knob.ordered:
            assert list(knob.values) == sorted(knob.values, key=float)


@pytest.mark.parametrize("name", TUNABLE)
def test_the_engine_takes_the_values_and_holds_them(name: str) -> None:
    scene = load_scene("fourbar-lecture-1")
    space = search_space(name).around(tuned(name))
    for knob in space.knobs:
        for value in knob.values[::4]:
            settings = space.settings(tuned(name), {**space.starts[0], knob.name: value})
            done = ran(scene, name, dt_s=1e-3, steps=1, settings=settings)
            assert [done.asked[each] for each in knob.targets] == [value] * len(knob.targets)
            assert all(
                math.isclose(float(done.settings[each]), float(value))
                for each in knob.targets
                if knob.ordered
            )


def test_a_knob_goes_through_values_that_it_has_not_and_rungs_are_round() -> None:
    assert Knob("n", (1, 5, 9)).through(7, 5).values == (1, 5, 7, 9)
    assert Knob("word", ("b", "a")).through("c").values == ("b", "a", "c")
    found = rungs(2.0, 20.0, 1.06)
    assert (found[0], found[-1]) == (2.0, 20.0)
    assert all(value == float(f"{value:.2g}") for value in found)
    assert all(1.0 < b / a < 1.12 for a, b in itertools.pairwise(found))


MUJOCO, PYMUNK, EXUDYN = map(tuned, ("mujoco", "pymunk", "exudyn"))


def works(knobs: ModuleType, *names: str) -> list[Work]:
    return [knobs.work(scene, start(scene)) for scene in map(load_scene, names)]


def test_work_costs_by_evaluations_bodies_loops_rails_and_matrices() -> None:
    assert set(EVALUATIONS) == set(INTEGRATORS)
    four, six = works(mujoco_knobs, "fourbar-lecture-1", "sixbar-watt")
    assert six(MUJOCO) > four(MUJOCO) > 3.0 * four({**MUJOCO, "integrator": "implicitfast"})
    # A rail costs its own, and only where there is one.
    exact, groove = ({**PYMUNK, "iterations": 1, "lines": each} for each in ("exact", "groove"))
    fourbar, massless = works(pymunk_knobs, "fourbar-lecture-1", "slider-crank-excel-210")
    assert fourbar(exact) == fourbar(groove)
    assert massless(exact) - massless(groove) == pytest.approx(RAIL_US, rel=0.01)
    # A matrix and an iteration cost as much as the mechanism is large.
    four, six = works(exudyn_knobs, "fourbar-lecture-1", "sixbar-watt")
    assert four(EXUDYN) < four({**EXUDYN, "jacobian": "each-iteration"})
    assert four({**EXUDYN, "relative_tolerance": 1e-4}) < four(EXUDYN)
    assert 1.5 < six(EXUDYN) / four(EXUDYN) < 2.5


@pytest.mark.parametrize("name", ["fourbar-lecture-1", "slider-crank-excel-210", "shaper"])
def test_the_unknowns_are_those_of_the_engine(name: str) -> None:
    scene = load_scene(name)
    session = ExudynSession(scene, start(scene), EXUDYN, 1e-3, "prescribed")
    held = session._system.systemData
    assert exudyn_knobs.unknowns(scene) == held.ODE2Size() + held.AEsize()
