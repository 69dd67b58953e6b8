"""A log of a million rows is judged in 1 GB, and in as many calls as a short one: a user records as
much in a quarter of an hour at 1 kHz."""

from __future__ import annotations

import math
import os
from functools import partial
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as pc

from reports.workers.isolated import Isolated, Limits
from tests.worlds.fuzzing import Ended, attempt
from tests.worlds.stranger import FOURBAR
from tests.worlds.stranger_faults import COLUMNS
from tests.worlds.stranger_log import even, logged
from tests.worlds.tiers import slow

TURNS, PER_TURN = 1000, 1000
MOST_BYTES = 1_000_000_000
PLAIN = "fourbar-lecture-1"


def many_turns(path: Path, turns: int = TURNS) -> None:
    """One turn of the four-bar over and over, of which the crank's angle and the time go on."""
    turn = logged(FOURBAR, even(FOURBAR, 1.0, PER_TURN)[:-1], COLUMNS[PLAIN][:8])
    number = np.repeat(np.arange(turns), PER_TURN)
    on = {"time_s": FOURBAR.period_s, "crank_deg": math.degrees(math.tau)}
    columns = {
        name: np.tile(series, turns) + on.get(name, 0.0) * number for name, series in turn.items()
    }
    pc.write_csv(pa.table(columns), path)


@slow("only here is a log so long that a copy too many of it would not fit")
def test_a_million_rows_are_judged_in_a_gigabyte_and_as_many_calls_as_a_thousand(
    tmp_path: Path,
) -> None:
    apart: Isolated[Ended] = Isolated(Limits(time_s=600.0, memory_gb=4.0))
    arguments = f"judge {PLAIN} FILE --target 1e-3 --json OUT.json".split()
    judged = partial(attempt, name="log.csv", counted=True)
    ended = []
    try:
        for turns in (1, 1, TURNS):  # the first imports what it needs
            path = tmp_path / f"{turns}.csv"
            many_turns(path, turns)
            ended.append(apart.call(judged, partial(os.symlink, path), *arguments))
    finally:
        apart.close()
    for one in ended:
        assert isinstance(one, Ended), one
        assert one.faults == []
        assert one.code == 0, one.output + one.errors
    _, short, long = ended
    assert long.calls < 2 * short.calls
    assert long.peak < MOST_BYTES
