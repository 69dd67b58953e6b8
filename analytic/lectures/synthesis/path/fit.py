"""Least-squares fit of a coupler curve to points, from a start on.

The unknowns are the three numbers of a shape, the three complex numbers that place it, and the
crank's angles: one in all with timing, one for each point without. Then the residuals are those to
the nearest points of the curve, which is an orthogonal fit. Derivatives are exact. Each number but
the angles stays in its box, as the sine of an unknown: so a fully turning crank keeps turning.

Source: G. H. Golub and V. Pereyra, SIAM Journal on Numerical Analysis 10 (1973) (that the placing
numbers, in which the curve is linear, follow from the others, gives the starts here); S. J. Ahn,
Least Squares Orthogonal Distance Fitting of Curves and Surfaces in Space, chapter 2.
"""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import least_squares  # type: ignore[import-untyped]  # ships no stubs

from analytic.lectures.synthesis.path import task
from analytic.lectures.synthesis.path.task import MOST, UnitPath
from models.array import Array

LARGEST = 12.0
"""Largest placing numbers, over the radius of the path."""
TOO_LARGE = 2.0 * LARGEST
"""Largest link of a useful mechanism, over the radius of the path."""
PENALTY = 3.0
"""Weight of a dyad that does not close, over the radius of the path."""
STRICT = 20.0
"""Weight of a transmission angle that is too small, over that of all points."""
INSIDE = 0.999
"""Largest offset of a start, over half the box: at its wall the sine does not change."""
BOXED = slice(0, 9)
"""Unknowns in a box: three numbers of a shape, and three complex numbers that place it."""


@dataclass(frozen=True)
class Fitted:
    """Four-bar near the points of a unit path: numbers of its shape, placing numbers O, G, Q, and
    the crank's angles [rad] from the ground on. ``cost`` is the mean square of the distances,
    ``mirrored`` is True for the mirror image of the points."""

    family: task.Family
    x: Array
    placing: task.Complexes
    phi: Array
    cost: float
    mirrored: bool = False

    @property
    def size(self) -> float:
        """Longest of its links, over the radius of the path."""
        _, ground, arm = self.placing
        shape = task.lengths(self.family, self.x)
        far = np.abs([arm, arm - ground * shape[1]])
        return float(max(np.abs(ground) * max(1.0, *(float(each) for each in shape)), *far))


def placed(
    lengths_of: tuple[Array, Array, Array], phi: Array, points: task.Complexes
) -> task.Complexes:
    """Return the placing numbers O, G, Q that fit points best, by linear least squares, (3,)."""
    u, _ = task.direction(lengths_of, phi)
    columns = np.stack([np.ones_like(u), lengths_of[0] * np.exp(1j * phi), u], axis=1)
    return np.asarray(np.linalg.lstsq(columns, points, rcond=1e-9)[0])


def refit(start: Fitted, path: UnitPath, evaluations: int, transmission_rad: float = 0.0) -> Fitted:
    """Return the four-bar of least squares near a start, after so many evaluations at most; a crank
    that turns fully keeps a least transmission angle [rad], or little less."""
    problem = _Problem(start.family, path, transmission_rad)
    result = least_squares(
        problem.residuals,
        problem.packed(start),
        problem.jacobian,
        method="lm",
        x_scale="jac",
        ftol=1e-12,
        xtol=1e-12,
        gtol=1e-14,
        max_nfev=evaluations,
    )
    return replace(
        problem.unpacked(result.x),
        cost=2.0 * float(result.cost) / len(path.points),
        mirrored=start.mirrored,
    )


