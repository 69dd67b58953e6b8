"""A demand: scenes, speed, frame and error; and the evidence of a stored study for a choice."""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

from models.errors import CrankcheckError, EngineError
from models.files.reading import parse_scene
from models.scene import Scene
from models.scene.laws import ConstantSpeed
from models.scene.loads import ConstantFriction
from reports.judge.cell import Cell
from reports.plan import grid, singular, study
from reports.plan.steps import LEAST_STEPS_PER_TURN, MOST_SEARCHED, positive
from reports.results.floor_fit import interpolate
from reports.results.lines import OWN, Line, value_text
from reports.store.reader import Stored
from sim.engine import AT_ROUNDING, SettingValue
from sim.engine.settings import profile_of, resolved
from sim.registry import engine

MOST_SUBSTEPS = 4096
"""Most sub-steps of a frame; a need for more shows wrong settings."""
COARSEST = 1.0
"""Upper limit of a target, an error of place: a radian, or the longest link."""
SLOWEST, FASTEST = 1e-9, 1e9
"""Speeds of a driver [rad/s]."""


@dataclass(frozen=True)
class Demand:
    """Scenes whose drivers turn at one speed [rad/s], and a program's frame [s].

    ``target`` is the error of place (angle [rad], position and displacement over the longest link)
    that a run of ``turns`` may have at most; the worst of the scenes counts.
    """

    scenes: tuple[Scene, ...]
    speed_rad_s: float
    frame_s: float
    target: float
    turns: float

    @property
    def period_s(self) -> float:
        """Period of a turn [s]."""
        return math.tau / abs(self.speed_rad_s)

    @property
    def frames_per_turn(self) -> float:
        return self.period_s / self.frame_s

    @property
    def least(self) -> int:
        """Fewest sub-steps of a frame that give a turn enough steps."""
        return max(1, math.ceil(LEAST_STEPS_PER_TURN * (1 - 1e-12) / self.frames_per_turn))

    @property
    def most(self) -> int:
        """Most sub-steps of the search; a run with twice as many is still possible."""
        return min(MOST_SUBSTEPS, int(MOST_SEARCHED / (2.0 * self.turns * self.frames_per_turn)))

    def steps_per_turn(self, substeps: int) -> float:
        return self.frames_per_turn * substeps

    def cell(self, scene: Scene, choice: Choice, substeps: int, longer: float = 1.0) -> Cell:
        """Return a run with a frame cut into equal parts, ``longer`` times the demanded length, as
        far as steps are run."""
        least = math.ceil(self.turns * self.steps_per_turn(substeps) * (1 - 1e-12))
        steps = max(least, min(math.ceil(longer * least), MOST_SEARCHED))
        names, dt_s = (choice.engine, choice.profile), self.frame_s / substeps
        return Cell(
            scene, *names, dt_s, steps, gated=False, converge=False, settings=choice.settings
        )


def at_speed(scene: Scene, speed_rad_s: float) -> Scene:
    """Return the scene with its driver at another constant speed, from where it starts.

    Raises CrankcheckError for a driver with another law, which no speed can replace.
    """
    law = scene.driver.law
    if not isinstance(law, ConstantSpeed):
        raise CrankcheckError(
            f"scene {scene.name}: its driver does not turn at a constant speed, and --speed can "
            'not take the place of its law; leave the scene out, or give it law = "constant" with '
            "a start_deg"
        )
    return replace(scene, driver=replace(scene.driver, law=replace(law, speed_rad_s=speed_rad_s)))


def demanded(
    scenes: Sequence[Scene], speed_rad_s: float, frame_s: float, target: float, turns: float
) -> Demand:
    """Return the demand, checked.

    Raises
    ------
    CrankcheckError
        A number out of its range, a frame that no number of sub-steps makes short enough, too many
        frames, a driver that does not turn at a constant speed, or one that comes to a position in
        which the motion is not determined.
    """
    positive("--dt", frame_s, "seconds for a frame, such as 1/60")
    if not SLOWEST <= abs(speed_rad_s) <= FASTEST:
        raise CrankcheckError(
            f"--speed {speed_rad_s:g}: give the driver's speed in rad/s, {SLOWEST:g} to "
            f"{FASTEST:g}, such as 10; clockwise it is negative"
        )
    if not AT_ROUNDING <= target < COARSEST:
        raise CrankcheckError(
            f"--target {target:g}: give an error of place from {AT_ROUNDING:g}, which is rounding, "
            f"to under {COARSEST:g}, such as 1e-3"
        )
    if not (math.isfinite(turns) and turns >= 1.0):
        raise CrankcheckError(
            f"--turns {turns:g}: give 1 turn of the driver or more; a part of a turn shows nothing "
            "of the rest"
        )
    moved = tuple(at_speed(scene, speed_rad_s) for scene in scenes)
    demand = Demand(moved, speed_rad_s, frame_s, target, turns)
    _refuse_frame(demand)
    for scene in moved:
        singular.refuse_singular(scene, turns * demand.period_s)
    return demand


