"""Actions on bodies beside their weight and their joints, step by step, for engines that are given
forces: loads, springs, and friction of sliders.

An engine says where its bodies are at the instant of a step's forces. The velocity at that instant
itself, for dampers and motors, may be half by the step to come. It is taken from the last three
positions, to the second order, unless the engine has it in the frames of the bodies.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Generic, TypeVar

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.motion import State
from models.scene import GROUND, Point, Scene
from models.scene.characteristics import Staircase
from models.scene.joints import (
    End,
    Frame,
    Prism,
    Slot,
    block_name,
    bodies,
    centre_of,
    joints,
    less,
    local_point,
    riding_body,
    sliding_angle,
    turned,
    whole_turns,
)
from models.scene.loads import ConstantFriction, Load, PinSpring, SlideSpring, Spring
from sim.engine import Drive
from sim.engine.load_magnitudes import ahead, known_ahead
from sim.engine.ties import Hinge, spring_ends

Push = tuple[float, float, float]
"""A force [N] and a moment [N m]."""
NONE: Push = (0.0, 0.0, 0.0)
Frames = Mapping[str, Frame]
"""Frames of bodies, with the engine's own origins, and ground, at the instant of forces."""
Value = TypeVar("Value", float, Array)


@dataclass(frozen=True)
class EngineBodies:
    """Bodies of a scene in an engine at a state; ``centre`` is the origin of each in the engine,
    and of the ground, in the frame of its link [m]."""

    scene: Scene
    state: State
    centre: dict[str, Point] = field(default_factory=lambda: {GROUND: (0.0, 0.0)}, kw_only=True)

    def anchor(self, body: str, point: str) -> Point:
        """Return a named point in the coordinates of its body in the engine [m]."""
        return self.from_centre(body, local_point(self.scene, body, point))

    def from_centre(self, body: str, place: Point) -> Point:
        """Return a place in the frame of a link in the coordinates of its body in the engine."""
        return less(place, self.centre[body])

    def hinge_ends(self, hinge: Hinge) -> tuple[End, End]:
        """Return the two bodies of a hinge, with its place on each."""
        first, other = hinge.first, hinge.other
        return (first, self.anchor(first, hinge.point)), (other, self.anchor(other, hinge.point))

    def line_ends(self, slide: Prism | Slot) -> tuple[End, End]:
        """Return a sliding body with its point, and its guide with a place on the line."""
        slider, rider = slide.slider, riding_body(slide)
        start = self.from_centre(slider.on, slider.through_m)
        return (rider, self.anchor(rider, slider.point)), (slider.on, start)


def centres(scene: Scene) -> dict[str, Point]:
    """Return the centre of mass of every body, and the origin of the ground, as `EngineBodies`."""
    return {GROUND: (0.0, 0.0)} | {name: centre_of(scene, name) for name in bodies(scene)}


class Pushes:
    """Forces at the origins of bodies with moments about them, by body, and their part on slider
    blocks without mass, which transfer it, by slider."""

    def __init__(self, bodies: Iterable[str], blocks: Iterable[str]) -> None:
        self.on_bodies = dict.fromkeys(bodies, NONE)
        self.on_blocks = dict.fromkeys(blocks, NONE)

    def torque(self, body: str, size: float) -> None:
        """Add a torque [N m]."""
        self.on_bodies[body] = _sum(self.on_bodies[body], (0.0, 0.0, size))

    def force(self, body: str, frame: Frame, place: Point, force: Point) -> None:
        """Add a force [N] on a body with that frame, at a place of the plane [m]."""
        x, y = less(place, frame.origin)
        push = force[0], force[1], x * force[1] - y * force[0]
        self.on_bodies[body] = _sum(self.on_bodies[body], push)

    def pull(self, first: End, second: End, frames: Mapping[str, Frame], size: float) -> Point:
        """Pull two places on bodies together by a force [N]; return it as the first body has it.
        Where they meet it has no direction."""
        (one, a), (other, b) = first, second
        here, there = frames[one].at(a), frames[other].at(b)
        way = less(there, here)
        per_length = size / (math.hypot(*way) or math.inf)
        fx, fy = per_length * way[0], per_length * way[1]
        self.force(one, frames[one], here, (fx, fy))
        self.force(other, frames[other], there, (-fx, -fy))
        return fx, fy

    def note(self, slider: str, push: Push) -> None:
        """Note an action on a block without mass, beside the bodies that take it."""
        self.on_blocks[slider] = _sum(self.on_blocks[slider], push)


