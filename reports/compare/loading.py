"""How hard the loads of a scene are on an engine, as pure numbers.

Driven exactly, a mechanism moves as it does whatever loads it; but a constraint that is soft gives
way under them, and what a load over a displacement weighs hangs on where its slider is.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from models.array import Array
from models.driver import driver_course
from models.errors import CrankcheckError
from models.joints import block_name, blocks, local_point
from models.loads import Load
from models.motion import Motion
from models.scene import Scene


def loading(scene: Scene, motion: Motion) -> float:
    """The largest second difference, from sample to sample, of the acceleration that its loads
    would give a body by itself, over those of the driver's speed on the longest link.

    The springs of soft constraints give way by a share of that acceleration, and where it grows
    evenly they do so evenly: what they make of the bodies' accelerations is its second difference.
    A body on a guide is not turned. 0 without loads, or where a table of one ends before the
    motion, which then has no forces either.
    """
    square, largest = scene.pace_rad_s**2, 0.0
    guided = {slider.link for slider in scene.sliders.values()}
    try:
        for name in dict.fromkeys(load.body for load in scene.loads.values()):
            force, moment = _push(scene, motion, name)
            mass = _mass(scene, name) * scene.longest_m * square
            largest = max(largest, _largest(np.abs(np.diff(force, 2))) / mass)
            if name in scene.links and name not in guided and scene.links[name].inertia_kg_m2:
                inertia = scene.links[name].inertia_kg_m2 * square
                largest = max(largest, _largest(np.abs(np.diff(moment, 2))) / inertia)
    except CrankcheckError:
        return 0.0
    return largest


def inertia_share(scene: Scene, force_n: float) -> float:
    """What all masses take at the driver's speed on the longest link, as a share of a force, 1 at
    most."""
    masses = [link.mass_kg for link in scene.links.values()]
    masses += [slider.mass_kg for slider in scene.sliders.values()]
    push = sum(masses) * scene.longest_m * scene.pace_rad_s**2
    return min(push / force_n, 1.0)


def _push(scene: Scene, motion: Motion, body: str) -> tuple[NDArray[np.complex128], Array]:
    """The force of all loads on a body [N], as x + iy, and their moment about its centre of mass
    [N m], (T,). Raises CrankcheckError as `Load.magnitude`."""
    force = np.zeros(motion.time_s.shape, dtype=np.complex128)
    moment = np.zeros(motion.time_s.shape)
    turned = np.exp(1j * _angle(scene, motion, body))
    for load in scene.loads.values():
        if load.body != body:
            continue
        size = _magnitude(scene, load, motion)
        if load.point is None:
            moment += size
            continue
        turn = turned if load.frame == "body" else 1.0
        push = size * turn * np.exp(1j * load.direction_rad)
        force += push
        if body in scene.links:
            place, centre = local_point(scene, body, load.point), scene.links[body].centre_m
            arm = turned * complex(place[0] - centre[0], place[1] - centre[1])
            moment += (arm.conj() * push).imag
    return force, moment


def _angle(scene: Scene, motion: Motion, body: str) -> Array | float:
    """The angle of a link or of a block, which is turned with its guide [rad]."""
    for slider in scene.sliders.values():
        if block_name(slider) == body:
            guide = motion.links.get(slider.on)
            return slider.direction_rad + (0.0 if guide is None else guide.theta)
    return motion.links[body].theta


def _magnitude(scene: Scene, load: Load, motion: Motion) -> Array:
    """The size of a load over a motion [N or N m]."""
    slid = None if load.slider is None else motion.sliders[load.slider]
    x = motion.time_s
    if load.over == "angle":
        x = driver_course(scene, motion)[0]
    elif load.over == "displacement" and slid is not None:
        x = slid.displacement
    return load.magnitude(x, None if slid is None else slid.speed)


def _largest(series: Array) -> float:
    return float(np.max(series, where=np.isfinite(series), initial=0.0))


def _mass(scene: Scene, body: str) -> float:
    """The mass of a body [kg]; of one that has none, the least there is."""
    own = {name: link.mass_kg for name, link in scene.links.items()}
    own |= {name: slider.mass_kg for name, slider in blocks(scene).items()}
    heavy = [mass for mass in own.values() if mass > 0.0]
    return own.get(body) or min(heavy, default=1.0)


def load_slopes(
    scene: Scene, motion: Motion, force_n: float, torque_n_m: float
) -> dict[str, float]:
    """How much the loads over displacements change with these, over the longest link: the
    ``reaction``, as a share of the largest, and the ``torque``, by their power.

    The slope at a sample is the steepest as far as the samples before and after it.
    """
    bears, turns = np.zeros_like(motion.time_s), np.zeros_like(motion.time_s)
    for load in scene.loads.values():
        if load.over != "displacement" or load.slider is None:
            continue
        slope = _slope(load, motion)
        at_point = load.point is not None
        bears += slope * (scene.longest_m if at_point else 1.0) / force_n
        moved = scene.longest_m / scene.pace_rad_s / torque_n_m
        turns += slope * _speed(scene, load, motion) * moved
    return {"reaction": _largest(bears), "torque": _largest(turns)}


def _slope(load: Load, motion: Motion) -> Array:
    """The slope of a load at every sample [N/m or N], 0 where it does not act."""
    assert load.slider is not None
    slid = motion.sliders[load.slider]
    apart = np.abs(np.diff(slid.displacement))
    near = np.maximum(np.append(apart, 0.0), np.insert(apart, 0, 0.0))
    slope = load.characteristic.steepest(slid.displacement, near) * np.ones_like(near)
    acts = {"forward": slid.speed > 0.0, "backward": slid.speed < 0.0}
    return np.where(acts[load.stroke], slope, 0.0) if load.stroke in acts else slope


def _speed(scene: Scene, load: Load, motion: Motion) -> Array:
    """How fast what is loaded moves [m/s or rad/s]."""
    if load.point is not None:
        return np.asarray(np.hypot(*motion.points[load.point].velocity.T))
    guides = {block_name(slider): slider.on for slider in scene.sliders.values()}
    turns = motion.links.get(guides.get(load.body, load.body))  # a block turns with its guide
    return np.zeros_like(motion.time_s) if turns is None else np.abs(turns.omega)
