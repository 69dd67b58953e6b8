"""Dyad that drives a four-bar to and fro between two positions: a six-bar whose crank turns.

Where neither pivot of a four-bar can turn fully, a point of its input link goes to and fro between
two places; a crank and a coupler swing it, as they swing the rocker of a crank-rocker.

Source: lecture "Tong hop co cau" (synthesis), example 5.

::

    O2 lies on the extension of the chord B1 B2, half of which the crank is:
                                                                 |B1 B2|
       B1 ------ B2 ------ (A1 -- O2 -- A2)      crank = O2 A =  -------,  coupler = A B = M O2
            M                                                       2

In B1 crank and coupler are stretched, in B2 they lie over each other; half a turn is between them.
With a coupler longer than the crank it is a Grashof crank-rocker wherever the rocker's pivot is, as
r^2 + O2 O4^2 = l^2 + R^2 for the rocker R.

Source: lecture "Tong hop co cau" (synthesis), examples 2, 3 and 5.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import chain

from analytic.lectures.synthesis import design
from models.errors import CrankcheckError
from models.lectures.draft import bar, plate, points_of

FACTORS = (1.5, 2.0, 3.0, 4.0)
"""Default distances of O2 from the middle of B1 B2, over the crank."""


@dataclass(frozen=True)
class ToAndFro:
    """Crank and coupler: places [m], lengths [m], the crank's angles in both positions [rad]."""

    pivot: complex
    crank_m: float
    coupler_m: float
    angles: tuple[float, float]

    @staticmethod
    def of(first: complex, second: complex, distance_m: float, *, beyond: int) -> ToAndFro:
        """Make them from the rocker's pin in its two places; the crank's pivot lies ``beyond`` the
        first (1) or the second (2). Raises CrankcheckError where it would lie between them."""
        crank = 0.5 * abs(second - first)
        if not distance_m > crank:
            raise CrankcheckError(
                f"distance_m is {distance_m:g}: the crank's pivot would lie between the rocker "
                f"pin's places, {2.0 * crank:.6g} m apart; take more than {crank:.6g} m"
            )
        near, far = (first, second) if beyond == 1 else (second, first)
        along = (near - far) / abs(near - far)
        pivot = 0.5 * (first + second) + distance_m * along
        folded, stretched = cmath.phase(along), cmath.phase(-along)
        angles = (folded, stretched) if beyond == 1 else (stretched, folded)
        return ToAndFro(pivot, crank, distance_m, angles)

    def steps(
        self, ends: tuple[complex, complex], letters: tuple[str, str, str]
    ) -> list[design.DrawingStep]:
        """Return the construction; ``letters`` are the crank's pivot, its pin, the rocker's pin."""
        pivot, pin, end = letters
        far = max(ends, key=lambda place: abs(place - self.pivot))
        pins = [self.pivot + cmath.rect(self.crank_m, angle) for angle in self.angles]
        chord = (
            design.Segment(far, self.pivot),
            design.Dot(self.pivot, pivot, "result", fixed=True),
        )
        half = (
            design.Segment(0.5 * sum(ends), ends[0]),
            design.DrawnCircle(self.pivot, self.crank_m),
            design.Dot(pins[0], f"{pin}1", "result"),
            design.Dot(pins[1], f"{pin}2"),
        )
        words = f"half of {end}1{end}2 is the crank: its circle meets the line in {pin}1 and {pin}2"
        coupler = tuple(design.chained(self.pivot, pins[0], ends[0]))
        return [
            design.DrawingStep(f"the chord {end}1{end}2, and {pivot} on its extension", chord),
            design.DrawingStep(words, half),
            design.DrawingStep(f"{pin}1{end}1 is the coupler", coupler),
        ]


def choices(crank_m: float, asked: float | None) -> list[float]:
    """Return the distances of the crank's pivot: the required one, or several."""
    return [asked] if asked is not None else [factor * crank_m for factor in FACTORS]


O6 = "O6"
SHARE = 0.6
"""Distance of the dyad's pin from the fixed pivot, over the input link."""


def with_driving_dyad(proposal: design.Proposal) -> Iterator[design.Proposal]:
    """Yield the six-bars of a four-bar of two positions, the dyad on its input link, O6 on either
    side of the chord and at several distances from it."""
    draft = proposal.draft
    pivot_name, pin_name = points_of(draft.links[design.INPUT])
    length = draft.links[design.INPUT]["length_m"]
    assert isinstance(length, float)
    pivot = draft.ground[pivot_name]
    first, second = (position.driver_rad for position in proposal.positions)
    on, own_pin = design.letters_beside(
        chain.from_iterable(map(points_of, draft.links.values())), 2
    )
    radius = SHARE * length
    ends = pivot + cmath.rect(radius, first), pivot + cmath.rect(radius, second)
    crank = 0.5 * abs(ends[1] - ends[0])
    for distance in choices(crank, None):
        for beyond in (1, 2):
            found = ToAndFro.of(*ends, distance, beyond=beyond)
            driven = replace(
                draft,
                ground={**draft.ground, O6: found.pivot},
                links={
                    "crank": bar(O6, own_pin, found.crank_m),
                    "rod": bar(own_pin, on, found.coupler_m),
                    **draft.links,
                    design.INPUT: plate(
                        {pivot_name: 0j, pin_name: complex(length), on: complex(radius)}
                    ),
                },
            )
            asked = [position.asked for position in proposal.positions]
            dots = tuple(design.numbered(on, ends))
            step = design.DrawingStep(f"{on} on the input link, in both positions", dots)
            told = {f"{O6} from the chord's middle": f"{distance:.6g} m", "beyond": f"{on}{beyond}"}
            yield replace(
                proposal,
                draft=driven,
                driver="crank",
                positions=tuple(map(design.PrecisionPosition, found.angles, asked)),
                chosen={**proposal.chosen, **told},
                steps=(*proposal.steps, step, *found.steps(ends, (O6, own_pin, on))),
            )


def swings_little(proposal: design.Proposal) -> bool:
    """True if the input link turns by less than half a turn, so that a rocker's chord leads it."""
    first, second = (position.driver_rad for position in proposal.positions)
    return abs(math.remainder(second - first, math.tau)) < math.pi
