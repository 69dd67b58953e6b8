"""Derivatives of Newton's states, by Warp's tape of each step.

A tape goes backward: one pass gives the derivatives of one number of the state after a step by all
before it. The passes of a step make its matrix, which takes the tangents of the state and of the
model through. Bodies stay in the plane, and so do their tangents.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.scene.joints import mass_of
from sim.compiling import compiling
from sim.engine import Settings
from sim.engine.gradient import OFFSETS, STEP, PoseGradient, Variation, placed, slope
from sim.newton.engine import NewtonSession, View, row, twist
from sim.newton.solvers import made, wp

STATES: Mapping[str, tuple[str, ...]] = {
    "XPBD": ("body_q", "body_qd"),
    "Featherstone": ("joint_q", "joint_qd", "body_q"),
}
"""Arrays of the state that a step hands on, by solver; the others have no tape."""
PLANAR = {"body_q": (0, 1, 5, 6), "body_qd": (0, 1, 5)}
"""Numbers of a body that change in the plane."""
METHOD = "tape"


class TapedSession(NewtonSession):
    """A session whose steps carry tangents, (P, n) by array of the state, along."""

    taped = True

    def begin_tangents(self, near: Sequence[Sequence[NewtonSession]]) -> None:
        """Start from the sessions at the neighbours, four for each dimension."""
        self.near = near
        self.kept = STATES[self.solver_name]
        self.by_model = _slopes(near, _model_numbers)
        self.slopes = _slopes(near, lambda session: _start(session, self.kept))

    def once_taped(self) -> None:
        """Take one step, and the tangents along."""
        self._lead_tangents()
        after, tape = self.model.state(), wp.Tape()
        before = [getattr(self.now.state, name) for name in self.kept]
        with tape:
            solver = made(self.model, self.settings, self.dt)  # which inverts masses
            solver.step(self.now.state, after, self.control, None, self.dt)
        ahead = {name: np.zeros_like(each) for name, each in self.slopes.items()}
        for name in self.kept:
            array = getattr(after, name)
            shape = array.numpy().shape
            for place in _planar(name, shape):
                seed = np.zeros(shape, dtype=np.float32)
                seed.flat[place] = 1.0
                tape.backward(grads={array: wp.array(seed, dtype=array.dtype, device="cpu")})
                passed = zip(self.slopes.values(), before, strict=True)
                of_model = ((by, getattr(self.model, n)) for n, by in self.by_model.items())
                for by, source in (*passed, *of_model):
                    ahead[name][:, place] += by @ source.grad.numpy().ravel()
                tape.zero()
        self.slopes = ahead
        self.now = View(self.model.state())
        for name in ("body_q", "body_qd", "joint_q", "joint_qd"):
            getattr(self.now, name)[:] = getattr(after, name).numpy()

    def _lead_tangents(self) -> None:
        """Put the tangents of the led body where its driver has put it."""
        assert self.led is not None
        led = _slopes(self.near, _led_numbers)
        number, width = (
            self.index[self.led],
            {"body_q": 7, "body_qd": 6, "joint_q": 1, "joint_qd": 1},
        )
        for name in self.kept:
            first = width[name] * (number if name in PLANAR else self.driven[0])
            self.slopes[name][:, first : first + width[name]] = led[name]

    def placed_slopes(self) -> list[Array]:
        """Return the derivatives (1, B, 3) of the places of all bodies by each dimension."""
        found, numbers = [], self.numbers()
        flat = self.slopes["body_q"].reshape(len(self.near), -1, 7)
        for by, sessions in zip(flat, self.near, strict=True):
            own = by[[self.index[name] for name in self.names]]
            half = 0.5 * numbers[:, 2]
            # z, w are sin and cos of half the angle, which a step keeps of length 1.
            turn = 2.0 * (np.cos(half) * own[:, 5] - np.sin(half) * own[:, 6])
            ahead = np.column_stack([own[:, :2], turn, np.zeros((len(own), 3))])
            near = [
                session.poses((numbers + offset * STEP * ahead)[None], np.zeros(1))
                for offset, session in zip(OFFSETS, sessions, strict=True)
            ]
            found.append(slope([placed(self.scene, poses.bodies) for poses in near]))
        return found


def gradient(
    variation: Variation, settings: Settings, dt_s: float, steps: Sequence[int]
) -> Iterator[PoseGradient]:
    """Differentiate each step by its tape. Raises EngineError."""
    solver = str(settings["solver"])
    if solver not in STATES:
        yield PoseGradient(METHOD, refusal=f"the kernels of {solver} have no adjoints")
        return
    if variation.scene.loads or variation.scene.springs or variation.scene.friction:
        raise EngineError(f"{variation.scene.name}: crankcheck adds its loads outside of the tape")
    near = [
        [NewtonSession(*at, settings, dt_s, "prescribed") for at in variation.neighbours(name)]
        for name in variation.names
    ]
    session = TapedSession(variation.scene, variation.state, settings, dt_s, "prescribed")
    session.begin_tangents(near)
    found, by, turns = [], [], session._turns(max(steps))
    led = [[one._turns(max(steps)) for one in each] for each in near]
    with compiling():
        for number in range(1, max(steps) + 1):
            for own, courses in zip(near, led, strict=True):
                for one, course in zip(own, courses, strict=True):
                    one.turn(*course[number - 1])
            session.turn(*turns[number - 1])
            session.once_taped()
            session.done += 1
            now = session.numbers()
            if number in steps:
                found.append(placed(variation.scene, session.poses(now[None], np.zeros(1)).bodies))
                by.append(session.placed_slopes())
    ahead = {n: np.concatenate([one[i] for one in by]) for i, n in enumerate(variation.names)}
    yield PoseGradient(METHOD, np.concatenate(found), ahead)


def _slopes(
    near: Sequence[Sequence[NewtonSession]], numbers: Callable[[NewtonSession], dict[str, Array]]
) -> dict[str, Array]:
    """Return the derivatives (P, n) of numbers of the sessions."""
    every = [[numbers(session) for session in sessions] for sessions in near]
    names = every[0][0]
    return {n: np.array([slope([one[n].ravel() for one in own]) for own in every]) for n in names}


def _model_numbers(session: NewtonSession) -> dict[str, Array]:
    """Return the numbers of a model that depend on lengths and masses; the flywheel of a crank that
    is placed in each step has no effect."""
    parents, children = (np.array(ends) for ends in zip(*session.ends, strict=True))
    bodies = [name for name in session.index if name in session.names]
    matter = [(1.0, 1.0) if n == session.led else mass_of(session.scene, n) for n in bodies]
    mass, inertia = (np.array(each) for each in zip(*matter, strict=True))
    solid = np.where(inertia > 0.0, inertia, mass)[:, None, None] * np.eye(3)
    return {
        "joint_X_p": parents,
        "joint_X_c": children,
        "body_mass": mass,
        "body_inv_mass": 1.0 / mass,
        "body_inertia": solid,
        "body_inv_inertia": np.linalg.inv(solid),
    }


def _start(session: NewtonSession, kept: Sequence[str]) -> dict[str, Array]:
    """Return the numbers of the state at the start."""
    frames = [session.frame_of(name) for name in session.index if name in session.names]
    rates = [freedom.rate for limb in session.tree.limbs for freedom in limb.freedoms]
    sizes = {name: len(getattr(session.now, name)) for name in kept}
    every = {
        "body_q": np.array([row(one.origin, one.theta) for one in frames]),
        "body_qd": np.array([twist(one) for one in frames]),
    }
    for name, first in (("joint_q", []), ("joint_qd", rates)):
        every[name] = np.zeros(sizes.get(name, 0))
        every[name][: len(first)] = first[: sizes.get(name, 0)]
    return {name: every[name] for name in kept}


def _led_numbers(session: NewtonSession) -> dict[str, Array]:
    place, speed = session.led_by
    frame = session.led_at(place, speed)
    return {
        "body_q": row(frame.origin, frame.theta),
        "body_qd": np.array(twist(frame)),
        "joint_q": np.array([place - session.from_value]),
        "joint_qd": np.array([speed]),
    }


def _planar(name: str, shape: tuple[int, ...]) -> list[int]:
    """Return the places of the numbers that change in the plane, in a flat array."""
    if name not in PLANAR:
        return list(range(*shape))
    return [shape[1] * body + column for body in range(shape[0]) for column in PLANAR[name]]


GRADIENT = gradient
