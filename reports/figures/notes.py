"""What stands under every figure: versions, processor, study, and the settings of its variants."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from reports.choice.lines import Line
from reports.choice.machines import machine
from reports.figures.marks import label, name_of
from reports.page.numbers import count
from reports.page.report import Report


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
    scenes = dict.fromkeys(line.scene for line in lines)
    where = next(iter(scenes)) if len(scenes) == 1 else count(len(scenes), "scene")
    variants = count(len({name_of(line) for line in lines}), "variant")
    steps = sorted({float(n) for line in lines for n in line.cells["steps_per_turn"]})
    turns = sorted({float(n) for line in lines for n in line.cells["turns"]})
    to = f"{steps[0]:g}" + (f" to {steps[-1]:g}" if len(steps) > 1 else "")
    long = ", ".join(f"{n:g}" for n in turns)
    return f"Study: {where}, {variants}, {to} steps per turn, {long} turns"


def made(report: Report, timed: bool) -> str:
    """On which processor, and when; that of the timings where there are any."""
    facts = facts_of(report)
    name = machine(report.stored.cells) if timed else None
    parts = [name or facts.get("processor", ""), facts.get("system", ""), facts.get("made", "")]
    return ", ".join(part for part in parts if part)


def settings(report: Report, lines: Sequence[Line]) -> list[str]:
    """What the variants set, in one paragraph; empty where all is as the engines are shipped."""
    told = {
        label(name_of(line)): report.settings_told(line)
        for line in lines
        if line.variant != "as-shipped"
    }
    words = [f"{name}: {each}" for name, each in told.items()]
    return [f"Settings other than as shipped: {'; '.join(words)}."] if words else []


def facts_of(report: Report) -> Mapping[str, str]:
    """What the last run of the store says of where it ran."""
    runs = report.stored.manifest.runs
    found = runs[-1].get("provenance") if runs else None
    return {str(k): str(v) for k, v in found.items()} if isinstance(found, Mapping) else {}
