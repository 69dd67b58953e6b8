"""Two faults of one channel are both told, where the first of them needs no fitted number."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
import pytest

from analytic.kinematics import solve
from models.array import Array
from reports.causes import causes
from tests.worlds.fourbar_sheets import SCENE, angle, of, omega, only
from tests.worlds.sheets import Sheet
from tests.worlds.tiers import few

COLUMN = "rocker_a"
DEG = math.pi / 180.0


def late(sheet: Sheet, samples: float = 2.5) -> Array:
    """The readings of so many samples ago."""
    motion = solve(SCENE, sheet.time_s - samples * sheet.step_s, bound=False)
    return sheet.of(motion, [COLUMN]).values[COLUMN]


def stuck(values: Array) -> Array:
    return np.concatenate([values[:50], [values[49]] * 4, values[54:]])


def spiked(values: Array) -> Array:
    return values + 0.4 * (np.arange(values.size) == 90)


def short_of_a_turn(values: Array) -> Array:
    return values - math.tau * (np.arange(values.size) >= 100)


def smoothed(values: Array) -> Array:
    after = values.copy()
    for row in range(1, values.size):
        after[row] = after[row - 1] + 0.2 * (values[row] - after[row - 1])
    return after


TWO: Mapping[str, tuple[Callable[[Sheet], Array], tuple[str, str]]] = {
    "sign, late": (lambda s: -late(s), ("has the wrong sign", "2.50 samples")),
    "unit, late": (lambda s: late(s) / DEG, ("is in deg, not in rad", "2.50 samples")),
    "unit, stuck": (lambda s: stuck(s.values[COLUMN]) / DEG, ("in deg", "samples 50 to 53")),
    "unit, turn": (lambda s: short_of_a_turn(s.values[COLUMN]) / DEG, ("in deg", "turns: -1")),
    "unit, filter": (lambda s: smoothed(s.values[COLUMN]) / DEG, ("in deg", "low-pass")),
    "sign, spike": (lambda s: -spiked(s.values[COLUMN]), ("wrong sign", "samples: sample 90")),
    "late, stuck": (lambda s: stuck(late(s)), ("samples 50 to 53", "2.50 samples")),
    "zero, spike": (lambda s: spiked(s.values[COLUMN] + 0.1), ("sample 90", "off by +0.1 rad")),
}  # fmt: skip
LONG = {"sign, late", "sign, spike"}


@pytest.mark.parametrize("name", few(TWO, TWO.keys() - LONG, "a second; a unit is as a sign"))
def test_both_are_told_of_their_channel(name: str) -> None:
    plant, words = TWO[name]
    plain = of(angle("rocker"), omega("rocker"), angle("coupler"))
    cause = only(plain.put({COLUMN: plant(plain)}))
    assert cause.columns == (COLUMN,)
    assert all(word in cause.text for word in words), cause.text
    assert "and beside that" in cause.text
    assert cause.left < 0.02


def test_what_is_to_be_written_in_the_map_is_told_of_both() -> None:
    plain = of(angle("rocker"), angle("coupler"))
    cause = only(plain.put({COLUMN: -late(plain) / DEG}))
    assert cause.correction == {
        "unit": "deg",
        "sign": -1,
        "delay_s": pytest.approx(-2.5 * plain.step_s, rel=1e-6),
    }


def test_a_channel_that_one_fault_explains_has_no_second() -> None:
    plain = of(angle("rocker"), omega("rocker"), angle("coupler"))
    for values in (-plain.values[COLUMN], late(plain), spiked(plain.values[COLUMN])):
        assert "beside" not in only(plain.put({COLUMN: values})).text


def test_two_faults_are_not_made_of_noise() -> None:
    plain = of(angle("rocker"), omega("rocker"), angle("coupler"))
    noise = np.random.default_rng(1).normal(size=plain.time_s.size)
    for size in (0.05, 1.0, 60.0):
        assert not causes(plain.put({COLUMN: plain.values[COLUMN] + size * noise}).case)


def test_nor_of_what_is_nearly_another_unit() -> None:
    plain = of(angle("rocker"), omega("rocker"), angle("coupler"))
    bent = plain.values[COLUMN] * (1.0 + 0.2 * np.sin(3.3 * plain.time_s)) / DEG
    assert not causes(plain.put({COLUMN: bent}).case)
