"""Where the nodes of elastic links start: the state that an engine's own beams are given."""

from __future__ import annotations

import numpy as np

from analytic.elastic.beam import Beam, ElasticBody
from analytic.elastic.discretisation import REFERENCE
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.multibody.as_motion import as_motion
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
        line = line_of(own.scene, name)
        x = np.linspace(0.0, line.length_m, own.count + 1)
        nodes = ElasticBody(body.link, line, body.shapes).body(
            [(line.at(each), line.lean_rad) for each in x], (0.0, 0.0)
        )
        q, rates, push = (each[:, at] for each in (instant.now.q, instant.now.rates, seconds))
        marks = nodes.mark(q, rates)
        place = marks.place[0]
        drift = (marks.gradient @ rates[:, None, :, None])[0, :, :, 0]
        gained = (marks.gradient @ push[:, None, :, None])[0, :, :, 0] + marks.drift[0]
        line_angle = q[0, 2] + line.lean_rad
        slope = place[:, 2] - line_angle
        lean = np.sqrt(1.0 - slope**2)
        place[:, 2] = line_angle + np.arcsin(slope)
        drift[:, 2] = rates[0, 2] + (drift[:, 2] - rates[0, 2]) / lean
        for told, points, levels in zip(turning, moving, (place, drift, gained), strict=True):
            told.update(zip(own.bodies(name), map(float, levels[:, 2]), strict=True))
            pairs = ((float(a), float(b)) for a, b in levels[:, :2])
            points.update(zip(own.nodes(name), pairs, strict=True))
        for kind, level in zip(strains, (q, rates), strict=True):
            values = map(float, body.strains(level, x)[0])
            kind.update(zip(own.bodies(name), values, strict=True))
    theta, omega, alpha = turning
    position, velocity, acceleration = moving
    return State(
        state.time_s, theta, omega, alpha, position, velocity, acceleration,
        state.displacement, state.speed, *strains,
    )  # fmt: skip
