"""Solutions of random tasks in every engine: what the reference says of them holds there as well.

Where a transmission angle comes below `LEAST_DEG`, or two pins of a link lie close together beside
the size of others, engines are not asked: these are hard cases of their own. With pins 0.08 m apart
on a coupler between links of 2.3 m pymunk tuned flies apart, where as shipped it holds.
"""

from __future__ import annotations

import itertools
import math

import pytest

from analytic.synthesis import coupler
from analytic.synthesis.examine import Examined
from analytic.synthesis.solutions import solutions_of
from models.errors import CrankcheckError
from models.scene import span
from reports.synthesis.proof import proven
from tests.analytic.synthesis.random_tasks import TASKS, random_task

LEAST_DEG = 20.0
LONGEST, OF_SIX_BARS = 4.0, 12.0
"""Of a link of what carries a body, over the least distance of two pins of one."""
CARRIES = ("two_positions", "three_positions", "given_pivots", "four_positions", "five_positions",
           "driving_dyad")  # fmt: skip
ENGINES = ("mujoco", "pymunk", "exudyn")


def is_easy(kind: str, one: Examined) -> bool:
    pins = [
        math.dist(link.points[p], link.points[q])
        for link in one.scene.links.values()
        for p, q in itertools.combinations(link.points, 2)
        if len(one.scene.pins[p]) > 1 and len(one.scene.pins[q]) > 1
    ]
    spans = [*pins, *(span(link.points) for link in one.scene.links.values())]
    most = OF_SIX_BARS if kind == "driving_dyad" else LONGEST
    even = kind not in CARRIES or max(spans) < most * min(pins)
    return even and math.degrees(one.least_transmission_rad) > LEAST_DEG


def hold(kind: str, first: int, count: int, engines: tuple[str, ...]) -> None:
    """So many tasks whose best solution transmits well enough."""
    done, number = 0, first
    while done < count:
        number += 1
        assert number < first + 40 * count, (kind, done)
        task = random_task(kind, number)
        try:
            found = solutions_of(task).sound
        except CrankcheckError:
            continue
        good = [one for one in found if is_easy(kind, one)]
        if not good:
            continue
        done += 1
        for engine in engines:
            every = proven(good[0], task, engine)
            off = max(met.off / met.limit for met in every)
            assert all(met.within for met in every), (kind, number, engine, off, good[0].text)


@pytest.mark.parametrize("kind", TASKS)
def test_engines_meet_what_the_reference_meets(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(coupler, "CHOSEN", 4)
    hold(kind, 2000, 1, ENGINES[:2])


@pytest.mark.slow
@pytest.mark.parametrize("kind", TASKS)
def test_fifty_of_each_kind(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("exudyn")
    monkeypatch.setattr(coupler, "CHOSEN", 4)
    hold(kind, 3000, 50, ENGINES)
