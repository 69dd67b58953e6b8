"""Engines with one fault each: a sound one whose sessions are meddled with."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, ClassVar, cast

import numpy as np

from models.array import Array
from models.characteristics import Constant, Sine
from models.forces import Forces
from models.friction import ConstantFriction
from models.loads import Load
from models.motion import State
from models.scene import Scene
from models.springs import LineSpring, Spring
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
)
from sim.registry import engine
from sim.settings import SettingError
from tests.worlds.fake.engine import FakeEngine


@dataclass
class Meddled:
    """A session that is handed on but for what a fault says, each with the session first."""

    session: Session
    facts_: Callable[[Facts], Facts] = lambda facts: facts
    record_: Callable[[Meddled, Log, int], Log] = lambda self, log, every: log
    read_: Callable[[Meddled, Poses], Poses] = lambda self, poses: poses
    step_: Callable[[Meddled, int], int] = lambda self, steps: steps
    forces_: Callable[[Meddled, Log], Log] = lambda self, log: log
    notes: dict[str, Any] = field(default_factory=dict)
    last: ClassVar[Meddled | None] = None

    def facts(self) -> Facts:
        return self.facts_(self.session.facts())

    def step(self, steps: int) -> None:
        self.session.step(self.step_(self, steps))

    def record(self, steps: int, every: int) -> Log:
        return self.record_(self, self.session.record(steps, every), every)

    def record_forces(self, steps: int, every: int) -> Log:
        return self.forces_(self, cast(ForceSession, self.session).record_forces(steps, every))

    def read(self) -> Poses:
        return self.read_(self, self.session.read())


def meddled(sound: Engine, **faults: Any) -> Engine:
    """An engine whose sessions have faults: see `Meddled`."""

    def opened(*asked: Any) -> Meddled:
        return Meddled(sound.open(*asked), **faults)

    return replace(sound, open=opened)


def opening(sound: Engine, change: Callable[..., tuple[Any, ...]]) -> Engine:
    """An engine that opens something else than was asked for."""
    return replace(sound, open=lambda *asked: sound.open(*change(*asked)))


def of_log(change: Callable[[Poses], Poses], least: int = 0) -> Callable[..., Log]:
    """A change of logs of so many samples at least."""

    def record(_: Meddled, log: Log, every: int) -> Log:
        return replace(log, poses=change(log.poses)) if log.poses.time_s.size >= least else log

    return record


def _without_reason(sound: Engine) -> Engine:
    tuned = sound.profiles["tuned"]
    settings = {name: Setting(each.value, "") for name, each in tuned.settings.items()}
    return replace(sound, profiles={**sound.profiles, "tuned": replace(tuned, settings=settings)})


def _without_as_shipped(sound: Engine) -> Engine:
    return replace(sound, profiles={"tuned": sound.profiles["tuned"]})


def _careless(sound: Engine) -> Engine:
    """It takes every setting, and holds its own in place of a wrong one."""

    def healed(
        scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
    ) -> tuple[Any, ...]:
        own = {name: each.value for name, each in sound.profiles["tuned"].settings.items()}
        wrong = {n for n, v in settings.items() if v != v or v == "no-such-choice"}
        healthy = {n: own[n] if n in wrong else v for n, v in settings.items()}
        return scene, state, healthy, dt_s, drive

    return replace(opening(sound, healed), check=lambda settings: None)


def _boundless(sound: Engine) -> Engine:
    """It refuses what is no number, and takes every number, 1 in place of it."""

    def checked(settings: Settings) -> None:
        if any(value != value or value == "no-such-choice" for value in settings.values()):
            raise SettingError("no number")

    def healed(
        scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
    ) -> tuple[Any, ...]:
        checked(settings)
        own = {"iterations": 1, "error_bias": 1.0, "damping": 1.0}
        return scene, state, {**settings, **own}, dt_s, drive

    return replace(opening(sound, healed), check=checked)


def _deaf(sound: Engine) -> Engine:
    """It runs as it always does, and says that it has what was asked for."""
    own = {name: each.value for name, each in sound.profiles["tuned"].settings.items()}

    def opened(
        scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
    ) -> Session:
        sound.check(settings)
        session = sound.open(scene, state, own, dt_s, drive)
        return Meddled(session, facts_=lambda f: replace(f, settings={**f.settings, **settings}))

    return replace(sound, open=opened)


def _another_setting(facts: Facts) -> Facts:
    return replace(facts, settings={**facts.settings, "iterations": 7})


def _heavier(facts: Facts) -> Facts:
    return replace(facts, mass_kg={name: 1.01 * mass for name, mass in facts.mass_kg.items()})


def _from_zero(
    scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
) -> tuple[Any, ...]:
    return scene, replace(state, time_s=0.0), settings, dt_s, drive


def _thin_count(_: Meddled, log: Log, every: int) -> Log:
    return replace(log, steps_done=log.steps_done // every)


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


def _noisy(poses: Poses) -> Poses:
    def shaken(body: BodyPose) -> BodyPose:
        return replace(body, omega=body.omega + 1e-14 * NOISE.random(body.omega.shape))

    return poses.changed(shaken)


def _wrapped(poses: Poses) -> Poses:
    return poses.changed(lambda body: replace(body, theta=np.remainder(body.theta, 2 * np.pi)))


def _prints(self: Meddled, steps: int) -> int:
    os.write(1, b"stepping\n")
    return steps


def _litters(self: Meddled, poses: Poses) -> Poses:
    Path("ENGINE_LOG.TXT").write_text("read")
    return poses


def _late_rates(poses: Poses) -> Poses:
    def late(body: BodyPose) -> BodyPose:
        omega = np.concatenate([body.omega[:1], body.omega[:-1]])
        return replace(body, omega=omega)

    return poses.changed(late)


def _slow_one(change: float) -> Callable[[Poses], Poses]:
    """The speed of the body that turns least, times a number."""

    def changed(poses: Poses) -> Poses:
        slow = min(poses.bodies, key=lambda name: float(np.abs(poses.bodies[name].omega).max()))
        body = poses.bodies[slow]
        turned = {slow: replace(body, omega=change * body.omega)}
        return replace(poses, bodies={**poses.bodies, **turned})

    return changed


def _zero_accelerations(poses: Poses) -> Poses:
    return poses.changed(
        lambda body: replace(
            body,
            alpha=np.zeros_like(body.alpha),
            origin_acceleration=np.zeros_like(body.origin_acceleration),
        )
    )


def _late_accelerations(poses: Poses) -> Poses:
    return poses.changed(
        lambda body: replace(body, alpha=np.concatenate([body.alpha[:1], body.alpha[:-1]]))
    )


def _a_little_fast(
    scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
) -> tuple[Any, ...]:
    law: Any = scene.driver.law
    if hasattr(law, "speed_rad_s"):
        law = replace(law, speed_rad_s=law.speed_rad_s * (1.0 + 1e-9))
    driver = replace(scene.driver, law=law)
    return replace(scene, driver=driver), state, settings, dt_s, drive


def _pulled(share_x: float, share_y: float) -> Callable[[Engine], Engine]:
    """Free, it has a share of gravity, and says that it has all."""

    def changed(sound: Engine) -> Engine:
        def opened(
            scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
        ) -> Session:
            if drive != "free":
                return sound.open(scene, state, settings, dt_s, drive)
            x, y = scene.gravity_m_s2
            other = replace(scene, gravity_m_s2=(share_x * x, share_y * y))
            session = sound.open(other, state, settings, dt_s, drive)
            return Meddled(session, facts_=lambda f: replace(f, gravity_m_s2=scene.gravity_m_s2))

        return replace(sound, open=opened)

    return changed


def _slowed(
    scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
) -> tuple[Any, ...]:
    """Free, it loses speed."""
    lossy = {**settings, "damping": 1e-9} if drive == "free" else settings
    return scene, state, lossy, dt_s, drive


def _in_seconds(sound: Engine) -> Engine:
    """A loss in a second, and not said."""
    lossy = {"error_bias": 0.5}

    def opened(
        scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
    ) -> Session:
        session = sound.open(scene, state, {**settings, **lossy}, dt_s, drive)
        return Meddled(
            session, facts_=lambda f: replace(f, settings={**f.settings, **dict(settings)})
        )

    return replace(sound, open=opened, in_seconds=lambda settings: ())


def _at_home(sound: Engine) -> Engine:
    """It is off by a milliradian wherever the ground lies far from the origin."""

    def opened(
        scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
    ) -> Session:
        session = sound.open(scene, state, settings, dt_s, drive)
        if max(abs(x) for x, _ in scene.ground.values()) < 2.0:
            return session
        name = next(n for n in reversed(list(scene.links)) if n != scene.driver.link)

        def off(poses: Poses) -> Poses:
            body = poses.bodies[name]
            off = np.minimum(np.arange(float(body.theta.size)), 50.0) * 2e-4
            wrong = replace(body, theta=body.theta + off)
            return replace(poses, bodies={**poses.bodies, name: wrong})

        return Meddled(session, record_=of_log(off))

    return replace(sound, open=opened)


def _blunt(sound: Engine) -> Engine:
    def refused(*asked: Any) -> tuple[Any, ...]:
        if asked[-1] == "servo":
            raise KeyError("motor")
        return asked

    return opening(sound, refused)


class _Integrated(FakeEngine):
    """It has its places from the reference, and says otherwise."""

    def placing(self, settings: Settings) -> Placing:
        return "integrated"


def _exact(_: Engine) -> Any:
    return _Integrated(drives=("prescribed", "servo"))


def of_forces(change: Callable[[Forces], Forces]) -> Callable[[Engine], Engine]:
    """An engine that reports forces, with a change of them."""

    def meddle(_: Engine) -> Engine:
        def changed(_: Meddled, log: Log) -> Log:
            assert log.forces is not None
            return replace(log, forces=change(log.forces))

        return meddled(engine("exudyn"), forces_=changed)

    return meddle


def _last_pin(change: Callable[[Array], Array]) -> Callable[[Forces], Forces]:
    """The forces of one pin changed."""

    def changed(forces: Forces) -> Forces:
        point = list(forces.pins)[-1]
        by_body = {body: change(force) for body, force in forces.pins[point].items()}
        return replace(forces, pins={**forces.pins, point: by_body})

    return changed


def _one_sided(forces: Forces) -> Forces:
    """What a pin exerts on its second body is told of the first as well."""
    point, by_body = list(forces.pins.items())[-1]
    first, second = by_body
    doubled = {first: by_body[second], second: by_body[second]}
    return replace(forces, pins={**forces.pins, point: doubled})


def _gap(forces: Forces) -> Forces:
    torque = forces.torque.copy()
    torque[7] = np.nan
    return replace(forces, torque=torque)


def _a_step_late(forces: Forces) -> Forces:
    """The forces of the step before, as if an impulse were of the wrong end of its step."""
    times, late = (
        forces.time_s,
        forces.each_series(lambda each: np.concatenate([each[:1], each[:-1]])),
    )
    return replace(late, time_s=times)


def _shaken(_: Engine) -> Engine:
    """To read forces it steps once more, from which it does not come back."""

    def changed(self: Meddled, log: Log) -> Log:
        return replace(log, poses=of_log(_late_rates)(self, log, 1).poses)

    return meddled(engine("exudyn"), forces_=changed)


def of_scene(change: Callable[[Scene], Scene]) -> Callable[[Engine], Engine]:
    """An engine that has another scene, without saying so."""

    def meddle(_: Engine) -> Engine:
        return opening(engine("exudyn"), lambda scene, *asked: (change(scene), *asked))

    return meddle


def _each_load(**changes: Callable[[Load], Any]) -> Callable[[Scene], Scene]:
    """The loads of a scene changed."""

    def changed(scene: Scene) -> Scene:
        loads = {
            name: replace(load, **{what: change(load) for what, change in changes.items()})
            for name, load in scene.loads.items()
        }
        return replace(scene, loads=loads)

    return changed


def _late_load(load: Load) -> Any:
    """A load as it was a step before."""
    wave = load.characteristic
    if not isinstance(wave, Sine):
        return wave
    return replace(wave, phase_rad=wave.phase_rad - 2 * 2 * np.pi / 800)


def _rubbing_less(scene: Scene) -> Scene:
    """Friction that is a tenth too small."""
    friction = {
        name: replace(one, size=0.9 * one.size)
        for name, one in scene.friction.items()
        if isinstance(one, ConstantFriction)
    }
    return replace(scene, friction=friction)


def of_springs(change: Callable[[Spring], Spring | None]) -> Callable[[Engine], Engine]:
    """An engine that has other springs, or none, and says that it has those of the scene."""

    def meddle(_: Engine) -> Engine:
        sound = engine("exudyn")

        def opened(scene: Scene, *asked: Any) -> Session:
            own = {name: change(spring) for name, spring in scene.springs.items()}
            springs = {name: spring for name, spring in own.items() if spring is not None}
            session = sound.open(replace(scene, springs=springs), *asked)
            told = {n: (s.rate, s.damping, s.free) for n, s in scene.springs.items()}
            return Meddled(session, facts_=lambda facts: replace(facts, springs=told))

        return replace(sound, open=opened)

    return meddle


def _elsewhere(spring: Spring) -> Spring:
    """A spring between points at the first point of the ground, and not at its own."""
    if not isinstance(spring, LineSpring):
        return spring
    return replace(spring, points=("A", spring.points[1]))


def _deaf_load(scene: Scene) -> Scene:
    """Loads over a speed as they are at a speed of 1."""
    loads = {
        name: load
        if load.over not in ("omega", "speed")
        else replace(
            load, over="time", slider=None, characteristic=Constant(load.magnitude(np.ones(1))[0])
        )
        for name, load in scene.loads.items()
    }
    return replace(scene, loads=loads)


def _leaking(
    scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
) -> tuple[Any, ...]:
    """Free, it loses half its speed in a second."""
    lossy = {**settings, "damping": 0.5} if drive == "free" else settings
    return scene, state, lossy, dt_s, drive


def _weightless_loads(_: Engine) -> Engine:
    """It reports no forces, says that it takes loads, and leaves them out."""
    own = engine("pymunk")
    plain = opening(own, lambda scene, *asked: (replace(scene, loads={}), *asked))
    return replace(plain, applies_loads=True, forces_of="nothing", applies_constant_friction=False)


FAULTS: Mapping[str, tuple[str, str, Callable[[Engine], Any], set[str]]] = {
    # name: clause, words, fault; other clauses that can not but break too
    "no reason": ("EC11", "iterations has no reason", _without_reason, set()),
    "one profile": ("EC11", "there is no profile as-shipped", _without_as_shipped, set()),
    "other version": (
        "EC12",
        "version() gives '2.0'",
        lambda e: replace(e, version=lambda: "2.0"),
        set(),
    ),
    "takes everything": ("EC13", "error_bias = nan is taken", _careless, set()),
    "boundless": ("EC13", "error_bias = -inf is taken", _boundless, {"EC14", "EC52", "EC54"}),
    "takes every count": (
        "EC13",
        "iterations takes each of 0, -1, 0.5",
        _boundless,
        {"EC14", "EC52", "EC54"},
    ),
    "deaf": ("EC14", "differ in iterations, error_bias", _deaf, {"EC53", "EC54"}),
    "other setting held": (
        "EC14",
        "iterations is asked to be 150, held 7",
        lambda e: meddled(e, facts_=_another_setting),
        set(),
    ),
    "heavier": ("EC21", "has mass_kg", lambda e: meddled(e, facts_=_heavier), set()),
    "from zero": ("EC22", "the samples are at", lambda e: opening(e, _from_zero), set()),
    "one step more": (
        "EC31",
        "after 60 steps step and record differ by",
        lambda e: meddled(e, step_=lambda self, steps: steps + 1),
        set(),
    ),
    "counts samples": (
        "EC32",
        "record(40, 8) says 5 steps done",
        lambda e: meddled(e, record_=_thin_count),
        set(),
    ),
    "restarts": (
        "EC33",
        "the second begins at 0 s",
        lambda e: meddled(e, record_=_restarts),
        set(),
    ),
    "lends its memory": (
        "EC34",
        "what read gave changes",
        lambda e: meddled(e, read_=_lent, step_=_overwritten),
        set(),
    ),
    "shared state": ("EC35", "it differs by", lambda e: meddled(e, record_=_shared), set()),
    "noise": (
        "EC36",
        "100 steps twice differ by",
        lambda e: meddled(e, record_=of_log(_noisy)),
        set(),
    ),
    "wrapped": (
        "EC37",
        "jumps by",
        lambda e: meddled(e, record_=of_log(_wrapped, 1000)),
        {"EC41", "EC51", "EC52", "EC53"},
    ),
    "talks": (
        "EC38",
        "writes to the terminal: 'stepping'",
        lambda e: meddled(e, step_=_prints),
        set(),
    ),
    "leaves files": (
        "EC38",
        "leaves files in the working folder: ENGINE_LOG.TXT",
        lambda e: meddled(e, read_=_litters),
        set(),
    ),
    "velocities late": (
        "EC41",
        "is that of -0.50 steps, and velocity_shift says +0.50",
        lambda e: meddled(e, record_=of_log(_late_rates, 700)),
        set(),
    ),
    "slow one is off": (
        "EC41",
        "is not that of its places",
        lambda e: meddled(e, record_=of_log(_slow_one(1.08), 700)),
        {"EC93"},
    ),
    "lag unsaid": (
        "EC41",
        "Poses.lag_s is 0 steps",
        lambda e: meddled(e, facts_=lambda f: replace(f, start=replace(f.start, lag_s=0.0))),
        set(),
    ),
    "zero accelerations": (
        "EC42",
        "are not all NaN",
        lambda e: meddled(e, record_=of_log(_zero_accelerations)),
        {"EC41"},
    ),
    "a little fast": ("EC51", "the crank is off by", lambda e: opening(e, _a_little_fast), set()),
    "third order": (
        "EC52",
        "shrink as dt^2.0, and order is 3",
        lambda e: replace(e, order=3),
        set(),
    ),
    "handed back": ("EC53", "placing is integrated with order 2", _exact, set()),
    "in seconds": ("EC54", "a thousandth as fast", _in_seconds, {"EC52", "EC53"}),
    "weightless": ("EC55", "free, gravity along y moves", _pulled(0.0, 0.0), {"EC93"}),
    "nearly weightless": ("EC55", "free, gravity along y moves", _pulled(0.01, 0.01), {"EC93"}),
    "too heavy": ("EC55", "free, gravity along y moves", _pulled(10.0, 10.0), {"EC93"}),
    "pulled down alone": ("EC55", "free, gravity along x moves", _pulled(0.0, 1.0), {"EC93"}),
    "slowed": (
        "EC55",
        "without gravity, the centres of mass move",
        lambda e: opening(e, _slowed),
        {"EC93", "EC94"},
    ),
    "at home": ("EC61", "moved by (3, -2) m", _at_home, set()),
    "another motion": ("EC81", "logs another motion", _shaken, set()),
    "one-sided": ("EC82", "the forces of pin C add up to", of_forces(_one_sided), {"EC83"}),
    "a gap": ("EC82", "the driving torque is not finite at sample 7", of_forces(_gap), set()),
    "none after all": (
        "EC82",
        "all forces are NaN",
        of_forces(lambda forces: forces.each_series(lambda each: np.full_like(each, np.nan))),
        {"EC85", "EC86"},
    ),
    "no pins": (
        "EC82",
        "pins are {}",
        of_forces(lambda forces: replace(forces, pins={})),
        {"EC83", "EC84"},
    ),
    "torque's sign": (
        "EC83",
        "crank: a moment of",
        of_forces(lambda forces: replace(forces, torque=-forces.torque)),
        {"EC85", "EC86"},
    ),
    "a pin's sign": (
        "EC83",
        "coupler: ",
        of_forces(_last_pin(lambda force: -force)),
        {"EC84", "EC85", "EC86"},
    ),
    "a body's frame": (
        "EC83",
        "rocker: ",
        of_forces(_last_pin(lambda force: force @ np.array([[0.8, 0.6], [-0.6, 0.8]]))),
        {"EC84", "EC85", "EC86"},
    ),
    "a step late": ("EC84", "is that of +1.00 steps", of_forces(_a_step_late), {"EC85"}),
    "half a step late": (
        "EC84",
        "is that of -0.50 steps",
        of_forces(
            lambda forces: replace(
                forces, time_s=forces.time_s - 0.5 * (forces.time_s[1] - forces.time_s[0])
            )
        ),
        {"EC85"},
    ),
    "without loads": (
        "EC85",
        "a force over time in the ground's frame on rocker",
        of_scene(lambda scene: replace(scene, loads={})),
        {"EC94"},
    ),
    "load's frame": (
        "EC85",
        "a constant force in the body's frame on rocker",
        of_scene(_each_load(frame=lambda _: "ground")),
        set(),
    ),
    "load late": (
        "EC85",
        "steps after its time",
        of_scene(_each_load(characteristic=_late_load)),
        set(),
    ),
    "loads not felt": ("EC85", "free, loads like its weight", _weightless_loads, {"EC94"}),
    "rubs less": ("EC86", "friction in C", of_scene(_rubbing_less), set()),
    "springs unsaid": (
        "EC91",
        "a spring in a pin: the engine does not hold rod: springs.pin is not there",
        lambda _: meddled(engine("exudyn"), facts_=lambda f: replace(f, springs={})),
        set(),
    ),
    "without springs": (
        "EC92",
        "a spring between two points: the body does not swing",
        of_springs(lambda spring: None),
        set(),
    ),
    "slack at nothing": (
        "EC92",
        "a spring between two points: the body swings about 1.712 rad, not 0.7",
        of_springs(lambda spring: replace(spring, free=0.0)),
        set(),
    ),
    "damped twice": (
        "EC92",
        "a spring in a pin: the body dies away by 1 1/s, not 0.5",
        of_springs(lambda spring: replace(spring, damping=2.0 * spring.damping)),
        set(),
    ),
    "fastened elsewhere": (
        "EC92",
        "a spring between a point and a slider: the body swings about",
        of_springs(_elsewhere),
        set(),
    ),
    "leaking": (
        "EC93",
        "of the energy that goes back and forth is gained or lost",
        lambda e: opening(e, _leaking),
        {"EC94"},
    ),
    "deaf to its speed": (
        "EC94",
        "a torque over the angular velocity of its link: after",
        of_scene(_deaf_load),
        set(),
    ),
    "blunt": ("EC71", "open raised KeyError: 'motor'", _blunt, set()),
}


def late_accelerations(sound: Engine) -> Engine:
    """Of an engine that reports them, those of links a step late."""
    return meddled(sound, record_=of_log(_late_accelerations, 700))
