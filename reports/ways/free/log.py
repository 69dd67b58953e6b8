"""Logs of free motion: their reference, and notes in place of causes."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from models.array import Array
from models.errors import CrankcheckError, few
from models.motion import Motion, Order
from models.scene import Scene
from reports.causes.cause import Cause
from reports.compare.compare import Truth
from reports.compare.errors import Error, Errors
from reports.compare.free_truth import BEYOND, FreeBeside, FreeTruth, free_truth_until
from reports.compare.tracks import Track, tracks
from reports.logs.channel import Channel, OwnLog, Reading, logged_motion
from reports.logs.kinds import KINDS
from reports.logs.log_beside import LogBeside
from reports.output.numbers import error_text, listed, short
from reports.own_log.drives import DriveFit
from reports.own_log.log_limits import EVERY, HeldLog, LogRequest
from reports.plan.requirements import refuse_unreleased
from reports.quantities.free_and_elastic import GEOMETRY
from sim.engine import Run

LEAST_ROWS = 2
MOST_TIMES = 10.0
"""Longest log, in durations of its scene: each second of its reference takes a part of a second to
integrate, or some seconds."""
BEGUN = 1e-3
"""Largest error of a first reading, as a pure number, of a log from the scene's start."""
OPEN, CLOSED = 0.3, 0.03
"""Limits of the part of an error of place that remains at the run's own angle: above the first the
geometry is off, below the second it is not."""
SHOWN = 4
"""Most columns that are named."""


def known_log(log: OwnLog, step_s: float, target: Mapping[str, float]) -> tuple[OwnLog, FreeTruth]:
    """The log as far as its reference is known well enough, and the reference.

    ``target`` has limits as pure numbers by quantity, that of all others under `EVERY`. Raises
    CrankcheckError for times before 0, the start of the free motion, or long after its end; a scene
    that can not move freely; a reference that is lost before the second row.
    """
    scene, lasts_s = log.scene, _lasts_s(log)
    refuse_unreleased(scene, lasts_s)
    phase = target.get("phase", target.get(EVERY))
    truth = free_truth_until(scene, lasts_s, step_s, {} if phase is None else {"phase": phase})
    rows = truth.known(log.time_s)
    if rows < LEAST_ROWS:
        raise CrankcheckError(
            f"{log.source}: at t = {log.time_s[rows]:.4g} s the reference of {scene.name} is "
            "too uncertain for a judgement: a small change of its start has grown too much by "
            "then; log the motion from its start on, or give a wider --target"
        )
    return log.first(rows), truth


def _lasts_s(log: OwnLog) -> float:
    """Duration of the reference. Raises CrankcheckError for times without a reference."""
    scene, time_s = log.scene, log.time_s
    first, last = float(time_s[0]), float(time_s[-1])
    zero = (
        "count the time from there on, or from the first row: zero = 'first' in [time] of the map"
    )
    if first < -1.001 * float(np.max(np.diff(time_s))):
        raise CrankcheckError(
            f"{log.source}: its rows begin at t = {first:.6g} s, and the free motion of "
            f"{scene.name} starts at t = 0; cut the log there, or {zero}"
        )
    if not 0.0 < last <= MOST_TIMES * scene.driver.law.period_s:
        raise CrankcheckError(
            f"{log.source}: its rows end at t = {last:.6g} s, and the free motion of {scene.name} "
            f"lasts from t = 0 for {scene.driver.law.period_s:.6g} s; check the unit of its times, "
            f"and {zero}; a log more than {MOST_TIMES:g} times as long as its scene needs a scene "
            "with a longer duration"
        )
    latest = max(float(each.instants[-1]) for each in log.readings) if log.readings else last
    return last if latest <= BEYOND * last else latest


def told_of_start(log: OwnLog, truth: FreeTruth) -> Iterator[str]:
    """A note on a log that does not begin as the free motion of its scene does."""
    first, sample = float(log.time_s[0]), float(np.min(np.diff(log.time_s)))
    if first > sample:
        yield (
            f"the log begins at t = {first:.6g} s, and the free motion of {log.scene.name} at t = "
            "0: the start of the motion is not in the log"
        )
        return
    off = {
        reading.channel.column: f"{error_text(size)} {unit}"
        for reading in log.readings
        for size, unit, share in (_off_at_start(reading, truth),)
        if not share <= BEGUN
    }
    if off:
        columns = few((f"{name} by {size}" for name, size in off.items()), SHOWN)
        yield (
            f"the log does not begin with the start of {log.scene.name}: {columns} at its first "
            "row; later errors are those of another motion"
        )


def _off_at_start(reading: Reading, truth: FreeTruth) -> tuple[float, str, float]:
    """The error of a reading in its first row, with its unit, and as a pure number; 0 for an
    acceleration, which is no part of a start."""
    kind, scene = reading.channel.kind, truth.scene
    if kind.order == 2:
        return 0.0, "", 0.0
    unit = ("rad" if kind.turns else "m") + ("", "/s")[kind.order]
    scale = 1.0 if kind.turns else scene.longest_m
    scale *= scene.pace_rad_s**kind.order
    size = abs(float(reading.first(1).error(truth)[0]))
    return size, unit, size / scale


def told_of_no_limit(errors: Errors) -> Iterator[str]:
    """A note on logged quantities that have no limit in free motion, for logs and engines alike."""
    own = (row for row in errors.rows if row.source == "reported" and row.kind == "total")
    names = dict.fromkeys(row.quantity for row in own if row.tolerance not in errors.limits)
    if names:
        yield f"no limit in free motion: {listed([f'{name} of bodies' for name in names])}"


