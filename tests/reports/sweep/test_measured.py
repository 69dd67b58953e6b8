"""A cell of a sweep: an engine that crashes, hangs or fills memory costs its own alone; and cells
are timed in turns, in repeats that are long enough, from where each of them starts."""

from collections.abc import Callable
from io import StringIO
from pathlib import Path
from types import SimpleNamespace
from typing import Any, TypeVar

import numpy as np
import pytest
from rich.console import Console

from analytic.kinematics import solve
from models.files.reading import load_scene
from models.scene import Scene
from reports.compare.free_truth import released_state
from reports.judge.cell import Cell
from reports.requests.sweep import SweepRequest
from reports.store.reader import read_store
from reports.sweep import measured
from reports.ways.elastic import ElasticWay
from reports.workers.isolated import Isolated, Limits, Lost
from sim import registry
from tests.worlds.command import shadows
from tests.worlds.in_process import Here

BAD_ENGINE = '''
"""MuJoCo, with a fault that a setting chooses."""
import os, time
from dataclasses import replace
from sim.engine import Profile, Setting
from sim.mujoco import engine as mujoco

def opened(scene, state, settings, dt_s, drive):
    fault = settings["fault"]
    if fault == "abort":
        os.abort()
    elif fault == "hang":
        time.sleep(1000)
    elif fault == "throw":
        raise RuntimeError("no luck")
    held = {name: value for name, value in settings.items() if name != "fault"}
    return mujoco.ENGINE.open(scene, state, held, dt_s, drive)

ENGINE = replace(
    mujoco.ENGINE,
    name="bad",
    profiles={
        name: Profile(name, "bad", "", dict(profile.settings) | {"fault": Setting("none", "")})
        for name, profile in mujoco.ENGINE.profiles.items()
    },
    open=opened,
)
'''
DECLARATION = """
from sim.registry import Declaration
DECLARATION = Declaration("mujoco", extra=False)
"""
KNOWN = "from sim import registry\nregistry.ENGINES['bad'] = 'bad_engine'\n"
EXPECTED = {
    "none": ("ok", ""),
    "abort": ("crashed", "the engine ended its process (signal SIGABRT)"),
    "hang": ("timeout", "no end within 1 s"),
    "throw": ("crashed", "RuntimeError: no luck"),
}
Answer = TypeVar("Answer")


