"""Loads and springs of a scene as generalised forces on its coordinates, in an assembly."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import islice

import numpy as np

from analytic.multibody.assembly import Assembly
from analytic.multibody.bodies import Configuration
from models.array import Array
from models.scene import Scene
from models.scene.loads import LineSpring, Load, PinSpring, Spring

Strokes = Mapping[str, bool]
"""Activity of each load that acts on one stroke of a slider."""


@dataclass(frozen=True)
class SpringDeflection:
    """Deflection q of a spring [m or rad], its rate, and its derivatives by the coordinates, (T,),
    (T,) and (T, n)."""

    spring: Spring
    q: Array
    rate: Array
    gradient: Array


@dataclass(frozen=True)
class Slide:
    """Displacement [m] and speed [m/s] of a slider, (T,), and the derivatives of the displacement
    by the coordinates, (T, n)."""

    displacement: Array
    speed: Array
    gradient: Array


class GeneralisedForces:
    """Forces on an assembly from outside or between its bodies, except weights.

    ``turns`` are the whole turns by which the angle of each spring in a pin is ahead of that
    within half a turn of its free angle, as the motion starts.
    """

    def __init__(self, assembly: Assembly, start: Array) -> None:
        self.assembly, self.scene = assembly, assembly.scene
        now = assembly.at_rest(start[None])
        self._turns = {
            spring.name: float(np.round((self._turned(spring, now)[0] - spring.free) / math.tau))
            for spring in self.scene.springs.values()
            if isinstance(spring, PinSpring)
        }

    def on(self, time_s: Array, now: Configuration, strokes: Strokes | None = None) -> Array:
        """Return the generalised forces at times [s] and a configuration (T, n).

        ``strokes`` decides which loads on one stroke act; by default the speed of the slider does.
        Raises CrankcheckError as `Load.magnitude`.
        """
        right = np.zeros_like(now.q)
        for load in self.scene.loads.values():
            size = self.magnitude(load, time_s, now, strokes)
            if load.point is None:
                right += size[:, None] * now.gradient[:, self.assembly.frames[load.body], 2]
                continue
            marker = self.assembly.marker(load.body, load.point)
            angle = np.full_like(size, load.direction_rad)
            if load.frame == "body":
                angle = angle + now.place[:, marker, 2]
            force = size[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
            right += (force[:, None] @ now.gradient[:, marker, :2])[:, 0]
        for deflection in self.deflections(now):
            spring = deflection.spring
            pull = spring.rate * (deflection.q - spring.free) + spring.damping * deflection.rate
            right -= pull[:, None] * deflection.gradient
        return right

    def driving(self, time_s: Array, now: Configuration) -> Array:
        """Return the torque on the driver that is no load [N m], (T,): none in free motion."""
        return np.zeros(len(time_s))

    def magnitude(
        self, load: Load, time_s: Array, now: Configuration, strokes: Strokes | None
    ) -> Array:
        """Return the force or torque of a load, (T,)."""
        speed = None
        if load.slider is not None and load.stroke != "both" and strokes is None:
            speed = self.slide(load.slider, now).speed
        size = load.magnitude(self.over(load, time_s, now), speed)
        if strokes is not None and not strokes.get(load.name, True):
            return np.zeros_like(size)
        return size

    def over(self, load: Load, time_s: Array, now: Configuration) -> Array:
        """Return the argument of a load's magnitude, in the unit of `Load.over`, (T,)."""
        if load.over == "time":
            return time_s
        if load.over == "angle":
            return now.place[:, self.assembly.frames[self.scene.driver.link], 2]
        if load.over == "omega":
            return now.velocity[:, self.assembly.frames[load.body], 2]
        assert load.slider is not None
        slide = self.slide(load.slider, now)
        return slide.displacement if load.over == "displacement" else slide.speed

    def slide(self, name: str, now: Configuration) -> Slide:
        """Return the place of a slider along its line."""
        tip, guide = self.assembly.tips[name], self.assembly.guides[name]
        angle = now.place[:, guide, 2]
        along = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        across = np.stack([-along[:, 1], along[:, 0]], axis=1)
        away = now.place[:, tip, :2] - now.place[:, guide, :2]
        aside = (across * away).sum(axis=1)  # 0 except for the gap of the joint
        drawn = now.gradient[:, tip, :2] - now.gradient[:, guide, :2]
        gradient = (along[:, None] @ drawn)[:, 0] + aside[:, None] * now.gradient[:, guide, 2]
        speed = (gradient * now.rates).sum(axis=1)
        return Slide((along * away).sum(axis=1), speed, gradient)

    def deflections(self, now: Configuration) -> Iterator[SpringDeflection]:
        """Yield the deflection of every spring."""
        for spring in self.scene.springs.values():
            if isinstance(spring, LineSpring):
                yield self._line(spring, now)
            elif isinstance(spring, PinSpring):
                first, second = self._sides(spring)
                gradient = now.gradient[:, second, 2] - now.gradient[:, first, 2]
                q = self._turned(spring, now) - math.tau * self._turns[spring.name]
                yield SpringDeflection(spring, q, (gradient * now.rates).sum(axis=1), gradient)
            else:
                slide = self.slide(spring.slider, now)
                yield SpringDeflection(spring, slide.displacement, slide.speed, slide.gradient)

    def _turned(self, spring: PinSpring, now: Configuration) -> Array:
        first, second = self._sides(spring)
        return np.asarray(now.place[:, second, 2] - now.place[:, first, 2])

    def _sides(self, spring: PinSpring) -> tuple[int, int]:
        """Return the two markers of its ends: at the pin, where a link may be bent."""
        held = self.assembly.held[spring.point]
        first, second = (held[body] for body in spring.bodies)
        return first, second

    def _line(self, spring: LineSpring, now: Configuration) -> SpringDeflection:
        a, b = (self.assembly.carriers[point][1] for point in spring.points)
        way = now.place[:, b, :2] - now.place[:, a, :2]
        length = np.hypot(way[:, 0], way[:, 1])
        # At zero length it has no direction, and its pull has no effect.
        along = way / np.where(length > 0.0, length, 1.0)[:, None]
        drawn = now.gradient[:, b, :2] - now.gradient[:, a, :2]
        gradient = (along[:, None] @ drawn)[:, 0]
        return SpringDeflection(spring, length, (gradient * now.rates).sum(axis=1), gradient)


