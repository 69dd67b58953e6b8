"""Steps of an integration, passages through change points, and the resulting state."""

import itertools
import math
from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.polynomial import Chebyshev
from scipy.integrate import OdeSolution  # type: ignore[import-untyped]  # ships no stubs
from scipy.interpolate import CubicHermiteSpline  # type: ignore[import-untyped]  # ships no stubs

from analytic.multibody.dynamics import Dynamics
from analytic.multibody.generalised_forces import Strokes, edges, state_cells, strokes, switches
from models.array import Array
from models.errors import CrankcheckError, few
from models.scene import Scene

WINDOWS = {25.0: 12, 12.0: 12, 6.0: 12, 3.0: 8, 1.5: 6}
"""Duration of the motion before that counts, over that of the passage, and the degree of the
polynomials: a long time spreads errors of accelerations, a short one follows fast changes, and is
the only one after a recent jump."""
LONG = 6.0
"""Shortest preferred duration: shorter ones are taken where none of the others will do."""
SAMPLES = 24
OFF = 1e-9
"""Largest correction of coordinates on the other side, in their units."""


@dataclass(frozen=True)
class SingularPassage:
    """Passage from ``begin_s`` to ``end_s`` through a change point at ``at_s`` [s].

    In a change point the rows of the Jacobian depend on each other, and next to it the
    accelerations are lost in rounding, by eps over the square of the smallest singular value. The
    motion itself is smooth there: polynomials through its accelerations of a while before carry
    them over the gap, where they are integrated from the state at its start. On the other side the
    motion has to be on the constraints again, to rounding, as only a motion through the change
    point itself is: one that misses it by a little turns off, however shortly, into the other
    branch.
    """

    begin_s: float
    at_s: float
    end_s: float
    course: tuple[Chebyshev, ...]

    def state(self, time_s: Array) -> Array:
        """Return the state at times [s], (2 n + 1, T)."""
        return np.array([one(np.asarray(time_s)) for one in self.course])

    def slope(self, time_s: Array) -> Array:
        """Return its derivative by time."""
        return np.array([one.deriv()(np.asarray(time_s)) for one in self.course])


def singular_at(
    dynamics: Dynamics, within: Callable[[Array], Array], now_s: float, back_s: float
) -> float:
    """Return the time of a zero singular value, as it falls now [s]; infinite where it grows.

    ``within`` gives the state at times up to now, at least as far as ``back_s`` [s].
    """
    states = within(np.array([now_s - back_s, now_s]))[: dynamics.assembly.size]
    before, now = (smallest_singular(dynamics, q) for q in states.T)
    return now_s + back_s * now / (before - now) if now < before else math.inf


def passage_ahead(
    dynamics: Dynamics,
    solution: Callable[[Array], Array],
    clear_s: float,
    now_s: float,
    at_s: float,
    strokes: Strokes,
) -> SingularPassage | None:
    """Return the passage that begins now, if the motion goes through a change point.

    Parameters
    ----------
    dynamics : Dynamics
        The mechanism.
    solution : Callable
        The state at times up to now.
    clear_s, now_s, at_s : float
        Times of the last jump, of now, and of the expected change point [s].
    strokes : Strokes
        Activity of the loads on one stroke.
    """
    width_s = 2.0 * (at_s - now_s)
    least, best = OFF, None
    for window, degree in WINDOWS.items():
        if window * width_s > now_s - clear_s or (best and window < LONG):
            continue
        course = _course(dynamics, solution, now_s, window * width_s, degree, strokes)
        passage = SingularPassage(now_s, at_s, now_s + width_s, course)
        if (off := _open(dynamics, passage)) <= least:
            least, best = off, passage
    return best


def _course(
    dynamics: Dynamics,
    solution: Callable[[Array], Array],
    now_s: float,
    window_s: float,
    degree: int,
    strokes: Strokes,
) -> tuple[Chebyshev, ...]:
    """Return the state from now on [s], from its slopes of a while before."""
    # Points that lie closer towards both ends, where polynomials swing.
    lean = np.cos(np.pi * (np.arange(SAMPLES) + 0.5) / SAMPLES)
    times = now_s - 0.5 * window_s * (1.0 + lean)
    slopes = []
    for time_s, state in zip(times, solution(times).T, strict=True):
        slopes.append(dynamics.rates(time_s, dynamics.closed_state(state), strokes))
    begin, n = solution(np.array([now_s]))[:, 0], dynamics.assembly.size

    def integrated(slope: Chebyshev, value: float) -> Chebyshev:
        return slope.integ(lbnd=now_s, k=value)

    domain = [now_s - window_s, now_s]
    fits = [Chebyshev.fit(times, own, degree, domain=domain) for own in np.array(slopes).T[n:]]
    last = [integrated(fit, value) for fit, value in zip(fits, begin[n:], strict=True)]
    places = [integrated(rate, value) for rate, value in zip(last, begin[:n], strict=False)]
    return (*places, *last)


