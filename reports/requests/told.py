"""What is said to a caller in Python: of arguments, where the command has options; and of a mistake
at the call."""

from __future__ import annotations

import functools
import inspect
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

from models.errors import CrankcheckError

if TYPE_CHECKING:
    from reports.judge.cell import Checked
    from reports.own_log.judged import JudgedLog

Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")
ARGUMENTS: Mapping[str, str] = {
    "--dt": "dt_s",
    "--duration": "duration_s",
    "--steps-per-turn": "steps_per_turn",
    "--turns": "turns",
    "--every": "every",
    "--drive": "drive",
    "--tol": "tolerance",
    "--target": "target",
    "--target angle=1e-3": "target={'angle': 1e-3}",
    "--step": "step_s",
    "--map": "map",
    "--modes": "modes",
    "--axial-modes": "axial_modes",
    "--elements": "elements",
    "--shape": "shape",
    "--linear": "linear",
    "--write-map": "crankcheck judge --write-map",
    "--require": "require",
    "--set": "settings",
    "sweep --set": "settings",
    "--jobs": "jobs",
    "--limit-s": "limit_s",
    "--memory-gb": "memory_gb",
    "--speed": "speed_rad_s",
    "--delta": "delta",
    "--key": "key",
    "--start": "start_rad",
    "--branch": "branch",
    "--engine": "engine",
    "--profile": "profile",
    "-o": "output",
}
"""Options of the commands, and what they are called in a call."""
OTHERS: Mapping[str, str] = {"engine": "engines", "profile": "profiles", "output": "folder"}
"""What functions call them that have no argument of that name."""
OPTION = re.compile(rf"(?<![\w./-])({'|'.join(sorted(ARGUMENTS, key=len, reverse=True))})(?![\w-])")


def told_at_the_call(
    function: Callable[Parameters, Result],
) -> Callable[Parameters, Result]:
    """The function, whose CrankcheckErrors name arguments in place of options, and come from here:
    what lies deeper is none of the caller's business."""
    arguments = _arguments_of(function)

    @functools.wraps(function)
    def called(*args: Parameters.args, **options: Parameters.kwargs) -> Result:
        __tracebackhide__ = True  # of pytest and IPython: they show the caller's line
        try:
            return function(*args, **options)
        except CrankcheckError as error:
            error.args = tuple(
                in_python(each, arguments) if isinstance(each, str) else each for each in error.args
            )
            raise error.with_traceback(None) from None

    return called


def _arguments_of(function: Callable[..., object]) -> Mapping[str, str]:
    """Options, and what this function calls them."""
    own = inspect.signature(function).parameters
    return {
        option: OTHERS[name] if name not in own and OTHERS.get(name) in own else name
        for option, name in ARGUMENTS.items()
    }


def in_python(text: str, arguments: Mapping[str, str] = ARGUMENTS) -> str:
    """A text of the command that names arguments in place of options."""
    return OPTION.sub(lambda hit: arguments[hit[1]], text)


def parts_in_python(judged: Checked | JudgedLog, tolerance: str = "tolerance") -> dict[str, Any]:
    """The fields of what was judged, whose words name arguments in place of options; ``tolerance``
    is the one by which tolerances were given."""

    def told(text: str) -> str:
        return in_python(text, {**ARGUMENTS, "--tol": tolerance})

    findings = (
        replace(each, text=told(each.text), cure=told(each.cure)) for each in judged.findings
    )
    limits = {name: replace(each, origin=told(each.origin)) for name, each in judged.limits.items()}
    changed = {"findings": tuple(findings), "limits": limits, "remedy": told(judged.remedy)}
    return vars(judged) | changed
