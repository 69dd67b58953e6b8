"""Faults of forces: the engine moves as it should, and what it says of its joints is wrong.

What leaves an inertia or a weight out, or comes of another mechanism, is the healthy log with the
difference that kinetostatics makes of it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from analytic.check.moved_scene import scaled
from analytic.forces.kinetostatics import forces
from models.array import Array
from models.forces import Forces, SliderForces
from models.scene import Scene
from reports.selftest.fault import FOURBAR, SHAPER, SLIDER, Fault, Plant, in_log
from reports.selftest.logs import WHEN, moved, noisy, spoilt
from sim.engine import Run
from sim.registry import engine

Change = Callable[[Scene, Run, Forces, float], Forces]
SLIDING = (SLIDER, SHAPER)
START = slice(5, 39)
"""Samples of the start, in which an engine takes up its pins."""
QUARTER = np.pi / 2


def _planted(change: Change) -> Plant:
    """The forces of a healthy log, changed by a size; as they are for a size of 0."""

    def changed(scene: Scene, done: Run, size: float) -> Run:
        motion = moved(done)
        if motion.forces is None or not size:
            return done
        return replace(
            done, motion=replace(motion, forces=change(scene, done, motion.forces, size))
        )

    return in_log(changed)


def _each(change: Callable[[Array, float], Array]) -> Plant:
    """Every series of forces, changed by a size."""
    return _planted(lambda scene, done, own, size: own.each_series(lambda x: change(x, size)))


def _pins(own: Forces, change: Callable[[str, str, Array], Array]) -> Forces:
    """The reactions of every pin and body changed."""
    pins = {
        point: {body: change(point, body, force) for body, force in bodies.items()}
        for point, bodies in own.pins.items()
    }
    return replace(own, pins=pins)


def _last_pin(own: Forces, change: Callable[[Array], Array]) -> Forces:
    """The reactions of the last pin changed."""
    last = list(own.pins)[-1]
    return _pins(own, lambda point, _, force: change(force) if point == last else force)


def _slid(own: Forces, change: Callable[[SliderForces], SliderForces]) -> Forces:
    """What the guides of all sliders exert, changed."""
    return replace(own, sliders={name: change(slider) for name, slider in own.sliders.items()})


def _largest_n(own: Forces) -> float:
    """The largest logged reaction [N]."""
    every = (force for bodies in own.pins.values() for force in bodies.values())
    return max(float(np.nanmax(np.abs(force))) for force in every)


def _in_body_frame(_: Scene, done: Run, own: Forces, size: float) -> Forces:
    """Vectors stand in the frames of the bodies that they act on."""
    links = moved(done).links

    def turned(_: str, body: str, force: Array) -> Array:
        if body not in links:
            return force
        turn = np.exp(-1j * size * links[body].theta)
        there = (force @ np.array([1.0, 1j])) * turn
        return np.stack([there.real, there.imag], axis=-1)

    return _pins(own, turned)


def _stamped(_: Scene, done: Run, own: Forces, steps: float) -> Forces:
    return replace(own, time_s=own.time_s + steps * done.dt_s)


def _late(_: Scene, done: Run, own: Forces, samples: float) -> Forces:
    """What stands in a row is what acted some samples before."""
    by = round(samples)
    return own.each_series(lambda x: np.concatenate([x[:by], x[:-by]]) if by else x)


def _of_the_giver(_: Scene, done: Run, own: Forces, size: float) -> Forces:
    """What a pin exerts on one body is said of the other, in the last pin."""
    last = list(own.pins)[-1]
    bodies = own.pins[last]
    reverse = dict(zip(bodies, reversed(list(bodies.values())), strict=True))
    return replace(own, pins={**own.pins, last: reverse})


def _pins_swapped(_: Scene, done: Run, own: Forces, size: float) -> Forces:
    """The last two pins of two bodies have each other's reactions."""
    one, other = [point for point, bodies in own.pins.items() if len(bodies) == 2][-2:]
    there = {one: own.pins[other].values(), other: own.pins[one].values()}
    swapped = {
        point: dict(zip(own.pins[point], values, strict=True)) for point, values in there.items()
    }
    return replace(own, pins={**own.pins, **swapped})


