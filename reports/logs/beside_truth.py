"""A user's log beside the truth: what it holds is compared as a run of an engine is.

The log's readings may be wrapped, relative to another link, or belong to other instants. So what
each is off by is worked out first (`reports.logs.channel`), and put on what the truth says of the
places and rates of the bodies themselves: of a point of which the log has one coordinate, the other
is right, and so of a force.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Protocol, cast

import numpy as np

from models.array import Array
from models.motion import Order
from models.scene import Scene
from reports.compare.beside import Truth
from reports.logs.channel import Channel, OwnLog, Reading
from reports.logs.log_beside import AtCrank, LogBeside
from reports.logs.logged_motion import logged_motion
from reports.logs.whole_pins import whole_pins
from reports.quantities import QUANTITIES
from reports.way.way import way_of
from sim.engine import Run


class LogSide(Protocol):
    """What logs of a kind of scene are compared as."""

    def beside(self, log: OwnLog, truth: Truth, run: Run) -> LogBeside:
        """The log beside the truth, and the run that it amounts to."""
        ...

    def judged_as(self, scene: Scene, channel: Channel) -> tuple[str, ...]:
        """The quantities that a column is judged as."""
        ...


def beside_truth(log: OwnLog, truth: Truth, *, step_s: float = 0.0) -> LogBeside:
    """The log beside the truth, and the run that it amounts to. Raises CrankcheckError."""
    scene, way = log.scene, way_of(log.scene)
    instants = {order: _instants(log, order) for order in (0, 1, 2)}
    moved = logged_motion(
        log, lambda order: truth.at(instants[order]), lambda reading: reading.error(truth)
    )
    alone = isinstance(truth, AtCrank)
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
        every=1,
        with_forces=borne is not None,
        forces_of="steps" if borne and borne.of_steps else "states",
    )
    assert run.motion is not None
    return cast(LogSide, way.part("log")).beside(log, truth, run)


def _instants(log: OwnLog, order: Order) -> Array:
    """The instants that rates of an order are compared at: their own, where all share them."""
    own = [each.instants for each in log.readings if each.channel.kind.order == order]
    if order and own and all(np.array_equal(each, own[0]) for each in own):
        return own[0]
    return log.time_s


def _gaps(log: OwnLog) -> dict[str, Array]:
    """How far the copies of a point are from the one that is judged [m], the widest at each row."""
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
    """What of the scene's places, rates and, where they were asked for, forces the log does not
    hold, quantity by quantity."""
    held, there = list[tuple[str, str]](), list[tuple[str, str]]()
    way = way_of(log.scene)
    for name, entry in QUANTITIES.items():
        if entry.role not in way.roles_of(with_forces=beside.run.with_forces):
            continue
        if name == "segments":  # which the same column says as the deflection
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


def readings_of(log: OwnLog, quantity: str, body: str) -> tuple[Reading, ...]:
    """The readings that a quantity of a body is judged by."""
    side = cast(LogSide, way_of(log.scene).part("log"))
    return tuple(
        each
        for each in log.readings
        if each.channel.of == body and quantity in side.judged_as(log.scene, each.channel)
    )