def _sum(a: Push, b: Push) -> Push:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


class Course(Generic[Value]):
    """A quantity, or many, at the ends of the last steps, and its rate."""

    def __init__(self, start: Value, dt_s: float) -> None:
        self._dt = dt_s
        self._values: list[Value] = [start]
        self._rate: Value | None = None

    def go_on(self, value: Value, rate: Value | None = None) -> None:
        """Go on to the end of the next step, with the rate there if it is known."""
        self._rate = rate
        self._values.append(value)
        del self._values[:-3]

    @property
    def value(self) -> Value:
        """Value at the end of the step."""
        return self._values[-1]

    @property
    def rate(self) -> Value:
        """Rate there, if not known by the parabola through three values, or the line through
        two."""
        if self._rate is not None:
            return self._rate
        if len(self._values) < 3:
            return (self._values[-1] - self._values[0]) / self._dt
        first, second, third = self._values
        return (3.0 * third - 4.0 * second + first) / (2.0 * self._dt)

    @property
    def rate_before(self) -> Value:
        """Rate half a step before the end."""
        return (self._values[-1] - self._values[-2]) / self._dt


class FollowedCoordinate(ABC):
    """A coordinate of the bodies that a load, a spring or friction follows, step by step."""

    def __init__(self, start: float, dt_s: float) -> None:
        self.course = Course(start, dt_s)

    def follow(self, frames: Frames, *, rates: bool) -> None:
        """Go on to the frames at the end of a step, with ``rates`` to their velocities too."""
        self.course.go_on(self.value(frames), self.rate(frames) if rates else None)

    @abstractmethod
    def value(self, frames: Frames) -> float:
        """Return the coordinate [m or rad]."""

    @abstractmethod
    def rate(self, frames: Frames) -> float:
        """Return its rate by the velocities of the frames."""

    @abstractmethod
    def push(self, size: float, frames: Frames, pushes: Pushes) -> None:
        """Add a force [N] or a couple [N m] that makes it larger."""


class SliderCourse(FollowedCoordinate):
    """Displacement of a slider; a push acts on the sliding body, and back on its guide."""

    def __init__(self, placed: EngineBodies, slide: Prism | Slot, dt_s: float) -> None:
        self._slide, slider = slide, slide.slider
        (self._rider, self._anchor), (self._guide, self._start) = placed.line_ends(slide)
        self._along = turned((1.0, 0.0), slider.direction_rad)
        super().__init__(placed.state.displacement[slider.name], dt_s)

    def value(self, frames: Frames) -> float:
        place = frames[self._rider].at(self._anchor)
        x, y = less(frames[self._guide].into(place), self._start)
        return x * self._along[0] + y * self._along[1]

    def rate(self, frames: Frames) -> float:
        guide, rider = frames[self._guide], frames[self._rider]
        place = rider.at(self._anchor)
        drift = less(rider.velocity_at(place), guide.velocity_at(place))
        u, v = turned(self._along, guide.theta)
        return u * drift[0] + v * drift[1]

    def push(self, size: float, frames: Frames, pushes: Pushes) -> None:
        slider, rider, guide = self._slide.slider, frames[self._rider], frames[self._guide]
        fx, fy = turned((size, 0.0), guide.theta + slider.direction_rad)
        if isinstance(self._slide, Slot):
            pushes.note(slider.name, (fx, fy, 0.0))
        place = rider.at(self._anchor)
        pushes.force(self._rider, rider, place, (fx, fy))
        pushes.force(self._guide, guide, place, (-fx, -fy))


