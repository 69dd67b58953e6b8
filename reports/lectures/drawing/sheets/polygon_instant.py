"""The instant of polygons: by the angle of the driver, or by the time.

In a log it is the sample nearest to the angle, by the driver's law or its free motion, when the log
passes it for the last time; or nearest to the time. The reference is drawn at that sample's time,
so that nothing is interpolated, and all errors are the log's.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from analytic.lectures.drawings.polygon import DriverState, PlacedMechanism, Quantity
from models.array import Array
from models.errors import CrankcheckError, few
from models.motion import Motion, Order
from models.scene import Scene
from models.scene.laws import Oscillating
from reports.compare.compare import Truth
from reports.compare.free_truth import LOOK, kept_motion
from reports.compare.tracks import rate, second_rate
from reports.describe.facts import angle_at, driver_at, time_at
from reports.drawing.shape import true_motion
from reports.lectures.drawing.sheets.graph_drawing import SheetLog
from reports.lectures.drawing.sheets.graph_span import refuse_released_elastic
from reports.logs.channel import OwnLog, Reading, logged_motion
from reports.logs.log_beside import EVEN

AT_DEG = 90.0
"""Default angle of the driver [deg]."""
LARGEST = 1e9
"""Largest speed [rad/s] that a user may name; its inverse is the smallest."""
MOST_PERIODS = 10.0
"""Longest time of free motion, in durations of the scene: it takes seconds to integrate."""
REST = 1e-12
"""Share of the root of the acceleration below which a speed [rad/s] is rounding."""


def placed_at_angle(
    scene: Scene, at_deg: float = AT_DEG, omega: float | None = None
) -> PlacedMechanism:
    """The mechanism with its driver at an angle [deg], with the speed of its law there, or with
    ``omega`` [rad/s], which is constant.

    Raises CrankcheckError for an angle that it never has, and for free motion without a speed.
    """
    if omega is not None:
        if not 1 / LARGEST <= abs(omega) <= LARGEST:  # or no number
            raise CrankcheckError(
                f"--omega {omega:g}: give a speed other than 0 in rad/s, from {1 / LARGEST:g} to "
                f"{LARGEST:g} either way; at rest there is nothing to draw"
            )
        return PlacedMechanism.of(scene, DriverState(angle_at(at_deg), omega))
    if scene.is_free:
        raise CrankcheckError(
            f"{scene.name}: its driver is in free motion, and no law gives its speed at "
            f"{at_deg:g} deg; give --at-s for an instant of its motion, or --omega"
        )
    return PlacedMechanism.of(scene, DriverState(*driver_at(scene, at_deg)))


def placed_at_time(scene: Scene, at_s: float) -> PlacedMechanism:
    """The mechanism at a time [s], by its driver's law, or in free motion by masses and forces.
    Raises CrankcheckError for a time at which it is at rest."""
    motion = _motion_at(scene, time_at(scene, at_s))
    placed = PlacedMechanism.standing(scene, motion)
    driver = placed.driver
    if abs(driver.omega) < REST * math.sqrt(abs(driver.alpha)):  # released from rest
        placed = replace(placed, driver=replace(driver, omega=0.0))
    if not (placed.driver.omega or placed.driver.alpha):
        turns = "swings" if isinstance(scene.driver.law, Oscillating) else "moves"
        raise CrankcheckError(
            f"--at-s {at_s:g}: {scene.driver.link} of {scene.name} is at rest there, and there is "
            f"nothing to draw; give a time at which it {turns}"
        )
    return placed


def _motion_at(scene: Scene, time_s: float) -> Motion:
    """The motion at one instant [s]; free motion is integrated over a part of its duration at
    least, as it begins at 0."""
    if not scene.is_free:
        return true_motion(scene, np.array([time_s]))
    omega = "name an --omega, with which links are drawn as rigid"
    refuse_released_elastic(scene, "polygons", f"take [elastic] out of the scene, or {omega}")
    own_s = scene.driver.law.period_s
    if time_s > MOST_PERIODS * own_s:
        raise CrankcheckError(
            f"--at-s {time_s:g}: the free motion of {scene.name} from t = 0 to there takes too "
            f"long to compute; give a time up to {MOST_PERIODS * own_s:.6g} s, {MOST_PERIODS:g} "
            "times its own duration"
        )
    lasts_s = max(time_s, LOOK * own_s)
    return kept_motion(scene, lasts_s).at(np.array([time_s]), bound=False)


REPORTED, DIFFERENCED = "as the log reports them", "by central differences of logged positions"
ORDER_OF: Mapping[Quantity, Order] = {"velocity": 1, "acceleration": 2}


@dataclass(frozen=True)
class LoggedInstant:
    """Errors of a log in one sample.

    ``placement`` is the reference at its time [s]; ``places`` are the errors of points [m], (2,)
    each; ``rates`` those of the ends of their vectors [m/s, m/s^2]. ``ways`` says where these come
    from; ``missing`` names the points with too few readings; ``passes`` counts the passes of the
    requested angle.
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
        """The pass of the angle, if there are several, in words that follow the name of the log."""
        return f" (the last of {self.passes} passes)" if self.passes > 1 else ""


