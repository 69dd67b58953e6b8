"""What the functions of the face give: values that print themselves, and are drawn in notebooks."""

from __future__ import annotations

import dataclasses
import math
import pickle
import re
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import crankcheck
from models.errors import CrankcheckError
from models.files import shipped
from reports.cli import app
from reports.face.shown import Shown
from reports.face.told import in_python

SCENE = "fourbar-lecture-1"


@pytest.fixture(scope="session")
def results(ran: crankcheck.Simulation) -> dict[str, Shown]:
    """One of each kind."""
    solution = crankcheck.solve(SCENE)
    return {
        "solution": solution,
        "simulation": ran,
        "comparison": crankcheck.compare(SCENE, ran),
        "cell": crankcheck.check(SCENE, profile="as-shipped", turns=1, converge=False),
        "log": crankcheck.judge(SCENE, solution, target=1e-9),
    }


KINDS = ["solution", "simulation", "comparison", "cell", "log"]


class Elements(HTMLParser):
    """The elements and attributes of a page, all of which are closed."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: set[str] = set()
        self.attributes: set[str] = set()
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.add(tag)
        self.attributes |= {name for name, _ in attrs}
        if tag != "br":
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.add(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


@pytest.mark.parametrize("kind", KINDS)
def test_a_notebook_gets_a_drawing_and_tables_without_scripts(
    results: dict[str, Shown], kind: str
) -> None:
    page = results[kind]._repr_html_()
    found = Elements(page)
    assert not found.open
    assert {"svg", "polygon", "table", "td"} <= found.tags
    assert not found.tags & {"script", "style", "link", "iframe", "img", "object"}
    assert not {name for name in found.attributes if name.startswith("on")} | (
        found.attributes & {"href", "src", "class"} - {"class"}
    )
    assert "http" not in page.replace("http://www.w3.org/2000/svg", "")
    # The colours of the notebook around it: none is set for text, and none behind it.
    assert "background:#" not in page
    assert "currentColor" in page


@pytest.mark.parametrize("kind", KINDS)
def test_text_in_a_notebook_is_the_text_and_is_not_shown_there_by_itself(
    results: dict[str, Shown], kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """rich prints into the notebook that it is run in, whatever file it was given."""
    one = results[kind]
    text, page = str(one), one._repr_html_()
    monkeypatch.setattr("rich.console._is_jupyter", lambda: True)
    assert str(one) == text
    assert one._repr_html_() == page


@pytest.mark.parametrize("kind", KINDS)
def test_a_result_is_itself_alone_cannot_be_changed_and_travels(
    results: dict[str, Shown], kind: str
) -> None:
    one = results[kind]
    assert repr(one) == str(one)
    again = pickle.loads(pickle.dumps(one))
    assert one == one
    assert again != one
    assert len({one, again}) == 2
    assert str(again).splitlines()[:4] == str(one).splitlines()[:4]
    with pytest.raises(dataclasses.FrozenInstanceError):
        one.errors = None  # type: ignore[attr-defined]


@pytest.mark.parametrize("kind", KINDS)
def test_frames_are_tidy(results: dict[str, Shown], kind: str) -> None:
    frame = results[kind].frame()  # type: ignore[attr-defined]
    assert len(frame) > 5
    assert frame.columns.is_unique
    assert list(frame.index) == list(range(len(frame)))


def without_time(text: str) -> str:
    """What is printed, but for spaces at the ends of lines, and when it was made."""
    return "\n".join(line.rstrip() for line in re.split(r",\s+made ", text)[0].rstrip().split("\n"))


def period(samples: int) -> np.ndarray:
    """Instants of a period of the shaper's driver."""
    period_s = crankcheck.load_scene("shaper").driver.law.period_s
    return period_s / (samples - 1) * np.arange(samples)


PAIRS: dict[str, Callable[[], Shown]] = {
    f"verify {SCENE} --engine mujoco --profile tuned --turns 1": lambda: crankcheck.check(
        SCENE, turns=1
    ),
    f"verify {SCENE} --engine pymunk --profile as-shipped --dt 5e-3 --tol angle=1e-3 "
    "--no-convergence --drive servo": lambda: crankcheck.check(
        SCENE,
        "pymunk",
        "as-shipped",
        dt_s=5e-3,
        drive="servo",
        tolerance={"angle": 1e-3},
        converge=False,
    ),
    "solve shaper": lambda: crankcheck.solve("shaper", period(13)),
    "solve fourbar-lecture-1 --at-deg 90": lambda: crankcheck.solve_driven(
        SCENE, math.pi / 2, 10.0, 0.0
    ),
    "run shaper --engine pymunk --steps-per-turn 90 --turns 1 --every 2": lambda: crankcheck.run(
        "shaper", "pymunk", steps_per_turn=90, turns=1, every=2
    ),
}


@pytest.mark.parametrize("command", list(PAIRS))
def test_a_result_prints_what_the_command_prints(command: str) -> None:
    printed = CliRunner().invoke(app, command.split(), catch_exceptions=False).stdout
    printed = re.sub("^(All samples|Points, and more digits): -o .*\n", "", printed, flags=re.M)
    own, told = without_time(str(PAIRS[command]())), without_time(printed)
    if in_python(told) == told:
        assert own == told
    else:  # other words, and so other ends of lines
        assert own.split() == in_python(told).split()


