"""Engines with one fault each: a sound one whose sessions are meddled with."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, ClassVar, NamedTuple, cast

import numpy as np

from models.array import Array
from models.motion import Forces, State
from models.scene import Scene
from models.scene.characteristics import Constant, Sine
from models.scene.loads import ConstantFriction, LineSpring, Load, Spring
from sim.engine import (
    BodyPose,
    Drive,
    Engine,
    Facts,
    ForceSession,
    Log,
    Placing,
    Poses,
    Session,
    Setting,
    Settings,
    Unreported,
)
from sim.engine.settings import SettingError
from sim.registry import engine
from tests.worlds.fake.engine import FakeEngine


class Asked(NamedTuple):
    scene: Scene
    state: State
    settings: Settings
    dt_s: float
    drive: Drive


Opens = Callable[[Asked], Asked]
Fault = Callable[[Engine], Any]


@dataclass
class Meddled:
    """A session that is handed on but for what a fault says, each with the session first."""

    session: Session
    asked: Asked
    facts_: Callable[[Asked, Facts], Facts] = lambda asked, facts: facts
    record_: Callable[[Meddled, Log, int], Log] = lambda self, log, every: log
    read_: Callable[[Meddled, Poses], Poses] = lambda self, poses: poses
    step_: Callable[[Meddled, int], int] = lambda self, steps: steps
    forces_: Callable[[Meddled, Log], Log] = lambda self, log: log
    notes: dict[str, Any] = field(default_factory=dict)
    last: ClassVar[Meddled | None] = None

    def facts(self) -> Facts:
        return self.facts_(self.asked, self.session.facts())

    def step(self, steps: int) -> None:
        self.session.step(self.step_(self, steps))

    def record(self, steps: int, every: int) -> Log:
        return self.record_(self, self.session.record(steps, every), every)

    def record_forces(self, steps: int, every: int) -> Log:
        return self.forces_(self, cast(ForceSession, self.session).record_forces(steps, every))

    def read(self) -> Poses:
        return self.read_(self, self.session.read())


def meddled(sound: Engine, opens: Opens = lambda asked: asked, **faults: Any) -> Engine:
    """An engine that opens something else than was requested, or whose sessions have faults."""

    def opened(*given: Any) -> Meddled:
        asked = Asked(*given)
        return Meddled(sound.open(*opens(asked)), asked, **faults)

    return replace(sound, open=opened)


def meddling(opens: Opens = lambda asked: asked, **faults: Any) -> Fault:
    return lambda sound: meddled(sound, opens, **faults)


def of_log(change: Callable[[Poses], Poses]) -> Callable[..., Log]:
    return lambda _, log, every: replace(log, poses=change(log.poses))


def of_bodies(change: Callable[[BodyPose], BodyPose]) -> Callable[..., Log]:
    return of_log(lambda poses: poses.changed(change))


def turning(change: Callable[[BodyPose], dict[str, Array]]) -> Fault:
    return meddling(record_=of_bodies(lambda body: replace(body, **change(body))))


def _own(sound: Engine) -> Settings:
    return {name: each.value for name, each in sound.profiles["tuned"].settings.items()}


def _without_reason(sound: Engine) -> Engine:
    tuned = sound.profiles["tuned"]
    settings = {name: Setting(each.value, "") for name, each in tuned.settings.items()}
    return replace(sound, profiles={**sound.profiles, "tuned": replace(tuned, settings=settings)})


def _careless(sound: Engine) -> Engine:
    """It takes every setting, and holds its own in place of a wrong one."""
    own = _own(sound)

    def healed(asked: Asked) -> Asked:
        wrong = {n for n, v in asked.settings.items() if v != v or v == "no-such-choice"}
        return asked._replace(settings={**asked.settings, **{name: own[name] for name in wrong}})

    return replace(meddled(sound, healed), check=lambda settings: None)


def _boundless(sound: Engine) -> Engine:
    """It refuses what is no number, and takes every number, 1 in place of it."""

    def checked(settings: Settings) -> None:
        if any(value != value or value == "no-such-choice" for value in settings.values()):
            raise SettingError("no number")

    def healed(asked: Asked) -> Asked:
        checked(asked.settings)
        own = {"iterations": 1, "error_bias": 1.0, "damping": 1.0}
        return asked._replace(settings={**asked.settings, **own})

    return replace(meddled(sound, healed), check=checked)


def _told_settings(asked: Asked, facts: Facts) -> Facts:
    """They are said to be as requested."""
    return replace(facts, settings={**facts.settings, **asked.settings})


def _deaf(sound: Engine) -> Engine:
    """It runs as it always does, and says that it has the requested settings."""

    def deaf(asked: Asked) -> Asked:
        sound.check(asked.settings)
        return asked._replace(settings=_own(sound))

    return meddled(sound, deaf, facts_=_told_settings)


def of_facts(change: Callable[[Facts], dict[str, Any]]) -> Fault:
    return meddling(facts_=lambda _, facts: replace(facts, **change(facts)))


def _restarts(self: Meddled, log: Log, every: int) -> Log:
    again = self.notes.setdefault("recorded", 0)
    self.notes["recorded"] += 1
    times = log.poses.time_s
    return replace(log, poses=replace(log.poses, time_s=times - times[0])) if again else log


def _lent(self: Meddled, poses: Poses) -> Poses:
    self.notes["lent"] = poses
    return poses


def _overwritten(self: Meddled, steps: int) -> int:
    for body in self.notes["lent"].bodies.values() if "lent" in self.notes else ():
        body.theta[:] += 1.0
    return steps


def _shared(self: Meddled, log: Log, every: int) -> Log:
    """What another session did last changes what this one logs."""
    other = Meddled.last is not self and self.notes.get("recorded", False)
    self.notes["recorded"], Meddled.last = True, self
    turned = log.poses.changed(lambda body: replace(body, omega=1.01 * body.omega))
    return replace(log, poses=turned) if other else log


NOISE = np.random.default_rng(1)


def _prints(self: Meddled, steps: int) -> int:
    os.write(1, b"stepping\n")
    return steps


def _litters(self: Meddled, poses: Poses) -> Poses:
    Path("ENGINE_LOG.TXT").write_text("read")
    return poses


def _late(series: Array) -> Array:
    return np.concatenate([series[:1], series[:-1]])


def _turned(poses: Poses, name: str, **changes: Array) -> Poses:
    return replace(poses, bodies={**poses.bodies, name: replace(poses.bodies[name], **changes)})


def _slow_one(poses: Poses) -> Poses:
    """The speed of the body that turns least, times a number."""
    slow = min(poses.bodies, key=lambda name: float(np.abs(poses.bodies[name].omega).max()))
    return _turned(poses, slow, omega=1.08 * poses.bodies[slow].omega)


def _a_little_fast(asked: Asked) -> Asked:
    scene, law = asked.scene, cast(Any, asked.scene.driver.law)
    if hasattr(law, "speed_rad_s"):
        law = replace(law, speed_rad_s=law.speed_rad_s * (1.0 + 1e-9))
    return asked._replace(scene=replace(scene, driver=replace(scene.driver, law=law)))


def _pulled(share_y: float) -> Fault:
    """Free, it has a share of gravity in y alone, and says that it has all."""

    def pulled(asked: Asked) -> Asked:
        other = replace(asked.scene, gravity_m_s2=(0.0, share_y * asked.scene.gravity_m_s2[1]))
        return asked._replace(scene=other) if asked.drive == "free" else asked

    return meddling(
        pulled, facts_=lambda asked, facts: replace(facts, gravity_m_s2=asked.scene.gravity_m_s2)
    )


def _damped(damping: float) -> Opens:
    """Free, it loses all of its speed but this share in a second."""

    def damped(asked: Asked) -> Asked:
        lossy = {**asked.settings, "damping": damping}
        return asked._replace(settings=lossy) if asked.drive == "free" else asked

    return damped


def _in_seconds(sound: Engine) -> Engine:
    """A loss in a second, and not said."""

    def lossy(asked: Asked) -> Asked:
        return asked._replace(settings={**asked.settings, "error_bias": 0.5})

    wrong = meddled(sound, lossy, facts_=_told_settings)
    return replace(wrong, in_seconds=lambda settings: ())


def _at_home(self: Meddled, log: Log, every: int) -> Log:
    """It is off by a milliradian wherever the ground lies far from the origin."""
    scene = self.asked.scene
    if max(abs(x) for x, _ in scene.ground.values()) < 2.0:
        return log
    name = next(n for n in reversed(list(scene.links)) if n != scene.driver.link)
    theta = log.poses.bodies[name].theta
    off = np.minimum(np.arange(float(theta.size)), 50.0) * 2e-4
    return replace(log, poses=_turned(log.poses, name, theta=theta + off))


def _blunt(asked: Asked) -> Asked:
    if asked.drive == "servo":
        raise KeyError("motor")
    return asked


class _Integrated(FakeEngine):
    """It has its places from the reference, and says otherwise."""

    def placing(self, settings: Settings) -> Placing:
        return "integrated"


def of_exudyn(opens: Opens = lambda asked: asked, **faults: Any) -> Fault:
    return lambda _: meddled(engine("exudyn"), opens, **faults)


def of_forces(change: Callable[[Forces], Forces]) -> Fault:
    return of_exudyn(forces_=lambda _, log: replace(log, forces=change(log.forces)))


def _last_pin(change: Callable[[Array, Array], tuple[Array, Array]]) -> Fault:
    """The forces of one pin on its first body and its second changed."""

    def changed(forces: Forces) -> Forces:
        point, by_body = list(forces.pins.items())[-1]
        wrong = dict(zip(by_body, change(*by_body.values()), strict=True))
        return replace(forces, pins={**forces.pins, point: wrong})

    return of_forces(changed)


def _gap(forces: Forces) -> Forces:
    torque = forces.torque.copy()
    torque[7] = np.nan
    return replace(forces, torque=torque)


def _half_a_step_late(forces: Forces) -> Forces:
    half_s = 0.5 * (forces.time_s[1] - forces.time_s[0])
    return replace(forces, time_s=forces.time_s - half_s)


def _shaken(_: Meddled, log: Log) -> Log:
    """To read forces it steps once more, from which it does not come back."""
    return replace(log, poses=log.poses.changed(lambda b: replace(b, omega=_late(b.omega))))


def _with_scene(change: Callable[[Scene], Scene]) -> Opens:
    """It has another scene, without saying so."""
    return lambda asked: asked._replace(scene=change(asked.scene))


def _without_loads(scene: Scene) -> Scene:
    return replace(scene, loads={})


def of_loads(change: Callable[[Load], Load]) -> Fault:
    def changed(scene: Scene) -> Scene:
        return replace(scene, loads={name: change(load) for name, load in scene.loads.items()})

    return of_exudyn(_with_scene(changed))


def _late_load(load: Load) -> Load:
    wave = load.characteristic
    if not isinstance(wave, Sine):
        return load
    late = replace(wave, phase_rad=wave.phase_rad - 2 * 2 * np.pi / 800)
    return replace(load, characteristic=late)


def _deaf_load(load: Load) -> Load:
    """A load over a speed as it is at a speed of 1."""
    if load.over not in ("omega", "speed"):
        return load
    at_one = Constant(load.magnitude(np.ones(1))[0])
    return replace(load, over="time", slider=None, characteristic=at_one)


def _rubbing_less(scene: Scene) -> Scene:
    """Friction that is a tenth too small."""
    rubbing = {n: one for n, one in scene.friction.items() if isinstance(one, ConstantFriction)}
    friction = {name: replace(one, size=0.9 * one.size) for name, one in rubbing.items()}
    return replace(scene, friction=friction)


def of_springs(change: Callable[[Spring], Spring | None]) -> Fault:
    """An engine that has other springs, or none, and says that it has those of the scene."""

    def changed(scene: Scene) -> Scene:
        own = {name: change(spring) for name, spring in scene.springs.items()}
        return replace(scene, springs={name: one for name, one in own.items() if one is not None})

    def told(asked: Asked, facts: Facts) -> Facts:
        springs = asked.scene.springs.items()
        return replace(facts, springs={n: (s.rate, s.damping, s.free) for n, s in springs})

    return of_exudyn(_with_scene(changed), facts_=told)


def _elsewhere(spring: Spring) -> Spring:
    """A spring between points at the first point of the ground, and not at its own."""
    if not isinstance(spring, LineSpring):
        return spring
    return replace(spring, points=("A", spring.points[1]))


def _left_out_when_free(name: str, **left_out: Any) -> Fault:
    """Its forces are right, as if from the change of momentum, and it moves without their cause."""

    def freed(asked: Asked) -> Asked:
        scene = replace(asked.scene, **left_out)
        return asked._replace(scene=scene) if asked.drive == "free" else asked

    return lambda _: meddled(engine(name), freed)


def _weightless_loads(_: Engine) -> Engine:
    """It reports no forces, says that it takes loads, and leaves them out."""
    plain = meddled(engine("pymunk"), _with_scene(_without_loads))
    return replace(plain, applies_loads=True, forces_of="nothing", applies_constant_friction=False)


def rounded_to_single(sound: Engine) -> Engine:
    """An engine that has the numbers of a sound one in 24 bits."""

    def rounded(body: BodyPose) -> BodyPose:
        return BodyPose(**{n: np.float64(np.float32(each)) for n, each in vars(body).items()})

    def few_digits(_: Asked, facts: Facts) -> Facts:
        masses = {name: float(np.float32(mass)) for name, mass in facts.mass_kg.items()}
        return replace(facts, mass_kg=masses, start=facts.start.changed(rounded))

    return meddled(
        sound,
        facts_=few_digits,
        record_=of_bodies(rounded),
        read_=lambda _, poses: poses.changed(rounded),
    )


def forces_of_some(left_out: Unreported) -> Engine:
    """An engine that reports all forces but some, and says so."""

    def blanked(forces: Forces) -> Forces:
        pins = {
            point: {b: each * np.nan if point in left_out.pins else each for b, each in by.items()}
            for point, by in forces.pins.items()
        }
        return replace(forces, pins=pins, torque=forces.torque * np.nan)

    some = of_forces(blanked)(engine("exudyn"))
    return replace(some, unreported=lambda scene, drive: left_out)


def _declaring(**declared: Any) -> Fault:
    """An engine of forces that declares something else."""
    return lambda _: replace(engine("exudyn"), **declared)


def _leaving_out(**left_out: Any) -> Fault:
    return _declaring(unreported=lambda scene, drive: Unreported(**left_out))


FAULTS: Mapping[str, tuple[str, str, Fault]] = {  # name: clause, words, fault
    "no reason": ("EC11", "iterations has no reason", _without_reason),
    "one profile": (
        "EC11", "there is no profile as-shipped",
        lambda e: replace(e, profiles={"tuned": e.profiles["tuned"]})),
    "other version": ("EC12", "version() gives '2.0'", lambda e: replace(e, version=lambda: "2.0")),
    "takes everything": ("EC13", "error_bias = nan is accepted", _careless),
    "boundless": ("EC13", "error_bias = -inf is accepted", _boundless),
    "takes every count": ("EC13", "iterations accepts each of 0, -1, 0.5", _boundless),
    "deaf": ("EC14", "differ in iterations, error_bias", _deaf),
    "other setting held": (
        "EC14", "iterations is requested as 150, found 7",
        of_facts(lambda f: {"settings": {**f.settings, "iterations": 7}})),
    "digits made up": (
        "EC15", "precision is single, but angles are rounded to",
        lambda e: replace(e, precision="single", floor=2e-6)),
    "digits lost": (
        "EC15", "precision is double, but all angular velocities are numbers of 24 bits",
        rounded_to_single),
    "heavier": (
        "EC21", "has mass_kg",
        of_facts(lambda f: {"mass_kg": {name: 1.01 * m for name, m in f.mass_kg.items()}})),
    "rounded start": ("EC21", "has mass_kg 0.2, not 0.2", rounded_to_single),
    "from zero": (
        "EC22", "the samples are at",
        meddling(lambda asked: asked._replace(state=replace(asked.state, time_s=0.0)))),
    "one step more": (
        "EC31", "after 60 steps step and record differ by",
        meddling(step_=lambda self, steps: steps + 1)),
    "counts samples": (
        "EC32", "record(40, 8) reports 5 steps done",
        meddling(record_=lambda _, log, every: replace(log, steps_done=log.steps_done // every))),
    "restarts": ("EC33", "the second begins at 0 s", meddling(record_=_restarts)),
    "lends its memory": (
        "EC34", "the result of read changes", meddling(read_=_lent, step_=_overwritten)),
    "shared state": ("EC35", "it differs by", meddling(record_=_shared)),
    "noise": (
        "EC36", "two runs of 100 steps differ by",
        turning(lambda b: {"omega": b.omega + 1e-14 * NOISE.random(b.omega.shape)})),
    "wrapped": ("EC37", "jumps by", turning(lambda b: {"theta": np.remainder(b.theta, 2 * np.pi)})),
    "talks": ("EC38", "writes to the terminal: 'stepping'", meddling(step_=_prints)),
    "leaves files": (
        "EC38", "leaves files in the working folder: ENGINE_LOG.TXT", meddling(read_=_litters)),
    "velocities late": (
        "EC41", "belongs -0.50 steps from its sample, and velocity_shift is +0.50",
        turning(lambda b: {"omega": _late(b.omega)})),
    "slow one is off": (
        "EC41", "does not fit its places", meddling(record_=of_log(_slow_one))),
    "shift unsaid": (
        "EC41", "belongs +0.50 steps from its sample, and velocity_shift is +0.00",
        of_facts(lambda f: {"velocity_shift": 0.0, "start": replace(f.start, lag_s=0.0)})),
    "lag unsaid": (
        "EC41", "Poses.lag_s is 0 steps",
        of_facts(lambda f: {"start": replace(f.start, lag_s=0.0)})),
    "zero accelerations": (
        "EC42", "are not all NaN",
        turning(lambda b: {"alpha": 0.0 * b.omega, "origin_acceleration": 0.0 * b.velocity})),
    "a little fast": ("EC51", "the crank is off by", meddling(_a_little_fast)),
    "floor too low": (
        "EC51", "the crank is off by",
        lambda e: replace(rounded_to_single(e), precision="single", floor=1e-8)),
    "third order": ("EC52", "shrink as dt^2.0, but order is 3", lambda e: replace(e, order=3)),
    "handed back": (
        "EC53", "placing is integrated with order 2",
        lambda _: _Integrated(drives=("prescribed", "servo"))),
    "in seconds": ("EC54", "a thousandth as fast", _in_seconds),
    "floor too high": (
        "EC56", "floor is 0.0001, and with 2880 steps a turn it is off by",
        lambda e: replace(e, floor=1e-4)),
    "weightless": ("EC55", "free, gravity along y moves", _pulled(0.0)),
    "pulled down alone": ("EC55", "free, gravity along x moves", _pulled(1.0)),
    "slowed": ("EC55", "without gravity, the centres of mass move", meddling(_damped(1e-9))),
    "slips": (
        "EC57", "planetary: Q is off by",
        of_exudyn(_with_scene(lambda scene: replace(scene, gears={
            name: replace(gear, teeth=(gear.teeth[0], gear.teeth[1] + 2))
            for name, gear in scene.gears.items()})))),
    "at home": ("EC61", "moved by (3, -2) m", meddling(record_=_at_home)),
    "blunt": ("EC71", "open raised KeyError: 'motor'", meddling(_blunt)),
    "another motion": ("EC81", "logs another motion", of_exudyn(forces_=_shaken)),
    "another motion under loads": (
        "EC81", "free, with a load: record_forces of every 4th step logs another",
        of_exudyn(forces_=lambda self, log: _shaken(self, log) if self.asked.scene.loads else log)),
    "one-sided": ("EC82", "the forces of pin C add up to", _last_pin(lambda one, two: (two, two))),
    "a gap": ("EC82", "the driving torque is not finite at sample 7", of_forces(_gap)),
    "none after all": (
        "EC82", "all forces are NaN", of_forces(lambda f: f.each_series(lambda x: x * np.nan))),
    "torque unsaid": (
        "EC82", "the driving torque is not finite at sample 0, and not in unreported",
        of_forces(lambda f: replace(f, torque=f.torque * np.nan))),
    "torque denied": (
        "EC82", "the driving torque has numbers, but is in unreported", _leaving_out(torque=True)),
    "pin denied": (
        "EC82", "the force of pin C on rocker has numbers", _leaving_out(pins=frozenset("C"))),
    "unknown pin": ("EC82", "unreported has Q, and the", _leaving_out(pins=frozenset("Q"))),
    "of states, not steps": (
        "EC82", "forces_of is steps, and the", _declaring(forces_of="steps")),
    "no pins": ("EC82", "pins are {}", of_forces(lambda f: replace(f, pins={}))),
    "torque's sign": (
        "EC83", "crank: a moment of", of_forces(lambda f: replace(f, torque=-f.torque))),
    "a pin's sign": ("EC83", "coupler: ", _last_pin(lambda one, two: (-one, -two))),
    "half a step late": ("EC84", "acts -0.50 steps", of_forces(_half_a_step_late)),
    "without loads": (
        "EC85", "a force over time in the ground's frame on rocker",
        of_exudyn(_with_scene(_without_loads))),
    "load's frame": (
        "EC85", "a constant force in the body's frame on rocker",
        of_loads(lambda load: replace(load, frame="ground"))),
    "load late": ("EC85", "steps after the load", of_loads(_late_load)),
    "loads not felt": ("EC85", "free, loads equal to its weight", _weightless_loads),
    "loads not pushed": (
        "EC85", "free, loads equal to its weight", _left_out_when_free("exudyn", loads={})),
    "rubs less": ("EC86", "friction in C", of_exudyn(_with_scene(_rubbing_less))),
    "rubs nothing": (
        "EC86", "friction in C: free, it takes", _left_out_when_free("mujoco", friction={})),
    "springs unsaid": (
        "EC91", "a spring in a pin: the engine does not hold rod: springs.pin is not there",
        of_exudyn(facts_=lambda _, facts: replace(facts, springs={}))),
    "without springs": (
        "EC92", "a spring between two points: the body does not swing",
        of_springs(lambda spring: None)),
    "slack at nothing": (
        "EC92", "a spring between two points: the body swings about 1.712 rad, not 0.7",
        of_springs(lambda spring: replace(spring, free=0.0))),
    "damped twice": (
        "EC92", "a spring in a pin: the body dies away by 1 1/s, not 0.5",
        of_springs(lambda spring: replace(spring, damping=2.0 * spring.damping))),
    "fastened elsewhere": (
        "EC92", "a spring between a point and a slider: the body swings about",
        of_springs(_elsewhere)),
    "leaking": (
        "EC93", "of the exchanged energy is gained or lost", meddling(_damped(0.5))),
    "deaf to its speed": (
        "EC94", "a torque over the angular velocity of its link: after", of_loads(_deaf_load)),
}  # fmt: skip


def late_accelerations(sound: Engine) -> Engine:
    """Of an engine that reports them, those of links a step late."""
    return meddled(sound, record_=of_bodies(lambda body: replace(body, alpha=_late(body.alpha))))
