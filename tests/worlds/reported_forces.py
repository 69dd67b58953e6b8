"""The forces that an engine reports: equilibrium of the bodies in its motion, and their errors."""

import numpy as np

from analytic.forces import kinetostatics
from models.array import Array
from models.motion import Forces
from models.scene import GROUND, Scene, joints
from models.scene.loads import LineSpring, PinSpring, SlideSpring
from reports.contract.clauses.reactions import named
from sim.engine import BodyPose, Log
from sim.engine.measure import spring_lengths


def turned(pose: BodyPose, local: tuple[float, float]) -> Array:
    c, s = np.cos(pose.theta), np.sin(pose.theta)
    return np.stack([c * local[0] - s * local[1], s * local[0] + c * local[1]], axis=-1)


def cross(a: Array, b: Array) -> Array:
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def pulls(scene: Scene, log: Log) -> dict[str, Array]:
    """What each spring pulls its q back with, from the places that were logged."""
    poses = log.poses
    lengths = spring_lengths(scene, poses)
    rates = {n: np.gradient(q, poses.time_s, edge_order=2) for n, q in lengths.items()}
    return {
        n: one.rate * (lengths[n] - one.free) + one.damping * rates[n]
        for n, one in scene.springs.items()
    }


def left_over(scene: Scene, log: Log) -> tuple[float, float]:
    """What is left of the equilibrium of the bodies with their springs in the engine's own motion:
    of forces and of moments [m], over the largest force."""
    poses, forces, pull = log.poses.bodies, log.forces, pulls(scene, log)
    largest = max(float(np.abs(f).max()) for by in forces.pins.values() for f in by.values())
    theta = {GROUND: np.zeros_like(log.poses.time_s)} | {n: p.theta for n, p in poses.items()}
    ends: list[tuple[str, Array, Array]] = []  # body, force, place
    couples: list[tuple[str, Array]] = []
    left, turning = [0.0], [0.0]

    def place(body: str, local: tuple[float, float]) -> Array:
        own = poses.get(body)
        return np.array([local]) if own is None else own.origin + turned(own, local)

    for point, by_body in forces.pins.items():
        for body, force in by_body.items():
            if body in poses:
                ends.append((body, force, place(body, joints.local_point(scene, body, point))))
    for slide in joints.joints(scene).slides:
        slider, rider = slide.slider, joints.riding_body(slide)
        line = theta[slider.on] + slider.direction_rad
        along = np.stack([np.cos(line), np.sin(line)], axis=-1)
        across = np.stack([-along[:, 1], along[:, 0]], axis=-1)
        own, at = (
            forces.sliders[slider.name],
            place(rider, joints.local_point(scene, rider, slider.point)),
        )
        pulled = [
            pull[name]
            for name, spring in scene.springs.items()
            if isinstance(spring, SlideSpring) and spring.slider == slider.name
        ]
        push = own.normal[:, None] * across
        back = sum(pulled, np.zeros_like(line))[:, None] * along
        if rider == (slider.link or joints.block_name(slider)):
            ends.append((rider, push - back, at))
            couples.append((rider, own.moment))
        else:  # a block without mass hands on to its pin what it is given
            on_block = forces.pins[slider.point][joints.block_name(slider)] + push - back
            left.append(float(np.abs(on_block).max()))
        ends.append((slider.on, back - push, at))
        couples.append((slider.on, -own.moment))
    for name, spring in scene.springs.items():
        if isinstance(spring, PinSpring):
            couples += [(spring.bodies[0], pull[name]), (spring.bodies[1], -pull[name])]
        elif isinstance(spring, LineSpring):
            (a, at), (b, to) = joints.line_ends(scene, spring)
            way = place(b, to) - place(a, at)
            force = pull[name][:, None] * way / np.hypot(*way.T)[:, None]
            ends += [(a, force, place(a, at)), (b, -force, place(b, to))]
    for body, pose in poses.items():
        mass, inertia = joints.mass_of(scene, body)
        arm = turned(pose, joints.centre_of(scene, body))
        push = pose.origin_acceleration - arm * (pose.omega**2)[:, None]
        push = push + np.stack([-pose.alpha * arm[:, 1], pose.alpha * arm[:, 0]], axis=-1)
        force = mass * (np.array(scene.gravity_m_s2) - push)
        moment = cross(arm, force) - inertia * pose.alpha
        moment = moment + sum(couple for on, couple in couples if on == body)
        for on, given, at in ends:
            if on == body:
                force = force + given
                moment = moment + cross(at - pose.origin, given)
        if body == scene.driver.link:
            moment = moment + forces.torque
        left.append(float(np.abs(force).max()))
        turning.append(float(np.abs(moment).max()))
    return max(left) / largest, max(turning) / largest


KINDS = ("force", "moment", "torque")


def misses(scene: Scene, found: Forces, *, over_moments: bool = False) -> dict[str, Array]:
    """Errors at each sample, by kind: of reactions over the largest, of moments over that times the
    longest link, or over the largest of them, of the torque over its own largest. None at dead
    points; NaN where a force is."""
    true = kinetostatics.forces(scene, found.time_s, bound=False, skip_dead_points=True)
    exact = dict(named(true))
    assert [name for name, _ in named(found)] == list(exact)
    of_kind = {kind: [exact[name] for name in exact if kind in name] for kind in KINDS}
    sizes = {
        kind: max((float(np.nanmax(np.abs(each))) for each in series), default=0.0)
        for kind, series in of_kind.items()
    }
    own = sizes["moment"] if over_moments else 0.0
    sizes["moment"] = max(own, 1e-9 * sizes["force"]) if own else sizes["force"] * scene.longest_m
    off: dict[str, Array] = {}
    for name, series in named(found):
        kind = next(kind for kind in KINDS if kind in name)
        error = np.where(np.isnan(exact[name]), 0.0, series - exact[name])
        error = np.linalg.norm(error.reshape(len(series), -1), axis=1) / sizes[kind]
        off[kind] = np.maximum(off.get(kind, 0.0), error)
    return off


def worst_of(scene: Scene, found: Forces, settled: int = 0) -> float:
    """The largest of all errors, after some samples."""
    return max(float(off[settled:].max()) for off in misses(scene, found).values())
