"""`crankcheck.testing.assert_within`: the verdict as an assertion, for anybody's tests."""

from __future__ import annotations

from collections.abc import Iterable

from models.errors import CrankcheckError, suggestion
from reports.face.any_log import LogLike, MapLike
from reports.face.arguments import SceneLike
from reports.face.cell_verdict import CellVerdict
from reports.face.log_verdict import LogVerdict, Target, judged
from reports.face.told import told_at_the_call
from reports.judge.tolerance import DEFAULTS
from reports.plan.steps import positive
from sim.engine import Run

BY_ARGUMENT = {name.replace("-", "_"): name for name in DEFAULTS}
"""Tolerances as arguments, which have no dashes in their names."""


@told_at_the_call
def assert_within(
    scene: SceneLike,
    log: Run | LogLike,
    *,
    target: float | None = None,
    step_s: float | None = None,
    map: MapLike = None,
    require: str | Iterable[str] = (),
    **tolerances: float,
) -> CellVerdict | LogVerdict:
    """Assert that a run, a motion or a log of a scene is within tolerance.

    Parameters
    ----------
    scene, log, step_s, map, require
        As of `judge`.
    target : float or None
        The largest error as a pure number, for the quantities that are not named.
    **tolerances : float
        The same for one quantity each: ``angle=1e-4``, ``velocity_differenced=1e-3``.

    Returns
    -------
    CellVerdict or LogVerdict
        What `judge` gives, where it is within tolerance.

    Raises
    ------
    AssertionError
        It is not: the message is the table that the command prints, with what is out and why.
    CrankcheckError
        As of `judge`; a tolerance of what is no quantity, whose message suggests the near ones.
    """
    limits = {_quantity(name): number for name, number in tolerances.items()}
    wanted: Target = limits or None
    if target is not None:
        every = positive("--target", target, "pure numbers, such as 1e-3")
        wanted = {**dict.fromkeys(DEFAULTS, every), **limits} if limits else every
    found = judged(
        scene, log, target=wanted, step_s=step_s, drive="scene", map=map, require=require
    )
    if found.verdict != "within":
        raise AssertionError(f"\n{found}")
    return found


def _quantity(argument: str) -> str:
    """The quantity of an argument. Raises CrankcheckError for one that is none."""
    if argument in BY_ARGUMENT:
        return BY_ARGUMENT[argument]
    hint = suggestion(argument, BY_ARGUMENT, "use one of", 2, 0.6)
    raise CrankcheckError(f"{argument}: it is no quantity; {hint}")
