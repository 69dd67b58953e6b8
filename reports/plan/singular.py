"""Singular positions: where the driver's angle no longer determines the motion.

A change point is none for the reference, which goes through it on the smooth branch, and says so.
"""

import math
from collections.abc import Iterable

import numpy as np

from analytic.forces.kinetostatics import forces
from analytic.kinematics import repeats_after, solve, solve_driven
from models.array import Array, Mask
from models.errors import CrankcheckError, few
from models.motion import Crossing, Motion
from models.scene import Scene
from models.scene.driver import driver_course, driver_unit, place_in_words
from reports.compare.hardness import near
from sim.registry import engine

SINGULAR = 1e-6
"""Sine of a transmission angle below which velocities are lost: rounding is over its square."""
GRID = 721
ZOOMS = 5
FINER = 65
"""Samples of a range, and of the neighbourhood of every smallest sine in each zoom."""
SHOWN = 4
SAME_RAD = 1e-3
"""Distance to a change point of its dyad below which a singular position is that change point."""


def refuse_singular(scene: Scene, duration_s: float) -> None:
    """Refuse a run through a position in which the motion is not determined, change points apart.

    The sine of a dyad falls and rises like the letter V there, mostly between two samples: its
    smallest values over the driver's range are searched, and refined.

    Raises CrankcheckError that names scene, driver angle and dyad, and ReachError for an angle that
    cannot be reached.
    """
    low, high = _range(scene, duration_s)
    theta = np.linspace(low, high, 1 + (GRID - 1) * max(1, round((high - low) / math.tau)))
    motion = _steady(scene, theta)
    sines = {key: np.abs(sine) for key, sine in motion.conditioning.items()}
    # A row for every valley of every dyad: all are looked at in one solution for each zoom.
    dyad = [key for key, sine in sines.items() for _ in range(np.count_nonzero(_valleys(sine)))]
    places = np.concatenate([theta[_valleys(sine)] for sine in sines.values()] or [np.zeros(0)])
    smallest = np.full_like(places, np.inf)
    width = (high - low) / (theta.size - 1)
    for _ in range(ZOOMS if places.size else 0):
        around = np.clip(places[:, None] + np.linspace(-width, width, FINER), low, high)
        every = _steady(scene, around.ravel()).conditioning
        looks = np.stack(
            [np.abs(every[key]).reshape(around.shape)[row] for row, key in enumerate(dyad)]
        )
        best = np.arange(len(around)), np.argmin(looks, axis=1)
        places, smallest = around[best], looks[best]
        width *= 2.0 / (FINER - 1)
    for key, place, sine in zip(dyad, places, smallest, strict=True):
        if sine < SINGULAR and not _is_passed(motion.crossings, key, np.array([place])).any():
            at = place_in_words(float(place), scene.driver.unit)
            raise CrankcheckError(
                f"{scene.name}: at driver {at} the dyad of {key} is singular: the motion is not "
                "determined there, so no engine can be compared with it; choose lengths, or a "
                "range of the driver, away from it"
            )


def passage_note(scene: Scene, duration_s: float) -> str:
    """Return the change points that a run goes through, for its reader; "" where there is none."""
    time_s = np.linspace(0.0, duration_s, GRID)
    crossings = solve(scene, time_s, links=(), points=(), sliders=(), bound=False).crossings
    if not crossings:
        return ""
    passes = _places(scene, crossings)
    return f"{scene.name}: passes {passes}; the reference continues the smooth branch"


def continued_note(scene: Scene, motion: Motion) -> str:
    """Return the change points on the way of a reference from its start; "" where there is none."""
    if not motion.crossings:
        return ""
    return f"continued smoothly through {_places(scene, motion.crossings)}"


def singular_note(scene: Scene, motion: Motion) -> str:
    """Return the singular samples of a reference, for the reader of a table; "" where none is."""
    theta = driver_course(scene, motion)[0]
    places = [
        f"{place_in_words(float(place), scene.driver.unit)} ({key})"
        for key, sine in motion.conditioning.items()
        for place in theta[(np.abs(sine) < SINGULAR) & ~_is_passed(motion.crossings, key, theta)]
    ]
    if not places:
        return ""
    return f"singular at {few(places, SHOWN)}: rates are not determined there"


def _range(scene: Scene, duration_s: float) -> tuple[float, float]:
    """Return the driver angles of a run, at most until the mechanism repeats [rad]."""
    theta = scene.driver.law.at(np.linspace(0.0, duration_s, GRID))[0]
    low = float(np.min(theta))
    return low, min(float(np.max(theta)), low + repeats_after(scene))


def _steady(scene: Scene, theta: Array) -> Motion:
    """Return the mechanism's conditioning at driver angles, at unit speed."""
    one, zero = np.ones_like(theta), np.zeros_like(theta)
    return solve_driven(scene, theta, one, zero, links=(), points=(), sliders=(), bound=False)


def _is_passed(crossings: Iterable[Crossing], key: str, theta: Array) -> Mask:
    """Return True where driver angles are in a change point of a dyad."""
    return near((crossing for crossing in crossings if crossing.dyad == key), theta, SAME_RAD)


def _places(scene: Scene, crossings: Iterable[Crossing]) -> str:
    angles: dict[str, list[str]] = {}
    unit = driver_unit(scene)
    by = 1.0 if unit == "m" else math.degrees(1.0)
    for crossing in crossings:
        angles.setdefault(crossing.dyad, []).append(f"{crossing.driver_rad * by:.6g}")
    words = [
        f"the change point{'s' * (len(each) > 1)} of {key} at driver {', '.join(each)} {unit}"
        for key, each in angles.items()
    ]
    return " and ".join(words)


def _valleys(sine: Array) -> Mask:
    """Return where a series is a local minimum, smaller than one neighbour at least, (T,) bool."""
    before = np.concatenate([[np.inf], sine[:-1]])
    after = np.concatenate([sine[1:], [np.inf]])
    return np.asarray((sine <= before) & (sine <= after) & ((sine < before) | (sine < after)))


def refuse_short_tables(scene: Scene, duration_s: float) -> None:
    """Refuse a run in which a load has no magnitude, over the displacements of a whole period and
    the times of the run. Raises CrankcheckError that names the load and the range that it needs."""
    loads = [load for load in scene.loads.values() if load.over != "angle"]
    if not loads:
        return
    turn = np.linspace(0.0, scene.driver.law.period_s, GRID)
    sliders = [load.slider for load in loads if load.slider is not None]
    motion = solve(scene, turn, links=(), points=(), sliders=sliders, bound=False)
    for load in loads:
        if load.over == "time":
            load.magnitude(np.array([0.0, duration_s]))
        elif load.slider is not None:
            load.magnitude(motion.sliders[load.slider].displacement)


def refuse_forceless(scene: Scene, duration_s: float) -> None:
    """Refuse a scene whose forces are not known at the start and the end of a run. Raises
    CrankcheckError where nothing has a mass and nothing loads it, or the table of a load ends
    before."""
    forces(scene, np.array([0.0, duration_s]), bound=False, skip_dead_points=True)


def gives_forces(name: str) -> bool:
    """True if an engine reports forces."""
    return engine(name).forces_of != "nothing"


def silent_note(engines: Iterable[str]) -> str:
    """Return the note on engines that report no forces and are run without; "" where all do."""
    silent = [name for name in dict.fromkeys(engines) if not gives_forces(name)]
    if not silent:
        return ""
    reasons = ((name, engine(name).no_forces) for name in silent)
    named = " and ".join(f"{name} ({why})" if why else name for name, why in reasons)
    return f"forces: {named} reports none, and runs without"
