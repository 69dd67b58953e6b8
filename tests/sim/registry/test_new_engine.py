"""What an engine has and lacks, and engines that are not installed or whose files have faults."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from models.errors import EngineError
from sim import registry
from sim.registry import engine
from sim.registry.offers import search_space, snippet, viewer
from sim.run.spoil import spoiler
from tests.test_architecture import ROOT


@pytest.mark.parametrize(("ask", "lacks"), [
    (lambda: search_space("fake"), "it has no knobs; use mujoco or pymunk or exudyn"),
    (lambda: snippet("fake", {}, 100), "it has no snippet; use mujoco or pymunk or exudyn"),
    (lambda: spoiler("fake"), "it has no spoiler; use mujoco or pymunk"),
    (lambda: registry.capability("pymunk", "viewer"), "it has no viewer; use mujoco"),
    (lambda: snippet("bullet", {}, 100), "'bullet': unknown; there are mujoco, pymunk, exudyn"),
])  # fmt: skip
def test_a_capability_that_is_lacking_is_named_with_who_has_it(
    ask: Callable[[], object], lacks: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(registry.ENGINES, "fake", "tests.worlds.fake")
    assert engine("fake").version() == "1.0"
    with pytest.raises(EngineError, match=lacks):
        ask()


def test_what_nobody_has_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
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
        f"from sim.registry import Declaration\nDECLARATION = Declaration({needs!r}, {needs!r})\n"
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
    words = (
        "brkn can not be imported here: RuntimeError: no screen; look at BRKN_GL=foo, or install"
    )
    with pytest.raises(EngineError, match=words):
        engine("broken")
    (entry,) = registry.available()
    assert entry.version is None
    assert words in entry.broken


@pytest.mark.parametrize("name", registry.ENGINES)
def test_what_is_declared_is_there(name: str) -> None:
    for what in registry.declaration(name).offers:
        assert registry.capability(name, what)


def test_a_snippet_is_made_where_the_engine_is_not_installed() -> None:
    code = (
        "import sys; sys.modules.update(mujoco=None, pymunk=None, exudyn=None)\n"
        "from sim.registry.offers import snippet\n"
        "for name in ('mujoco', 'pymunk', 'exudyn'): print(snippet(name, {}, 90))"
    )
    printed = subprocess.check_output([sys.executable, "-c", code], cwd=ROOT, text=True)
    for part in ("<option timestep=", "space.step(dt)", "stepping.numberOfSteps"):
        assert part in printed
