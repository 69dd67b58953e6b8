"""Effects of tolerances of lengths and clearances of joints on the required positions.

A scene is varied and solved again by the reference, its driver at the same angles. Derivatives are
central differences, good to some nine digits.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from analytic.kinematics import solve_driven
from analytic.lectures.synthesis.design import Asked, asked_motion
from analytic.lectures.synthesis.examine import Examined, way_of
from models.array import Array
from models.errors import CrankcheckError, ReachError
from models.lectures.draft import Draft, plate, points_of
from models.scene import Scene

SINGULAR = 1e-3
"""Least sine of transmission below which differences are meaningless."""
STEP = 1e-5
"""Step of a difference, over the longest link: the error is its square, and rounding over it."""
ON_THE_WAY = 49
"""Samples of the driver's way for a random mechanism."""


@dataclass(frozen=True)
class TolerancedDimension:
    """Number of a scene: a coordinate of a point on a body (0 along x, 1 along y)."""

    body: str
    point: str
    axis: int

    @property
    def words(self) -> str:
        """Name in a table."""
        return f"{self.body} {self.point} {'xy'[self.axis]}"


@dataclass(frozen=True)
class Sensitivity:
    """Slopes ``slopes`` (P, N) of each required value (P, over the positions) by each dimension (N)
    [m/m or rad/m]; ``asked`` with the number of its position."""

    examined: Examined
    asked: tuple[tuple[int, Asked], ...]
    dimensions: tuple[TolerancedDimension, ...]
    slopes: Array

    def worst(self, tolerance_m: float) -> Array:
        """Return the largest change of each value for errors up to a tolerance (P,)."""
        return np.asarray(np.abs(self._lengths).sum(axis=1) * tolerance_m)

    def usual(self, tolerance_m: float) -> Array:
        """Return the root of the sum of squares (P,), for independent errors of dimensions."""
        return np.asarray(np.sqrt(np.square(self._lengths).sum(axis=1)) * tolerance_m)

    @property
    def _lengths(self) -> Array:
        """Slopes of the dimensions on a drawing."""
        keep = [is_measured(self.examined, one) for one in self.dimensions]
        return np.asarray(self.slopes[:, np.array(keep)])

    def largest_clearance(self, limits: Sequence[float]) -> tuple[float, int]:
        """Return the radial clearance of all joints [m] that keeps every required value within its
        limit (P,), the pins free to lie to any side; and the number of the one that sets it."""
        joints: dict[str, list[int]] = {}
        pins = pinned(self.examined.scene)
        for k, one in enumerate(self.dimensions):
            if one.point in pins:
                joints.setdefault(one.point, []).append(k)
        effect = np.zeros(len(self.asked))
        for rows in joints.values():
            # The pin moves against one of its two bodies, no matter which: the first, by x and y.
            effect += np.hypot(self.slopes[:, rows[0]], self.slopes[:, rows[1]])
        with np.errstate(divide="ignore"):
            allowed = np.asarray(limits) / effect
        k = int(np.argmin(allowed))
        return float(allowed[k]), k


@dataclass(frozen=True)
class Spread:
    """Result of a Monte Carlo: the largest change of each required value (P,), and the share of
    mechanisms within all limits; ``lost`` could not be assembled."""

    largest: Array
    share_within: float
    count: int
    lost: int


def sensitivity(examined: Examined) -> Sensitivity:
    """Compute the slopes of a mechanism that meets its positions. Raises CrankcheckError for a
    mechanism that passes a change point, or a dead point: next to it there are no slopes."""
    if examined.least_sine < SINGULAR:
        raise CrankcheckError(
            f"{examined.scene.name}: it passes a position in which links are in line, where a "
            "change of length as small as one likes leads into another assembly"
        )
    draft = as_plates(examined)
    step = STEP * examined.scene.longest_m
    dimensions = tuple(_dimensions(draft))
    positions = enumerate(examined.positions, 1)
    asked = tuple((number, one) for number, position in positions for one in position.asked)
    slopes = np.empty((len(asked), len(dimensions)))
    for k, dimension in enumerate(dimensions):
        ahead, back = (
            _values(examined, _varied(draft, {dimension: sign * step}).scene) for sign in (1, -1)
        )
        slopes[:, k] = np.abs(ahead - back) / (2.0 * step)
    return Sensitivity(examined, asked, dimensions, slopes)


def monte_carlo(
    examined: Examined, tolerance_m: float, limits: Sequence[float], count: int, seed: int = 19
) -> Spread:
    """Draw so many mechanisms with uniform, independent errors of dimensions up to a tolerance [m];
    ``limits`` (P,) of the required values [m, rad]. Those that can not be assembled all along the
    driver's way are lost."""
    draft, draw = as_plates(examined), np.random.default_rng(seed)
    dimensions = [one for one in _dimensions(draft) if is_measured(examined, one)]
    exact, way = _values(examined, draft.scene), way_of(examined.scene.driver.law, ON_THE_WAY)
    largest, within, lost = np.zeros(len(exact)), 0, 0
    for _ in range(count):
        off = draw.uniform(-tolerance_m, tolerance_m, len(dimensions)).tolist()
        try:
            scene = _varied(draft, dict(zip(dimensions, off, strict=True))).scene
            values = _values(examined, scene)
            solve_driven(scene, way, np.ones(1), np.zeros(1), points=(), sliders=(), bound=False)
        except ReachError:
            lost += 1
            continue
        change = np.abs(values - exact)
        largest = np.maximum(largest, change)
        within += bool(np.all(change <= limits))
    return Spread(largest, within / count, count, lost)


def pinned(scene: Scene) -> set[str]:
    """Return the points in which two bodies meet, a slider's block one of them."""
    shared = {name for name, bodies in scene.pins.items() if len(bodies) > 1}
    return shared | {slider.point for slider in scene.sliders.values()}


def is_measured(examined: Examined, one: TolerancedDimension) -> bool:
    """True if a dimension is on a drawing: of a bar its length, but not the place of a required
    point that holds nothing."""
    if one.body == "ground":
        return True
    if one.point not in pinned(examined.scene):
        return False
    link = examined.draft.links[one.body]
    return "bar" not in link or (one.axis == 0 and one.point == list(points_of(link))[1])


def as_plates(examined: Examined) -> Draft:
    """Return the draft of the examined scene, every bar as a link of points."""
    links = {name: plate(points_of(link)) for name, link in examined.draft.links.items()}
    return replace(examined.draft, links=links)


def _dimensions(draft: Draft) -> Iterator[TolerancedDimension]:
    for body, points in (("ground", draft.ground), *_bodies(draft)):
        yield from (TolerancedDimension(body, point, axis) for point in points for axis in (0, 1))


def _bodies(draft: Draft) -> list[tuple[str, dict[str, complex]]]:
    return [(name, points_of(link)) for name, link in draft.links.items()]


def _varied(draft: Draft, by: Mapping[TolerancedDimension, float]) -> Draft:
    """Return the draft with dimensions changed [m]."""
    ground, links = dict(draft.ground), dict(_bodies(draft))
    for one, delta in by.items():
        points = ground if one.body == "ground" else links[one.body]
        points[one.point] += delta if one.axis == 0 else 1j * delta
    return replace(
        draft, ground=ground, links={name: plate(points) for name, points in links.items()}
    )


def _values(examined: Examined, scene: Scene) -> NDArray[np.complex128]:
    """Return the required values at the positions (P,): places, or turns exp(i angle)."""
    motion = asked_motion(scene, examined.positions)
    positions = enumerate(examined.positions)
    return np.array([one.value(motion)[k] for k, each in positions for one in each.asked])
