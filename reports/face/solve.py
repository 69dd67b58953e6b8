"""`solve`: the closed form alone, as a motion that can be shown."""

from __future__ import annotations

from collections.abc import Iterable
from typing import cast

import numpy as np
from numpy.typing import ArrayLike

from analytic import kinematics
from analytic.result import Selection
from models.array import Array
from models.errors import CrankcheckError
from models.laws import MOST_TURNS
from models.motion import Motion
from models.samples import samples
from models.scene import Scene
from reports.describe.with_forces import with_forces
from reports.face.arguments import SceneLike, is_true, scene_of
from reports.face.elastic_choice import ElasticChoice
from reports.face.solution import Solution
from reports.face.told import told_at_the_call

SAMPLES = 361
"""Instants of a period, both ends included, where none are given: as in a file of the command."""
Names = str | Iterable[str] | None


@told_at_the_call
def solve(
    scene: SceneLike,
    time_s: ArrayLike | None = None,
    *,
    links: Names = None,
    points: Names = None,
    sliders: Names = None,
    bound: bool = True,
    forces: bool = False,
    modes: int | None = None,
    axial_modes: int | None = None,
    elements: int | None = None,
    shape: str | None = None,
    linear: bool = False,
) -> Solution:
    """The motion of a scene at some times, in closed form; of one that is let go, its free motion,
    integrated (`FreeSolution`); of one with elastic links, how these bend (`ElasticSolution`).

    Parameters
    ----------
    scene : Scene, str or path
        A shipped name, the path of a scene file, or a scene.
    time_s : ArrayLike or None
        Times [s], shape (T,), in any order; 361 over a period of the driver for None.
    links, points, sliders : str, Iterable[str] or None
        What to return, by one name or several; None is all, () is none.
    bound : bool
        Carry error bounds (about three times the work).
    forces : bool
        Have the reactions and the driving torque as well; NaN in dead points of the driver.
    modes, axial_modes, elements : int or None
        Of elastic links: sines across and along each, or beam elements.
    shape : str or None
        What elastic links start with: ``periodic``, ``quasi-static`` or ``straight``; None is what
        the scene says.
    linear : bool
        Leave out that a bent link is shorter.

    Raises
    ------
    CrankcheckError
        A scene, times or names that are none; a StructureError for a mechanism without a closed
        form, a ReachError for a driver angle that it can not be assembled in. Of forces: a scene
        without mass and load, or no instant outside of dead points.
    """
    scene = scene_of(scene)
    asked = ElasticChoice(modes, axial_modes, elements, shape, linear)
    if not scene.elastic:
        asked.refuse_of_rigid(scene)
    if time_s is None:
        time_s = np.linspace(0.0, scene.driver.law.period_s, SAMPLES)
    if scene.elastic:
        return _elastic_solution(scene, time_s, links, points, sliders, asked, forces=forces)
    if scene.is_free:
        return _free_solution(scene, time_s, links, points, sliders, bound=bound, forces=forces)
    # Whatever the times are, they are looked at there.
    motion = kinematics.solve(
        scene,
        cast(Array, time_s),
        links=links,
        points=points,
        sliders=sliders,
        bound=is_true(bound, "bound"),
    )
    _refuse_far(scene, motion)
    if is_true(forces, "forces"):
        motion = with_forces(scene, motion, bound=bound)
    return Solution(**vars(motion), scene=scene)


def _free_solution(
    scene: Scene,
    time_s: ArrayLike,
    links: Names,
    points: Names,
    sliders: Names,
    *,
    bound: bool,
    forces: bool,
) -> Solution:
    """The free motion of a scene. Raises CrankcheckError."""
    from reports.face.free_solution import free_solution  # slow to import

    if is_true(forces, "forces"):
        raise CrankcheckError(f"forces=True: {scene.name} is let go, and has no driving torque")
    wanted = Selection.of(scene, links, points, sliders)
    instants = samples(time_s, "time_s")
    return free_solution(scene, instants, wanted, bound=is_true(bound, "bound"))


def _elastic_solution(
    scene: Scene,
    time_s: ArrayLike,
    links: Names,
    points: Names,
    sliders: Names,
    asked: ElasticChoice,
    *,
    forces: bool,
) -> Solution:
    """The motion of a scene with elastic links. Raises CrankcheckError."""
    from reports.face.elastic_solution import elastic_solution  # slow to import

    if is_true(forces, "forces") and scene.is_free:
        raise CrankcheckError(f"forces=True: {scene.name} is let go, and has no driving torque")
    wanted = Selection.of(scene, links, points, sliders)
    return elastic_solution(scene, samples(time_s, "time_s"), wanted, asked, forces=forces)


def _refuse_far(scene: Scene, motion: Motion) -> None:
    """Refuse times so late that the place within a turn is lost. Raises CrankcheckError."""
    far_s = float(np.max(np.abs(motion.time_s), initial=0.0))
    turns = far_s / scene.driver.law.period_s
    if turns > MOST_TURNS:
        raise CrankcheckError(
            f"time_s: t = {far_s:.6g} s is {turns:.3g} turns of {scene.name}, and at most "
            f"{MOST_TURNS:g} leave the digits that tell where in a turn it is; "
            "give times in seconds"
        )


@told_at_the_call
def solve_driven(
    scene: SceneLike,
    theta: ArrayLike,
    omega: ArrayLike,
    alpha: ArrayLike,
    time_s: ArrayLike | None = None,
    *,
    links: Names = None,
    points: Names = None,
    sliders: Names = None,
    bound: bool = True,
    forces: bool = False,
) -> Solution:
    """The motion of a scene whose driver has given angles, rates and accelerations.

    Parameters
    ----------
    theta, omega, alpha : ArrayLike
        Angles [rad], rates [rad/s] and accelerations [rad/s^2] of the driver, shape (T,), taken as
        exact; one rate, or one acceleration, counts for all samples.
    time_s : ArrayLike or None
        Times [s] that label the samples, and nothing else.
    scene, links, points, sliders, bound, forces
        As of `solve`; forces need the whole motion.

    Raises
    ------
    CrankcheckError
        As `solve`.
    """
    scene = scene_of(scene)
    motion = kinematics.solve_driven(
        scene,
        cast(Array, theta),
        cast(Array, omega),
        cast(Array, alpha),
        cast(Array | None, time_s),
        links=links,
        points=points,
        sliders=sliders,
        bound=is_true(bound, "bound"),
    )
    if is_true(forces, "forces"):
        motion = with_forces(scene, motion, by_law=False, bound=bound)
    return Solution(**vars(motion), scene=scene)
