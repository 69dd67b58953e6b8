"""What the functions of the face give: values that print themselves, and are drawn in notebooks."""

import dataclasses
import pickle
import re
import shlex
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import crankcheck
from models.files.reading import parse_scene
from reports.drawing.svg import svg
from reports.requests.arguments import in_python
from reports.requests.shown import Shown
from reports.store.manifest import read_manifest
from tests.reports.page.hostile import Outline
from tests.worlds.command_line import crank
from tests.worlds.in_process import Here, in_this_process
from tests.worlds.own_models import CROWDED, FACTS, SLIDER_CRANK, judged
from tests.worlds.tiers import slow

SCENE = "fourbar-lecture-1"


@pytest.fixture(scope="session")
def results(ran: crankcheck.Simulation) -> dict[str, Shown]:
    solution = crankcheck.solve(SCENE)
    return {
        "solution": solution,
        "simulation": ran,
        "comparison": crankcheck.compare(SCENE, ran),
        "cell": crankcheck.check(SCENE, profile="as-shipped", turns=1, converge=False),
        "log": crankcheck.judge(SCENE, solution, target=1e-9),
    }


KINDS = ["solution", "simulation", "comparison", "cell", "log"]


@pytest.mark.parametrize("kind", KINDS)
def test_a_notebook_gets_a_drawing_and_tables_without_scripts(
    results: dict[str, Shown], kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """rich prints into the notebook that it is run in, whatever file it was given."""
    one = results[kind]
    text, page = str(one), one._repr_html_()
    found = Outline(page)
    assert not found.open
    tags = {tag for tag, _ in found.elements}
    assert {"svg", "polygon", "table", "td"} <= tags
    assert not tags & {"script", "style", "link", "iframe", "img", "object"}
    attributes = {name for _, each in found.elements for name in each}
    assert not {name for name in attributes if name.startswith("on") or name in ("href", "src")}
    assert "http" not in page.replace("http://www.w3.org/2000/svg", "")
    # The colours of the notebook around it: none is set for text, and none behind it.
    assert "background:#" not in page
    assert "currentColor" in page
    monkeypatch.setattr("rich.console._is_jupyter", lambda: True)
    assert str(one) == text
    assert one._repr_html_() == page


@pytest.mark.parametrize("kind", KINDS)
def test_a_result_is_fixed_travels_and_has_a_frame(results: dict[str, Shown], kind: str) -> None:
    one = results[kind]
    assert repr(one) == str(one)
    again = pickle.loads(pickle.dumps(one))
    assert one == one
    assert again != one
    assert len({one, again}) == 2
    assert str(again).splitlines()[:4] == str(one).splitlines()[:4]
    with pytest.raises(dataclasses.FrozenInstanceError):
        one.errors = None
    frame = one.frame()
    assert len(frame) > 5
    assert frame.columns.is_unique
    assert list(frame.index) == list(range(len(frame)))


def without_time(text: str) -> str:
    """What is printed, but for spaces at the ends of lines, and when it was made."""
    return "\n".join(line.rstrip() for line in re.split(r",\s+made ", text)[0].rstrip().split("\n"))


PERIOD_S = crankcheck.load_scene("shaper").driver.law.period_s
COARSE = (SCENE, "pymunk", "as-shipped")
PAIRS: dict[str, Callable[[], Shown]] = {
    f"verify {SCENE} --engine pymunk --profile as-shipped --dt 5e-3 --tol angle=1e-3 "
    "--no-convergence --drive servo": lambda: crankcheck.check(
        *COARSE, dt_s=5e-3, drive="servo", tolerance={"angle": 1e-3}, converge=False
    ),
    "solve shaper": lambda: crankcheck.solve("shaper", PERIOD_S / 12 * np.arange(13)),
    "run shaper --engine pymunk --steps-per-turn 90 --turns 1 --every 2": lambda: crankcheck.run(
        "shaper", "pymunk", steps_per_turn=90, turns=1, every=2
    ),
}


@pytest.mark.parametrize("command", list(PAIRS))
def test_a_result_prints_what_the_command_prints(command: str) -> None:
    printed = crank(*command.split()).stdout
    printed = re.sub("^(All samples|Points, and more digits): -o .*\n", "", printed, flags=re.M)
    own, told = without_time(str(PAIRS[command]())), without_time(printed)
    assert own.split() == in_python(told).split()
    assert own == told or in_python(told) != told  # other words have other ends of lines


def test_what_is_said_names_arguments_and_no_options(ran: crankcheck.Simulation) -> None:
    log = {"time_s": [0.0, 0.1, 0.2], "rocker_rad": [1.0, 2.0, 3.0]}
    verdicts = {
        "tolerance": crankcheck.check(
            *COARSE, dt_s=5e-3, tolerance={"angle": 1e-6}, converge=False
        ),
        "target": crankcheck.judge(SCENE, ran, target={"angle": 1e-12}),
        "target of a log": crankcheck.judge(SCENE, log, target=1e-3),
    }
    for given, verdict in verdicts.items():
        limit = next(each for each in verdict.failures if each.rule == "CC103")
        assert f"({given.split()[0]})" in limit.text
        assert verdict.limits["angle"].origin == given.split()[0]
        assert not any("--" in each.text + each.cure for each in verdict.findings)
        assert not re.search(r"[ (]--", str(verdict))
    tried = "Tried at the same step: sweep --set pymunk.iterations=300 leaves 0.1 of its limit."
    assert in_python(tried).startswith("Tried at the same step: settings pymunk.iterations=300 ")


def test_a_run_that_an_engine_can_not_do_is_told_and_drawn() -> None:
    scene = crankcheck.load_scene("slider-crank-central")
    light = {k: replace(x, mass_kg=0.0, inertia_kg_m2=0.0) for k, x in scene.links.items()}
    sliders = {"C": replace(scene.sliders["C"], mass_kg=0.0)}
    done = crankcheck.run(replace(scene, sliders=sliders, links=light))
    assert done.status == "unsupported"
    assert done.motion is None
    assert done.frame().empty
    assert "ended unsupported: " in str(done)
    assert "svg" in done._repr_html_()


def test_a_scene_that_is_let_go_runs_free_and_is_not_driven() -> None:
    done = crankcheck.run("fourbar-swing", engine="pymunk", dt_s=0.01, duration_s=0.2)
    assert (done.steps, done.drive) == (20, "free")
    with pytest.raises(
        crankcheck.CrankcheckError, match="-swing is in free motion, without a drive"
    ):
        crankcheck.run("fourbar-swing", drive="servo")


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> crankcheck.Sweep:
    """One scene of a file that is gone, and a shipped one, in two settings each."""
    folder = tmp_path_factory.mktemp("swept") / "my study"
    shipped = crankcheck.load_scene(SCENE)
    driver = replace(shipped.driver, law=shipped.driver.law.turned(1.0))
    scenes = [replace(shipped, name="own", driver=driver), shipped]
    asked = {"engines": "mujoco", "steps_per_turn": 90, "turns": 1, "timing": False, "jobs": 1}
    asked["settings"] = {"mujoco.iterations": np.array([50, 100])}
    with in_this_process():
        return crankcheck.sweep(scenes, folder, keep_trajectories=True, **asked)


def test_a_sweep_has_a_frame_of_its_cells_and_keeps_its_scenes(swept: crankcheck.Sweep) -> None:
    frame = swept.frame()
    assert len(frame) == swept.cells == swept.done.ran == 4
    assert set(frame["scene"]) == {SCENE, "own"}
    assert swept.verdict == "within"
    assert str(swept).startswith("4 cells: 4 run now, 0 were there; 0 timed now\nstored in ")
    assert "4 cells" in swept._repr_html_()
    manifest = read_manifest(swept.folder)
    own = parse_scene(manifest.scenes["own"], "own")
    assert own.links == crankcheck.load_scene(SCENE).links
    words, asked = shlex.join(manifest.runs[0]["command"]).split(" --engine ")
    assert words.startswith("crankcheck sweep -o '")
    assert words.endswith(" --steps-per-turn 90 --turns 1")
    assert asked == "mujoco --set mujoco.iterations=50,100"


def test_kept_runs_are_logs_to_be_judged(swept: crankcheck.Sweep) -> None:
    frame = swept.frame()
    row = frame[frame["scene"] == SCENE].iloc[0]
    path = swept.folder / "trajectories" / f"{row['key']}.parquet"
    assert "C_gap_m" in pd.read_parquet(path).columns
    found = crankcheck.judge(SCENE, path, step_s=row["dt_s"])
    assert found.verdict == "within"
    worst = max(found.errors.worst(name).pure for name in ("angle", "position"))
    assert worst == pytest.approx(row["place_pure"], rel=1e-12)


def test_a_report_is_a_page_or_text(swept: crankcheck.Sweep, tmp_path: Path) -> None:
    page = crankcheck.report(swept, tmp_path / "page.html")
    assert page.read_text(encoding="utf-8").startswith("<!doctype html>")
    text = crankcheck.report(swept.folder, tmp_path / "text.md")
    assert text.read_text(encoding="utf-8").startswith("#")


@pytest.mark.parametrize("name", ["scenes", "engines", "profiles", "steps_per_turn"])
def test_an_empty_list_is_refused_and_not_taken_for_everything(name: str, tmp_path: Path) -> None:
    asked = {"scenes": SCENE, "limit_s": 1e-6, "folder": tmp_path / "out", "jobs": -1}
    with pytest.raises(crankcheck.CrankcheckError, match=f"{name}: found nothing in it"):
        crankcheck.sweep(**{**asked, name: []})
    assert not list(tmp_path.iterdir())


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("model") / "engine.xml"
    path.write_text(SLIDER_CRANK)
    return path


@pytest.fixture(scope="module")
def verdict(model: Path) -> crankcheck.ModelVerdict:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("reports.own_model.account.Isolated", Here)
        patch.setattr("reports.own_model.judged.Isolated", Here)
        return crankcheck.check_model(model, "motor", -10.0, turns=0.5, converge=False)


def test_a_verdict_of_a_model_is_lines_a_scene_and_tables(verdict: crankcheck.ModelVerdict) -> None:
    assert verdict.verdict == "out"
    assert "CC105" in {finding.rule for finding in verdict.failures}
    assert set(verdict.failures) <= set(verdict.findings)
    assert [line.cell.profile for line in verdict.lines][:2] == ["as-written", "contacts-off"]
    assert list(verdict.scene.links) == ["crank", "rod"]
    assert verdict.patch.startswith("--- engine.xml\n")
    assert verdict.facts["mujoco"] == verdict.own.version
    assert verdict == verdict
    assert pickle.loads(pickle.dumps(verdict)).patch == verdict.patch
    frame = verdict.frame()
    assert list(frame["profile"].unique()) == [line.cell.profile for line in verdict.lines]
    gaps = frame[(frame["quantity"] == "gap") & (frame["profile"] == "as-written")]
    assert set(gaps["body"]) == {joint.name for joint in verdict.joints()}
    assert str(verdict) == repr(verdict)
    assert "OUT OF TOLERANCE as written" in str(verdict)
    page = verdict._repr_html_()
    assert "<svg" in page
    assert "recommended" in page
    assert "<option" not in page


@slow("rare: a model that is driven at its rocker")
def test_a_linkage_that_goes_through_no_whole_turn_is_drawn_as_far_as_it_went() -> None:
    """Driven at its rocker, which swings."""
    one = judged(CROWDED, "ankle", turns=0.02, dt_s=1e-4)
    swung = crankcheck.ModelVerdict(account=one.account, lines=one.lines, facts=FACTS)
    assert "<svg" in swung._repr_html_()
    with pytest.raises(crankcheck.ReachError):
        svg(one.scene)