def _refuse_frame(demand: Demand) -> None:
    """Refuse a frame that is too long, or so short that a run has too many; CrankcheckError."""
    per_turn, turn = demand.frames_per_turn, f"a turn at {demand.speed_rad_s:g} rad/s"
    if per_turn * MOST_SUBSTEPS < LEAST_STEPS_PER_TURN:
        longest = demand.period_s * MOST_SUBSTEPS / LEAST_STEPS_PER_TURN
        raise CrankcheckError(
            f"--dt {demand.frame_s:g}: {turn} takes {demand.period_s:.4g} s, and needs at least "
            f"{LEAST_STEPS_PER_TURN} steps: the frame is too long, even in {MOST_SUBSTEPS} "
            f"sub-steps; give at most {longest:.3g} s"
        )
    frames = demand.turns * per_turn
    turns = MOST_SEARCHED / (2.0 * per_turn * demand.least)
    if not demand.turns <= turns:
        fewer = f"use --turns {turns:.3g}, or " if turns >= 1.0 else ""
        raise CrankcheckError(
            f"--dt {demand.frame_s:g} --turns {demand.turns:g}: {frames:.6g} frames, "
            f"{per_turn:.4g} in {turn}; at most {MOST_SEARCHED // 2} steps are run: {fewer}give "
            "a longer frame or a faster crank: a slower one has smaller errors"
        )


USUAL = "as-shipped"
"""The profile of an engine's own defaults."""


@dataclass(frozen=True)
class Choice:
    """Complete settings of an engine, by the name of its profile or a variant, from ``profile``."""

    engine: str
    name: str
    profile: str
    settings: Mapping[str, SettingValue] = field(repr=False)

    @property
    def label(self) -> str:
        return f"{self.engine} {self.name}"

    @property
    def words(self) -> str:
        """Settings that differ from the engine as shipped."""
        profiles = engine(self.engine).profiles
        own = resolved(profiles[USUAL], None) if USUAL in profiles else {}
        differing = [f"{n} {value_text(v)}" for n, v in self.settings.items() if own.get(n) != v]
        return ", ".join(differing) or OWN

    @property
    def in_seconds(self) -> tuple[str, ...]:
        """Settings that make errors depend on the speed."""
        return engine(self.engine).in_seconds(self.settings)

    @property
    def key(self) -> str:
        """Identity of the settings, independent of their name."""
        return key_of(self.engine, self.settings)


def key_of(name: str, settings: Mapping[str, object]) -> str:
    """Return an engine with complete settings, as a text."""
    return f"{name} {json.dumps(dict(settings), sort_keys=True)}"


def choices(engines: Sequence[str], others: Iterable[Choice]) -> tuple[Choice, ...]:
    """Return all profiles of the engines, the variants of the shipped study, and the others.

    Variants with the settings of another choice are left out, under any name.
    """
    every = [
        Choice(name, profile.name, profile.name, resolved(profile, None))
        for name in engines
        for profile in engine(name).profiles.values()
    ]
    for choice in (*_shipped(), *others):
        if choice.engine in engines and choice.key not in [each.key for each in every]:
            taken = any(choice.label == other.label for other in every)
            every.append(replace(choice, name=f"{choice.name} (study)") if taken else choice)
    return tuple(sorted(every, key=lambda choice: engines.index(choice.engine)))


def _shipped() -> Iterator[Choice]:
    """Yield the variants of the shipped study, of the installed engines."""
    for variant in (one for several in study.load_study(None).variants for one in several.each()):
        with suppress(EngineError):
            settings = resolved(profile_of(engine(variant.engine), variant.profile), variant.chosen)
            yield Choice(variant.engine, variant.name, variant.profile, settings)


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
    if grid.shape_digest(stored_text) != grid.shape_digest(text):
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
