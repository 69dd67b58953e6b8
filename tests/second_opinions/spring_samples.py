"""What springs and dampers exert on the bodies, in plain arrays over a motion.

Shares nothing with `analytic.forces.force_elements`.
"""

import math
from collections.abc import Iterator

import numpy as np

from models.array import Array
from models.motion import Motion
from models.scene import GROUND, Point, Scene
from models.scene.joints import block_name, local_point, sliding_body
from models.scene.loads import LineSpring, PinSpring, SlideSpring
from tests.second_opinions.body_samples import body_samples, cross

Push = tuple[str, Point, Array, Array]
"""A body, a place on it, a force (T, 2) and a torque (T,)."""


def springs_on_bodies(scene: Scene, motion: Motion) -> Iterator[Push]:
    """What all springs exert on bodies other than the ground."""
    for spring in scene.springs.values():
        if isinstance(spring, LineSpring):
            pushes = _between_points(scene, motion, spring)
        elif isinstance(spring, PinSpring):
            pushes = _in_pin(motion, spring)
        else:
            pushes = _along_line(scene, motion, spring)
        yield from (push for push in pushes if push[0] != GROUND)


def _between_points(scene: Scene, motion: Motion, spring: LineSpring) -> Iterator[Push]:
    one, other = (motion.points[name] for name in spring.points)
    way, drift = other.position - one.position, other.velocity - one.velocity
    length = np.hypot(*way.T)
    pull = spring.pull(length, np.sum(way * drift, axis=1) / length)
    force = way * (pull / length)[:, None]
    for name, sign in zip(spring.points, (1.0, -1.0), strict=True):
        blocks = [block_name(s) for s in scene.sliders.values() if s.point == name]
        body = scene.pins[name][0] if name in scene.pins else blocks[0]
        yield body, local_point(scene, body, name), sign * force, np.zeros_like(length)


def _in_pin(motion: Motion, spring: PinSpring) -> Iterator[Push]:
    """Which turn q is in, the sample nearest to time 0 says."""
    rest = np.zeros_like(motion.time_s)
    angles = [rest if n == GROUND else motion.links[n].theta for n in spring.bodies]
    rates = [rest if n == GROUND else motion.links[n].omega for n in spring.bodies]
    away = angles[1] - angles[0] - spring.free
    off = away - math.tau * np.round(away[np.argmin(np.abs(motion.time_s))] / math.tau)
    couple = spring.rate * off + spring.damping * (rates[1] - rates[0])
    for body, sign in zip(spring.bodies, (1.0, -1.0), strict=True):
        yield body, (0.0, 0.0), np.zeros((len(rest), 2)), sign * couple


def _along_line(scene: Scene, motion: Motion, spring: SlideSpring) -> Iterator[Push]:
    slider, sliding = scene.sliders[spring.slider], motion.sliders[spring.slider]
    guide = None if slider.on == GROUND else body_samples(scene, motion)[slider.on]
    angle = slider.direction_rad + (0.0 * sliding.speed if guide is None else guide.theta)
    pull = spring.pull(sliding.displacement, sliding.speed)  # type: ignore[arg-type]  # arrays as well
    force = -pull * np.stack([np.cos(angle), np.sin(angle)])
    body = sliding_body(slider)
    yield body, local_point(scene, body, slider.point), force.T, np.zeros_like(pull)
    if guide is not None:
        arm = motion.points[slider.point].position - guide.origin
        yield slider.on, (0.0, 0.0), -force.T, -cross(arm, force.T)
