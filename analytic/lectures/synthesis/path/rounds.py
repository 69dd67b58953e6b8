"""Rounds of least-squares fits: many starts over few points first, few over all points last."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from analytic.lectures.synthesis.path.fit import TOO_LARGE, Fitted, refit
from analytic.lectures.synthesis.path.task import MOST, UnitPath
from analytic.lectures.synthesis.path.unit_four_bar import BOUNDS

Progress = Callable[[float, float], None]
"""Is told the share that is done [0 to 1] and the least RMS distance by then [m]."""
APART = 0.02
"""Of the box of shapes: fits that are nearer go the same way."""


@dataclass(frozen=True)
class Round:
    """One round: of the best ``share`` of the starts, over at most so many points, in at most so
    many evaluations."""

    share: float
    points: int
    evaluations: int

    def count(self, starts: int) -> int:
        """How many fits it has."""
        return max(1, math.ceil(self.share * starts))


ROUNDS = (Round(1.0, 14, 60), Round(0.4, MOST, 120), Round(0.17, MOST, 1500))


@dataclass
class Clock:
    """How far a search is: ``until`` is when no further fit is begun [s of the monotonic clock],
    ``unit_m`` the path's radius."""

    starts: int
    until: float
    unit_m: float
    progress: Progress | None = None
    complete: bool = True
    best: float = math.inf
    work: float = field(default=0.0)

    @property
    def is_over(self) -> bool:
        """Whether the time is used up."""
        return time.monotonic() >= self.until

    def fitted(self, one: Round, fit: Fitted) -> None:
        """A fit was made."""
        self.work += one.evaluations * one.points
        if one.points >= MOST:  # fits of some of the points say little of all
            self.best = min(self.best, self.unit_m * math.sqrt(fit.cost))
        whole = sum(r.count(self.starts) * r.evaluations * r.points for r in ROUNDS)
        self.tell(min(0.99, self.work / whole))

    def tell(self, share: float) -> None:
        """Tell whom it concerns."""
        if self.progress is not None:
            self.progress(share, self.best)


def fitted(
    starts: Sequence[Fitted], path: UnitPath, clock: Clock, transmission_rad: float = 0.0
) -> list[Fitted]:
    """The fits of the last round that was begun, the best first; with those of the round before for
    which the time did not last. One fit is made in any case."""
    current = list(starts)
    for number, each in enumerate(ROUNDS):
        current = current[: each.count(len(starts))]
        done: list[Fitted] = []
        for start in current:
            if clock.is_over and (done or number > 0):
                clock.complete = False
                break
            done.append(_fit(start, path, each, transmission_rad))
            clock.fitted(each, done[-1])
        rest = current[len(done) :] if number > 0 else []
        current = _apart(sorted(done + rest, key=lambda fit: (fit.size > TOO_LARGE, fit.cost)))
        if not clock.complete:
            break
    return current


def _fit(start: Fitted, path: UnitPath, each: Round, transmission_rad: float) -> Fitted:
    """A fit over some of the points, with the crank's angles in all of them; the start, where the
    fit grows too large."""
    own = path.mirrored if start.mirrored else path
    keep = np.arange(len(own.points)) if each.points >= len(own.points) else own.kept(each.points)
    fit = refit(
        replace(start, phi=start.phi[keep]), own.only(keep), each.evaluations, transmission_rad
    )
    change = np.interp(np.arange(len(own.points)), keep, fit.phi - start.phi[keep])
    grows = fit.size > TOO_LARGE >= start.size and math.isfinite(start.cost)
    return start if grows else replace(fit, phi=start.phi + change)


def _apart(fits: Sequence[Fitted]) -> list[Fitted]:
    """Fits without those that come near a better one: they would end in the same mechanism."""
    kept: list[Fitted] = []
    for fit in fits:
        low, high = (np.array(side) for side in zip(*BOUNDS[fit.family], strict=True))
        near = (
            one.family == fit.family
            and one.mirrored == fit.mirrored
            and np.max(np.abs(one.x - fit.x) / (high - low)) < APART
            and np.max(np.abs(one.placing - fit.placing)) < APART * np.max(np.abs(fit.placing))
            for one in kept
        )
        if not any(near):
            kept.append(fit)
    return kept