MOST_EDGES = 100_000
"""Most edges of a load over time that are integrated from one to the next."""


@dataclass(frozen=True)
class Switch:
    """Load with kinks over a coordinate of the state, or, ``turning``, with a stroke.

    Between two kinks the coordinate is in one ``cell``: cell k begins with kink k - 1; with a
    ``period`` they go on for ever, to both sides.
    """

    load: Load
    kinks: tuple[float, ...]
    period: float | None
    turning: bool

    def of_state(self, forces: GeneralisedForces, state: Array) -> float:
        """Return the coordinate of a state of q, q' and the work, (2 n + 1,), in the unit of the
        kinks."""
        n = forces.assembly.size
        now = forces.assembly.at_rates(state[None, :n], state[None, n : 2 * n])
        if self.turning:
            assert self.load.slider is not None
            return float(forces.slide(self.load.slider, now).speed[0])
        return float(forces.over(self.load, np.zeros(1), now)[0])

    def cell(self, x: float) -> int:
        """Return the number of the cell of a coordinate."""
        if self.period is None:
            return int(np.searchsorted(self.kinks, x, side="right"))
        turns = int((x - self.kinks[0]) // self.period)
        within = x - turns * self.period
        return turns * len(self.kinks) + int(np.searchsorted(self.kinks, within, side="right"))

    def begin(self, cell: int) -> float:
        """Return the kink with which a cell begins."""
        turns, k = divmod(cell - 1, len(self.kinks))
        return self.kinks[k] + (turns * self.period if self.period is not None else 0.0)


def switches(forces: GeneralisedForces) -> tuple[Switch, ...]:
    """Return the switches of all loads of a scene that depend on the state."""
    found = []
    for load in forces.scene.loads.values():
        kinks = load.characteristic.kinks
        if load.over != "time" and kinks:
            period = load.characteristic.repeats_after
            if period is not None and kinks[-1] - kinks[0] > period * (1.0 - 1e-9):
                kinks = kinks[:-1]  # the first of the next period
            found.append(Switch(load, kinks, period, turning=False))
        if load.stroke != "both":
            found.append(Switch(load, (0.0,), None, turning=True))
    return tuple(found)


def state_cells(own: tuple[Switch, ...], forces: GeneralisedForces, state: Array) -> Array:
    """Return the cells of the switches at a state (2 n + 1,)."""
    return np.array([switch.cell(switch.of_state(forces, state)) for switch in own], dtype=int)


def strokes(own: tuple[Switch, ...], cells: Array) -> Strokes:
    """Return the activity of the loads on one stroke, with the switches in their cells."""
    return {
        switch.load.name: bool((cell > 0) == (switch.load.stroke == "forward"))
        for switch, cell in zip(own, cells, strict=True)
        if switch.turning
    }


def edges(scene: Scene, until_s: float) -> list[float]:
    """Return the times at which loads over time are not smooth, with 0 and the end."""
    inside: set[float] = set()
    for load in scene.loads.values():
        if load.over == "time":
            inside.update(islice(load.characteristic.kinks_between(0.0, until_s), MOST_EDGES))
    return [0.0, *sorted(inside - {0.0, until_s}), until_s]
