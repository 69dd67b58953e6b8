"""The loads of a scene on the bodies of a space, step by step.

A step of Chipmunk moves the positions with the velocity that is there, and then changes that by
the forces it was given. Where the bodies will be at its end is known before it, and so are arms and
directions there; with the magnitudes of that instant the loads act where the joints do, and the
step keeps its order. Those of its start would be a step late, and of first order: with a force of a
sine on the lecture's four-bar at 1440 steps a turn, reactions are off by 4e-3 of the largest, and
by 3e-5 as it is. At the sample where a stroke ends, a load of that stroke may act or not.

Friction of a slider that is always as large is given like a load, against its motion. The speed of
a slider is that at the end of the step too, from its last three displacements.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from models.array import Array
from models.errors import EngineError
from models.friction import ConstantFriction
from models.joints import (
    Prism,
    Slot,
    block_name,
    joints,
    less,
    local_point,
    riding_body,
    sliding_angle,
    turned,
)
from models.loads import Load
from models.motion import State
from models.poses import FIXED, Frame
from models.scene import GROUND, Point, Scene
from sim.engine import Drive
from sim.load_magnitudes import ahead, known_ahead
from sim.pymunk.space import SpaceModel

Push = tuple[float, float, float]
"""A force [N] and a moment [N m]."""


class LoadSteps:
    """The loads of a scene in a space, and the constant friction of its sliders."""

    def __init__(
        self, scene: Scene, model: SpaceModel, state: State, dt_s: float, drive: Drive
    ) -> None:
        self._scene, self._model, self._dt, self._drive = scene, model, dt_s, drive
        slides = {slide.slider.name: slide for slide in joints(scene).slides}
        self._slots = {
            block_name(slide.slider): slide for slide in slides.values() if isinstance(slide, Slot)
        }
        self._rubbing = [
            (slides[one.joint], one.size)
            for one in scene.friction.values()
            if isinstance(one, ConstantFriction) and one.joint in slides
        ]
        followed = {load.slider for load in scene.loads.values()}
        followed |= {slide.slider.name for slide, _ in self._rubbing}
        self._tracks = {
            name: _Track(scene, model, slide, state.displacement[name], dt_s)
            for name, slide in slides.items()
            if name in followed
        }
        self._times: list[float] = []
        self._known: dict[str, list[float]] = {}
        self.on_blocks: dict[str, Push] = {}
        """What the last step had on slider blocks without mass, by slider."""
        self.rubbed: dict[str, float] = {}
        """The friction of each slider's guide on what slides in the last step [N]."""
        if drive == "free" and self._rubbing:
            names = ", ".join(f"friction.{slide.slider.name}" for slide, _ in self._rubbing)
            raise EngineError(
                f"{scene.name}: {names}: pymunk has no friction that holds a slider at rest, and "
                "free motion may bring it there; drive the mechanism, or take the friction out"
            )

    def __bool__(self) -> bool:
        return bool(self._scene.loads or self._rubbing)

    def look_ahead(self, times: Array) -> None:
        """Work out what is known before the next steps, which end at these times [s]."""
        self._times = times.tolist()
        self._known = {
            name: ahead(self._scene, load, times).tolist()
            for name, load in self._scene.loads.items()
            if known_ahead(load, self._drive)
        }

    def apply(self, step: int) -> None:
        """Have the loads act in the step of that number since the look ahead, from 0 on."""
        frames = {GROUND: FIXED} | {
            name: Frame(
                (
                    body.position[0] + self._dt * body.velocity[0],
                    body.position[1] + self._dt * body.velocity[1],
                ),
                body.angle + self._dt * body.angular_velocity,
                (0.0, 0.0),
                0.0,
            )
            for name, body in self._model.bodies.items()
        }
        for track in self._tracks.values():
            track.follow(frames)
        self.on_blocks = {slot.slider.name: (0.0, 0.0, 0.0) for slot in self._slots.values()}
        self.rubbed = {}
        totals = dict.fromkeys(frames, (0.0, 0.0, 0.0))
        for name, load in self._scene.loads.items():
            if load.body in self._slots:
                pushes = self._on_block(load, self._size(name, step), frames)
            else:
                pushes = self._on_body(load, self._size(name, step), frames)
            _add(totals, pushes)
        for slide, size in self._rubbing:
            _add(totals, self._rub(slide, size, frames))
        for name, body in self._model.bodies.items():
            fx, fy, moment = totals[name]
            body.force, body.torque = (fx, fy), moment

    def _size(self, name: str, step: int) -> float:
        """The magnitude of a load at the end of a step."""
        if name in self._known:
            return self._known[name][step]
        crank = self._model.crank
        sliders = {
            slider: (track.places[-1], track.speed) for slider, track in self._tracks.items()
        }
        theta = crank.angle + self._dt * crank.angular_velocity
        load = self._scene.loads[name]
        body = self._model.bodies.get(load.body)
        omega = 0.0 if body is None else body.angular_velocity
        return load.size(self._times[step], theta, sliders, omega)

    def _on_body(
        self, load: Load, size: float, frames: Mapping[str, Frame]
    ) -> Iterator[tuple[str, Push]]:
        """A load on a body of the space."""
        if load.point is None:
            yield load.body, (0.0, 0.0, size)
            return
        frame = frames[load.body]
        force = _along(load, size, frame.theta)
        place = self._anchor(load.body, local_point(self._scene, load.body, load.point))
        yield load.body, _about(frame, frame.at(place), force)

    def _on_block(
        self, load: Load, size: float, frames: Mapping[str, Frame]
    ) -> Iterator[tuple[str, Push]]:
        """A load on a block without mass: its pin's body takes the force, its guide a torque."""
        slot = self._slots[load.body]
        slider = slot.slider
        if load.point is None:
            self._note(slot, (0.0, 0.0, size))
            yield slider.on, (0.0, 0.0, size)
            return
        force = _along(load, size, frames[slider.on].theta + sliding_angle(slider))
        self._note(slot, (*force, 0.0))
        rider = riding_body(slot)
        place = self._anchor(rider, local_point(self._scene, rider, slider.point))
        yield rider, _about(frames[rider], frames[rider].at(place), force)

    def _rub(
        self, slide: Prism | Slot, size: float, frames: Mapping[str, Frame]
    ) -> Iterator[tuple[str, Push]]:
        """Friction on what slides, against its motion along the line, and the opposite on the
        guide."""
        slider, rider = slide.slider, riding_body(slide)
        against = -math.copysign(size, speed) if (speed := self._tracks[slider.name].speed) else 0.0
        self.rubbed[slider.name] = against
        fx, fy = turned((against, 0.0), frames[slider.on].theta + slider.direction_rad)
        if isinstance(slide, Slot):
            self._note(slide, (fx, fy, 0.0))
        place = frames[rider].at(self._anchor(rider, local_point(self._scene, rider, slider.point)))
        yield rider, _about(frames[rider], place, (fx, fy))
        yield slider.on, _about(frames[slider.on], place, (-fx, -fy))

    def _note(self, slot: Slot, push: Push) -> None:
        """What acts on a block without mass."""
        x, y, moment = self.on_blocks[slot.slider.name]
        self.on_blocks[slot.slider.name] = x + push[0], y + push[1], moment + push[2]

    def _anchor(self, body: str, local: Point) -> Point:
        """A place of a link's frame in the coordinates of the pymunk body."""
        return less(local, self._model.centre[body])


