"""The bodies of a mechanism as a log has them: how far they are off the truth, to be drawn over it.

What a log does not hold is left out; how the rest is placed is said in
`reports.page.log_sections.placing`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from models.array import Array
from models.scene import Scene
from reports.compare.beside import Truth
from reports.drawing.moving import FARTHEST, drawn_links, moving_points
from reports.drawing.packed import packed
from reports.logs.channel import Reading
from reports.own_log.judged import JudgedLog
from reports.own_log.rows import log_rows
from reports.page.log_sections.placing import PlacedBodies, Placing


@dataclass(frozen=True)
class LoggedBodies:
    """What a log says of the bodies at some instants: the pieces that it is drawn in, the error of
    the angles of links (T,) [rad], and in words, of each body that is drawn, from what."""

    scene: Scene
    pieces: tuple[PlacedBodies, ...]
    turned: Mapping[str, Array]
    origins: Mapping[str, str]

    @property
    def left_out(self) -> list[str]:
        """The links that the log does not place."""
        drawn = {name for piece in self.pieces for name in piece.links}
        return [name for name in self.scene.links if name not in drawn]

    def embedded(self, samples: int) -> list[dict[str, object]]:
        """The pieces as the script reads them, with rows as `reports.drawing.moving` has them."""
        return [
            {
                "name": piece.name,
                "apart": piece.apart,
                "only": {"links": piece.links, "blocks": piece.blocks, "marks": piece.marks},
                "rows": packed(self._rows(piece, samples)),
            }
            for piece in self.pieces
        ]

    def _rows(self, piece: PlacedBodies, samples: int) -> Array:
        nowhere = np.full((samples, 2), np.nan)
        places = [piece.off.get(name, nowhere).T for name in moving_points(self.scene)]
        angles = [[self.turned.get(name, np.zeros(samples))] for name in drawn_links(self.scene)]
        reach = FARTHEST * self.scene.longest_m
        return np.asarray(np.clip(np.vstack([*places, *angles]), -reach, reach))


def truth_of_all(judged: JudgedLog) -> Truth:
    """The truth that the log is judged by, of every body: what is judged may need fewer."""
    return replace(judged.beside.truth, bound=False, links=None, points=None, _motions={})


def logged_bodies(judged: JudgedLog, truth_of: Truth, time_s: Array) -> LoggedBodies:
    """What the log says of the bodies at instants (T,), beside a truth of every point. Raises
    CrankcheckError."""
    scene, truth = judged.beside.scene, truth_of.at(time_s)
    errors = [
        (reading, _error_at(truth_of, reading, time_s))
        for reading in judged.log.readings
        if reading.channel.kind.order == 0
    ]
    placing = Placing(scene, truth, _turned(errors, time_s.size), _angles_out(judged))
    placing.take_points(errors)
    placing.take_sliders(errors)
    placing.take_links()
    return LoggedBodies(scene, tuple(placing.pieces()), placing.turned, placing.origins)


def _angles_out(judged: JudgedLog) -> frozenset[str]:
    """The links whose angle is out of tolerance."""
    angles = [row for row in log_rows(judged) if row.error.quantity in ("angle", "drive")]
    return frozenset(row.error.body for row in angles if row.verdict == "out")


def _error_at(truth: Truth, reading: Reading, time_s: Array) -> Array:
    """The error of a reading between its instants by straight lines, NaN beyond them; whole turns
    that an angle loses on the way are no error."""
    after = np.searchsorted(reading.instants, time_s)
    near = np.unique(np.concatenate([after - 1, after]))
    rows = near[(near >= 0) & (near < reading.instants.size)]
    own = reading.instants[rows]
    error = reading.channel.error(reading.values[rows], reading.channel.expected(truth.at(own)))
    if reading.channel.kind.turns:
        error = np.unwrap(error)
    return np.interp(time_s, own, error, left=math.nan, right=math.nan)


def _turned(errors: Sequence[tuple[Reading, Array]], samples: int) -> dict[str, Array]:
    """The errors of the angles of links: one that was logged relative to another link has that
    one's as well."""
    own = {e.channel.of: (e.channel.relative_to, off) for e, off in errors if e.channel.kind.turns}
    found: dict[str, Array] = {}
    for link in own:
        total, at, passed = np.zeros(samples), link, set[str]()
        while at in own and at not in passed:
            passed.add(at)
            total, at = total + own[at][1], own[at][0]
        found[link] = total
    return found
