"""Every scene file either runs or ends with exit code 2 and a message, in the memory that it may
take.

Files that were made from nothing (`tests.worlds.scene_files`) and shipped files with something done
to them (`tests.worlds.mutation`), many of them in a process apart. A failure prints what brings it
back::

    python -c "from tests.worlds.fuzzing import *; from tests.worlds.mutation import mutant
    print(attempt(mutant(SEED), *'COMMAND'.split()))"
"""

import itertools
import os
import re
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
import typer
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st

from reports.workers.isolated import Isolated, Limits, Lost
from tests.worlds import fuzzing
from tests.worlds.in_process import Here
from tests.worlds.mutation import mutant, retied, stretched
from tests.worlds.scene_files import Tree, elastic_mechanisms, free_mechanisms, scene_files
from tests.worlds.tiers import at_length, slowly

LIMITS = Limits(time_s=600.0, memory_gb=1.0)
"""The time ends what hangs. Memory is that beyond a child with all engines in it, which has 0.2 GB
in use."""
MOST_BYTES = 800_000_000
"""Beyond what the process held before its first file."""
SEED = 20260
EACH, PARTS = 250, 20
"""Files of each kind in each part of ten thousand, and the parts."""
QUICKLY = {"made": 5, "free": 5, "elastic": 1, "changed": 5}
"""Files in the quick test, half a second of elastic links each."""
HOME = Path(tempfile.gettempdir()) / f"crankcheck-misdeed-{os.getpid()}"


class Bench:
    """A process that files are tried in, this one or one apart, and what came of them."""

    def __init__(self, apart: Isolated[fuzzing.Ended] | Here[fuzzing.Ended]) -> None:
        self.apart = apart
        self.ends: Counter[str] = Counter()
        self.held: int | None = None

    def try_out(self, raw: bytes, command: str) -> list[str]:
        """The faults that a file brings about."""
        ended = self.apart.call(fuzzing.attempt, raw, *command.split())
        if isinstance(ended, Lost):
            return [f"{ended.status}: {ended.reason}"]
        self.ends[f"exit {ended.code}"] += 1
        self.ends.update(ended.outcomes)
        if self.held is None:
            self.held = ended.before
        more = ended.peak - self.held
        over = [f"{more / 1e6:.0f} MB of memory"] if more > MOST_BYTES else []
        return ended.faults + over


@pytest.fixture
def bench() -> Iterator[Bench]:
    made = Bench(Isolated(LIMITS))
    yield made
    made.apart.close()
    print(made.ends)


KINDS: dict[str, tuple[tuple[str, ...], tuple[str, ...], st.SearchStrategy[Tree] | None]] = {
    "made": (fuzzing.QUICK, fuzzing.COMMANDS, None),
    "free": (fuzzing.LET_GO, fuzzing.LET_GO, free_mechanisms()),
    "elastic": (fuzzing.ELASTIC_QUICK, fuzzing.ELASTIC, elastic_mechanisms()),
    "changed": (fuzzing.QUICK, fuzzing.COMMANDS, None),
}
"""Files made from nothing, of driven mechanisms, of those that are let go and of those with elastic
links, and shipped files with something done to them: with which commands they are tried, in a
fraction of the time and in all, and how they are made."""


def try_files(bench: Bench, kind: str, number: int, count: int, *, quickly: bool = False) -> None:
    """Files of a kind; of those from nothing the smallest that fails is shown."""
    quick, every, made = KINDS[kind]
    commands = quick if quickly else every
    if kind == "changed":
        for one in range(number, number + count):
            raw = mutant(one)
            command = fuzzing.fitting(raw, commands[one % len(commands)])
            faults = bench.try_out(raw, command)
            assert not faults, f"{faults}: {command} of mutant({one}):\n{raw[:3000]!r}"
        return

    @seed(number)
    @settings(
        max_examples=count,
        database=None,
        deadline=None,
        phases=[Phase.generate, Phase.shrink],
        suppress_health_check=list(HealthCheck),
    )
    @given(scene_files(made), st.sampled_from(commands))
    def holds(text: str, command: str) -> None:
        faults = bench.try_out(text.encode(), command)
        assert not faults, f"{faults}: {command} of seed {number}:\n{text[:3000]}"

    holds()


def test_every_file_runs_or_is_refused_with_a_message() -> None:
    bench = Bench(Here(LIMITS))
    for kind, count in QUICKLY.items():
        try_files(bench, kind, SEED, count, quickly=True)
    total = sum(QUICKLY.values())
    assert sum(bench.ends[f"exit {code}"] for code in (0, 1, 2)) >= total
    assert bench.ends["exit 0"] > 0.1 * total, bench.ends
    assert bench.ends["exit 2"] > 0.2 * total, bench.ends