class _Track:
    """The displacement of a slider at the ends of the last steps [m], and its speed [m/s]."""

    def __init__(
        self, scene: Scene, model: SpaceModel, slide: Prism | Slot, start_m: float, dt_s: float
    ) -> None:
        slider, self._rider = slide.slider, riding_body(slide)
        self._guide, self._dt = slider.on, dt_s
        local = local_point(scene, self._rider, slider.point)
        self._anchor = less(local, model.centre[self._rider])
        centre = (0.0, 0.0) if slider.on == GROUND else model.centre[slider.on]
        self._start = less(slider.through_m, centre)
        self._along = turned((1.0, 0.0), slider.direction_rad)
        self.places = [start_m]

    def follow(self, frames: Mapping[str, Frame]) -> None:
        """Go on to where the bodies will be at the end of a step."""
        seen = frames[self._guide].into(frames[self._rider].at(self._anchor))
        x, y = less(seen, self._start)
        self.places = [*self.places[-2:], x * self._along[0] + y * self._along[1]]

    @property
    def speed(self) -> float:
        """Of the parabola through the last three places, at the last; of the line through two."""
        if len(self.places) < 3:
            return (self.places[-1] - self.places[0]) / self._dt
        first, second, third = self.places
        return (3.0 * third - 4.0 * second + first) / (2.0 * self._dt)


def _along(load: Load, size: float, theta: float) -> Point:
    """The force of a load on a body at that angle."""
    return turned((size, 0.0), load.direction_rad + (theta if load.frame == "body" else 0.0))


def _about(frame: Frame, place: Point, force: Point) -> Push:
    """A force at a place of the plane, as one on a body with its moment about the origin."""
    x, y = less(place, frame.origin)
    return force[0], force[1], x * force[1] - y * force[0]


def _add(totals: dict[str, Push], pushes: Iterator[tuple[str, Push]]) -> None:
    """Put pushes on the bodies they act on."""
    for body, push in pushes:
        x, y, moment = totals[body]
        totals[body] = x + push[0], y + push[1], moment + push[2]