def smallest_singular(dynamics: Dynamics, q: Array) -> float:
    """Return the smallest singular value of the constraints that count at coordinates (n,)."""
    assembly = dynamics.assembly
    rows = assembly.scaled(assembly.joints.jacobian(assembly.at_rest(q[None]))[0])
    return float(np.linalg.svd(rows, compute_uv=False)[dynamics.rank - 1])


def _open(dynamics: Dynamics, passage: SingularPassage) -> float:
    """Return the distance of the other end from the constraints, in the units of coordinates."""
    n = dynamics.assembly.size
    state = passage.state(np.array([passage.end_s]))[:, 0]
    off = (dynamics.closed_state(state) - state)[:n] / dynamics.assembly.units
    return float(np.abs(off).max())


@dataclass(frozen=True)
class StateHistory:
    """``state`` over time [s], (2 n + 1, T); ``passages`` are the change points on the way."""

    state: Callable[[Array], Array]
    steps: int
    passages: tuple[SingularPassage, ...] = ()


LARGEST = 1e12
"""Largest coordinate or rate, over its unit: beyond it a motion has diverged."""


@dataclass(frozen=True)
class FixedSteps:
    """Method of Runge and Kutta of order 4 with equal steps, as in the thesis on elastic
    mechanisms; in between cubics, of the same order. Edges over time are at steps."""

    dynamics: Dynamics
    step_s: float

    def history(self, q: Array, rates: Array, until_s: float) -> StateHistory:
        """Integrate from a state to a time [s]. Raises CrankcheckError where it diverges."""
        own = switches(self.dynamics.forces)
        state = np.concatenate([q, rates, [0.0]])
        times, states, slopes = [], [], []
        edge = edges(self.dynamics.assembly.scene, until_s)
        for begin, end in itertools.pairwise(edge):
            count = max(1, math.ceil((end - begin) / self.step_s * (1.0 - 1e-9)))
            h, last = (end - begin) / count, math.nextafter(end, begin)
            for i in range(count):
                at_s = begin + i * h
                held = strokes(own, state_cells(own, self.dynamics.forces, state))
                slope, state_after = self._step(at_s, h, last, state, held)
                times.append(at_s)
                states.append(state)
                slopes.append(slope)
                state = state_after
                self._check(state, at_s + h)
        held = strokes(own, state_cells(own, self.dynamics.forces, state))
        times.append(until_s)
        states.append(state)
        slopes.append(self.dynamics.rates(until_s, state, held))
        spline = CubicHermiteSpline(np.array(times), np.array(states), np.array(slopes))
        return StateHistory(lambda time_s: np.asarray(spline(time_s).T), len(times) - 1)

    def _step(
        self, at_s: float, h: float, last: float, state: Array, held: Strokes
    ) -> tuple[Array, Array]:
        """Return the slope at the start of a step, and the state at its end."""
        rates = self.dynamics.rates
        with np.errstate(all="ignore"):
            k1 = rates(at_s, state, held)
            k2 = rates(min(at_s + 0.5 * h, last), state + 0.5 * h * k1, held)
            k3 = rates(min(at_s + 0.5 * h, last), state + 0.5 * h * k2, held)
            k4 = rates(min(at_s + h, last), state + h * k3, held)
        return k1, state + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)

    def _check(self, state: Array, time_s: float) -> None:
        if not np.abs(state).max() < LARGEST:
            raise CrankcheckError(
                f"{self.dynamics.assembly.scene.name}: with steps of {self.step_s:g} s the motion "
                f"comes apart at {time_s:g} s; take smaller ones, or a smaller alpha and beta"
            )


SHARE = 0.9
"""Share of the time of a lost motion: the speed after it is compared with that before."""
MANY = 100.0
"""Growth of the speed since then that counts as without bound."""
FEW = 0.05
"""Share of steps that end at edges over time, up to which these are not why steps are short."""


