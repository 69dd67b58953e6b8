"""Errors of choices from a stored study at any step: its range, and the reasons for gaps."""

import itertools
import math
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from models.errors import EngineError
from models.files.reading import parse_scene
from models.scene import Scene
from models.scene.laws import ConstantSpeed
from models.scene.loads import ConstantFriction
from reports.advise.demand import Choice, Demand, key_of
from reports.plan.grid import shape_digest
from reports.results.floor_fit import interpolate
from reports.results.lines import Line
from reports.store.reader import Stored
from sim.engine.settings import profile_of, resolved
from sim.registry import engine

SAME_SPEED = 1e-9
"""Relative difference up to which two speeds are equal."""


@dataclass(frozen=True)
class MeasuredSteps:
    """Errors of place of one choice on one scene, by steps in a turn from few to many; infinite for
    a run that did not end well."""

    errors: tuple[tuple[float, float], ...]

    def error(self, steps_per_turn: float) -> float | None:
        """Return the error on a straight line in the logarithms between two measured steps; None
        outside, and beside a run that did not end well."""
        for (few, before), (many, after) in itertools.pairwise(self.errors):
            if few <= steps_per_turn <= many and math.isfinite(before) and math.isfinite(after):
                return interpolate((few, many), (before, after), steps_per_turn)
        return None

    def missed(self, steps_per_turn: float, target: float) -> float | None:
        """Return the fewest steps in a turn, of more than so many, with an error over target."""
        over = (n for n, error in self.errors if n > steps_per_turn and error > target)
        return next(over, None)


@dataclass(frozen=True)
class MeasuredStudy:
    """Measured steps of a store, by choice (its engine and settings) and scene; ``turns`` is the
    length of its shortest run, ``refusals`` say which lines do not serve, and why."""

    folder: Path | None = None
    turns: float = math.nan
    measured: Mapping[tuple[str, str], MeasuredSteps] = field(default_factory=dict, repr=False)
    refusals: tuple[str, ...] = ()

    def error(self, scene: Scene, choice: Choice, steps_per_turn: float) -> float | None:
        """Return the error of place of a run at so many steps in a turn; None if unknown."""
        steps = self._of(scene, choice)
        return None if steps is None else steps.error(steps_per_turn)

    def missed(
        self, scene: Scene, choice: Choice, steps_per_turn: float, target: float
    ) -> float | None:
        """Return the fewest steps in a turn, of more than so many, known to miss a target."""
        steps = self._of(scene, choice)
        return None if steps is None else steps.missed(steps_per_turn, target)

    def _of(self, scene: Scene, choice: Choice) -> MeasuredSteps | None:
        return self.measured.get((scene.name, choice.key))


def stored_scenes(stored: Stored) -> dict[str, str]:
    """Return the texts of the scenes that the store has cells of, by name."""
    names = set(stored.cells["scene"])
    return {name: text for name, text in stored.manifest.scenes.items() if name in names}


def stored_choices(every: Iterable[Line]) -> list[Choice]:
    """Return the settings of lines that the engines installed here take."""
    found: dict[str, Choice] = {}
    for line in every:
        with suppress(EngineError):  # an engine that is not here, or of other settings
            adapter = engine(line.engine)
            profile = str(line.cells["profile"].iloc[0])
            settings = resolved(profile_of(adapter, profile), line.settings)
            adapter.check(settings)
            choice = Choice(line.engine, line.variant, profile, settings)
            found.setdefault(choice.key, choice)
    return list(found.values())


def evidence(
    stored: Stored,
    every: Iterable[Line],
    demand: Demand,
    texts: Mapping[str, str],
    wanted: Iterable[Choice],
) -> MeasuredStudy:
    """Return the evidence of a store's lines on the demanded scenes of these texts, at their speed.

    A line of cells serves where the scene is the same but for the size of the speed, the engine is
    the version installed, the drive the usual one, and nothing but the crank sets a time scale: no
    gravity, loads or constant friction, and no setting in seconds, unless at the study's own speed.
    """
    by_key = {choice.key: choice for choice in wanted}
    scenes = {scene.name: scene for scene in demand.scenes}
    measured: dict[tuple[str, str], MeasuredSteps] = {}
    refusals: dict[str, list[str]] = {}
    turns = [math.inf]
    for line in every:
        scene, choice = scenes.get(line.scene), by_key.get(key_of(line.engine, line.settings))
        if scene is None or choice is None or line.scene not in stored.manifest.scenes:
            continue
        why = _refusal(line, stored.manifest.scenes[line.scene], scene, texts[line.scene], choice)
        if why:
            refusals.setdefault(why, []).append(choice.label)
            continue
        measured[line.scene, key_of(line.engine, line.settings)] = _steps(line)
        turns.append(float(line.cells["turns"].min()))
    absent = [name for name in scenes if name not in stored_scenes(stored)]
    told = [f"{', '.join(dict.fromkeys(labels))}: {why}" for why, labels in refusals.items()]
    told += [f"{', '.join(absent)}: not in the study"] if absent else []
    return MeasuredStudy(stored.folder, min(turns), measured, tuple(told))


def _refusal(line: Line, stored_text: str, scene: Scene, text: str, choice: Choice) -> str:
    """Say why a line does not serve; "" where it does."""
    if line.version != (here := engine(line.engine).version()):
        return f"of {line.engine} {line.version}; here it is {here}"
    if line.drive != "prescribed":
        return f"under the drive {line.drive}"
    if shape_digest(stored_text) != shape_digest(text):
        return f"another scene {line.scene}"
    law = parse_scene(stored_text, line.scene).driver.law
    ours = scene.driver.law
    assert isinstance(law, ConstantSpeed)  # as the shapes are the same
    assert isinstance(ours, ConstantSpeed)
    if law.speed_rad_s * ours.speed_rad_s < 0.0:
        return f"{line.scene} turns the other way"
    if math.isclose(law.speed_rad_s, ours.speed_rad_s, rel_tol=SAME_SPEED):
        return ""
    if own := _forces_of_their_own(scene):
        return f"{line.scene} has {own}, and turns at {law.speed_rad_s:g} rad/s there"
    if choice.in_seconds:
        named = ", ".join(choice.in_seconds)
        return f"{named} in seconds, measured at {law.speed_rad_s:g} rad/s"
    return ""


def _forces_of_their_own(scene: Scene) -> str:
    """Return forces that, unlike inertia, do not grow with the speed squared; "" if none."""
    found = {
        "gravity": scene.gravity_m_s2 != (0.0, 0.0),
        "loads": bool(scene.loads),
        "constant friction": any(isinstance(f, ConstantFriction) for f in scene.friction.values()),
    }
    return ", ".join(name for name, has in found.items() if has)


def _steps(line: Line) -> MeasuredSteps:
    columns = ("steps_per_turn", "status", "place_pure")
    rows = zip(*(line.cells[name] for name in columns), strict=True)
    errors = (
        (float(steps), float(error) if status == "ok" and math.isfinite(error) else math.inf)
        for steps, status, error in rows
    )
    return MeasuredSteps(tuple(sorted(errors)))