def _of_another(change: Callable[[Scene, float], Scene]) -> Change:
    """The forces that another scene would have, at the same instants."""

    def changed(scene: Scene, done: Run, own: Forces, size: float) -> Forces:
        known = np.isfinite(own.time_s)
        times = np.where(known, own.time_s, 0.0)
        right, wrong = (
            forces(each, times, bound=False, skip_dead_points=True)
            for each in (scene, change(scene, size))
        )
        pins = {
            point: {
                body: force + wrong.pins[point][body] - right.pins[point][body]
                for body, force in bodies.items()
            }
            for point, bodies in own.pins.items()
        }
        sliders = {
            name: SliderForces(
                slider.normal + wrong.sliders[name].normal - right.sliders[name].normal,
                slider.moment + wrong.sliders[name].moment - right.sliders[name].moment,
            )
            for name, slider in own.sliders.items()
        }
        torque = own.torque + wrong.torque - right.torque
        return replace(own, pins=pins, sliders=sliders, torque=torque)

    return changed


def _lighter(scene: Scene, share: float) -> Scene:
    """The mass and inertia of the link that is pinned to the driver are left out."""
    name = list(scene.links)[1]
    link, left = scene.links[name], 1.0 - share
    light = replace(link, mass_kg=left * link.mass_kg, inertia_kg_m2=left * link.inertia_kg_m2)
    return replace(scene, links={**scene.links, name: light})


def _turning_lighter(scene: Scene, share: float) -> Scene:
    """The inertia of that link alone."""
    name = list(scene.links)[1]
    link = scene.links[name]
    light = replace(link, inertia_kg_m2=(1.0 - share) * link.inertia_kg_m2)
    return replace(scene, links={**scene.links, name: light})


def _weighed(scene: Scene, more_m_s2: float) -> Scene:
    """Gravity is put on top of what there is."""
    x, y = scene.gravity_m_s2
    return replace(scene, gravity_m_s2=(x, y - more_m_s2))


def _copied(scene: Scene, done: Run, own: Forces, size: float) -> Forces:
    """The reference's forces, in the engine's place."""
    times = np.where(np.isfinite(own.time_s), own.time_s, 0.0)
    return forces(scene, times, bound=False, skip_dead_points=True)


def _smooth(series: Array, samples: float) -> Array:
    """The mean over so many samples around each."""
    reach = round(samples) // 2
    if not reach:
        return series
    rows = np.pad(series, [(reach, reach)] + [(0, 0)] * (series.ndim - 1), mode="edge")
    sums = np.cumsum(np.concatenate([np.zeros_like(rows[:1]), np.nan_to_num(rows)]), axis=0)
    width = 2 * reach + 1
    return np.asarray((sums[width:] - sums[:-width]) / width)


def _slipped(scene: Scene, done: Run, own: Forces, share: float) -> Forces:
    """The moment is taken about a point so far from the slider's along its line."""
    arm = share * scene.longest_m
    return _slid(own, lambda one: replace(one, moment=one.moment + arm * one.normal))


def _spoilt_pin(at: int | slice) -> Change:
    """The reactions of the last pin are off at some samples, opposite on its bodies."""

    def changed(_: Scene, done: Run, own: Forces, share: float) -> Forces:
        last = list(own.pins)[-1]
        signs = dict(zip(own.pins[last], (-1.0, 1.0), strict=False))
        off = share * _largest_n(own)

        def spoil(point: str, body: str, force: Array) -> Array:
            return spoilt(force, at, signs.get(body, 0.0) * off) if point == last else force

        return _pins(own, spoil)

    return changed


def _one_sided(_: Scene, done: Run, own: Forces, share: float) -> Forces:
    """A pin pushes one of its bodies, and less of it the other."""
    last = list(own.pins)[-1]
    body = next(iter(own.pins[last]))
    return _pins(
        own,
        lambda point, b, force: force * (1.0 + share) if (point, b) == (last, body) else force,
    )


def _without_last_pin(_: Scene, done: Run, own: Forces, size: float) -> Forces:
    return replace(own, pins=dict(list(own.pins.items())[:-1]))


def _nan_at_end(_: Scene, done: Run, own: Forces, size: float) -> Forces:
    return _last_pin(own, lambda force: spoilt(force, slice(-1, None), np.nan))


def _torque(change: Callable[[Array, float], Array]) -> Plant:
    return _planted(lambda scene, done, own, size: replace(own, torque=change(own.torque, size)))


def _aside(_: Scene, done: Run, own: Forces, size: float) -> Forces:
    """All reactions are turned by a quarter of a turn, as x for y would have it."""
    angle = size * QUARTER
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return _pins(own, lambda point, body, force: force @ turn)


def _dropped(_: Scene, done: Run, size: float) -> Run:
    return replace(done, motion=replace(moved(done), forces=None)) if size else done


def _reports(name: str) -> bool:
    return engine(name).forces_of != "nothing"


