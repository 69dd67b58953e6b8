"""Scenes in free motion, with links that bend."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from models.scene import Scene
from reports.compare.compare import Truth
from reports.plan import requirements
from reports.protocol.length import GivenAs, Length, Planned
from reports.protocol.way import StudyLengths
from reports.quantities.limits import FREE_ELASTIC
from reports.ways.elastic import Bending
from reports.ways.free import FreeWay
from sim.engine import Drive

if TYPE_CHECKING:
    from reports.compare.elastic_truth import ElasticTruth


class FreeElasticWay(Bending, FreeWay):
    """The way of free motion with elastic links."""

    name = "free_elastic"
    limits = FREE_ELASTIC
    kinds = (*Bending.kinds, *FreeWay.kinds)
    roles = FreeWay.roles | {"elastic"}

    def stored(self, row: Mapping[Any, Any]) -> bool:
        return super().stored(row) and self.bends(row)

    def takes(self, scene: Scene, drive: Drive) -> bool:
        return super().takes(scene, drive) and bool(scene.elastic)

    def counted(self, scene: Scene, length: Length, given: GivenAs) -> tuple[float, int]:
        asked = length.dt_s, length.duration_s, given.segments, given.springs
        return requirements.counted_released(scene, *asked, every=length.every, least=length.least)

    def lengths(self, scene: Scene, study: StudyLengths, given: GivenAs) -> list[Length]:
        if not study.times_held:
            return super().lengths(scene, study, given)
        held_s, count = self.counted(scene, Length(duration_s=study.duration_s), given)
        lasts_s = held_s * count
        return [Length(held_s / times, duration_s=lasts_s) for times in study.times_held]

    def launch(self, run: Planned) -> Truth | None:
        return self.truth(run)

    def judged_by(self, given: GivenAs) -> list[str] | None:
        return None

    def start_truth(self, scene: Scene, given: GivenAs) -> ElasticTruth:
        from reports.compare.released_truth import released_elastic_truth  # slow to import

        look_s = requirements.LOOK * scene.driver.law.period_s
        return released_elastic_truth(scene, given.segments, given.springs, 1, look_s)

    def note(self, scene: Scene, duration_s: float) -> str:
        return self.shortened(scene, duration_s)

    def shortened(self, scene: Scene, lasts_s: float) -> str:
        return requirements.shortened_note(scene, lasts_s)

    def every(self, steps: int, steps_per_turn: float) -> int:
        return requirements.logged_every(min(steps_per_turn, float(steps)))

    def truth(self, run: Planned) -> Truth:
        from reports.compare.released_truth import released_elastic_truth  # slow to import

        bent = run.given_as.segments, run.given_as.springs
        return released_elastic_truth(run.scene, *bent, run.steps, run.dt_s, run.tolerance)


WAY = FreeElasticWay()
