"""Actions on the bodies of a space beside their weight and their joints, step by step."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.scene import GROUND, Scene
from models.scene.characteristics import Staircase
from models.scene.joints import Slot, block_name, joints, riding_body, sliding_angle, turned
from models.scene.loads import ConstantFriction, Load
from sim.engine import Drive
from sim.engine.load_magnitudes import ahead, known_ahead
from sim.pymunk import bodies, space
from sim.pymunk.native import NONE, Pushes


class LoadSteps:
    """Loads in a space; ``slots`` are the blocks without mass, by body name.

    With the magnitudes of the end of a step the loads act where the joints do, and the step keeps
    its order. With those of its start they would be a step late, and of first order: with a force
    of a sine on the lecture's four-bar at 1440 steps a turn, reactions would be off by 4e-3 of the
    largest, instead of 3e-5.

    In free motion a step's load is also its change of velocity, so that a jump, or the end of a
    stroke, counts with its share of the step about that instant: half of a jump at a sample. In
    driven motion it is read as the force at the sample, where a jump has its new value and a load
    of a stroke that ends there may act or not.
    """

    def __init__(
        self,
        model: space.SpaceModel,
        slots: Mapping[str, Slot],
        tracks: Mapping[str, bodies.SliderCourse],
        dt_s: float,
        drive: Drive,
    ) -> None:
        self._model, self._dt, self._drive = model, dt_s, drive
        self._scene = scene = model.scene
        self._slots, self._tracks = slots, tracks
        self._turning = {
            load.body: bodies.Course(model.bodies[load.body].angle, dt_s)
            for load in scene.loads.values()
            if load.over == "omega"
        }
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
        """Compute the known loads of the next steps, which end at these times [s]."""
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

    def push(self, step: int, frames: bodies.Frames, pushes: Pushes) -> None:
        """Apply the loads of a step, by its number since the look ahead, from 0 on."""
        for body, course in self._turning.items():
            course.go_on(frames[body].theta)
        for name, load in self._scene.loads.items():
            size = self._known[name][step] if name in self._known else self._size(load, step)
            self._apply(load, size, frames, pushes)

    def _size(self, load: Load, step: int) -> float:
        """Return the magnitude of a load that follows the motion, at the end of a step."""
        crank = self._model.crank
        sliders = {
            name: (track.course.value, track.course.rate) for name, track in self._tracks.items()
        }
        omega = self._turning[load.body].rate if load.over == "omega" else 0.0
        now = self._times[step], crank.angle + self._dt * crank.angular_velocity, sliders, omega
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

    def _apply(self, load: Load, size: float, frames: bodies.Frames, pushes: Pushes) -> None:
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
            place = frames[body].at(self._model.anchor(body, point))
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


def slider_friction(scene: Scene, drive: Drive) -> dict[str, float]:
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
            f"{scene.name}: {names}: pymunk has no friction that holds a slider at rest, and "
            "free motion may bring it there; drive the mechanism, or take the friction out"
        )
    return rubbing


class Acting:
    """Loads, springs and friction of sliders in a space."""

    def __init__(self, model: space.SpaceModel, dt_s: float, drive: Drive) -> None:
        scene = model.scene
        slides = joints(scene).slides
        followed = {load.slider for load in scene.loads.values()}
        followed |= {getattr(one, "slider", None) for one in scene.springs.values()}
        followed |= {*scene.friction}
        tracks = {
            slide.slider.name: bodies.SliderCourse(model, slide, dt_s)
            for slide in slides
            if slide.slider.name in followed
        }
        slots = {block_name(slide.slider): slide for slide in slides if isinstance(slide, Slot)}
        self._model, self._dt, self._tracks = model, dt_s, tracks
        self._loads = LoadSteps(model, slots, tracks, dt_s, drive)
        chained = () if model.springs else bodies.chain_springs(scene)
        self._chain = bodies.ChainSprings(model, chained, dt_s) if chained else None
        self._springs = bodies.SpringSteps(model, tracks, dt_s, but=chained)
        self._friction = slider_friction(scene, drive)
        self._others = bool(scene.loads or self._springs or self._friction)
        self._bodies = (GROUND, *model.bodies)
        self._blocks = tuple(slot.slider.name for slot in slots.values())
        self.on_blocks = dict.fromkeys(self._blocks, NONE)
        """Actions of the last step on slider blocks without mass, by slider."""
        self.rubbed: dict[str, float] = {}
        """Friction of each slider's guide on the sliding body in the last step [N]."""

    def __bool__(self) -> bool:
        return self._others or self._chain is not None

    def springs(self) -> dict[str, tuple[float, float, float]]:
        """Return the active springs by name: rate, damping and slack length."""
        own = {name: spring.numbers for name, spring in self._model.springs.items()}
        chain = self._chain.numbers if self._chain else {}
        return own | chain | self._springs.numbers

    def look_ahead(self, times: Array) -> None:
        """Compute the known loads of the next steps, which end at these times [s]."""
        self._loads.look_ahead(times)

    def apply(self, step: int) -> None:
        """Apply all actions of a step, by its number since the look ahead, from 0 on."""
        if self._chain and not self._others:
            self._chain.push()
            return
        chain = self._chain.by_body() if self._chain else {}
        frames = bodies.frames_at_end(self._model, self._dt)
        for track in self._tracks.values():
            track.follow(frames)
        pushes, self.rubbed = Pushes(self._bodies, self._blocks), {}
        self._loads.push(step, frames, pushes)
        self._springs.push(frames, pushes)
        for name, size in self._friction.items():
            speed = self._tracks[name].course.rate
            self.rubbed[name] = -math.copysign(size, speed) if speed else 0.0
            self._tracks[name].push(self.rubbed[name], frames, pushes)
        self.on_blocks = pushes.on_blocks
        for name, body in self._model.bodies.items():
            fx, fy, moment = pushes.on_bodies[name]
            body.force, body.torque = (fx, fy), moment + chain.get(name, 0.0)

    def pulled(self) -> Pushes:
        """Return the actions of the space's own springs in the last step, and with them all actions
        on blocks without mass."""
        pushes = Pushes(self._bodies, self._blocks)
        pushes.on_blocks = dict(self.on_blocks)
        if self._model.springs:
            frames = bodies.frames_at_end(self._model, 0.0)
            for spring in self._model.springs.values():
                spring.push(self._dt, frames, pushes)
        return pushes
