"""Scenes whose driver follows a law, with links that bend."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from models.motion import State
from models.scene import Scene
from reports.compare.compare import Truth
from reports.plan import requirements
from reports.protocol.length import SEGMENTS, GivenAs, Length, Planned
from reports.protocol.way import ResultKind, StudyLengths, StudyLinks
from reports.quantities.limits import ELASTIC
from reports.ways.driven import DrivenWay
from sim.engine import Drive

if TYPE_CHECKING:
    from reports.compare.elastic_truth import ElasticTruth


class Bending(DrivenWay):
    """Particulars of links that bend, with any drive; precedes the way of rigid links."""

    closed_form = False
    kinds: Sequence[str] = ("elastic",)
    placed: Sequence[str] = ("deflection",)
    no_case = "no elastic link in it"
    results = ResultKind(
        error="The error of elastic links is that of their deflection compared with the solved "
        "motion of the beam, as a share of the largest deflection.",
        stands=1,
        leads=0,
        axis="largest error of deflection / largest deflection [-]",
        promise="deflection (of the largest)",
        unit="/ D",
        targets=(1e-1, 1e-2, 1e-3),  # nearer to the beam comes no chain that is run
        kept="deflection within a target of the beam's",
        head="target\n/ D",
        notes=(
            "Each elastic link is a chain of n rigid segments, with a spring of rate EI n / l "
            "in every pin between them. At any speed the step times their highest frequency "
            "stays below 1.5.",
        ),
    )

    def bends(self, row: Mapping[Any, Any]) -> bool:
        """True if links of a stored cell bend."""
        segments = row.get("segments")  # a number, or none: NaN is not itself
        return segments is not None and bool(segments == segments)

    def given(self, scene: Scene, given: GivenAs) -> Scene:
        return requirements.cut_scene(scene, given)

    def held_steps(self, scene: Scene) -> tuple[float, ...]:
        return (requirements.held_steps(scene, SEGMENTS, requirements.SPRINGS[0]),)

    def judged_by(self, given: GivenAs) -> list[str] | None:
        springs = ["--springs", given.springs] * (given.springs != "plain")
        return ["--segments", str(given.segments), *springs]

    def given_by(self, study: StudyLinks) -> list[GivenAs]:
        return requirements.given_as(study)

    def key(self, given: GivenAs) -> list[object]:
        return ["elastic", given.segments, given.springs]

    def refuse(self, run: Planned) -> None:
        super().refuse(run)
        requirements.refuse_unelastic(self.start_truth, run.scene, run.given_as)

    def opened(self, scene: Scene) -> tuple[Scene, State]:
        truth = self.start_truth(scene, GivenAs())
        return truth.given, truth.start

    def start_truth(self, scene: Scene, given: GivenAs) -> ElasticTruth:
        """The reference of a short run. Raises CrankcheckError for a scene without one."""
        raise NotImplementedError


class ElasticWay(Bending):
    """The way of driven scenes with elastic links."""

    name = "elastic"
    limits = ELASTIC
    roles = DrivenWay.roles | {"elastic"}

    def stored(self, row: Mapping[Any, Any]) -> bool:
        return self.bends(row)

    def takes(self, scene: Scene, drive: Drive) -> bool:
        return bool(scene.elastic)

    def counted(self, scene: Scene, length: Length, given: GivenAs) -> tuple[float, int]:
        if length.dt_s is None and length.steps_per_turn is None:
            held = requirements.held_steps(scene, given.segments, given.springs)
            length = replace(length, steps_per_turn=held)
        return super().counted(scene, length, given)

    def lengths(self, scene: Scene, study: StudyLengths, given: GivenAs) -> list[Length]:
        if not study.times_held:
            return super().lengths(scene, study, given)
        held = requirements.held_steps(scene, given.segments, given.springs)
        return [Length(None, times * held, study.turns) for times in study.times_held]

    def start_truth(self, scene: Scene, given: GivenAs) -> ElasticTruth:
        from reports.compare.elastic_truth import elastic_truth  # slow to import

        return elastic_truth(scene, given.segments, given.springs, self.turn_s(scene))

    def every(self, steps: int, steps_per_turn: float) -> int:
        return requirements.logged_every(steps_per_turn)

    def truth(self, run: Planned) -> Truth:
        from reports.compare.elastic_truth import elastic_truth  # slow to import

        bent = run.given_as.segments, run.given_as.springs
        return elastic_truth(run.scene, *bent, run.dt_s * (run.steps + 1))


WAY = ElasticWay()
