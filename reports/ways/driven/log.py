"""Logs of scenes whose driver follows a law."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.scene import Scene
from reports.causes.cause import Cause, Excerpt, LogCase
from reports.causes.find import causes
from reports.compare.compare import Truth
from reports.compare.errors import Error, Errors, largest
from reports.logs.channel import Channel, OwnLog
from reports.logs.log_beside import AtCrank, LogBeside
from reports.output.numbers import error_text, listed
from reports.own_log.drives import DriveFit, truth_of_log
from reports.own_log.judged import column_text
from reports.own_log.log_limits import HeldLog, LogRequest, limits_by_column
from reports.quantities import named
from sim.engine import Run

NO_FIT = (
    "no speed and start of the driver explain the places: errors are measured against the nearest "
    "fit; log the driver's angle, or use --drive scene"
)


class DrivenLog:
    """Logs of driven scenes with rigid links."""

    truth_name = "closed form"
    no_cause = "no known cause explains {}"
    driver_angle = "drive"

    def truth(self, log: OwnLog, request: LogRequest) -> tuple[OwnLog, Truth, DriveFit | None]:
        return log, *truth_of_log(log, request.drive)

    def beside(self, log: OwnLog, truth: Truth, run: Run) -> LogBeside:
        assert run.motion is not None
        alone = isinstance(truth, AtCrank)
        return LogBeside(truth, run, run.motion, step_s=run.dt_s, geometry_alone=alone)

    def judged_as(self, scene: Scene, channel: Channel) -> tuple[str, ...]:
        driver, of = scene.driver, (channel.kind.name, channel.of)
        drives = [("displacement", driver.slider), *[("angle", driver.link)] * driver.is_crank]
        return ("drive",) if of in drives else (channel.kind.quantity,)

    def explained(self, held: HeldLog) -> tuple[Sequence[Cause], Sequence[str]]:
        if held.fit is not None and not held.fit.explains:
            return (), (NO_FIT,)
        case = LogCase(held.log, held.truth, limits_by_column(held.log, held.evidence, held.errors))
        found = causes(case)
        return found, (*seldom(case), *of_no_cause(case, found, held.errors))


LOG = DrivenLog()


SHOWN = 3
"""Most columns whose errors are described."""
HARMONICS = 3
LEAST_TURNS, LEAST_ROWS = 1.5, 24
"""Harmonics of an error that repeats every turn, and the least turns and rows to find them."""
TOLD = 0.1
"""Least part of an error, by the mean square, that is described."""
WORDS = ("stays the same", "grows or falls linearly", "repeats every turn", "has another shape")
SMALL, MOST = 0.1, 0.7
"""Limits of the part of an error that remains at the logged angle: little of it, most of it."""


def of_no_cause(case: LogCase, causes: Sequence[Cause], errors: Errors) -> tuple[str, ...]:
    """Sentences on errors without a cause: one on the drive, the geometry and the joints, and one
    on the course of the largest errors by column, places first. Raises CrankcheckError where the
    scene has no reference."""
    told = {column for cause in causes for column in cause.columns}
    left = [
        excerpt
        for column, excerpt in case.excerpts.items()
        if excerpt.out and column not in told and excerpt.limit > 0.0
    ]
    if not left:
        return ()
    left.sort(key=lambda each: (each.channel.kind.order, -each.worst / each.limit))
    shapes = [text for each in left[:SHOWN] if (text := _shape(case.truth.scene, each))]
    lines = (f"without a known cause, by the mean square of the error: {'; '.join(shapes)}",)
    parts = _parts(case.truth.scene, left, errors)
    return (*((parts,) if parts else ()), *(lines if shapes else ()))


def seldom(case: LogCase) -> Iterator[str]:
    """Notes on a driver's angle out of tolerance that turns by half a turn or more per row."""
    scene, time_s = case.truth.scene, case.log.time_s
    try:
        angle = scene.driver.law.at(time_s)[0]
    except CrankcheckError:
        return
    turns = float(np.median(np.abs(np.diff(angle)))) / math.tau
    if turns < 0.5 - 1e-9:
        return
    for column, excerpt in case.excerpts.items():
        channel = excerpt.channel
        within = float(np.ptp(excerpt.reading.values)) < math.tau + 1e-2
        if excerpt.out and channel.of == scene.driver.link and channel.kind.turns and within:
            yield (
                f"{column_text(column)}: {channel.of} turns by {turns:.3g} turns from row to row; "
                "an angle wrapped into one turn does not show the whole turns in between; log it "
                "more than twice a turn, or without jumps"
            )


