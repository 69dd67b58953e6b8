"""Step of a gear train: the angles of its links, constant shares of known angles."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction

import numpy as np

from analytic.change_points.turns import CellSolver, Counter, Turns
from analytic.dyads.chunk import SINES, Chunk, Passage, driver_scale
from analytic.dyads.plane import EPS, STEADY, AngleError, BodyKinematics, Real, Vec
from analytic.dyads.riding import PlacedBodies
from analytic.dyads.steps import PeriodicStep, Step, common_period, stretched
from analytic.structure.gear_groups import GearGroup
from models.array import Array
from models.errors import CrankcheckError
from models.scene import GROUND

MOST_TURNS = 128
"""Most turns of the driver after which a linkage behind gears may come back."""


class GearStep(PeriodicStep):
    """Links on known pins, at angles that are shares of known ones.

    ``before`` are the steps of the bodies before it; with ``leads`` other groups hang on it.
    """

    def __init__(
        self, placed: PlacedBodies, train: GearGroup, before: Sequence[Step], *, leads: bool
    ) -> None:
        self.train, self.leads, self.before = train, leads, tuple(before)
        self.key = f"gears {', '.join(gear.name for gear in train.gears)}"
        self.scene = scene = placed.scene
        self._start = float(scene.driver.law.at(np.zeros(1))[0][0]) / driver_scale(scene)
        self._counted: dict[tuple[str, ...], Turns] = {}
        """By the keys of the change points that were known."""
        at = scene.points_of
        radii = [min(g.teeth) * g.slip_m(at) for g in train.gears if g.carrier != GROUND]
        self.firmness = min([*radii, scene.longest_m]) / scene.longest_m
        """Least pitch radius on a moving carrier, over the longest link: a slip by the arc of a
        step turns a gear by the inverse of it."""
        known = placed.known
        self.links: list[tuple[str, str, str, Mapping[str, float], float]] = []
        for body, pin in zip(train.bodies, train.pins, strict=True):
            holder = PlacedBodies(scene, placed.structure, known).holder(pin)
            shares = {name: float(share) for name, share in train.shares(body).items() if share}
            self.links.append((body, pin, holder, shares, train.phase_rad(body)))
            known |= {body}

    def advance(self, chunk: Chunk) -> None:
        angles = {name: self._angle(chunk, name) for name in self.train.known}
        for body, pin, holder, shares, phase in self.links:
            anchor = chunk.point(holder, pin)
            local = self.scene.links[body].points[pin]
            theta: Real = phase
            omega: Real = 0.0
            alpha: Real = STEADY
            error = AngleError(SINES + EPS * abs(phase), 0.0, 0.0)
            for name, share in shares.items():
                own, size = chunk.bodies[name], abs(share)
                theta = theta + share * angles[name]
                omega = omega + share * own.omega
                if own.alpha is not STEADY:
                    alpha = alpha + share * own.alpha
                if (off := own.error) is not None:
                    error = AngleError(
                        error.theta + size * off.theta + 2 * EPS * size * np.abs(angles[name]),
                        error.omega + size * off.omega + 2 * EPS * size * np.abs(own.omega),
                        error.alpha + size * off.alpha + 2 * EPS * size * np.abs(own.alpha),
                    )
            turn = Vec(np.cos(theta), np.sin(theta))
            bound = error if chunk.certified else None
            chunk.bodies[body] = BodyKinematics(local, anchor, turn, omega, alpha, bound, theta)
        chunk.sines[self.key] = np.full_like(chunk.theta, self.firmness)

    def _angle(self, chunk: Chunk, name: str) -> Real:
        """Return the angle of a known body [rad], whole turns counted from time 0 on."""
        body = chunk.bodies[name]
        if body.theta is not None:
            return body.theta
        angle = np.broadcast_to(np.arctan2(body.turn.y, body.turn.x), chunk.theta.shape).copy()
        Counter(self._turns(chunk.passages), chunk.theta).count(name, angle)
        return angle

    def _turns(self, passages: Mapping[str, Passage]) -> Turns:
        """Return the whole turns of the bodies before the train."""
        own = {step.key: passages[step.key] for step in self.before if step.key in passages}
        if (found := self._counted.get(tuple(own))) is None:
            look = CellSolver(self.scene, self.before, own)
            found = Turns.of(look, self._start, common_period(self.before, own))
            self._counted[tuple(own)] = found
        return found

    def period(self, passages: Mapping[str, Passage], base: float) -> float | None:
        """Return the driver angle after which its links stand as at first [rad]; that of the known
        bodies where nothing hangs on it. Raises CrankcheckError for more than `MOST_TURNS`."""
        own = {step.key: passages[step.key] for step in self.before if step.key in passages}
        if not self.leads or self.scene.driver.slider is not None:
            return base
        ends: Array = np.array([self._start, self._start + base])
        chunk = stretched(self.scene, (*self.before, self), ends, own)
        gains = []
        for body in self.train.bodies:
            theta: Real = chunk.bodies[body].theta
            turned = float(np.ptp(np.broadcast_to(theta, ends.shape))) / math.tau
            gains.append(Fraction(turned).limit_denominator(10**6))
        back = math.lcm(*(gain.denominator for gain in gains)) * base
        if back > (MOST_TURNS + 0.5) * math.tau:
            raise CrankcheckError(
                f"{self.scene.name}: the links on its gears return after {back / math.tau:.0f} "
                "turns of the driver; linkages on gears are solved if they return after at "
                f"most {MOST_TURNS}: choose numbers of teeth with a simpler ratio"
            )
        return back
