"""The draft of a four-bar that carries a body: what two dyads make."""

from __future__ import annotations

import cmath
from collections.abc import Mapping, Sequence

from analytic.synthesis.asked import AskedAngle, AskedPlace, PrecisionPosition
from analytic.synthesis.burmester import Dyad
from analytic.synthesis.construction import Step
from analytic.synthesis.design import Proposal
from analytic.synthesis.pose import Pose
from models.draft import Draft, bar, plate

INPUT, COUPLER, OUTPUT = "input", "coupler", "output"
PIVOTS, PINS = ("O2", "O4"), ("A", "B")


def carried(
    name: str,
    source: str,
    poses: Sequence[Pose],
    dyads: tuple[Dyad, Dyad],
    points: Mapping[str, complex],
    *,
    pins: tuple[str, str] = PINS,
    chosen: Mapping[str, str] | None = None,
    steps: Sequence[Step] = (),
) -> Proposal:
    """A four-bar whose coupler is a body with named ``points`` in its own frame, held by two dyads:
    the first is driven. Asked are the places of the points and the body's angle in each pose."""
    first, second = dyads
    own = {pins[0]: first.moving, pins[1]: second.moving} | dict(points)
    draft = Draft(
        name,
        source,
        {PIVOTS[0]: first.fixed, PIVOTS[1]: second.fixed},
        {
            INPUT: bar(PIVOTS[0], pins[0], first.radius(poses)),
            COUPLER: plate(own),
            OUTPUT: bar(PIVOTS[1], pins[1], second.radius(poses)),
        },
        {},
    )
    positions = tuple(
        PrecisionPosition(
            cmath.phase(pose.at(first.moving) - first.fixed),
            (
                AskedAngle(COUPLER, pose.angle),
                *(AskedPlace(point, pose.at(place)) for point, place in points.items()),
            ),
        )
        for pose in poses
    )
    return Proposal(draft, INPUT, positions, dict(chosen or {}), tuple(steps))
