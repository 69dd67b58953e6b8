"""Stepping and logging: every way to step a session gives the same result."""

import ctypes
import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout, suppress
from pathlib import Path

import numpy as np

from reports.contract.subject import Subject, apart, clause, numbers
from sim.run import stretch

TURNS = 2.2
"""Turns of the driver, for angles over whole turns."""


@clause(
    "EC31",
    "step, record and read reach the same state",
    "Errors come from record and times from step: both have to be of the same motion.",
    "Let record call the function that step calls, and read return the state of the last sample.",
)
def _step_and_record(subject: Subject) -> Iterator[str]:
    for profile in subject.engine.profiles:
        stepped, recorded = subject.opened(profile), subject.opened(profile)
        stepped.step(60)
        log = recorded.record(60, 1)
        if (off := apart(stepped.read(), recorded.read())) > subject.rounding:
            yield f"profile {profile}: after 60 steps step and record differ by {off:.2g}"
        last = stretch(log.poses, slice(-1, None))
        if (off := apart(last, recorded.read())) > subject.rounding:
            yield f"profile {profile}: the last sample and the state of read differ by {off:.2g}"


@clause(
    "EC32",
    "a log holds the current sample and every n-th after it",
    "Samples are compared with the reference at k dt: one too many, or too late, is an error of "
    "place.",
    "Log before the first step and after every n-th: steps // every + 1 samples, at start + k dt.",
)
def _every_nth(subject: Subject) -> Iterator[str]:
    full, thin = subject.opened().record(40, 1), subject.opened().record(40, 8)
    for log, every in ((full, 1), (thin, 8)):
        wanted = subject.start.time_s + subject.dt_s() * np.arange(0.0, 41.0, every)
        times = log.poses.time_s
        if times.shape != wanted.shape or not np.allclose(times, wanted, rtol=1e-12, atol=0.0):
            yield f"record(40, {every}) has samples at {_few(times)}, not {_few(wanted)} s"
            return
        if log.steps_done != 40 or log.diverged:
            yield (
                f"record(40, {every}) reports {log.steps_done} steps done, diverged {log.diverged}"
            )
        if not log.wall_s > 0.0:
            yield f"record(40, {every}) took {log.wall_s} s"
    if (off := apart(thin.poses, stretch(full.poses, slice(None, None, 8)))) > subject.rounding:
        yield f"logged every 8th step, the samples differ by {off:.2g} of the largest number"


def _few(times: np.ndarray) -> str:
    return ", ".join(f"{time:.4g}" for time in times[:3]) + f", ... ({len(times)} of them)"


@clause(
    "EC33",
    "two recordings in a row equal one",
    "Long runs are recorded in parts.",
    "Keep all state in the session: the number of steps done, and the start values of solvers.",
)
def _stretches(subject: Subject) -> Iterator[str]:
    for profile in subject.engine.profiles:
        whole, parts = subject.opened(profile), subject.opened(profile)
        one = whole.record(50, 1)
        parts.record(20, 1)
        two = parts.record(30, 1)
        rest = stretch(one.poses, slice(20, None))
        if not np.allclose(two.poses.time_s, rest.time_s, rtol=1e-12, atol=0.0):
            yield f"profile {profile}: the second begins at {two.poses.time_s[0]:.6g} s, not " + (
                f"{rest.time_s[0]:.6g} s"
            )
        elif (off := apart(rest, two.poses)) > subject.rounding:
            yield f"profile {profile}: 20 and 30 steps differ from 50 by {off:.2g}"


@clause(
    "EC34",
    "logged numbers do not change afterwards",
    "Arrays that the session still writes to change a finished result.",
    "Hand out copies.",
    of_scenes=False,
)
def _kept(subject: Subject) -> Iterator[str]:
    session = subject.opened()
    log, now = session.record(10, 1).poses, session.read()
    before = numbers(log).copy(), numbers(now).copy()
    session.step(10)
    session.read()
    for what, poses, was in (("record", log, before[0]), ("read", now, before[1])):
        if not np.array_equal(numbers(poses), was, equal_nan=True):
            yield f"the result of {what} changes while the session continues"


