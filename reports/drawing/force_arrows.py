"""Forces as arrows on a drawn mechanism: at the pins and guides, all to one scale.

An arrow is the force on the body of its colour: at a pin of two bodies on the second, from the
first; of more, on each, from the pin; at a guide the normal force on the sliding body.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.motion import Motion
from models.scene import Scene
from models.scene.joints import block_name
from reports.drawing.moving import packed, rounded
from reports.drawing.shape import MARGIN, box_of, guide_direction, size_of_motion

LONGEST = 0.34
"""Length of the largest force, over the size of the moving parts."""
LARGE = 98.0
"""Percentile that counts as the largest: near a dead point forces have no end."""
CUT = 1.5
"""Factor of `LONGEST` above which an arrow is cut off, and has no head."""
LEAST = 0.012
"""Length of an arrow, over the size of the moving parts, below which it is not drawn."""
ALONG = 24
"""Places along an arrow, the ends included."""
HEAD = (0.045, 0.016)
"""Length and half the width of a head, over the size of the moving parts."""


@dataclass(frozen=True)
class Arrow:
    """An arrow from ``tail`` to ``tip`` [m], of the force on ``body``; without a head if cut
    off."""

    body: str
    tail: Array
    tip: Array
    is_whole: bool = True

    @property
    def shaft(self) -> Array:
        """Places along it that names should avoid, (n, 2) [m]; at its tail a pin stands."""
        return np.linspace(self.tail, self.tip, ALONG)[3:]

    def head(self, size: float) -> Array:
        """Return the corners of the head, the tip first, (3, 2); ``size`` of moving parts [m]."""
        way = self.tip - self.tail
        long = float(np.hypot(*way))
        along = way / long
        length = min(HEAD[0] * size, 0.6 * long)
        half = length * HEAD[1] / HEAD[0]
        across = np.array([-along[1], along[0]])
        foot = self.tip - length * along
        return np.array([self.tip, foot + half * across, foot - half * across])

    def line(self, size: float) -> Array:
        """Return both ends of the line, up to the head if there is one, (2, 2)."""
        end = self.head(size)[1:].mean(axis=0) if self.is_whole else self.tip
        return np.array([self.tail, end])


@dataclass(frozen=True)
class _Force:
    """A force [N] on a body at a point, of a ``pin`` or of a ``guide``."""

    body: str
    point: str
    kind: str
    force: Array


@dataclass(frozen=True)
class ForceArrows:
    """Arrows of a motion with forces: the drawn length of a newton [m], the size of the moving
    parts [m], and the scale bar [N]."""

    scene: Scene
    m_per_n: float
    size: float
    bar_n: float

    def at(self, motion: Motion, index: int) -> list[Arrow]:
        """Return the arrows at a sample; none of an undetermined force, or one too small to see."""
        return [
            arrow
            for one in _acting(self.scene, motion, index)
            if (arrow := self._arrow(one, motion.points[one.point].position[index])) is not None
        ]

    def largest_at(self, path: Motion) -> int:
        """Return the sample at which a force is the largest."""
        sizes = [
            max((float(np.hypot(*(a.tip - a.tail))) for a in self.at(path, k)), default=0.0)
            for k in range(path.time_s.size)
        ]
        return int(np.argmax(sizes))

    def embedded(self, motion: Motion) -> dict[str, object]:
        """Return the forces of a motion for a page: each by the point where it acts and its kind,
        and its x and y as rows [N]."""
        every = [list(_acting(self.scene, motion, k)) for k in range(motion.time_s.size)]
        forces = np.array([[one.force for one in each] for each in every])  # (T, n, 2)
        rows = forces.reshape(len(every), -1).T
        return {
            "arrows": [{"point": one.point, "kind": one.kind} for one in every[0]],
            "rows": packed(rows),
            "m_per_n": self.m_per_n,
            "most_m": CUT * LONGEST * self.size,
            "bar_n": self.bar_n,
        }

    def _arrow(self, one: _Force, tail: Array) -> Arrow | None:
        way = self.m_per_n * one.force
        long = float(np.hypot(*way))
        if not long > LEAST * self.size:
            return None
        most = CUT * LONGEST * self.size
        return Arrow(one.body, tail, tail + way * min(1.0, most / long), long <= most)

    def box(self, path: Motion) -> tuple[Array, Array]:
        """Return the box as `box_of`, with room for all arrows of a turn."""
        low, high = box_of(self.scene, path)
        spare = 0.25 * MARGIN * self.size
        tips = [a.tip for k in range(path.time_s.size) for a in self.at(path, k)]
        if not tips:
            return low, high
        every = np.array(tips)
        return (
            np.minimum(low, every.min(axis=0) - spare),
            np.maximum(high, every.max(axis=0) + spare),
        )


def force_arrows(scene: Scene, path: Motion) -> ForceArrows:
    """Return the arrows of a turn that has forces; the bar is a round number near the largest."""
    sizes = [
        float(np.hypot(*one.force))
        for index in range(path.time_s.size)
        for one in _acting(scene, path, index)
    ]
    sizes = [each for each in sizes if math.isfinite(each)]
    largest = float(np.percentile(sizes, LARGE)) if sizes else 0.0
    size = size_of_motion(scene, path)
    if not largest > 0.0:
        return ForceArrows(scene, 0.0, size, 0.0)
    return ForceArrows(scene, LONGEST * size / largest, size, rounded(0.7 * largest))


def _acting(scene: Scene, motion: Motion, index: int) -> Iterator[_Force]:
    acting = motion.forces
    if acting is None:
        return
    for point, bodies in acting.pins.items():
        names = list(bodies)
        for body in names[1:] if len(names) == 2 else names:
            yield _Force(body, point, "pin", bodies[body][index])
    for name, one in acting.sliders.items():
        slider = scene.sliders[name]
        c, s = guide_direction(slider, motion, index)
        normal = float(one.normal[index]) * np.array([-s, c])
        yield _Force(slider.link or block_name(slider), slider.point, "guide", normal)
