"""`sensitivity --engine`: derivatives of engines beside those of the reference."""

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from models.errors import EngineError
from models.files.reading import load_scene
from reports.lectures.machine import engine_gradients
from reports.lectures.machine.engine_gradients import EngineGradient, Question
from sim.engine import Settings
from sim.engine.gradient import PoseGradient, Variation, changes, slope, steadiest
from sim.registry import capability
from tests.worlds.command_line import crank_alone
from tests.worlds.engines import HERE
from tests.worlds.tiers import slow

FOURBAR = load_scene("fourbar-lecture-1")
NAMES = ("crank", "coupler", "driver.angle")
QUESTION = Question(FOURBAR, NAMES, (1, 30), FOURBAR.driver.law.period_s / 360.0, "rocker")
COMPILES = "they compile for minutes, and are not installed by `make test`"
LIMITS = (("mjx", "tuned", 1e-4), ("newton", "tuned", 1e-5), ("newton", "as-shipped", 1e-3))
LINE = ("sensitivity", "fourbar-lecture-1", "--engine", "mujoco", "--by", "crank", "--by",
        "driver.angle", "--steps", "1,5", "--steps-per-turn", "180")  # fmt: skip


def compared(name: str, profile: str, question: Question = QUESTION) -> list[EngineGradient]:
    return list(engine_gradients.engine_gradients(question, name, profile))


@pytest.fixture(scope="module")
def shipped() -> list[EngineGradient]:
    """MuJoCo as shipped: by its transition matrices, and by differences of its runs."""
    return compared("mujoco", "as-shipped")


def test_transition_matrices_are_the_differences_of_runs_by_the_start(
    shipped: list[EngineGradient],
) -> None:
    by_matrices, by_runs = shipped
    assert (by_matrices.method, by_runs.method) == ("mjd_transitionFD", "differences of runs")
    assert by_matrices.slopes is not None
    assert by_runs.slopes is not None
    assert np.isnan(by_matrices.slopes[:, :2]).all()
    assert by_matrices.slopes[:, 2] == pytest.approx(by_runs.slopes[:, 2], abs=1e-6)
    assert 1e-6 < by_matrices.error(1) < 1e-3
    assert math.isnan(by_matrices.angle(0))  # of one number each


def test_the_error_of_a_soft_loop_grows_with_the_steps(shipped: list[EngineGradient]) -> None:
    soft, stiff = shipped[1], compared("mujoco", "tuned")[1]
    assert soft.error(1) > 30.0 * soft.error(0)
    assert soft.error(1) > 100.0 * stiff.error(1)
    assert soft.within
    assert stiff.angle(1) < 1e-5


def test_no_place_depends_on_a_mass() -> None:
    question = replace(QUESTION, names=("crank", "rocker.mass"))
    found = compared("mujoco", "tuned", question)[-1]
    assert not question.truth[:, 1].any()
    assert found.slopes is not None
    assert np.abs(found.slopes[:, 1]).max() < 1e-6


def told(
    slopes: Sequence[float], turn: float = 0.0, opening: float = 0.0, elsewhere: float = 0.0
) -> EngineGradient:
    """A comparison of an engine with shares of the reference's derivatives, with the gradient of
    the rocker turned in the plane of the first two, a pin open, or links elsewhere."""
    own = QUESTION.truth * np.array(slopes)[:, None]
    n = QUESTION.followed[0]
    c, s = math.cos(turn), math.sin(turn)
    own[..., n] = own[..., n] @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    gaps, astray = {"C": np.array([0.0, opening * FOURBAR.longest_m])}, np.array([0.0, elsewhere])
    return EngineGradient(QUESTION, "fake", "1.0", "tuned", "tape", "", own, gaps, astray)


def test_findings_come_from_the_numbers() -> None:
    assert told((1.0, 1.0, 1.0)).within
    assert told((1.0, 1.0, 1.0)).findings(1) == []
    zero = told((0.0, 1.0, 0.0))
    assert zero.findings(1) == ["zero by crank, driver.angle"]
    assert not zero.within
    assert told((1.0, 1.0, 1.0), opening=0.25).findings(1) == [
        "loop open: 0.25 of the longest link at C"
    ]
    assert told((1.0, 1.0, 1.0), elsewhere=0.5).findings(1) == ["links elsewhere, by up to 0.5 rad"]
    assert math.isnan(told((0.0, 0.0, 0.0)).angle(1))
    assert told((math.nan,) * 3).within is False


def test_the_angle_is_between_the_gradients_of_the_follower() -> None:
    turned = told((1.0, 1.0, 1.0), turn=0.3)
    own, truth = turned.vectors(1)
    expected = math.acos(own @ truth / np.linalg.norm(own) / np.linalg.norm(truth))
    assert turned.angle(1) == pytest.approx(expected)
    assert turned.angle(1) > 0.1