_fault = partial(Fault, "force", needs=_reports)
FAULTS = (
    _fault("force-sign", "all forces have the other sign", "CC120", _each(lambda x, _: -x)),
    _fault(
        "force-giver",
        "a pin's force on one body is said of the other",
        "CC120",
        _planted(_of_the_giver),
    ),
    _fault("force-body-frame", "vectors in the bodies' frames", "CC120", _planted(_in_body_frame)),
    _fault("force-turned", "x for y: a quarter of a turn", "CC120", _planted(_aside)),
    _fault("force-half-step", "stamped too late", "CC120", _planted(_stamped), 0.5, "steps"),
    _fault(
        "force-late",
        "a row has the forces of a row before",
        "CC120",
        _planted(_late),
        1.0,
        "sample",
        whole=True,
    ),
    _fault("force-far", "stamped far from its sample", "CC115", _planted(_stamped), 2.0, "steps"),
    _fault("pins-swapped", "two pins have each other's forces", "CC120", _planted(_pins_swapped)),
    _fault(
        "no-inertia",
        "mass and inertia of a link left out",
        "CC120",
        _planted(_of_another(_lighter)),
        1.0,
        "of it",
    ),
    _fault(
        "no-turning-inertia",
        "inertia of a link against turning left out",
        "CC123",
        _planted(_of_another(_turning_lighter)),
        1.0,
        "of it",
    ),
    _fault(
        "weight-added",
        "forces of a gravity that is not there",
        "CC120",
        _planted(_of_another(_weighed)),
        9.81,
        "m/s^2",
    ),
    _fault(
        "other-scene-forces",
        "forces of a larger scene",
        "CC120",
        _planted(_of_another(lambda scene, share: scaled(scene, 1.0 + share))),
        1e-2,
        "longer",
    ),
    _fault(
        "force-doubled",
        "all forces twice",
        "CC120",
        _each(lambda x, by: x * (1.0 + by)),
        1.0,
        "of it",
    ),
    _fault("force-of-kgf", "forces in kgf", "CC120", _each(lambda x, _: x / 9.80665)),
    _fault(
        "pin-open",
        "a pin's forces do not add up to 0",
        "CC124",
        _planted(_one_sided),
        1e-6,
        "of it",
    ),
    _fault(
        "normal-sign",
        "normal forces have the other sign",
        "CC121",
        _planted(lambda s, d, own, _: _slid(own, lambda one: replace(one, normal=-one.normal))),
        scenes=SLIDING,
    ),
    _fault(
        "moment-elsewhere",
        "moments about another point",
        "CC122",
        _planted(_slipped),
        1e-1,
        "L off",
        scenes=SLIDING,
    ),
    _fault(
        "flywheel-in",
        "the flywheel's share is in the torque",
        "CC123",
        _torque(lambda torque, share: torque * (1.0 - share)),
        1.0,
        "of it",
    ),
    _fault(
        "torque-off",
        "a torque of too much power",
        "CC123",
        _torque(lambda torque, share: torque * (1.0 + share)),
        1e-2,
        "of it",
    ),
    _fault("torque-sign", "what the driver exerts on the drive", "CC123", _torque(lambda x, _: -x)),
    _fault(
        "force-smoothed",
        "the mean over some samples",
        "CC120",
        _each(_smooth),
        41.0,
        "samples",
        whole=True,
    ),
    _fault(
        "force-noise",
        "noise on all forces (normal)",
        "CC120",
        _planted(lambda s, d, own, x: own.each_series(lambda f: noisy(f, x * _largest_n(own)))),
        1e-2,
        "F",
    ),
    _fault(
        "force-spike", "a reaction off at a sample", "CC120", _planted(_spoilt_pin(WHEN)), 1e-2, "F"
    ),
    _fault(
        "force-start", "reactions off at the start", "CC116", _planted(_spoilt_pin(START)), 0.5, "F"
    ),
    _fault(
        "force-floor",
        "a reaction off, within this step's limit",
        "CC125",
        _planted(_spoilt_pin(slice(None))),
        1e-3,
        "F",
        scenes=(FOURBAR,),
        finer=True,
    ),
    _fault("forces-copied", "forces of the reference", "CC111", _planted(_copied)),
    _fault("force-nan", "a reaction not a number at the end", "CC109", _planted(_nan_at_end)),
    _fault("pin-missing", "a pin is not in the log", "CC109", _planted(_without_last_pin)),
    _fault("forces-missing", "no force is in the log", "CC109", in_log(_dropped)),
)