@pytest.mark.parametrize(("part", "count"), [
    slowly(0, 50, reason="every command and not the short ones alone: 10 to 30 s a kind"),
    *(
        at_length(part, EACH, reason="ten thousand files find rare ones")
        for part in range(PARTS)
    ),
])  # fmt: skip
@pytest.mark.parametrize("kind", KINDS)
def test_ten_thousand_files_run_or_are_refused(
    kind: str, part: int, count: int, bench: Bench
) -> None:
    try_files(bench, kind, 1_000_000 + part * EACH, count)
    assert bench.ends["exit 0"] > 0.1 * count, bench.ends


@pytest.mark.parametrize(("part", "parts"), [
    slowly(3, 240, reason="a few of fifteen thousand: 20 s"),
    *(
        at_length(part, 4, reason="each name, each number: fifteen thousand")
        for part in range(4)
    ),
])  # fmt: skip
@pytest.mark.parametrize(
    ("changed", "commands"),
    [
        (retied, ("solve FILE", fuzzing.VERIFY, "view FILE -o OUT.png")),
        (stretched, (fuzzing.VERIFY,)),
    ],
)
def test_each_name_and_each_number_in_place_of_another(
    changed: Callable[[], Iterator[tuple[str, bytes]]],
    commands: tuple[str, ...],
    part: int,
    parts: int,
    bench: Bench,
) -> None:
    for done, raw in itertools.islice(changed(), part, None, parts):
        for command in dict.fromkeys(fuzzing.fitting(raw, each) for each in commands):
            faults = bench.try_out(raw, command)
            assert not faults, f"{faults}: {command} of {done}"
    assert bench.ends["exit 0"] > 120 / parts, bench.ends


def rods_and_rockers(count: int) -> bytes:
    """A crank with as many rods and rockers, all in its pin."""
    lines = ['name = "many"', 'source = "a test"', "ground.points.A = [0.0, 0.0]"]
    lines += ['driver = { link = "crank", speed_rad_s = 10.0 }']
    lines += ['links.crank = { bar = ["A", "B"], length_m = 0.05 }']
    for k in range(count):
        lines += [f"ground.points.D{k} = [0.3, {1e-3 * k}]"]
        lines += [f'links.rod{k} = {{ bar = ["B", "C{k}"], length_m = 0.3 }}']
        lines += [f'links.rocker{k} = {{ bar = ["D{k}", "C{k}"], length_m = 0.2 }}']
    return "\n".join(lines).encode()


@pytest.mark.parametrize("count", [1, slowly(6, reason="fifty links at most, as of eight: 2 s")])
def test_the_calls_for_a_crank_with_many_rods_grow_as_the_rods_do(count: int) -> None:
    """What twice as many add is twice what the others added; by their square it were four times."""
    asked = ("solve", "FILE", "--at-deg", "90")
    fuzzing.attempt(rods_and_rockers(1), *asked)  # all is imported then
    ended = [fuzzing.attempt(rods_and_rockers(k * count), *asked, counted=True) for k in (1, 2, 4)]
    assert {(one.code, *one.faults) for one in ended} == {(0,)}
    calls = [one.calls for one in ended]
    assert calls[2] - calls[1] < 2.5 * (calls[1] - calls[0])


MISDEEDS: dict[str, tuple[Callable[[], object], str]] = {
    "raises": (lambda: 1 / 0, "escaped: ZeroDivisionError"),
    "warns": (lambda: np.zeros(1) / 0.0, "warning: .* invalid value"),
    "clears the screen": (lambda: typer.echo("\x1b[2J"), r"acts: '\\x1b'"),
    "writes beside": (lambda: Path("beside").write_text("x"), "wrote work/beside"),
    "writes at home": (lambda: HOME.write_text("x"), f"wrote {HOME}"),
    "says nothing": (lambda: sys.exit(2), "exit code 2 without a message"),
}


@pytest.mark.parametrize("name", MISDEEDS)
def test_a_misdeed_is_seen(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    misdeed, fault = MISDEEDS[name]
    monkeypatch.setattr(fuzzing, "_command", lambda: lambda _: misdeed())
    try:
        faults = fuzzing.attempt(b"").faults
    finally:
        HOME.unlink(missing_ok=True)
    assert any(re.search(fault, one) for one in faults), faults
