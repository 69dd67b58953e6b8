"""A kind of scene that crankcheck has not: a bead on a wire that is bent to a circle.

One link is the spoke that holds the bead; the bead is free from rest. What a kind of scene needs
is this folder, and its name in `reports.protocol.way.WAYS`: see
`tests/reports/protocol/test_new_way.py`.
"""

from collections.abc import Mapping
from typing import Any

from models.errors import CrankcheckError
from models.scene import Scene
from reports.compare.compare import Truth
from reports.protocol.length import Planned
from reports.protocol.way import ResultKind
from reports.ways.free import FreeWay
from sim.engine import Drive
from tests.worlds.bead.limits import LIMITS


class BeadWay(FreeWay):
    """As of `Way`."""

    name = __name__
    placed = ("phase", "angle", "position")
    kinds = ("bead",)
    limits = LIMITS
    units = "Beads: errors against the swing in elliptic functions."
    no_case = "no bead in it"
    results = ResultKind(
        error="Of beads the error is that of the angle, or of a place, against the swing.",
        stands=3,
        leads=3,
        axis="largest error of a bead: angle [rad], place / L [-]",
        promise="place of a bead (rad, or of the spoke)",
    )

    def takes(self, scene: Scene, drive: Drive) -> bool:
        return super().takes(scene, drive) and len(scene.links) == 1

    def stored(self, row: Mapping[Any, Any]) -> bool:
        turned = row.get("swing_rad")
        return turned is not None and bool(turned == turned)

    def refuse(self, run: Planned) -> None:
        super().refuse(run)
        speed = float(run.scene.driver.law.at(0.0)[1])
        if speed:
            raise CrankcheckError(
                f"{run.scene.name}: the bead starts with {speed:g} rad/s; found a swing for what "
                "is in free motion from rest alone: leave speed_rad_s out"
            )

    def truth(self, run: Planned) -> Truth:
        from tests.worlds.bead.truth import BeadTruth

        return BeadTruth(run.scene)


WAY = BeadWay()
