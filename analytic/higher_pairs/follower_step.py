"""Step of the follower of a cam: its coordinate by the law of motion at the cam's angle."""

from __future__ import annotations

import numpy as np

from analytic.cams.cam_design import refuse_undercut
from analytic.dyads.chunk import SINES, Chunk
from analytic.dyads.parts import SlideError, Sliding
from analytic.dyads.plane import EPS, AngleError, BodyKinematics, Real, Vec
from analytic.dyads.riding import PlacedBodies, RidingLine, riding_point
from analytic.structure.groups import Following
from models.array import Array
from models.errors import CrankcheckError, StructureError
from models.scene.cam_laws import CamLift
from models.scene.pairs import CamPair


def angle_of(body: BodyKinematics) -> Real:
    """Return the angle of a body [rad], up to whole turns where it is not known with them."""
    return np.arctan2(body.turn.y, body.turn.x) if body.theta is None else body.theta


def lift_at(pair: CamPair, cam: BodyKinematics, carrier: BodyKinematics) -> CamLift:
    """Return the lift of a cam at the angles of its bodies, and its derivatives by their
    difference in the way of the follower's coordinate."""
    lift = pair.profile.law.at(pair.law_angle(angle_of(cam), angle_of(carrier)))
    return CamLift(*(pair.way * pair.sense**n * one for n, one in enumerate(lift)))


class FollowerStep:
    """Follower on the carrier of its cam."""

    def __init__(self, placed: PlacedBodies, part: Following) -> None:
        self.part, self.pair = part, part.pair
        self.key = f"cam {self.pair.name}"
        scene = placed.scene
        self.lowest = self.pair.lowest(scene.points_of, scene.sliders)
        try:
            if self.pair.profile.law.continuous > 0:  # else it has corners, as a relation
                refuse_undercut(self.pair.profile)
        except CrankcheckError as error:
            raise StructureError(f"{scene.name}: cams.{self.pair.name}: {error}") from None
        self.riding = RidingLine.of(placed, self.pair.slider) if self.pair.slider else None
        self.pin = "" if self.riding else part.joint[1]
        self.local = (0.0, 0.0) if self.riding else placed.local(part.body, self.pin)

    def advance(self, chunk: Chunk) -> None:
        cam, carrier = chunk.bodies[self.pair.cam], chunk.bodies[self.pair.carrier]
        lift = lift_at(self.pair, cam, carrier)
        omega, alpha = cam.omega - carrier.omega, cam.alpha - carrier.alpha
        place = self.lowest + lift.value
        rate = lift.first * omega
        second = lift.second * omega**2 + lift.first * alpha
        error = self._error(cam, carrier, lift, place) if chunk.certified else None
        found = Sliding(place, rate, second, error)
        if self.riding is not None:
            point = riding_point(self.riding.line(chunk), found)
            follower = self.riding.follower(chunk, self.riding.rider, point)
            chunk.sliders[self.pair.slider] = found
        else:
            follower = self._turned(chunk, carrier, found)
        chunk.bodies[self.part.body] = follower
        chunk.sines[self.key] = np.ones_like(chunk.theta)

    def _turned(self, chunk: Chunk, carrier: BodyKinematics, by: Sliding) -> BodyKinematics:
        """Return an oscillating follower, at an angle to its carrier."""
        theta = None if carrier.theta is None else carrier.theta + by.s
        turn = carrier.unit(0.0).turned(Vec(np.cos(by.s), np.sin(by.s)))
        error = None
        if by.error is not None and carrier.error is not None:
            own, base = by.error, carrier.error
            error = AngleError(
                own.displacement + base.theta + SINES + 2 * EPS,
                own.speed + base.omega + EPS * np.abs(by.speed),
                own.acceleration + base.alpha + EPS * np.abs(by.acceleration),
            )
        anchor = chunk.point(self.pair.carrier, self.pin)
        omega, alpha = carrier.omega + by.speed, carrier.alpha + by.acceleration
        return BodyKinematics(self.local, anchor, turn, omega, alpha, error, theta)

    def _error(
        self, cam: BodyKinematics, carrier: BodyKinematics, lift: CamLift, place: Array
    ) -> SlideError:
        """Return bounds of the coordinate and its rates."""
        assert cam.error is not None
        assert carrier.error is not None
        errors = lift_errors(self.pair, cam, carrier)
        omega, alpha = np.abs(cam.omega - carrier.omega), np.abs(cam.alpha - carrier.alpha)
        rate = cam.error.omega + carrier.error.omega + 2 * EPS * omega
        gain = cam.error.alpha + carrier.error.alpha + 2 * EPS * alpha
        first, second = np.abs(lift.first) + errors[1], np.abs(lift.second) + errors[2]
        return SlideError(
            errors[0] + 2 * EPS * (np.abs(place) + abs(self.lowest)),
            errors[1] * omega + first * rate,
            errors[2] * omega**2 + second * rate * (2.0 * omega + rate)
            + errors[1] * alpha + first * gain + 4 * EPS * second * omega**2,
        )  # fmt: skip


def lift_errors(
    pair: CamPair, cam: BodyKinematics, carrier: BodyKinematics, orders: int = 3
) -> list[Real]:
    """Return bounds of the lift and its derivatives, so many ``orders``, 4 at most: those of the
    law's angle by the largest next derivative, jumps of the law beside it, and its rounding."""
    assert cam.error is not None
    assert carrier.error is not None
    law, one, other = pair.profile.law, angle_of(cam), angle_of(carrier)
    off = cam.error.theta + carrier.error.theta
    off = off + 3 * EPS * (np.abs(one) + np.abs(other) + abs(pair.start_rad) + 7.0)
    peaks = [*(max(map(abs, each)) for each in law.extremes), law.fourth_at_most]
    narrow = 0.5 * min(np.diff(law.knots_rad))
    away = [np.zeros_like(off) for _ in range(orders)]
    for jump in law.jumps:
        phi = pair.law_angle(one, other) - jump.angle_rad
        near = np.abs(np.remainder(phi + np.pi, 2.0 * np.pi) - np.pi) <= off
        for n, size in enumerate(jump[1 : 1 + orders]):
            away[n] = away[n] + np.where(near, abs(size), 0.0)
    return [
        peaks[n + 1] * off + away[n] + 64 * EPS * peaks[0] / narrow**n
        for n in range(orders)
    ]  # fmt: skip
