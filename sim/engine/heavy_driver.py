"""Sessions of engines of free bodies that divide a step: the driver on the ground is so heavy that
nothing moves it, and unlike a kinematic body changes its speed within a step; any other driver has
a motor."""

import math
from abc import abstractmethod
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np

from models.array import Array
from models.motion import Forces, State
from models.scene import GROUND, Point, Scene
from models.scene import joints as pairs
from models.scene.joints import Frame, less, turned
from models.scene.laws import ConstantSpeed
from sim.engine import Drive, Poses, Settings
from sim.engine.acting import Push, SliderCourse
from sim.engine.measure import BodyPath, PointPath, arms, centred
from sim.engine.momentum_balance import MomentumGain, forces_by_body, joint_pushes
from sim.engine.stepped import BodySession
from sim.engine.ties import hinges, rubbing_pins, slide_of

HEAVY = 1e9
"""Inertia of a led driver over the mechanism's: nothing that is read has as many digits."""
STUCK = 1e-4
"""Rate over the driver's below which a pin with friction may stick, by rounding."""
SHARE = 0.5
"""Share of its error of place that a motor corrects in a step."""


class HeavyDriverSession(BodySession):
    """A session with ``substeps`` in a step, each of which adds the forces to the velocities first.

    A body that turns by ``w h`` in a sub-step is turned along the tangent of its rotation, so that
    ``(w h)^3 / tangent`` is missing.
    """

    tangent: ClassVar[float]

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
        self.substeps = substeps
        self.fixed = {p.body for p in pairs.joints(scene).prisms if p.slider.on == GROUND}
        """Bodies that do not turn."""
        self.rubbed_pins = list(rubbing_pins(scene))
        led = {GROUND, self.led}
        self.rubbing = [one for one in self.rubbed_pins if {one.first, one.second} != led]
        """Pins whose friction acts on a body that is not led."""
        driver = scene.driver
        self.heavy = HEAVY * pairs.inertia_scale(scene) / scene.driver_arm_m**2
        if self.led:
            self.led_centre, self.led_frame = self._led()
        elif driven_by == "free":
            return
        elif driver.slider is not None:
            self.track = SliderCourse(self.bodies, slide_of(scene, driver.slider), dt_s)
        else:
            at = float(driver.law.at(np.array([self.start_s]))[0][0])
            apart = self.where[driver.link].theta - self.where[driver.base].theta
            self.ahead = math.tau * round((apart - at) / math.tau)

    def _led(self) -> tuple[Point, Frame]:
        """Return the origin of the heavy body in its link and its frame; a block without mass is a
        body here too."""
        name, slider = str(self.led), self.scene.sliders.get(self.scene.driver.slider or "")
        frame, centre = self.where.get(name), self.bodies.centre.get(name, (0.0, 0.0))
        if slider is not None and frame is None:
            state, point = self.state, slider.point
            frame = Frame(state.position[point], 0.0, state.velocity[point], 0.0)
        assert frame is not None
        if slider is not None:
            way = turned((self.state.displacement[slider.name], 0.0), slider.direction_rad)
            self.base = less(frame.at(centre), way)
        place = frame.at(centre)
        return centre, Frame(place, frame.theta, frame.velocity_at(place), frame.omega)

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

    def joint_forces(self) -> object:
        """Return the numbers before and after the last step, and all actions in it."""
        acting, now = self.acting, self.numbers()
        rate = {GROUND: 0.0} | dict(zip(self.names, now[:, 5].tolist(), strict=True))
        turning = {one.pin: rate[one.second] - rate[one.first] for one in self.rubbed_pins}
        couples = {
            one.pin: math.nan
            if abs(turning[one.pin]) <= STUCK * self._pace()
            else -math.copysign(one.size, turning[one.pin])
            for one in self.rubbed_pins
        }
        rubbed = acting.rubbed | couples
        return self.before, now, self.pushed.on_bodies, acting.on_blocks, rubbed

    def acted(self, rows: Sequence[Any], poses: Poses) -> Forces:
        """Return the forces by the momentum of the bodies, at the middle of each step.

        Impulses of stiff joints in a sub-step, which engines report, repeat the rounding of places.
        """
        before, after = (np.array([row[k] for row in rows]) for k in (0, 1))
        blocks = {name: np.array([row[3][name] for row in rows]) for name in rows[0][3]}
        rubbed = {n: np.array([row[4].get(n, math.nan) for row in rows]) for n in rows[-1][4]}
        given = {name: np.array([row[2][name] for row in rows]) for name in self.names}
        for one in self.rubbed_pins:
            for name, sign in ((one.first, -1.0), (one.second, 1.0)):
                if name in given:
                    given[name][:, 2] += sign * rubbed[one.pin]
        gains = {
            name: self._gain(name, before[:, k], after[:, k], given[name])
            for k, name in enumerate(self.names)
        }
        tied = [*hinges(self.scene, GROUND)]
        found = joint_pushes(self.scene, tied, gains, driven=self.drive != "free")
        times = poses.time_s + self.dt * (self.shift - 0.5)
        forces = forces_by_body(self.scene, found, blocks, rubbed, times)
        unknown = np.isnan(before).any(axis=(1, 2))  # no step led there

        def without(series: Array) -> Array:
            return np.where(unknown.reshape(-1, *[1] * (series.ndim - 1)), np.nan, series)

        return forces.each_series(without)

    def _gain(self, name: str, before: Array, after: Array, given: Array) -> MomentumGain:
        """Return the action of joints and drive on a body in each step."""
        mass, inertia = pairs.mass_of(self.scene, name)
        own, centre = self.bodies.centre[name], pairs.centre_of(self.scene, name)
        lag = self.shift * self.dt
        ends = [centred(row[:, :3], row[:, 3:], None, own, lag) for row in (before, after)]
        start, end = (BodyPath(pose) for pose in ends)
        gained = PointPath(end, centre).velocity - PointPath(start, centre).velocity
        place = 0.5 * (PointPath(start, centre).position + PointPath(end, centre).position)
        force = mass * (gained / self.dt - np.array(self.scene.gravity_m_s2)) - given[:, :2]
        theta = 0.5 * (before[:, 2] + after[:, 2])
        arm = arms(theta, less(own, centre))  # given moments are about the engine's origin
        about = given[:, 2] + arm[:, 0] * given[:, 1] - arm[:, 1] * given[:, 0]
        moment = inertia * (after[:, 5] - before[:, 5]) / self.dt - about
        return MomentumGain(centre, place, theta, force, moment)
