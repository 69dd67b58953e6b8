"""Start of a session: with the requested scene, at its state, at any time."""

from collections.abc import Iterator
from dataclasses import replace
from typing import get_args

import numpy as np

from models.errors import EngineError
from models.files.reading import load_scene, shipped
from models.scene import Scene
from reports.contract.subject import NotTriedError, Subject, clause
from sim.engine import Drive
from sim.engine.measure import motion
from sim.own_engine.watched import failure
from sim.run.check import rounding_of

PLACE = 1e-12
"""Largest distance of a point from its place, over the longest link or coordinate, in double
precision."""
LATER = 0.3
"""Part of a period."""


@clause(
    "EC21",
    "a session opens as the scene, at the state, with closed joints",
    "Another mass, place or speed at the start is another mechanism, whatever comes after it.",
    "Take masses from mass_of, centres from centre_of, places and velocities from "
    "frames(scene, state, velocity_shift * dt_s), and read all of them back from the engine.",
)
def _the_scene(subject: Subject) -> Iterator[str]:
    by_profile = {name: _other_scene(subject, name) for name in subject.engine.profiles}
    for text in dict.fromkeys(filter(None, by_profile.values())):
        profiles = [name for name, own in by_profile.items() if own == text]
        yield text if len(profiles) == len(by_profile) else f"profile {profiles[0]}: {text}"


def is_other(subject: Subject) -> bool:
    """True if a session is not the scene to begin with; one clause reports it."""
    return any(_the_scene.check(subject))


def _other_scene(subject: Subject, profile: str) -> str:
    facts = subject.opened(profile).facts()
    try:
        subject.refuse_other_model(subject.start, facts, subject.dt_s(), "prescribed")
    except EngineError as error:
        return str(error)
    held = motion(subject.scene, facts.start).state(0)
    for point, place in subject.start.position.items():
        scale = max(subject.scene.longest_m, *map(abs, place))
        off = float(np.hypot(*np.subtract(held.position[point], place)))
        if not off <= max(PLACE, rounding_of(subject.engine.precision)) * scale:
            return f"point {point} is off by {off:.2g} m at the start"
    return ""


@clause(
    "EC22",
    "a session may start at any time of the driver's law",
    "A run that goes on from another, or from a later state, is driven by the time of its state.",
    "Count time from state.time_s, in Poses.time_s and in the drive of the crank.",
)
def _at_any_time(subject: Subject) -> Iterator[str]:
    if is_other(subject):
        raise NotTriedError("it does not open as the scene at time 0 (EC21)")
    later = subject.at(LATER * subject.scene.driver.law.period_s)
    session = subject.opened(start=later)
    try:
        subject.refuse_other_model(later, session.facts(), subject.dt_s(), "prescribed")
    except EngineError as error:
        yield f"from {later.time_s:.3g} s on: {error}"
    times = session.record(4, 2).poses.time_s
    wanted = later.time_s + subject.dt_s() * np.array([0.0, 2.0, 4.0])
    if not np.allclose(times, wanted, rtol=1e-12, atol=0.0):
        yield f"from {later.time_s:.6g} s on the samples are at {times}, not {wanted} s"
    elif (off := _crank_off(subject, session.read().bodies, times[-1])) > subject.beyond(
        PLACE**0.5
    ):
        yield f"a start at {later.time_s:.3g} s: the crank is off by {off:.2g} rad 4 steps later"


def _crank_off(subject: Subject, bodies: object, time_s: float) -> float:
    crank = bodies[subject.scene.driver.link]  # type: ignore[index]  # poses by name
    angle = subject.scene.driver.law.at(np.array([time_s]))[0][0]
    return float(abs(np.remainder(crank.theta[0] - angle + np.pi, 2 * np.pi) - np.pi))


@clause(
    "EC71",
    "an unsupported scene or drive is refused with EngineError, before the first step",
    "A refusal is a row with a reason; anything else looks like a fault of the scene.",
    "Raise EngineError in open, and name the missing feature.",
    of_scenes=False,
)
def _every_scene(subject: Subject) -> Iterator[str]:
    scenes, other = [load_scene(name) for name in shipped()], is_other(subject)
    for scene in [*scenes, _massless(load_scene("fourbar-lecture-1"))]:
        for drive in get_args(Drive):
            at = f"{scene.name}, {drive}" + (" (a link without mass)" * (scene not in scenes))
            try:
                session = subject.in_scene(scene).opened(drive=drive)
            except NotTriedError as refused:
                if not str(refused).strip():
                    yield f"{at}: refused without a reason"
                continue
            except Exception as error:  # any error of an engine counts
                yield f"{at}: open raised {failure(error)}, in place of EngineError"
                continue
            try:
                facts, _ = session.facts(), session.record(20, 1)
                own = subject.in_scene(scene)
                if not other:
                    own.refuse_other_model(own.start, facts, own.dt_s(), drive)
            except EngineError as error:
                yield f"{at}: not refused, and {error}"
            except Exception as error:  # as above
                yield f"{at}: not refused, and then raised {failure(error)}"


def _massless(scene: Scene) -> Scene:
    """Return the scene with a link that nothing but its joints could move."""
    link = next(name for name in reversed(list(scene.links)) if name != scene.driver.link)
    bare = replace(scene.links[link], mass_kg=0.0, inertia_kg_m2=0.0)
    return replace(scene, links={**scene.links, link: bare})
