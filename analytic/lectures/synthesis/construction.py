"""The steps of a construction, as one draws them: points, lines and circles in metres."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Look = Literal["given", "auxiliary", "result"]
"""What a task gives, what a construction draws on the way, and the links that it finds."""


@dataclass(frozen=True)
class Dot:
    """A point with its letter; ``fixed`` is drawn as a pivot of the ground."""

    place: complex
    letter: str
    look: Look = "auxiliary"
    fixed: bool = False


@dataclass(frozen=True)
class Segment:
    """A straight line between two places; ``beyond`` of its length is drawn on past both ends."""

    start: complex
    end: complex
    look: Look = "auxiliary"
    beyond: float = 0.0


@dataclass(frozen=True)
class Circle:
    """A circle, or an arc of it counter-clockwise from one direction to another [rad]."""

    centre: complex
    radius: float
    look: Look = "auxiliary"
    arc: tuple[float, float] | None = None


@dataclass(frozen=True)
class Curve:
    """A curve through many places, in pieces."""

    pieces: tuple[tuple[complex, ...], ...]
    look: Look = "auxiliary"


Element = Dot | Segment | Circle | Curve


@dataclass(frozen=True)
class Step:
    """One step: what is done, in words, and what it draws."""

    words: str
    elements: tuple[Element, ...]