class _EndDistance(FollowedCoordinate):
    """Distance of two places on bodies."""

    def __init__(self, first: End, second: End, start: Frames, dt_s: float) -> None:
        self._ends = first, second
        super().__init__(self.value(start), dt_s)

    def value(self, frames: Frames) -> float:
        return math.dist(*(frames[body].at(anchor) for body, anchor in self._ends))

    def rate(self, frames: Frames) -> float:
        (one, a), (other, b) = self._ends
        here, there = frames[one].at(a), frames[other].at(b)
        drift = less(frames[other].velocity_at(there), frames[one].velocity_at(here))
        way = less(there, here)
        return (way[0] * drift[0] + way[1] * drift[1]) / (self.value(frames) or math.inf)

    def push(self, size: float, frames: Frames, pushes: Pushes) -> None:
        pushes.pull(*self._ends, frames, -size)


class _BodyAngle(FollowedCoordinate):
    """Angle of a body against another, and in the pin of a ``spring`` its whole turns."""

    def __init__(
        self, first: str, second: str, start: Frames, dt_s: float, spring: PinSpring | None = None
    ) -> None:
        self._first, self._second, self._whole = first, second, 0.0
        if spring is not None:
            self._whole = whole_turns(spring, self.value(start))
        super().__init__(self.value(start), dt_s)

    def value(self, frames: Frames) -> float:
        return frames[self._second].theta - frames[self._first].theta + self._whole

    def rate(self, frames: Frames) -> float:
        return frames[self._second].omega - frames[self._first].omega

    def push(self, size: float, frames: Frames, pushes: Pushes) -> None:
        pushes.torque(self._second, size)
        pushes.torque(self._first, -size)


