"""The cells of a study, each with the key that names its result."""

import hashlib
import itertools
import json
import math
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from models.errors import CrankcheckError, few
from models.files.assemble import scene_text
from models.files.reading import names_of_scenes, scene_texts, shipped
from models.scene import Scene
from reports.judge.cell import Cell
from reports.output.numbers import count as told
from reports.plan.requirements import by_contact, refuse_rigid, scenes_of
from reports.plan.singular import gives_forces
from reports.plan.study import UNITS, Study, Variant
from reports.protocol.length import GivenAs, Planned
from reports.protocol.way import driven_by, way_of
from sim.engine import SettingValue
from sim.engine.settings import profile_of, resolved
from sim.registry import engine

MOST_CELLS = 100_000
"""Most cells of a sweep: a day's work for one machine, and more settings than anybody looks at."""
ENDLESS = 10**15
"""Variants beyond which none are counted."""


@dataclass(frozen=True)
class Task:
    """A cell with its names: its own ``key``, and the ``line`` of cells that differ in step only.

    ``settings`` is the complete set for the engine.
    """

    cell: Cell
    key: str
    line: str
    variant: str
    version: str
    scene_digest: str
    settings: Mapping[str, SettingValue]

    @property
    def label(self) -> str:
        cell = self.cell
        step = cell.way.clock.short(cell.dt_s, cell.steps_per_turn)
        return f"{cell.scene.name}, {cell.engine} {self.variant}, {step}"


@dataclass(frozen=True)
class Grid:
    """The tasks of a study, each key once, and the text of every scene by its name."""

    tasks: tuple[Task, ...]
    texts: Mapping[str, str]


def grid(study: Study) -> Grid:
    """Lay out a study. Raises CrankcheckError for a scene, engine, profile, setting or step that
    can not be run."""
    refuse_endless(study)
    scenes = scenes_of(study.scenes, free=study.free)
    texts = scene_texts(study.scenes)
    scenes = by_contact(scenes, study.facets)
    texts |= {scene.name: scene_text(scene) for scene in scenes if scene.name not in texts}
    refuse_rigid(scenes, study.segments or None, study.springs or None)
    variants = [one for variant in study.variants for one in variant.each()]
    adapters = [engine(name) for name in dict.fromkeys(variant.engine for variant in variants)]
    versions = {adapter.name: adapter.version() for adapter in adapters}
    complete = [(v, _complete(v)) for v in variants]
    _refuse_twins(complete)
    tasks: dict[str, Task] = {}
    for scene in scenes:
        name = digest(texts[scene.name])
        given = [(bent, _steps(study, scene, bent)) for bent in way_of(scene).given_by(study)]
        for (variant, settings), (bent, steps) in itertools.product(complete, given):
            for dt_s, count in steps:
                cell = Cell(
                    scene=scene,
                    engine=variant.engine,
                    profile=variant.profile,
                    dt_s=dt_s,
                    steps=count,
                    gated=variant.profile == "tuned" and not variant.settings,
                    drive=driven_by(scene, study.drive),
                    converge=False,
                    settings=variant.chosen,
                    with_forces=study.forces and gives_forces(variant.engine),
                    segments=bent.segments,
                    springs=bent.springs,
                )
                version = versions[variant.engine]
                turns = cell.turns if study.free else study.turns
                acting = _acting(cell, settings)
                line = line_key(cell, turns, name, version, acting)
                key = _hash([line, cell.dt_s.hex(), cell.steps])
                tasks.setdefault(
                    key, Task(cell, key, line, variant.name + bent.words, version, name, acting)
                )
    return Grid(tuple(tasks.values()), texts)


def _steps(study: Study, scene: Scene, given: GivenAs) -> list[tuple[float, int]]:
    """Return steps [s] and numbers of steps of a scene. Raises CrankcheckError where it is too
    long."""
    way = way_of(scene)
    steps = [way.counted(scene, each, given) for each in way.lengths(scene, study, given)]
    longest = max(steps, key=lambda step: step[0] * step[1])
    way.refuse(Planned(scene, *longest, given, study.forces))
    return steps


