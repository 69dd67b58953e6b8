"""A dyad that drives a four-bar to and fro between two positions: a six-bar whose crank turns.

Where neither pivot of a four-bar can turn fully, a point of its input link goes to and fro between
two places; a crank and a coupler swing it, as they swing the rocker of a crank-rocker.

Source: lecture "Tong hop co cau" (synthesis), example 5.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Iterator
from dataclasses import replace

from analytic.lectures.synthesis.construction import Dot, Step
from analytic.lectures.synthesis.design import Proposal
from analytic.lectures.synthesis.fourbar_draft import INPUT, letters_beside
from analytic.lectures.synthesis.to_and_fro import ToAndFro, choices
from models.files.assemble import Table
from models.lectures.draft import bar, plate

O6 = "O6"
SHARE = 0.6
"""Of the input link, from its fixed pivot: there the dyad is pinned to it."""


def with_driving_dyad(proposal: Proposal) -> Iterator[Proposal]:
    """The six-bars of a four-bar of two positions, the dyad on its input link, O6 on either side
    of the chord and at several distances from it."""
    draft = proposal.draft
    pivot_name, pin_name = _points(draft.links[INPUT])
    length = draft.links[INPUT]["length_m"]
    assert isinstance(length, float)
    pivot = draft.ground[pivot_name]
    first, second = (position.driver_rad for position in proposal.positions)
    on, own_pin = letters_beside({name for one in draft.links.values() for name in _points(one)}, 2)
    radius = SHARE * length
    ends = tuple(pivot + cmath.rect(radius, angle) for angle in (first, second))
    crank = 0.5 * abs(ends[1] - ends[0])
    for distance in choices(crank, None):
        for beyond in (1, 2):
            found = ToAndFro.of(ends[0], ends[1], distance, beyond=beyond)
            driven = replace(
                draft,
                ground={**draft.ground, O6: found.pivot},
                links={
                    "crank": bar(O6, own_pin, found.crank_m),
                    "rod": bar(own_pin, on, found.coupler_m),
                    **draft.links,
                    INPUT: plate({pivot_name: 0j, pin_name: complex(length), on: complex(radius)}),
                },
            )
            positions = tuple(
                replace(position, driver_rad=angle)
                for position, angle in zip(proposal.positions, found.angles, strict=True)
            )
            dots = tuple(Dot(end, f"{on}{n}") for n, end in enumerate(ends, 1))
            steps = (
                *proposal.steps,
                Step(f"{on} on the input link, in both positions", dots),
                *found.steps((ends[0], ends[1]), (O6, own_pin, on)),
            )
            told = {f"{O6} from the chord's middle": f"{distance:.6g} m", "beyond": f"{on}{beyond}"}
            yield replace(
                proposal,
                draft=driven,
                driver="crank",
                positions=positions,
                chosen={**proposal.chosen, **told},
                steps=steps,
            )


def _points(link: Table) -> list[str]:
    """The names of the points of a link's table."""
    names = link.get("bar") or link["points"]
    assert isinstance(names, Iterable)
    return list(names)


def swings_little(proposal: Proposal) -> bool:
    """Whether the input link turns by less than half a turn, so that a rocker's chord leads it."""
    first, second = (position.driver_rad for position in proposal.positions)
    return abs(math.remainder(second - first, math.tau)) < math.pi
