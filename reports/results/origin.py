"""What stands under every figure: versions, processor, study, and the settings of its variants."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from reports.output.numbers import count, duration, listed
from reports.results.lines import Line, named
from reports.results.one_processor import machine
from reports.results.overview import Report
from reports.results.settings_text import OWN
from reports.way.clock import SECONDS, TURNS, common_clock

SHOWN = 10
"""Variants whose settings a figure tells; Markdown and the page tell all of them."""


def notes(report: Report, lines: Sequence[Line], timed: bool = False) -> list[str]:
    """Paragraphs on the lines that a figure shows; ``timed`` where it shows times."""
    return [
        f"{versions(report, lines)}. {study(lines)}. {made(report, timed)}.",
        *settings(report, lines),
    ]


def versions(report: Report, lines: Sequence[Line]) -> str:
    """crankcheck, and the engines of the lines, with their versions."""
    own = {str(version) for line in lines for version in line.cells["crankcheck"]}
    engines = dict.fromkeys(f"{line.engine} {line.version}" for line in lines)
    facts = facts_of(report)
    others = [f"{name} {facts[name]}" for name in ("numpy", "python") if name in facts]
    return ", ".join([*(f"crankcheck {version}" for version in sorted(own)), *engines, *others])


def study(lines: Sequence[Line]) -> str:
    """The size of the grid that the lines are of."""
    return _STUDIES[common_clock(line.drive for line in lines)](lines)


def _where(lines: Sequence[Line]) -> str:
    """The scenes and variants."""
    scenes = dict.fromkeys(line.scene for line in lines)
    where = next(iter(scenes)) if len(scenes) == 1 else count(len(scenes), "scene")
    return f"Study: {where}, {count(len({named(line) for line in lines}), 'variant')}"


def _in_turns(lines: Sequence[Line]) -> str:
    steps = sorted({float(n) for line in lines for n in line.cells["steps_per_turn"]})
    turns = sorted({float(n) for line in lines for n in line.cells["turns"]})
    to = f"{steps[0]:g}" + (f" to {steps[-1]:g}" if len(steps) > 1 else "")
    long = ", ".join(f"{n:g}" for n in turns) + (" turn" if turns == [1.0] else " turns")
    return f"{_where(lines)}, {to} steps per turn, {long}"


def _in_seconds(lines: Sequence[Line]) -> str:
    dts = sorted({float(dt) for line in lines for dt in line.cells["dt_s"]}, reverse=True)
    lasts = listed([duration(s) for s in sorted({line.lasts_s for line in lines})])
    return f"{_where(lines)}, let go for {lasts}, dt {listed([duration(dt) for dt in dts])}"


_STUDIES = {TURNS: _in_turns, SECONDS: _in_seconds}


def made(report: Report, timed: bool) -> str:
    """On which processor, and when; that of the timings where there are any."""
    facts = facts_of(report)
    name = machine(report.stored.cells) if timed else None
    parts = [name or facts.get("processor", ""), facts.get("system", ""), facts.get("made", "")]
    return ", ".join(part for part in parts if part)


def settings(report: Report, lines: Sequence[Line]) -> list[str]:
    """What the variants set, in one paragraph; none where all of it is the engines' own."""
    told = {name: each for name, each in settings_of(report, lines).items() if each != OWN}
    words = [f"{name}: {each}" for name, each in list(told.items())[:SHOWN]]
    more = len(told) - len(words)
    words += [f"and {count(more, 'more variant')} (crankcheck report tells)"] if more > 0 else []
    return [f"Settings, where not as shipped: {'; '.join(words)}."] if words else []


def settings_of(report: Report, lines: Sequence[Line]) -> Mapping[str, str]:
    """The settings of each variant, by its label (see `reports.results.settings_text`)."""
    shown = dict.fromkeys(named(line) for line in lines)
    return {report.looks[name].name: report.settings_told[name] for name in shown}


def facts_of(report: Report) -> Mapping[str, str]:
    """What the last run of the store says of where it ran."""
    runs = report.stored.manifest.runs
    facts = runs[-1].get("provenance") if runs else None
    return {str(k): str(v) for k, v in facts.items()} if isinstance(facts, Mapping) else {}
