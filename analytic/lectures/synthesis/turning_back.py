"""Whether what is asked to go to and fro between two positions turns back there, and nowhere else.

A ram on a rod that is too short goes further than the ends of its lever ask for, and turns back in
other times: two positions that are met tell nothing of it. The reference follows it over a turn.
"""

from __future__ import annotations

import math
from dataclasses import replace

from analytic.lectures.synthesis.asked import AskedAngle, AskedSlide, PrecisionPosition
from analytic.lectures.synthesis.examine import Examined
from analytic.mechanism.travel import Travel, travel
from models.errors import CrankcheckError

STROKE = 1e-9
"""Of a stroke or swing: what it is longer than asked is none of rounding beyond it."""
RATIO = 1e-6
"""Of a time ratio: limit positions are roots, and lose half of the digits where they are flat."""
FLAT = 1e-6
"""A least sine of transmission below which there is a change point on the way."""


def held_to_its_limits(one: Examined) -> Examined:
    """A mechanism with what its output does over a turn of the crank told; with a fault where that
    is not what the two positions ask for. Where the way comes too near to a singular position to
    have limits, that is told."""
    name = one.proposal.turns_back
    if not name or one.defects or not one.turns_fully or one.least_sine < FLAT:
        return one
    try:
        found = travel(one.scene, name)
    except CrankcheckError as singular:
        return replace(one, notes=(*one.notes, f"not followed over a turn: {singular}"))
    stroke, ratio = _asked(one.positions, name)
    off = abs(found.stroke - stroke) > STROKE * stroke
    if off or abs(found.time_ratio - ratio) > RATIO * ratio:
        advice = ": take a longer rod" if name in one.scene.sliders else ""
        return replace(one, fault=f"{_told(one, found)}{advice}")
    return replace(one, notes=(*one.notes, _told(one, found)))


def _asked(positions: tuple[PrecisionPosition, ...], name: str) -> tuple[float, float]:
    """The stroke [m] or swing [rad] between the two positions, and the ratio of the crank's turns
    between them."""
    first, second = (_of(position, name) for position in positions)
    if isinstance(first, AskedAngle) and isinstance(second, AskedAngle):
        stroke = abs(math.remainder(second.angle - first.angle, math.tau))
    else:
        assert isinstance(first, AskedSlide)
        assert isinstance(second, AskedSlide)
        stroke = abs(second.displacement - first.displacement)
    forth = (positions[1].driver_rad - positions[0].driver_rad) % math.tau
    back = math.tau - forth
    return stroke, max(forth, back) / min(forth, back)


def _of(position: PrecisionPosition, name: str) -> AskedAngle | AskedSlide:
    """What a position asks of a link or slider."""
    for each in position.asked:
        if isinstance(each, AskedAngle) and each.link == name:
            return each
        if isinstance(each, AskedSlide) and each.slider == name:
            return each
    raise CrankcheckError(f"nothing is asked of {name} in a position, which it turns back in")


def _told(one: Examined, found: Travel) -> str:
    """Stroke and time ratio over a turn, in words."""
    if one.proposal.turns_back in one.scene.sliders:
        goes = f"goes {found.stroke:.6g} m"
    else:
        goes = f"swings {math.degrees(found.stroke):.6g} deg"
    return f"{goes}, time ratio {found.time_ratio:.6g}"
