"""What a section of the page is, and what it is built from."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from reports.results.overview import Report
from reports.stability.matrix import Matrix


@dataclass(frozen=True)
class PageReport(Report):
    """A store as the page shows it, with the hard cases that were run beside it, if any."""

    matrix: Matrix | None = None


@dataclass(frozen=True, eq=False)
class WaySection:
    """The section of a way: None where a store has none of its cells. ``lighter`` is the same with
    fewer drawings and curves, in a room of characters."""

    build: Callable[[PageReport], Section | None]
    lighter: Callable[[PageReport, int], Section | None] | None = None


@dataclass(frozen=True)
class Section:
    """A section: its place in the page, the words of its template, and what its scripts read.

    ``template`` is a file of ``templates/sections``, or another file, rendered with ``words``.
    ``embedded`` is put into the page as JSON, to be read with ``crankcheck.embedded(anchor)``;
    ``scripts`` are files of ``assets`` that the section needs, in order, and ``styles`` its style
    sheets beside that of the page; ``plotly`` says that it draws diagrams.
    """

    anchor: str
    title: str
    template: str | Path
    words: Mapping[str, object] = field(default_factory=dict)
    embedded: Mapping[str, object] | None = None
    scripts: tuple[str, ...] = ()
    styles: tuple[str, ...] = ()
    plotly: bool = False
