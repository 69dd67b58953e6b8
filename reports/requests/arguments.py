"""Arguments of a call, checked before anything is done, and the messages on mistakes there."""

from __future__ import annotations

import functools
import inspect
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import lru_cache
from numbers import Integral, Real
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar, cast

import numpy as np

from analytic.cams.outline import outlined
from models.errors import CrankcheckError, shown, suggestion
from models.files.reading import every_shipped, load_scene
from models.scene import KEPT, Scene
from reports.output.numbers import listed
from reports.plan.steps import positive
from reports.quantities.limits import EVERY
from sim.engine import SettingValue
from sim.engine.settings import profile_of, resolved
from sim.registry import FIRST, engine

if TYPE_CHECKING:
    from reports.judge.cell import Checked
    from reports.own_log.judged import JudgedLog


SceneLike = Scene | str | PathLike[str]
"""A shipped name, the path of a scene file, or a scene."""


def scene_of(scene: SceneLike) -> Scene:
    """The scene of an argument. Raises CrankcheckError as `load_scene`, and for other values."""
    if isinstance(scene, Scene):
        return outlined(scene)
    if isinstance(scene, str) and scene in every_shipped():
        return outlined(_shipped(scene))
    if not isinstance(scene, str | PathLike):
        cure = "give a shipped name, the path of a scene file, or a Scene"
        raise wrong_kind("scene", scene, cure)
    return outlined(load_scene(scene))


@lru_cache(maxsize=KEPT)
def _shipped(name: str) -> Scene:
    """A shipped scene, the same object every time, so that its cached results are kept."""
    return load_scene(name)


def kind_of(value: object) -> str:
    """The wrong value as named in a message: itself where it is short, else its type."""
    if isinstance(value, str | int | float | bytes | None):
        return shown(value)
    name = type(value).__qualname__
    return f"{'an' if name[0] in 'AEIOUaeiou' else 'a'} {name}"


def wrong_kind(name: str, value: object, cure: str) -> CrankcheckError:
    """The error of an argument, or of an option, that has a value of another kind."""
    return CrankcheckError(f"{name}: found {kind_of(value)}; {cure}")


def text_of(value: object, name: str, such_as: str) -> str:
    """A text. Raises CrankcheckError for anything else."""
    if isinstance(value, str):
        return value
    raise wrong_kind(name, value, f"give a name, such as {such_as!r}")


def one_of(value: object, name: str, choices: Iterable[str]) -> str:
    """Return a value that is among ``choices``. Raises CrankcheckError that lists them."""
    every = list(choices)
    if isinstance(value, str) and value in every:
        return value
    raise CrankcheckError(f"{name} {shown(value)}: unknown; use {listed(every, 'or')}")


def whole_of(value: object, name: str, least: int = 1) -> int:
    """A whole number. Raises CrankcheckError for another, or one below ``least``."""
    if isinstance(value, Integral) and not isinstance(value, bool) and int(value) >= least:
        return int(value)
    raise wrong_kind(name, value, f"give a whole number, at least {least}")


def is_true(value: object, name: str) -> bool:
    """True or False. Raises CrankcheckError for anything else."""
    if isinstance(value, bool | np.bool_):
        return bool(value)
    raise wrong_kind(name, value, "give True or False")


def path_of(value: object, name: str) -> Path:
    """A path. Raises CrankcheckError for anything else."""
    try:
        text = fspath(value)  # type: ignore[call-overload]  # checked here
    except TypeError:
        text = None
    if isinstance(text, str) and text and "\0" not in text:
        return Path(text)
    raise wrong_kind(name, value, "give a path")


def engine_of(name: object, profile: object, settings: object) -> tuple[str, str]:
    """Engine and profile, with its settings overridden, once all of them are known to exist.

    Raises EngineError for an engine that is unknown or not installed, a profile or setting that it
    has not, a value that it does not take.
    """
    chosen = engine(text_of(name, "engine", FIRST))
    chosen.version()
    of = profile_of(chosen, text_of(profile, "profile", next(iter(chosen.profiles))))
    chosen.check(resolved(of, settings_of(settings)))
    return chosen.name, of.name


