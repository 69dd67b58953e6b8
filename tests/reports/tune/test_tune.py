"""The command as a whole, with real engines and small budgets."""

import io
import re
import signal
from dataclasses import replace
from pathlib import Path

import pytest
from rich.console import Console

from models.errors import CrankcheckError
from models.files.reading import shipped
from reports.requests.tune import TuneRequest
from reports.tune.attempt import Attempt, Bench
from reports.workers.signals import Stopped
from sim.engine import Settings
from sim.mujoco.knobs import EVALUATIONS
from sim.registry.offers import search_space
from tests.worlds.tiers import slow
from tests.worlds.workshop import mujoco_disturbance

SMALL = TuneRequest(("fourbar-lecture-1",), "mujoco", 1e-5, budget=6, seed=3, timing=False)


def told(request: TuneRequest) -> tuple[int, str]:
    """Exit code and output, but for the time of day."""
    output = io.StringIO()
    code = request.run(Console(file=output, width=100), Console(file=io.StringIO()))
    return code, "\n".join(line for line in output.getvalue().splitlines() if "made" not in line)


def line(text: str, label: str) -> list[str]:
    return next(row for row in text.splitlines() if row.startswith(label))[len(label) :].split()


@pytest.fixture(scope="module")
def whole() -> tuple[int, str]:
    return told(SMALL)


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("kept") / "kept.db"
    told(replace(SMALL, budget=1, output=path))
    return path


@slow("two seconds: test_search.py goes on with a search cut short")
def test_one_seed_gives_the_same_in_two_halves(path: Path, whole: tuple[int, str]) -> None:
    told(replace(SMALL, budget=4, output=path))
    assert told(replace(SMALL, output=path)) == whole


def test_what_is_found_reaches_the_target_no_dearer_than_tuned(whole: tuple[int, str]) -> None:
    code, text = whole
    assert code == 0
    tuned, found = line(text, "error of place")
    assert max(float(tuned), float(found)) <= 1e-5
    assert line(text, "solref_timeconst_steps")[0] == "5"
    pairs = zip(line(text, "integrator"), line(text, "steps per turn"), strict=True)
    cost = [EVALUATIONS[integrator] * int(steps) for integrator, steps in pairs]
    assert cost[1] <= cost[0]
    told_ratio = re.search(r"found over profile tuned: (\S+) by the model", text)
    assert float(told_ratio[1]) == pytest.approx(cost[1] / cost[0], abs=0.0051)
    assert f"{line(text, 'steps per turn')[1]} steps a turn" in text
    assert f'integrator="{line(text, "integrator")[1]}"' in text
    assert f' {line(text, "solref_dampratio")[1]}" solimp=' in text
    pasted = text[text.index("<!--") : text.rindex("-->") + 3]
    assert "makes contacts softer" in pasted  # and so a box does not lie where it lay
    assert mujoco_disturbance(pasted).moving < 1e-9


@slow("0.6 s: what is kept of another target is refused in test_search.py")
@pytest.mark.parametrize(
    ("name", "now", "words"),
    [
        ("crankcheck_version", lambda: "0.0", "crankcheck version 0.0"),
        ("version", lambda name: "0.0", "Optuna version 0.0"),
        ("search_space", lambda name: replace(search_space(name), starts=()), "starts"),
    ],
)
def test_a_file_of_other_versions_or_starts_is_refused(
    kept: Path, monkeypatch: pytest.MonkeyPatch, name: str, now: object, words: str
) -> None:
    monkeypatch.setattr(f"reports.requests.tune.{name}", now)
    with pytest.raises(CrankcheckError, match=f"requested was {words}"):
        told(replace(SMALL, output=kept))


