"""Settings as text to copy and paste into a model that knows nothing of crankcheck."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal, cast

from sim.engine import Drive, Settings
from sim.registry import capability

PERIOD_S = 2.0 * math.pi / 10.0
"""A turn at 10 rad/s, the speed of most shipped scenes."""


@dataclass(frozen=True)
class Stepping:
    """How a crank of ``period_s`` [s] is stepped: ``dt_s`` [s] at a time, and where a program has
    frames ``substeps`` of that in each of them; 0 where it has none."""

    period_s: float
    dt_s: float
    substeps: int = 0

    @property
    def speed_rad_s(self) -> float:
        return 2.0 * math.pi / self.period_s

    @property
    def steps_per_turn(self) -> float:
        return self.period_s / self.dt_s

    def counted_in(self, drive: Drive) -> Literal["turns", "frames", "nothing"]:
        """What its steps are a part of: of what nothing drives no speed says how long they are."""
        if drive == "free":
            return "nothing"
        return "frames" if self.substeps else "turns"


@dataclass(frozen=True)
class SnippetWriter:
    """What writes the snippets of an engine.

    ``language`` is what a page may colour them as; ``write`` is given the settings, the
    stepping, the drive, and lines of comment to begin with (see `snippet`).
    """

    language: str
    write: Callable[[Settings, Stepping, Drive, Sequence[str]], str]


def snippet_writer(engine: str) -> SnippetWriter:
    """That of an engine. Raises EngineError where it has none."""
    return cast(SnippetWriter, capability(engine, "snippet"))


def comment(paragraphs: Sequence[str], width: int) -> list[str]:
    """The paragraphs as comment lines of Python, at most so wide."""
    lines: list[str] = []
    for paragraph in paragraphs:
        wrapped = textwrap.wrap(paragraph, width - 2, break_on_hyphens=False)
        lines += [f"# {line}" for line in wrapped]
    return lines


def snippet(
    engine: str,
    settings: Settings,
    steps_per_turn: float,
    period_s: float = PERIOD_S,
    *,
    drive: Drive = "prescribed",
    head: Sequence[str] = (),
) -> str:
    """The lines that set ``settings`` (those asked for), at a step of period over steps.

    What is the engine's own default is left out. In force is what the mechanism needs, on the
    mechanism alone wherever the engine can, so that what else a user's model holds goes on as it
    did with that step and integrator; the settings that measured runs had besides, to which that
    does not apply, stand in a comment. ``period_s`` is that of the driver [s]; the text says how
    its numbers change with the speed. Raises EngineError where the engine has no writer.
    """
    stepping = Stepping(period_s, period_s / steps_per_turn)
    return snippet_writer(engine).write(settings, stepping, drive, head)


def frame_snippet(
    engine: str, settings: Settings, stepping: Stepping, head: Sequence[str] = ()
) -> str:
    """As `snippet`, for a program that has frames: how many steps of which length are one."""
    return snippet_writer(engine).write(settings, stepping, "prescribed", head)
