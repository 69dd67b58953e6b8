"""A mechanism that a synthesis proposes: its scene, what is asked of it, and how it was found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from analytic.lectures.synthesis.asked import PrecisionPosition
from analytic.lectures.synthesis.construction import Step
from models.lectures.draft import SPEED_RAD_S, Draft


@dataclass(frozen=True)
class Proposal:
    """What a construction gives: the tables of a scene without its law, the link that drives, the
    precision positions with the driver's angles [rad] in the order they are asked for.

    ``chosen`` are the numbers that the task left open, in words and SI units; ``steps`` draw how
    the rest was found. ``doubt`` is what a task gave up where it could not be met as asked.
    ``speed_rad_s`` is the driver's, or the circular frequency of one that swings.
    ``allowed`` is how far it may be from a position (angles in rad, lengths over the longest link):
    0 of what is to be met exactly, more of what least squares fitted. ``also_rad`` are angles that
    a driver that swings goes to as well, beyond the positions. ``turns_back`` is the link or slider
    that has its limits in the two positions, and so goes to and fro between them.
    """

    draft: Draft
    driver: str
    positions: tuple[PrecisionPosition, ...]
    chosen: Mapping[str, str] = field(default_factory=dict)
    steps: tuple[Step, ...] = ()
    doubt: str = ""
    speed_rad_s: float = SPEED_RAD_S
    allowed: float = 0.0
    also_rad: tuple[float, ...] = ()
    turns_back: str = ""