def told_apart(errors: Errors) -> Iterator[str]:
    """A note on the source of the errors: the phase has run away, or the linkage has come open."""
    phase, geometry = errors.worst("phase", kind="raw"), errors.worst("geometry")
    if phase is None or geometry is None or not (phase.finite and geometry.finite):
        return
    left = geometry.pure / phase.pure if phase.pure > 0.0 else np.inf
    what = (
        "the geometry is off"
        if left > OPEN
        else "the phase is off, and not the geometry"
        if left < CLOSED
        else "both are off"
    )
    yield (
        f"at the same time {phase.body} is off by {_size(phase)} at most, with a sensitivity of "
        f"{short(errors.of_motion.sensitivity)}; at its own angle {geometry.body} is off by "
        f"{_size(geometry)}: {what}; causes are not searched in free motion"
    )


def _size(error: Error) -> str:
    return f"{error_text(error.maximum)} {error.unit}"


class FreeLog:
    """Logs of free motion with rigid links."""

    truth_name = "free motion"
    no_cause = "of {}: see the notes; causes are not searched in free motion"
    driver_angle = "phase"

    def truth(self, log: OwnLog, request: LogRequest) -> tuple[OwnLog, Truth, DriveFit | None]:
        if request.drive != "scene":
            raise CrankcheckError(
                f"--drive {request.drive}: {log.scene.name} is in free motion, without a drive; "
                "leave --drive out: the geometry at its own angle is judged beside the motion in "
                "time"
            )
        return *known_log(log, request.step_s, request.target), None

    def beside(self, log: OwnLog, truth: Truth, run: Run) -> LogBeside:
        assert isinstance(truth, FreeTruth)
        assert run.motion is not None
        return FreeLogBeside(
            *(truth, run, run.motion),
            step_s=run.dt_s,
            whole_run=run,
            free=truth.free,
            log=log,
            unknown=log.left_out,
        )

    def judged_as(self, scene: Scene, channel: Channel) -> tuple[str, ...]:
        """Quantities of a channel: places at the same time and at the log's own angle."""
        kind = channel.kind
        if kind.order:
            return (kind.quantity,)
        is_phase = (kind.name, channel.of) == ("angle", scene.driver.link)
        return ("phase" if is_phase else kind.quantity, "geometry")

    def explained(self, held: HeldLog) -> tuple[Sequence[Cause], Sequence[str]]:
        assert isinstance(held.truth, FreeTruth)
        apart = told_apart(held.errors) if held.out else ()
        return (), (*told_of_start(held.log, held.truth), *apart, *told_of_no_limit(held.errors))


LOG = FreeLog()


@dataclass(frozen=True)
class FreeLogBeside(LogBeside, FreeBeside):
    """A log as far as its reference is known: ``unknown`` rows after it were left out.

    Geometry is that of the readings alone, without other places of the reference at the same time:
    where the phase has run away, those belong to another position.
    """

    log: OwnLog = field(kw_only=True)
    unknown: int = field(kw_only=True)

    @property
    def left_out(self) -> int:
        return self.unknown

    @property
    def no_geometry(self) -> str:
        driver = self.scene.driver.link
        if not (self.has_crank and self._says("link", driver, "angle")):
            return f"no geometry: the log has no angle of {driver} at the times of its rows"
        truth = self.free
        if truth.driver_tells or self._holds((0,)):
            return ""
        return (
            f"no geometry: the angle of {driver} alone does not determine the pose of "
            f"{self.scene.name}; log the angles of all links, and both coordinates of all moving "
            "points"
        )

    @property
    def tells_momentum(self) -> bool:
        return self._holds((0, 1))

    @cached_property
    def at_crank(self) -> Motion:
        own = self.motion.links
        rest = {name: link for name, link in self.reference.links.items() if name not in own}
        return self.free.beside(replace(self.motion, links={**own, **rest}))

    def tracks(self, quantities: Sequence[str], reference: Motion) -> tuple[Track, ...]:
        if tuple(quantities) != (GEOMETRY.name,):
            return super().tracks(quantities, reference)

        def off(reading: Reading) -> Array:
            return reading.channel.error(reading.values, reading.channel.expected(reference))

        places = [each for each in self._at_rows if each.channel.kind.order == 0]
        log = replace(self.log, readings=tuple(places))
        run = replace(self.run, motion=logged_motion(log, lambda _: reference, off))
        every = tracks(self.scene, run, reference, quantities)
        return tuple(track for track in every if not np.all(np.isnan(track.error)))

    @cached_property
    def _at_rows(self) -> tuple[Reading, ...]:
        """The readings that belong to the times of the rows."""
        own = self.log.time_s
        return tuple(each for each in self.log.readings if np.array_equal(each.instants, own))

    def _says(self, body_kind: str, body: str, *names: str) -> bool:
        """True if there are readings of a body of all these names, not relative to another."""
        held = {
            each.channel.kind.name
            for each in self._at_rows
            if (each.channel.kind.body_kind, each.channel.of) == (body_kind, body)
            and not each.channel.relative_to
        }
        return held.issuperset(names)

    def _holds(self, orders: Sequence[Order]) -> bool:
        """True if the log has all kinds of some orders for every link and every moving point."""
        scene = self.scene
        points = {*scene.pins, *(slider.point for slider in scene.sliders.values())}
        names = {
            body: [
                k.name
                for k in KINDS.values()
                if k.body_kind == body and k.order in orders and not k.is_size
            ]
            for body in ("link", "point")
        }
        return all(self._says("link", link, *names["link"]) for link in scene.links) and all(
            self._says("point", point, *names["point"]) for point in points - {*scene.ground}
        )
