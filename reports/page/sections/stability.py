"""Stability: the settings that hold each scene, and the step from which on they do."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

import pandas as pd

from reports.page.sections.section import Section
from reports.protocol.length import SECONDS, clock_of
from reports.results.engine_table import FEWEST
from reports.results.looks import Look
from reports.results.overview import Report

ALL_WITHIN = "within: all"


@dataclass(frozen=True)
class Holds:
    """Steps at which a line holds: ``level`` is ``all``, ``some`` or ``none``; ``rank`` orders the
    cells of the table; ``runs`` and ``within`` are its two lines of words."""

    level: str
    rank: float
    runs: str
    within: str


def build(report: Report) -> Section:
    """Return the section."""
    every = list(report.looks.values())
    engines = Counter(look.engine for look in every)
    looks = [look for engine in engines for look in every if look.engine == engine]
    held = {(x.scene, report.look(x).number): holds(x.cells) for x in report.lines}
    clocks = [clock_of(line.drive) for line in report.lines]
    lost = report.cells[report.cells["status"] != "ok"]
    return Section(
        anchor="stability",
        title="Stability",
        template="stability.html",
        words={
            "looks": looks,
            "engines": engines,
            "free": any(clock is SECONDS for clock in clocks),
            "all_free": all(clock is SECONDS for clock in clocks),
            "rows": [
                (scene, [held.get((scene, look.number)) for look in looks])
                for scene in report.scenes
            ],
            "summed": [_summed(look, held) for look in looks] if len(engines) >= FEWEST else [],
            "lost": [_lost(report, row) for _, row in lost.iterrows()],
        },
    )


def _summed(look: Look, held: Mapping[tuple[str, int], Holds]) -> dict[str, object]:
    """Return a row of a look for all scenes, where looks are too many for columns: numbers of
    scenes that it holds at every step, and words on the others."""
    own = {scene: one for (scene, number), one in held.items() if number == look.number}
    ran = [scene for scene, one in own.items() if one.level == "all"]
    within = [scene for scene, one in own.items() if one.within == ALL_WITHIN]
    scenes: dict[str, list[str]] = {}
    for scene, one in own.items():
        words = [one.runs] * (scene not in ran) + [one.within] * (scene not in within)
        scenes.setdefault("; ".join(words), []).append(scene)
    others = {words: ", ".join(names) for words, names in scenes.items() if words}
    level = "all" if len(ran) == len(own) else "some" if ran else "none"
    return {"look": look, "scenes": len(own), "ran": len(ran), "within": len(within),
            "level": level, "others": others}  # fmt: skip


def holds(cells: pd.DataFrame) -> Holds:
    """Return the steps at which a line holds; its cells go from the coarse to the fine step."""
    steps = [_step(row) for _, row in cells.iterrows()]
    ran = [status == "ok" for status in cells["status"]]
    within = [verdict == "within" for verdict in cells["verdict"]]
    ends = Counter(status for status in cells["status"] if status != "ok")
    why = ends.most_common(1)[0][0] if ends else ""
    level = "all" if all(ran) else "some" if any(ran) else "none"
    return Holds(
        level=level,
        rank=sum(ran) + sum(within) / (len(within) + 1),
        runs=_runs(steps, ran, why),
        within=_within(steps, within),
    )


def _step(row: pd.Series) -> str:
    return clock_of(row["drive"]).step(row.to_dict())


def _runs(steps: list[str], ran: list[bool], why: str) -> str:
    if all(ran):
        return "every step"
    if not any(ran):
        return f"{why} at every step"
    first, last = ran.index(True), len(ran) - 1 - ran[::-1].index(True)
    if not all(ran[first : last + 1]):
        return f"{why} at {', '.join(s for s, good in zip(steps, ran, strict=True) if not good)}"
    if last == len(ran) - 1:
        return f"from {steps[first]} on; {why} below"
    if first == 0:
        return f"up to {steps[last]}; {why} beyond"
    return f"{steps[first]} to {steps[last]}; {why} elsewhere"


def _within(steps: list[str], within: list[bool]) -> str:
    if all(within) or not any(within):
        return f"within: {'all' if all(within) else 'none'}"
    first, number = within.index(True), sum(within)
    if all(within[first:]):
        return f"within: from {steps[first]}"
    if all(within[:number]):
        return f"within: to {steps[number - 1]}"
    return f"within: {', '.join(s for s, good in zip(steps, within, strict=True) if good)}"


def _lost(report: Report, row: pd.Series) -> dict[str, object]:
    look = report.looks[row["engine"], row["variant"], row["drive"]]
    return {
        "scene": row["scene"],
        "look": look,
        "steps": row["steps_per_turn"],
        "step": _step(row),
        "status": row["status"],
        "reason": row["reason"],
    }
