"""What is asked of a user's own model."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from models.errors import CrankcheckError


@dataclass(frozen=True)
class ModelRequest:
    """A model file and the joint that drives it, at ``speed_rad_s`` from the pose that the file is
    drawn in, or from keyframe ``key``, or from ``start_deg`` of the joint's own coordinate.

    The step is the file's own where neither ``dt_s`` nor ``steps_per_turn`` is given; ``branch``
    overrides the assembly that is drawn. Raises CrankcheckError for what is no speed, angle or
    assembly.
    """

    path: Path
    joint: str
    speed_rad_s: float
    key: str | None = None
    start_deg: float | None = None
    branch: Mapping[str, int] = field(default_factory=dict)
    dt_s: float | None = None
    steps_per_turn: float | None = None
    turns: float = 1.0
    tolerance: Mapping[str, float] = field(default_factory=dict)
    converge: bool = True

    def __post_init__(self) -> None:
        if not (math.isfinite(self.speed_rad_s) and self.speed_rad_s):
            raise CrankcheckError(
                f"--speed {self.speed_rad_s:g}: give that of the crank in rad/s, such as 10; -10 "
                "turns it the other way"
            )
        if self.start_deg is not None and not math.isfinite(self.start_deg):
            raise CrankcheckError(f"--start {self.start_deg:g}: give an angle")
        for name, sign in self.branch.items():
            if sign not in (1, -1):
                raise CrankcheckError(f"--branch {name}: found {sign}; it is 1 or -1")
