"""Actions on the bodies of a space beside their weight and their joints, step by step."""

from models.array import Array
from sim.engine import Drive
from sim.engine.acting import Acting, Pushes
from sim.pymunk import bodies, space


class SpaceActing:
    """Loads, springs and friction of sliders in a space, with the magnitudes of the end of a step:
    there they act where the joints do, and the step keeps its order. With those of its start they
    would be a step late: with a force of a sine on the lecture's four-bar at 1440 steps a turn,
    reactions would be off by 4e-3 of the largest, instead of 3e-5."""

    def __init__(self, model: space.SpaceModel, dt_s: float, drive: Drive) -> None:
        self._model, self._dt = model, dt_s
        chained = () if model.springs else bodies.chain_springs(model.scene)
        self._chain = bodies.ChainSprings(model, chained, dt_s) if chained else None
        but = [*model.springs, *(spring.name for spring in chained)]
        start = bodies.frames_at_end(model, 0.0)
        self._acting = Acting("pymunk", model, start, dt_s, drive, but)

    def __bool__(self) -> bool:
        return bool(self._acting) or self._chain is not None

    @property
    def rubbed(self) -> dict[str, float]:
        """Friction of each slider's guide on the sliding body in the last step [N]."""
        return self._acting.rubbed

    def springs(self) -> dict[str, tuple[float, float, float]]:
        """Return the active springs by name: rate, damping and slack length."""
        own = {name: spring.numbers for name, spring in self._model.springs.items()}
        chain = self._chain.numbers if self._chain else {}
        return own | chain | self._acting.springs

    def look_ahead(self, times: Array) -> None:
        """Compute the known loads of the next steps, which end at these times [s]."""
        self._acting.look_ahead(times)

    def apply(self, step: int) -> None:
        """Apply all actions of a step, by its number since the look ahead, from 0 on."""
        if self._chain and not self._acting:
            self._chain.push()
            return
        chain = self._chain.by_body() if self._chain else {}
        pushes = self._acting.pushes(step, bodies.frames_at_end(self._model, self._dt))
        for name, body in self._model.bodies.items():
            fx, fy, moment = pushes.on_bodies[name]
            body.force, body.torque = (fx, fy), moment + chain.get(name, 0.0)

    def pulled(self) -> Pushes:
        """Return the actions of the space's own springs in the last step, and with them all actions
        on blocks without mass."""
        pushes = self._acting.none()
        pushes.on_blocks = dict(self._acting.on_blocks)
        if self._model.springs:
            frames = bodies.frames_at_end(self._model, 0.0)
            for spring in self._model.springs.values():
                spring.push(self._dt, frames, pushes)
        return pushes
