"""A whole mechanism in fifty digits: every constraint at once, on numbers that carry derivatives.

The unknowns are the frames of all bodies. A float Jacobian only leads the iteration; what is
brought to zero, at all three levels, are the exact constraints and their derivatives by time.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from mpmath import mp, mpf

from models.motion import Motion
from models.scene import GROUND, Point, Scene, Slider
from models.scene.joints import local_point, sliding_body
from models.scene.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating
from tests.analytic import oracle
from tests.analytic.change_points import jets
from tests.analytic.change_points.jets import Jet, Number
from tests.analytic.oracle import Place
from tests.second_opinions.constraints import Constraints

DONE = mpf(10) ** -42


@dataclass(frozen=True)
class Frame:
    """Frame of a body, in numbers of any kind."""

    origin: Place
    angle: Jet
    along: Place

    def at(self, local: Point) -> Place:
        return self.origin + turned(self.along, local)


def turned(along: Place, by: tuple[Number, Number]) -> Place:
    """A direction times a constant vector, as complex numbers."""
    x, y = by
    return Place(along.x * x - along.y * y, along.y * x + along.x * y)


def law_at(law: Law, time_s: float) -> Jet:
    t = Jet(time_s, 1)
    if isinstance(law, ConstantSpeed):
        return t * mpf(law.speed_rad_s) + mpf(law.start_rad)
    if isinstance(law, Oscillating):
        phase = t * mpf(law.frequency_rad_s) + mpf(law.phase_rad)
        return jets.sin(phase) * mpf(law.amplitude_rad) + mpf(law.centre_rad)
    if isinstance(law, Accelerating):
        gain = t * mpf(law.acceleration_rad_s2) / 2
        return (gain + mpf(law.speed_rad_s)) * t + mpf(law.start_rad)
    assert isinstance(law, FromRest)
    speed, rise = mpf(law.speed_rad_s), mpf(law.rise_s)
    if time_s >= law.rise_s:
        return (t - rise / 2) * speed + mpf(law.start_rad)
    if time_s <= 0.0:
        return Jet(law.start_rad)
    tau = t / rise
    full = 2 * mp.pi
    ramp = tau * tau / 2 + (jets.cos(tau * full) - 1) / full**2
    return ramp * (speed * rise) + mpf(law.start_rad)


@dataclass(frozen=True)
class Solved:
    """The exact motion at one time."""

    links: Mapping[str, Jet]
    points: Mapping[str, Place]
    sliders: Mapping[str, Jet]


def held_points(scene: Scene) -> dict[str, list[tuple[str, Point]]]:
    """The bodies that hold each point, blocks among them, and where."""
    held = {
        point: [(body, local_point(scene, body, point)) for body in bodies]
        for point, bodies in scene.pins.items()
    }
    for slider in scene.sliders.values():
        if slider.link is None:
            held.setdefault(slider.point, []).append((sliding_body(slider), (0.0, 0.0)))
    return held


class JetChain(ABC):
    """The constraints of a scene over jets of numbers of any kind."""

    def __init__(self, scene: Scene) -> None:
        self.scene, self.held = scene, held_points(scene)

    @abstractmethod
    def along(self, guide: Frame, slider: Slider) -> Place:
        """The direction of a slider's line on its guide."""

    def gaps(self, frames: Mapping[str, Frame]) -> list[Jet]:
        """What the places of each pin on its bodies are apart, in x and y."""
        rows: list[Jet] = []
        for (first, at_first), *others in self.held.values():
            for body, local in others:
                gap = frames[first].at(at_first) - frames[body].at(local)
                rows += [gap.x, gap.y]
        return rows

    def ride(self, frames: Mapping[str, Frame], slider: Slider) -> tuple[Place, Place]:
        """From the line's point to the slider's, and the direction of the line."""
        body, guide = sliding_body(slider), frames[slider.on]
        tip = (0.0, 0.0) if slider.link is None else local_point(self.scene, body, slider.point)
        return frames[body].at(tip) - guide.at(slider.through_m), self.along(guide, slider)

    def solved(self, frames: Mapping[str, Frame]) -> Solved:
        rides = {name: self.ride(frames, s) for name, s in self.scene.sliders.items()}
        held = {name: bodies[0] for name, bodies in self.held.items()}
        for slider in self.scene.sliders.values():
            held.setdefault(slider.point, (sliding_body(slider), (0.0, 0.0)))
        return Solved(
            {name: frames[name].angle for name in self.scene.links},
            {name: frames[body].at(local) for name, (body, local) in held.items()},
            {name: along.dot(away) for name, (away, along) in rides.items()},
        )


