"""What a cause is, and what is looked at to find one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from reports.compare.beside import Truth
from reports.logs.channel import Log


@dataclass(frozen=True)
class Case:
    """A log, the truth as it is driven, and by column what its error may be [SI]."""

    log: Log
    truth: Truth
    limits: Mapping[str, float]


@dataclass(frozen=True)
class Cause:
    """Why some channels are off.

    ``correction`` is what to write in the map for each of ``columns``, and ``of_column`` where that
    is something else for each of them.
    """

    name: str
    columns: tuple[str, ...]
    text: str
    correction: Mapping[str, object]
    left: float
    of_column: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
