"""`solve` of a scene with elastic links: how they bend, beside the same mechanism with rigid
ones."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from analytic.elastic.sampled import ElasticHistory, sampled
from analytic.result import Selection
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import Scene
from reports.describe.elastic_course import (
    ElasticCourse,
    closely_sampled,
    elastic_course,
    energy_columns,
    rigid_columns,
    start_of,
)
from reports.describe.elastic_words import certainty
from reports.output.console import say
from reports.requests.elastic_choice import ElasticChoice
from reports.requests.solution import ROWS, Solution, drawn, thinned

if TYPE_CHECKING:
    import pandas as pd
    from rich.console import Console


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class ElasticSolution(Solution):
    """The motion of a scene with elastic links.

    As `Solution`, with ``elastic``: how far each elastic link is bent in its middle, and stretched
    [m]. Its bound is None: `certainty` says how far it is to be trusted. ``vibration`` is the whole
    of it (`analytic.elastic.elastic_motion.DrivenElasticMotion`, or `ReleasedElasticMotion`).
    """

    vibration: ElasticHistory

    @cached_property
    def rigid(self) -> Motion:
        """The same scene with rigid links, at the same instants."""
        return self._course(self.time_s).rigid

    @cached_property
    def certainty(self) -> list[str]:
        """What it may be off by, in sentences."""
        return certainty(self.vibration)

    def frame(self) -> pd.DataFrame:
        """As of `Solution`, with ``coupler_deflection_m`` and ``coupler_extension_m`` of elastic
        links, what rigid ones would have, ``rocker_theta_rigid_rad``, and the energies of what is
        let go."""

        rigid = self.rigid if self.forces is not None else replace(self.rigid, forces=None)
        energy = energy_columns(self.vibration, self.time_s)
        return super().frame().assign(**rigid_columns(rigid), **energy)

    def show(self, console: Console) -> None:
        from reports.requests.elastic_text import show_elastic

        few = np.sort(thinned(self, ROWS).time_s)
        shown, fine = (
            self._course(each)
            for each in (few, closely_sampled(self.scene, self.vibration.until_s))
        )
        forces = self.forces is not None
        show_elastic(console, self.vibration, shown, fine, self.certainty, forces=forces)
        if few.size < self.time_s.size:
            left = f"{few.size} of {self.time_s.size} samples; all of them: frame()"
            say(console, left, "dim")

    def _course(self, time_s: Array) -> ElasticCourse:
        return elastic_course(self.vibration, time_s)

    def _drawn(self) -> str:
        return drawn(self.scene)


def elastic_solution(
    scene: Scene, time_s: Array, wanted: Selection, choice: ElasticChoice, *, forces: bool
) -> ElasticSolution:
    """The motion of a scene with elastic links at times [s] from 0 on; of ``wanted`` alone.

    Raises
    ------
    CrankcheckError
        Times before the start, what `ElasticChoice` refuses, and motions that are not found.
    """
    until_s = max(float(np.max(time_s)), 0.0) or scene.driver.law.period_s
    vibration = choice.motion(scene, until_s)
    if float(np.min(time_s)) < 0.0 and start_of(vibration) != "periodic":
        raise CrankcheckError(
            f"time_s: t = {float(np.min(time_s)):g} s, and {scene.name} starts at 0, "
            f"{start_of(vibration)}; give times from there on, or --shape periodic"
        )
    whole = sampled(vibration, time_s)
    motion = replace(
        whole,
        links={name: whole.links[name] for name in wanted.links},
        points={name: whole.points[name] for name in wanted.points},
        sliders={name: whole.sliders[name] for name in wanted.sliders},
        elastic={name: x for name, x in whole.elastic.items() if name in wanted.links},
        forces=whole.forces if forces else None,
    )
    return ElasticSolution(**vars(motion), scene=scene, vibration=vibration)