class Chain(JetChain):
    """The constraints in fifty digits."""

    def __init__(self, scene: Scene) -> None:
        super().__init__(scene)
        self.floats = Constraints(scene)
        self.bodies = self.floats.bodies

    def solve(self, time_s: float, start: list[float]) -> Solved:
        """The motion at a time, by iteration from coordinates near it."""
        drive = law_at(self.scene.driver.law, time_s)
        inverse = np.linalg.inv(self.floats.jacobian(np.array(start)))
        levels: list[list[Number]] = [[mpf(c) for c in start]]
        levels += [[mpf(0)] * len(start) for _ in range(2)]
        for _ in range(40):
            q = [Jet(*row) for row in zip(*levels, strict=True)]
            wrong = self._equations(q, drive)
            steps = [_times(inverse, [_level(e, level) for e in wrong]) for level in range(3)]
            for values, step in zip(levels, steps, strict=True):
                values[:] = [v - s for v, s in zip(values, step, strict=True)]
            if all(map(_settled, levels, steps)):
                break
        else:
            raise AssertionError(f"no convergence at {time_s} s")
        return self.solved(self._frames([Jet(*row) for row in zip(*levels, strict=True)]))

    def along(self, guide: Frame, slider: Slider) -> Place:
        return oracle.toward(guide.angle + mpf(slider.direction_rad))

    def _frames(self, q: list[Jet]) -> dict[str, Frame]:
        frames = {GROUND: Frame(oracle.at(0, 0), Jet(0), oracle.at(1, 0))}
        for i, body in enumerate(self.bodies):
            x, y, angle = q[3 * i : 3 * i + 3]
            frames[body] = Frame(Place(x, y), angle, oracle.toward(angle))
        return frames

    def _equations(self, q: list[Jet], drive: Jet) -> list[Jet]:
        frames = self._frames(q)
        rows = self.gaps(frames)
        for slider in self.scene.sliders.values():
            away, along = self.ride(frames, slider)
            turn = frames[sliding_body(slider)].angle - frames[slider.on].angle
            turn -= mpf(slider.direction_rad) + mpf(slider.angle_rad)
            whole = mp.nint(turn.value / (2 * mp.pi))  # angles of links are known but for turns
            rows += [along.cross(away), turn - 2 * mp.pi * whole]
        return [*rows, self._driven(frames, drive)]

    def _driven(self, frames: Mapping[str, Frame], drive: Jet) -> Jet:
        """The driver's coordinate less what it should be."""
        driver = self.scene.driver
        if driver.slider is not None:
            away, along = self.ride(frames, self.scene.sliders[driver.slider])
            return along.dot(away) - drive
        off = frames[driver.link].angle - frames[driver.base].angle - drive
        if driver.base == GROUND:
            return off
        return off - 2 * mp.pi * mp.nint(off.value / (2 * mp.pi))  # known but for turns


def coordinates(scene: Scene, motion: Motion, index: int) -> list[float]:
    """The frames of all bodies at a sample, from the angles and points of a motion."""
    angles = {GROUND: 0.0} | {name: float(m.theta[index]) for name, m in motion.links.items()}
    found: list[float] = []
    for link in scene.links.values():
        point, (x, y) = next(iter(link.points.items()))
        c, s = np.cos(angles[link.name]), np.sin(angles[link.name])
        place = motion.points[point].position[index]
        found += [place[0] - c * x + s * y, place[1] - s * x - c * y, angles[link.name]]
    for slider in scene.sliders.values():
        if slider.link is None:
            place = motion.points[slider.point].position[index]
            found += [*place, angles[slider.on] + slider.direction_rad]
    return [float(c) for c in found]


def _level(jet: Jet, level: int) -> Number:
    return (jet.value, jet.rate, jet.second)[level]


def _settled(values: list[Number], step: list[Number]) -> bool:
    return max(map(abs, step)) < DONE * (max(map(abs, values)) + 1)


def _times(inverse: np.ndarray, wrong: list[Number]) -> list[Number]:
    """A float matrix times exact numbers, of which only the leading digits matter."""
    size = max((abs(w) for w in wrong), default=mpf(0))
    if size == 0:
        return [mpf(0)] * len(wrong)
    step = inverse @ np.array([float(w / size) for w in wrong])
    return [mpf(float(s)) * size for s in step]
