"""Sessions of engines of free bodies that divide a step: the driver on the ground is so heavy that
nothing moves it, and unlike a kinematic body changes its speed within a step; other drivers have a
motor."""

import math
from abc import abstractmethod
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from models.array import Array
from models.motion import State
from models.scene import GROUND, Scene
from models.scene import joints as pairs
from models.scene.joints import FIXED, Frame, less, turned
from models.scene.laws import ConstantSpeed
from sim.engine import Drive, Poses, Settings
from sim.engine.acting import EngineBodies, Push, SliderCourse, centres
from sim.engine.measure import BodyPath, PointPath, arms, centred, moment
from sim.engine.momentum_balance import MomentumGain
from sim.engine.stepped import SteppedSession, StepSeries
from sim.engine.ties import RubbingJoint, rubbing_joints, slide_of

HEAVY = 1e9
"""Inertia of a led driver over the mechanism's: nothing that is read has as many digits."""
TURN_BETWEEN = 0.25
"""Turn between two readings of an angle, by the rates at the first [rad]: bodies may be faster."""
SHARE = 0.5
"""Share of its error of place that a motor corrects in a step."""


class HeavyDriverSession(SteppedSession):
    """A session with ``substeps`` in a step, each of which adds the forces to the velocities first.

    Each body has its origin at its centre of mass, but the heavy one: it is led along the driver's
    law, with its origin at its pivot. A body that turns by ``w h`` in a sub-step is turned along
    the tangent of its rotation, so that ``(w h)^3 / tangent`` is missing.
    """

    tangent: ClassVar[float]
    stuck = 1e-4

    def __init__(
        self,
        scene: Scene,
        state: State,
        settings: Settings,
        dt_s: float,
        driven_by: Drive,
        substeps: int,
    ) -> None:
        super().__init__(scene, state, settings, dt_s, driven_by)
        driver = scene.driver
        self.led = driver.link if driven_by == "prescribed" and not driver.is_inner else None
        self.where = pairs.frames(scene, state, self.shift * dt_s)
        centre = centres(scene)
        if self.led and driver.slider is None:
            centre[self.led] = pairs.local_point(scene, self.led, scene.driver_pivot)
        self.bodies = EngineBodies(scene, state, centre=centre)
        self._angles = np.array([self.where[name].theta for name in self.names])
        self._slowest = max(self._pace(), 1e-9)  # of the bodies, between two looks at their angles
        self.substeps = substeps
        self.fixed = {p.body for p in pairs.joints(scene).prisms if p.slider.on == GROUND}
        """Bodies that do not turn."""
        self.rubbing = list(rubbing_joints(scene, sliders=False))
        led = {GROUND, self.led}
        self.braked = [one for one in self.rubbing if {one.first, one.second} != led]
        """Pins whose friction acts on a body that is not led."""
        self.heavy = HEAVY * pairs.inertia_scale(scene) / scene.driver_arm_m**2
        if self.led:
            self.led_frame = self._led(self.led)
        elif driven_by == "free":
            return
        elif driver.slider is not None:
            self.track = SliderCourse(self.bodies, slide_of(scene, driver.slider), dt_s)
        else:
            at = float(driver.law.at(np.array([self.start_s]))[0][0])
            apart = self.where[driver.link].theta - self.where[driver.base].theta
            self.ahead = math.tau * round((apart - at) / math.tau)

    def _led(self, name: str) -> Frame:
        """Return the frame of the heavy body; a block without mass is a body here too."""
        slider, state = self.scene.sliders.get(self.scene.driver.slider or ""), self.state
        if slider is not None:
            if name not in self.where:
                speed = state.velocity[slider.point]
                self.where[name] = Frame(state.position[slider.point], 0.0, speed, 0.0)
                self.bodies.centre[name] = (0.0, 0.0)
            way = turned((state.displacement[slider.name], 0.0), slider.direction_rad)
            self.base = less(self.frame_of(name).origin, way)
        return self.frame_of(name)

    def frame_of(self, name: str) -> Frame:
        """Return the frame of a body in the engine at the start."""
        own = self.where[name]
        place = own.at(self.bodies.centre[name])
        return Frame(place, own.theta, own.velocity_at(place), own.omega)

    @abstractmethod
    def lead(self, frame: Frame, push: Push) -> None:
        """Set the heavy body, and its force and moment in the next step."""

    @abstractmethod
    def run_motor(self, speed: float) -> None:
        """Set the speed of the driver's motor."""

    def _stands(self) -> float:
        """Return the present coordinate of a driver with a motor."""
        driver, frames = self.scene.driver, self.frames(0.0)
        if driver.slider is None:
            return frames[driver.link].theta - frames[driver.base].theta - self.ahead
        return self.track.value(frames)

    def turn(self, place: float | None, speed: float) -> None:
        if self.led is None:
            if place is not None and self.drive == "prescribed":
                speed += SHARE * (place - self._stands()) / self.dt
            self.run_motor(speed)
            return
        before, gain, law = speed, 0.0, self.scene.driver.law
        if not isinstance(law, ConstantSpeed):
            now = self.start_s + self.dt * (self.done + self.shift)
            before, after = law.at(np.array([now, now + self.dt]))[1].tolist()
            gain = after - before
        # A gain in equal parts, each before the sub-step's motion.
        mean, sub = before + 0.5 * gain * (1.0 + 1.0 / self.substeps), self.dt / self.substeps
        slider, push = self.scene.driver.slider, self.heavy * gain / self.dt
        push = 0.0 if place is None else push
        (x, y), theta = self.led_frame.origin, self.led_frame.theta
        if slider is None:
            mean -= mean**3 * sub**2 / self.tangent
            if place is not None:
                theta = place + self.dt * (speed - mean)
            self.lead(Frame((x, y), theta, (0.0, 0.0), before), (0.0, 0.0, push))
            return
        u, v = turned((1.0, 0.0), self.scene.sliders[slider].direction_rad)
        if place is not None:
            along = place + self.dt * (speed - mean)
            x, y = self.base[0] + along * u, self.base[1] + along * v
        frame = Frame((x, y), theta, (before * u, before * v), 0.0)
        self.lead(frame, (push * u, push * v, 0.0))

    @abstractmethod
    def look(self) -> Array:
        """Return x, y, angle (up to whole turns), and their rates, of all bodies, (B, 6)."""

    def numbers(self) -> Array:
        rows = self.look()
        behind = np.round((self._angles - rows[:, 2]) / math.tau)
        rows[:, 2] += math.tau * behind
        self._angles = rows[:, 2]
        fastest = float(np.fmax.reduce(np.abs(rows[:, 5]), initial=self._slowest))
        self.next_look = self.done + max(1, int(TURN_BETWEEN / (fastest * self.dt)))
        return rows

    def frames(self, ahead_s: float) -> Mapping[str, Frame]:
        now = self.numbers()
        then = (now[:, :3] + ahead_s * now[:, 3:]).tolist()
        found = {
            name: Frame((x, y), theta, (0.0, 0.0), 0.0)
            for name, (x, y, theta) in zip(self.names, then, strict=True)
        }
        return {GROUND: FIXED} | found

    def poses(self, rows: Array, time_s: Array) -> Poses:
        lag, centre = self.shift * self.dt, self.bodies.centre
        found = {
            name: centred(rows[:, k, :3], rows[:, k, 3:], None, centre[name], lag)
            for k, name in enumerate(self.names)
        }
        return Poses(time_s, found, lag)

    def rate_in(self, rub: RubbingJoint, numbers: Array) -> float:
        row = {name: k for k, name in enumerate(self.names)}
        first, second = (numbers[row[n], 5] if n in row else 0.0 for n in (rub.first, rub.second))
        return float(second - first)

    def gains(self, steps: StepSeries) -> Mapping[str, MomentumGain]:
        """Return the gains at the middle of each step. Impulses of stiff joints in a sub-step,
        which engines report, repeat the rounding of places."""
        return {
            name: self._gain(name, steps.before[:, k], steps.after[:, k], steps.given[name])
            for k, name in enumerate(self.names)
        }

    def _gain(self, name: str, before: Array, after: Array, given: Array) -> MomentumGain:
        """Return the action of joints and drive on a body in each step."""
        mass, inertia = pairs.mass_of(self.scene, name)
        own, centre = self.bodies.centre[name], pairs.centre_of(self.scene, name)
        lag = self.shift * self.dt
        ends = [centred(row[:, :3], row[:, 3:], None, own, lag) for row in (before, after)]
        start, end = (PointPath(BodyPath(pose), centre) for pose in ends)
        pull = (end.velocity - start.velocity) / self.dt - np.array(self.scene.gravity_m_s2)
        place, force = 0.5 * (start.position + end.position), mass * pull - given[:, :2]
        theta = 0.5 * (before[:, 2] + after[:, 2])
        arm = arms(theta, less(own, centre))  # given moments are about the engine's origin
        about = given[:, 2] + moment(arm, given[:, :2])
        couple = inertia * (after[:, 5] - before[:, 5]) / self.dt - about
        return MomentumGain(centre, place, theta, force, couple)
