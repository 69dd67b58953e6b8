"""The free motion of a mechanism of several freedoms, or without a closed form, by the equations of
motion of all its bodies."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from analytic.dyads.plane import EPS
from analytic.free.free_motion import IntegratedLaw, LimitPassage
from analytic.multibody.as_motion import as_motion, logged_places
from analytic.multibody.bodies import EnergyBalance
from analytic.multibody.multibody_motion import MultibodyMotion, Projection
from models.array import Array, samples
from models.motion import Bound, LinkMotion, Motion, PointMotion, SliderMotion
from models.scene import Scene

COARSER = Projection(1e-12)
"""The integration that this one is held to: it is off by more, so that their difference is what it
is off by itself."""
SAFETY = 4.0
"""How much more than the largest difference so far the error may be."""
LOOKS = 801
"""Instants at which both are compared."""

BodyMotion = TypeVar("BodyMotion", LinkMotion, PointMotion, SliderMotion)


@dataclass(frozen=True, eq=False)
class BodiesMotion:
    """What all bodies of a scene do (`FreeMotion`), integrated at once as ``bodies``.

    No coordinate of it is special: `sensitivity` is that of all coordinates, what it may be off by
    that of the worst link. Bounds are estimates, of a second integration.
    """

    bodies: MultibodyMotion

    @property
    def scene(self) -> Scene:
        return self.bodies.scene

    @property
    def until_s(self) -> float:
        return self.bodies.until_s

    @property
    def passages(self) -> tuple[LimitPassage, ...]:
        """None: where a link turns back, no other coordinate has to take its place."""
        return ()

    @property
    def edges_s(self) -> tuple[float, ...]:
        """Those of loads over time."""
        return self.bodies.edges_s

    @property
    def freedoms(self) -> int:
        return self.bodies.dynamics.assembly.size - self.bodies.dynamics.rank

    @property
    def by_dyads(self) -> bool:
        return False

    @property
    def driver_tells(self) -> bool:
        return False

    @property
    def peak_speed_rad_s(self) -> float:
        return max(float(np.abs(one.omega).max()) for one in self._looks[1].links.values())

    @property
    def range_rad(self) -> float:
        return float(np.ptp(self._looks[1].links[self.scene.driver.link].theta))

    @cached_property
    def law(self) -> IntegratedLaw:
        return IntegratedLaw(self._driver, 0.0, self.until_s, self.peak_speed_rad_s)

    def at(self, time_s: Array, *, bound: bool = True) -> Motion:
        motion = replace(self.bodies.at(time_s), forces=None)
        return replace(motion, bound=self._bound(time_s)) if bound else motion

    def outside(self, time_s: Array, *, bound: bool = True) -> Motion:
        motion = self.bodies.outside(time_s)
        return replace(motion, bound=self._bound(time_s)) if bound else motion

    def with_forces(self, motion: Motion, *, bound: bool = True) -> Motion:
        """With reactions without bounds of their own."""
        del bound
        return replace(motion, forces=self.bodies.at(motion.time_s).forces)

    def beside(self, logged: Motion) -> Motion:
        assembly = self.bodies.dynamics.assembly
        q = logged_places(assembly, logged, self.freedoms)
        return as_motion(assembly, logged.time_s, assembly.at_rest(q), np.zeros_like(q))

    def energy(self, time_s: Array) -> EnergyBalance:
        return self.bodies.energy(time_s)

    def sensitivity(self, time_s: Array) -> Array:
        return self.bodies.sensitivity(time_s)

    def error_rad(self, time_s: Array) -> Array:
        links = self._bound(samples(time_s, "time_s")).links.values()
        return np.asarray(np.max([one.theta for one in links], axis=0))

    def _driver(self, time_s: Array) -> tuple[Array, Array, Array]:
        one = self.bodies.at(time_s).links[self.scene.driver.link]
        return one.theta, one.omega, one.alpha

    @cached_property
    def _looks(self) -> tuple[Array, Motion]:
        """Instants, and the motion then."""
        time_s = np.linspace(0.0, self.until_s, LOOKS)
        return time_s, self.bodies.at(time_s)

    @cached_property
    def _doubt(self) -> Bound:
        """What all bodies may be off by until each of these instants."""
        time_s, motion = self._looks
        other = replace(self.bodies, method=COARSER).at(time_s)
        return Bound(
            _apart(motion.links, other.links),
            _apart(motion.points, other.points),
            _apart(motion.sliders, other.sliders),
        )

    def _bound(self, time_s: Array) -> Bound:
        # That of the next look: the differences before a time hold up to there.
        k = np.clip(np.searchsorted(self._looks[0], time_s), 0, LOOKS - 1)
        doubt = self._doubt
        return Bound(_some(doubt.links, k), _some(doubt.points, k), _some(doubt.sliders, k))


def _apart(
    own: Mapping[str, BodyMotion], others: Mapping[str, BodyMotion]
) -> dict[str, BodyMotion]:
    """How far bodies of two motions have been apart until each instant at most, with room."""
    return {
        name: type(body)(*map(_room, vars(body).values(), vars(others[name]).values()))
        for name, body in own.items()
    }


def _room(own: Array, other: Array) -> Array:
    apart, size = np.abs(own - other), np.abs(own)
    if own.ndim == 2:
        apart, size = np.linalg.norm(apart, axis=1), np.linalg.norm(size, axis=1)
    return np.asarray(SAFETY * np.maximum.accumulate(apart) + 4.0 * EPS * (size + size.max()))


def _some(bodies: Mapping[str, BodyMotion], index: NDArray[np.intp]) -> dict[str, BodyMotion]:
    return {
        name: type(body)(*(series[index] for series in vars(body).values()))
        for name, body in bodies.items()
    }
