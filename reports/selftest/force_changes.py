"""Change the forces of a log, and leave its motion.

A log without an inertia or a weight, or of another mechanism, is the healthy log with the
difference that kinetostatics makes of it.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from analytic.forces.kinetostatics import forces
from models.array import Array
from models.motion import Forces, SliderForces
from models.scene import Scene
from models.scene.characteristics import Sine
from models.scene.loads import Load
from reports.selftest.fault import Plant, in_log
from reports.selftest.log_edits import last, moved, spoilt
from sim.engine import Run
from sim.registry import engine

Change = Callable[[Scene, Run, Forces, float], Forces]
QUARTER = np.pi / 2


def in_forces(change: Change) -> Plant:
    """Change the forces of a healthy log by a size; leave them for a size of 0."""

    def changed(scene: Scene, done: Run, size: float) -> Run:
        motion = moved(done)
        if motion.forces is None or not size:
            return done
        return replace(
            done, motion=replace(motion, forces=change(scene, done, motion.forces, size))
        )

    return in_log(changed)


def each_force(change: Callable[[Array, float], Array]) -> Plant:
    """Change every series of forces by a size."""
    return in_forces(lambda scene, done, own, size: own.each_series(lambda x: change(x, size)))


def each_pin(own: Forces, change: Callable[[str, str, Array], Array]) -> Forces:
    """Change the reactions of every pin and body."""
    pins = {
        point: {body: change(point, body, force) for body, force in bodies.items()}
        for point, bodies in own.pins.items()
    }
    return replace(own, pins=pins)


def _last_pin(own: Forces, change: Callable[[Array], Array]) -> Forces:
    """Change the reactions of the last pin."""
    last = list(own.pins)[-1]
    return each_pin(own, lambda point, _, force: change(force) if point == last else force)


def each_slider(own: Forces, change: Callable[[SliderForces], SliderForces]) -> Forces:
    """Change the forces of the guides of all sliders."""
    return replace(own, sliders={name: change(slider) for name, slider in own.sliders.items()})


def largest_n(own: Forces) -> float:
    """Return the largest logged reaction [N]."""
    every = (force for bodies in own.pins.values() for force in bodies.values())
    return max(float(np.nanmax(np.abs(force))) for force in every)


def in_body_frame(_: Scene, done: Run, own: Forces, size: float) -> Forces:
    """Turn vectors into the frames of the bodies that they act on."""
    links = moved(done).links

    def turned(_: str, body: str, force: Array) -> Array:
        if body not in links:
            return force
        turn = np.exp(-1j * size * links[body].theta)
        there = (force @ np.array([1.0, 1j])) * turn
        return np.stack([there.real, there.imag], axis=-1)

    return each_pin(own, turned)


def stamped(_: Scene, done: Run, own: Forces, steps: float) -> Forces:
    return replace(own, time_s=own.time_s + steps * done.dt_s)


def rows_late(_: Scene, done: Run, own: Forces, samples: float) -> Forces:
    """Put into each row the forces of some samples before."""
    by = round(samples)
    return own.each_series(lambda x: np.concatenate([x[:by], x[:-by]]) if by else x)


def of_the_giver(_: Scene, done: Run, own: Forces, size: float) -> Forces:
    """Exchange the reactions of both bodies in the last pin."""
    last = list(own.pins)[-1]
    bodies = own.pins[last]
    reverse = dict(zip(bodies, reversed(list(bodies.values())), strict=True))
    return replace(own, pins={**own.pins, last: reverse})


def pins_swapped(_: Scene, done: Run, own: Forces, size: float) -> Forces:
    """Exchange the reactions of the last two pins of two bodies."""
    one, other = [point for point, bodies in own.pins.items() if len(bodies) == 2][-2:]
    there = {one: own.pins[other].values(), other: own.pins[one].values()}
    swapped = {
        point: dict(zip(own.pins[point], values, strict=True)) for point, values in there.items()
    }
    return replace(own, pins={**own.pins, **swapped})


def of_another(change: Callable[[Scene, float], Scene]) -> Change:
    """Return the forces that another scene would have, at the same instants."""

    return lambda scene, _, own, size: changed_by_scene(own, scene, change(scene, size))


def changed_by_scene(own: Forces, right: Scene, wrong: Scene) -> Forces:
    """Return the forces of a log, with the difference of a wrong scene to the right one."""
    times = np.where(np.isfinite(own.time_s), own.time_s, 0.0)
    before, after = (
        forces(each, times, bound=False, skip_dead_points=True) for each in (right, wrong)
    )
    pins = {
        point: {
            body: force + after.pins[point][body] - before.pins[point][body]
            for body, force in bodies.items()
        }
        for point, bodies in own.pins.items()
    }
    sliders = {
        name: SliderForces(
            slider.normal + after.sliders[name].normal - before.sliders[name].normal,
            slider.moment + after.sliders[name].moment - before.sliders[name].moment,
        )
        for name, slider in own.sliders.items()
    }
    torque = own.torque + after.torque - before.torque
    return replace(own, pins=pins, sliders=sliders, torque=torque)


def lighter(scene: Scene, share: float) -> Scene:
    """Leave out the mass and inertia of the link that is pinned to the driver."""
    name = list(scene.links)[1]
    link, left = scene.links[name], 1.0 - share
    light = replace(link, mass_kg=left * link.mass_kg, inertia_kg_m2=left * link.inertia_kg_m2)
    return replace(scene, links={**scene.links, name: light})


def turning_lighter(scene: Scene, share: float) -> Scene:
    """Leave out the inertia of that link alone."""
    name = list(scene.links)[1]
    link = scene.links[name]
    light = replace(link, inertia_kg_m2=(1.0 - share) * link.inertia_kg_m2)
    return replace(scene, links={**scene.links, name: light})


def weighed(scene: Scene, more_m_s2: float) -> Scene:
    """Add to gravity."""
    x, y = scene.gravity_m_s2
    return replace(scene, gravity_m_s2=(x, y - more_m_s2))


def of_reference(scene: Scene, done: Run, own: Forces, size: float) -> Forces:
    """Put the reference's forces in the engine's place."""
    times = np.where(np.isfinite(own.time_s), own.time_s, 0.0)
    return forces(scene, times, bound=False, skip_dead_points=True)


def smoothed(series: Array, samples: float) -> Array:
    """Return the mean over so many samples around each."""
    reach = round(samples) // 2
    if not reach:
        return series
    rows = np.pad(series, [(reach, reach)] + [(0, 0)] * (series.ndim - 1), mode="edge")
    sums = np.cumsum(np.concatenate([np.zeros_like(rows[:1]), np.nan_to_num(rows)]), axis=0)
    width = 2 * reach + 1
    return np.asarray((sums[width:] - sums[:-width]) / width)


def about_another_point(scene: Scene, done: Run, own: Forces, share: float) -> Forces:
    """Take the moment about a point so far from the slider's along its line."""
    arm = share * scene.longest_m
    return each_slider(own, lambda one: replace(one, moment=one.moment + arm * one.normal))


