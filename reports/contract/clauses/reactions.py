"""Reported forces of an engine: they change nothing else, balance every body in its motion, and
belong to stated instants."""

import math
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from analytic.forces import kinetostatics
from analytic.kinematics import solve
from models.array import Array
from models.motion import Forces, Motion
from models.scene import GROUND, Scene
from models.scene.characteristics import Sine
from models.scene.joints import block_name, centre_of, joined_at, local_point, mass_of
from models.scene.loads import Load
from reports.contract.subject import NotTriedError, Subject, clause, numbers
from sim.engine import ForceSession, Unreported
from sim.run.check import rounding_of

STEPS = 800
"""Number of steps in one turn."""
START = STEPS // 8
"""Samples in which an engine may settle."""
OFF = 0.05
"""Largest residual force on a body in equilibrium, over the largest force, and of a moment over
that force times the longest link: far above the effect of steps, below any wrong sign."""
LATE = 0.25
"""Largest distance of forces from their stated instant, in steps."""
STEADY = 0.01
"""Change over a turn, over its size or another's change, below which the instant is unknown."""
CLOSED = 1e-9
"""Largest sum of all forces of a pin, over the largest, in double precision."""
PULL = 0.5
"""Gravity for the tests of forces, over the acceleration of the longest link's end."""


@clause(
    "EC81",
    "with forces the motion is the same, to the last bit",
    "Errors of places come from runs without forces, and have to hold for runs with them.",
    "Let record_forces step as record does, and read the forces beside it.",
)
def _same_motion(subject: Subject) -> Iterator[str]:
    subject.reports_forces()
    for profile in subject.engine.profiles:
        plain = subject.opened(profile).record(100, 4)
        beside = subject.force_session(profile).record_forces(100, 4)
        if not np.array_equal(numbers(plain.poses), numbers(beside.poses), equal_nan=True):
            yield f"profile {profile}: record_forces logs another motion than record"
    if subject.engine.applies_loads:
        with suppress(NotTriedError):  # an engine need not have free motion
            yield from _same_when_free(subject)


def _same_when_free(subject: Subject) -> Iterator[str]:
    """Yield a fault where logging, with forces or without, changes a free motion under a load."""
    scene = subject.scene
    link = list(scene.links)[-1]
    wave = Sine(PULL * scene.longest_m * scene.pace_rad_s**2, 0.1 * scene.driver.law.period_s)
    pushed = subject.in_scene(replace(scene, loads={"load": Load("load", link, None, wave)}))
    each, some, acting = (pushed.opened(drive="free") for _ in range(3))
    rows = numbers(each.record(60, 1).poses)[::4]
    forces = cast(ForceSession, acting).record_forces(60, 4)
    for words, log in (("record", some.record(60, 4)), ("record_forces", forces)):
        if not np.array_equal(numbers(log.poses), rows, equal_nan=True):
            yield f"free, with a load: {words} of every 4th step logs another motion"


@clause(
    "EC82",
    "every pin and slider has its forces, as declared, and those of a pin add up to zero",
    "A missing or doubled force looks like 0, or like that of another joint.",
    "Give Forces.pins by the names of joined_at(scene), each as the force of the pin on the "
    "body, in the ground's frame; NaN for those in Engine.unreported, and at the start if "
    "forces_of is steps.",
)
def _declared(subject: Subject) -> Iterator[str]:
    scene = subject.scene
    forces = subject.acting(STEPS)
    wanted = {point: list(names) for point, names in joined_at(scene).items()}
    if (found := {point: list(by) for point, by in forces.pins.items()}) != wanted:
        yield f"pins are {found}, and the scene has {wanted}"
        return
    if list(forces.sliders) != list(scene.sliders):
        yield f"sliders are {list(forces.sliders)}, and the scene has {list(scene.sliders)}"
        return
    given = {
        name: np.asarray(np.isfinite(each).reshape(len(each), -1).all(axis=1))
        for name, each in named(forces)
    }
    if not any(there.any() for there in given.values()):
        yield f"forces_of is {subject.engine.forces_of}, and all forces are NaN"
    first = 0 if subject.engine.forces_of == "states" else 1
    left_out = subject.engine.unreported(scene, "prescribed")
    if strange := {*left_out.pins} - {*wanted} | {*left_out.sliders} - {*scene.sliders}:
        yield f"unreported has {', '.join(sorted(strange))}, and the scene has none"
    unreported = set(_names(forces, left_out))
    for name, there in given.items():
        if name in unreported:
            if there.any():
                yield f"the {name} has numbers, but is in unreported"
        elif not there[first:].all() and not (forces.undetermined and not there.any()):
            missing = first + int(np.argmin(there[first:]))
            yield f"the {name} is not finite at sample {missing}, and not in unreported"
        elif there[:first].any():
            yield f"forces_of is steps, and the {name} is reported before the first of them"
    closed = max(CLOSED, rounding_of(subject.engine.precision))
    for point, by_body in forces.pins.items():
        total = np.abs(sum(by_body.values(), np.zeros(2))).max(axis=1)[first:]
        size = largest(forces)
        if np.isfinite(total).all() and not total.max() <= closed * size:
            yield f"the forces of pin {point} add up to {total.max():.2g} N, of {size:.2g} N"


