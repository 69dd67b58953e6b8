"""How long a run is, and by which steps, as it was requested."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from models.scene import Scene
from reports.compare.beside import SETTLING

Springs = Literal["plain", "corrected", "beam"]
"""Between segments: those of the beam's stiffness over a segment, or those that give the chain the
sag of the beam; or none, where the engine has beams of its own, as many elements long."""
SEGMENTS = 16
"""Of an elastic link, unless another number is asked for."""


LEAST_STEPS = 2 * SETTLING
"""Of a verification. Measured: of the shipped scenes none fails for shortness alone in a run of so
many steps."""


@dataclass(frozen=True)
class GivenAs:
    """What the elastic links of a scene are given to engines as; ``words`` tell the lines of a
    sweep apart, and are empty of a rigid scene."""

    segments: int = SEGMENTS
    springs: Springs = "plain"
    words: str = ""


@dataclass(frozen=True)
class Length:
    """The step [s], or the steps in a turn, and turns or a duration [s]; each None where it is left
    to the scene. Every ``every``-th step is logged, and there are at least ``least``."""

    dt_s: float | None = None
    steps_per_turn: float | None = None
    turns: float | None = None
    duration_s: float | None = None
    every: int = 1
    least: int = LEAST_STEPS


@dataclass(frozen=True)
class Planned:
    """A run of a scene in so many ``steps`` of ``dt_s`` [s], before an engine is chosen."""

    scene: Scene
    dt_s: float
    steps: int
    given_as: GivenAs = field(default_factory=GivenAs)
    with_forces: bool = False
    tolerance: Mapping[str, float] = field(default_factory=dict)

    @property
    def duration_s(self) -> float:
        return self.dt_s * self.steps
