"""Faults in logs of mechanisms of other kinds, of parts of what may be logged, sampled otherwise:
nothing is told that is not so.

A cause with the name of another fault is true as well where it leaves no more than the noise that
the log had before: a line through the crank's pin that is turned, and a lever whose zero is, are
one thing.
"""

from __future__ import annotations

from itertools import cycle, islice, product

import numpy as np
import pytest

from analytic.kinematics import solve
from reports.causes import Cause, causes
from reports.logs.channel import Channel
from reports.logs.kinds import KINDS as KINDS_OF
from tests.worlds.other_kinds import KINDS, PARTS, SAMPLING, infected, scene_of
from tests.worlds.plantings import PLANTINGS
from tests.worlds.sheets import Sheet
from tests.worlds.tiers import few, slow

TEN = (
    "two_swapped",
    "another_unit",
    "another_sign",
    "one_late",
    "slow_clock",
    "another_assembly",
    "another_length",
    "stuck_sample",
    "lost_turn",
    "low_passed",
)
NOISE = 0.2
"""What a cause may leave, over the limit, to be as good as the fault that was planted."""
LIMIT = 1e-3
ALSO = {"low_passed": ("smoothed",)}
"""What a fault may be called as well."""
TURN_ABOUT = list(zip(
    [(kind, fault) for kind in KINDS for fault in ("healthy", *TEN)],
    islice(cycle(PARTS), len(KINDS) * (len(TEN) + 1)),
    strict=True,
))  # fmt: skip
"""Each fault in each kind, of the parts in turn. Each fifth is looked at at once: each fault in one
kind or two."""


def false(planted: Sheet, fault: str) -> list[str]:
    """The causes that are told of a log, and are not so."""
    excerpts = planted.case.excerpts
    found = causes(planted.case)

    def as_good(cause: Cause) -> bool:
        return all(
            cause.left * float(np.max(np.abs(excerpts[c].error))) <= NOISE * excerpts[c].limit
            for c in cause.columns
        )

    names = (*PLANTINGS[fault].names, *ALSO.get(fault, ()))
    return [each.text for each in found if each.name not in names and not as_good(each)]


@pytest.mark.parametrize("at", few(TURN_ABOUT, TURN_ABOUT[1::5], "the same fault in other kinds"))
def test_nothing_false_is_told(at: tuple[tuple[str, str], str]) -> None:
    (kind, fault), part = at
    planted = infected(kind, fault, part, "plain", LIMIT)
    if planted is None:
        return  # no turn to be lost in a log of lengths, say
    assert not false(planted, fault)
    assert fault != "healthy" or not planted.case.out


def test_a_delay_is_found_though_a_nudge_of_it_takes_the_last_sample_out_of_the_log() -> None:
    scene = scene_of("parallel links")
    time_s = np.arange(161) * scene.driver.law.period_s / 400.0
    channels = {axis: Channel(axis, KINDS_OF["point", axis], "F", "m") for axis in ("x", "y")}
    whole = Sheet(scene, time_s, channels, {}, dict.fromkeys(channels, 3e-4))
    step_s = whole.step_s
    plain = whole.of(solve(scene, time_s, bound=False))
    (cause,) = causes(plain.of(solve(scene, time_s - 2.5 * step_s, bound=False), ["x"]).case)
    assert cause.name == "delay"
    assert cause.correction["delay_s"] == pytest.approx(-2.5 * step_s, rel=1e-6)


@slow("only here is each fault planted at coarse and at few samples")
@pytest.mark.parametrize("sampling", [name for name in SAMPLING if name != "plain"])
@pytest.mark.parametrize("kind", KINDS)
def test_nor_with_other_samples_and_other_limits(kind: str, sampling: str) -> None:
    told, limits = [], cycle((1e-4, 1e-2))
    faults = ("healthy", "noise", "wandering", *TEN)
    for (fault, part), limit in zip(
        product(faults, ("all", "without the crank")), limits, strict=False
    ):
        planted = infected(kind, fault, part, sampling, limit)
        if planted is not None:
            told += [f"{fault}, {part}, {limit}: {each}" for each in false(planted, fault)]
    assert not told
