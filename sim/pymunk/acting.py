"""All that acts on the bodies of a space beside their weight and their joints, step by step."""

from __future__ import annotations

from models.array import Array
from models.joints import Slot, block_name, joints
from models.motion import State
from models.scene import GROUND, Scene
from sim.engine import Drive
from sim.pymunk.chain_springs import ChainSprings, chain_springs
from sim.pymunk.load_steps import LoadSteps
from sim.pymunk.pushes import NONE, Pushes
from sim.pymunk.slider_friction import SliderFriction
from sim.pymunk.space import SpaceModel
from sim.pymunk.spring_steps import SpringSteps
from sim.pymunk.step_end import SliderCourse, frames_at_end


class Acting:
    """The loads, springs and friction of sliders of a scene, in a space."""

    def __init__(
        self, scene: Scene, model: SpaceModel, state: State, dt_s: float, drive: Drive
    ) -> None:
        slides = joints(scene).slides
        followed = {load.slider for load in scene.loads.values()}
        followed |= {getattr(one, "slider", None) for one in scene.springs.values()}
        followed |= {*scene.friction}
        tracks = {
            slide.slider.name: SliderCourse(
                scene, model, slide, state.displacement[slide.slider.name], dt_s
            )
            for slide in slides
            if slide.slider.name in followed
        }
        slots = {block_name(slide.slider): slide for slide in slides if isinstance(slide, Slot)}
        self._model, self._dt, self._tracks = model, dt_s, tracks
        self._loads = LoadSteps(scene, model, slots, tracks, dt_s, drive)
        chained = () if model.springs else chain_springs(scene)
        self._chain = ChainSprings(model, chained, dt_s) if chained else None
        self._springs = SpringSteps(scene, model, tracks, dt_s, but=chained)
        self._friction = SliderFriction(scene, model, tracks, drive)
        self._others = bool(scene.loads or self._springs or self._friction)
        self._bodies = (GROUND, *model.bodies)
        self._blocks = tuple(slot.slider.name for slot in slots.values())
        self.on_blocks = dict.fromkeys(self._blocks, NONE)
        """What the last step was given on slider blocks without mass, by slider."""
        self.rubbed: dict[str, float] = {}
        """The friction of each slider's guide on what slides in the last step [N]."""

    def __bool__(self) -> bool:
        return self._others or self._chain is not None

    def springs(self) -> dict[str, tuple[float, float, float]]:
        """The springs that act, by name: rate, damping and the length at which each is slack."""
        own = {name: spring.numbers for name, spring in self._model.springs.items()}
        chain = self._chain.numbers if self._chain else {}
        return own | chain | self._springs.numbers

    def look_ahead(self, times: Array) -> None:
        """Work out what is known before the next steps, which end at these times [s]."""
        self._loads.look_ahead(times)

    def apply(self, step: int) -> None:
        """Have all act in the step of that number since the look ahead, from 0 on."""
        if self._chain and not self._others:
            self._chain.push()
            return
        chain = self._chain.by_body() if self._chain else {}
        frames = frames_at_end(self._model, self._dt)
        for track in self._tracks.values():
            track.follow(frames)
        pushes = Pushes(self._bodies, self._blocks)
        self._loads.push(step, frames, pushes)
        self._springs.push(frames, pushes)
        self.rubbed = self._friction.push(frames, pushes)
        self.on_blocks = pushes.on_blocks
        for name, body in self._model.bodies.items():
            fx, fy, moment = pushes.on_bodies[name]
            body.force, body.torque = (fx, fy), moment + chain.get(name, 0.0)

    def pulled(self) -> Pushes:
        """What the space's own springs did in the step that was made, and with it all that acted on
        blocks without mass."""
        pushes = Pushes(self._bodies, self._blocks)
        pushes.on_blocks = dict(self.on_blocks)
        if self._model.springs:
            frames = frames_at_end(self._model, 0.0)
            for spring in self._model.springs.values():
                spring.push(self._dt, frames, pushes)
        return pushes
