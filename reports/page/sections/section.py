"""What a section of the page is, and what it is built from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

from reports.results.lines import Named, named
from reports.results.looks import Look
from reports.results.overview import Report
from reports.stability.matrix import Matrix


@dataclass(frozen=True)
class PageReport(Report):
    """A store as the page shows it, with the hard cases that were run beside it, if any."""

    matrix: Matrix | None = None

    @cached_property
    def driven(self) -> PageReport | None:
        """What was driven alone, which has turns; None where everything was let go."""
        free = self.stored.cells["drive"] == "free"
        if not free.any():
            return self
        if free.all():
            return None
        cells = self.stored.cells[~free].reset_index(drop=True)
        return DrivenReport(replace(self.stored, cells=cells), self.matrix, whole=self)


@dataclass(frozen=True)
class DrivenReport(PageReport):
    """The driven part of a report; its engines look as they do in the ``whole``."""

    whole: PageReport = field(kw_only=True)

    @property
    def looks(self) -> Mapping[Named, Look]:  # type: ignore[override]  # there it is kept
        shown = {named(line) for line in self.lines}
        return {name: look for name, look in self.whole.looks.items() if name in shown}


@dataclass(frozen=True)
class Section:
    """A section: its place in the page, the words of its template, and what its scripts read.

    ``template`` is a file of ``templates/sections``, rendered with ``words``. ``embedded`` is put
    into the page as JSON, to be read with ``crankcheck.embedded(anchor)``; ``scripts`` are files of
    ``assets`` that the section needs, in order, and ``styles`` its style sheets beside that of the
    page; ``plotly`` says that it draws diagrams.
    """

    anchor: str
    title: str
    template: str
    words: Mapping[str, object] = field(default_factory=dict)
    embedded: Mapping[str, object] | None = None
    scripts: tuple[str, ...] = ()
    styles: tuple[str, ...] = ()
    plotly: bool = False
