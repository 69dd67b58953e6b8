"""Mechanisms with elastic links that tests share (synthetic): at other speeds, with other rockers
and damping; their motions by multipliers, and how far two motions are apart."""

from dataclasses import replace
from functools import cache

import numpy as np

from analytic.elastic.discretisation import Discretisation, Modes, flexible_links
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.natural import lowest_rad_s
from analytic.elastic.reduced import ReducedForm
from analytic.elastic.released import assembled
from analytic.multibody.generalised_forces import GeneralisedForces
from analytic.multibody.multibody_motion import MultibodyMotion, Projection
from analytic.multibody.release_multibody import Acting, ready
from models.array import Array
from models.files.reading import load_scene
from models.motion import Motion
from models.scene import Scene
from models.scene.laws import ConstantSpeed, Law

FEW = Modes(2, 1)


def with_elastic(scene: Scene, **changes: float) -> Scene:
    """The scene with every elastic link changed."""
    return replace(
        scene, elastic={name: replace(own, **changes) for name, own in scene.elastic.items()}
    )


def following(scene: Scene, law: Law) -> Scene:
    return replace(scene, driver=replace(scene.driver, law=law))


@cache
def fourbar(*, axial_n: float = float("inf"), damping_s: float = 0.0) -> Scene:
    return with_elastic(load_scene("fourbar-elastic"), axial_n=axial_n, damping_s=damping_s)


def turning(ratio: float = 10.5, rocker: float = 1.0, damping_s: float = 0.0) -> Scene:
    """The shipped four-bar with its first frequency so many times the crank's speed, a rocker so
    many times as heavy, and damping."""
    scene = fourbar(damping_s=damping_s)
    own = scene.links["rocker"]
    heavy = replace(own, mass_kg=rocker * own.mass_kg, inertia_kg_m2=rocker * own.inertia_kg_m2)
    scene = following(scene, ConstantSpeed(1.0, lowest_rad_s(scene) / ratio))
    return replace(scene, links={**scene.links, "rocker": heavy})


def form_of(scene: Scene, by: Discretisation = FEW) -> ReducedForm:
    return DrivenElasticMotion(scene, 1.0, by, "periodic", stiffened=True).form


def by_multipliers(
    scene: Scene, until_s: float, by: Discretisation, acting: Acting = GeneralisedForces
) -> MultibodyMotion:
    """Free motion, by the equations with multipliers and an explicit method."""
    dynamics, *start = ready(scene, assembled(scene), flexible_links(scene, by), acting)
    return MultibodyMotion(dynamics, Projection(), until_s, tuple(start))


def largest(series: Array) -> float:
    return float(np.abs(series).max())


def apart(motion: Motion, other: Motion, link: str) -> float:
    """How far two motions are from each other, each quantity over its largest."""
    bent, wanted = motion.elastic[link], other.elastic[link]
    pairs = [(bent.middle, wanted.middle), (bent.extension, wanted.extension)]
    pairs += [(motion.forces.torque, other.forces.torque)]
    pairs += [(one.alpha, other.links[name].alpha) for name, one in motion.links.items()]
    for pin, held in motion.forces.pins.items():
        pairs += [(push, other.forces.pins[pin][body]) for body, push in held.items()]
    return max(largest(a - b) / (largest(a) or 1.0) for a, b in pairs)
