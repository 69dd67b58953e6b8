"""A user's log beside the reference: its content is compared like a run of an engine.

The log's readings may be wrapped, relative to another link, or belong to other instants. So their
errors are computed first (`reports.logs.channel`), and added to the reference positions and rates
of the bodies themselves: a coordinate of a point, or of a force, that the log lacks equals the
reference.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Protocol, cast

import numpy as np

from analytic.kinematics import solve_driven
from models.array import Array
from models.errors import ReachError
from models.motion import Forces, Motion, Order
from models.scene import Scene
from reports.compare.compare import Beside, Truth
from reports.compare.errors import Error
from reports.compare.tracks import Track, tracks
from reports.logs.channel import Channel, OwnLog, Reading, is_driver, logged_motion
from reports.protocol.way import way_of
from reports.quantities import QUANTITIES, named
from reports.quantities.quantity import Role
from sim.engine import Run

EVEN = 1e-6
"""Relative difference below which steps are equal, as for printed times."""
MANY = 200_000
"""Samples beyond which memory counts: tracks are not kept, and the errors at the logged angle of
the driver left out, as a second reference of that size takes as much as all else."""


@dataclass(frozen=True)
class AtCrank(Truth):
    """The reference at the logged angles of the driver, where the log has them: its positions.
    Rates are by the scene's law, as the measure of its difficulty; ``with_rates`` if they are
    judged as well."""

    time_s: Array = field(kw_only=True)
    crank_rad: Array = field(kw_only=True)
    with_rates: bool = False

    def crank_at(self, time_s: Array) -> Array:
        """Return the driver's angle at instants of the rows [rad]; at others interpolated."""
        if np.array_equal(time_s, self.time_s):
            return self.crank_rad
        return np.interp(time_s, self.time_s, self.crank_rad)

    def driven_at(self, time_s: Array) -> tuple[Array, Array, Array]:
        """Return that angle with its rate and acceleration, which are by the scene's law."""
        return self.crank_at(time_s), *self.scene.driver.law.at(time_s)[1:]

    def _solved(self, time_s: Array) -> Motion:
        solved = partial(solve_driven, links=self.links, points=self.points, bound=self.bound)
        return solved(self.scene, *self.driven_at(time_s), time_s)


