"""Settings as text to copy and paste into a model that knows nothing of crankcheck."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Protocol

from models.errors import CrankcheckError
from sim.engine import Drive, SettingValue
from sim.mujoco.snippet import mujoco_snippet
from sim.pymunk.snippet import pymunk_snippet

PERIOD_S = 2.0 * math.pi / 10.0
"""A turn at 10 rad/s, the speed of most shipped scenes."""


class Maker(Protocol):
    """Writes the snippet of one engine; ``head`` are lines of comment to begin with."""

    def __call__(
        self,
        settings: Mapping[str, SettingValue],
        steps_per_turn: float,
        period_s: float,
        drive: Drive,
        head: Sequence[str],
    ) -> str: ...


MAKERS: Mapping[str, Maker] = {"mujoco": mujoco_snippet, "pymunk": pymunk_snippet}
LANGUAGE: Mapping[str, str] = {"mujoco": "xml", "pymunk": "python"}
"""What a page may colour the snippets as."""


def snippet(
    engine: str,
    settings: Mapping[str, SettingValue],
    steps_per_turn: float,
    period_s: float = PERIOD_S,
    *,
    drive: Drive = "prescribed",
    head: Sequence[str] = (),
) -> str:
    """The lines that set ``settings`` (those asked for), at a step of period over steps.

    What is the engine's own default is left out. ``period_s`` is that of the driver [s]; the text
    says how its numbers change with the speed.

    Raises
    ------
    CrankcheckError
        An engine that nobody has written snippets for.
    """
    if engine not in MAKERS:
        raise CrankcheckError(f"snippet for {engine!r}: there are those of {', '.join(MAKERS)}")
    return MAKERS[engine](settings, steps_per_turn, period_s, drive, head)