@dataclass(frozen=True)
class _Problem:
    """Residuals over the unknowns, both as real numbers."""

    family: task.Family
    path: UnitPath
    transmission_rad: float = 0.0

    @property
    def box(self) -> tuple[Array, Array]:
        """Middle and half width of shape and placing numbers, (9,)."""
        low, high = np.array(task.BOUNDS[self.family]).T
        middle = np.concatenate([0.5 * (low + high), np.zeros(6)])
        return middle, np.concatenate([0.5 * (high - low), np.full(6, LARGEST)])

    def packed(self, fit: Fitted) -> Array:
        """Return the unknowns of a four-bar: numbers in a box as the arc sine of their share."""
        placing = np.stack([fit.placing.real, fit.placing.imag], axis=1).ravel()
        angles = fit.phi if self.path.turned is None else fit.phi[:1]
        middle, half = self.box
        share = (np.concatenate([fit.x, placing]) - middle) / half
        return np.concatenate([np.arcsin(np.clip(share, -INSIDE, INSIDE)), angles])

    def unpacked(self, z: Array) -> Fitted:
        """Return the four-bar of unknowns."""
        middle, half = self.box
        inner = middle + half * np.sin(z[BOXED])
        placing = inner[3::2] + 1j * inner[4::2]
        return Fitted(self.family, inner[:3], placing, self._phi(z), 0.0)

    def residuals(self, z: Array) -> Array:
        """Return the distances from the points, then the gap of the dyad where it may be open."""
        fit = self.unpacked(z)
        a, b, c = (float(each) for each in task.lengths(self.family, fit.x))
        at = task.turn((a, b, c), fit.phi)
        origin, ground, arm = fit.placing
        off = origin + ground * a * np.exp(1j * fit.phi) + arm * at.u - self.path.points
        opened = [PENALTY * at.excess] if self.family == "limited" else []
        strained = [self._strained((a, b, c))[0]] if self._is_strict else []
        return np.concatenate([off.real, off.imag, *opened, *strained, np.zeros(self._spare)])

    def jacobian(self, z: Array) -> Array:
        """Return their derivatives, (residuals, unknowns)."""
        fit = self.unpacked(z)
        a, b, c = (float(each) for each in task.lengths(self.family, fit.x))
        at = task.turn((a, b, c), fit.phi)
        _, ground, arm = fit.placing
        e, one = a * np.exp(1j * fit.phi), np.ones_like(at.u)
        by_shape = task.lengths_jacobian(self.family, fit.x)
        by_angle = 1j * ground * e + arm * at.d_phi
        by_lengths = arm * at.d_shape
        by_lengths[0] += ground * e / a
        columns = [*(by_shape @ by_lengths), one, 1j * one, e, 1j * e, at.u, 1j * at.u]
        fixed = np.array(columns).T
        off = np.hstack([fixed, self._spread(by_angle)])
        rows = [off.real, off.imag]
        if self.family == "limited":
            shut = np.zeros((len(e), 9))
            shut[:, :3] = (by_shape @ at.d_excess).T
            by_phi = self._spread(at.d_excess_phi.astype(np.complex128)).real
            rows.append(PENALTY * np.hstack([shut, by_phi]))
        if self._is_strict:
            strained = np.zeros((2, 9 + self._angles))
            strained[:, :3] = self._strained((a, b, c))[1] @ by_shape.T
            rows.append(strained)
        every = np.concatenate([*rows, np.zeros((self._spare, rows[0].shape[1]))])
        every[:, BOXED] *= self.box[1] * np.cos(z[BOXED])
        return np.asarray(every)

    @property
    def _angles(self) -> int:
        """Number of the crank's angles among the unknowns."""
        return len(self.path.points) if self.path.turned is None else 1

    @property
    def _spare(self) -> int:
        """Number of zero residuals for few points: the library wants as many as unknowns."""
        return max(0, 9 + self._angles - 2 * len(self.path.points))

    @property
    def _is_strict(self) -> bool:
        """True if the transmission angle counts: with limits, it is small at these in any case."""
        return self.transmission_rad > 0.0 and self.family != "limited"

    def _strained(self, shape: tuple[float, float, float]) -> tuple[Array, Array]:
        """Return the excess of the cosines of the transmission angle, where A is nearest to O4 and
        farthest, over the allowed one, (2,), and its changes with a, b, c, (2, 3)."""
        a, b, c = shape
        rho, by_a = np.array([abs(1.0 - a), 1.0 + a]), np.array([math.copysign(1.0, a - 1.0), 1.0])
        cosine = (b**2 + c**2 - rho**2) / (2.0 * b * c)
        change = np.stack([-rho * by_a / (b * c), 1.0 / c - cosine / b, 1.0 / b - cosine / c])
        weight = STRICT * math.sqrt(len(self.path.points))
        beyond = np.maximum(np.abs(cosine) - math.cos(self.transmission_rad), 0.0)
        return weight * beyond, weight * (np.where(beyond > 0.0, np.sign(cosine), 0.0) * change).T

    def _phi(self, z: Array) -> Array:
        turned = self.path.turned
        return z[9:].copy() if turned is None else np.asarray(z[9] + turned)

    def _spread(self, column: task.Complexes) -> task.Complexes:
        """Return a derivative by each point's own angle, or by the one that all share."""
        return np.diag(column) if self.path.turned is None else column[:, None]