def refuse_endless(study: Study) -> None:
    """Refuse more cells than anybody waits for, before they are laid out. Raises CrankcheckError
    that names the large factors."""
    scenes, steps = len(names_of_scenes(study.scenes) or shipped()), len(study.steps)
    lists = [
        {name: len(values) for name, values in variant.lists.items() if len(values) > 1}
        for variant in study.variants
    ]
    bent = max(len(study.segments), 1) * max(len(study.springs), 1) * max(len(study.facets), 1)
    numbers = [min(math.prod(each.values()), ENDLESS) for each in lists]
    if (cells := scenes * sum(numbers) * steps * bent) > MOST_CELLS:
        largest = lists[numbers.index(max(numbers))]
        several = few((f"{number} of {name}" for name, number in largest.items()), 6)
        raise CrankcheckError(
            f"the study has {cells:.6g} cells: {told(scenes, 'scene')} x {sum(numbers):.6g} "
            "variants"
            + f" (one has {several}, in all combinations)"
            * bool(several)
            + f" x {steps} steps{UNITS[study.lists[0]]}; a sweep has at most "
            f"{MOST_CELLS}: take fewer of them"
        )


def _acting(cell: Cell, settings: Mapping[str, SettingValue]) -> dict[str, SettingValue]:
    """Return the settings of a complete set that can have an effect: of beams, only with beams."""
    beams = bool(cell.scene.elastic) and cell.springs == "beam"
    own = profile_of(engine(cell.engine), cell.profile).settings
    return {name: value for name, value in settings.items() if beams or not own[name].of_beams}


def _complete(variant: Variant) -> dict[str, SettingValue]:
    """Return all settings of a variant. Raises CrankcheckError for a setting that the engine lacks,
    a value that it does not take, or a name that readers would take for another profile."""
    chosen = engine(variant.engine)
    settings = resolved(profile_of(chosen, variant.profile), variant.chosen)
    chosen.check(settings)
    if variant.name in chosen.profiles and (variant.name != variant.profile or variant.chosen):
        raise CrankcheckError(
            f"variant {variant.name!r} of {variant.engine}: that is the name of a profile, and "
            "these are other settings; give it another name"
        )
    return settings


def _refuse_twins(complete: Iterable[tuple[Variant, Mapping[str, SettingValue]]]) -> None:
    """Refuse two variants of an engine that share a name and differ in settings."""
    by_name: dict[tuple[str, str], Mapping[str, SettingValue]] = {}
    for variant, settings in complete:
        if by_name.setdefault((variant.engine, variant.name), settings) != settings:
            raise CrankcheckError(
                f"variant {variant.name!r}: two of {variant.engine} have that name, and other "
                "settings; give each a name of its own"
            )


MEASURE = 2
"""Version of the measurement, raised with any change of it: older rows are then not reused."""


def digest(text: str) -> str:
    """Return the hash of a scene's text, in which comments and layout do not count.

    The order of its tables does: engines solve joints in that order, and err otherwise in another.
    """
    return _hash(tomllib.loads(text))


def shape_digest(text: str) -> str:
    """Return the hash of a scene's text, in which the size and direction of the driver's speed do
    not count either: without a time scale of their own, scenes alike in this have the same angles
    at the same steps in a turn."""
    table = tomllib.loads(text)
    driver = table.get("driver")
    if isinstance(driver, dict):
        driver.pop("speed_rad_s", None)
    return _hash(table)


def line_key(
    cell: Cell, turns: float, scene_digest: str, version: str, settings: Mapping[str, SettingValue]
) -> str:
    """Return the key of all cells that differ in step only.

    ``turns`` is the requested number, which the steps of a cell may not divide; ``settings`` is the
    complete set. Engines did not always take loads and friction: rows of that time, which say
    "unsupported", have another name than those of today.
    """
    return _hash(
        [
            MEASURE,
            scene_digest,
            cell.engine,
            version,
            sorted(settings.items()),
            cell.drive,
            turns,
            *(["forces"] if cell.with_forces else ()),
            *(["loads"] if cell.scene.loads else ()),
            *(["friction"] if cell.scene.friction else ()),
            *cell.way.key(cell.given_as),
        ]
    )


def _hash(value: object) -> str:
    """Return a hash of 160 bits: enough for any store, and short enough for a file name."""
    text = json.dumps(value, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:40]