@dataclass
class Pace:
    """Speeds of a motion at the ends of its steps: the largest up to each of them, and the last;
    ``edges`` are the numbers of steps that edges over time end."""

    times_s: list[float] = field(default_factory=list)
    largest: list[float] = field(default_factory=list)
    last: float = 0.0
    edges: list[int] = field(default_factory=list)

    def note(self, time_s: float, speed: float) -> None:
        """Note the start of the motion, or the end of a step."""
        self.times_s.append(time_s)
        self.largest.append(max(speed, self.largest[-1]) if self.largest else speed)
        self.last = speed

    def end_at_edge(self) -> None:
        """Note that the last step ended at an edge over time."""
        self.edges.append(self.made)

    @property
    def made(self) -> int:
        """Number of steps."""
        return len(self.times_s) - 1

    def lasted_s(self, count: int) -> float:
        """Return the duration of the last ``count`` steps [s]; infinite where there are fewer, or
        where edges over time made them short."""
        first = self.made - count
        if first < 0 or len(self.edges) - bisect_right(self.edges, first) > FEW * count:
            return math.inf
        return self.times_s[-1] - self.times_s[first]

    def check_runaway(self, scene: Scene, lost_s: float) -> None:
        """Refuse a motion lost at ``lost_s`` [s] by an unbounded speed. Raises CrankcheckError.

        The speed is compared with the largest one before: a motion that turns back is slow for a
        while.

        A load that grows with the square of the speed that it drives, v' = c v^2, has v = 1 / (c
        (t* - t)): no step leads to t*, whatever its size.
        """
        before = self.largest[bisect_right(self.times_s, SHARE * lost_s) - 1]
        if not self.last > MANY * before:
            return
        over = [load for load in scene.loads.values() if load.over != "time"]
        named = few([f"loads.{load.name} over {load.over}" for load in over], 6) or "what acts"
        raise CrankcheckError(
            f"{scene.name}: it runs away: at about {lost_s:.4g} s its speed goes to infinity, "
            f"and is over {MANY:g} times what it was up to {SHARE * lost_s:.3g} s; {named} "
            f"drives it faster and faster: give a time of {SHARE * lost_s:.2g} s or less, or a "
            "load that grows no faster than its speed or path"
        )


MOST_STEPS = 1_000_000
FIRST_STEPS, FAR = 2_000, 2.0
"""Number of steps after which the total is foretold, and the excess at which it is refused."""

CROWD = 200
"""Number of last steps from which the total is foretold."""


@dataclass
class Steps:
    """Steps of an integration: their ``pace`` with the times between them, and the state ``within``
    each; ``clear_s`` is the time of the last jump. ``careful`` if a change point may be near,
    ``tried`` the smallest singular value at which a passage through it was last looked for in
    vain."""

    pace: Pace
    until_s: float
    within: list[Callable[[Array], Array]] = field(default_factory=list)
    passages: list[SingularPassage] = field(default_factory=list)
    clear_s: float = 0.0
    careful: bool = False
    tried: float = math.inf

    def add(self, end_s: float, within: Callable[[Array], Array], speed: float) -> None:
        self.pace.note(end_s, speed)
        self.within.append(within)

    @property
    def times(self) -> list[float]:
        return self.pace.times_s

    @property
    def solution(self) -> OdeSolution:
        return OdeSolution(self.times, self.within)

    @property
    def crowded(self) -> bool:
        """True if the remaining time would take too many steps, as short as the last ones; it is
        checked now and then."""
        made, now_s = self.pace.made, self.times[-1]
        if made < CROWD or made % CROWD:
            return False
        return (self.until_s - now_s) * CROWD > FAR * MOST_STEPS * self.pace.lasted_s(CROWD)

    def check_count(self, name: str, now_s: float) -> None:
        """Refuse a time of a scene that takes too many steps. Raises CrankcheckError."""
        made = len(self.times)
        ahead = made * self.until_s / now_s
        if made > MOST_STEPS or (made >= FIRST_STEPS and ahead > FAR * MOST_STEPS):
            raise CrankcheckError(
                f"{name}: free for {self.until_s:g} s, of which "
                f"{now_s:.3g} s took {made} steps of the integration; at most {MOST_STEPS} are "
                "made, and a load that is switched by the motion may hold it in place, or a "
                f"spring or damper is too stiff: give a time of {now_s * MOST_STEPS / made:.2g} s "
                "or less, or a softer one"
            )
