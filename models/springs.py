"""Springs with dampers beside them: between two points, in a pin, or along the line of a slider.

With q the distance of the points [m], the angle of the second body against the first [rad], or the
displacement of the slider [m], a spring pulls q back with

    rate (q - free) + damping q'                 [N], or [N m] in a pin

and keeps the energy rate (q - free)^2 / 2. A rate of 0 leaves a damper, a damping of 0 a spring.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class _Elastic:
    """What every spring has: ``rate`` [N/m or N m/rad], ``damping`` [N s/m or N m s], and ``free``,
    the q [m or rad] at which it is slack."""

    name: str
    rate: float
    damping: float
    free: float

    def pull(self, q: float, speed: float) -> float:
        """What it pulls q back with [N or N m]."""
        return self.rate * (q - self.free) + self.damping * speed

    def energy(self, q: float) -> float:
        """What it keeps [J]."""
        return 0.5 * self.rate * (q - self.free) ** 2


@dataclass(frozen=True)
class LineSpring(_Elastic):
    """Between two named points. Each end is fixed to one body that has the point: to the ground,
    else to the first link in the order of the scene, else to a block."""

    points: tuple[str, str]


@dataclass(frozen=True)
class PinSpring(_Elastic):
    """In a pin, between two of the bodies that meet there; q is the angle of the second less that
    of the first: at the start within half a turn of ``free``, and counted on from there."""

    point: str
    bodies: tuple[str, str]


@dataclass(frozen=True)
class SegmentSpring(PinSpring):
    """In a pin between two segments of an elastic link (`models.segmented`)."""


@dataclass(frozen=True)
class SlideSpring(_Elastic):
    """Along the line of a slider, between what slides and the body that the line is on."""

    slider: str


Spring = LineSpring | PinSpring | SlideSpring