def named(forces: Forces) -> Iterator[tuple[str, Array]]:
    """Yield all series with their names in words."""
    for point, by_body in forces.pins.items():
        for body, force in by_body.items():
            yield f"force of pin {point} on {body}", force
    for name, slider in forces.sliders.items():
        yield f"normal force of slider {name}", slider.normal
        yield f"moment of slider {name}", slider.moment
    yield "driving torque", forces.torque


def _names(forces: Forces, left_out: Unreported) -> Iterator[str]:
    """Yield the names of the series that an engine does not report, as `named` has them."""
    for point in left_out.pins & {*forces.pins}:
        yield from (f"force of pin {point} on {body}" for body in forces.pins[point])
    for name in left_out.sliders:
        yield from (f"normal force of slider {name}", f"moment of slider {name}")
    if left_out.torque:
        yield "driving torque"


def largest(forces: Forces) -> float:
    """Return the largest of all forces [N]."""
    each = [force for by_body in forces.pins.values() for force in by_body.values()]
    each += [slider.normal for slider in forces.sliders.values()]
    return max(float(np.nan_to_num(np.abs(force)).max(initial=0.0)) for force in each)


@clause(
    "EC83",
    "forces, inertia and gravity hold each body in equilibrium",
    "A force with a wrong sign, frame or body is as large as a correct one.",
    "Turn forces into the ground's frame, and give that of the pin ON the body. For a slider "
    "give the normal along the line turned by +90 deg and the moment about its point, both of "
    "the guide on the sliding body. The torque is that of the drive on the driver, without the "
    "share of a flywheel.",
)
def _equilibrium(subject: Subject) -> Iterator[str]:
    scene = pulled(subject.scene)
    forces = subject.in_scene(scene).acting(STEPS).stretch(slice(START, None))
    size = largest(forces)
    if not size > 0.0:
        yield f"no force is reported, or all are 0, in {scene.name} with a pull on its masses"
        return
    motion = solve(scene, forces.time_s, bound=False)
    for body in (*scene.links, *(block_name(s) for s in scene.sliders.values() if not s.link)):
        held = _Held(scene, motion, body)
        force, moment = held.left_over(forces)
        off = float(np.abs(force).max()) / size
        if off > OFF:
            yield f"{body}: {off:.2g} of the largest force ({size:.3g} N) is unbalanced"
        off = float(np.abs(moment).max()) / (size * scene.longest_m)
        if off > OFF:
            yield f"{body}: a moment of {off:.2g} of the largest force times a length is unbalanced"


def pulled(scene: Scene) -> Scene:
    """Return the scene in a gravity that shows beside its inertia forces."""
    pull = PULL * scene.longest_m * scene.pace_rad_s**2
    return replace(scene, gravity_m_s2=(0.6 * pull, -0.8 * pull))


