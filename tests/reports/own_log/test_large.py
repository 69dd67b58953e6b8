"""A log of a million rows is judged in under 10 s and 1 GB: what a user records in a quarter of an
hour at 1 kHz. Only here is a log so long that a copy too many of it would not fit."""

from __future__ import annotations

import math
import os
from functools import partial
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as pc
import pytest

from reports.workers.isolated import Isolated, Limits
from tests.worlds.fuzzing import Ended, attempt
from tests.worlds.stranger import FOURBAR
from tests.worlds.stranger_faults import COLUMNS
from tests.worlds.stranger_log import even, logged

TURNS, PER_TURN = 1000, 1000
MOST_S, MOST_BYTES = 10.0, 1_000_000_000
PLAIN = "fourbar-lecture-1"


def many_turns(path: Path) -> None:
    """One turn of the four-bar over and over, of which the crank's angle and the time go on."""
    turn = logged(FOURBAR, even(FOURBAR, 1.0, PER_TURN)[:-1], COLUMNS[PLAIN][:8])
    number = np.repeat(np.arange(TURNS), PER_TURN)
    on = {"time_s": FOURBAR.period_s, "crank_deg": math.degrees(math.tau)}
    columns = {
        name: np.tile(series, TURNS) + on.get(name, 0.0) * number for name, series in turn.items()
    }
    pc.write_csv(pa.table(columns), path)


@pytest.mark.slow
def test_a_million_rows_are_judged_in_ten_seconds_and_a_gigabyte(tmp_path: Path) -> None:
    path = tmp_path / "long.csv"
    many_turns(path)
    apart: Isolated[Ended] = Isolated(Limits(time_s=120.0, memory_gb=4.0))
    arguments = f"judge {PLAIN} FILE --target 1e-3 --json OUT.json".split()
    try:
        ended = apart.call(partial(attempt, name="log.csv"), partial(os.symlink, path), *arguments)
    finally:
        apart.close()
    assert isinstance(ended, Ended), ended
    assert ended.faults == []
    assert ended.code == 0, ended.output + ended.errors
    assert ended.took_s < MOST_S
    assert ended.peak < MOST_BYTES
