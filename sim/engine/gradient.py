"""Derivatives of an engine's poses after some steps, by dimensions and masses of its scene.

The scene and its assembled start change together: what is differentiated is the whole run, from the
model's builder on. An engine with derivatives of its own has them from the tangents of its model
and of its start; from any other they follow by differences of whole runs.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.motion import State
from models.scene import Scene
from models.scene.joints import bodies
from sim.engine import BodyPose, Drive, Session, Settings

OFFSETS, WEIGHTS = (-2.0, -1.0, 1.0, 2.0), (1 / 12, -2 / 3, 2 / 3, -1 / 12)
"""Central difference of fourth order, in steps."""
STEP = 1e-4
"""Its step for what is exact to rounding, in units of a dimension: rounding leaves 1e-12."""
SWEEP = tuple(10.0 ** (-0.5 * n) for n in range(2, 13))
"""Steps from which the best is chosen for the runs of an engine, in units of a dimension."""
Opener = Callable[[Scene, State, Settings, float, Drive], Session]
"""Opening of a session, as `Engine.open`."""


@dataclass(frozen=True)
class Variation:
    """A scene at its start, and the same with one of ``names`` changed.

    ``shifted`` gives scene and assembled state with a dimension changed by so many units: the
    longest link, a radian, the mass itself. Raises CrankcheckError where it can not be assembled.
    """

    scene: Scene
    state: State
    names: tuple[str, ...]
    shifted: Callable[[str, float], tuple[Scene, State]]

    def neighbours(self, name: str, step: float = STEP) -> list[tuple[Scene, State]]:
        """Return scenes and states at the offsets of the difference."""
        return [self.shifted(name, offset * step) for offset in OFFSETS]


@dataclass(frozen=True)
class PoseGradient:
    """Poses after some steps, and their derivatives by a unit of each dimension, by one ``method``.

    ``places`` (K, B, 3) are x, y [m] and angle [rad] of the bodies of `models.scene.joints.bodies`;
    ``by`` has their derivatives, for all dimensions or some. With a ``refusal`` there are none.
    """

    method: str
    places: Array = field(default_factory=lambda: np.empty((0, 0, 3)))
    by: Mapping[str, Array] = field(default_factory=dict)
    refusal: str = ""


Differentiated = Callable[[Variation, Settings, float, Sequence[int]], Iterator[PoseGradient]]
"""An engine's derivatives after the given steps, with settings and step [s], the driver prescribed:
a result for each of its methods. Raises EngineError where it can not hold the scene."""


def slope(values: Sequence[Array], step: float = STEP) -> Array:
    """Return the derivative from values at the neighbours."""
    return np.asarray(sum(w * v for w, v in zip(WEIGHTS, values, strict=True)) / step)


def placed(scene: Scene, poses: Mapping[str, BodyPose]) -> Array:
    """Return the places of all bodies of poses, (T, B, 3)."""
    own = [poses[name] for name in bodies(scene)]
    return np.stack([np.column_stack([one.origin, one.theta]) for one in own], axis=1)


def differences(
    opened: Opener, variation: Variation, settings: Settings, dt_s: float, steps: Sequence[int]
) -> PoseGradient:
    """Differentiate whole runs by differences, each at the step of the sweep where it changes
    least from one to the next."""

    def after(scene: Scene, state: State) -> Array:
        return places_after(opened(scene, state, settings, dt_s, "prescribed"), scene, steps)

    by = {}
    for name in variation.names:
        found: list[Array] = []
        for step in SWEEP:
            if len(found) > 3:
                change = changes(found)
                if (change[-2:].min(axis=0) > change[:-2].min(axis=0)).all():
                    break  # rounding grows
            try:
                near = [after(*one) for one in variation.neighbours(name, step)]
            except CrankcheckError:  # too far to be assembled
                continue
            found.append(slope(near, step))
        if len(found) > 1:
            by[name] = steadiest(found)
    return PoseGradient("differences of runs", after(variation.scene, variation.state), by)


def places_after(session: Session, scene: Scene, steps: Sequence[int]) -> Array:
    """Return the places of all bodies after some steps, (K, B, 3), not numbers after the end of a
    run that ends before."""
    every = math.gcd(*steps)
    found = placed(scene, session.record(max(steps), every).poses.bodies)
    whole = np.full((max(steps) // every + 1, *found.shape[1:]), np.nan)
    whole[: len(found)] = found
    return np.asarray(whole[np.array(steps) // every])


def steadiest(found: Sequence[Array]) -> Array:
    """Return, for each K of arrays (K, ...) by falling step, the one that differs least from the
    next: errors of the step fall until those of rounding rise."""
    best = np.argmin(changes(found), axis=0)
    return np.array([found[n][k] for k, n in enumerate(best)])


def changes(found: Sequence[Array]) -> Array:
    """Return the largest change of each K from one array to the next, (F - 1, K)."""
    change = np.abs(np.diff(np.array(found), axis=0))
    change = change.reshape(len(found) - 1, len(found[0]), -1).max(axis=2)
    return np.where(np.isnan(change), np.inf, change)
