"""A store as a Markdown comment on a pull request: verdict, settings to use, orders and floors,
failures, and origin."""

import math
from collections.abc import Iterator

from reports.judge.rules import RULES
from reports.output.formats import code, fitted, folded, plain, table
from reports.output.numbers import count, listed, short
from reports.page.sections.engines import in_markdown
from reports.page.sections.section import PageReport
from reports.page.sections.verdict import level, verdict
from reports.protocol.length import clock_of
from reports.results.candidates import MEANS, Costs
from reports.results.lines import Line, called, label, named
from reports.results.overview import Report, made, settings_of, study, versions
from reports.results.recommend import Recommendation, noise_line, short_target
from reports.stability.matrix import Matrix
from reports.store.reader import Stored
from sim.engine import Drive
from sim.registry.offers import snippet_writer

ROOM = {
    "damage": 4_000,
    "engines": 4_000,
    "outside": 6_000,
    "set": 8_000,
    "snippets": 10_000,
    "times": 3_000,
    "fits": 10_000,
    "failures": 8_000,
    "settings": 6_000,
}
"""Bytes of each part: with heads and footer all stay below the 65,536 of a comment on GitHub."""
HEADS = (
    "error up to:",
    "engine",
    "settings",
    "steps per turn:",
    "µs per step:",
    "ms per turn:",
    "largest error:",
    "on scene",
)
HEADLINES = {"within": "within tolerance", "out": "OUT OF TOLERANCE", "none": "no verdict"}


def summary(stored: Stored, matrix: Matrix | None = None) -> str:
    """Return the text, below 60,000 bytes for any size of the store; with the table of engines, and
    the hard cases that were run beside the store, where it has three of them."""
    report = PageReport(stored, matrix)
    gated = report.cells[report.cells["gated"]]
    parts = [
        f"## crankcheck: {HEADLINES[level(gated)]}",
        f"**{plain(verdict(gated))}** {_ended(report)}",
        *_damaged(report),
        *in_markdown(report, ROOM["engines"]),
        *_outside(report),
        "### What to set",
        _recommended(report),
        *_snippets(report),
        *_times(report),
        "### Error as the step shrinks",
        _fits(report),
        *_failures(report),
        _footer(report),
    ]
    return "\n\n".join(parts) + "\n"


def _ended(report: Report) -> str:
    number, bad = len(report.cells), int((report.cells["status"] != "ok").sum())
    rest = f"{bad} failed" if bad else "no run failed"
    return f"Of all {count(number, 'cell')}, whatever the settings, {rest}."


def _damaged(report: Report) -> Iterator[str]:
    kept, left = fitted(report.stored.notice, ROOM["damage"])
    if kept:
        yield "### State of the store"
        yield code("\n".join([*kept, *([f"and {left} more"] if left else [])]), "text")


def _outside(report: Report) -> Iterator[str]:
    """Yield the gated cells that are out of tolerance, with the rules that they fail."""
    cells = report.cells[report.cells["gated"] & (report.cells["verdict"] != "within")]
    if cells.empty:
        return
    rows = [
        (
            row["scene"],
            f"{row['engine']} {row['variant']}",
            steps_told(float(row["steps_per_turn"]), row["drive"]),
            row["status"],
            ", ".join(_rule(name) for name in str(row["failed_rules"]).split()),
        )
        for _, row in cells.iterrows()
    ]
    yield "### Out of tolerance"
    yield table(("scene", "variant", "steps per turn:", "ended", "fails"), rows, ROOM["outside"])


def _rule(name: str) -> str:
    return f"{name} {RULES[name].title}" if name in RULES else name


