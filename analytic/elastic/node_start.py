"""Where the nodes of elastic links start: the state that an engine's own beams are given."""

from __future__ import annotations

import numpy as np

from analytic.elastic.beam import Beam, ElasticBody
from analytic.elastic.cubic_nodes import CubicNodes, cubic_nodes, strain_places
from analytic.elastic.discretisation import REFERENCE
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.multibody.as_motion import as_motion
from models.array import Array
from models.beamed import BeamedScene
from models.elastic import Shape
from models.elastic_line import line_of
from models.motion import State


def node_start(own: BeamedScene, start: Shape) -> State:
    """The state at time 0 of `BeamedScene.given`, as beams of small slopes have it that are as
    stiff along their line.

    The way x along a bent link is that along the bow, so the sine of the tangent's angle is w'.
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
        assert isinstance(body, Beam)
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
    own: BeamedScene, body: Beam, q: Array, rates: Array, push: Array
) -> tuple[CubicNodes, Array]:
    """The nodes of a link at coordinates, rates and second derivatives (1, n), and their
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
