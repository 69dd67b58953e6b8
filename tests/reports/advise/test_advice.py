"""Advice of what was found: its order, its best, how it is shown and written."""

from __future__ import annotations

import io
import json
import math
from dataclasses import replace

import pytest
from rich.console import Console

from models.files import load_scene
from reports.advise.advice import Advice, offers
from reports.advise.choices import choices
from reports.advise.demand import demanded
from reports.advise.document import document
from reports.advise.evidence import MeasuredSteps, MeasuredStudy
from reports.advise.look import TriedRun
from reports.advise.prices import Price, Prices
from reports.advise.search import SearchResult, Worst
from reports.advise.table import show, word

DEMAND = demanded(
    [load_scene("fourbar-lecture-1"), load_scene("slider-crank-central")], 10.0, 1 / 60, 1e-3, 10.0
)
NAME = DEMAND.scenes[0].name
EVERY = {choice.label: choice for choice in choices(["mujoco", "pymunk"], ())}


def worst(substeps: int, error: float, **seen: object) -> Worst:
    return Worst(substeps, NAME, replace(TriedRun(error), **seen))  # type: ignore[arg-type]


def reached(label: str, substeps: int, error: float, **seen: object) -> SearchResult:
    promise = worst(substeps, error, **seen)
    return SearchResult(EVERY[label], worst(1, 2e-2), promise, None, held_at=(2 * substeps,))


FOUND = (
    (reached("pymunk tuned", 4, 8e-4), 1.4e-3),
    (reached("mujoco tuned", 1, 7e-5), 5.0e-4),
    (reached("pymunk no bias", 4, 7.9e-4), 3.00e-4),
    (reached("pymunk no bias, 50 iterations", 4, 7.8e-4), 3.05e-4),
    (reached("mujoco stiff", 8, 9e-4), 1.3e-3),
    (SearchResult(EVERY["mujoco RK4"], worst(1, 4e-3), None, worst(8, 1.8e-3)), None),
    (
        SearchResult(EVERY["mujoco as-shipped"], worst(1, math.inf, status="diverged"), None, None),
        None,
    ),
    (
        SearchResult(
            EVERY["pymunk as-shipped"],
            None,
            None,
            None,
            ended=TriedRun(math.inf, "timeout", "no end"),
        ),
        None,
    ),
)


def advice(*changed: tuple[SearchResult, float | None], noise: float = 0.05) -> Advice:
    found = changed or FOUND
    prices = tuple(s_per_s and Price(NAME, 1e6 * s_per_s / 240, s_per_s) for _, s_per_s in found)
    made = offers([one for one, _ in found], Prices(prices, noise))
    return Advice(DEMAND, made, noise, MeasuredStudy(), {"mujoco": "4.0.0", "processor": "abacus"})


def labels(every: Advice) -> list[str]:
    return [offer.reached.choice.label for offer in every.offers]


def printed(every: Advice, width: int = 100) -> str:
    stream = io.StringIO()
    show(Console(file=stream, width=width), every)
    return stream.getvalue()


def test_promises_come_first_from_cheap_to_dear_then_the_nearest() -> None:
    assert labels(advice()) == [
        "pymunk no bias",
        "pymunk no bias, 50 iterations",
        "mujoco tuned",
        "mujoco stiff",
        "pymunk tuned",
        "mujoco RK4",
        "mujoco as-shipped",
        "pymunk as-shipped",
    ]


def test_of_what_costs_the_same_within_the_noise_the_least_error_is_best() -> None:
    best = {noise: advice(noise=noise).best for noise in (0.05, 0.001, math.nan)}
    names = {n: [offer.reached.choice.label for offer in each] for n, each in best.items()}
    assert names[0.05] == ["pymunk no bias, 50 iterations", "mujoco tuned"]
    assert names[0.001] == ["pymunk no bias", "mujoco tuned"]


def test_a_promise_whose_error_grows_is_best_only_where_no_other_is() -> None:
    grows = reached("pymunk no bias", 4, 7e-4, growth=1.4)
    assert [o.reached.choice.name for o in advice((grows, 1e-4), FOUND[0]).best] == ["tuned"]
    (only,) = advice((grows, 1e-4)).best
    assert only.reached is grows
    assert "the error grows: with 4 a frame it is 1.4 times" in " ".join(
        printed(advice((grows, 1e-4))).split()
    )


def test_so_is_one_that_a_study_has_over_the_target_at_finer_steps() -> None:
    one = reached("pymunk no bias, 50 iterations", 4, 7e-4)
    steps = MeasuredSteps(((90.0, 1e-2), (360.0, 1e-4), (5760.0, math.inf)))
    known = MeasuredStudy(measured={(NAME, one.choice.key): steps})
    every = replace(advice((one, 1e-4), FOUND[0]), known=known)
    assert [offer.reached.choice.name for offer in every.best] == ["tuned"]
    only = replace(advice((one, 1e-4)), known=known)
    text = " ".join(printed(only).split())
    assert f"the study {NAME} is over the target at 5760 steps a turn (153 sub-steps)" in text
    assert "Caution: holds with 4 sub-steps" in " ".join(only.snippet(only.best[0]).split())


