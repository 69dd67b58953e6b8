"""Logs and maps that can not be judged: each is refused with exit code 2 and one message, which
names the place, what was found and what would work; nothing is written, and it takes no more calls,
and hardly more memory, than a right log of the same size. A million rows take 1 GB, and as many
calls as a few: a user records as much in a quarter of an hour at 1 kHz."""

import math
import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from itertools import cycle
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as pc
import pytest

from reports.workers.isolated import Isolated, Limits, Lost
from tests.worlds import bad_logs
from tests.worlds.fuzzing import Ended, attempt
from tests.worlds.stranger import FOURBAR
from tests.worlds.stranger_guises import COLUMNS
from tests.worlds.stranger_log import even, logged
from tests.worlds.tiers import few, slow

PLAIN = "judge fourbar-lecture-1 FILE --target 1e-3 -o OUT.html --json OUT.json"
ALONE = "judge fourbar-lecture-1 FILE --target 1e-3 --json OUT.json"
CALLS, LESS = 2_000_000, 300_000_000
"""Calls and memory [byte], those of imports counted: to look at each byte of 9 MB takes more."""
LARGE_BYTES = 50_000
"""From which on calls are counted."""

JUDGE = "judge fourbar-lecture-1 FILE"
OPTIONS: dict[str, str] = {
    JUDGE: "--step.*--target|--target.*--step",
    **{f"{JUDGE} --step {number}": "--step" for number in ("0", "nan", "1e300")},
    f"{JUDGE} --target nan": "'nan' is not a number above 0",
    f"{JUDGE} --target angel=1e-3": "'angel' is not a quantity; .*angle",
    f"{JUDGE} --target 1e-3 --require rockr": "--require 'rockr': neither a q.*rocker",
    f"{JUDGE} --target 1e-3 --write-map nowhere/map.toml": "nowhere",
    "judge nowhere FILE --target 1e-3": "nowhere",
    f"{JUDGE} --target 1e-3 --map nowhere.toml": "nowhere.toml",
    f"{JUDGE} --target 1e-3 -o OUT.pdf": "pdf",
}
OF_ROCKER: dict[str, str] = {
    'of = "rockr"\nkind = "angle"': "of: 'rockr' is not in scene fourbar-lecture-1; .*rocker",
    'unit = "mm"': "mm is a unit of length, and",
    'kind = "vx"': "'vx' is not a kind of reading of link roc",
    'relative_to = "rocker"': "'rocker'; .*another link",
    'units = "deg"': "channel.1.units: unknown key; .*unit",
    '[[channel]]\ncolumn = "rocker_deg"': "given twice",
    'of = "crank"\nkind = "angle"': (
        "two columns for one quantity, angle of crank: 'crank_deg' and 'rocker_deg'"
    ),
    "offset = inf": "channel.1.offset: found inf",
    'time = "C_x_mm"': "'C_x_mm' is not a column of times",
}
"""What a map says of the column ``rocker_deg``."""
READ = bad_logs.HEADER.split(",")[1:]
MAPS: dict[str, str] = {
    **{f'[[channel]]\ncolumn = "rocker_deg"\n{told}': words for told, words in OF_ROCKER.items()},
    '[[channel]]\ncolumn = "rockr_deg"': "'rockr_deg' is not in .*rocker_deg",
    '[[channel]]\ncolumn = "C_x_mm"\non = "crank"': "'crank' does not carry C; .*coupler",
    '[[channel]]\nof = "rocker"': "channel.1.column: missing; add",
    '[time]\ncolumn = "tme_s"': "'tme_s' is not in .*time_s",
    "[colums]\na = 1": "colums: unknown key; ",
    '[file]\ndecimal = "!"': "file.decimal: found '!'",
    "[[channel": "not valid TOML",
    "".join(f'[[channel]]\ncolumn = "{c}"\nignore = true\n' for c in READ): "no column belongs to",
}


@dataclass(frozen=True)
class Case:
    """A file, a command on it, words of the message, and a map."""

    made: bad_logs.Made
    words: str
    command: str = PLAIN
    name: str = "log.csv"
    mapped: str = ""


