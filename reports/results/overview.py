"""The input of pages, figures and tables, and their notes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import ClassVar

import pandas as pd

from analytic.free.free_motion import loosened
from models.errors import CrankcheckError
from models.files.reading import parse_scene
from models.scene import Scene
from reports.output.numbers import count, duration, listed
from reports.plan.requirements import under_control
from reports.protocol.length import FACETS, SECONDS, TURNS, Clock, clock_of, common_clock
from reports.protocol.way import TARGETS, WAYS, way_of_row
from reports.results.candidates import Candidate, Costs, candidates, costs_of, noise
from reports.results.lines import OWN, Line, Named, lines, machine, named, settings_told
from reports.results.looks import Look, looks
from reports.results.recommend import Recommendation, recommendations
from reports.store.reader import Stored


@dataclass(frozen=True)
class Report:
    """A store as its readers see it: its newest lines, and their cells."""

    stored: Stored
    clock: ClassVar[Clock | None] = None
    """Clock of all lines, None where their drives have it."""

    @cached_property
    def lines(self) -> tuple[Line, ...]:
        """Newest lines, by scene and variant in the order of the study."""
        return lines(self.stored)

    @cached_property
    def cells(self) -> pd.DataFrame:
        """Cells of the lines, in their order, coarse steps first."""
        return pd.concat([line.cells for line in self.lines], ignore_index=True)

    @cached_property
    def looks(self) -> Mapping[Named, Look]:
        """Look of each engine with its settings."""
        return looks(self.lines)

    @cached_property
    def recommendations(self) -> tuple[Recommendation, ...]:
        """Cheapest settings per engine and target."""
        return recommendations(self.stored)

    @cached_property
    def candidates(self) -> tuple[Candidate, ...]:
        """Every set of settings at every step, over all scenes."""
        return candidates(self.lines)

    @cached_property
    def costs(self) -> tuple[Costs, ...]:
        """Cost of each variant, and the time in which it reaches the targets."""
        return costs_of(self.lines, TARGETS)

    @cached_property
    def noise(self) -> float:
        """Relative difference up to which costs are called equal; NaN if nothing was timed."""
        return noise(self.stored)

    @cached_property
    def scenes(self) -> Mapping[str, Scene | None]:
        """Scenes that were run, in order, released where all lines are free motions; None where the
        store has no readable text of one."""
        names = dict.fromkeys(line.scene for line in self.lines)
        texts = self.stored.manifest.scenes
        found = {name: _parsed(texts.get(name), name) for name in names}
        driven = {line.scene for line in self.lines if clock_of(line.drive) is TURNS}
        return {
            name: scene if scene is None or name in driven else loosened(under_control(scene))
            for name, scene in found.items()
        }

    @cached_property
    def engines(self) -> Mapping[str, str]:
        """Engines with their versions, in the order of the study."""
        versions_of: dict[str, dict[str, None]] = {}
        for line in self.lines:
            versions_of.setdefault(line.engine, {})[line.version] = None
        return {engine: ", ".join(versions) for engine, versions in versions_of.items()}

    @property
    def timed(self) -> bool:
        """True if any cell was timed."""
        return bool(self.cells["s_per_turn"].notna().any())

    @cached_property
    def driven(self) -> Report | None:
        """Report of the driven cells with rigid links: turns, and errors of place; None where every
        cell is free or elastic."""
        cells = self.stored.cells
        rows = cells.drop_duplicates("line").to_dict("records")
        names = {row["line"]: way_of_row(row).name for row in rows}
        other = cells["line"].map(names) != WAYS[-1]
        if not other.any():
            return self
        if other.all():
            return None
        own = cells[~other].reset_index(drop=True)
        return DrivenReport(replace(self.stored, cells=own), whole=self)

    @cached_property
    def over_facets(self) -> FacetReport | None:
        """Report of cams by contact, each at its finest step; None where no cam has several
        facets."""
        rows = []
        for line in self.lines:
            scene, row = self.scenes[line.scene], line.cells.iloc[-1]
            for sides in {pair.facets for pair in scene.cams.values()} if scene else ():
                base = line.scene.removesuffix(f"-{sides}-facets")
                where = f"{base} at {row['steps_per_turn']:g} steps a turn"
                own = {"scene": where, "line": f"{where} {named(line)}", "steps_per_turn": sides}
                rows += [{**row, **own, "dt_s": line.period_s / sides}] if sides else []
        cells = pd.DataFrame(rows)
        if not rows or not (several := cells["line"].duplicated(keep=False)).any():
            return None
        return FacetReport(replace(self.stored, cells=cells[several]), whole=self)

    def of_kind(self, kind: str) -> tuple[Line, ...]:
        """Return the lines of a kind (`reports.protocol.way.Way.kinds`)."""
        return tuple(line for line in self.lines if kind in line.way.kinds)

    def look(self, line: Line) -> Look:
        """Return the look of a line."""
        return self.looks[named(line)]

    def lines_of(self, scene: str) -> tuple[Line, ...]:
        """Return the lines of a scene."""
        return tuple(line for line in self.lines if line.scene == scene)

    @cached_property
    def settings_told(self) -> Mapping[Named, str]:
        """Settings of each variant, as differences from the engine as shipped."""
        return settings_told(self.lines)


@dataclass(frozen=True)
class DrivenReport(Report):
    """The driven part of a report; its engines look as they do in the ``whole``."""

    whole: Report = field(kw_only=True)

    @property
    def looks(self) -> Mapping[Named, Look]:
        shown = {named(line) for line in self.lines}
        return {name: look for name, look in self.whole.looks.items() if name in shown}


@dataclass(frozen=True)
class FacetReport(DrivenReport):
    """Cams by contact over their facets, in the place of steps: a side of the profile is to the
    error as a step of the cam's angle."""

    clock = FACETS

    @cached_property
    def lines(self) -> tuple[Line, ...]:
        return self.of("place_pure")

    def of(self, quantity: str) -> tuple[Line, ...]:
        """Return the lines of a quantity; the floor of facets is the error of the step."""
        wrong, right = "converges to the wrong answer: floor", "down to the error of the step,"
        return tuple(
            replace(line, words=line.words.replace(wrong, f"order {line.fit.order:.1f} {right}"))
            for line in lines(self.stored, quantity)
        )


