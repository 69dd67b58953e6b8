"""Cases of elastic links: run when asked for, and graded by what the links bend."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from reports.stability.catalogue import CATALOGUE
from reports.stability.grading import graded
from reports.stability.matrix import Graded
from tests.worlds.command_line import crank, crank_alone, flat, refused

ELASTIC = [name for name, case in CATALOGUE.items() if case.elastic]


def run_of(name: str, value: float, engine: str = "mujoco") -> Graded:
    return graded(CATALOGUE[name], engine, "tuned", value, draw=False)[0]


def trials() -> Iterator[tuple[str, Any]]:
    for name in ELASTIC:
        for value in CATALOGUE[name].values:
            yield name, CATALOGUE[name].trial(value)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["coarse-step", "--elastic"], "no elastic link in it; those are elastic-thick"),
        (["--free", "--elastic"], "no case is of both"),
    ],
)
def test_what_is_not_elastic_is_refused(words: list[str], says: str) -> None:
    refused(crank("stability", *words), says)


def test_every_case_gives_segments_and_few_samples() -> None:
    for name, trial in trials():
        assert len(trial.given.links) == len(trial.scene.links) + trial.segments - 1, name
        assert trial.steps / trial.every <= 4000, name


def test_an_error_falls_with_the_step_squared() -> None:
    coarse, fine = (run_of("elastic-step", steps, "pymunk").error for steps in (720.0, 1440.0))
    assert coarse / fine == pytest.approx(4.0, rel=0.2)


def test_a_stiffness_that_the_step_does_not_hold_says_which_would() -> None:
    run = run_of("elastic-stiff", 100.0)
    assert run.outcome == "diverged"
    assert "steps a turn, or fewer segments" in run.reason
    assert run_of("elastic-stiff", 9.0).outcome == "ok"


def test_one_value_is_shown_from_the_command_line() -> None:
    words = ["stability", "elastic-step", "--at", "360", "--profile", "tuned"]
    done, held = (crank_alone(*words, "--engine", engine) for engine in ("pymunk", "mujoco"))
    assert done.exit_code == 1
    told = flat(done.output)
    assert "a deflection, over the largest, is off by 0.029" in told
    assert "error of the deflection, over the largest: 0.0" in told
    assert held.exit_code == 0, held.output


def test_what_fails_is_drawn_with_its_nodes() -> None:
    case = CATALOGUE["elastic-step"]
    _, drawn = graded(case, "pymunk", "tuned", 360.0, draw=True)
    assert {"coupler-1-2", "coupler-2-3", "coupler-3-4"} <= {*drawn.drawing["points"]}  # type: ignore[misc]


def test_the_page_says_what_errors_are_of(tmp_path: Path) -> None:
    words = ["stability", "elastic-step", "--engine", "mujoco", "--profile", "as-shipped"]
    done = crank_alone(*words, "-o", tmp_path, "--jobs", 1)
    assert "Numbers: the worst error of the deflection, over the largest;" in done.stdout
    page = (tmp_path / "stability.html").read_text(encoding="utf-8")
    assert "Worst error of the deflection, over the largest:" in page
