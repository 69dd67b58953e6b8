"""A user's mistake in a call is told at the call, in the words of the command."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Mapping
from typing import ParamSpec, TypeVar

from models.errors import CrankcheckError

Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")
ARGUMENTS: Mapping[str, str] = {
    "--dt": "dt_s",
    "--steps-per-turn": "steps_per_turn",
    "--turns": "turns",
    "--every": "every",
    "--drive": "drive",
    "--tol": "tolerance",
    "--target": "target",
    "--step": "step_s",
    "--map": "map",
    "--write-map": "crankcheck judge --write-map",
    "--require": "require",
    "--set": "settings",
    "--jobs": "jobs",
    "--limit-s": "limit_s",
    "--memory-gb": "memory_gb",
    "--speed": "speed_rad_s",
    "--key": "key",
    "--start": "start_rad",
    "--branch": "branch",
    "--engine": "engine",
    "--profile": "profile",
    "-o": "output",
}
"""Options of the commands, and what they are called in a call."""
OPTION = re.compile(rf"(?<![\w./-])({'|'.join(sorted(ARGUMENTS, key=len, reverse=True))})(?![\w-])")


def told_at_the_call(
    function: Callable[Parameters, Result],
) -> Callable[Parameters, Result]:
    """The function, whose CrankcheckErrors name arguments in place of options, and come from here:
    what lies deeper is none of the caller's business."""

    @functools.wraps(function)
    def called(*args: Parameters.args, **options: Parameters.kwargs) -> Result:
        try:
            return function(*args, **options)
        except CrankcheckError as error:
            error.args = tuple(_in_python(part) for part in error.args)
            raise error.with_traceback(None) from None

    return called


def _in_python(part: object) -> object:
    """A message that names arguments."""
    return OPTION.sub(lambda hit: ARGUMENTS[hit[1]], part) if isinstance(part, str) else part
