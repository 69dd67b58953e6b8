"""A motion in memory as a log: what it holds of each body, at its instants."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from models.array import Array, numbers, samples
from models.errors import CrankcheckError, suggestion
from models.motion import Motion
from models.scene import Scene
from reports.logs.channel import OwnLog
from reports.logs.columns import Columns
from reports.logs.kinds import KINDS, OWN, Kind, plural
from reports.logs.map_file import ChannelTable, Map, TimeTable
from reports.logs.meanings import understood
from reports.logs.units import si

TIME = "time_s"


def log_of_motion(scene: Scene, motion: Motion, source: str = "the motion") -> OwnLog:
    """The log of a motion; a series that is NaN throughout, as of an engine that does not report
    it, is none.

    Raises CrankcheckError for times that do not go on; bodies that the scene has not; series of
    another shape than the times, or with samples that are not finite; nothing that moves.
    """
    raw = {TIME: samples(motion.time_s, f"{source}: time_s")}
    channels = []
    for kind, body, series in _series(scene, motion, source):
        values = _fitting(series, kind, raw[TIME], f"{source}: {body}, {kind.field}")
        if np.all(np.isnan(values)):
            continue
        column = f"{body}_{OWN[kind.body_kind, kind.name]}"
        raw[column] = values
        channels.append(
            ChannelTable(column=column, of=body, kind=kind.name, unit=si(kind.dimension))
        )
    if not channels:
        raise CrankcheckError(f"{source}: nothing in it moves; give links, points or sliders")
    columns = Columns(source, raw, rows=raw[TIME].size)
    return understood(columns, scene, Map(time=TimeTable(column=TIME), channel=channels))


def _series(scene: Scene, motion: Motion, source: str) -> Iterator[tuple[Kind, str, object]]:
    """What a motion says of bodies that move. Raises CrankcheckError for one that is not there."""
    points = [*scene.pins, *(slider.point for slider in scene.sliders.values())]
    there = {"link": [*scene.links], "point": points, "slider": [*scene.sliders]}
    there |= {"elastic": [*scene.elastic]} if scene.elastic else {}
    for body_kind, names in there.items():
        own = getattr(motion, plural(body_kind))
        for body, moved in own.items():
            if body not in names:
                hint = suggestion(str(body), names, "it has") if names else "it has none"
                raise CrankcheckError(
                    f"{source}: {body_kind} {body!r} is not in {scene.name}; {hint}"
                )
            if body_kind == "point" and body in scene.ground:
                continue
            for kind in KINDS.values():
                if kind.body_kind == body_kind:
                    yield kind, body, getattr(moved, kind.field)


def _fitting(series: object, kind: Kind, time_s: Array, what: str) -> Array:
    """A series (T,) of a body. Raises CrankcheckError for one of another shape."""
    found = numbers(series, what)  # type: ignore[arg-type]  # whatever it is, it is looked at there
    shape = time_s.shape if kind.axis is None else (*time_s.shape, 2)
    if found.shape != shape:
        raise CrankcheckError(
            f"{what} of shape {found.shape}, time_s of {time_s.shape}; give {shape}"
        )
    return found if kind.axis is None else found[:, kind.axis]