@dataclass(frozen=True)
class LogInstants:
    """A log with its reference, and the driver's angle by that at every sample [rad], (T,)."""

    log: OwnLog
    truth: Truth
    driver_rad: Array

    @staticmethod
    def of(beside: SheetLog) -> LogInstants:
        return LogInstants(beside.log, beside.truth, beside.driver_rad(beside.log.time_s))

    def at_angle(self, at_deg: float) -> LoggedInstant:
        """Errors at the sample nearest to an angle of the driver [deg], at the last pass with rows
        before and after. Raises CrankcheckError where there is no pass."""
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
        """Errors at the sample nearest to a time [s]. Raises CrankcheckError off the log."""
        time_s = self.log.time_s
        row = int(np.argmin(np.abs(time_s - at_s)))
        if not abs(time_s[row] - at_s) <= np.diff(time_s).max() / 2:  # or no number
            raise CrankcheckError(
                f"--at-s {at_s:g}: {self.log.source} goes from {time_s[0]:.6g} to "
                f"{time_s[-1]:.6g} s"
            )
        return self._at(row)

    def _at(self, row: int) -> LoggedInstant:
        """Errors in a row. Raises CrankcheckError where none can be drawn."""
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
        """Errors of places or rates of points in some rows, (n, 2) each, for points with both
        coordinates in the log."""
        axes: dict[str, set[int | None]] = {name: set() for name in _points(self.log.scene)}
        readings = []
        for each in self.log.readings:
            kind, point = each.channel.kind, each.channel.of
            if kind.body_kind == "point" and kind.order == order and point in axes:
                axes[point].add(kind.axis)
                readings.append(Reading(each.channel, each.values[rows], each.instants[rows]))
        whole = [name for name, own in axes.items() if own == {0, 1}]
        kept = [each for each in readings if each.channel.of in whole]
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
    """The points of a scene that a log can have."""
    return dict.fromkeys([*scene.pins, *(slider.point for slider in scene.sliders.values())])


def _vectors(motion: Motion, name: str, order: Order) -> Array:
    """Places or rates of a point (T, 2)."""
    point = motion.points[name]
    return (point.position, point.velocity, point.acceleration)[order]


def _differenced(places: Mapping[str, Array], time_s: Array, order: Order) -> dict[str, Array]:
    """Rates of errors of places by three rows, as in `reports.compare`; none at the ends of a log,
    or where its rows are not even."""
    steps = np.diff(time_s)
    if steps.size < 2 or np.ptp(steps) > EVEN * steps.max():
        return {}
    step_s = float(steps.mean())
    difference = rate if order == 1 else second_rate
    return {name: difference(each, step_s)[0] for name, each in places.items()}
