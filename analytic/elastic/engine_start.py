"""Start of the segments and nodes of elastic links: the initial state for engines."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import legendre

from analytic.elastic.beam import BeamBody, ElasticBody
from analytic.elastic.control import elastic_history
from analytic.elastic.discretisation import REFERENCE, SegmentChain, Segments
from analytic.elastic.elastic_motion import DrivenElasticMotion, ElasticHistory
from analytic.elastic.released import ENOUGH
from analytic.multibody.as_motion import as_motion
from models.array import Array
from models.motion import State
from models.scene.cut_links import line_of
from models.scene.cut_scenes import BeamedScene, SegmentedScene
from models.scene.elastic import Shape


def chain_motion(own: SegmentedScene, start: Shape, until_s: float = 1.0) -> ElasticHistory:
    """Return the exact motion of a scene's chains until then [s], their nodes as named points."""
    by = Segments(own.count, own.corrected)
    motion = elastic_history(own.with_nodes, until_s, by, start, tolerance=ENOUGH)
    if not isinstance(motion, DrivenElasticMotion):
        return motion
    return replace(motion, bare=replace(motion, scene=own.scene))


def segment_start(own: SegmentedScene, start: Shape, motion: ElasticHistory | None = None) -> State:
    """Return the state at time 0 of `SegmentedScene.rigid` from the exact chain: its joints are
    closed, and its accelerations solve the equations of motion. ``motion`` is that of
    `chain_motion`, if it exists already."""
    motion = motion or chain_motion(own, start)
    (now, seconds), assembly = motion.begun, motion.assembly
    state = as_motion(assembly, np.zeros(1), now, seconds).state()
    turning = {"theta": dict(state.theta), "omega": dict(state.omega), "alpha": dict(state.alpha)}
    series = zip(turning.values(), (now.q, now.rates, seconds), strict=True)
    for angles, values in series:
        for name in own.scene.elastic:
            chain, at = assembly.elastic[name]
            assert isinstance(chain, SegmentChain)
            del angles[name]
            each = chain.segment_angles(values[0, at])
            angles.update(zip(own.segments(name), map(float, each), strict=True))
    return State(**{**vars(state), **turning})


def node_start(own: BeamedScene, start: Shape) -> State:
    """Return the state at time 0 of `BeamedScene.given`, from beams of small slopes that are as
    stiff along their line.

    The way x along a bent link runs along the bow, so the sine of the tangent's angle is w'.
    """
    motion = DrivenElasticMotion(own.stretching, 1.0, REFERENCE, start, stiffened=True)
    instant, assembly = motion.first, motion.form.assembly
    seconds = instant.all_seconds(instant.seconds)
    state = as_motion(assembly, np.zeros(1), instant.now, seconds).state()
    turning = [
        {name: value for name, value in each.items() if name not in own.scene.elastic}
        for each in (state.theta, state.omega, state.alpha)
    ]
    moving = [dict(each) for each in (state.position, state.velocity, state.acceleration)]
    strains: tuple[dict[str, float], dict[str, float]] = ({}, {})
    for name in own.scene.elastic:
        body, at = assembly.elastic[name]
        assert isinstance(body, BeamBody)
        q, rates, push = (each[:, at] for each in (instant.now.q, instant.now.rates, seconds))
        nodes, gained = _nodes(own, body, q, rates, push)
        levels = (nodes.place, nodes.drift, gained)
        for told, points, level in zip(turning, moving, levels, strict=True):
            told.update(zip(own.bodies(name), map(float, level[:, 2]), strict=True))
            pairs = ((float(a), float(b)) for a, b in level[:, :2])
            points.update(zip(own.nodes(name), pairs, strict=True))
        for kind, values in zip(strains, (nodes.strain, nodes.strain_rate), strict=True):
            kind.update(zip(own.bodies(name), map(float, values), strict=True))
    theta, omega, alpha = turning
    position, velocity, acceleration = moving
    return State(
        state.time_s, theta, omega, alpha, position, velocity, acceleration,
        state.displacement, state.speed, *strains,
    )  # fmt: skip


