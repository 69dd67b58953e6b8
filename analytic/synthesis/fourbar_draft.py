"""The draft of a four-bar that carries a body: what two dyads make."""

from __future__ import annotations

import cmath
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from analytic.synthesis.asked import AskedAngle, AskedPlace, PrecisionPosition
from analytic.synthesis.construction import Step
from analytic.synthesis.design import Proposal
from analytic.synthesis.guided_body import Dyad
from analytic.synthesis.pose import Pose
from models.draft import Draft, bar, plate

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
        *,
        chosen: Mapping[str, str] | None = None,
        steps: Sequence[Step] = (),
    ) -> Proposal:
        """The four-bar whose coupler the body is, held by two dyads: the first is driven."""
        first, second = dyads
        pins = [self.letter(dyad.moving, which) for which, dyad in enumerate(dyads)]
        own = {pins[0]: first.moving, pins[1]: second.moving, **self.points}
        draft = Draft(
            self.name,
            self.source,
            {PIVOTS[0]: first.fixed, PIVOTS[1]: second.fixed},
            {
                INPUT: bar(PIVOTS[0], pins[0], first.radius(self.poses)),
                COUPLER: plate(own),
                OUTPUT: bar(PIVOTS[1], pins[1], second.radius(self.poses)),
            },
            {},
        )
        turns = first.turns(self.poses)
        positions = tuple(map(self.asked, turns, self.poses))
        return Proposal(draft, INPUT, positions, dict(chosen or {}), tuple(steps))

    def asked(self, driver_rad: float, pose: Pose) -> PrecisionPosition:
        """The body in a pose while the driver has an angle [rad]."""
        places = (AskedPlace(point, pose.at(place)) for point, place in self.points.items())
        return PrecisionPosition(driver_rad, (AskedAngle(COUPLER, pose.angle), *places))

    def letter(self, moving: complex, which: int) -> str:
        """The name of a pin: that of the body's point that it is, or a free letter."""
        for name, place in self.points.items():
            if place == moving:
                return name
        return [letter for letter in PINS if letter not in self.points][which]


def angle_of(from_place: complex, to_place: complex) -> float:
    """The direction from a place to another [rad]."""
    return cmath.phase(to_place - from_place)