Progress = Callable[[float, float], None]
"""Callback with the finished share [0 to 1] and the least RMS distance by then [m]."""
APART = 0.02
"""Distance in the box of shapes, below which fits go the same way."""


@dataclass(frozen=True)
class Round:
    """One round: the best ``share`` of the starts, and most points and evaluations."""

    share: float
    points: int
    evaluations: int

    def count(self, starts: int) -> int:
        """Return its number of fits."""
        return max(1, math.ceil(self.share * starts))


ROUNDS = (Round(1.0, 14, 60), Round(0.4, MOST, 120), Round(0.17, MOST, 1500))


@dataclass
class SearchClock:
    """Progress of a search: ``until`` is the time after which no further fit is begun [s of the
    monotonic clock], ``unit_m`` the path's radius."""

    starts: int
    until: float
    unit_m: float
    progress: Progress | None = None
    complete: bool = True
    best: float = math.inf
    work: float = 0.0

    @property
    def is_over(self) -> bool:
        """True if the time is used up."""
        return time.monotonic() >= self.until

    def fitted(self, one: Round, fit: Fitted) -> None:
        """Count a fit."""
        self.work += one.evaluations * one.points
        if one.points >= MOST:  # fits of some of the points say little of all
            self.best = min(self.best, self.unit_m * math.sqrt(fit.cost))
        whole = sum(r.count(self.starts) * r.evaluations * r.points for r in ROUNDS)
        self.tell(min(0.99, self.work / whole))

    def tell(self, share: float) -> None:
        """Call the progress callback."""
        if self.progress is not None:
            self.progress(share, self.best)


def fitted(
    starts: Sequence[Fitted], path: UnitPath, clock: SearchClock, transmission_rad: float = 0.0
) -> list[Fitted]:
    """Return the fits of the last round that was begun, the best first, with those of the round
    before for which the time ran out. One fit is made in any case."""
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
    """Return a fit over some of the points, with the crank's angles in all of them; the start, if
    the fit grows too large."""
    own = path.mirrored if start.mirrored else path
    keep = np.arange(len(own.points)) if each.points >= len(own.points) else own.kept(each.points)
    fit = refit(
        replace(start, phi=start.phi[keep]), own.only(keep), each.evaluations, transmission_rad
    )
    change = np.interp(np.arange(len(own.points)), keep, fit.phi - start.phi[keep])
    grows = fit.size > TOO_LARGE >= start.size and math.isfinite(start.cost)
    return start if grows else replace(fit, phi=start.phi + change)


def _apart(fits: Sequence[Fitted]) -> list[Fitted]:
    """Return fits without those near a better one: they would end in the same mechanism."""
    kept: list[Fitted] = []
    for fit in fits:
        low, high = np.array(task.BOUNDS[fit.family]).T
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