def settings_of(settings: object) -> dict[str, SettingValue]:
    """Settings by name, numbers of numpy as plain ones. Raises CrankcheckError."""
    if settings is None:
        return {}
    if not isinstance(settings, Mapping):
        cure = "give a dict of names and values, such as {'iterations': 100}"
        raise wrong_kind("settings", settings, cure)
    return {
        text_of(name, "settings", "iterations"): setting_of(name, value)
        for name, value in settings.items()
    }


def setting_of(name: object, value: object) -> SettingValue:
    """A setting's value, as a plain one. Raises CrankcheckError for neither number nor text."""
    if isinstance(value, str):
        return str(value)
    if isinstance(value, Real) and not isinstance(value, bool):
        return int(value) if isinstance(value, Integral) else float(value)
    raise wrong_kind(f"setting {name}", value, "it takes a number or a text")


def tolerances_of(tolerance: object, option: str) -> dict[str, float]:
    """Tolerances by quantity, as pure numbers.

    Raises CrankcheckError for no mapping, an unknown quantity (the message suggests near ones), a
    number that is not above 0.
    """
    if tolerance is None:
        return {}
    if not isinstance(tolerance, Mapping):
        cure = "give a dict of quantities and numbers, such as {'angle': 1e-4}"
        raise wrong_kind(option, tolerance, cure)
    found: dict[str, float] = {}
    for name, number in tolerance.items():
        if name not in EVERY:
            hint = suggestion(str(name), EVERY, "use one of", 2, 0.6)
            raise CrankcheckError(f"{option} {shown(name)}: not a quantity; {hint}")
        unit = "pure numbers: rad, lengths over that of the longest link"
        found[name] = positive(f"{option} {name}", number, unit)
    return found


def each_of(values: object) -> list[Any]:
    """A value as a list, or the values of a list or an array."""
    if isinstance(values, np.ndarray):
        values = values.tolist()
    several = isinstance(values, Iterable) and not isinstance(values, str | bytes | Mapping)
    return list(cast(Iterable[Any], values)) if several else [values]


Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")
SAME = (
    "steps-per-turn turns every drive target map modes axial-modes elements shape linear require "
    "jobs limit-s memory-gb delta key branch engine profile"
)
ARGUMENTS = {
    "--dt": "dt_s",
    "--duration": "duration_s",
    "--tol": "tolerance",
    "--target angle=1e-3": "target={'angle': 1e-3}",
    "--step": "step_s",
    "--write-map": "crankcheck judge --write-map",
    "--set": "settings",
    "sweep --set": "settings",
    "--speed": "speed_rad_s",
    "--start": "start_rad",
    "-o": "output",
    **{f"--{name}": name.replace("-", "_") for name in SAME.split()},
}
"""Arguments of the Python functions, by the option of the command."""
OTHERS: Mapping[str, str] = {"engine": "engines", "profile": "profiles", "output": "folder"}
"""Names of the arguments in functions that have none of the first name."""
OPTION = re.compile(rf"(?<![\w./-])({'|'.join(sorted(ARGUMENTS, key=len, reverse=True))})(?![\w-])")


def told_at_the_call(function: Callable[Parameters, Result]) -> Callable[Parameters, Result]:
    """Wrap a function so that its CrankcheckErrors name arguments in place of options, and have a
    traceback that ends here: deeper frames are none of the caller's business."""
    own = inspect.signature(function).parameters
    arguments = {
        option: OTHERS[name] if name not in own and OTHERS.get(name) in own else name
        for option, name in ARGUMENTS.items()
    }

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


def in_python(text: str, arguments: Mapping[str, str] = ARGUMENTS) -> str:
    """A text of the command, with arguments in place of options."""
    return OPTION.sub(lambda hit: arguments[hit[1]], text)


def parts_in_python(judged: Checked | JudgedLog, tolerance: str = "tolerance") -> dict[str, Any]:
    """The fields of a judged run or log, with arguments in place of options in their words;
    ``tolerance`` is the argument that gave the tolerances."""

    def told(text: str) -> str:
        return in_python(text, {**ARGUMENTS, "--tol": tolerance})

    findings = (
        replace(each, text=told(each.text), cure=told(each.cure)) for each in judged.findings
    )
    limits = {name: replace(each, origin=told(each.origin)) for name, each in judged.limits.items()}
    changed = {"findings": tuple(findings), "limits": limits, "remedy": told(judged.remedy)}
    return vars(judged) | changed