@dataclass(frozen=True)
class _Held:
    """A body in the reference's motion, vectors of the plane as complex numbers."""

    scene: Scene
    motion: Motion
    body: str

    @property
    def _slider(self) -> str:
        """The slider whose block it is; empty for a link."""
        sliders = self.scene.sliders.values()
        return next((s.name for s in sliders if block_name(s) == self.body), "")

    def _turning(self, name: str) -> tuple[Array, Array, Array]:
        """Return angle, rate and its rate of a link, of the ground, or of the guide of a block."""
        if name == GROUND:
            zero = np.zeros(len(self.motion.time_s))
            return zero, zero, zero
        link = self.motion.links[name]
        return link.theta, link.omega, link.alpha

    def left_over(self, forces: Forces) -> tuple[Array, Array]:
        """Return the residual force, and moment about the centre of mass; 0 where unknown."""
        slider = self.scene.sliders[self._slider] if self._slider else None
        theta, omega, alpha = self._turning(slider.on if slider else self.body)
        point = slider.point if slider else next(iter(self.scene.links[self.body].points))
        track, turn = self.motion.points[point], np.exp(1j * theta)
        arm = 0.0 * turn
        if slider is None:
            local = local_point(self.scene, self.body, point)
            arm = turn * complex(*np.subtract(centre_of(self.scene, self.body), local))
        centre = track.position @ _AXES + arm
        mass, inertia = _matter(self.scene, self.body)
        push = track.acceleration @ _AXES + (1j * alpha - omega**2) * arm
        force = mass * (complex(*self.scene.gravity_m_s2) - push)
        moment = -inertia * alpha
        for place, each, couple in self._from_joints(forces):
            force = force + each
            moment = moment + couple + ((place - centre).conjugate() * each).imag
        if self.body == self.scene.driver.link:
            moment = moment + forces.torque
        told = np.isfinite(force) & np.isfinite(moment)
        return np.where(told, force, 0.0), np.where(told, moment, 0.0)

    def _from_joints(self, forces: Forces) -> Iterator[tuple[Array, Array, Array]]:
        """Yield the place of each joint on it, its force and its couple."""
        none = np.zeros(len(self.motion.time_s))
        for point, by_body in forces.pins.items():
            if self.body in by_body:
                yield self.motion.points[point].position @ _AXES, by_body[self.body] @ _AXES, none
        for name, one in forces.sliders.items():
            slider = self.scene.sliders[name]
            sign = 1.0 * (self.body == (slider.link or block_name(slider)))
            sign -= 1.0 * (self.body == slider.on)
            if sign:
                line = self._turning(slider.on)[0] + slider.direction_rad + 0.5 * math.pi
                place = self.motion.points[slider.point].position @ _AXES
                yield place, sign * one.normal * np.exp(1j * line), sign * one.moment


_AXES = np.array([1.0, 1j])


def _matter(scene: Scene, body: str) -> tuple[float, float]:
    massless = [block_name(s) for s in scene.sliders.values() if s.mass_kg == 0.0]
    return (0.0, 0.0) if body in massless else mass_of(scene, body)


@clause(
    "EC84",
    "forces belong to the instants stated with them",
    "Half a step is most of the error of a force.",
    "Set Forces.time_s to the instants at which they act: an impulse over a step acts in its "
    "middle or, if velocities are stepped with new places, at its end.",
)
def _instants(subject: Subject) -> Iterator[str]:
    scene = pulled(subject.scene)
    forces = subject.in_scene(scene).acting(STEPS).stretch(slice(START, None))
    true = kinetostatics.forces(scene, forces.time_s, bound=False)
    late = late_by(dict(named(forces)), dict(named(true)), subject.dt_s(STEPS))
    if late and abs(late[worst := max(late, key=lambda name: abs(late[name]))]) > LATE:
        yield f"the {worst} acts {late[worst]:+.2f} steps after its stated time"


def late_by(own: Mapping[str, Array], true: Mapping[str, Array], dt_s: float) -> dict[str, float]:
    """Return the delay of forces in steps, for those that change enough to show it."""
    rates = {name: np.gradient(true[name], dt_s, axis=0) for name in own if "force" in name}
    most = max(float(np.sqrt(np.nanmean(rate**2))) for rate in rates.values())
    size = max(float(np.nanmax(np.abs(true[name]))) for name in rates)
    late: dict[str, float] = {}
    if not most * dt_s * STEPS > STEADY * size:
        return late
    for name, rate in rates.items():
        told = np.isfinite(own[name]) & np.isfinite(rate)
        square = float((rate[told] ** 2).sum())
        if square > (STEADY * most) ** 2 * told.sum():
            shift = float(((own[name] - true[name])[told] * rate[told]).sum()) / square
            late[name] = -shift / dt_s
    return late
