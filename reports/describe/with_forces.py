"""The forces of a solved motion, as shown: notes name uncertain, omitted or open ones.

Over a turn, instants in dead points have no numbers; a single position in one is refused.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from analytic.forces.kinetostatics import forces
from analytic.free.free_motion import FreeMotion
from analytic.kinematics import solve
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Forces, Motion
from models.scene import Scene, characteristics, driver
from reports.describe.free_motion import instants
from reports.output.numbers import count, listed

UNCERTAIN = 1e-6
"""Limit for a number smaller than its own bound: it is 0 where the bound is less than this part of
the largest of its kind, and unknown where it is more."""
ROUNDING = 1e-12
"""Part of the largest reaction below which one without a bound is 0."""
TURN = 721
"""Samples of a turn for drawings and largest forces."""
NAMED = 4
"""Number of angles of dead points that a note names."""


def with_forces(scene: Scene, motion: Motion, *, by_law: bool = True, bound: bool = True) -> Motion:
    """Return the motion with its reactions and driving torque, for a slider force.

    ``by_law`` is True if its times are instants of the driver's law, which determine the forces;
    else the whole motion itself is taken.

    Raises CrankcheckError as `analytic.forces.kinetostatics.forces`, for dead points only where all
    samples are in one; and for a load over time on a motion whose times are mere labels.
    """
    for load in () if by_law else scene.loads.values():
        if load.over == "time" and not isinstance(load.characteristic, characteristics.Constant):
            raise CrankcheckError(
                f"forces at an angle: loads.{load.name} follows time, and an angle has none; "
                "request a motion over time"
            )
    when = motion.time_s if by_law else motion
    acting = forces(scene, when, bound=bound, skip_dead_points=True)
    if acting.torque.size and np.all(np.isnan(acting.torque)):
        acting = forces(scene, when, bound=bound)  # tells why
    return replace(motion, forces=acting)


def with_reactions(free: FreeMotion, motion: Motion, *, bound: bool = True) -> Motion:
    """Return a motion of all bodies in free motion with its reactions. Raises CrankcheckError as
    `undriven`."""
    acting = free.with_forces(motion, bound=bound).forces
    assert acting is not None
    return replace(motion, forces=undriven(free.scene, acting))


def finely_loaded(free: FreeMotion) -> Motion:
    """Return a free motion closely sampled, with its reactions, without bounds."""
    time_s = np.linspace(0.0, free.until_s, instants(free))
    return with_reactions(free, free.at(time_s, bound=False), bound=False)


def undriven(scene: Scene, acting: Forces) -> Forces:
    """Return the forces of free motion, without the torque of a drive, which is rounding there.
    Where it is more, in a dead point of the driver, the reactions are no better, and left out
    (NaN). Raises CrankcheckError where redundant joints leave the reactions open."""
    if acting.undetermined:
        raise CrankcheckError(
            f"forces: {scene.name} is free and has only reactions, and {acting.undetermined}; "
            "solve it without forces"
        )
    off = np.abs(acting.torque) > UNCERTAIN * scene.longest_m * _largest(acting)
    free = acting.each_series(lambda series: np.where(off, np.nan, series.T).T)
    return replace(free, torque=0.0 * free.torque, bound=acting.bound, drive_unit="")


def _largest(acting: Forces) -> float:
    """Return the largest component of a reaction in pins and guides [N]."""
    series = [force for bodies in acting.pins.values() for force in bodies.values()]
    series += [slider.normal for slider in acting.sliders.values()]
    return max((float(np.nanmax(np.abs(each), initial=0.0)) for each in series), default=0.0)


def undriven_shown(acting: Forces) -> Forces:
    """Return the forces of free motion for readers, with 0 for rounding."""
    least = ROUNDING * _largest(acting)
    return cleaned_forces(acting).each_series(lambda x: np.where(np.abs(x) <= least, 0.0, x))


def turn_with_forces(scene: Scene, samples: int = TURN) -> Motion:
    """Return the first turn of the driver, both ends included, with its forces and their bounds."""
    time_s = np.linspace(0.0, scene.driver.law.period_s, samples)
    return with_forces(scene, solve(scene, time_s))


def force_notes(scene: Scene, motion: Motion) -> list[str]:
    """Return the undetermined forces, in sentences."""
    acting = motion.forces
    if acting is None:
        return []
    notes = [f"Reactions: none, as {acting.undetermined}."] if acting.undetermined else []
    return notes + left_out_notes(scene, motion)


def left_out_notes(scene: Scene, motion: Motion) -> list[str]:
    """Return the driver's places in dead points, and where friction locks, a sentence for each."""
    assert motion.forces is not None
    is_locked = motion.forces.has_equilibria(0)
    locked = np.flatnonzero(is_locked)
    dead = np.flatnonzero(np.isnan(motion.forces.torque) & ~is_locked)
    notes = []
    if dead.size:
        why = (
            f"the driving {scene.driver.effort} and the reactions are not determined there, and "
            "left out; near it they can have any size"
        )
        if not motion.forces.drive_unit:
            why = "the reactions are left out there; near it they are correct"
        notes.append(f"Dead point, {_where(scene, motion, dead)}: {why}.")
    if locked.size:
        notes.append(
            f"Locked, {_where(scene, motion, locked)}: friction grows there by more than the "
            "torque against it; there are no forces, and near it they can have any size."
        )
    return notes


