"""Simbody: bodies hung on one another by joint coordinates, loops closed by projection."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from models.array import Array
from models.mjcf.tree import Tree, plan
from models.motion import Forces, State
from models.scene import Scene
from models.scene import joints as pairs
from models.scene.joints import Frame
from models.scene.laws import ConstantSpeed
from sim.engine import Drive, Facts, Poses, Settings
from sim.engine.acting import Acting, Pushes
from sim.engine.settings import shipped_engine
from sim.engine.ties import refuse_driver_angle, refuse_massless, refuse_pin_friction
from sim.engine.tree_session import TreeSession
from sim.simbody import model as made
from sim.simbody import settings as own
from sim.simbody.reactions import reactions

AHEAD = 1000
"""Steps that the course of a driver with a changing speed is given ahead at first."""
MARGIN = 40
"""Steps of that course beyond its ends, where a spline is less accurate."""


class SimbodySession(TreeSession):
    """A session with one model. Times in OpenSim count from the start."""

    name = "simbody"
    acts_at = 0.5
    knows_rates = True

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, driven_by: Drive
    ) -> None:
        own.checked(settings)
        if driven_by != "prescribed":
            refuse_driver_angle(scene, self.name)
        refuse_pin_friction(scene, self.name)
        super().__init__(scene, state, settings, dt_s, driven_by)
        self.steady = driven_by == "free" or isinstance(scene.driver.law, ConstantSpeed)
        self.gain = float(settings["servo_gain"]) * pairs.inertia_scale(scene) * scene.pace_rad_s
        self.gain /= scene.driver_arm_m**2
        self.extra = self._extra()
        places = [math.hypot(*place) for place in state.position.values()]
        self.size = max(1.0, scene.longest_m, *places)
        self.known_until = AHEAD
        self._acts = bool(scene.loads or scene.springs or scene.friction)
        self.restarts = driven_by == "servo" and self._acts
        self._open(
            np.array([freedom.ref for freedom in self.freedoms]),
            np.array([freedom.rate for freedom in self.freedoms]),
        )
        now: Drive = "prescribed" if driven_by == "prescribed" else "servo"
        self.present = Acting(self.name, self.bodies, self.frames(0.0), dt_s, now, rates=True)
        """The loads and springs at the positions themselves, where forces are read."""
        self.begin()

    def _extra(self) -> tuple[float, float]:
        """Return the mass at its pivot and the inertia of a prescribed crank that has none."""
        scene, free = self.scene, (0.0, 0.0)
        held = {prism.body for prism in pairs.joints(scene).prisms}
        for name in self.names:
            mass, inertia = pairs.mass_of(scene, name)
            led = self.drive == "prescribed" and scene.driver.is_crank and name == scene.driver.link
            if not led:
                refuse_massless(scene, self.name, name, turns=name not in held)
            elif not (mass and inertia):
                free = 0.0 if mass else 1.0, pairs.inertia_scale(scene) or 1.0
        return free

    def _open(self, q: Array, rate: Array) -> None:
        """Build the model, and set it to these coordinates and rates at the present step."""
        scene, self.acted_at = self.scene, -1
        self.made = made.TreeModel(scene, self.tree, self.extra)
        if self.drive == "prescribed":
            self.made.prescribe(self.driven, self._course(0))
        elif self.drive == "servo":
            self.made.add_motor(self.driven, self.gain, self._course(1))
        if self._acts:
            self.made.add_pushers()
        state, self.column = self.made.opened()
        self._place(state, q, rate)
        self._set_off(state, fixed=self.settings["steps"] == "fixed" and self.drive != "servo")

    def _place(self, state: Any, q: Array, rate: Array) -> None:
        """Give a state these coordinates and rates, at the present step."""
        for numbers, vector in ((q, state.updQ()), (rate, state.updU())):
            for k, number in zip(self.column, numbers.tolist(), strict=True):
                vector.set(k, number)
        state.setTime(self.done * self.dt)

    def _set_off(self, state: Any, *, fixed: bool) -> None:
        """Have an integrator begin at a state, with fixed steps or controlled ones."""
        settings = self.settings
        method = "servo_integrator" if self.drive == "servo" else "integrator"
        manager = made.integrator(
            self.made.model,
            str(settings[method]),
            self.dt if fixed else None,
            float(settings["accuracy"]),
            float(settings["constraint_tolerance"]) * self.size,
        )
        manager.initialize(state)
        self.manager = manager

    def _course(self, level: int) -> Any:
        """Return the driven coordinate, or its rate, over time, as far as it is known."""
        law, ref = self.scene.driver.law, self.freedoms[self.driven].ref
        if isinstance(law, ConstantSpeed):
            speed = self.sense * law.speed_rad_s
            return made.line(0.0, speed) if level else made.line(speed, ref)
        knots = self.dt * np.arange(-MARGIN, self.known_until + MARGIN + 1, dtype=np.float64)
        numbers = law.at(self.start_s + knots)[level]
        start = 0.0 if level else ref - self.sense * numbers[MARGIN]
        return made.spline(knots, start + self.sense * numbers)

    def grown(self) -> Tree:
        return plan(self.scene, self.state, delay_s=self.shift * self.dt, at_slides=True)

    def once(self) -> None:
        state, ends_s = self.manager.getState(), (self.done + 1) * self.dt
        if self.restarts:
            self.manager.initialize(state)
        before = self.coordinates()
        try:
            self.manager.integrate(ends_s)
        except RuntimeError:  # no step is short enough to reach a singular position: pass it
            self.warnings.append("passed a singular position with a step of fixed size")
            state = self.manager.getState()
            self._place(state, *before)
            self._set_off(state, fixed=True)
            self.manager.integrate(ends_s)
            self._set_off(self.manager.getState(), fixed=False)

    def turn(self, place: float | None, speed: float) -> None:
        if not self.steady and self.done >= self.known_until:
            self.known_until *= 4
            q, rate, _ = self.look()
            self._open(q, rate)

    def push(self, pushes: Pushes) -> None:
        self.acted_at = -1
        state = self.manager.getState()
        for name, pushers in self.made.pushers.items():
            for pusher, size in zip(pushers, pushes.on_bodies[name], strict=True):
                pusher.setOverrideActuation(state, size)

    def coordinates(self) -> Array:
        """Return the joint coordinates and their rates, (2, n)."""
        state = self.manager.getState()
        return np.array([state.getQ().to_numpy(), state.getU().to_numpy()])[:, self.column]

    def look(self) -> Array:
        state = self.manager.getState()
        self.made.model.realizeAcceleration(state)
        return np.vstack([self.coordinates(), state.getUDot().to_numpy()[self.column]])

    def numbers(self) -> Array:
        self._act_now()
        return self.look()

    def frames(self, ahead_s: float) -> Mapping[str, Frame]:
        if ahead_s:
            self._act_now()
        return super().frames(ahead_s)

    def _act_now(self) -> None:
        """Have the loads act as at the present positions, not as in a step; accelerations need
        them."""
        if self.acting and self.acted_at != self.done:
            self.present.look_ahead(np.array([self.start_s + self.dt * self.done]))
            self.push(self.present.pushes(0, self.frames(0.0)))
            self.acted_at = self.done

    def joint_forces(self) -> Array:
        self._act_now()
        state = self.manager.getState()
        self.made.model.realizeAcceleration(state)
        rubbed = [(size, 0.0, 0.0) for size in self.present.rubbed.values()]
        return np.array([*self.made.forces(state), *self.present.on_blocks.values(), *rubbed])

    def acted(self, rows: Sequence[object], poses: Poses) -> Forces:
        names = [*self.present.on_blocks], [*self.present.rubbed]
        return reactions(self.scene, self.tree, poses, np.array(rows), self.extra, *names)

    def facts(self) -> Facts:
        matter, centre = {}, {}
        for name in self.names:
            body = self.made.body[name]
            if not (self.extra[1] and name == self.scene.driver.link):
                place = body.getMassCenter()
                matter[name] = body.getMass(), body.getInertia().getMoments().get(2)
                centre[name] = place.get(0), place.get(1)
        gravity = self.made.model.getGravity()
        return self.facts_of(made.VERSION, matter, centre, (gravity.get(0), gravity.get(1)), {})


ENGINE = shipped_engine(
    own, made.VERSION, SimbodySession, of_states=True, placing=own.placing, order=4
)
