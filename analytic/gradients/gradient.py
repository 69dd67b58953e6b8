"""Gradient of the reference: derivatives of a motion and its forces, each with its bound.

The motion of a scene changes with its dimensions (`analytic.gradients.dimensions`) at the same time
and in the same assembly; by implicit differentiation of all its joints the derivatives are as
exact as the motion. Torque and reactions are linear in masses and inertias: their derivatives by
one are the forces that one unit of it alone exerts, its weight included.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from analytic.dyads.chunk import driver_scale
from analytic.forces.kinetostatics import forces as forces_of
from analytic.gradients.dimensions import dimensions
from analytic.gradients.linearised import Linearised, linearised
from analytic.gradients.varying import Varying
from analytic.kinematics import chunks, solve, solve_driven, unit_chunk
from analytic.result import Selection
from models.array import Array, samples
from models.errors import CrankcheckError, suggestion
from models.files.inputs import names_in
from models.motion import Bound, Forces, LinkMotion, Motion, PointMotion, SliderMotion
from models.scene import Scene

STRETCH = 1024
"""Samples at a time: their matrices fit the cache."""


@dataclass(frozen=True)
class Gradient:
    """Derivatives of a motion, sampled at ``time_s`` (T,).

    ``by`` has them by dimension, each as a motion of derivatives: ``links["rocker"].theta`` of
    ``by["crank"]`` is that of the rocker's angle by the length of the crank [rad/m], ``omega`` and
    ``alpha`` those of its rate and acceleration; points and sliders likewise. ``bound`` of each
    bounds their errors, infinite where nothing is certain. ``forces`` has the derivatives of torque
    and reactions by mass [N/kg, N m/kg] or inertia, such as ``rocker.mass`` and ``rocker.inertia``.
    ``locked`` are dimensions without a derivative: redundant links fit at their present value only.
    """

    scene: Scene
    motion: Motion
    by: Mapping[str, Motion]
    forces: Mapping[str, Forces] = field(default_factory=dict)
    locked: tuple[str, ...] = ()

    @property
    def time_s(self) -> Array:
        return self.motion.time_s


def gradient(
    scene: Scene, time_s: Array, by: str | Iterable[str] | None = None, *, forces: bool = False
) -> Gradient:
    """Return the derivatives of the motion of a scene at the given times.

    Parameters
    ----------
    scene : Scene
        The mechanism with its driver's law.
    time_s : Array
        Times [s], shape (T,).
    by : str, Iterable[str] or None
        Names of dimensions, masses and inertias; None is all dimensions.
    forces : bool
        With all masses and inertias where ``by`` is None.

    Raises
    ------
    StructureError, ReachError
        As `analytic.kinematics.solve`.
    CrankcheckError
        An unknown name, times that are no numbers; of masses Coulomb's friction, with which forces
        are not linear in them.
    """
    time_s, known, weighed = samples(time_s, "time_s"), dimensions(scene), masses(scene)
    names = [*known, *(weighed if forces else ())] if by is None else names_in(by, "by")
    for name in names:
        if name not in known and name not in weighed:
            have = suggestion(name, (*known, *weighed), "there are")
            raise CrankcheckError(f"{scene.name}: no dimension, mass or inertia {name}; {have}")
    wanted = {name: known[name] for name in names if name in known}
    motion, parts = solve(scene, time_s), []
    for first in range(0, len(time_s) if wanted else 0, STRETCH):
        part = time_s[first : first + STRETCH]
        for _, chunk in chunks(scene, part, bound=True):
            parts.append(_motions(linearised(scene, chunk, wanted), part))
    locked = {name for _, each in parts for name in each}
    found = {n: Motion.joined([each[n] for each, _ in parts]) for n in wanted if n not in locked}
    acting = {
        name: _unit_forces(scene, time_s, *weighed[name]) for name in names if name in weighed
    }
    return Gradient(scene, motion, found, acting, tuple(n for n in wanted if n in locked))


def gradient_at(scene: Scene, drive: Array, by: Iterable[str]) -> tuple[Motion, dict[str, Motion]]:
    """Return the motion and its derivatives by dimensions at coordinates of the driver [rad or m],
    (T,), the driver at 1 rad/s, without bounds. Raises as `gradient`."""
    known, theta = dimensions(scene), drive / driver_scale(scene)
    motion = solve_driven(scene, drive, np.ones(1), np.zeros(1), bound=False)
    found = linearised(scene, unit_chunk(scene, theta, bound=False), {n: known[n] for n in by})
    return motion, _motions(found, motion.time_s)[0]


def masses(scene: Scene) -> dict[str, tuple[str, str]]:
    """Return the names of masses and inertias, each with its link or slider and its field."""
    bodies = [*scene.links, *(s.name for s in scene.sliders.values() if s.link is None)]
    fields = (("mass", "mass_kg"), ("inertia", "inertia_kg_m2"))
    return {f"{body}.{what}": (body, field) for body in bodies for what, field in fields}


def _unit_forces(scene: Scene, time_s: Array, body: str, field_name: str) -> Forces:
    """Return the forces of one unit of a mass or an inertia. Raises CrankcheckError."""
    if scene.coulomb_joints:
        raise CrankcheckError(
            f"{scene.name}: Coulomb's friction ({', '.join(scene.coulomb_joints)}) follows from "
            "reactions, so that forces are not linear in masses; remove it, or leave out masses"
        )
    none = {"mass_kg": 0.0, "inertia_kg_m2": 0.0}

    def weight(name: str) -> dict[str, Any]:
        return {**none, field_name: 1.0} if name == body else none

    alone = replace(
        scene,
        links={n: replace(link, **weight(n)) for n, link in scene.links.items()},
        sliders={n: replace(one, **weight(n)) for n, one in scene.sliders.items()},
        loads={},
        springs={},
        friction={},
    )
    return forces_of(alone, time_s, skip_dead_points=True)


@np.errstate(invalid="ignore")  # nothing is certain in singular positions
def _motions(found: Linearised, time_s: Array) -> tuple[dict[str, Motion], frozenset[str]]:
    """Return the derivatives of everything that moves, by dimension; and the locked ones."""
    places, scene = found.places, found.places.scene
    links = {name: found.at(places.angle(name)) for name in scene.links}
    carriers = Selection.of(scene, (), None, ()).points
    points = {name: found.at(places.point(body, name)) for name, body in carriers.items()}
    sliders = {name: found.at(places.ride(one)) for name, one in scene.sliders.items()}
    motions = {}
    for number, name in enumerate(places.wanted):
        value = Motion(
            time_s,
            {n: LinkMotion(*one.value[:, number].real) for n, one in links.items()},
            {n: PointMotion(*_pairs(one, number)) for n, one in points.items()},
            {n: SliderMotion(*one.value[:, number].real) for n, one in sliders.items()},
        )
        bound = Bound(
            {n: LinkMotion(*_certain(one, number)) for n, one in links.items()},
            {n: PointMotion(*_certain(one, number)) for n, one in points.items()},
            {n: SliderMotion(*_certain(one, number)) for n, one in sliders.items()},
        )
        motions[name] = replace(value, bound=bound)
    return motions, found.locked


def _pairs(one: Varying, number: int) -> list[Array]:
    return [np.stack([each.real, each.imag], axis=1) for each in one.value[:, number]]


def _certain(one: Varying, number: int) -> Array:
    return np.where(np.isnan(one.error[:, number]), np.inf, one.error[:, number])
