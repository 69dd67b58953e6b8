"""Hard free runs: a chain of windows compared with its closed form (`analytic.free.exact_motions`),
and a mechanism that is thrown at its toggle."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from analytic.free.exact_motions import ChainMotion, ToggleBarrier
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene.hard import WindowChain
from reports.compare.branch import AWAY_RAD, CLOSED, HERE_RAD
from reports.compare.errors import Departure
from sim.engine import Run


@dataclass(frozen=True)
class ChainErrors:
    """Errors of an engine on a chain, at the logged samples, shape (T,).

    ``place_m`` is the distance of B0 from its true position [m], ``energy_j`` the energy less that
    of the start in the closed form [J], at the instants of the velocities; ``lean_rad`` the largest
    angle between two rockers, or of a coupler to the ground line [rad], 0 in the closed form;
    ``gap_m`` the largest gap of a pin [m].
    """

    chain: WindowChain
    run: Run
    time_s: Array
    place_m: Array
    energy_j: Array
    lean_rad: Array
    gap_m: Array

    @property
    def left(self) -> Departure | None:
        """Place where a rod began to leave the others, if one came to an angle to them while the
        pins were closed; the rod, and the angle of the first rocker there."""
        closed = self.gap_m < CLOSED * self.chain.length_m
        away = np.flatnonzero(closed & ~(self.lean_rad < AWAY_RAD))
        if not away.size or self.run.motion is None:
            return None
        here = np.flatnonzero(self.lean_rad[: away[0]] < HERE_RAD)
        index = int(here[-1]) if here.size else 0
        angle = self.run.motion.links["rocker0"].theta[index]
        rod = _leaning(self.chain, self.run.motion, int(away[0]))
        return Departure(rod, float(self.time_s[index]), float(angle))


def compared(chain: WindowChain, done: Run) -> ChainErrors:
    """Return the comparison of a free run of the chain. Raises CrankcheckError without a log."""
    if done.motion is None or done.energy is None:
        why = done.reason or f"it was run under the drive {done.drive}"
        raise CrankcheckError(f"{done.scene} in {done.engine}: no free motion to compare: {why}")
    motion, turning = done.motion, ChainMotion(chain)
    theta, _, _ = turning.at(motion.time_s)
    arm = chain.length_m * np.stack([np.cos(theta), np.sin(theta)], axis=-1)
    with np.errstate(all="ignore"):  # a run that came apart may overflow
        return ChainErrors(
            chain,
            done,
            motion.time_s,
            np.hypot(*(motion.points["B0"].position - arm).T),
            done.energy.total_j - start_j(turning),
            _lean(chain, motion),
            np.max(list(done.gaps.values()), axis=0),
        )


def start_j(turning: ChainMotion) -> float:
    """Return the energy of the start, upright [J]."""
    theta, omega, _ = turning.at(np.array([0.0]))
    return float(turning.energy(theta, omega)[0])


def _leaning(chain: WindowChain, motion: Motion, index: int) -> str:
    """Return the rod at the largest angle to the rods parallel to it in the closed form."""
    angles = {name: float(motion.links[name].theta[index]) for name in chain.rockers()}
    middle = float(np.median(list(angles.values())))
    off = {name: abs(angle - middle) for name, angle in angles.items()}
    off |= {name: abs(float(motion.links[name].theta[index])) for name in chain.couplers()}
    return max(off, key=lambda name: off[name])


def _lean(chain: WindowChain, motion: Motion) -> Array:
    """Return the largest angle between rods that are parallel in the closed form [rad], (T,)."""
    rockers = np.stack([motion.links[name].theta for name in chain.rockers()])
    couplers = [np.abs(motion.links[name].theta) for name in chain.couplers()]
    spread: Array = np.max([np.ptp(rockers, axis=0), *couplers], axis=0)
    return spread


Passage = Literal["over", "back", "undecided", "broken"]
OVER = -0.5
"""Part of the way from toggle to start: a run that is so far beyond the toggle has passed it."""
NEAR = 0.5
"""The same before the toggle: a run that comes nearer and turns back was near it."""


@dataclass(frozen=True, eq=False)
class TogglePassage:
    """Result of a run: ``outcome``, at the sample ``index`` (the last if neither over nor back).

    ``open_rad`` (T,) is the remaining angle of coupler and rocker until they are in line: negative
    in the other assembly. ``nearest_rad`` is its least value until the outcome.
    """

    outcome: Passage
    index: int
    open_rad: Array

    @property
    def nearest_rad(self) -> float:
        return float(np.min(self.open_rad[: self.index + 1]))


def toggle_passage(barrier: ToggleBarrier, run: Run) -> TogglePassage:
    """Return the outcome of a run that was thrown at a toggle.

    A run is broken where it did not end as it should, or has a pin open by more than
    `reports.compare.branch.CLOSED` of the longest link before it is decided; undecided where it has
    come neither over nor back to its start by its end. It has to have logged its motion.
    """
    motion = run.motion
    assert motion is not None
    one, other = barrier.links
    with np.errstate(all="ignore"):  # a run that came apart may overflow
        turned = motion.links[other].theta - motion.links[one].theta
        share = 1.0 + (turned - turned[0]) / barrier.open_rad
        gap = np.max([np.abs(pin) for pin in run.gaps.values()], axis=0)
        apart = gap > CLOSED * barrier.scene.longest_m
    near = np.maximum.accumulate(share < NEAR)
    ends: dict[Passage, Array] = {
        "over": share <= OVER,
        "back": near & (share >= 1.0),
        "broken": apart | ~np.isfinite(share),
    }
    first = {name: int(np.argmax(at)) for name, at in ends.items() if at.any()}
    outcome: Passage = "undecided" if run.status == "ok" else "broken"
    if first:
        outcome = min(first, key=lambda name: first[name])
        return TogglePassage(outcome, first[outcome], abs(barrier.open_rad) * share)
    return TogglePassage(outcome, len(share) - 1, abs(barrier.open_rad) * share)