def spoilt_pin(at: int | slice) -> Change:
    """Change the reactions of the last pin at some samples, opposite on its bodies."""

    def changed(_: Scene, done: Run, own: Forces, share: float) -> Forces:
        last = list(own.pins)[-1]
        signs = dict(zip(own.pins[last], (-1.0, 1.0), strict=False))
        off = share * largest_n(own)

        def spoil(point: str, body: str, force: Array) -> Array:
            return spoilt(force, at, signs.get(body, 0.0) * off) if point == last else force

        return each_pin(own, spoil)

    return changed


def one_sided(_: Scene, done: Run, own: Forces, share: float) -> Forces:
    """Let a pin push one of its bodies more than the other."""
    last = list(own.pins)[-1]
    body = next(iter(own.pins[last]))
    return each_pin(
        own,
        lambda point, b, force: force * (1.0 + share) if (point, b) == (last, body) else force,
    )


def without_last_pin(_: Scene, done: Run, own: Forces, size: float) -> Forces:
    return replace(own, pins=dict(list(own.pins.items())[:-1]))


def nan_at_end(_: Scene, done: Run, own: Forces, size: float) -> Forces:
    return _last_pin(own, lambda force: spoilt(force, slice(-1, None), np.nan))


def in_torque(change: Callable[[Array, float], Array]) -> Plant:
    return in_forces(lambda scene, done, own, size: replace(own, torque=change(own.torque, size)))


def turned_aside(_: Scene, done: Run, own: Forces, size: float) -> Forces:
    """Turn all reactions by a quarter of a turn, as x for y would."""
    angle = size * QUARTER
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return each_pin(own, lambda point, body, force: force @ turn)


def dropped(_: Scene, done: Run, size: float) -> Run:
    return replace(done, motion=replace(moved(done), forces=None)) if size else done


def gives(name: str) -> bool:
    return engine(name).forces_of != "nothing"


def of_load(wrong: Callable[[Load, Run, float], Load | None]) -> Change:
    """Let a load, as large as the largest reaction, be felt otherwise than it acts, or not at all.
    Loads add up linearly, so that the scene need have none."""

    def changed(scene: Scene, done: Run, own: Forces, size: float) -> Forces:
        name = last(scene)
        point = [each for each in scene.links[name].points if each not in scene.ground][-1]
        right = Load("push", name, point, Sine(largest_n(own), scene.driver.law.period_s))
        felt = wrong(right, done, size)
        return changed_by_scene(own, _loaded(scene, right), _loaded(scene, felt) if felt else scene)

    return changed


def _loaded(scene: Scene, load: Load) -> Scene:
    return replace(scene, loads={**scene.loads, load.name: load})


def load_late(load: Load, done: Run, steps: float) -> Load:
    """Return a load over time, felt some steps later."""
    return replace(load, characteristic=load.characteristic.carried(1.0, shift=steps * done.dt_s))


def load_in_body(load: Load, _: Run, size: float) -> Load:
    """Return a load along an axis of the body, not of the ground."""
    return replace(load, frame="body")
