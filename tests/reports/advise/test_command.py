"""`crankcheck advise` from the command line: its promises held by other runs, and mistakes."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest
from typer.testing import Result

from models.files.reading import find_scene, load_scene, read_text
from models.scene import Scene
from reports.advise.demand import at_speed
from reports.compare.compare import Truth, places
from reports.judge.cell import Cell
from reports.quantities import named
from sim.run import run
from tests.worlds.bare import BARE
from tests.worlds.command_line import crank, flat, refused
from tests.worlds.in_process import in_this_process

DT_S, SPEED, TURNS, TARGET = 0.0166667, 10.0, 2.0, 1e-3
Told = tuple[Result, Mapping[str, Any]]
LINE = ["--dt", DT_S, "--speed", SPEED, "--target", TARGET]


@pytest.fixture(scope="module", autouse=True)
def quick() -> Any:
    """All is run in this process, and its times are made up."""
    with in_this_process() as patch:
        patch.setattr("reports.advise.advice.timed_in_turns", timed)
        yield


def timed(_: object, cells: Sequence[tuple[Cell, float]], rounds: int, done: Any) -> list[object]:
    """In place of a clock: pymunk's steps take a microsecond, those of others three."""
    each = [1.0 if cell.engine == "pymunk" else 3.0 for cell, _ in cells]
    for _ in range(rounds * len(cells)):
        done()
    return [((us, us), (us, 1.01 * us)) for us in each]


@pytest.fixture(scope="module")
def told(tmp_path_factory: pytest.TempPathFactory) -> Told:
    """What is printed and written for the usual scenes."""
    path = tmp_path_factory.mktemp("advice") / "advice.json"
    result = crank("advise", *LINE, "--turns", TURNS, "--json", path, "--jobs", "1")
    return result, json.loads(path.read_text())


def place_error(scene: Scene, one: Mapping[str, Any], dt_s: float, turns: float = TURNS) -> float:
    """The error of place of a run as a user of the parts would make it."""
    truth, steps = Truth(scene, bound=False), int(turns * scene.driver.law.period_s / dt_s)
    options = {"dt_s": dt_s, "steps": steps, "settings": one["settings"]}
    done = run(scene, truth.start, one["engine"], one["profile"], **options)
    assert done.status == "ok", done.reason
    errors = [each for each in places(truth.beside(done)) if each.quantity in named("place")]
    return max(each.pure for each in errors)


def promises(content: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    return [one for one in content["settings"] if one["promise"]]


def best(content: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    names = content["best"]
    return [one for one in content["settings"] if f"{one['engine']} {one['name']}" in names]


def test_its_promises_are_printed_and_held_by_runs_of_both_engines(told: Told) -> None:
    result, content = told
    assert result.exit_code == 0, result.output
    scenes = [at_speed(load_scene(name), SPEED) for name in content["asked"]["scenes"]]
    kept = promises(content)
    assert {one["engine"] for one in best(content)} == {"mujoco", "pymunk"}
    assert len(kept) >= 6
    for one in kept:
        n, promised = one["promise"]["substeps"], one["promise"]["place_error"]
        found = max(place_error(scene, one, DT_S / n) for scene in scenes)
        assert found <= TARGET
        assert found == pytest.approx(promised, rel=1e-3)  # the last part of a turn is cut off
        if n > 1:  # and no fewer would do
            assert max(place_error(scene, one, DT_S / (n - 1)) for scene in scenes) > TARGET
    for one in best(content):  # for long, and at finer steps
        n = one["promise"]["substeps"]
        for scene in scenes:
            assert place_error(scene, one, DT_S / n, 3 * TURNS) <= TARGET
            for finer in (n + 1, 2 * n):
                assert place_error(scene, one, DT_S / finer) <= TARGET
    text = flat(result.stdout)
    assert max(len(line.rstrip()) for line in result.stdout.splitlines()) <= 100
    for one in content["settings"]:
        assert f"{one['engine']} {one['name']}" in text
    for one in best(content):
        assert one["snippet"] in result.stdout
    assert "37.7 in a turn; error of place up to 0.001 over 2 turns" in text
    assert "takes your own" in text
    assert f"mujoco {content['provenance']['mujoco']}" in text


def test_a_pasted_snippet_keeps_the_promise(told: Told) -> None:
    """In a four-bar that knows nothing of crankcheck; pymunk's is run once a frame, and steps it
    all."""
    _, content = told
    for one in promises(content):
        n, per_turn = one["promise"]["substeps"], one["promise"]["steps_per_turn"]
        runs = per_turn / n if one["engine"] == "pymunk" else per_turn
        assert f"{n} step{'s' * (n > 1)} a frame" in flat(one["snippet"])
        assert repr(DT_S / n) in one["snippet"]
        found = BARE[one["engine"]](one["snippet"], round(runs), SPEED)
        assert found <= TARGET, one["snippet"]


def test_where_nothing_reaches_the_exit_code_is_1(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("reports.advise.demand.MOST_SUBSTEPS", 2)
    options = (*LINE[:-1], "1e-9", "--turns", "2")
    result = crank("advise", "fourbar-lecture-1", "--engine", "pymunk", *options)
    assert result.exit_code == 1, result.output
    assert "NOTHING REACHES 1e-09 with up to 2 sub-steps a frame: nearest is" in result.stdout
    assert "space.step" not in result.stdout


def test_a_study_is_read_where_it_covers_what_is_asked(store: Path, tmp_path: Path) -> None:
    """At 2 rad/s, not the 10 of the study; its scenes, as none are named."""
    path = tmp_path / "advice.json"
    options = ("--study", store, "--engine", "mujoco", "--json", path, "--turns", "2")
    result = crank("advise", *LINE, "--speed", "2", *options)
    assert result.exit_code == 0, result.output
    content = json.loads(path.read_text())
    assert content["asked"]["scenes"] == ["fourbar-lecture-1", "slotted-lever"]
    assert content["study"]["lines"] == 2
    found = {one["name"]: one for one in content["settings"]}
    assert found["tuned"]["promise"]["measured"] == "now"
    assert found["tuned"]["runs"] == 2
    assert found["as-shipped"]["at_frame"]["measured"] == "now"
    text = flat(result.stdout)
    assert "Run now: mujoco as-shipped: solref_timeconst_s in seconds, measured at" in text
    assert "read between the steps of the study in" in text


def test_scenes_that_no_engine_can_hold_are_bad_input(tmp_path: Path) -> None:
    text = read_text(find_scene("scotch-yoke")).replace("mass_kg = 0.1\n", "")
    path = tmp_path / "massless.toml"
    path.write_text(text.replace('"scotch-yoke"', '"massless"'))
    result = crank("advise", path, *LINE, "--engine", "mujoco")
    refused(result, "advise: mujoco ", "mass")
    assert result.stdout == ""
