"""A hard case: a family of runs with one number that becomes harder, and the right outcome."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from typing import Literal, cast

import numpy as np

from analytic.free.exact_motions import ToggleBarrier
from analytic.kinematics import solve
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion, State
from models.scene import Scene
from models.scene.cut_scenes import SegmentedScene
from models.scene.hard import WindowChain
from reports.protocol.way import own_parts
from reports.stability.error_series import ErrorSeries
from reports.stability.matrix import CaseFacts, Outcome
from sim.engine import Drive, Run, SettingValue

WITHIN = 1e-2
"""Limit of every case that names no other: a hundredth of a radian, or of the longest link."""
STEPS_PER_TURN = 360.0
TURNS = 2.0
BEYOND = 10.0
"""Factor beyond its values up to which a case may be run."""
Scale = Literal["log", "linear", "whole"]
Judge = str
"""Name of the reference of runs, see `reports.stability.case`."""


@dataclass(frozen=True, eq=False)
class Throw:
    """A four-bar that is thrown at its toggle, with the margin of its energy."""

    barrier: ToggleBarrier
    margin: float


@dataclass(frozen=True)
class Trial:
    """A run, ready for an engine.

    ``scene`` is the reference; ``start`` the state of the engine instead (None: the state of the
    reference), with joints open by up to ``open_m`` [m]; errors count from ``settled_turns`` on.
    Every ``every`` steps are logged. ``limit_rad`` is the driver angle that cannot be passed,
    ``chain`` the chain in free motion, and ``throw`` the throw at a toggle, for the cases that test
    these. A free motion is compared at the same time for ``followed_s`` [s], and after it by its
    geometry and its energy alone; its turn is the duration of the free motion in the scene. An
    elastic link is given to the engine as so many ``segments``.
    """

    scene: Scene
    steps_per_turn: float = STEPS_PER_TURN
    turns: float = TURNS
    every: int = 1
    drive: Drive = "prescribed"
    settings: Mapping[str, SettingValue] = field(default_factory=dict)
    start: State | None = None
    open_m: float = 0.0
    settled_turns: float = 0.0
    limit_rad: float = math.nan
    chain: WindowChain | None = None
    throw: Throw | None = None
    followed_s: float = math.inf
    segments: int = 0

    @property
    def given(self) -> Scene:
        """Scene that the engine is given."""
        return SegmentedScene(self.scene, self.segments).rigid if self.segments else self.scene

    @property
    def dt_s(self) -> float:
        return self.scene.driver.law.period_s / self.steps_per_turn

    @property
    def steps(self) -> int:
        """Number of steps: a whole number of logged samples."""
        return max(round(self.turns * self.steps_per_turn / self.every), 1) * self.every


@dataclass(frozen=True, kw_only=True)
class Case(CaseFacts):
    """A family of trials, with its facts; the catalogue sets its ``group`` and ``way``.

    ``values`` go from easy to hard. Between the last value that holds and the first that does not,
    a bisection searches on its ``scale``: by factors, by differences, or over whole numbers.
    """

    group: str = ""
    unit: str = ""
    good: tuple[Outcome, ...] = ("ok",)
    within: float = WITHIN
    trial: Callable[[float], Trial]
    scale: Scale = "log"
    judge: Judge = "follow"
    way: str = ""

    def refuse(self, value: float) -> None:
        """Refuse a value that means nothing for the case. Raises CrankcheckError."""
        if value in self.values:
            return
        easy, hard = self.labels[0], self.labels[-1]
        means = f"{self.parameter}, in the catalogue {easy} to {hard} {self.unit}".rstrip()
        if len(self.values) == 1:
            raise CrankcheckError(f"--at {value:g}: {self.name} has only the value {easy}")
        if not math.isfinite(value):
            raise CrankcheckError(f"--at {value:g}: not a finite number; it is the {means}")
        if self.scale != "linear" and value <= 0.0:
            raise CrankcheckError(f"--at {value:g}: not above 0; it is the {means}")
        far = (min(self.values) / BEYOND, max(self.values) * BEYOND)
        if self.scale != "linear" and not far[0] <= value <= far[1]:
            raise CrankcheckError(f"--at {value:g}: too far off; it is the {means}")
        if self.scale == "whole" and value != round(value):
            raise CrankcheckError(f"--at {value:g}: not a whole number; it is the {means}")

    def facts(self) -> CaseFacts:
        """Return the facts for a reader."""
        own = {each.name: getattr(self, each.name) for each in fields(CaseFacts)}
        unit = self.trial(self.values[0]).scene.driver.unit
        return CaseFacts(**own | {"driver_unit": unit})


@dataclass(frozen=True)
class Yardstick:
    """Comparison of a run with its reference, motion of the reference, to be drawn, and their
    common start. ``error_of`` names the quantity of the errors, as pure numbers; ``with_forces``
    says if errors of forces may be requested as well."""

    error_of: str
    look: Callable[[Trial, Run], ErrorSeries]
    motion: Callable[[Trial, Array], Motion]
    start: Callable[[Trial], State] = lambda trial: (
        trial.start or solve(trial.scene, np.zeros(1)).state()
    )
    with_forces: bool = False


def yardsticks() -> dict[Judge, tuple[str, Yardstick]]:
    """Return all yardsticks, by name, each with the name of its way."""
    return {
        judge: (name, each)
        for name, own in own_parts("series").items()
        for judge, each in cast(Mapping[Judge, Yardstick], own).items()
    }
