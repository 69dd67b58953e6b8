"""Arguments of a sweep in Python, in the form of the command."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence, Sized
from contextlib import ExitStack, suppress
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from models.errors import CrankcheckError
from models.files import assemble, reading
from reports.plan import chosen_study
from reports.plan.steps import positive
from reports.plan.study import StudyValue
from reports.requests import arguments
from reports.workers.isolated import checked_limits

if TYPE_CHECKING:
    from reports.sweep.running import Manner

MOST_JOBS = 1024


def refuse_empty_lists(values: Mapping[str, object]) -> None:
    """Refuse empty lists and the like: () alone keeps the values of the study. Raises
    CrankcheckError that names the argument."""
    for name, value in values.items():
        if isinstance(value, str | tuple) or not isinstance(value, Sized):
            continue
        with suppress(TypeError):  # of a number in an array of numpy, which has no length
            if len(value) == 0:
                found = f"found nothing in it ({arguments.kind_of(value)})"
                raise CrankcheckError(
                    f"{name}: {found}; give at least one, or () for those of the study"
                )


def manner_of(
    limit_s: float,
    memory_gb: float,
    jobs: int,
    *,
    timing: bool,
    keep_trajectories: bool,
    again: bool,
) -> Manner:
    """The manner of running cells. Raises CrankcheckError for invalid arguments."""
    limits = checked_limits(
        positive("--limit-s", limit_s, "seconds"), positive("--memory-gb", memory_gb, "GB")
    )
    jobs = arguments.whole_of(jobs, "--jobs", 0)
    if jobs > MOST_JOBS:
        raise CrankcheckError(f"--jobs {jobs}: at most {MOST_JOBS}; 0 is one per processor")
    from reports.sweep.running import Manner  # pandas, which takes a third of a second

    return Manner(
        limits,
        jobs,
        timing=arguments.is_true(timing, "timing"),
        keep_runs=arguments.is_true(keep_trajectories, "keep_trajectories"),
        again=arguments.is_true(again, "again"),
    )


def scene_names(scenes: object, kept: ExitStack) -> list[str]:
    """Names and paths of scenes; any other scene is written into a file, which is ``kept``. Raises
    CrankcheckError for values that are no scene."""
    names: list[str] = []
    for each in arguments.each_of(scenes):
        if isinstance(each, str | PathLike):
            names.append(str(arguments.path_of(each, "scenes")))
            continue
        scene = arguments.scene_of(each)
        if scene.name in reading.every_shipped() and reading.load_scene(scene.name) == scene:
            names.append(scene.name)
            continue
        path = Path(kept.enter_context(TemporaryDirectory())) / f"{scene.name}.toml"
        path.write_text(assemble.scene_text(scene), encoding="utf-8")
        names.append(str(path))
    return names


def numbers_of(
    values: float | Iterable[float], option: str, unit: str = "steps, such as 720"
) -> list[float]:
    """One number or several, above 0, as a list. Raises CrankcheckError."""
    return [positive(option, value, unit) for value in arguments.each_of(values)]


def overrides_of(settings: object, engines: Sequence[str]) -> chosen_study.Overrides:
    """Settings by engine. Raises CrankcheckError for names that are not engine.setting."""
    if settings is None:
        return {}
    cure = "give a dict such as {'ENGINE.iterations': [2, 10]}"
    if not isinstance(settings, Mapping):
        raise arguments.wrong_kind("--set", settings, cure)
    found: dict[str, dict[str, StudyValue | list[StudyValue]]] = {}
    for name, values in settings.items():
        owner, dot, setting = str(name).partition(".")
        if not dot:
            raise CrankcheckError(f"--set {name!r}: no engine and setting; {cure}")
        chosen_study.refuse_other_engine(owner, engines, f"--set {name!r}")
        plain: list[StudyValue] = [
            arguments.setting_of(name, value) for value in arguments.each_of(values)
        ]
        if not plain:
            raise CrankcheckError(f"--set {name!r}: found no value; give one, or several")
        found.setdefault(owner, {})[setting] = plain
    return found