def _where(scene: Scene, motion: Motion, samples: NDArray[np.intp]) -> str:
    if driver.driver_place(scene, motion) is None:
        return count(samples.size, "instant")
    places, unit = driver.driver_shown(scene, motion)[samples], driver.driver_unit(scene)
    places = np.round(places % 360.0 if unit == "deg" else places, 6)
    places = places % 360.0 if unit == "deg" else places
    angles = [f"{each:g} {unit}" for each in sorted(set(places.tolist()))]
    few = [*angles[:NAMED], "more"] if len(angles) > NAMED else angles
    return f"{scene.driver.joint} at {listed(few)}"


def force_certainty(scene: Scene, acting: Forces) -> str:
    """Return the uncertainty of forces, in a line; "" without a bound. Instants at which a bound is
    of the size of the forces themselves are counted apart; those at which it locks or may jam are
    left out.

    A couple is compared with that of the forces at the arms of the links: where it is 0, as in a
    dead centre, its own size is no measure of the loss.
    """
    bound = acting.bound
    if bound is None:
        return ""
    kinds: dict[str, list[tuple[Array, Array]]] = {"N": [], "N m": []}
    if acting.drive_unit:
        kinds[acting.drive_unit].append((acting.torque, bound.torque))
    for point, bodies in acting.pins.items():
        kinds["N"] += [(f, bound.pins[point][body]) for body, f in bodies.items()]
    for name, slider in acting.sliders.items():
        kinds["N"].append((slider.normal, bound.sliders[name].normal))
        kinds["N m"].append((slider.moment, bound.sliders[name].moment))
    apart = acting.has_equilibria(0) | acting.has_equilibria(2)  # reported in notes
    largest_n, largest_n_m = (
        max((float(np.nanmax(np.abs(f), initial=0.0)) for f, _ in pairs), default=0.0)
        for pairs in kinds.values()
    )
    sizes = {
        "N": max(largest_n, largest_n_m / scene.longest_m),
        "N m": max(largest_n_m, largest_n * scene.longest_m),
    }
    told, doubtful = [], np.isnan(acting.torque) & ~apart
    for unit, pairs in kinds.items():
        largest = sizes[unit]
        limits = np.array([np.where(apart, 0.0, limit) for _, limit in pairs])
        fit = np.where(limits <= UNCERTAIN * largest, limits, 0.0)
        doubtful = doubtful | np.any(limits > UNCERTAIN * largest, axis=0)
        if np.any(limits <= UNCERTAIN * largest):
            told.append(f"{float(fit.max()):.1e} {unit}")
    if apart.any() and apart.all():
        return (
            "Two equilibria here, as the mechanism may jam: these forces are those of less "
            "friction, without a bound."
        )
    if not told:
        return "Forces are not certain here: a dead point is near, or a load sets in."
    words = f"Forces certain to {', '.join(told)}"
    if doubtful.any():
        words += f", except at {count(int(doubtful.sum()), 'instant')}, in or near a dead point or "
        words += "where a load sets in or ends"
    return f"{words}."


def cleaned_forces(acting: Forces) -> Forces:
    """Return the forces for readers: numbers that are 0 within their own bound are 0, and those
    smaller than a large bound are NaN. Where the mechanism may jam there is no bound, and they
    stay."""
    bound = acting.bound
    if bound is None:
        return acting
    jams = acting.has_equilibria(2)

    def clean(series: Array, limit: Array) -> Array:
        """Clean a series (T,) or (T, 2) by its bound (T,)."""
        rows, limit = series.T, np.where(jams, 0.0, limit)
        largest = float(np.nanmax(np.abs(rows), initial=0.0))
        swallowed = np.where(limit <= max(UNCERTAIN * largest, 1e-9), 0.0, np.nan)
        return np.asarray(np.where(np.abs(rows) <= limit, swallowed, rows).T)

    clear = acting.each_series(clean, bound)
    return replace(clear, bound=bound, friction_solution=acting.friction_solution)