@pytest.fixture
def _bad_engine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An engine `bad` is known here, and in the children of this process."""
    folder = tmp_path / "bad"
    (folder / "bad_engine").mkdir(parents=True)
    (folder / "bad_engine" / "__init__.py").write_text(DECLARATION)
    (folder / "bad_engine" / "engine.py").write_text(BAD_ENGINE)
    (folder / "sitecustomize.py").write_text(KNOWN)
    monkeypatch.setenv("PYTHONPATH", str(folder))
    monkeypatch.syspath_prepend(folder)
    monkeypatch.setitem(registry.ENGINES, "bad", "bad_engine")


def swept(folder: Path, *faults: str, engine: str = "bad", **more: Any) -> str:
    """The output of a sweep of an engine, the bad one over some faults, with one child."""
    output = StringIO()
    named = {"engines": [engine], "settings": [f"bad.fault={','.join(faults)}"] * bool(faults)}
    usual = {"profiles": ["tuned"], "steps_per_turn": "90", "jobs": 1, "timing": False}
    more = {"limit_s": 600.0, **usual, **more}
    request = SweepRequest(folder, ["fourbar-lecture-1"], **named, **more)
    assert request.run(Console(file=output, width=100), Console(file=StringIO())) == 0
    return output.getvalue()


@pytest.mark.usefixtures("_bad_engine")
def test_each_fault_is_a_row_with_a_reason(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "store"
    monkeypatch.setattr("reports.sweep.running.Isolated", Here)  # of timing
    monkeypatch.setattr("reports.sweep.measured.REPEAT_S", 1e-3)
    swept(folder, *(fault for fault in EXPECTED if fault != "hang"), timing=True)
    told = swept(folder, "hang", limit_s=1.0)  # where no other cell has to be done in that time
    cells = read_store(folder).cells
    assert len(cells) == len(EXPECTED)
    cells["fault"] = cells.variant.str.removeprefix("tuned, fault=")
    rows = zip(cells.fault, cells.status, cells.reason, strict=True)
    assert {fault: (status, reason) for fault, status, reason in rows} == EXPECTED
    assert {*cells.fault[cells.us_per_step.notna()]} == {"none"}
    assert "1 timeout, such as" in told


def test_no_file_of_the_folder_is_imported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mine = shadows(tmp_path / "mine")
    (mine / "queue.py").write_text("raise SystemExit('mine')")
    monkeypatch.chdir(mine)
    swept(Path("store"), engine="pymunk")
    assert set(read_store(mine / "store").cells.status) == {"ok"}


class Watched(Isolated[Answer]):
    """Works in this process, where a slow engine takes five seconds of no clock."""

    def call(self, function: Callable[..., Answer], *arguments: object) -> Answer | Lost:
        cell = arguments[0]
        assert isinstance(cell, Cell)
        if cell.settings["fault"] == "slow" and self.limits.time_s < 5.0:
            return Lost("timeout", f"no end within {self.limits.time_s:g} s")
        return function(*arguments)


@pytest.mark.usefixtures("_bad_engine")
def test_a_wider_limit_runs_what_was_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("reports.workers.isolated.Isolated", Watched)
    folder = tmp_path / "store"

    def ran(limit_s: float, *faults: str, again: bool = False) -> str:
        faults = faults or ("none", "slow")
        return swept(folder, *faults, limit_s=limit_s, again=again).splitlines()[0]

    assert ran(3.0).startswith("2 cells: 2 run now, 0 were there")
    assert {*read_store(folder).cells.status} == {"ok", "timeout"}
    for limit_s in (3.0, 2.0):
        assert ran(limit_s).startswith("2 cells: 0 run now, 2 were there")
    assert ran(2.0, again=True).startswith("2 cells: 1 run now, 1 were there")
    ran(600.0, "none")  # a wider limit, and the cell that was ended is not asked for
    assert len(read_store(folder).cells) == 2
    assert ran(300.0).startswith("2 cells: 1 run now, 1 were there")
    assert list(read_store(folder).cells.status) == ["ok", "ok"]


def cell(name: str = "fourbar-lecture-1", **more: Any) -> Cell:
    return Cell(load_scene(name), "pymunk", "tuned", 0.002, 100, **more)


def test_cells_take_turns_and_one_that_is_lost_is_timed_no_more() -> None:
    cells = [(cell("whitworth"), 3.0), (cell("shaper"), 5.0)]
    answers = iter([(1.0, 2.0), (7.0,), (3.0,), Lost("crashed", ""), (4.0,), (5.0, 6.0)])
    asked: list[object] = []
    done: list[int] = []

    class Child(Here[Any]):
        def call(self, function: Callable[..., object], *arguments: object) -> object:
            asked.append((function, *arguments))
            return next(answers)

    found = measured.timed_in_turns(Child(Limits()), cells, 4, lambda: done.append(len(asked)))
    assert found == [((1.0, 2.0, 4.0), (3.0, 5.0, 6.0)), None]
    first, second = ((measured.timed, *each) for each in cells)
    assert asked == [first, second, first, second, first, first]
    assert done == [1, 2, 3, 4, 5, 5, 6, 6]


@pytest.mark.parametrize(
    ("guess_us", "steps"), [(50.0, 300), (1e-9, 50_000), (0.2, 50_000), (1.0, 15_000), (1e6, 200)]
)
def test_a_repeat_takes_15_ms(guess_us: float, steps: int, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[object, ...]] = []

    def time_run(*arguments: object, **options: object) -> SimpleNamespace:
        asked.append((arguments, options))
        return SimpleNamespace(walls_s=(3e-3, 6e-3))

    monkeypatch.setattr(measured, "time_run", time_run)
    one = cell(settings={"iterations": 7})
    assert measured.timed(one, guess_us) == pytest.approx((3e3 / steps, 6e3 / steps))
    (((scene, _, *engine), options),) = asked
    assert (scene, engine) == (one.given, ["pymunk", "tuned"])
    wanted = {"dt_s": 0.002, "steps": steps, "repeats": 2, "drive": one.drive}
    assert options == {**wanted, "settings": {"iterations": 7}}


def test_a_cell_is_timed_from_its_own_start(monkeypatch: pytest.MonkeyPatch) -> None:
    states: list[object] = []

    def time_run(scene: Scene, state: object, *_: object, **__: object) -> SimpleNamespace:
        states.append(state)
        return SimpleNamespace(walls_s=())

    monkeypatch.setattr(measured, "time_run", time_run)
    truth = SimpleNamespace(start="that of the reference")
    monkeypatch.setattr(ElasticWay, "truth", lambda way, run: truth)
    driven, free = cell("shaper"), cell("fourbar-swing", drive="free")
    for one in (driven, free, cell("fourbar-elastic")):
        assert measured.timed(one, 50.0) == ()
    starts = [solve(driven.scene, np.zeros(1)).state(), released_state(free.scene), truth.start]
    assert repr(states) == repr(starts)