def _parts(scene: Scene, left: Sequence[Excerpt], errors: Errors) -> str:
    """Words on the part of the worst place without a cause that remains at the logged angle of the
    driver, and on the gap of the joints; "" where the log does not show it."""
    bodies = {(each.channel.kind.quantity, each.channel.of) for each in left}
    places = [row for row in errors.rows if row.quantity in named("place")]
    worst = largest(
        row for row in places if row.kind == "total" and (row.quantity, row.body) in bodies
    )
    if worst is None or not worst.finite:
        return ""
    at_crank = next(
        (row for row in places
         if row.kind == "geometric" and (row.quantity, row.body) == (worst.quantity, worst.body)),
        None,
    )  # fmt: skip
    drive, gap = errors.worst("drive"), errors.worst("gap")
    texts = []
    if at_crank is not None and drive is not None:
        texts.append(
            f"{worst.quantity} of {worst.body} is off by {_size(worst)}, and by {_size(at_crank)} "
            f"at the logged angle of {scene.driver.link}, which is off by {_size(drive)}: "
            f"{_verdict(at_crank.maximum / worst.maximum)}"
        )
    if gap is not None and gap.maximum > 0.0:
        texts.append(f"the joint that opens most, {gap.body}, opens by {_size(gap)}")
    return f"without a known cause: {'; '.join(texts)}" if texts else ""


def _verdict(share: float) -> str:
    """The cause, by the part of an error that remains at the logged angle of the driver."""
    if share < SMALL:
        return "the drive is off, and not the geometry"
    return "the drive is not the cause" if share > MOST else "the drive is a part of the cause"


def _shape(scene: Scene, excerpt: Excerpt) -> str:
    """The course of the error of a column, by parts of its mean square; "" for a log too short to
    show it, or an error that is no number."""
    angle = scene.driver.law.at(excerpt.instants)[0]
    size = float(np.max(np.abs(excerpt.error), initial=0.0))
    if excerpt.rows.size < LEAST_ROWS or np.ptp(angle) < LEAST_TURNS * math.tau or not size > 0.0:
        return ""
    shares = _shares(excerpt.instants, angle, excerpt.error / size)
    parts = [
        f"{share:.0%} {word}" for share, word in zip(shares, WORDS, strict=True) if share > TOLD
    ]
    return f"{column_text(excerpt.channel.column)} {listed(parts)}"


def _shares(time_s: Array, angle_rad: Array, error: Array) -> tuple[float, float, float, float]:
    """The parts of the square of an error that a constant, a line, and harmonics of the driver's
    angle take off, one after the other, and the rest."""
    middle = (time_s - time_s.mean()) / max(float(np.ptp(time_s)), np.finfo(float).tiny)
    turns = np.outer(angle_rad, np.arange(1, HARMONICS + 1))
    columns = np.column_stack([np.ones_like(middle), middle, np.cos(turns), np.sin(turns)])
    basis = np.linalg.qr(columns)[0]
    squares = (basis.T @ error) ** 2 / float(error @ error)
    zero, line, again = float(squares[0]), float(squares[1]), float(np.sum(squares[2:]))
    return zero, line, again, max(0.0, 1.0 - zero - line - again)


def _size(error: Error) -> str:
    return f"{error_text(error.maximum)} {error.unit}"
