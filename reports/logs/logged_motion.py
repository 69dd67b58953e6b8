"""The motion that a log amounts to: what each of its readings is off by, put on the truth."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from models.array import Array
from models.motion import ElasticMotion, LinkMotion, Motion, Order, PointMotion, SliderMotion
from reports.logs.channel import OwnLog, Reading
from reports.logs.kinds import Kind


def logged_motion(
    log: OwnLog,
    truth_of: Callable[[Order], Motion],
    error_of: Callable[[Reading], Array],
    orders: Sequence[Order] = (0, 1, 2),
) -> Motion:
    """What a log says of places, or of rates of some ``orders``, as a motion; the rest is NaN.

    ``truth_of`` gives the truth at the instants of an order, ``error_of`` what a reading is off by
    it: of a point of which the log has one coordinate, the other is right.
    """
    bodies: dict[str, dict[str, dict[str, Array]]]
    bodies = {"links": {}, "points": {}, "sliders": {}, "elastic": {}}
    for (kind, body), several in _slots(log).items():
        if kind.order not in orders:
            continue
        right = kind.of(truth_of(kind.order), body)
        wrong = _largest([error_of(reading) for reading in several], kind.order)
        fields = bodies[kind.bodies].setdefault(body, {})
        if kind.axis is None:
            fields[kind.field] = right + wrong
            continue
        if kind.field not in fields:
            motion = truth_of(kind.order).points[body]
            fields[kind.field] = getattr(motion, kind.field).copy()
        fields[kind.field][:, kind.axis] += wrong
    return _as_motion(log.time_s, bodies)


def _slots(log: OwnLog) -> dict[tuple[Kind, str], list[Reading]]:
    """The readings by what of a motion they are of: one, but for rates of a point on several
    bodies, and for angles of a link that are relative to others as well."""
    slots: dict[tuple[Kind, str], list[Reading]] = {}
    for reading in log.readings:
        slots.setdefault((reading.channel.kind, reading.channel.of), []).append(reading)
    return slots


def _largest(errors: Sequence[Array], order: Order) -> Array:
    """What a place or rate is off by, of which there are several readings, so that no right one
    hides a wrong one: of rates the largest at every sample; of places, which are differenced and
    must not jump from one to another, those of the reading whose largest is."""
    if len(errors) == 1:
        return errors[0]
    if order == 0:
        return max(errors, key=lambda error: float(np.max(np.abs(error))))
    every = np.stack(errors)
    return np.asarray(every[np.argmax(np.abs(every), axis=0), np.arange(every.shape[1])])


def _as_motion(time_s: Array, bodies: Mapping[str, Mapping[str, Mapping[str, Array]]]) -> Motion:
    """What is known of bodies, as a motion; the rest is NaN."""
    nothing = np.full(time_s.shape, np.nan)
    nowhere = np.full((time_s.size, 2), np.nan)
    return Motion(
        time_s,
        {
            name: LinkMotion(*(each.get(key, nothing) for key in ("theta", "omega", "alpha")))
            for name, each in bodies["links"].items()
        },
        {
            name: PointMotion(
                *(each.get(key, nowhere) for key in ("position", "velocity", "acceleration"))
            )
            for name, each in bodies["points"].items()
        },
        {
            name: SliderMotion(
                *(each.get(key, nothing) for key in ("displacement", "speed", "acceleration"))
            )
            for name, each in bodies["sliders"].items()
        },
        elastic={
            name: ElasticMotion(*(each.get(key, nothing) for key in ("middle", "extension")))
            for name, each in bodies["elastic"].items()
        },
    )
