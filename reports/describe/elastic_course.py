"""A scene with elastic links over time, beside the same scene with rigid ones: what is told and
drawn of it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from analytic.elastic.elastic_motion import ElasticHistory, bent, sampled
from analytic.elastic.released import ReleasedElasticMotion
from analytic.forces.kinetostatics import forces
from analytic.free.release import release
from analytic.kinematics import solve
from models.array import Array
from models.cut_links import with_rigid_links
from models.driver import Controlled
from models.elastic import Shape
from models.motion import Motion
from models.scene import Scene
from reports.describe.elastic_words import described

SHARES = np.linspace(0.0, 1.0, 41)
"""Of an elastic link's length, at which its shape is looked at; the middle is one of them."""

ROUNDING = 1e-14
"""Of the largest of a series: its joints are closed to no less."""
LEAST, MOST, IN_A_PERIOD = 180, 7200, 360
"""Parts of what is closely sampled: at least and at most, and in a period of the driver."""


@dataclass(frozen=True)
class Apart:
    """A link's angle [rad] or a slider's displacement [m], with elastic links and with rigid ones,
    (T,) each."""

    name: str
    unit: str
    elastic: Array
    rigid: Array

    @property
    def difference(self) -> Array:
        """Elastic less rigid; what is nothing but rounding is 0."""
        apart = self.elastic - self.rigid
        rounding = ROUNDING * float(np.max(np.abs(self.rigid), initial=0.0))
        return np.where(np.abs(apart) <= rounding, 0.0, apart)


@dataclass(frozen=True)
class ElasticCourse:
    """Both motions at the same instants, with their forces; ``bent`` is how far each elastic link
    is from the line between its pins [m], (T, K), at `SHARES` of its length. ``words`` say how the
    links are described, and how they start. ``uncontrolled`` is the motion without the gains of a
    controller, where it was asked for."""

    scene: Scene
    motion: Motion
    rigid: Motion
    bent: Mapping[str, Array]
    words: str
    uncontrolled: Motion | None = None

    @property
    def time_s(self) -> Array:
        """(T,)."""
        return self.motion.time_s

    @property
    def turns(self) -> float:
        """Periods of the driver from the start to the end."""
        return float(self.time_s[-1]) / self.scene.driver.law.period_s

    @property
    def base(self) -> Motion:
        """What displacements are drawn from: rigid links, where these are driven alike; let go they
        are soon elsewhere, and the motion itself is drawn with its links bent."""
        return self.motion if self.scene.is_free else self.rigid

    def apart(self) -> Iterator[Apart]:
        """What elastic links change: the angles of links, without that of a driver that follows a
        law, which is told, and the displacements of sliders."""
        for name, link in self.motion.links.items():
            gives_way = self.scene.is_free or isinstance(self.scene.driver.law, Controlled)
            if name != self.scene.driver.link or gives_way:
                yield Apart(name, "rad", link.theta, self.rigid.links[name].theta)
        for name, slider in self.motion.sliders.items():
            rigid = self.rigid.sliders[name].displacement
            yield Apart(f"slider {name}", "m", slider.displacement, rigid)

    @property
    def torques(self) -> tuple[Array, Array] | None:
        """Those of the drive with elastic links and with rigid ones [N m], (T,); None without a
        drive."""
        acting, rigid = self.motion.forces, self.rigid.forces
        return None if acting is None or rigid is None else (acting.torque, rigid.torque)


def closely_sampled(scene: Scene, until_s: float) -> Array:
    """Instants from 0 to a time [s], both included, close enough to draw, and to find extremes."""
    count = IN_A_PERIOD * until_s / scene.driver.law.period_s
    return np.linspace(0.0, until_s, int(np.clip(round(count), LEAST, MOST)) + 1)


def elastic_course(motion: ElasticHistory, time_s: Array) -> ElasticCourse:
    """A motion at times [s], (T,) in ascending order. Raises CrankcheckError where there is
    none."""
    scene = motion.scene
    words = [described(scene, motion.by), f"start {start_of(motion)}"]
    words += ["shortening left out"] * (not motion.stiffened)
    own, rigid = sampled(motion, time_s), _with_rigid_links(motion, time_s)
    return ElasticCourse(scene, own, rigid, bent(motion, time_s, SHARES), ", ".join(words))


def drawn_course(motion: ElasticHistory, time_s: Array) -> ElasticCourse:
    """As `elastic_course`, with what is drawn alone: a driver that is controlled without its gains,
    under the torque that rigid links would need. Raises CrankcheckError as that."""
    course, driver = elastic_course(motion, time_s), motion.scene.driver
    if not isinstance(motion, ReleasedElasticMotion) or not isinstance(driver.law, Controlled):
        return course
    law = replace(driver.law, kp_n_m_rad=0.0, kd_n_m_s=0.0)
    without = replace(motion, scene=replace(motion.scene, driver=replace(driver, law=law)))
    return replace(course, uncontrolled=sampled(without, time_s))


def _with_rigid_links(motion: ElasticHistory, time_s: Array) -> Motion:
    """The same mechanism, driven or let go alike, with its forces where it is driven."""
    scene = with_rigid_links(motion.scene)
    if scene.is_free:
        return release(scene, motion.until_s).at(time_s, bound=False)
    acting = forces(scene, time_s, bound=False, skip_dead_points=True)
    return replace(solve(scene, time_s, bound=False), forces=acting)


def start_of(motion: ElasticHistory) -> Shape:
    """The shape at time 0."""
    if isinstance(motion, ReleasedElasticMotion):
        return motion.scene.start.shape or "quasi-static"
    return motion.start
