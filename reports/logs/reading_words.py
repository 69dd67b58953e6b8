"""The words for kinds of readings: angle, omega, vx, stroke."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from models.errors import cut
from reports.logs.kinds import KINDS, Kind, LoggedKind
from reports.logs.own_columns import LENGTH
from reports.logs.spelling import DIMENSION

PLACES = {"pos", "position", "place", "coordinate", "coord"}
SPEEDS = {"v", "vel", "velocity", "speed", "rate"}
ACCELERATIONS = {"a", "acc", "accel", "acceleration"}
TURNING: Sequence[set[str]] = (
    {"theta", "angle", "ang", "phi", "rot", "rotation", "orientation", "q", *PLACES},
    {"omega", "w", "angvel", "thetadot", "dtheta", "qd", *SPEEDS},
    {"alpha", "angacc", "thetaddot", "qdd", *ACCELERATIONS},
)
SLIDING: Sequence[set[str]] = (
    {"displacement", "disp", "s", "stroke", "travel", *PLACES},
    {"sdot", *SPEEDS},
    {"sddot", *ACCELERATIONS},
)
AXES = {f"{prefix}{axis}": (order, at) for at, axis in enumerate("xy") for order, prefix in
        enumerate(("", "v", "a"))} | {"px": (0, 0), "py": (0, 1)}  # fmt: skip


def kind_of_words(
    kinds: Sequence[LoggedKind], words: Sequence[str], unit: str, *, slider: bool
) -> Kind | str:
    """The kind of reading that words and a unit name, or why none."""
    dimension = DIMENSION.get(unit)
    if "elastic" in kinds and ("elastic", " ".join(words)) in KINDS:
        return KINDS["elastic", " ".join(words)]
    if "link" in kinds:
        if len(words) > 1 and words[-1] == "z":  # the axis that all turn about
            words = words[:-1]
        order = _order(words, TURNING)
        chosen = [k for k in KINDS.values() if k.body_kind == "link" and k.order == order]
        if not words:
            chosen = [k for k in KINDS.values() if k.body_kind == "link"]
            chosen = [k for k in chosen if k.dimension == (dimension or "angle")]
        return chosen[0] if chosen else _unknown(words, "link", unit)
    axis = None if slider else _axis(words)
    if "point" in kinds and axis:
        order, at = axis
        of = [k for k in KINDS.values() if k.body_kind == "point"]
        return next(k for k in of if (k.order, k.axis) == (order, at))
    if "slider" in kinds:
        order = _order(words, SLIDING)
        chosen = [k for k in KINDS.values() if k.body_kind == "slider" and k.order == order]
        if not words:
            chosen = [k for k in KINDS.values() if k.body_kind == "slider"]
            chosen = [k for k in chosen if k.dimension == (dimension or "length")]
        return chosen[0] if chosen else _unknown(words, "slider", unit)
    if list(words) in (["v"], ["a"]):
        return LENGTH
    return _unknown(words, "point", unit)


def _order(words: Sequence[str], names: Sequence[set[str]]) -> int | None:
    """Which derivative some words name; None where they name none, or several."""
    orders = {n for word in words for n, known in enumerate(names) if word in known}
    known = set().union(*names)
    if len(orders) == 2 and 0 in orders and not PLACES.isdisjoint(names[0]):
        orders -= {0}  # angle velocity
    return orders.pop() if len(orders) == 1 and known.issuperset(words) else None


def _axis(words: Sequence[str]) -> tuple[int, int] | None:
    """Derivative and axis of a point's component; None where the words name none."""
    axes = [word for word in words if word in AXES]
    if len(axes) != 1:
        return None
    order, axis = AXES[axes[0]]
    for word in words:
        if word == axes[0] or word in PLACES | {"p"}:
            continue
        if word in SPEEDS and order == 0:
            order = 1
        elif word in ACCELERATIONS and order == 0:
            order = 2
        else:
            return None
    return order, axis


def _unknown(words: Sequence[str], kind: str, unit: str) -> str:
    """Why nothing is made of a column of a body."""
    told: Mapping[str, str] = {
        "link": "angle, angular velocity or angular acceleration",
        "point": "x, y, vx, vy, ax or ay",
        "slider": "displacement, speed or acceleration",
    }
    if words:
        return f"{cut(' '.join(words))!r} is no kind of reading of a {kind}: {told[kind]}"
    of = f"{unit} is a unit of {DIMENSION[unit]}, and" if unit else "it tells no kind:"
    return f"{of} a {kind} has {told[kind]}"
