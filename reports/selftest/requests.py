"""Faults of the run: other than requested, or a log of the reference handed back as an engine's."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from itertools import islice
from typing import Any

import numpy as np

from analytic.kinematics import solve, solve_driven
from models.array import Array
from models.motion import LinkMotion, Motion
from models.scene import Scene
from reports.selftest import fault
from reports.selftest.log_faults import last, moved, noisy, taken, to_digits, with_link
from sim.engine import Run
from sim.registry import available, engine, offering
from sim.run import run, setup
from sim.run.spoil import WrongSetting, spoiler

DEGREES = 10
"""Degrees of a turn that are run in place of it."""
THIN, LATER = 8, 10
"""Stride of the thinned log; steps by which the run starts later."""


def other_engine(name: str) -> str | None:
    """Return another engine that can be run here, if there is one."""
    return next((one.name for one in available() if one.version and one.name != name), None)


def _wrong(name: str) -> list[WrongSetting]:
    return list(spoiler(name).wrong_settings) if name in offering("spoiler") else []


def _run_of(other: Callable[[str, str], tuple[str, str]], renamed: bool) -> fault.Plant:
    """Run another engine or profile; ``renamed``, under the requested names."""

    @fault.planting
    def runner(size: float, scene: Scene, state: Any, *names: str, **options: Any) -> Run:
        if not size:
            return run(scene, state, *names, **options)
        asked = setup(scene, state, *names, **options)
        done = run(scene, state, *other(*names), **{**options, "settings": None})
        return replace(done, **vars(asked)) if renamed else done

    return runner


def _engine_for(name: str, profile: str) -> tuple[str, str]:
    return other_engine(name) or name, profile


def _profile_for(name: str, profile: str) -> tuple[str, str]:
    return name, next((other for other in engine(name).profiles if other != profile), profile)


def _given(change: Callable[[Scene, str, Mapping[str, Any]], Mapping[str, Any]]) -> fault.Plant:
    """Change the options of a run, and let the run say so."""

    @fault.planting
    def runner(
        size: float, scene: Scene, state: Any, name: str, profile: str, **options: Any
    ) -> Run:
        changed = {"state": state, **options, **(change(scene, name, options) if size else {})}
        return run(scene, changed.pop("state"), name, profile, **changed)

    return runner


def _other_setting(_: Scene, name: str, _options: Mapping[str, Any]) -> dict[str, Any]:
    first = _wrong(name)[0]
    return {"settings": spoiler(name).wrong_settings[first](1.0)}


def _one_more(name: str) -> dict[str, Any]:
    """Return a setting that is a whole number, one above profile tuned; none without one."""
    tuned = engine(name).profiles[fault.PROFILE].settings
    whole = (n for n, setting in tuned.items() if type(setting.value) is int)
    return {n: int(tuned[n].value) + 1 for n in islice(whole, 1)}


def _started_later(scene: Scene, _: str, options: Mapping[str, Any]) -> dict[str, Any]:
    later = np.array([LATER * options["dt_s"]])
    return {"state": solve(scene, later, bound=False).state()}


def _silent(_: Scene, done: Run) -> Run:
    """Set accelerations to NaN, and say that the engine reports none."""
    motion = moved(done)
    series = {"links": ["alpha"], "points": ["acceleration"], "sliders": ["acceleration"]}
    mute = taken(motion, motion, lambda own, _: np.full_like(own, np.nan), **series)
    return replace(done, motion=mute, reports_accelerations=False)


@fault.planting
def _the_first_again(
    size: float, *args: Any, dt_s: float, steps: int, every: int, **options: Any
) -> Run:
    """Put the run at the full step in the place of the finer ones, with their words."""
    if not size:
        return run(*args, dt_s=dt_s, steps=steps, every=every, **options)
    first = run(*args, dt_s=dt_s * every, steps=steps // every, every=1, **options)
    held = engine(first.engine).holds(first.asked, dt_s, first.drive)
    settings = {**first.settings, **held}
    return replace(first, dt_s=dt_s, steps=steps, every=every, settings=settings)


def _fault(name: str, what: str, plant: fault.Plant, says: str, **more: Any) -> fault.Fault:
    scenes = (fault.FOURBAR, fault.SLIDER, fault.SHAPER)
    return fault.Fault("request", name, what, "CC117", plant, says=(says,), scenes=scenes, **more)


RUN_FAULTS = (
    _fault("engine-other", "another engine's run", _run_of(_engine_for, renamed=False),
           "engine: requested", needs=lambda name: other_engine(name) is not None),
    _fault("engine-renamed", "the same, under the requested name",
           _run_of(_engine_for, renamed=True), "as the engine holds it",
           needs=lambda name: other_engine(name) is not None),
    _fault("profile-other", "the run of another profile", _run_of(_profile_for, renamed=False),
           "profile: requested"),
    _fault("profile-renamed", "the same, under the requested name",
           _run_of(_profile_for, renamed=True), "as the engine holds it"),
    _fault("setting-other", "a setting that was not requested", _given(_other_setting), "setting ",
           needs=lambda name: bool(_wrong(name))),
    _fault("setting-dropped", "the settings of the cell, left out",
           _given(lambda *_: {"settings": None}), "setting ", settings=_one_more,
           needs=lambda name: bool(_one_more(name))),
    _fault("version-other", "another version",
           fault.switched(lambda _, done: replace(done, version=f"{done.version}.1")), "version: "),
    _fault("drive-other", "a servo drives, and says so", _given(lambda *_: {"drive": "servo"}),
           "drive: requested 'prescribed'"),
    _fault("turn-cut", "ten degrees for a turn",
           _given(lambda s, n, asked: {"steps": max(asked["steps"] * DEGREES // 360, 1)}),
           "steps: "),
    _fault("step-double", "twice the step",
           _given(lambda s, n, asked: {"dt_s": 2.0 * asked["dt_s"], "steps": asked["steps"] // 2}),
           "dt_s: "),
    _fault("log-thinned", "every eighth sample",
           _given(lambda s, n, asked: {"every": THIN * asked["every"]}), "every: "),
    _fault("start-later", "a start ten steps later", _given(_started_later), "start"),
    _fault("accelerations-kept", "accelerations that are kept back", fault.switched(_silent),
           "reports_accelerations: requested True",
           needs=lambda name: engine(name).reports_accelerations),
    _fault("halved-again", "the first run, for its own finer ones", _the_first_again,
           "the places are those of dt", finer=True, needs=fault.integrates),
)  # fmt: skip


def _handed_back(scene: Scene, done: Run) -> Run:
    """Put the closed form in the place of the log, at the instants of the places."""
    motion = solve(scene, moved(done).time_s)
    return replace(done, motion=motion, velocity_time_s=None, acceleration_time_s=None)


def _each(change: Callable[[Motion], Motion]) -> fault.Plant:
    """Return the closed form, changed a little."""

    def changed(scene: Scene, done: Run) -> Run:
        back = _handed_back(scene, done)
        return replace(back, motion=change(moved(back)))

    return fault.switched(changed)


def _through_degrees(motion: Motion) -> Motion:
    def there_and_back(series: Array) -> Array:
        return np.asarray(np.radians(np.degrees(series)))

    links = {
        name: LinkMotion(*map(there_and_back, vars(link).values()))
        for name, link in motion.links.items()
    }
    return replace(motion, links=links)


def _spoilt(change: Callable[[Array, float], Array]) -> fault.Plant:
    """Return the closed form, with its places changed by a size, in radians and longest links."""

    def changed(scene: Scene, done: Run, size: float) -> Run:
        if not size:
            return done
        own, far = moved(_handed_back(scene, done)), size * scene.longest_m
        links = {n: replace(m, theta=change(m.theta, size)) for n, m in own.links.items()}
        links[scene.driver.link] = own.links[scene.driver.link]
        points = {n: replace(m, position=change(m.position, far)) for n, m in own.points.items()}
        motion = replace(own, links=links, points=points)
        return replace(done, motion=motion, velocity_time_s=None, acceleration_time_s=None)

    return fault.in_log(changed)


def _one(bodies: str, name: Callable[[Scene], str]) -> fault.Plant:
    """Give a link, point or slider the numbers of the closed form; keep the rest of the engine."""

    def changed(scene: Scene, done: Run) -> Run:
        own, body = moved(done), name(scene)
        true = getattr(solve(scene, own.time_s, bound=False), bodies)[body]
        other: dict[str, Any] = {bodies: {**getattr(own, bodies), body: true}}
        return replace(done, motion=replace(own, **other))

    return fault.switched(changed)


def _velocity(scene: Scene, done: Run) -> Run:
    """Give the last link the closed form's angular velocity, at the instants of the engine's."""
    assert done.velocity_time_s is not None
    name = last(scene)
    omega = solve(scene, done.velocity_time_s, bound=False).links[name].omega
    return with_link(done, name, omega=omega)


def _speeds(scene: Scene, done: Run) -> Run:
    assert done.velocity_time_s is not None
    own = moved(done)
    true = solve(scene, done.velocity_time_s, bound=False)
    return replace(done, motion=taken(own, true, points=["velocity"], sliders=["speed"]))


def _moving_pin(scene: Scene) -> str:
    """Return a point at the end of the driven links."""
    ends = scene.links[last(scene)].points
    carried = scene.links[scene.driver.link].points
    return next(name for name in ends if name not in scene.ground and name not in carried)


def _at_the_crank(scene: Scene, done: Run) -> Run:
    """Return the closed form at the logged angles of the crank, with the speeds of its law."""
    own = moved(done)
    crank = own.links[scene.driver.link].theta
    _, omega, alpha = scene.driver.law.at(own.time_s)
    motion = solve_driven(scene, crank, omega, alpha, own.time_s, bound=False)
    return replace(done, motion=motion, velocity_time_s=None, acceleration_time_s=None)


@fault.planting
def _finer_handed_back(size: float, scene: Scene, *args: Any, **options: Any) -> Run:
    """Run the engine at the full step, and the closed form at the finer ones."""
    done = run(scene, *args, **options)
    return _handed_back(scene, done) if size and options["every"] > 1 else done


_shut = fault.switched(
    lambda _, done: replace(done, gaps={n: np.zeros_like(gap) for n, gap in done.gaps.items()})
)
_handed = partial(fault.Fault, "reference", scenes=(fault.FOURBAR, fault.SLIDER, fault.SHAPER))
LOG_FAULTS = (
    _handed("too-good", "the reference, handed back", "CC111", fault.switched(_handed_back)),
    _handed("too-good-degrees", "through degrees and back", "CC111", _each(_through_degrees)),
    _handed("too-good-next", "every number the next float", "CC111",
           _each(lambda motion: motion.each_series(lambda x: np.nextafter(x, np.inf)))),
    _handed("too-good-link", "of one link only", "CC111", _one("links", last)),
    _handed("too-good-point", "of one point only", "CC111", _one("points", _moving_pin)),
    _handed("too-good-slider", "of one slider only", "CC111",
           _one("sliders", lambda scene: next(iter(scene.sliders))),
           scenes=(fault.SLIDER, fault.SHAPER)),
    _handed("too-good-velocity", "of one velocity only", "CC111", fault.switched(_velocity),
           needs=fault.integrates),
    _handed("too-good-speeds", "of all points and sliders", "CC111", fault.switched(_speeds),
           needs=fault.integrates),
    _handed("too-good-gaps", "every gap is 0, as in the reference", "CC111", _shut,
           needs=fault.integrates),
    _handed("too-good-rounded", "to few digits", "CC118", _spoilt(to_digits), 1e-7, "rad, L"),
    _handed("too-good-noisy", "with noise (normal)", "CC118", _spoilt(noisy), 1e-7, "rad, L",
           needs=fault.is_double),
    _handed("too-good-crank", "at the logged crank angle", "CC111", fault.switched(_at_the_crank),
           needs=fault.integrates),
    _handed("too-good-finer", "in the finer runs only", "CC117", _finer_handed_back,
           says=("which no step of that size allows",), finer=True, needs=fault.integrates),
)  # fmt: skip
