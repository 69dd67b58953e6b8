"""A triad, or a dyad with a compound, as a step of the solution, at change points as well.

Where the central link is at a change point of its group, its rows give 0/0. As at the change
points of dyads, the smooth motion is an analytic function of the driver's angle,
and interpolated from both sides (`analytic.change_points.sign`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from analytic.assur.mounting import Mounting
from analytic.assur.platform import SolvedPlatform, pose_at, solve_platform
from analytic.assur.sampled_rows import SampledRow
from analytic.assur.track import AssemblyTrack
from analytic.change_points import sign
from analytic.change_points.sign import AT_START, HALVES, Interpolant, whole_turns_off
from analytic.dyads.chunk import Chunk, DrivenCoordinate, Passage, driver_scale, told
from analytic.dyads.parts import Closure, OpenError
from analytic.dyads.plane import EPS, AngleError, BodyKinematics, PointError, PointKinematics, Vec
from analytic.dyads.steps import FollowedStep, Step, common_period, uncertain_chunk
from analytic.structure.groups import Group
from models.array import Array, Mask
from models.errors import CrankcheckError, ReachError, StructureError
from models.motion import Crossing

if TYPE_CHECKING:
    from analytic.assur.assemblies import TriadAssembly


Solved = Callable[[Array], BodyKinematics]
"""Central link at driver angles [rad], per unit speed of the driver, with bounds."""


@dataclass(frozen=True)
class CrossingPiece(sign.SmoothPiece):
    """Place and angle of the link as functions of the driver's angle."""

    series: tuple[Interpolant, Interpolant, Interpolant]

    @staticmethod
    def about(solved: Solved, centre: float, room: float, size_m: float) -> CrossingPiece | None:
        """Return the widest that is about as certain as any, within ``room`` [rad]; None where the
        motion is not certainly smooth."""
        halves = (half for half in sign.HALVES if half <= room)
        return sign.widest(halves, lambda half: _piece(solved, centre, half, size_m))

    def near(self, from_centre: Array) -> Mask:
        """Return the mask of driver angles, from the centre, at which it is used."""
        return np.asarray(np.abs(from_centre) < self.window)

    def put(
        self, body: BodyKinematics, from_centre: Array, driver: DrivenCoordinate
    ) -> BodyKinematics:
        """Return the link with its lost values about the change point restored."""
        index = np.flatnonzero(self.near(from_centre))
        if not index.size:
            return body
        rates = sign.rates_at(driver, index)
        found = [one.at(from_centre[index] / self.half, rates) for one in self.series]
        (x, y, angle), errors = zip(*found, strict=True)
        new, at = sign.into(from_centre.shape, index), body.anchor
        levels = zip((at.p, at.v, at.a), x, y, strict=True)
        p, v, a = (Vec(new(old.x, each_x), new(old.y, each_y)) for old, each_x, each_y in levels)
        turn = Vec(new(body.turn.x, np.cos(angle[0])), new(body.turn.y, np.sin(angle[0])))
        anchor = PointKinematics(p, v, a, at.error)
        omega, alpha = new(body.omega, angle[1]), new(body.alpha, angle[2])
        body = replace(body, anchor=anchor, turn=turn, omega=omega, alpha=alpha)
        if body.error is None or at.error is None:
            return body
        point = PointError(*map(new, at.error, map(np.hypot, errors[0], errors[1])))
        turned = AngleError(*map(new, body.error, errors[2]))
        return replace(body, anchor=replace(anchor, error=point), error=turned)


def _piece(solved: Solved, centre: float, half: float, size_m: float) -> CrossingPiece:
    wide, narrow = centre + half * sign.nodes(sign.COUNT), centre + half * sign.nodes(sign.FEWER)
    fine, coarse = _levels(solved(wide), wide), _levels(solved(narrow), narrow)
    series = [
        Interpolant.of(one, other, half, turning=k == 2)
        for k, (one, other) in enumerate(zip(fine, coarse, strict=True))
    ]
    doubts = [
        one.worst() / (np.abs(one.values).max(axis=1) + (1.0 if k == 2 else size_m))
        for k, one in enumerate(series)
    ]
    doubt = float(np.nan_to_num(np.max(doubts), nan=math.inf))
    return CrossingPiece(half, doubt, (series[0], series[1], series[2]))


