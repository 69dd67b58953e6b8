"""Errors of a hard run over time, apart from their grading."""

import math
from dataclasses import dataclass

import numpy as np

from analytic.kinematics import nearness
from models.array import Array
from models.motion import Motion
from models.scene import Scene
from models.scene.joints import joints
from reports.compare.branch import HERE_RAD, departure
from reports.compare.compare import Truth, incomplete
from reports.compare.errors import Departure
from reports.compare.tracks import length
from sim.engine import Run


@dataclass(frozen=True)
class ErrorSeries:
    """A run beside the reference, sample by sample (T,).

    ``place`` is the worst error of any link, slider and point, ``gap`` the widest open joint,
    ``drive`` the error of the crank, all as pure numbers (rad, lengths over the longest link) and
    infinite where a number is missing; ``drive`` is NaN where nothing commands the crank. ``crank``
    is its logged angle [rad]. ``settled`` is the first sample that counts, and ``incomplete`` names
    commanded samples or gaps that the log lacks. ``limited`` says that ``place`` is the crank's,
    against a command that ends at a limit, and ``worst_of_place`` names the quantity of the largest
    error of place. ``driver_unit`` is m where a slider is driven: ``driver_rad`` and ``crank`` are
    its displacements [m] then.
    """

    status: str
    reason: str
    time_s: Array
    driver_rad: Array
    place: Array
    gap: Array
    drive: Array
    crank: Array
    period_s: float
    sine: float
    settled: int = 0
    departure: Departure | None = None
    incomplete: str = ""
    limited: bool = False
    worst_of_place: str = "a place"
    driver_unit: str = "rad"

    @property
    def turn(self) -> Array:
        """Number of elapsed periods."""
        return np.asarray((self.time_s - self.time_s[0]) / self.period_s)

    @property
    def slides(self) -> bool:
        """True if a slider is driven."""
        return self.driver_unit == "m"

    @property
    def driver(self) -> str:
        """Driven body, in words."""
        return "the slider" if self.slides else "the crank"

    @property
    def driven(self) -> bool:
        """True if anything commands the crank."""
        return not bool(np.isnan(self.drive).all())

    @property
    def per_turn(self) -> str:
        """Unit of a growth per period, in words."""
        return "a turn" if self.driven else f"in {self.period_s:.3g} s"

    def worst(self, series: Array) -> tuple[float, int]:
        """Return the largest number of a series that counts, and its sample."""
        index = self.settled + int(np.argmax(series[self.settled :]))
        return float(series[index]), index

    def first(self, series: Array, over: float) -> int:
        """Return the first sample that counts with a series over a number; the last if none."""
        samples = np.flatnonzero(series[self.settled :] > over)
        return self.settled + int(samples[0]) if samples.size else len(series) - 1


def error_series(scene: Scene, run: Run, settled_turns: float = 0.0) -> ErrorSeries:
    """Return a run that logged something beside the reference.

    Raises CrankcheckError where the scene has no reference at the times of the run.
    """
    beside = Truth(scene, bound=False).beside(run)
    assert beside is not None
    time_s, driver = beside.motion.time_s, beside.driver_rad
    with np.errstate(over="ignore", invalid="ignore"):  # runs that came apart are judged
        place = widest([length(track.error) / track.scale for track in beside.places], driver)
        gap = widest([np.abs(gap) / scene.longest_m for gap in run.gaps.values()], driver)
        drive = widest([beside.drive], driver)
    period = scene.driver.law.period_s
    first = int(np.searchsorted(time_s, time_s[0] + settled_turns * period))
    settled = min(first, len(driver) - 1)
    left = departure(beside)
    if place[settled:].max() < HERE_RAD:
        left = None  # it came back before it counted
    return ErrorSeries(
        status=run.status,
        reason=run.reason,
        time_s=time_s,
        driver_rad=driver,
        place=place,
        gap=gap,
        drive=drive,
        crank=beside.crank,
        period_s=period,
        settled=settled,
        departure=left,
        sine=nearest(scene, beside.reference),
        driver_unit=scene.driver.unit,
        incomplete=lacking(scene, run),
    )


def lacking(scene: Scene, run: Run) -> str:
    """Return the commanded samples, or joints, that the log lacks, in words; "" if none."""
    joined = dict.fromkeys([*(pin.point for pin in joints(scene).pins), *scene.sliders])
    silent = [name for name in joined if name not in run.gaps]
    return incomplete(run) or (f"no gap of {', '.join(silent)} in the log" if silent else "")


def nearest(scene: Scene, reference: Motion) -> float:
    """Return how near a motion comes to a singular position (`nearness`); 1 without a dyad."""
    sines = nearness(scene, reference).values()
    return min((float(np.min(each)) for each in sines), default=1.0)


def worst_of(series: Array) -> Array:
    """Return the series with NaN replaced by infinity."""
    return np.where(np.isnan(series), math.inf, series)


def widest(series: list[Array], like: Array) -> Array:
    """Return the largest of several series at each sample, infinite where one is not a number."""
    if not series:
        return np.zeros_like(like)
    return worst_of(np.max([np.abs(one) for one in series], axis=0))