def test_the_best_step_is_between_truncation_and_rounding() -> None:
    steps = 10.0 ** -np.arange(1.0, 8.0)
    found = [np.array([2.0 + step**2 + 1e-11 / step]) for step in steps]
    assert int(np.argmin(changes(found))) == 3
    assert steadiest(found)[0] == pytest.approx(2.0, abs=2e-7)
    cubes = [np.array((1.0 + 1e-2 * offset) ** 4) for offset in (-2.0, -1.0, 1.0, 2.0)]
    assert slope(cubes, 1e-2) == pytest.approx(4.0, rel=1e-12)


def test_the_command_prints_a_table_a_document_and_a_page(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    shown = crank_alone(*LINE, "--order", "-o", "page.html")
    assert shown.exit_code == 0
    assert "Not differentiable: mujoco tuned, mjd_transitionFD: it takes no RK4." in shown.stdout
    assert "page.html: gradients of fourbar-lecture-1" in shown.stdout
    page = (tmp_path / "page.html").read_text()
    assert "All gradients within 0.01" in page
    assert page.count("<figure") == 2
    document = json.loads(crank_alone(*LINE, "--json").stdout)
    assert [row["steps"] for row in document["rows"]] == [1, 5]
    assert document["not_differentiable"][0]["reason"] == "it takes no RK4"


def test_a_wrong_gradient_ends_with_1_and_none_with_2(monkeypatch: pytest.MonkeyPatch) -> None:
    def wrong(
        variation: Variation, settings: Settings, dt_s: float, steps: Sequence[int]
    ) -> Iterator[PoseGradient]:
        found = next(
            one for one in capability("mujoco", "gradient")(variation, settings, dt_s, steps)  # type: ignore[operator]
            if one.by
        )  # fmt: skip
        yield replace(found, by={name: 0.0 * each for name, each in found.by.items()})

    monkeypatch.setattr(engine_gradients, "methods_of", lambda name, with_runs: [wrong])
    answer = crank_alone(*LINE)
    assert answer.exit_code == 1
    assert "OUT; zero by crank, driver.angle" in " ".join(answer.stdout.split())

    def none(*given: object) -> Iterator[PoseGradient]:
        raise EngineError("no hinges here")

    monkeypatch.setattr(engine_gradients, "methods_of", lambda name, with_runs: [none])
    answer = crank_alone(*LINE)
    assert answer.exit_code == 2
    assert "no derivatives: " in " ".join(answer.stderr.split())


def test_an_error_of_an_engine_is_the_reason_why_it_has_no_derivatives(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def broken(*given: object) -> Iterator[PoseGradient]:
        raise RuntimeError("boom in step")

    monkeypatch.setattr(engine_gradients, "methods_of", lambda name, with_runs: [broken])
    answer = crank_alone(*LINE)
    assert answer.exit_code == 2
    assert "RuntimeError: boom in step" in " ".join(answer.stderr.split())


@pytest.mark.parametrize(("line", "words"), [
    (("--steps", "1,x"), "--steps '1,x': write whole numbers from 1"),
    (("--profile", "tunde"), "did you mean tuned"),
    (("--of", "lid"), "--of lid: there are"),
    (("--tolerance-mm", "7"), "--tolerance-mm: leave it out with --engine"),
])  # fmt: skip
def test_faulty_requests_end_with_2(line: tuple[str, str], words: str) -> None:
    answer = crank_alone(*LINE, *line)
    assert answer.exit_code == 2
    assert words in " ".join(answer.stderr.split())


def test_options_of_engines_need_an_engine() -> None:
    answer = crank_alone("sensitivity", "fourbar-lecture-1", "--order")
    assert answer.exit_code == 2
    assert "name an --engine" in answer.stderr


@slow(COMPILES)
@pytest.mark.parametrize(("name", "profile", "limit"), [one for one in LIMITS if one[0] in HERE])
def test_engines_of_training_have_the_gradient_of_the_reference(
    name: str, profile: str, limit: float
) -> None:
    found = compared(name, profile)[0]
    assert 1e-8 < max(found.error(k) for k in range(2)) < limit


@slow(COMPILES)
@pytest.mark.skipif("newton" not in HERE, reason="newton is not installed")
def test_a_loop_that_is_left_out_is_found_and_kernels_without_adjoints_are_refused() -> None:
    far = replace(QUESTION, steps=(1, 60))
    (found,) = compared("newton", "featherstone", far)
    assert not found.within
    assert found.findings(1)[0].startswith("loop open")
    assert "no adjoints" in compared("newton", "kamino")[0].refusal
    if "mujoco-warp" in HERE:
        assert "no adjoints" in compared("mujoco-warp", "tuned")[0].refusal