def _levels(body: BodyKinematics, theta: Array) -> list[tuple[Array, Array]]:
    """Return place and angle at the nodes, with two derivatives, and their bounds, each (3, n)."""
    assert body.error is not None
    assert body.anchor.error is not None
    at, e = body.anchor, body.anchor.error
    angle = np.unwrap(np.arctan2(body.turn.y, body.turn.x))
    turned = body.error._replace(theta=body.error.theta + 2 * EPS * (np.abs(angle) + math.pi))
    rows = (
        (at.p.x, at.v.x, at.a.x, *e),
        (at.p.y, at.v.y, at.a.y, *e),
        (angle, body.omega, body.alpha, *turned),
    )
    tables = (np.stack([np.broadcast_to(each, theta.shape) for each in row]) for row in rows)
    return [(table[:3], table[3:]) for table in tables]


SIDE = HALVES[0]
"""Range of influence of a change point [rad]."""
TINY = 1e-15
"""Offset that puts a driver angle beside an end on one side of it [rad]."""


class AssurStep(FollowedStep):
    """Central link of a group on its legs, followed from its assembly at time 0."""

    def __init__(self, mounting: Mounting, before: Sequence[Step]) -> None:
        self.mounting, self.key = mounting, mounting.group.branch_key
        self.scene, self.steps_before = mounting.placed.scene, tuple(before)
        self._tracks: dict[frozenset[str], AssemblyTrack] = {}
        self._pieces: dict[tuple[AssemblyTrack, int], CrossingPiece | None] = {}

    def before(self, theta: Array, half: Array | float, passages: Mapping[str, Passage]) -> Chunk:
        """Solve the earlier steps at driver angles with this uncertainty [rad]."""
        return uncertain_chunk(self.scene, self.steps_before, theta, half, passages)

    def advance(self, chunk: Chunk) -> None:
        track = self.track(chunk.passages)
        theta = track.home(chunk.theta)
        solved = self._solved(chunk, *track.guess(theta))
        beyond = track.beyond(theta)
        closes = solved.closed & track.on_side(theta, solved.det) & (beyond <= 0.0)
        if track.crossings:
            solved, closes = self._crossed(chunk, track, theta, solved, closes)
        # The end is known to rounding; beside it an assembly may count as open, or closed.
        short = self.mounting.size_m * np.where(
            closes, np.minimum(beyond, -1e-15), np.maximum(beyond, 1e-15)
        )
        if not chunk.stretch and not closes.all():
            raise OpenError(short)
        error = chunk.driver.error
        slack = 0.0 if error is None else self.mounting.size_m * error.theta
        chunk.sines[self.key] = np.where(closes, np.abs(solved.det), 0.0)
        if chunk.stretch:
            chunk.shortage[self.key] = short
            chunk.closures[self.key] = Closure(None, short, 0.0, slack)
        self.mounting.place(chunk, solved.body)

    def _crossed(
        self, chunk: Chunk, track: AssemblyTrack, theta: Array, solved: SolvedPlatform, closes: Mask
    ) -> tuple[SolvedPlatform, Mask]:
        """Restore the values lost in and beside the change points of the group.

        Raises CrankcheckError where the motion through one of them is not clear.
        """
        body = solved.body
        for k in range(len(track.crossings)):
            x = track.from_crossing(k, theta)
            near = np.abs(x) < SIDE
            if not near.any():
                continue
            piece = self._piece(track, k)
            if piece is not None:
                body = piece.put(body, x, chunk.driver)
                closes = closes | piece.near(x)
            elif not chunk.stretch:
                at = told(self.scene, track.crossings[k].theta)
                raise CrankcheckError(
                    f"{self.scene.name}: at {self.scene.driver.joint} {at} the group about "
                    f"{self.key} is in a change point whose smooth motion cannot be distinguished "
                    "from others within rounding: change a length, or keep the driver's range away "
                    "from there"
                )
        return replace(solved, body=body), closes

    def _piece(self, track: AssemblyTrack, k: int) -> CrossingPiece | None:
        if (track, k) not in self._pieces:

            def solved(theta: Array) -> BodyKinematics:
                home = track.home(theta)
                rows = track.rows(home, np.zeros(theta.shape))
                size = self.mounting.size_m
                return solve_platform(rows, *track.guess(home), size, certified=True).body

            centre, room = track.crossings[k].theta, track.room_about(k)
            self._pieces[track, k] = CrossingPiece.about(solved, centre, room, self.mounting.size_m)
        return self._pieces[track, k]

    def passed(
        self, passages: Mapping[str, Passage], low: float, high: float
    ) -> tuple[Crossing, ...]:
        track = self.track(passages)
        period = track.period
        found = set()
        for end in track.crossings:
            turns = 0.0 if period is None else math.ceil((low - AT_START - end.theta) / period)
            at = end.theta + turns * (period or 0.0)
            if low - AT_START <= at <= high + AT_START:
                found.add(whole_turns_off(end.theta))
        return tuple(Crossing(self.key, place) for place in sorted(found))

    def _solved(self, chunk: Chunk, place: Vec, turn: Vec) -> SolvedPlatform:
        rows = self.mounting.rows(chunk)
        return solve_platform(rows, place, turn, self.mounting.size_m, certified=chunk.certified)

    def track(self, passages: Mapping[str, Passage]) -> AssemblyTrack:
        """Return the track of the assembly that the scene names, with these earlier change points.

        Raises
        ------
        ReachError
            The group has no assembly at the start, or none of that number.
        """
        own = frozenset(passages) & {step.key for step in self.steps_before}
        if own not in self._tracks:
            self._tracks[own] = self._follow({key: passages[key] for key in own})
        return self._tracks[own]

    def _follow(self, passages: Mapping[str, Passage]) -> AssemblyTrack:
        scene = self.scene
        start = float(scene.driver.law.at(np.zeros(1))[0][0]) / driver_scale(scene)
        chosen = self._chosen(start, passages)

        def rows(theta: Array, half: Array) -> list[SampledRow]:
            return self.mounting.rows(self.before(theta, half, passages))

        pose = pose_at(rows, start, *_pose(chosen), self.mounting.size_m)
        if pose is None:
            raise ReachError(
                f"{scene.name}: at {scene.driver.joint} {told(scene, start)}, where it starts, the "
                f"group about {self.key} is singular to within rounding; start elsewhere"
            )
        repeats = None
        if scene.driver.slider is None:
            repeats = common_period(self.steps_before, passages)
        return AssemblyTrack(rows, pose, self.mounting.size_m, repeats)

    def period(self, passages: Mapping[str, Passage], base: float) -> float | None:
        del base  # its own track has it
        return self.track(passages).period

    def end_in_words(self, passages: Mapping[str, Passage], theta: float) -> str:
        track = self.track(passages)
        at = float(track.home(np.array([theta]))[0])
        ends = [end for end in track.ends if end is not None]
        end = min(ends, key=lambda one: abs(one.theta - at), default=None)
        if end is None:
            return f"the group about {self.key} cannot close"
        place = told(self.scene, end.theta)
        return f"the group about {self.key} ends in a {end.kind} at {place}"

    def assemblies(
        self, theta: float, passages: Mapping[str, Passage]
    ) -> tuple[TriadAssembly, ...]:
        """Return all assemblies at one driver angle, in the order of their numbers."""
        from analytic.assur.assemblies import assemblies  # with python-flint, for these alone

        before = self.before(np.array([theta]), 0.0, passages)
        one, two, three = (row.at(0) for row in self.mounting.rows(before))
        return assemblies((one, two, three))

    def _side(self, start: float, one: TriadAssembly, passages: Mapping[str, Passage]) -> float:
        """Return a value that orders the two assemblies of a dyad: the larger one is side +1."""
        group = self.mounting.group
        assert isinstance(group, Group)
        chunk = self.before(np.array([start]), 0.0, passages)
        self.mounting.place(chunk, self._solved(chunk, *_pose(one)).body)
        if group.kind != "RRR":
            return float(chunk.sliders[group.branch_key].s[0])
        first, inner, second = (
            chunk.point(self.mounting.holder(chunk, pin), pin).p
            for pin in (group.outer1, group.inner, group.outer2)
        )
        return float((second - first).cross(inner - first)[0])

    def _chosen(self, start: float, passages: Mapping[str, Passage]) -> TriadAssembly:
        """Return the assembly at the start that the scene's branch names."""
        every = self.assemblies(start, passages)
        scene = self.scene
        at = f"at {scene.driver.joint} {told(scene, start)}"
        if not every:
            raise ReachError(
                f"{scene.name}: {at}, where it starts, the group about {self.key} has no assembly; "
                "start elsewhere, or change a length"
            )
        sides = isinstance(self.mounting.group, Group)
        number = scene.branch.get(self.key, 1)
        if sides:
            ordered = sorted(every, key=lambda one: self._side(start, one, passages))
            chosen = ordered[-1 if number > 0 else 0]
        elif number > len(every):
            raise StructureError(
                f"{scene.name}: branch.{self.key} is {number}, and {at}, where it starts, the "
                f"group has {len(every)} assemblies; give a number from 1 to {len(every)}"
            )
        else:
            chosen = every[number - 1]
        if chosen.count > 1:
            raise ReachError(
                f"{scene.name}: {at}, where it starts, two assemblies of the group about "
                f"{self.key} fall together: it is singular there, and continues with either; "
                "start elsewhere"
            )
        return chosen


def _pose(one: TriadAssembly) -> tuple[Vec, Vec]:
    place = Vec(np.array([one.place[0]]), np.array([one.place[1]]))
    turn = Vec(np.array([math.cos(one.angle_rad)]), np.array([math.sin(one.angle_rad)]))
    return place, turn