def test_what_is_said_names_arguments_and_no_options(
    ran: crankcheck.Simulation,
) -> None:
    log = {"time_s": [0.0, 0.1, 0.2], "rocker_rad": [1.0, 2.0, 3.0]}
    verdicts: dict[str, crankcheck.CellVerdict | crankcheck.LogVerdict] = {
        "tolerance": crankcheck.check(
            SCENE, "pymunk", "as-shipped", dt_s=5e-3, tolerance={"angle": 1e-6}, converge=False
        ),
        "target": crankcheck.judge(SCENE, ran, target={"angle": 1e-12}),
        "target of a log": crankcheck.judge(SCENE, log, target=1e-3),
    }
    for given, verdict in verdicts.items():
        limit = next(each for each in verdict.failures if each.rule == "CC103")
        assert f"({given.split()[0]})" in limit.text
        assert verdict.limits["angle"].origin == given.split()[0]
        assert not any("--" in each.text + each.cure for each in verdict.findings)
        assert " --" not in str(verdict)
        assert "(--" not in str(verdict)
    tried = "Tried at the same step: sweep --set pymunk.iterations=300 leaves 0.1 of its limit."
    assert in_python(tried).startswith("Tried at the same step: settings pymunk.iterations=300 ")


def test_judge_prints_what_the_command_prints(ran: crankcheck.Simulation, tmp_path: Path) -> None:
    log = tmp_path / "log.csv"
    ran.frame().to_csv(log, index=False)
    command = ["judge", SCENE, str(log), "--step", repr(ran.dt_s)]
    printed = CliRunner().invoke(app, command, catch_exceptions=False).stdout
    assert without_time(str(crankcheck.judge(SCENE, log, step_s=ran.dt_s))) == without_time(printed)


def test_a_solution_is_a_motion_of_the_times_asked_for() -> None:
    solution = crankcheck.solve(SCENE, [0.2, 0.1])
    assert isinstance(solution, crankcheck.Motion)
    assert solution.time_s.tolist() == [0.2, 0.1]
    assert crankcheck.solve(SCENE).time_s.size == 361
    assert solution.scene is crankcheck.solve(SCENE).scene
    one = crankcheck.solve_driven(SCENE, np.float64(0.5), 1, 0)
    assert one.state().theta["crank"] == pytest.approx(0.5)
    assert "theta" in str(one)
    parts = crankcheck.solve(SCENE, [0.0, 0.1], links="rocker", points=(), sliders=())
    assert "rocker" in str(parts)
    assert "mobility 1" in str(crankcheck.solve(SCENE, 0.0, links=(), points="C"))


def test_arrays_are_the_callers_own() -> None:
    """Nothing that is worked out later looks at them, and they are not those that were given."""
    time_s = np.array([0.1, 0.2])
    first = crankcheck.solve(SCENE, time_s)
    kept = first.links["rocker"].theta.copy()
    first.links["rocker"].theta[:] = first.points["C"].position[:] = first.time_s[:] = 0.0
    assert time_s.tolist() == [0.1, 0.2]
    assert crankcheck.solve(SCENE, time_s).links["rocker"].theta.tolist() == kept.tolist()
    log = {"time_s": time_s, "rocker_rad": kept}
    assert crankcheck.judge(SCENE, log, target=1e-12).verdict == "within"


def test_names_from_files_are_no_html(tmp_path: Path) -> None:
    path = tmp_path / "own.toml"
    text = shipped()[SCENE]
    lines = text.read_text(encoding="utf-8").splitlines()
    lines = ['source = "<b onclick=alert(1)>[red]x[/red]</b>"' if line.startswith("source")
             else line for line in lines]  # fmt: skip
    path.write_text("\n".join(lines), encoding="utf-8")
    solution = crankcheck.solve(path, [0.0, 0.1])
    assert "<b onclick" not in solution._repr_html_()
    assert "<b onclick=alert(1)>[red]x[/red]</b>" in str(solution).replace("\n", "")


def test_a_run_that_an_engine_can_not_do_is_told_and_drawn() -> None:
    from dataclasses import replace

    scene = crankcheck.load_scene("slider-crank-central")
    slider = replace(scene.sliders["C"], mass_kg=0.0)
    links = {name: replace(link, mass_kg=0.0, inertia_kg_m2=0.0)
             for name, link in scene.links.items()}  # fmt: skip
    bare = replace(scene, sliders={"C": slider}, links=links)
    done = crankcheck.run(bare)
    assert done.status == "unsupported"
    assert done.motion is None
    assert done.frame().empty
    assert "ended unsupported: " in str(done)
    assert "svg" in done._repr_html_()


def test_a_scene_that_is_let_go_runs_free_and_is_not_driven() -> None:
    done = crankcheck.run("fourbar-swing", engine="pymunk", dt_s=0.01, duration_s=0.2)
    assert done.steps == 20
    assert done.drive == "free"
    with pytest.raises(CrankcheckError, match="fourbar-swing is let go, and nothing drives it"):
        crankcheck.run("fourbar-swing", engine="pymunk", dt_s=0.01, drive="servo")
    with pytest.raises(CrankcheckError, match="turns: fourbar-swing is let go, and has no turns"):
        crankcheck.run("fourbar-swing", turns=0.02)
    with pytest.raises(CrankcheckError, match="duration_s: it is of runs that are let go"):
        crankcheck.run("shaper", duration_s=0.2)