def _nodes(
    own: BeamedScene, body: BeamBody, q: Array, rates: Array, push: Array
) -> tuple[CubicNodes, Array]:
    """Return the nodes of a link at coordinates, rates and second derivatives (1, n), and their
    accelerations (n + 1, 3)."""
    line = line_of(own.scene, body.link.link)
    x = np.linspace(0.0, line.length_m, own.count + 1)
    marked = [(line.at(each), line.lean_rad) for each in x]
    marks = ElasticBody(body.link, line, body.shapes).body(marked, (0.0, 0.0)).mark(q, rates)
    place = marks.place[0]
    drift = (marks.gradient @ rates[:, None, :, None])[0, :, :, 0]
    gained = (marks.gradient @ push[:, None, :, None])[0, :, :, 0] + marks.drift[0]
    line_angle = q[0, 2] + line.lean_rad
    slope = place[:, 2] - line_angle
    place[:, 2] = line_angle + np.arcsin(slope)
    drift[:, 2] = rates[0, 2] + (drift[:, 2] - rates[0, 2]) / np.sqrt(1.0 - slope**2)
    element_m = line.length_m / own.count
    within = strain_places(element_m, own.count)
    strain, rate = (body.strains(each, within.ravel()).reshape(within.shape) for each in (q, rates))
    return cubic_nodes(place, drift, strain, rate, element_m), gained


POINTS = 5


def strain_places(element_m: float, count: int) -> Array:
    """Places along the link where strains are compared, (count, POINTS) [m]: Gauss' nodes."""
    share = 0.5 * (legendre.leggauss(POINTS)[0] + 1.0)
    return element_m * (np.arange(count)[:, None] + share)


@dataclass(frozen=True)
class CubicNodes:
    """Nodes of cubic elements: ``place`` and ``drift`` (n + 1, 3) are x, y [m] and the tangent's
    angle of each, and their rates; ``strain`` and ``strain_rate`` (n + 1,) the tangents' lengths
    less 1."""

    place: Array
    drift: Array
    strain: Array
    strain_rate: Array


def cubic_nodes(
    place: Array, drift: Array, wanted: Array, wanted_rate: Array, element_m: float
) -> CubicNodes:
    """Return the nodes nearest to ``place`` and ``drift`` whose elements have the wanted strains
    and rates at `strain_places`; the two at the pins stay where they are.

    A cubic through places and unit tangents of a curve is longer than it in one half of an element
    and shorter in the other, by about h^3 k k', k the curvature. Elements that hardly stretch
    answer with forces of about EA (w/l)^2/n^3 on their pins. The lengths of the tangents, and the
    places of inner nodes along the curve, are free: they are chosen so that the strain is nearest
    to the wanted one.
    """
    c, s = np.cos(place[:, 2:]), np.sin(place[:, 2:])
    tangent, turning = np.hstack([c, s]), drift[:, 2:] * np.hstack([-s, c])
    x, weight = legendre.leggauss(POINTS)
    share = 0.5 * (x + 1.0)
    chord, near, far = (
        6.0 * share * (1.0 - share),
        (1.0 - share) * (1.0 - 3.0 * share),
        (share * (3.0 * share - 2.0)),
    )

    def derivative(places: Array, tangents: Array) -> Array:
        """Return the derivative by the length along an element, (n, POINTS, 2)."""
        ways = np.diff(places, axis=0)[:, None] / element_m * chord[:, None]
        return ways + tangents[:-1, None] * near[:, None] + tangents[1:, None] * far[:, None]

    slope = derivative(place[:, :2], tangent)
    long = np.hypot(slope[..., 0], slope[..., 1])
    along = slope / long[..., None]
    count = len(place) - 1
    by = np.zeros((count, POINTS, 2 * (count + 1)))  # lengths of tangents, then places over h
    for i in range(count):
        first, last = along[i] @ tangent[i], along[i] @ tangent[i + 1]
        by[i, :, i], by[i, :, i + 1] = near * first, far * last
        by[i, :, count + 1 + i], by[i, :, count + 2 + i] = -chord * first, chord * last
    by = np.delete(by, [count + 1, 2 * count + 1], axis=2)  # the pins stay
    root = np.sqrt(weight)[None, :, None]

    def solved(left: Array) -> tuple[Array, Array]:
        """Return lengths of tangents, and shifts of inner nodes along them [m]."""
        found = np.linalg.lstsq(
            (root * by).reshape(count * POINTS, -1), (root[..., 0] * left).ravel(), rcond=None
        )[0]
        return np.asarray(found[: count + 1]), np.asarray(element_m * found[count + 1 :])

    strain, moved = solved(wanted - (long - 1.0))
    rate = (along * derivative(drift[:, :2], turning)).sum(axis=2)
    strain_rate, sped = solved(wanted_rate - rate)
    place, drift = place.copy(), drift.copy()
    place[1:-1, :2] += moved[:, None] * tangent[1:-1]
    drift[1:-1, :2] += sped[:, None] * tangent[1:-1]
    return CubicNodes(place, drift, strain, strain_rate)