def _parsed(text: str | None, name: str) -> Scene | None:
    """Return the scene of a text; None for a text that can not be read."""
    if text is None:
        return None
    try:
        return parse_scene(text, name)
    except CrankcheckError:
        return None


SHOWN = 10
"""Variants whose settings a figure shows; Markdown and the page show all of them."""


def notes(report: Report, lines: Sequence[Line], timed: bool = False) -> list[str]:
    """Return paragraphs on the lines that a figure shows; ``timed`` where it shows times."""
    return [
        f"{versions(report, lines)}. {study(lines, report.clock)}. {made(report, timed)}.",
        *settings(report, lines),
    ]


def versions(report: Report, lines: Sequence[Line]) -> str:
    """Return crankcheck, and the engines of the lines, with their versions."""
    own = {str(version) for line in lines for version in line.cells["crankcheck"]}
    engines = dict.fromkeys(f"{line.engine} {line.version}" for line in lines)
    facts = facts_of(report)
    others = [f"{name} {facts[name]}" for name in ("numpy", "python") if name in facts]
    return ", ".join([*(f"crankcheck {version}" for version in sorted(own)), *engines, *others])


def study(lines: Sequence[Line], clock: Clock | None = None) -> str:
    """Return the size of the grid of the lines, by that ``clock`` or the one of their drives."""
    return _STUDIES[clock or common_clock(line.drive for line in lines)](lines)


def _where(lines: Sequence[Line]) -> str:
    scenes = dict.fromkeys(line.scene for line in lines)
    where = next(iter(scenes)) if len(scenes) == 1 else count(len(scenes), "scene")
    return f"Study: {where}, {count(len({named(line) for line in lines}), 'variant')}"


def _in_turns(lines: Sequence[Line], of: str = "steps per turn") -> str:
    steps = sorted({float(n) for line in lines for n in line.cells["steps_per_turn"]})
    turns = sorted({float(n) for line in lines for n in line.cells["turns"]})
    to = f"{steps[0]:g}" + (f" to {steps[-1]:g}" if len(steps) > 1 else "")
    long = ", ".join(f"{n:g}" for n in turns) + (" turn" if turns == [1.0] else " turns")
    return f"{_where(lines)}, {to} {of}, {long}"


def _in_seconds(lines: Sequence[Line]) -> str:
    dts = sorted({float(dt) for line in lines for dt in line.cells["dt_s"]}, reverse=True)
    lasts = listed([duration(s) for s in sorted({line.lasts_s for line in lines})])
    return f"{_where(lines)}, free motion for {lasts}, dt {listed([duration(dt) for dt in dts])}"


_STUDIES: Mapping[Clock, Callable[[Sequence[Line]], str]] = {
    TURNS: _in_turns,
    SECONDS: _in_seconds,
    FACETS: partial(_in_turns, of="facets"),
}


def made(report: Report, timed: bool) -> str:
    """Return processor, system and date; the processor of the timings where there are any."""
    facts = facts_of(report)
    name = machine(report.stored.cells) if timed else None
    parts = [name or facts.get("processor", ""), facts.get("system", ""), facts.get("made", "")]
    return ", ".join(part for part in parts if part)


def settings(report: Report, lines: Sequence[Line]) -> list[str]:
    """Return the settings of the variants, in one paragraph; none if all are the engines' own."""
    told = {name: each for name, each in settings_of(report, lines).items() if each != OWN}
    words = [f"{name}: {each}" for name, each in list(told.items())[:SHOWN]]
    more = len(told) - len(words)
    words += [f"and {count(more, 'more variant')} (see crankcheck report)"] if more > 0 else []
    return [f"Settings, where not as shipped: {'; '.join(words)}."] if words else []


def settings_of(report: Report, lines: Sequence[Line]) -> Mapping[str, str]:
    """Return the settings of each variant, by its label (see `reports.results.lines`)."""
    shown = dict.fromkeys(named(line) for line in lines)
    return {report.looks[name].name: report.settings_told[name] for name in shown}


def facts_of(report: Report) -> Mapping[str, str]:
    """Return the provenance of the last run of the store."""
    runs = report.stored.manifest.runs
    facts = runs[-1].get("provenance") if runs else None
    return {str(k): str(v) for k, v in facts.items()} if isinstance(facts, Mapping) else {}