@clause(
    "EC35",
    "two sessions side by side do not disturb each other",
    "Runs at a step, its half and its quarter, and their timing, use sessions of their own.",
    "Keep nothing in the module or the class that a step changes.",
    of_scenes=False,
)
def _side_by_side(subject: Subject) -> Iterator[str]:
    alone = subject.opened().record(30, 1).poses
    a, b = subject.opened(), subject.opened()
    first = a.record(15, 1).poses
    b.record(30, 1)
    second = a.record(15, 1).poses
    for part, cut in ((first, slice(0, 16)), (second, slice(15, 31))):
        if (off := apart(stretch(alone, cut), part)) > subject.rounding:
            yield f"with another session beside it, it differs by {off:.2g}"
            return


@clause(
    "EC36",
    "the same input gives the same numbers, to the last bit",
    "A result that can not be repeated can not be compared.",
    "Seed random numbers, and keep the order of bodies and joints.",
)
def _twice(subject: Subject) -> Iterator[str]:
    for profile in subject.engine.profiles:
        one, other = (subject.opened(profile).record(100, 1).poses for _ in range(2))
        if not np.array_equal(numbers(one), numbers(other), equal_nan=True):
            yield f"profile {profile}: two runs of 100 steps differ by {apart(one, other):.2g}"


@clause(
    "EC37",
    "angles continue over whole turns",
    "A wrapped angle jumps by 2 pi, and is a turn behind.",
    "Report the angle as it is integrated, or add the turns.",
)
def _turns(subject: Subject) -> Iterator[str]:
    scene = subject.scene
    steps = round(TURNS * 600)
    log = subject.opened().record(steps, 1).poses
    turned = scene.driver.law.at(log.time_s)[0]
    off = float(np.abs(log.bodies[scene.driver.link].theta - turned).max())
    if not off < 1.0:
        yield f"the crank is off by {off:.3g} rad over {TURNS} turns; count whole turns"
    for name, body in log.bodies.items():
        jump = float(np.abs(np.diff(body.theta)).max())
        if not jump < 1.0:
            yield f"{name} jumps by {jump:.3g} rad from one sample to the next"


@clause(
    "EC38",
    "a session writes nothing to the terminal, nor into the working folder",
    "Ninety thousand warnings hide the one line that counts.",
    "Silence the engine, and pass its warnings on in Log.warnings.",
    of_scenes=False,
)
def _quiet(subject: Subject) -> Iterator[str]:
    with _listening() as (words, files):
        session = subject.opened()
        session.facts()
        session.step(50)
        session.record(50, 5)
        session.read()
    if words:
        text = words[0].decode(errors="replace").strip()
        yield f"it writes to the terminal: {text.partition(chr(10))[0][:100]!r}"
    if files:
        yield f"it leaves files in the working folder: {', '.join(sorted(files)[:5])}"


@contextmanager
def _listening() -> Iterator[tuple[list[bytes], list[str]]]:
    """Yield lists of output to the terminal, by Python or below it, and of files in the working
    folder; both are filled at the end."""
    words, files, home = list[bytes](), list[str](), Path.cwd()
    _flush()
    before = os.dup(1), os.dup(2)
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryFile() as heard:
        os.chdir(folder)
        os.dup2(heard.fileno(), 1)
        os.dup2(heard.fileno(), 2)
        spoken = open(os.dup(heard.fileno()), "w", encoding="utf-8")  # noqa: PTH123, SIM115 - of a number
        try:
            with spoken, redirect_stdout(spoken), redirect_stderr(spoken):
                yield words, files
        finally:
            _flush()
            os.dup2(before[0], 1)
            os.dup2(before[1], 2)
            for number in before:
                os.close(number)
            os.chdir(home)
            heard.seek(0)
            words += [text] if (text := heard.read()) else []
            files += [path.name for path in Path(folder).iterdir()]


def _flush() -> None:
    """Write out all buffered text, in Python and in the C library."""
    for stream in (sys.stdout, sys.stderr):
        with suppress(ValueError, OSError, AttributeError):
            stream.flush()
    with suppress(OSError, AttributeError, TypeError):
        ctypes.CDLL(None).fflush(None)
