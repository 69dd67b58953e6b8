"""Every fault is named with its channels, and nothing else is; healthy logs have none."""

from __future__ import annotations

from collections import Counter
from itertools import cycle

import numpy as np
import pytest

from models.files import load_scene
from reports.causes import causes
from tests.reports.causes.conftest import CLEAR, FAULTS, SCENES, Diagnosed, Infected
from tests.worlds.plantings import PLANTINGS
from tests.worlds.sheets import sheet
from tests.worlds.tiers import slow

NONE = [name for name, each in PLANTINGS.items() if not each.names]
MANY = 4
"""Plantings of each fault in each scene."""
MISSED = 0.02
"""The part of them that chance may make two faults of: a mean and a delay in noise, say."""


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_named_with_its_channels(fault: str, diagnosed: Diagnosed) -> None:
    planted, columns, found = diagnosed(fault)
    out = {reading.channel.column for reading in planted.case.out}
    assert {cause.name for cause in found} <= set(PLANTINGS[fault].names)
    told = {column for cause in found for column in cause.columns}
    assert out <= told
    assert told <= (set(columns) or set(planted.channels))
    for cause in found:
        assert "{" not in cause.text
        assert 0.0 <= cause.left <= 0.4


@pytest.mark.parametrize(("fault", "scene"), list(zip(NONE, cycle(SCENES), strict=False)))
def test_nothing_is_made_up(fault: str, scene: str, infected: Infected) -> None:
    planted, _ = infected(fault, scene, rows=300)
    assert not causes(planted.case)


@pytest.mark.parametrize("scene", ["whitworth", "shaper", "tangent", "scotch-yoke"])
def test_healthy_logs_of_other_mechanisms_have_no_cause(scene: str) -> None:
    rng = np.random.default_rng(3)
    for even in (True, False):
        planted = sheet(load_scene(scene), rng, rows=300, even=even, noise=0.5)
        assert not planted.case.out
        assert not causes(planted.case)


@slow("only here are sizes of faults, lengths of logs, limits and noise at random")
@pytest.mark.parametrize("scene", SCENES)
def test_the_names_of_many_faults_at_random_are_not_mistaken(
    scene: str, infected: Infected
) -> None:
    right: Counter[bool] = Counter()
    for fault, planting in PLANTINGS.items():
        for seed in range(MANY):
            rng = np.random.default_rng([seed, *fault.encode()])
            options = {
                "rows": int(rng.choice([200, 600, 2500])),
                "turns": float(rng.choice([1.5, 2.5, 12.0])),
                "limit": float(10.0 ** rng.uniform(-4.0, -2.5)),
                "noise": float(rng.choice([0.0, 0.05, 0.5])),
            }
            try:
                planted, _ = infected(fault, scene, seed + 1, **options)
            except LookupError:  # few angles to swap, or too small a fault beside the limits
                continue
            case, found = planted.case, causes(planted.case)
            told = {column: cause.name for cause in found for column in cause.columns}
            shares = {c: each.worst / each.limit for c, each in case.excerpts.items()}
            clear = [column for column, share in shares.items() if share > CLEAR]
            if planting.names:
                right[all(told.get(column) in planting.names for column in clear)] += 1
            else:
                assert not found
    assert sum(right.values()) > 140
    assert right[False] <= MISSED * right[True]