@pytest.mark.parametrize("width", [60, 72, 80, 100, 120])
def test_it_fits_the_terminal_whole(width: int) -> None:
    text = printed(advice(), width)
    table = text[: text.index("within 0.001,")]
    assert max(len(line.rstrip()) for line in table.splitlines()) <= width
    assert "\u2026" not in text
    for part in ("comes", "apart", "none", "over", "1.8e-3", "7.0e-5", "2.0e-2"):
        assert part in table
    assert ("of real" in table) is (width >= 76)


def test_the_best_of_each_engine_is_told_with_its_price_and_its_snippet() -> None:
    text = printed(advice(noise=0.001))
    flat = " ".join(text.replace("#", " ").split())
    assert (
        "pymunk no bias, 4 steps a frame (4.167 ms): within 0.001, 7.9e-4 at worst; 0.03 % of"
        in flat
    )
    assert "mujoco tuned, 1 step a frame (16.67 ms)" in flat
    assert "dt = 0.004166666666666667  # a frame of 0.0166667 s / 4" in text
    assert "for _ in range(4):" in text
    assert '<option timestep="0.016666666666666666" integrator="RK4"/>' in text
    assert "on each of 2 scenes at 10 rad/s, over 10 turns; at worst 7.9e-4" in flat
    assert "abacus" in text
    assert "pymunk as-shipped: no end" in text
    assert "error_bias 0" in text


def test_times_are_told_over_the_cheapest() -> None:
    lines = printed(advice(noise=0.05)).splitlines()
    ratio = {
        name: line.split()[-1] for line in lines for name in EVERY if line.startswith(f"{name}  ")
    }
    assert ratio["pymunk no bias"] == ratio["pymunk no bias, 50 iterations"] == "1"
    assert ratio["mujoco tuned"] == "1.7"
    assert ratio["mujoco RK4"] == "-"


def test_where_nothing_reaches_the_nearest_is_told() -> None:
    every = advice(*FOUND[-3:])
    assert every.best == ()
    text = " ".join(printed(every).split())
    assert f"NOTHING REACHES 0.001 with up to {DEMAND.most} sub-steps a frame: nearest is" in text
    assert f"mujoco RK4 with 8, 1.8e-3 on {NAME}" in text
    assert "no run came to its end" in " ".join(printed(advice(FOUND[-1])).split())


def test_what_was_luck_is_told() -> None:
    one = replace(FOUND[-3][0], unsteady=(3, 4))
    text = " ".join(printed(advice((one, None))).split())
    assert "mujoco RK4: within with 3, 4 sub-steps, and not with more" in text


def test_who_named_no_scene_is_told_that_his_own_may_differ() -> None:
    assert "takes your own" not in printed(advice())
    assert "takes your own" in printed(replace(advice(), named=False))


def test_a_process_lost_while_it_was_timed_costs_the_price_alone() -> None:
    every = advice(FOUND[1], (FOUND[2][0], None))
    assert labels(every) == ["mujoco tuned", "pymunk no bias"]
    assert [offer.reached.choice.engine for offer in every.best] == ["mujoco", "pymunk"]
    assert "within 0.001, 7.9e-4 at worst\n" in printed(every)


@pytest.mark.parametrize(
    ("seen", "words"),
    [
        (None, "too coarse"),
        (worst(1, 9e-4), "within"),
        (worst(1, 2e-3), "over"),
        (worst(1, 2e-3, growth=1.2), "over, grows"),
        (worst(1, math.inf, status="branch-changed"), "other branch"),
    ],
)
def test_the_frame_itself_gets_a_word(seen: Worst | None, words: str) -> None:
    assert word(seen, DEMAND.target) == words


def test_the_file_has_the_same_facts_and_all_settings() -> None:
    every = replace(advice(noise=0.001), known=MeasuredStudy())
    content = json.loads(document(every))
    assert content["asked"]["frames_per_turn"] == pytest.approx(37.699, rel=1e-4)
    assert content["best"] == ["pymunk no bias", "mujoco tuned"]
    assert content["study"] is None
    first, *_, last = content["settings"]
    assert f"{first['engine']} {first['name']}" == "pymunk no bias"
    assert first["promise"]["substeps"] == 4
    assert first["promise"]["dt_s"] == DEMAND.frame_s / 4
    assert first["promise"]["held_at"] == [8]
    assert first["settings"]["error_bias"] == 0.0
    assert first["ms_per_simulated_s"] == pytest.approx(0.3)
    assert first["times_cheapest"] == 1.0
    assert first["snippet"] == every.snippet(every.offers[0])
    assert last["promise"] is None
    assert last["ended"]["status"] == "timeout"
    assert content["settings"][-2]["at_frame"]["place_error"] is None
