"""Faults for a session of pymunk: changes of its space, bodies and constraints, in place."""

import math
from collections.abc import Callable, Mapping
from typing import cast

import numpy as np
import pymunk

from models.array import Array
from sim.engine import Session, Settings
from sim.pymunk.engine import PymunkSession
from sim.pymunk.space import SpaceModel
from sim.run.spoil import Opening, Post, Spoiler, WrongSetting, rounded


class PymunkSpoiler:
    """pymunk's faults: all joints are constraints; one of two moving bodies closes the loop."""

    wrong_settings: Mapping[WrongSetting, Callable[[float], Settings]] = {
        "few-iterations": lambda size: {"iterations": round(1.0 / size)},
        "first-order": lambda _: {"error_bias": 0.9**60},
    }

    def open_loop(self, session: Session) -> None:
        """Remove the constraint from the space."""
        model = _model(session)
        model.space.remove(_closing(model))

    def soften(self, session: Session, opening: Opening, share: float) -> None:
        """Raise `error_bias`, the share of a gap that is left after a second."""
        a_step = float(opening.settings["error_bias"]) ** opening.dt_s + share
        for constraint in _model(session).space.constraints:
            constraint.error_bias = a_step ** (1.0 / opening.dt_s)

    def slip(self, session: Session, by_m: float) -> None:
        """Move the anchor on the second body."""
        joint = _closing(_model(session))
        joint.anchor_b = (joint.anchor_b[0] + by_m, joint.anchor_b[1])
        arcs = cast(PymunkSession, session)._arcs
        if arcs is not None and isinstance(joint, pymunk.PivotJoint):
            arcs.move(joint, (by_m, 0.0))

    def pull(self, session: Session, gravity_m_s2: float) -> None:
        """Add gravity along -y."""
        space = _model(session).space
        space.gravity = (space.gravity[0], space.gravity[1] - gravity_m_s2)

    def load(self, session: Session, share: float) -> None:
        """Make the last body heavier."""
        _last(session).mass *= 1.0 + share

    def turn(self, session: Session, angle_rad: float) -> None:
        """Turn the last body about its centre of gravity."""
        _last(session).angle += angle_rad

    def block(self, session: Session, opening: Opening, body: str, post: Post) -> None:
        """Add the post to the ground, and let joints permit collisions of their own bodies. The bar
        of ``body`` is as thick as MuJoCo's."""
        model = _model(session)
        for constraint in model.space.constraints:
            constraint.collide_bodies = True
        x0, y0 = model.centre[body]
        first, *others = [(x - x0, y - y0) for x, y in opening.scene.links[body].points.values()]
        thin = 0.012 * opening.scene.longest_m
        bars = [pymunk.Segment(model.bodies[body], first, end, thin) for end in others]
        ground = model.space.static_body
        model.space.add(pymunk.Circle(ground, post.radius_m, post.centre), *bars)

    def round_state(self, session: Session, relative: float) -> None:
        """Round places, angles and velocities of all bodies, the crank's too."""
        for body in _model(session).bodies.values():
            state = np.array(
                [*body.position, body.angle, *body.velocity, body.angular_velocity],
                dtype=np.float64,
            )
            x, y, angle, vx, vy, omega = rounded(state, relative).tolist()
            body.position, body.angle = (x, y), angle
            body.velocity, body.angular_velocity = (vx, vy), omega

    def damp(self, session: Session, per_s: float) -> None:
        """Lower Chipmunk's damping, the share of a velocity that is left after a second."""
        _model(session).space.damping *= math.exp(-per_s)

    def slow(self, session: Session, share: float) -> None:
        """Make the last body slower to turn, about its centre of gravity."""
        _last(session).moment *= 1.0 + share

    def spin(self, session: Session, by_rad_s: float) -> None:
        """Add to the angular velocity of the last body."""
        _last(session).angular_velocity += by_rad_s

    def quicken(self, session: Session, share: float) -> None:
        """Scale the velocities of every body."""
        for body in _model(session).bodies.values():
            body.velocity *= 1.0 + share
            body.angular_velocity *= 1.0 + share

    def hold_back(self, session: Session, by_s: float, before: Array | None = None) -> Array:
        """Take back the whole change of velocity, as velocities are half a step newer."""
        bodies = list(_model(session).bodies.values())
        now = np.array([[*body.velocity, body.angular_velocity] for body in bodies])
        off = np.zeros_like(now) if before is None else by_s * (now - before)
        for body, (x, y, turn) in zip(bodies, off, strict=True):
            body.position -= (float(x), float(y))
            body.angle -= float(turn)
        return now

    def lose(self, session: Session) -> None:
        """Make the velocity of the last body NaN."""
        _last(session).velocity = (math.nan, math.nan)


def _model(session: Session) -> SpaceModel:
    """Return the space of the session, which only this file accesses."""
    return cast(PymunkSession, session)._model


def _last(session: Session) -> pymunk.Body:
    return list(_model(session).bodies.values())[-1]


def _closing(model: SpaceModel) -> pymunk.PivotJoint | pymunk.GrooveJoint | pymunk.PinJoint:
    """Return the last joint that holds a point: of two freely moving bodies if there is one, else
    of one of them and the ground or the crank."""
    kinds = (pymunk.PivotJoint, pymunk.GrooveJoint, pymunk.PinJoint)
    dynamic = pymunk.Body.DYNAMIC
    holding = [c for c in model.space.constraints if isinstance(c, kinds)]
    both = [c for c in holding if c.a.body_type == c.b.body_type == dynamic]
    return (both or [c for c in holding if c.b.body_type == dynamic])[-1]


SPOILER: Spoiler = PymunkSpoiler()
