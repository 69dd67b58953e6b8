"""Reactions and the drive's torque from the forces in OpenSim's joints and constraints."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from models.array import Array
from models.mjcf.tree import Limb, Tree
from models.motion import Forces
from models.scene import GROUND, Point, Scene
from models.scene import joints as pairs
from models.scene.joints import Prism
from sim.engine import Poses
from sim.engine.measure import PointPath, body_paths, directions
from sim.engine.momentum_balance import JointPushes, forces_by_body
from sim.engine.ties import Hinge, slide_of


class _Reactions:
    """Builder of the reactions; ``rows`` (T, joints and constraints, 3) are those of
    `sim.simbody.model.TreeModel.forces`."""

    def __init__(self, scene: Scene, tree: Tree, poses: Poses, rows: Array) -> None:
        self._scene, self._tree = scene, tree
        self._paths = body_paths(poses)
        self._rows: Iterator[Array] = iter(np.moveaxis(rows, 1, 0))
        self.hinges: dict[Hinge, Array] = {}
        self.normals: dict[str, Array] = {}
        self.moments: dict[str, Array] = {}
        self.torque = np.zeros(len(poses.time_s))
        for limb in tree.limbs:
            if limb.slider is None:
                self._hinge(limb, next(self._rows))
            else:
                self._slide(limb, next(self._rows))
        for pin in tree.closures:
            force = self._from_ground(pin.bodies, next(self._rows))
            self.hinges[Hinge(pin.point, *pin.bodies)] = force
        for slide in tree.slides:
            self._closing(slide)

    def across(self, slider: str) -> Array:
        """Return the direction across a line, (T, 2)."""
        return directions(self.line(slider) + 0.5 * math.pi)

    def line(self, slider: str) -> Array:
        """Return the direction of a line [rad], (T,)."""
        own = self._scene.sliders[slider]
        return self._paths[own.on].pose.theta + own.direction_rad

    def _hinge(self, limb: Limb, row: Array) -> None:
        driver = self._scene.driver
        self.hinges[Hinge(limb.point, limb.parent, limb.body)] = row[:, :2]
        bodies, driven = {limb.parent, limb.body}, driver.pin or self._scene.driver_pivot
        if driver.slider is None and limb.point == driven and bodies == {driver.base, driver.link}:
            self.torque = row[:, 2] if limb.body == driver.link else -row[:, 2]

    def _slide(self, limb: Limb, row: Array) -> None:
        """Take a slide: its guide is the parent of the sliding body, or its child."""
        slider = limb.slider
        assert slider is not None
        rides = limb.parent == slider.on
        rider = limb.body if rides else limb.parent
        force = row[:, :2] if rides else -row[:, :2]
        self.normals[slider.name] = (force * self.across(slider.name)).sum(axis=1)
        if slider.name == self._scene.driver.slider:
            self.torque = (force * directions(self.line(slider.name))).sum(axis=1)
        slide = slide_of(self._scene, slider.name)
        if isinstance(slide, Prism):
            place = self._place(limb.body, (0.0, 0.0)) - self._point(rider, slider.point)
            moment = row[:, 2] if rides else -row[:, 2]
            about = place[:, 0] * force[:, 1] - place[:, 1] * force[:, 0]
            self.moments[slider.name] = moment + about
        elif rider != pairs.riding_body(slide):  # the pin's force goes on to the body that rides
            self.hinges[Hinge(slider.point, pairs.riding_body(slide), rider)] = force

    def _closing(self, slide: pairs.Prism | pairs.Slot) -> None:
        slider, across = slide.slider, self.across(slide.slider.name)
        bodies = slider.on, pairs.riding_body(slide)
        pushes = [
            (self._from_ground(bodies, next(self._rows)) * across).sum(axis=1)
            for _ in range(1 + isinstance(slide, Prism))
        ]
        self.normals[slider.name] = sum(pushes[1:], pushes[0])
        if isinstance(slide, Prism):
            self.moments[slider.name] = self._scene.longest_m * pushes[1]

    def _from_ground(self, bodies: tuple[str, str], row: Array) -> Array:
        """Return a constraint's force, which Simbody has in the frame of the bodies' carrier."""
        first, second = ([*self._carriers(body)] for body in bodies)
        theta = self._paths[next(body for body in first if body in second)].pose.theta
        return np.asarray(
            row[:, :1] * directions(theta) + row[:, 1:2] * directions(theta + 0.5 * math.pi)
        )

    def _carriers(self, body: str) -> Iterator[str]:
        """Yield a body, the one that carries it, and so on to the ground."""
        parents = {limb.body: limb.parent for limb in self._tree.limbs}
        while body != GROUND:
            yield body
            body = parents[body]
        yield GROUND

    def _point(self, body: str, point: str) -> Array:
        return self._place(body, pairs.local_point(self._scene, body, point))

    def _place(self, body: str, local: Point) -> Array:
        return PointPath(self._paths[body], local).position


def reactions(
    scene: Scene,
    tree: Tree,
    poses: Poses,
    rows: Array,
    extra: tuple[float, float],
    blocks: Sequence[str],
    rubbing: Sequence[str],
) -> Forces:
    """Return the forces at the samples of ``rows``, whose last are the actions on ``blocks``, and
    friction of the sliders ``rubbing``.

    The crank's pin carries the weight of its ``extra`` mass, and the drive turns its inertia.
    """
    given = len(blocks) + len(rubbing)
    found = _Reactions(scene, tree, poses, rows[:, : rows.shape[1] - given])
    on_blocks = {name: rows[:, k - given] for k, name in enumerate(blocks)}
    friction = {name: rows[:, k - len(rubbing), 0] for k, name in enumerate(rubbing)}
    driver, ties = scene.driver, pairs.joints(scene)
    if driver.slider in on_blocks:  # a block without mass hands the drive's force on to its pin
        along = found.torque[:, None] * directions(found.line(driver.slider))
        on_blocks[driver.slider] = on_blocks[driver.slider] + np.pad(along, ((0, 0), (0, 1)))
    torque = found.torque
    if extra[1]:
        torque = torque - extra[1] * poses.bodies[driver.link].alpha
        weight = extra[0] * np.array(scene.gravity_m_s2)
        found.hinges[Hinge(scene.driver_pivot, GROUND, driver.link)] += weight
    unknown = 2 * sum(len(pin.bodies) - 1 for pin in ties.pins) + len(ties.slides)
    unknown += len(ties.prisms) + (not driver.law.is_free)
    pushes = JointPushes(
        found.hinges,
        {name: found.across(name) for name in scene.sliders},
        {name: found.normals[name] for name in scene.sliders},
        found.moments,
        torque,
        spare=max(unknown - 3 * len(poses.bodies), 0),
    )
    return forces_by_body(scene, pushes, on_blocks, friction, poses.time_s)
