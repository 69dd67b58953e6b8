"""Faults in logs of mechanisms of other kinds, of parts of what may be logged, sampled otherwise:
nothing is told that is not so.

A cause with the name of another fault is true as well where it leaves no more than the noise that
the log had before: a line through the crank's pin that is turned, and a lever whose zero is, are
one thing.
"""

from __future__ import annotations

from itertools import cycle, islice

import numpy as np
import pytest

from reports.causes import Cause, causes
from tests.worlds.other_kinds import KINDS, PARTS, SAMPLING, infected
from tests.worlds.plantings import PLANTINGS
from tests.worlds.sheets import Sheet

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


@pytest.mark.parametrize(("mechanism", "part"), TURN_ABOUT)
def test_nothing_false_is_told(mechanism: tuple[str, str], part: str) -> None:
    kind, fault = mechanism
    planted = infected(kind, fault, part, "plain", LIMIT)
    if planted is None:
        return  # no turn to be lost in a log of lengths, say
    assert not false(planted, fault)
    assert fault != "healthy" or not planted.case.out


@pytest.mark.slow
@pytest.mark.parametrize("sampling", SAMPLING)
@pytest.mark.parametrize("kind", KINDS)
def test_nor_with_other_samples_other_channels_and_other_limits(kind: str, sampling: str) -> None:
    """Only here is each fault planted in each part of a log, at coarse and at few samples."""
    told = []
    for fault in ("healthy", "noise", "wandering", *TEN):
        for part in PARTS:
            for limit in (1e-4, 1e-2):
                planted = infected(kind, fault, part, sampling, limit)
                if planted is not None:
                    told += [f"{fault}, {part}, {limit}: {each}" for each in false(planted, fault)]
    assert not told
