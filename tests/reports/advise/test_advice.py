"""Advice of what was found: its order, its best, how it is shown and written."""

import io
import json
import math
from collections.abc import Iterable
from dataclasses import replace

import pytest
from rich.console import Console

from models.files.reading import load_scene
from reports.advise.advice import Advice, Offer, Price, Prices, offers
from reports.advise.demand import MeasuredSteps, MeasuredStudy, choices, demanded
from reports.advise.search import SearchResult, TriedRun, Worst
from reports.advise.table import document, show_advice
from tests.worlds.command_line import flat

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


def missed(
    label: str, at_frame: Worst | None, nearest: Worst | None = None, **more: TriedRun
) -> tuple[SearchResult, None]:
    return SearchResult(EVERY[label], at_frame, None, nearest, **more), None


FOUND = (
    (reached("pymunk tuned", 4, 8e-4), 1.4e-3),
    (reached("mujoco tuned", 1, 7e-5), 5.0e-4),
    (reached("pymunk no bias", 4, 7.9e-4), 3.00e-4),
    (reached("pymunk no bias, 50 iterations", 4, 7.8e-4), 3.05e-4),
    (reached("mujoco stiff", 8, 9e-4), 1.3e-3),
    missed("mujoco RK4", worst(1, 4e-3), worst(8, 1.8e-3)),
    missed("mujoco as-shipped", worst(1, math.inf, status="diverged")),
    missed("pymunk as-shipped", None, ended=TriedRun(math.inf, "timeout", "no end")),
)


def advice(*changed: tuple[SearchResult, float | None], noise: float = 0.05) -> Advice:
    found = changed or FOUND
    prices = tuple(s_per_s and Price(NAME, 1e6 * s_per_s / 240, s_per_s) for _, s_per_s in found)
    made = offers([one for one, _ in found], Prices(prices, noise))
    return Advice(DEMAND, made, noise, MeasuredStudy(), {"mujoco": "4.0.0", "processor": "abacus"})


def labels(every: Iterable[Offer]) -> str:
    return "; ".join(offer.reached.choice.label for offer in every)


def printed(every: Advice, width: int = 100) -> str:
    stream = io.StringIO()
    show_advice(Console(file=stream, width=width), every)
    return stream.getvalue()


def test_promises_come_first_from_cheap_to_dear_and_of_equal_ones_the_least_error() -> None:
    assert labels(advice().offers) == (
        "pymunk no bias; pymunk no bias, 50 iterations; mujoco tuned; mujoco stiff; pymunk tuned; "
        "mujoco RK4; mujoco as-shipped; pymunk as-shipped"
    )
    assert labels(advice(noise=0.05).best) == "pymunk no bias, 50 iterations; mujoco tuned"
    assert labels(advice(noise=0.001).best) == "pymunk no bias; mujoco tuned"
    assert advice(noise=math.nan).best


def test_what_grows_or_is_over_at_finer_steps_in_a_study_is_best_only_where_no_other_is() -> None:
    grows = reached("pymunk no bias", 4, 7e-4, growth=1.4)
    assert labels(advice((grows, 1e-4), FOUND[0]).best) == "pymunk tuned"
    (only,) = advice((grows, 1e-4)).best
    assert only.reached is grows
    text = flat(printed(advice((grows, 1e-4))))
    assert "the error grows: with 4 a frame it is 1.4 times" in text
    one = reached("pymunk no bias, 50 iterations", 4, 7e-4)
    steps = MeasuredSteps(((90.0, 1e-2), (360.0, 1e-4), (5760.0, math.inf)))
    known = MeasuredStudy(measured={(NAME, one.choice.key): steps})
    assert labels(replace(advice((one, 1e-4), FOUND[0]), known=known).best) == "pymunk tuned"
    only = replace(advice((one, 1e-4)), known=known)
    over = f"the study {NAME} is over the target at 5760 steps a turn (153 sub-steps)"
    assert over in flat(printed(only))
    assert "Caution: holds with 4 sub-steps" in flat(only.snippet(only.best[0]))


@pytest.mark.parametrize("width", [60, 76, 100])
def test_it_fits_the_terminal_whole(width: int) -> None:
    text = printed(advice(), width)
    table = text[: text.index("within 0.001,")]
    assert max(len(line.rstrip()) for line in table.splitlines()) <= width
    assert "\u2026" not in text
    for part in ("comes", "apart", "none", "over", "1.8e-3", "7.0e-5", "2.0e-2", " 1.7 "):
        assert part in table
    assert ("of real" in table) is (width >= 76)


def test_the_best_of_each_engine_is_told_and_written_with_its_price_and_its_snippet() -> None:
    every = advice(noise=0.001)
    text = printed(every)
    for line in (
        "dt = 0.004166666666666667  # a frame of 0.0166667 s / 4",
        "abacus",
        "pymunk as-shipped: no end",
        "error_bias 0",
    ):
        assert line in text
    words = "pymunk no bias, 4 steps a frame (4.167 ms): within 0.001, 7.9e-4 at worst; 0.03 % of"
    assert words in flat(text.replace("#", " "))
    assert "takes your own" not in text
    content = json.loads(document(every))
    assert content["asked"]["frames_per_turn"] == pytest.approx(37.699, rel=1e-4)
    assert content["best"] == ["pymunk no bias", "mujoco tuned"]
    first, *_, before, last = content["settings"]
    assert f"{first['engine']} {first['name']}" == "pymunk no bias"
    promised = {"substeps": 4, "dt_s": DEMAND.frame_s / 4, "held_at": [8]}
    assert promised.items() <= first["promise"].items()
    assert first["settings"]["error_bias"] == 0.0
    assert first["ms_per_simulated_s"] == pytest.approx(0.3)
    assert first["times_cheapest"] == 1.0
    assert first["snippet"] == every.snippet(every.offers[0])
    assert last["promise"] is None
    assert last["ended"]["status"] == "timeout"
    assert before["at_frame"]["place_error"] is None


def test_the_nearest_is_told_where_nothing_reaches_what_was_luck_and_what_has_no_price() -> None:
    every = advice(*FOUND[-3:])
    assert every.best == ()
    text = flat(printed(every))
    assert f"NOTHING REACHES 0.001 with up to {DEMAND.most} sub-steps a frame: nearest is" in text
    assert f"mujoco RK4 with 8, 1.8e-3 on {NAME}" in text
    assert "no run came to its end" in flat(printed(advice(FOUND[-1])))
    lucky = flat(printed(advice((replace(FOUND[-3][0], unsteady=(3, 4)), None))))
    assert "mujoco RK4: within with 3, 4 sub-steps, but not with more" in lucky
    every = advice(FOUND[1], (FOUND[2][0], None))  # a process lost while it was timed
    assert labels(every.offers) == labels(every.best) == "mujoco tuned; pymunk no bias"
    assert "within 0.001, 7.9e-4 at worst\n" in printed(every)
