"""What is seen of a hard run: errors over time, apart from how they are judged."""

import math
from dataclasses import dataclass

import numpy as np

from analytic.kinematics import nearness
from models.array import Array
from models.motion import Motion
from models.scene import Scene
from models.scene.joints import joints
from reports.compare.beside import Beside, Truth, incomplete
from reports.compare.branch import HERE_RAD, departure
from reports.compare.errors import Departure
from reports.compare.tracks import length
from sim.engine import Run


@dataclass(frozen=True)
class ErrorSeries:
    """A run beside the truth, sample by sample (T,).

    ``place`` is the worst error of any link, slider and point, ``gap`` the widest open joint,
    ``drive`` the error of the crank, all as pure numbers (rad, lengths over the longest link) and
    infinite where a number is missing; ``drive`` is NaN where nothing tells the crank where to be.
    ``crank`` is its logged angle [rad]. ``settled`` is the first sample that counts, and
    ``incomplete`` what the log lacks of what was commanded.
    ``limited`` says that ``place`` is the crank's, against a command that ends at a limit, and
    ``worst_of_place`` what the largest error of place is one of. ``driver_unit`` is m where a
    slider is driven: ``driver_rad`` and ``crank`` are its displacements [m] then.
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
        """How many periods have gone by."""
        return np.asarray((self.time_s - self.time_s[0]) / self.period_s)

    @property
    def slides(self) -> bool:
        """Whether a slider is driven."""
        return self.driver_unit == "m"

    @property
    def driver(self) -> str:
        """What is driven, in words."""
        return "the slider" if self.slides else "the crank"

    @property
    def driven(self) -> bool:
        """Whether anything tells the crank where to be."""
        return not bool(np.isnan(self.drive).all())

    @property
    def per_turn(self) -> str:
        """What a growth per period is told as."""
        return "a turn" if self.driven else f"in {self.period_s:.3g} s"

    def worst(self, series: Array) -> tuple[float, int]:
        """The largest number of a series that counts, and its sample."""
        index = self.settled + int(np.argmax(series[self.settled :]))
        return float(series[index]), index

    def first(self, series: Array, over: float) -> int:
        """The first sample that counts at which a series is over a number; the last if none."""
        samples = np.flatnonzero(series[self.settled :] > over)
        return self.settled + int(samples[0]) if samples.size else len(series) - 1


def error_series(scene: Scene, run: Run, settled_turns: float = 0.0) -> ErrorSeries:
    """A run that logged something beside the reference.

    Raises CrankcheckError where the scene has no reference at the times of the run.
    """
    beside = Beside.of(Truth(scene, bound=False), run)
    assert beside is not None
    time_s, driver = beside.motion.time_s, beside.driver_rad
    with np.errstate(over="ignore", invalid="ignore"):  # what has come apart is judged, not warned
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
    """What the log lacks of the samples that were commanded, or of the joints; "" if nothing."""
    joined = dict.fromkeys([*(pin.point for pin in joints(scene).pins), *scene.sliders])
    silent = [name for name in joined if name not in run.gaps]
    return incomplete(run) or (f"no gap of {', '.join(silent)} in the log" if silent else "")


def nearest(scene: Scene, reference: Motion) -> float:
    """How near a motion comes to a singular position (`nearness`); 1 where it has no dyad."""
    sines = nearness(scene, reference).values()
    return min((float(np.min(each)) for each in sines), default=1.0)


def worst_of(series: Array) -> Array:
    """The series with what is not a number as infinite."""
    return np.where(np.isnan(series), math.inf, series)


def widest(series: list[Array], like: Array) -> Array:
    """The largest of several series at each sample, infinite where one is not a number."""
    if not series:
        return np.zeros_like(like)
    return worst_of(np.max([np.abs(one) for one in series], axis=0))