class LoadSteps:
    """Loads on bodies; ``slots`` are the blocks without mass, by body name.

    In free motion a step's load is also its change of velocity, so that a jump, or the end of a
    stroke, counts with its share of the step about that instant: half of a jump at a sample. In
    driven motion it is read as the force at the sample, where a jump has its new value and a load
    of a stroke that ends there may act or not.
    """

    def __init__(
        self,
        placed: EngineBodies,
        slots: Mapping[str, Slot],
        tracks: Mapping[str, SliderCourse],
        turning: Mapping[str, FollowedCoordinate],
        dt_s: float,
        drive: Drive,
    ) -> None:
        self._placed, self._dt, self._drive = placed, dt_s, drive
        self._scene = scene = placed.scene
        self._slots, self._tracks, self._turning = slots, tracks, turning
        self._of_strokes: dict[str, Load] = {}
        self._stairs: dict[str, Staircase] = {}
        if drive == "free":
            for name, load in scene.loads.items():
                if load.stroke != "both":
                    self._of_strokes[name] = replace(load, stroke="both")
                if isinstance(load.characteristic, Staircase):
                    self._stairs[name] = load.characteristic
        self._begun = False
        self._times: list[float] = []
        self._known: dict[str, list[float]] = {}

    def look_ahead(self, times: Array) -> None:
        """Compute the known loads of the next steps, which act at these times [s]."""
        self._times = times.tolist()
        self._known = {
            name: self._ahead(load, times).tolist()
            for name, load in self._scene.loads.items()
            if known_ahead(load, self._drive)
        }
        self._begun = self._begun or len(times) > 0

    def _ahead(self, load: Load, times: Array) -> Array:
        sizes = ahead(self._scene, load, times)
        if load.name in self._stairs:
            late = late_share(self._stairs[load.name], times, self._dt, first=not self._begun)
            return np.asarray(sizes + late)
        return sizes

    def push(self, step: int, frames: Frames, pushes: Pushes) -> None:
        """Apply the loads of a step, by its number since the look ahead, from 0 on."""
        for name, load in self._scene.loads.items():
            size = (
                self._known[name][step] if name in self._known else self._size(load, step, frames)
            )
            self._apply(load, size, frames, pushes)

    def _size(self, load: Load, step: int, frames: Frames) -> float:
        """Return the magnitude of a load that follows the motion, in a step."""
        sliders = {
            name: (track.course.value, track.course.rate) for name, track in self._tracks.items()
        }
        omega = self._turning[load.body].course.rate if load.over == "omega" else 0.0
        now = self._times[step], frames[self._scene.driver.link].theta, sliders, omega
        if load.name in self._of_strokes:
            return self._share_of_stroke(load) * self._of_strokes[load.name].size(*now)
        return load.size(*now)

    def _share_of_stroke(self, load: Load) -> float:
        """Return the share of the step about its end with the slider on the load's stroke."""
        assert load.slider is not None
        course = self._tracks[load.slider].course
        before, here = course.rate_before, course.rate
        after = 2.0 * here - before
        low, high = min(before, after), max(before, after)
        turns = low < 0.0 < high
        forward = high / (high - low) if turns else float(here > 0.0)
        return forward if load.stroke == "forward" else 1.0 - forward

    def _apply(self, load: Load, size: float, frames: Frames, pushes: Pushes) -> None:
        """Apply a load: on a massless block, a force to its pin's body, a torque to its guide."""
        slot = self._slots.get(load.body)
        body, turning, theta = load.body, load.body, 0.0
        if slot is not None:
            body, turning, theta = riding_body(slot), slot.slider.on, sliding_angle(slot.slider)
        if load.point is None:
            push = 0.0, 0.0, size
            pushes.torque(turning, size)
        else:
            own = frames[turning].theta + theta if load.frame == "body" else 0.0
            fx, fy = turned((size, 0.0), load.direction_rad + own)
            push = fx, fy, 0.0
            point = load.point if slot is None else slot.slider.point
            place = frames[body].at(self._placed.anchor(body, point))
            pushes.force(body, frames[body], place, (fx, fy))
        if slot is not None:
            pushes.note(slot.slider.name, push)


def late_share(steps: Staircase, times: Array, dt_s: float, *, first: bool) -> Array:
    """Return the correction of a staircase at sample times [s] to its mean over a step about each,
    (T,).

    Before the ``first`` of them the velocities have made half a step with the load of the start, so
    the sample makes up for a jump in that half.
    """
    added = np.zeros(len(times))
    rises = np.diff(steps.values, prepend=0.0)
    for place, rise in zip(steps.places, rises, strict=True):
        after = np.clip((times - place) / dt_s + 0.5, 0.0, 1.0)
        if first and len(times) and times[0] - dt_s < place < times[0] - 0.5 * dt_s:
            after[0] = (times[0] - place) / dt_s + 0.5
        added += rise * (after - (times >= place))
    return added


def slider_friction(scene: Scene, drive: Drive, engine: str) -> dict[str, float]:
    """Return the size of the constant friction of each slider that has it [N].

    It acts against the speed at the end of a step. It does not hold a slider at rest: a driven
    mechanism is at rest at the ends of strokes only. Raises EngineError for free motion.
    """
    rubbing = {
        one.joint: one.size
        for one in scene.friction.values()
        if isinstance(one, ConstantFriction) and one.joint in scene.sliders
    }
    if drive == "free" and rubbing:
        names = ", ".join(f"friction.{name}" for name in rubbing)
        raise EngineError(
            f"{scene.name}: {names}: {engine} has no friction that holds a slider at rest, and "
            "free motion may bring it to rest; drive the mechanism, or remove the friction"
        )
    return rubbing


