"""A log at one of its samples, beside the reference at the same commanded time.

The sample is the nearest to the angle of the driver, as its law or its free motion has it, of the
last time that the log passes it; or the nearest to a time. The reference is drawn of that sample's
time, so that nothing is interpolated, and what is off is the log's alone.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from analytic.lectures.drawings.placed_mechanism import PlacedMechanism
from analytic.lectures.drawings.polygon import Quantity
from models.array import Array
from models.errors import CrankcheckError, few
from models.motion import Motion, Order
from models.scene import Scene
from reports.compare.beside import Truth
from reports.compare.series import rate, second_rate
from reports.describe.facts import angle_at
from reports.lectures.drawing.sheets.sheet_log import SheetLog
from reports.logs.channel import OwnLog, Reading
from reports.logs.log_beside import EVEN
from reports.logs.logged_motion import logged_motion
from reports.logs.map_file import Map

REPORTED, DIFFERENCED = "as the log reports them", "by central differences of logged positions"
ORDER_OF: Mapping[Quantity, Order] = {"velocity": 1, "acceleration": 2}


@dataclass(frozen=True)
class LoggedInstant:
    """What a log of a name is off by in one sample.

    ``placement`` is the reference at its time [s]; ``places`` are the errors of points [m], (2,)
    each; ``rates`` those of the ends of their vectors [m/s, m/s^2]. ``ways`` says where these come
    from; ``missing`` names the points that the log does not say enough of; ``passes`` is how often
    the log passes the angle that was asked for.
    """

    source: str
    time_s: float
    placement: PlacedMechanism
    places: Mapping[str, Array]
    rates: Mapping[Quantity, Mapping[str, Array]]
    ways: Mapping[Quantity, str]
    missing: tuple[str, ...] = ()
    passes: int = 1

    @property
    def taken(self) -> str:
        """Which of several passes of an angle it is, in words that follow the name of the log."""
        return f" (the last of {self.passes} passes)" if self.passes > 1 else ""


@dataclass(frozen=True)
class LogInstants:
    """A log that instants are looked for in, the truth beside it, and the driver's angle by that at
    every sample [rad], (T,)."""

    log: OwnLog
    truth: Truth
    driver_rad: Array

    @staticmethod
    def of_file(scene: Scene, path: Path, map_: Map) -> LogInstants:
        """A file, read as `judge` does. Raises CrankcheckError for what is no log of the scene."""
        return LogInstants._of(SheetLog.of_file(scene, path, map_, "polygons"))

    @staticmethod
    def of_log(log: OwnLog) -> LogInstants:
        """A log that was read. Raises CrankcheckError as `SheetLog.of_log`."""
        return LogInstants._of(SheetLog.of_log(log))

    @staticmethod
    def _of(beside: SheetLog) -> LogInstants:
        log, driver = beside.log, beside.log.scene.driver
        if log.scene.is_free:
            angle = beside.truth.at(log.time_s).links[driver.link].theta
        else:
            angle = driver.law.at(log.time_s)[0]
        return LogInstants(log, beside.truth, angle)

    def at_angle(self, at_deg: float) -> LoggedInstant:
        """At the sample that is nearest to an angle of the driver [deg], when it passes it for the
        last time with rows before and after. Raises CrankcheckError where it does not."""
        off = (self.driver_rad - angle_at(at_deg) + math.pi) % math.tau - math.pi
        near = np.abs(off) < math.pi / 2
        before = np.flatnonzero((off[:-1] * off[1:] <= 0.0) & near[:-1] & near[1:])
        rows = before + (np.abs(off[before + 1]) < np.abs(off[before]))
        within = rows[(rows > 0) & (rows < off.size - 1)]
        if rows.size:
            rows = np.unique(within if within.size else rows)  # one on the angle ends two parts
            return replace(self._at(int(rows[-1])), passes=rows.size)
        low, high = (
            round(math.degrees(each), 9) for each in (self.driver_rad.min(), self.driver_rad.max())
        )
        raise CrankcheckError(
            f"--at-deg {at_deg:g}: {self.log.source} does not pass it; in its "
            f"{self.log.time_s.size} rows {self.log.scene.driver.link} goes from {low:.6g} to "
            f"{high:.6g} deg"
        )

    def at_time(self, at_s: float) -> LoggedInstant:
        """At the sample that is nearest to a time [s]. Raises CrankcheckError for one that is not
        in the log."""
        time_s = self.log.time_s
        row = int(np.argmin(np.abs(time_s - at_s)))
        if not abs(time_s[row] - at_s) <= np.diff(time_s).max() / 2:  # or no number
            raise CrankcheckError(
                f"--at-s {at_s:g}: {self.log.source} goes from {time_s[0]:.6g} to "
                f"{time_s[-1]:.6g} s"
            )
        return self._at(row)

    def _at(self, row: int) -> LoggedInstant:
        """What is off in a row. Raises CrankcheckError where nothing can be drawn of it."""
        log, rows = self.log, slice(max(row - 1, 0), row + 2)
        places = self._errors(0, rows)
        here = row - rows.start
        rates, ways = {}, {}
        for quantity, order in ORDER_OF.items():
            errors = {name: each[here] for name, each in self._errors(order, rows).items()}
            ways[quantity] = REPORTED
            if not errors:
                errors = _differenced(places, log.time_s[rows], order)
                ways[quantity] = DIFFERENCED
            rates[quantity] = errors
        moving = [name for name in _points(log.scene) if name not in log.scene.ground]
        drawn = rates["velocity"].keys() | rates["acceleration"].keys()
        if not drawn:
            raise CrankcheckError(self._too_little(row, moving))
        return LoggedInstant(
            log.source,
            float(log.time_s[row]),
            PlacedMechanism.standing(log.scene, self.truth.at(log.time_s[row : row + 1])),
            {name: each[here] for name, each in places.items()},
            rates,
            ways,
            tuple(name for name in moving if any(name not in each for each in rates.values())),
        )

    def _errors(self, order: Order, rows: slice) -> dict[str, Array]:
        """What places or rates of points are off by in some rows, (n, 2) each, of those that the
        log has both coordinates of."""
        each_of: dict[str, set[int | None]] = {}
        for reading in self.log.readings:
            channel = reading.channel
            if channel.kind.body_kind == "point" and channel.kind.order == order:
                each_of.setdefault(channel.of, set()).add(channel.kind.axis)
        whole = [name for name in _points(self.log.scene) if each_of.get(name) == {0, 1}]
        kept = [
            Reading(each.channel, each.values[rows], each.instants[rows])
            for each in self.log.readings
            if each.channel.kind.body_kind == "point"
            and each.channel.kind.order == order
            and each.channel.of in whole
        ]
        if not kept:
            return {}
        part = replace(self.log, time_s=self.log.time_s[rows], readings=tuple(kept))
        true = self.truth.at(part.time_s)
        moved = logged_motion(part, lambda _: true, lambda reading: reading.error(self.truth))
        return {name: _vectors(moved, name, order) - _vectors(true, name, order) for name in whole}

    def _too_little(self, row: int, moving: list[str]) -> str:
        held = few((each.channel.name for each in self.log.readings), 6)
        if row in (0, self.log.time_s.size - 1) and self._errors(0, slice(row, row + 1)):
            return (
                f"{self.log.source}: it reports no rates of points, and its row at t = "
                f"{self.log.time_s[row]:.6g} s has no neighbours on both sides to take "
                "differences with; name an instant within the log"
            )
        return (
            f"{self.log.source}: polygons need both coordinates of points that move "
            f"({few(moving, 6)}), or of their velocities and accelerations; it holds {held}"
        )


def _points(scene: Scene) -> dict[str, None]:
    """The points of a scene that a log can tell of."""
    return dict.fromkeys([*scene.pins, *(slider.point for slider in scene.sliders.values())])


def _vectors(motion: Motion, name: str, order: Order) -> Array:
    """Places or rates of a point (T, 2)."""
    point = motion.points[name]
    return (point.position, point.velocity, point.acceleration)[order]


def _differenced(places: Mapping[str, Array], time_s: Array, order: Order) -> dict[str, Array]:
    """Rates of errors of places by three rows, as `reports.compare` has them; none at the ends of a
    log, or where its rows are not even."""
    steps = np.diff(time_s)
    if steps.size < 2 or np.ptp(steps) > EVEN * steps.max():
        return {}
    step_s = float(steps.mean())
    difference = rate if order == 1 else second_rate
    return {name: difference(each, step_s)[0] for name, each in places.items()}
