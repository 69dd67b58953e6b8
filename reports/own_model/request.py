"""What is asked of a user's own model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True)
class ModelRequest:
    """A model file and the joint that drives it, at ``speed_rad_s`` from the pose that the file is
    drawn in, or from keyframe ``key``, or from ``start_deg`` of the joint's own coordinate.

    ``dt_s`` is the file's own where it is None; ``branch`` overrides the assembly that is drawn.
    """

    path: Path
    joint: str
    speed_rad_s: float
    key: str | None = None
    start_deg: float | None = None
    branch: Mapping[str, int] = field(default_factory=dict)
    dt_s: float | None = None
    turns: float = 1.0
    tolerance: Mapping[str, float] = field(default_factory=dict)
    converge: bool = True