class Acting:
    """Loads, springs and friction of sliders; not springs of the names ``but``, nor friction where
    the engine ``rubs``: it has these itself. ``bodies`` are placed so in the ``engine``, with the
    frames ``start`` there; with ``rates`` all frames have the velocities of their instant."""

    def __init__(
        self,
        engine: str,
        bodies: EngineBodies,
        start: Frames,
        dt_s: float,
        drive: Drive,
        but: Collection[str] = (),
        *,
        rubs: bool = False,
        rates: bool = False,
    ) -> None:
        scene, self._rates = bodies.scene, rates
        slides = joints(scene).slides
        followed = {load.slider for load in scene.loads.values()}
        followed |= {getattr(one, "slider", None) for one in scene.springs.values()}
        followed |= {*scene.friction}
        self._tracks = {
            slide.slider.name: SliderCourse(bodies, slide, dt_s)
            for slide in slides
            if slide.slider.name in followed
        }
        turning = {
            load.body: _BodyAngle(GROUND, load.body, start, dt_s)
            for load in scene.loads.values()
            if load.over == "omega"
        }
        slots = {block_name(slide.slider): slide for slide in slides if isinstance(slide, Slot)}
        self._loads = LoadSteps(bodies, slots, self._tracks, turning, dt_s, drive)
        springs = [own for name, own in scene.springs.items() if name not in but]
        self._springs = [(own, self._deflection(own, bodies, start, dt_s)) for own in springs]
        self.springs = {own.name: (own.rate, own.damping, own.free) for own in springs}
        """The active springs by name: rate, damping and slack length."""
        coordinates = *self._tracks.values(), *turning.values(), *(q for _, q in self._springs)
        self._followed = tuple(dict.fromkeys(coordinates))
        self._friction = {} if rubs else slider_friction(scene, drive, engine)
        self._acts = bool(scene.loads or self._springs or self._friction)
        self._bodies = tuple(start)
        self._blocks = tuple(slot.slider.name for slot in slots.values())
        self.on_blocks = dict.fromkeys(self._blocks, NONE)
        """Actions of the last step on slider blocks without mass, by slider."""
        self.rubbed: dict[str, float] = {}
        """Friction of each slider's guide on the sliding body in the last step [N]."""

    def __bool__(self) -> bool:
        return self._acts

    def _deflection(
        self, spring: Spring, bodies: EngineBodies, start: Frames, dt_s: float
    ) -> FollowedCoordinate:
        """Return the coordinate of a spring."""
        if isinstance(spring, SlideSpring):
            return self._tracks[spring.slider]
        if isinstance(spring, PinSpring):
            return _BodyAngle(*spring.bodies, start, dt_s, spring)
        ends = spring_ends(bodies.scene, spring)
        first, second = ((body, bodies.from_centre(body, place)) for body, place in ends)
        return _EndDistance(first, second, start, dt_s)

    def look_ahead(self, times: Array) -> None:
        """Compute the known loads of the next steps, which act at these times [s]."""
        self._loads.look_ahead(times)

    def none(self) -> Pushes:
        """Return no action on any body or block."""
        return Pushes(self._bodies, self._blocks)

    def pushes(self, step: int, frames: Frames) -> Pushes:
        """Return all actions of a step, by its number since the look ahead, from 0 on, with the
        bodies where they are at its instant; it has to be called once for each, in turn."""
        for coordinate in self._followed:
            coordinate.follow(frames, rates=self._rates)
        pushes, self.rubbed = self.none(), {}
        self._loads.push(step, frames, pushes)
        for spring, own in self._springs:
            own.push(-spring.pull(own.course.value, own.course.rate), frames, pushes)
        for name, size in self._friction.items():
            speed = self._tracks[name].course.rate
            self.rubbed[name] = -math.copysign(size, speed) if speed else 0.0
            self._tracks[name].push(self.rubbed[name], frames, pushes)
        self.on_blocks = pushes.on_blocks
        return pushes
