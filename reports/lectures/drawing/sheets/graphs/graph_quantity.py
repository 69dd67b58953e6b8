"""What graphs are drawn of: the angle of a link, the way of a slider, a coordinate of a point."""

from __future__ import annotations

from dataclasses import dataclass

from models.errors import CrankcheckError, suggestion
from models.motion import Motion
from reports.logs.kinds import KINDS, Kind, LoggedKind

AXES = ("x", "y")


@dataclass(frozen=True)
class GraphedQuantity:
    """A quantity of a ``body`` with both of its rates: how a motion holds them, their symbols, and
    what their unit is before any s."""

    name: str
    body: str
    kinds: tuple[Kind, Kind, Kind]
    symbols: tuple[str, str, str]
    unit: str


def quantity_of(motion: Motion, name: str) -> GraphedQuantity:
    """The quantity of that name: a link, a slider, or a coordinate of a point (C.x). Raises
    CrankcheckError for what the motion has not."""
    point, _, axis = name.partition(".")
    if name in motion.links:
        kinds = _kinds("link", "angle", "angular velocity", "angular acceleration")
        return GraphedQuantity(name, name, kinds, ("phi", "omega", "epsilon"), "rad")
    if name in motion.sliders:
        kinds = _kinds("slider", "displacement", "speed", "acceleration")
        return GraphedQuantity(name, name, kinds, ("s", "v", "a"), "m")
    if point in motion.points and axis in AXES:
        kinds = _kinds("point", axis, f"v{axis}", f"a{axis}")
        return GraphedQuantity(name, point, kinds, ("s", "v", "a"), "m")
    known = [*motion.links, *motion.sliders, *(f"{p}.{a}" for p in motion.points for a in AXES)]
    raise CrankcheckError(f"--of {name}: {suggestion(name, known, 'there are')}")


def _kinds(of: LoggedKind, value: str, rate: str, second: str) -> tuple[Kind, Kind, Kind]:
    return KINDS[of, value], KINDS[of, rate], KINDS[of, second]
