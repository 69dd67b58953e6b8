"""Faults of a log that was taken from the reference, in whole or in part, as it is or rounded."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from analytic.kinematics import solve, solve_driven
from models.array import Array
from models.motion import LinkMotion, Motion
from models.scene import Scene
from reports.selftest import fault
from reports.selftest.log_faults import last, moved, noisy, taken, to_digits, with_link
from sim.engine import Run
from sim.run import run


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
    """Give all points and sliders the velocities of the closed form, likewise."""
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
_fault = partial(fault.Fault, "reference", scenes=(fault.FOURBAR, fault.SLIDER, fault.SHAPER))
FAULTS = (
    _fault("too-good", "the reference, handed back", "CC111", fault.switched(_handed_back)),
    _fault("too-good-degrees", "through degrees and back", "CC111", _each(_through_degrees)),
    _fault("too-good-next", "every number the next float", "CC111",
           _each(lambda motion: motion.each_series(lambda x: np.nextafter(x, np.inf)))),
    _fault("too-good-link", "of one link only", "CC111", _one("links", last)),
    _fault("too-good-point", "of one point only", "CC111", _one("points", _moving_pin)),
    _fault("too-good-slider", "of one slider only", "CC111",
           _one("sliders", lambda scene: next(iter(scene.sliders))),
           scenes=(fault.SLIDER, fault.SHAPER)),
    _fault("too-good-velocity", "of one velocity only", "CC111", fault.switched(_velocity),
           needs=fault.integrates),
    _fault("too-good-speeds", "of all points and sliders", "CC111", fault.switched(_speeds),
           needs=fault.integrates),
    _fault("too-good-gaps", "every gap is 0, as in truth", "CC111", _shut, needs=fault.integrates),
    _fault("too-good-rounded", "to few digits", "CC118", _spoilt(to_digits), 1e-7, "rad, L"),
    _fault("too-good-noisy", "with noise (normal)", "CC118", _spoilt(noisy), 1e-7, "rad, L"),
    _fault("too-good-crank", "at the logged crank angle", "CC111", fault.switched(_at_the_crank),
           needs=fault.integrates),
    _fault("too-good-finer", "in the finer runs only", "CC117", _finer_handed_back,
           says=("which no step of that size allows",), finer=True, needs=fault.integrates),
)  # fmt: skip
