"""Scenes in free motion, with rigid links."""

from collections.abc import Collection, Mapping, Sequence, Set
from typing import Any, NoReturn

import numpy as np

from analytic.free.free_motion import loosened
from analytic.kinematics import solve
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Forces, Motion, State
from models.scene import Scene
from models.scene.driver import LONGEST_S
from reports.compare.compare import Truth
from reports.compare.free_facts import FreeFacts
from reports.compare.free_truth import kept_motion, released_state
from reports.plan.requirements import refuse_unreleased, under_control
from reports.plan.steps import counted_free
from reports.protocol.length import LEAST_STEPS, GivenAs, Length, Planned
from reports.protocol.way import ResultKind, StudyLengths
from reports.quantities import named
from reports.quantities.limits import FREE
from reports.quantities.quantity import Role, Tolerance
from reports.ways.driven import DrivenWay
from sim.engine import Drive

UNITS = (
    "Free motion: errors at the same time over G, the growth of a small change of the start; "
    "geometry at the run's own angle; drift of energy over the largest kinetic energy T. Classes: "
    "fine is a thousandth of the limit of the phase; 1e-1 and 1e-3 are of the error without G, "
    "with the time up to which 1e-3 holds."
)


class FreeWay(DrivenWay):
    """The way of free motion with rigid links."""

    name = "free"
    drive: Drive = "free"
    kinds: Sequence[str] = ("free",)
    closed_form = False
    limits: Mapping[str, Tolerance] = FREE
    roles: Set[Role] = frozenset(("free", "place", "closure", "derived"))
    placed: Sequence[str] = ("phase", *named("place"))
    unlogged: Sequence[str] = ("energy",)
    noted = True
    no_case = "no case of free motion"
    units = UNITS
    over_g: Sequence[str] = FreeFacts.over_g
    results = ResultKind(
        error="Free motion is compared with the integrated motion at the same time, its errors "
        "over the sensitivity G of that motion.",
        stands=2,
        leads=2,
        axis="largest error / sensitivity: angle [rad], place / L [-]",
        promise="place over the sensitivity (rad, or of the longest link)",
    )

    def takes(self, scene: Scene, drive: Drive) -> bool:
        return drive == "free"

    def counted(self, scene: Scene, length: Length, given: GivenAs) -> tuple[float, int]:
        return counted_free(
            scene, length.dt_s, length.duration_s, every=length.every, least=length.least
        )

    def lengths(self, scene: Scene, study: StudyLengths, given: GivenAs) -> list[Length]:
        return [Length(each, duration_s=study.duration_s) for each in study.dt_s]

    def refuse(self, run: Planned) -> None:
        refuse_unreleased(run.scene, run.duration_s)

    def stored(self, row: Mapping[Any, Any]) -> bool:
        return str(row["drive"]) == "free"

    def note(self, scene: Scene, duration_s: float) -> str:
        return ""

    def truth(self, run: Planned) -> Truth:
        from reports.compare.free_truth import free_truth  # slow to import

        return free_truth(run.scene, run.steps, run.dt_s, run.tolerance)

    drives: tuple[Drive, ...] = ("free",)
    lengths_by: tuple[str, ...] = ("--duration",)
    over = "in free motion"
    targets: Collection[str] = FREE
    least_judged = LEAST_STEPS

    def refuse_length(self, option: str) -> NoReturn:
        raise CrankcheckError(
            f"{option}: free motion has no turns; give --dt and --duration, in seconds"
        )

    def released(self, scene: Scene) -> Scene:
        return loosened(under_control(scene))

    def opened(self, scene: Scene) -> tuple[Scene, State]:
        try:
            return scene, solve(scene, np.zeros(1)).state()
        except CrankcheckError:
            return scene, released_state(scene)  # of several freedoms there is no closed form

    def launch(self, run: Planned) -> Truth | None:
        return None

    def refuse_made(self, run: Planned) -> None:
        refuse_unreleased(run.scene, run.duration_s)

    def motion(self, scene: Scene, time_s: Array) -> Motion:
        return kept_motion(scene, float(np.max(time_s))).at(time_s, bound=False)

    def drawn_forces(self, scene: Scene, time_s: Array) -> Forces:
        raise CrankcheckError(f"{scene.name}: free motion is drawn without forces; leave them out")

    def drawn_s(self, most_s: float) -> float:
        return most_s

    def latest_s(self, scene: Scene) -> float:
        return LONGEST_S


WAY = FreeWay()
