"""Chunks of a given motion, for the computation of forces."""

import operator
from collections.abc import Iterator

import numpy as np

from analytic.dyads import plane
from analytic.dyads.chunk import SINES, Chunk, DrivenCoordinate, driver_scale
from analytic.dyads.parts import SlideError, Sliding
from analytic.dyads.plane import AngleError, BodyKinematics, PointKinematics
from analytic.prepared import spans
from models.array import Array
from models.errors import CrankcheckError
from models.motion import LinkMotion, Motion, PointMotion, SliderMotion
from models.scene import GROUND, Scene, Slider
from models.scene.driver import driver_course
from models.scene.joints import block_name


def chunks_of(scene: Scene, motion: Motion, *, bound: bool) -> Iterator[tuple[slice, Chunk]]:
    """Yield the motion, a chunk of samples at a time; certified where a bound is required.

    Raises
    ------
    CrankcheckError
        A link, point or slider that the motion lacks, or missing accelerations or bounds.
    """
    _check_whole(scene, motion, bound=bound)
    for span in spans(len(motion.time_s)):
        yield span, _Span(scene, motion, span, certified=bound).chunk()


def _check_whole(scene: Scene, motion: Motion, *, bound: bool) -> None:
    points = [*scene.pins, *(slider.point for slider in scene.sliders.values())]
    for what, wanted, found in (
        ("link", scene.links, motion.links),
        ("point", points, motion.points),
        ("slider", scene.sliders, motion.sliders),
    ):
        for name in wanted:
            if name not in found:
                raise CrankcheckError(
                    f"{scene.name}: forces need the whole motion, and {what} {name} is not in it; "
                    "solve it without a choice of links, points and sliders"
                )
    for name, link in motion.links.items():
        if not motion.conditioning and np.all(np.isnan(link.alpha)):
            raise CrankcheckError(
                f"{scene.name}: the motion has no acceleration of link {name}, which forces "
                "follow from; give one that has"
            )
    if bound and motion.bound is None:
        raise CrankcheckError(
            f"{scene.name}: the motion carries no bounds, so its forces have none; solve it "
            "with bound=True, or request forces with bound=False"
        )


class _Span:
    def __init__(self, scene: Scene, motion: Motion, span: slice, *, certified: bool) -> None:
        self.scene, self.motion, self.span = scene, motion, span
        self.bound = motion.bound if certified else None

    def chunk(self) -> Chunk:
        certified = self.bound is not None
        bodies = {GROUND: plane.fixed_body(certified=certified)}
        bodies |= {name: self._link(name) for name in self.scene.links}
        for slider in self.scene.sliders.values():
            if slider.link is None:
                bodies[block_name(slider)] = self._block(slider, bodies[slider.on])
        chunk = Chunk(self.scene, certified, False, bodies, self._driver())
        chunk.points.update({name: self._point(name) for name in self.motion.points})
        chunk.sines.update({key: s[self.span] for key, s in self.motion.conditioning.items()})
        chunk.sliders.update({name: self._sliding(name) for name in self.scene.sliders})
        return chunk

    def _levels(self, track: LinkMotion | PointMotion | SliderMotion) -> list[Array]:
        """Return the span of a quantity and of its first two derivatives, or of their bounds."""
        return [level[self.span] for level in vars(track).values()]

    def _driver(self) -> DrivenCoordinate:
        scale, span, driver = driver_scale(self.scene), self.span, self.scene.driver
        theta, omega, alpha = (one[span] / scale for one in driver_course(self.scene, self.motion))
        error = None
        if self.bound is not None and driver.slider is not None:
            off = self._levels(self.bound.sliders[driver.slider])
            error = AngleError(*(one / scale for one in off))
        elif self.bound is not None:
            error = AngleError(SINES, 0.0, 0.0)
            for name in (driver.link, driver.base):
                if name != GROUND:
                    own = self._levels(self.bound.links[name])
                    error = AngleError(*map(operator.add, error, own))
        return DrivenCoordinate(theta, omega, alpha, error)

    def _link(self, name: str) -> BodyKinematics:
        theta, omega, alpha = self._levels(self.motion.links[name])
        point, local = next(iter(self.scene.links[name].points.items()))
        error = None
        if self.bound is not None:
            error = AngleError(*self._levels(self.bound.links[name]))
            error = error._replace(theta=error.theta + SINES)
        turn = plane.Vec(np.cos(theta), np.sin(theta))
        return BodyKinematics(local, self._point(point), turn, omega, alpha, error, theta)

    def _block(self, slider: Slider, guide: BodyKinematics) -> BodyKinematics:
        """Return a block, which has the direction of its line."""
        angle, error = slider.direction_rad, guide.error
        if error is not None:
            error = error._replace(theta=error.theta + plane.rounding_of_angles(angle))
        turn, at = guide.turn.turned(plane.direction(angle)), self._point(slider.point)
        return BodyKinematics((0.0, 0.0), at, turn, guide.omega, guide.alpha, error)

    def _point(self, name: str) -> PointKinematics:
        levels = self._levels(self.motion.points[name])
        p, v, a = (plane.Vec(level[:, 0], level[:, 1]) for level in levels)
        error = None
        if self.bound is not None:
            error = plane.PointError(*self._levels(self.bound.points[name]))
        return PointKinematics(p, v, a, error)

    def _sliding(self, name: str) -> Sliding:
        s, speed, acceleration = self._levels(self.motion.sliders[name])
        error = None
        if self.bound is not None:
            error = SlideError(*self._levels(self.bound.sliders[name]))
        return Sliding(s, speed, acceleration, error)
