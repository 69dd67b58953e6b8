"""A log that is off, and what explains that it is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

from reports.causes.excerpt import Excerpt, excerpts
from reports.compare.beside import Truth
from reports.logs.channel import OwnLog, Reading


@dataclass(frozen=True)
class Case:
    """A log beside the truth of its scene as it is driven, with what the error of each channel may
    be [SI], by column; what has no limit is not judged."""

    log: OwnLog
    truth: Truth
    limits: Mapping[str, float]

    @property
    def readings(self) -> tuple[Reading, ...]:
        """All readings, those of further bodies' copies of a point as well."""
        return (*self.log.readings, *self.log.copies)

    @cached_property
    def excerpts(self) -> Mapping[str, Excerpt]:
        """The excerpt of each channel that is judged, by column. Raises CrankcheckError where there
        is no reference."""
        return excerpts(self.readings, self.truth, self.limits)

    @property
    def out(self) -> tuple[Reading, ...]:
        """The readings that are further off than they may be."""
        return tuple(excerpt.reading for excerpt in self.excerpts.values() if excerpt.out)


@dataclass(frozen=True)
class Cause:
    """What explains that some channels are off, or late though they are not off.

    ``text`` names the fault, the channels and the numbers. ``correction`` is what to write in the
    map for each of ``columns``, and ``of_column`` where that is something else for each of them;
    both are empty where no map mends the log. ``left`` is the largest error that remains, over the
    one that there was, in the channel where that is most.
    """

    name: str
    columns: tuple[str, ...]
    text: str
    correction: Mapping[str, object]
    left: float
    of_column: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
