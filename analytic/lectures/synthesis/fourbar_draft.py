"""The draft of a four-bar that carries a body: what two dyads make."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from analytic.lectures.synthesis.asked import AskedAngle, AskedPlace, PrecisionPosition
from analytic.lectures.synthesis.construction import Step
from analytic.lectures.synthesis.design import Proposal
from analytic.lectures.synthesis.guided_body import Dyad
from analytic.lectures.synthesis.pose import Pose
from models.lectures.draft import Draft, bar, plate

INPUT, COUPLER, OUTPUT = "input", "coupler", "output"
PIVOTS, PINS = ("O2", "O4"), "ABEFGHJKLM"
"""The fixed pivots are named as the lecture has them, the pins by letters that are free."""


@dataclass(frozen=True)
class CarriedBody:
    """A body in its positions, with the named points of it [m, own frame] whose places are asked;
    ``name`` and ``source`` go on to its scenes."""

    name: str
    source: str
    poses: tuple[Pose, ...]
    points: Mapping[str, complex]

    def four_bar(
        self,
        dyads: tuple[Dyad, Dyad],
        driven: int = 0,
        *,
        chosen: Mapping[str, str] | None = None,
        steps: Sequence[Step] = (),
    ) -> Proposal:
        """The four-bar whose coupler the body is, held by two dyads, the first of which stands on
        O2; ``driven`` is which of them (0 or 1)."""
        pins = [self.letter(dyad.moving, which) for which, dyad in enumerate(dyads)]
        cranks = [
            bar(pivot, pin, dyad.radius(self.poses))
            for pivot, pin, dyad in zip(PIVOTS, pins, dyads, strict=True)
        ]
        own = {pin: dyad.moving for pin, dyad in zip(pins, dyads, strict=True)}
        draft = Draft(
            self.name,
            self.source,
            {pivot: dyad.fixed for pivot, dyad in zip(PIVOTS, dyads, strict=True)},
            {INPUT: cranks[driven], COUPLER: plate(own | dict(self.points)),
             OUTPUT: cranks[1 - driven]},
            {},
        )  # fmt: skip
        positions = tuple(map(self.asked, dyads[driven].turns(self.poses), self.poses))
        told = {**(chosen or {}), "driven at": PIVOTS[driven]}
        return Proposal(draft, INPUT, positions, told, tuple(steps))

    def asked(self, driver_rad: float, pose: Pose) -> PrecisionPosition:
        """The body in a pose while the driver has an angle [rad]."""
        places = (AskedPlace(point, pose.at(place)) for point, place in self.points.items())
        return PrecisionPosition(driver_rad, (AskedAngle(COUPLER, pose.angle), *places))

    def letter(self, moving: complex, which: int) -> str:
        """The name of a pin: that of the body's point that it is, or a free letter."""
        for name, place in self.points.items():
            if place == moving:
                return name
        return letters_beside(self.points, which + 1)[which]


def letters_beside(names: Iterable[str], count: int) -> list[str]:
    """So many letters for pins that are not among the names."""
    taken = set(names)
    return [letter for letter in PINS if letter not in taken][:count]
