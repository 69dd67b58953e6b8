"""Lengths of a mechanism from logged readings, by least squares with the reference's gradient.

Readings over the driver's coordinate determine as many combinations of lengths as the gradient has
independent columns. Angles alone determine ratios: all lengths grown by one factor give the same
angles. What is not determined is held and named, not invented. Steps by Levenberg and Marquardt;
deviations from the residuals themselves, each by its own size (H. White, Econometrica 48 (1980)).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from analytic.gradients.dimensions import dimensions, with_dimensions
from analytic.gradients.gradient import gradient_at
from models.array import Array
from models.errors import CrankcheckError, few
from models.motion import Motion
from models.scene import GROUND, Scene

SINGULAR = 1e-9
"""Least singular value of the gradient over the largest: below it rounding decides."""
MOST_STEPS, DONE = 200, 1e-10
"""Largest number of steps, and the last one over the lengths."""
ROUNDING = 1e-13
"""Least residual that says anything of the noise of a reading [rad or m]."""
ORDERLY = 4.5
"""Deviations beyond which the order of residuals is no chance: three in a million logs."""
SMALL = 1e-3
"""Part of residuals that follows the driver, over the swing of the reading, that lengths need not
explain."""


Differentiated = Callable[[Scene, Array, Sequence[str]], tuple[Motion, Mapping[str, Motion]]]
"""A motion at coordinates of the driver, and its derivatives by dimensions, as `gradient_at`."""


@dataclass(frozen=True)
class LoggedSeries:
    """Readings (T,) [rad or m] of something that ``expected`` takes from a motion; angles count but
    for whole turns."""

    name: str
    values: Array
    expected: Callable[[Motion], Array]
    turns: bool

    def residual(self, motion: Motion) -> Array:
        off = self.values - self.expected(motion)
        return off - math.tau * np.round(off / math.tau) if self.turns else off


@dataclass(frozen=True)
class LengthFit:
    """Fitted dimensions and zeros of sensors: ``values`` and one standard ``deviations`` of each.

    ``held`` are dimensions that the readings do not determine, each with its reason. With
    ``unit_length`` only ratios to that dimension are determined, which is at the scene's value.
    """

    scene: Scene
    start: Mapping[str, float]
    values: Mapping[str, float]
    deviations: Mapping[str, float]
    held: Mapping[str, str]
    unit_length: str
    readings: tuple[LoggedSeries, ...]
    residuals: tuple[Array, ...]
    order: NDArray[np.intp]

    def spread(self, number: int) -> float:
        """Return the root mean square of the residuals of a reading."""
        free = 1.0 - len(self.values) / max(sum(r.size for r in self.residuals), 1)
        return float(np.sqrt(np.mean(self.residuals[number] ** 2) / max(free, 1e-3)))

    def orderly(self, number: int) -> tuple[float, float]:
        """Return how much of the residuals of a reading follows the driver's angle [rad or m], and
        its distance from chance in deviations: neighbours in the order of the angle of a turn have
        independent noise, and what a mechanism does wrong in common."""
        r = self.residuals[number][self.order]
        common = float(np.mean(r * np.roll(r, 1)))
        size = float(np.mean(r**2))
        return math.sqrt(max(common, 0.0)), common / size * math.sqrt(r.size) if size else 0.0

    def is_explained(self, number: int) -> bool:
        """True unless residuals of a reading follow the driver's angle, beyond chance and rounding:
        then no lengths explain it."""
        part, chance = self.orderly(number)
        return chance <= ORDERLY or part <= SMALL * float(np.std(self.readings[number].values))


def fit_lengths(
    scene: Scene,
    drive: Array,
    readings: Sequence[LoggedSeries],
    names: Sequence[str] = (),
    given: Mapping[str, float] | None = None,
    *,
    zeros: bool = False,
    differentiate: Differentiated = gradient_at,
) -> LengthFit:
    """Fit dimensions of a scene to readings over its driver's coordinate (T,) [rad or m].

    Parameters
    ----------
    names : Sequence[str]
        Dimensions to be fitted; none: all lengths.
    given : Mapping[str, float] or None
        Dimensions of known value [m or rad].
    zeros : bool
        Fit the zero of each angle as well, that of the driver too.
    differentiate : Differentiated
        Source of the motion and its derivatives; what the readings determine is the reference's.

    Raises
    ------
    CrankcheckError
        An unknown name; nothing to fit, or fewer readings than unknowns; a start, the scene's own
        lengths, that can not follow the driver; no convergence.
    """
    given = dict(given or {})
    known = dimensions(scene)
    free = list(names) or [n for n, one in known.items() if one.unit == "m"]
    free = [n for n in free if n not in given and not n.startswith("driver.")]
    if strange := [n for n in free if n not in known]:
        raise CrankcheckError(f"{scene.name}: no dimension {few(strange, 6)}; see `sensitivity`")
    # A mechanism of another size has the same angles: lengths start at the size of given ones.
    sizes = [v / known[n].value for n, v in given.items() if n in known and known[n].value > 0.0]
    grown = {n: known[n].value * sum(sizes) / len(sizes) for n in free if sizes}
    grown = {n: value for n, value in grown.items() if known[n].unit == "m"}
    scene = with_dimensions(scene, {**grown, **given})
    angles = [one.name for one in readings if one.turns] if zeros else []
    problem = _Unknowns(scene, drive, tuple(readings), tuple(free), tuple(angles), zeros)
    problem, held, unit_length = _determined(problem)
    problem = replace(problem, differentiate=differentiate)
    size = sum(one.values.size for one in readings)
    if not problem.names or size <= len(problem.names):
        raise CrankcheckError(
            f"{scene.name}: {size} readings and {len(problem.names)} unknowns that they determine; "
            "log more, or name other dimensions"
        )
    weights = np.ones(len(readings))
    p = problem.start
    for _ in range(1 if len(readings) == 1 else 3):  # weights follow from residuals
        p = _descended(problem, p, weights)
        residuals, slopes = problem.at(p)
        sizes = [float(np.sqrt(np.mean(r**2))) for r in residuals]
        weights = 1.0 / np.maximum(sizes, ROUNDING)
    order = np.argsort(np.mod(drive, math.tau) if scene.driver.slider is None else drive)
    deviations = _deviations(residuals, slopes, weights)
    return LengthFit(
        problem.scene_at(p),
        {name: known[name].value if name in known else 0.0 for name in problem.names},
        dict(zip(problem.names, p.tolist(), strict=True)),
        dict(zip(problem.names, deviations.tolist(), strict=True)),
        held,
        unit_length,
        problem.readings,
        tuple(residuals),
        order,
    )


@dataclass(frozen=True)
class _Unknowns:
    """Unknowns, dimensions and then zeros of angles, that of the driver the last."""

    scene: Scene
    drive: Array
    readings: tuple[LoggedSeries, ...]
    free: tuple[str, ...]
    angles: tuple[str, ...]
    zeros: bool
    differentiate: Differentiated = gradient_at

    @property
    def names(self) -> list[str]:
        zeros = [f"zero of {name}" for name in self.angles]
        return [*self.free, *zeros, *(["zero of the driver"] if self.zeros else [])]

    @property
    def start(self) -> Array:
        known = dimensions(self.scene)
        values = [known[name].value for name in self.free]
        return np.array([*values, *[0.0] * (len(self.names) - len(values))])

    @property
    def units(self) -> Array:
        """Size of each unknown: the longest length, or a radian."""
        known = dimensions(self.scene)
        units = [self.scene.longest_m if known[n].unit == "m" else 1.0 for n in self.free]
        return np.array([*units, *[1.0] * (len(self.names) - len(units))])

    def scene_at(self, p: Array) -> Scene:
        return with_dimensions(self.scene, dict(zip(self.free, p.tolist(), strict=False)))

    def at(self, p: Array) -> tuple[list[Array], list[Array]]:
        """Return the residuals (T,) of each reading, and its derivatives by the unknowns (T, n).
        Raises CrankcheckError for lengths with which the mechanism can not follow its driver."""
        ahead = [n for n in dimensions(self.scene) if n.startswith("driver.")] * self.zeros
        drive = self.drive - p[-1] if self.zeros else self.drive
        motion, by = self.differentiate(self.scene_at(p), drive, [*self.free, *ahead])
        residuals, slopes = [], []
        for one in self.readings:
            columns = [one.expected(by[name]) for name in self.free]
            columns += [np.full(drive.shape, float(one.name == name)) for name in self.angles]
            columns += [-one.expected(by[name]) for name in ahead]
            off = one.residual(motion)
            if one.name in self.angles:
                off = off - p[len(self.free) + self.angles.index(one.name)]
            residuals.append(off)
            slopes.append(np.stack(columns, axis=1))
        return residuals, slopes

    def without(self, name: str) -> _Unknowns:
        if name in self.free:
            return replace(self, free=tuple(n for n in self.free if n != name))
        if name == self.names[-1] and self.zeros:
            return replace(self, zeros=False)
        return replace(self, angles=tuple(n for n in self.angles if f"zero of {n}" != name))


def _determined(problem: _Unknowns) -> tuple[_Unknowns, dict[str, str], str]:
    """Return the problem without unknowns that the readings do not determine; those, each with its
    reason; and the length that all others are ratios to, "" where lengths are determined."""
    held: dict[str, str] = {}
    unit_length = ""
    while problem.names:
        slopes = np.concatenate(problem.at(problem.start)[1]) * problem.units
        columns = np.linalg.norm(slopes, axis=0)
        if unseen := [n for n, c in zip(problem.names, columns, strict=True) if c <= SINGULAR]:
            for own in unseen:
                held[own] = "no reading depends on it"
                problem = problem.without(own)
            continue
        _, sizes, right = np.linalg.svd(slopes, full_matrices=False)
        if sizes[-1] > SINGULAR * sizes[0]:
            break
        null, grown = right[-1], problem.start / problem.units
        grown = grown / max(float(np.linalg.norm(grown)), 1e-300)
        names = problem.names
        if abs(float(null @ grown)) > 1.0 - 1e-6:
            own = GROUND if GROUND in problem.free else problem.free[0]
            held[own] = "only ratios of lengths are determined"
            unit_length = own
        else:
            own = names[int(np.argmax(np.abs(null)))]
            with_it = [n for n, c in zip(names, null, strict=True) if abs(c) > 1e-3 and n != own]
            held[own] = f"the same readings follow from changes of {few(with_it, 6)}"
        problem = problem.without(own)
    return problem, held, unit_length


def _descended(problem: _Unknowns, p: Array, weights: Array) -> Array:
    """Return the unknowns of least squares near ``p``. Raises CrankcheckError."""

    def stacked(p: Array) -> tuple[Array, Array]:
        residuals, slopes = problem.at(p)
        rows = [w * r for w, r in zip(weights, residuals, strict=True)]
        columns = [w * s for w, s in zip(weights, slopes, strict=True)]
        return np.concatenate(rows), np.concatenate(columns) * problem.units

    r, slopes = stacked(p)
    damping = 1e-3
    for _ in range(MOST_STEPS):
        normal = slopes.T @ slopes
        step = np.linalg.solve(normal + damping * np.diag(np.diag(normal)), slopes.T @ r)
        try:
            ahead = stacked(p + step * problem.units)
        except CrankcheckError:  # which can not be assembled
            ahead = None
        if ahead is None or ahead[0] @ ahead[0] > r @ r:
            damping *= 8.0
            if float(np.abs(step).max()) < DONE:
                return p
            continue
        p, (r, slopes), damping = p + step * problem.units, ahead, damping / 5.0
        if float(np.abs(step).max()) < DONE:
            return p
    raise CrankcheckError(
        f"{problem.scene.name}: lengths do not settle in {MOST_STEPS} steps from those of the "
        "scene; start from lengths nearer to the real ones, or fit fewer"
    )


def _deviations(residuals: Sequence[Array], slopes: Sequence[Array], weights: Array) -> Array:
    """Return one standard deviation of each unknown."""
    rows = np.concatenate([w * s for w, s in zip(weights, slopes, strict=True)])
    r = np.concatenate([w * r for w, r in zip(weights, residuals, strict=True)])
    inverse = np.linalg.inv(rows.T @ rows)
    middle = rows.T @ (rows * (r**2)[:, None])
    share = r.size / (r.size - rows.shape[1])
    return np.asarray(np.sqrt(np.diag(inverse @ middle @ inverse) * share))
