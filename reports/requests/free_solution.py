"""`solve` of a scene that is let go: its free motion, integrated, with what it is sure to."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from analytic.result import Selection
from models.array import Array
from models.motion import Bound, Motion
from models.scene import Scene
from reports.output.console import say
from reports.requests.solution import ROWS, Solution, drawn, thinned

if TYPE_CHECKING:
    import pandas as pd
    from rich.console import Console

    from analytic.free.free_motion import FreeMotion

Bodies = TypeVar("Bodies", Motion, Bound)


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class FreeSolution(Solution):
    """The free motion of a scene, with a bound of its own error at every sample.

    As `Solution`; ``free`` is the whole of it, dense (`analytic.free.free_motion.FreeMotion`).
    """

    free: FreeMotion

    @property
    def sensitivity(self) -> Array:
        """By how much a small change of the start has grown by each sample, (T,)."""
        return self.free.sensitivity(self.time_s)

    @property
    def error_rad(self) -> Array:
        """What the driver's angle may be off by at each sample [rad], (T,)."""
        return self.free.error_rad(self.time_s)

    def frame(self) -> pd.DataFrame:
        """As of `Solution`, with the energies, the sensitivity and the error beside."""
        from reports.describe.free_motion import free_columns

        return super().frame().assign(**free_columns(self.free, self.time_s))

    def show(self, console: Console) -> None:
        from reports.requests.free_text import show_free

        few = thinned(self, ROWS)
        show_free(console, self.free, few)
        if few.time_s.size < self.time_s.size:
            left = f"{few.time_s.size} of {self.time_s.size} samples; all of them: frame()"
            say(console, left, "dim")

    def _drawn(self) -> str:
        return drawn(self.scene)


def free_solution(scene: Scene, time_s: Array, wanted: Selection, *, bound: bool) -> FreeSolution:
    """The free motion of a scene at times [s] from 0 on; of ``wanted`` alone.

    Raises
    ------
    CrankcheckError
        Times before the start, and as `analytic.free.release.release`.
    """
    from analytic.free.release import release

    law = scene.driver.law
    free = release(scene, float(np.max(time_s)) if np.max(time_s) > 0.0 else law.period_s)
    motion = _chosen(free.at(time_s, bound=bound), wanted)
    if motion.bound is not None:
        motion = replace(motion, bound=_chosen(motion.bound, wanted))
    return FreeSolution(**vars(motion), scene=scene, free=free)


def _chosen(of: Bodies, wanted: Selection) -> Bodies:
    """The links, points and sliders that were asked for."""
    return replace(
        of,
        links={name: of.links[name] for name in wanted.links},
        points={name: of.points[name] for name in wanted.points},
        sliders={name: of.sliders[name] for name in wanted.sliders},
    )