@dataclass(frozen=True)
class LogBeside(Beside):
    """A log beside the reference: tracks of its own content alone. ``step_s`` is the stated step, 0
    for none: without one there is no start, and nothing is differenced. A reference `AtCrank` has
    ``geometry_alone``."""

    step_s: float = 0.0
    geometry_alone: bool = False

    @cached_property
    def whole(self) -> Motion:
        if self.truth.links is None:
            return self.reference
        every = -(-self.motion.time_s.size // MANY)
        whole = replace(self.truth, links=None, points=None, bound=False, _motions={})
        return whole.at(self.motion.time_s[::every])

    @property
    def of_engine(self) -> bool:
        return False

    @property
    def settling(self) -> int:
        return super().settling if self.step_s else 0

    @property
    def is_even(self) -> bool:
        steps = np.diff(self.motion.time_s)
        even = np.ptp(steps) <= EVEN * np.max(steps)
        return bool(self.step_s) and bool(even)

    @property
    def has_crank(self) -> bool:
        few = self.motion.time_s.size <= MANY
        return few and not self.geometry_alone and bool(np.all(np.isfinite(self.crank)))

    @property
    def missing(self) -> tuple[str, ...]:
        return ()

    @property
    def incomplete(self) -> str:
        return ""

    def driver_at(self, time_s: Array, reference: Motion) -> Array:
        if isinstance(self.truth, AtCrank):
            return self.truth.crank_at(time_s)
        return super().driver_at(time_s, reference)

    def tracks(self, quantities: Sequence[str], reference: Motion) -> tuple[Track, ...]:
        judged = list(quantities)
        if self.geometry_alone:
            rates: list[Role] = ["derived"] if getattr(self.truth, "with_rates", False) else []
            judged = [name for name in quantities if name in named("place", "closure", *rates)]
        if self.motion.time_s.size > MANY:
            every = tuple(tracks(self.scene, self.run, reference, judged))
        else:
            every = super().tracks(judged, reference)
        return tuple(track for track in every if not np.all(np.isnan(track.error)))


class LogSide(Protocol):
    """Comparison of logs of a kind of scene."""

    def beside(self, log: OwnLog, truth: Truth, run: Run) -> LogBeside:
        """Return the log beside the reference, and the equivalent run."""
        ...

    def judged_as(self, scene: Scene, channel: Channel) -> tuple[str, ...]:
        """Return the quantities for which a column is judged."""
        ...


def beside_truth(log: OwnLog, truth: Truth, *, step_s: float = 0.0) -> LogBeside:
    """Return the log beside the reference, and the equivalent run. Raises CrankcheckError."""
    scene, way = log.scene, way_of(log.scene)
    instants = {order: _instants(log, order) for order in (0, 1, 2)}
    alone = isinstance(truth, AtCrank)
    try:
        moved = logged_motion(
            log, lambda order: truth.at(instants[order]), lambda reading: reading.error(truth)
        )
    except ReachError as error:
        if alone or not scene.driver.is_crank:
            raise
        has = any(is_driver(each.channel, scene) for each in log.readings)
        raise ReachError(
            f"{error} If the log moves differently from the scene's driver, "
            f"{'judge it at its own' if has else 'log the'} angle of {scene.driver.link}: "
            "--drive logged"
        ) from None
    borne = None if alone else log.forces
    steps = round((log.time_s[-1] - log.time_s[0]) / step_s) if step_s else 0
    run = Run(
        scene=scene.name,
        engine="",
        version="",
        profile="",
        drive=way.drive,
        dt_s=step_s,
        status="ok",
        reason="",
        settings={},
        motion=replace(moved, forces=whole_pins(borne.forces, truth) if borne else None),
        gaps={**_gaps(log), **{gap.of: gap.opening_m for gap in log.gaps}},
        velocity_time_s=instants[1],
        acceleration_time_s=instants[2],
        stopped_at_s=float(log.time_s[-1]),
        start_s=float(log.time_s[0]),
        steps=steps,
        with_forces=borne is not None,
        forces_of="steps" if borne and borne.of_steps else "states",
    )
    assert run.motion is not None
    return cast(LogSide, way.part("log")).beside(log, truth, run)


def _instants(log: OwnLog, order: Order) -> Array:
    """Return the instants of comparison of rates of an order: their own, where all share them."""
    own = [each.instants for each in log.readings if each.channel.kind.order == order]
    if order and own and all(np.array_equal(each, own[0]) for each in own):
        return own[0]
    return log.time_s


def _gaps(log: OwnLog) -> dict[str, Array]:
    """Return the largest distance of a point's copies from the judged one [m], at each row."""
    main = {(each.channel.kind, each.channel.of): each for each in log.readings}
    square: dict[tuple[str, str], Array] = {}
    for copy in log.copies:
        off = copy.values - main[copy.channel.kind, copy.channel.of].values
        key = (copy.channel.of, copy.channel.on)
        square[key] = square.get(key, np.zeros_like(off)) + off**2
    gaps: dict[str, Array] = {}
    for (point, _), each in square.items():
        gaps[point] = np.maximum(gaps.get(point, np.zeros_like(each)), np.sqrt(each))
    return gaps


def lacking(log: OwnLog, beside: LogBeside) -> tuple[str, ...]:
    """Return positions, rates and, on request, forces that the log lacks, quantity by quantity."""
    held, there = list[tuple[str, str]](), list[tuple[str, str]]()
    way = way_of(log.scene)
    roles = way.roles_of(with_forces=beside.run.with_forces)
    for name, entry in QUANTITIES.items():
        if entry.role not in roles or name == "segments":  # said as the deflection by its column
            continue
        reference, whole = beside.reference, beside.whole
        if entry.role == "force":
            instants = entry.instants(beside.run)
            at = log.time_s if instants is None else instants
            reference = whole = beside.truth.with_forces_at(at)
        held += [(name, track.body) for track in beside.tracks((name,), reference)]
        every = (measure.truth(beside.scene, whole) for measure in entry.measures)
        there += [(name, body) for bodies in every for body in bodies]
    there += [(name, beside.scene.name) for name in way.unlogged]
    return tuple(f"{name} of {body}" for name, body in there if (name, body) not in held)


def aside(log: OwnLog, not_judged: Sequence[str]) -> tuple[str, ...]:
    """Return those of the quantities without a verdict (`lacking`) that the log has."""
    side = cast(LogSide, way_of(log.scene).part("log"))
    channels = [each.channel for each in log.readings]
    there = {f"{name} of {c.of}" for c in channels for name in side.judged_as(log.scene, c)}
    return tuple(name for name in not_judged if name in there)


def readings_of(log: OwnLog, error: Error) -> tuple[Reading, ...]:
    """Return the readings by which the quantity of an error is judged."""
    side = cast(LogSide, way_of(log.scene).part("log"))
    return tuple(
        each
        for each in log.readings
        if each.channel.of == error.body
        and error.quantity in side.judged_as(log.scene, each.channel)
        and error.body_kind in (each.channel.kind.judged_of, "driver")
    )


def whole_pins(logged: Forces, truth: Truth) -> Forces:
    """Return forces in which a component of a pin that the log lacks equals the reference. Raises
    CrankcheckError where the scene has no reference."""
    lacks = {
        (point, body): np.all(np.isnan(force), axis=0)
        for point, bodies in logged.pins.items()
        for body, force in bodies.items()
    }
    halves = {key for key, lacking in lacks.items() if np.sum(lacking) == 1}
    right = truth.with_forces_at(logged.time_s).forces if halves else None
    if right is None or not right.pins:
        return logged
    pins = {
        point: {
            body: np.where(lacks[point, body], right.pins[point][body], force)
            if (point, body) in halves
            else force
            for body, force in bodies.items()
        }
        for point, bodies in logged.pins.items()
    }
    return replace(logged, pins=pins)
