"""`crankcheck.testing.assert_within`: the verdict as an assertion, for anybody's tests."""

from __future__ import annotations

from collections.abc import Iterable
from numbers import Real

from models.errors import CrankcheckError, shown, suggestion
from reports.plan.steps import positive
from reports.quantities.limits import DEFAULTS
from reports.requests.any_log import LogLike, LogOptions, MapLike
from reports.requests.arguments import SceneLike, is_true, told_at_the_call
from reports.requests.compare import CellVerdict
from reports.requests.judge import LogVerdict, Target, judged, target_of
from sim.engine import Run

BY_ARGUMENT = {name.replace("-", "_"): name for name in DEFAULTS if name != "drive"}
"""Tolerances as arguments, which have no dashes in their names; ``drive`` is another argument."""


@told_at_the_call
def assert_within(
    scene: SceneLike,
    log: Run | LogLike,
    *,
    target: Target = None,
    step_s: float | None = None,
    drive: str = "scene",
    map: MapLike = None,
    require: str | Iterable[str] = (),
    forces: bool = False,
    **tolerances: float,
) -> CellVerdict | LogVerdict:
    """Assert that a run, a motion or a log of a scene is within tolerance.

    Parameters
    ----------
    scene, log, step_s, drive, map, require, forces
        As in `judge`.
    target : float, Mapping or None
        As in `judge`, for the quantities that are not named.
    **tolerances : float
        The same for one quantity each: ``angle=1e-4``, ``velocity_differenced=1e-3``; that of
        quantity drive is ``target={"drive": 1e-6}``.

    Returns
    -------
    CellVerdict or LogVerdict
        The result of `judge`, where it is within tolerance.

    Raises
    ------
    AssertionError
        Out of tolerance: the message is the table of the command, with errors and reasons.
    CrankcheckError
        As in `judge`; a tolerance of an unknown quantity, whose message suggests near names.
    """
    __tracebackhide__ = True  # the line that asserts is the caller's
    if isinstance(drive, Real):
        raise CrankcheckError(
            f"drive: found {shown(drive)}; give scene, fitted or logged; the tolerance of quantity "
            "drive is target={'drive': 1e-6}"
        )
    unit = "pure numbers: rad, lengths over that of the longest link"
    named = {_quantity(name): positive(name, limit, unit) for name, limit in tolerances.items()}
    limits = target_of(target) | named
    options = LogOptions(step_s, drive, map, require, is_true(forces, "forces"))
    found = judged(scene, log, limits, options)
    if found.verdict != "within":
        raise AssertionError(f"\n{found}")
    return found


def _quantity(argument: str) -> str:
    if argument in BY_ARGUMENT:
        return BY_ARGUMENT[argument]
    hint = suggestion(argument, BY_ARGUMENT, "use one of", 2, 0.6)
    raise CrankcheckError(f"{argument}: not a quantity; {hint}")