def _recommended(report: Report) -> str:
    rows = [_recommendation(one) for one in report.recommendations]
    scenes = count(len(report.scenes), "scene")
    words = (
        "The cheapest settings that keep the error of position [rad, or over the longest link] on "
        f"{scenes} within a target; times are geometric means."
        + " Where links bend, it is that of the deflection, over the largest."
        * bool(report.of_kind("elastic"))
    )
    remarks = dict.fromkeys(_remark(one) for one in report.recommendations)
    kept, left = fitted([f"- {plain(text)}" for text in remarks if text], ROOM["set"] // 2)
    more = [f"- and {left} more"] if left else []
    grid = table(HEADS, rows, ROOM["set"] // 2)
    return "\n\n".join(filter(None, [words, grid, "\n".join([*kept, *more])]))


def _recommendation(one: Recommendation) -> tuple[str, ...]:
    target, best = short_target(one.target), one.best
    if one.reason:
        return (target, best.engine, "none", *[""] * 5)
    per_second = _per(best.drive)
    times = (f"{best.us_per_step:.2f}", f"{1e3 * best.s_per_turn:.3g}{per_second}")
    steps, error = steps_told(best.steps_per_turn, best.drive), short(best.worst_error)
    name = called(best.variant, best.drive)
    return (target, best.engine, name, steps, *times, error, str(best.worst_scene))


def _remark(one: Recommendation) -> str:
    which = f"{one.best.engine}, {short_target(one.target)}"
    if one.reason:
        return f"{which}: none; {one.reason}"
    if not one.caution:
        return ""
    instead = ""
    if one.steadier is not None:
        other = one.steadier.best
        instead = f"; {other.variant} at {other.steps_per_turn:g} holds at finer ones too"
    return f"{which}: holds at this step, {one.caution}{instead}"


def _snippets(report: Report) -> Iterator[str]:
    """Yield text to be copied, each behind a click; once where it serves several targets."""
    groups: dict[tuple[str, str, Drive, float], list[Recommendation]] = {}
    for one in report.recommendations:
        if not one.reason:
            best = one.best
            same = (best.engine, best.variant, best.drive, best.steps_per_turn)
            groups.setdefault(same, []).append(one)
    texts = []
    for (engine, variant, drive, steps), group in groups.items():
        tightest = min(group, key=lambda one: one.target)
        targets = listed([short_target(one.target) for one in group])
        a_turn = f"{steps:g} steps per {clock_of(drive).name}"
        title = f"{engine} {variant}, {a_turn} (error up to {targets})"
        if text := tightest.snippet():
            texts.append(folded(title, code(text, snippet_writer(engine).language)))
    kept, left = fitted(texts, ROOM["snippets"])
    yield from kept
    if left:
        yield f"and {left} more to be copied from the page of `crankcheck report`"


def _times(report: Report) -> Iterator[str]:
    """Yield the cost of a step of each variant, and of a turn that reaches each target."""
    if not report.timed:
        return
    targets = list(report.costs[0].s_to)
    heads = ("variant", "µs per step:", "median repeat:")
    ends = [f"ms per turn to {short_target(target)}:" for target in targets]
    grid = table((*heads, *ends), [_time(each) for each in report.costs], ROOM["times"], "variants")
    yield folded("Time to reach an error", f"{grid}\n\n{plain(MEANS)}")


def _time(costs: Costs) -> list[str]:
    """Return a row; a value that does not hold on all scenes has the number of scenes beside it."""
    name, part = label((costs.engine, costs.variant, costs.drive)), costs.part(costs.timed)
    steps = [
        f"{us:.2f}" if costs.timed else "" for us in (costs.us_per_step, costs.us_per_step_median)
    ]
    if costs.timed and part:
        steps[0] += f" ({part})"
    unit = _per(costs.drive)
    turns = [
        costs.part(costs.reached[target]) or (f"{1e3 * s:.3g}{unit}" if math.isfinite(s) else "")
        for target, s in costs.s_to.items()
    ]
    return [name, *steps, *turns]


def _fits(report: Report) -> str:
    """Return order or floor in words, a row for each scene and variant."""
    rows = [(line.scene, label(named(line)), line.words, *_finest(line)) for line in report.lines]
    heads = ("scene", "variant", "error of place", "finest error:", "at steps per turn:")
    title = f"{count(len(rows), 'line')}: scene by scene and variant by variant"
    return folded(title, table(heads, rows, ROOM["fits"]))


def _finest(line: Line) -> tuple[str, str]:
    if not line.fit.runs:
        return "", ""
    dt_s, error = line.fit.runs[0]
    return short(error), steps_told(float(f"{line.period_s / dt_s:.4g}"), line.drive)


def steps_told(steps: float, drive: str) -> str:
    """Return steps per turn, or with "per second" for a free motion."""
    return f"{steps:g}{_per(drive)}"


def _per(drive: str) -> str:
    """Return the unit behind a number that counts per second; empty for turns."""
    per = clock_of(drive).per
    return f" {per}" if per else ""


def _failures(report: Report) -> Iterator[str]:
    """Yield the runs that did not end well, a row for each line and status."""
    rows, number = [], 0
    for line in report.lines:
        bad = line.cells[line.cells["status"] != "ok"]
        for status, cells in bad.groupby("status", sort=False):
            steps = ", ".join(steps_told(n, line.drive) for n in cells["steps_per_turn"])
            reason = str(cells["reason"].iloc[0])
            number += len(cells)
            rows.append((line.scene, label(named(line)), status, steps, reason))
    if rows:
        heads = ("scene", "variant", "ended", "at steps per turn", "first reason")
        body = table(heads, rows, ROOM["failures"])
        yield "### Failed runs"
        yield folded(f"{count(number, 'run')} of {count(len(report.cells), 'cell')}", body)


def _footer(report: Report) -> str:
    lines = report.lines
    texts = [f"{versions(report, lines)}.", f"{made(report, report.timed)}.", f"{study(lines)}."]
    texts += [noise_line(report.stored)]
    told = settings_of(report, lines)
    settings = table(("variant", "settings"), told.items(), ROOM["settings"])
    return "\n\n".join(["  \n".join(map(plain, texts)), folded("Settings", settings)])
