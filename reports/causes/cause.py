"""What a cause is, and what is looked at to find one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

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
    """Why some channels are off."""

    name: str
    columns: tuple[str, ...]
    text: str
    correction: Mapping[str, object]
    left: float