def test_what_the_clock_ended_is_told_and_another_limit_refused(path: Path) -> None:
    request = replace(SMALL, budget=2, limit_s=1e-4, output=path)
    code, text = told(request)
    assert code == 1
    assert "The time limit ended 2 of the trials (--limit-s 0.0001)" in " ".join(text.split())
    with pytest.raises(CrankcheckError, match=r"with limit_s 0\.0001; requested was limit_s 20"):
        told(replace(request, limit_s=20.0))


def test_nothing_that_reaches_is_told_with_what_is_nearest(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("reports.tune.attempt.MOST_SEARCHED", 4000)
    code, text = told(replace(SMALL, engine="pymunk", target=1e-10, budget=1))
    assert code == 1
    assert "NOTHING REACHES 1e-10: nearest is" in text
    assert "steps per turn; take a larger target" in " ".join(text.split())
    assert "OVER" in text
    assert "space.iterations" not in text


def test_several_scenes_are_tuned_together_and_measured_cost_is_told() -> None:
    scenes = ("fourbar-lecture-1", "slider-crank-excel-210")
    code, text = told(replace(SMALL, scenes=scenes, target=1e-4, budget=2, timing=True))
    assert code == 0
    assert text.startswith("fourbar-lecture-1, slider-crank-excel-210, mujoco: error of place")
    assert line(text, "worst in")[0] == "slider-crank-excel-210"
    assert line(text, "us per step")[-2:] == ["3.00", "7.00"]
    assert "ms per turn" in text
    assert "cost of a turn, found over profile tuned: " in text
    assert "A/A noise" in text


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"target": 0.0}, "--target 0: give an error of place from 1e-11"),
        ({"budget": 0}, "--budget 0: give a number of trials"),
        ({"seed": -1}, "--seed -1: give a whole number"),
        ({"turns": 1e9}, r"--turns 1e\+09: .* take 12500 turns or less"),
        ({"scenes": ()}, "name a scene"),
        ({"output": Path("nowhere/kept.db")}, "there is no folder"),
        ({"target": 1e-4}, "holds a search with target 1e-05; requested was target 0.0001"),
        ({"engine": "pymunk"}, "with engine mujoco; requested was engine pymunk"),
        ({"scenes": ("whitworth",)}, r'with scene \["fourbar-lecture-1"\]; requested was'),
    ],
)
def test_bad_requests_and_the_file_of_another_search_are_refused_before_anything_runs(
    kept: Path, change: dict[str, object], words: str
) -> None:
    with pytest.raises(CrankcheckError, match=words):
        told(replace(SMALL, **{"output": kept, **change}))  # type: ignore[arg-type]


def test_a_run_through_a_singular_position_is_refused(tmp_path: Path) -> None:
    text = shipped()["fourbar-lecture-1"].read_text(encoding="utf-8")
    text = re.sub(r"length_m = 0\.\d+", "length_m = 0.3", text)
    nearly = tmp_path / "nearly.toml"  # a rhombus, but for 1e-13 m
    nearly.write_text(text.replace("0.3 }", "0.2999999999999 }", 1), encoding="utf-8")
    with pytest.raises(CrankcheckError, match="driver 360 deg"):
        told(replace(SMALL, scenes=(str(nearly),)))


def test_a_stopped_search_says_what_it_keeps_and_optuna_nothing(
    path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    progress, real, calls = io.StringIO(), Bench.attempt, []

    def attempt(bench: Bench, settings: Settings, best: Attempt | None) -> Attempt:
        calls.append(settings)
        if len(calls) == 3:
            raise Stopped(signal.SIGINT)
        return real(bench, settings, best)

    monkeypatch.setattr(Bench, "attempt", attempt)
    with pytest.raises(Stopped):
        replace(SMALL, output=path).run(Console(quiet=True), Console(file=progress))
    wanted = f"2 of 6 trials are kept in {path}; the same command continues from there\n"
    assert progress.getvalue() == wanted
    assert capsys.readouterr() == ("", "")
    assert sorted(each.name for each in path.parent.iterdir()) == [".kept.db.lock", "kept.db"]