def cases() -> Iterator[tuple[str, Case]]:
    for name, (made, words) in {**bad_logs.TEXTS, **bad_logs.LARGE}.items():
        yield name, Case(made, words)
    endings = cycle(("csv", "xlsx", "parquet"))
    for (name, (made, words)), ending in zip(bad_logs.SPECIAL.items(), endings, strict=False):
        yield f"{name} .{ending}", Case(made, words, name=f"log.{ending}")
    for name, (made, words) in bad_logs.PARQUET.items():
        yield f"Parquet, {name}", Case(made, words, name="log.parquet")
    for name, (made, words) in bad_logs.WORKBOOKS.items():
        yield f"workbook, {name}", Case(made, words, name="log.xlsx")
    right = bad_logs.text(*bad_logs.ROWS)
    for command, words in OPTIONS.items():
        yield command, Case(right, words, command)
    for mapped, words in MAPS.items():
        yield f"map, {mapped}", Case(right, words, mapped=mapped)
    rows = [row.split(",") for row in (bad_logs.HEADER, *bad_logs.ROWS)]
    without = "\n".join(",".join([*row[:1], *row[2:]]) for row in rows).encode()
    logged = f"{PLAIN} --drive logged"
    yield "logged, no crank", Case(without, "no angle of crank .*log crank_", logged)
    lever = bad_logs.HEADER.replace("crank_deg", "lever_deg")
    swinging = bad_logs.text(*bad_logs.ROWS, header=lever)
    fitted, words = "judge tangent FILE --drive fitted", "driver of tangent has no constant speed"
    yield "fitted to a lever that swings", Case(swinging, f"--drive fitted: the {words}", fitted)
    yield "another ending", Case(right, "found '.docx'; use .csv, .tsv", name="log.docx")
    yield "no ending", Case(right, "found no ending; use .csv", name="log")


CASES = dict(cases())


@pytest.fixture(scope="module")
def apart() -> Iterator[Isolated[Ended]]:
    """A process that bad input is tried in: it may hang, or fill memory."""
    # Arrow lays claim to more than a gigabyte, of which it takes next to nothing.
    process: Isolated[Ended] = Isolated(Limits(time_s=600.0, memory_gb=5.0))
    yield process
    process.close()


LONG = {
    "null bytes behind a good beginning",
    "a line of 9 MB",
    "remarks of 300 kB",
    "10 million rows",
    "a quote over 9 MB",
    "workbook, a cell far away",
    "workbook, laughs",
}


@pytest.mark.parametrize(
    "name", few(CASES, CASES.keys() - LONG, "sizes at which work on each byte shows")
)
def test_it_is_refused_in_one_message(name: str, apart: Isolated[Ended], tmp_path: Path) -> None:
    case = CASES[name]
    arguments = case.command.split()
    if case.mapped:
        (tmp_path / "map.toml").write_text(case.mapped, encoding="utf-8")
        arguments += ["--map", str(tmp_path / "map.toml")]
    large = callable(case.made) or len(case.made) > LARGE_BYTES
    ended = apart.call(partial(attempt, name=case.name, counted=large), case.made, *arguments)
    assert not isinstance(ended, Lost), ended
    assert ended.faults == []
    assert ended.code == 2, ended.output + ended.errors
    assert ended.errors.count("crankcheck: ") == 1
    assert len(ended.errors) < 9000
    assert re.search(case.words, " ".join(ended.errors.split()), re.DOTALL), ended.errors[:500]
    assert ended.files == ()
    assert large == (0 < ended.calls < CALLS)
    assert ended.peak - ended.before < LESS


TURNS, PER_TURN = 1000, 1000


def many_turns(path: Path, turns: int) -> None:
    """One turn of the four-bar over and over, of which the crank's angle and the time go on."""
    turn = logged(FOURBAR, even(FOURBAR, 1.0, PER_TURN)[:-1], COLUMNS["fourbar-lecture-1"][:8])
    number = np.repeat(np.arange(turns), PER_TURN)
    on = {"time_s": FOURBAR.period_s, "crank_deg": math.degrees(math.tau)}
    columns = {c: np.tile(series, turns) + on.get(c, 0.0) * number for c, series in turn.items()}
    pc.write_csv(pa.table(columns), path)


@slow("only here is a log so long that a copy too many of it would not fit")
def test_a_million_rows_take_a_gigabyte_and_as_many_calls_as_a_thousand(tmp_path: Path) -> None:
    apart: Isolated[Ended] = Isolated(Limits(time_s=600.0, memory_gb=4.0))
    judged = partial(attempt, name="log.csv", counted=True)
    ended = []
    try:
        for turns in (1, 1, TURNS):  # the first imports what it needs
            path = tmp_path / f"{turns}.csv"
            many_turns(path, turns)
            ended.append(apart.call(judged, partial(os.symlink, path), *ALONE.split()))
    finally:
        apart.close()
    for one in ended:
        assert isinstance(one, Ended), one
        assert one.faults == []
        assert one.code == 0, one.output + one.errors
    _, short, long = ended
    assert long.calls < 2 * short.calls
    assert long.peak < 1_000_000_000
