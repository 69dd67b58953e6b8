"""Velocities and accelerations: their instants, and their agreement with the positions.

They are compared with the engine's own path, which may be off as a whole: its differences, and
their change in the reference, show by how many steps a rate is late or early.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from analytic.kinematics import solve
from models.array import Array
from reports.contract.subject import Subject, clause
from sim.engine import Session
from sim.engine.measure import motion

STEPS = 800
"""Number of steps in one turn."""
LATE = 0.25
"""Largest distance of a rate from its stated instant, in steps."""
OFF = 0.05
"""Largest difference of a rate to the path's own, over the largest of that body."""
SLOW = 1e-2
"""Rate, over the scale of the scene, below which it counts as 0: its differences are rounding, or
the give of joints."""
STILL = 1e-3
"""Change of a rate, over the largest of all, below which its instant is undetermined."""


@dataclass(frozen=True)
class _Rate:
    """A rate of a body (T, n) as reported, by its path's differences, and the change of these in
    the reference; without the start, in which an engine may settle. ``scale`` is that of a body as
    fast as the driver, as long as the longest link."""

    body: str
    reported: Array
    own: Array
    change: Array
    scale: float

    def late_s(self) -> float:
        """Return its delay against the path's own [s]."""
        return float((self.reported - self.own).ravel() @ self.change.ravel()) / float(
            (self.change**2).sum()
        )

    def off(self, shift_s: float) -> float:
        """Return its difference to the path's own, that much later, over its own largest."""
        size = max(float(np.abs(self.own).max()), SLOW * self.scale)
        return float(np.abs(self.reported - self.own - shift_s * self.change).max()) / size


@clause(
    "EC41",
    "velocities belong to the instant that the facts state, and to the places",
    "A velocity changes in half a step by more than most of its errors.",
    "Set Facts.velocity_shift (in steps) and Poses.lag_s (velocity_shift * dt_s): -0.5 where "
    "velocities are stepped before places, 0.5 where after them, 0 where both are of one "
    "instant.",
)
def _velocities(subject: Subject) -> Iterator[str]:
    session = subject.opened(steps=STEPS)
    said, lag_s = session.facts().velocity_shift, session.facts().start.lag_s
    rates = _of_log(subject, session, 1)
    yield from _faults(rates, said, subject.dt_s(STEPS), "velocity", "velocity_shift")
    if abs(lag_s / subject.dt_s(STEPS) - said) > 1e-6:
        lag = lag_s / subject.dt_s(STEPS)
        yield f"Poses.lag_s is {lag:.3g} steps, and Facts.velocity_shift {said:.3g}"


@clause(
    "EC42",
    "accelerations are reported as declared, and belong to the instant that the facts state",
    "A missing acceleration is not zero, and the one before a step is not the present one.",
    "Give NaN for all if there are none, with reports_accelerations=False; else set "
    "Facts.acceleration_shift.",
)
def _accelerations(subject: Subject) -> Iterator[str]:
    reports, log = subject.engine.reports_accelerations, subject.opened().record(20, 1)
    for name, body in log.poses.bodies.items():
        given = np.concatenate([body.alpha, body.origin_acceleration.ravel()])
        if not (np.isfinite(given) if reports else np.isnan(given)).all():
            wrong = "finite" if reports else "NaN"
            yield f"reports_accelerations is {reports}, and those of {name} are not all {wrong}"
            return
    if not reports:
        return
    session = subject.opened(steps=STEPS)
    said, rates = session.facts().acceleration_shift, _of_log(subject, session, 2)
    yield from _faults(rates, said, subject.dt_s(STEPS), "acceleration", "acceleration_shift")


def _of_log(subject: Subject, session: Session, order: int) -> list[_Rate]:
    """Return the rates of links and points over a turn: velocities for 1, accelerations for 2."""
    held = motion(subject.scene, session.record(STEPS, 1).poses)
    truth = solve(subject.scene, held.time_s, bound=False)
    dt_s, rates = subject.dt_s(STEPS), []
    turning = subject.scene.pace_rad_s**order
    for kind, scale in (("link", turning), ("point", subject.scene.longest_m * turning)):
        others = getattr(truth, f"{kind}s")
        for name, body in getattr(held, f"{kind}s").items():
            series, (*_, true) = [*vars(body).values()], vars(others[name]).values()
            paths = _differences(series[0], series[order], true, dt_s, order)
            rates.append(_Rate(f"{kind} {name}", *paths, scale))
    return rates


def _differences(
    place: Array, reported: Array, true: Array, dt_s: float, order: int
) -> tuple[Array, Array, Array]:
    """Return the reported rate, the path's own, and its change in the reference."""
    own = (place[2:] - place[:-2]) / (2 * dt_s)
    change = true[1:-1]
    if order == 2:
        own = (place[2:] - 2 * place[1:-1] + place[:-2]) / dt_s**2
        change = (true[2:] - true[:-2]) / (2 * dt_s)
    later = slice(len(own) // 8, None)
    return reported[1:-1][later], own[later], change[later]


def _faults(rates: list[_Rate], said: float, dt_s: float, what: str, where: str) -> Iterator[str]:
    """Yield the bodies whose rates are farthest from the stated instant, and from the path."""
    for kind in ("link", "point"):
        same = [rate for rate in rates if rate.body.startswith(kind)]
        change = max(float(np.sqrt((rate.change**2).mean())) for rate in same)
        moving = [r for r in same if np.sqrt((r.change**2).mean()) > STILL * change]
        if moving and change:
            late = {rate.body: rate.late_s() / dt_s for rate in moving}
            worst = max(late, key=lambda body: abs(late[body] - said))
            if not abs(late[worst] - said) <= LATE:
                yield (
                    f"the {what} of {worst} belongs {late[worst]:+.2f} steps from its sample, "
                    f"and {where} is {said:+.2f}"
                )
                return
        off = {rate.body: rate.off(said * dt_s) for rate in same}
        worst = max(off, key=lambda body: off[body])
        if not off[worst] <= OFF:
            yield f"the {what} of {worst} does not fit its places: error {off[worst]:.2g}"
            return
