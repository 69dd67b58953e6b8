"""An own model on the terminal and as JSON: its reading, its lines, and the recommended changes."""

import math
from collections.abc import Mapping

from rich.console import Console
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from models.errors import harmless
from models.files.assemble import scene_text
from reports.judge.halving import worst_place
from reports.judge.rows import cell_row, error_row
from reports.judge.rules import titled
from reports.output.console import grid, hanging, show_failed
from reports.output.formats import json_text
from reports.output.numbers import short
from reports.own_model import sentences
from reports.own_model.account import CheckedLine
from reports.own_model.judged import JudgedModel, errors_of
from reports.verify.table import HALVED, MARKS, halved, mark

WIDE, NARROW = 76, 52
"""Columns of a terminal that show the gap and the body of the largest error; and those below which
the convergence by halving is left out, if all lines ran."""
STYLES = {"within": "bold green", "out": "bold red", "unsupported": "bold red"}


def show(console: Console, judged: JudgedModel, facts: Mapping[str, str]) -> None:
    """Print the whole model."""
    _failures(console, judged)
    _told(console, str(judged.account.request.path), sentences.reading(judged.account))
    console.print()
    console.print(_table(judged, console.width), "")
    if text := sentences.still_out(judged):
        hanging(console, "recommended: ", harmless(text))
    if text := sentences.gaps(judged):
        hanging(console, "joints: ", harmless(text))
    _disturbing(console, judged)
    _recommended(console, judged)
    console.print(Text(harmless(sentences.verdict_text(judged)), STYLES[judged.verdict]))
    lines = [
        *sentences.footer(judged),
        ", ".join(f"{name} {value}" for name, value in facts.items()),
    ]
    console.print(escape("\n".join(lines)), style="dim", highlight=False)


def _failures(console: Console, judged: JudgedModel) -> None:
    if not judged.failures:
        return
    head = f"{MARKS[judged.verdict].plain}  {judged.account.request.path}, as written"
    show_failed(console, head, titled(judged.failures), judged.own.remedy)
    console.print()


def _told(console: Console, title: str, told: Mapping[str, str]) -> None:
    console.print(Text(harmless(title), "bold"))
    for head, text in told.items():
        hanging(console, f"  {head}: ", harmless(text))


def _table(judged: JudgedModel, width: int) -> Table:
    """Return the three lines, each with its gain, and the others worth reporting."""
    wide = width >= WIDE
    heads = ["", "line", *(f"{head}:" for head in sentences.step_heads(judged))]
    heads += ["gap\n/ L:", "largest of"] * wide
    if width >= NARROW or any(one.errors is None for one in judged.lines):
        heads.append(HALVED)
    title = f"largest error of place {sentences.steps_text(judged)}"
    least = {"largest of": 12, HALVED: 10}
    table = grid(heads, (), title, gap=1, whole=("line",), cut=("",), least=least)
    for one in (*judged.three, *judged.others):
        _add(table, judged, one, wide=wide)
    return table


def _add(table: Table, judged: JudgedModel, one: CheckedLine, *, wide: bool) -> None:
    columns = len(table.columns) - 2
    steps = len(sentences.step_heads(judged))
    table.add_row(mark(one), one.cell.profile, *_numbers(one, steps, wide=wide)[:columns])
    if one is not judged.own and any(map(math.isfinite, judged.gains(one))):
        factors = [
            "" if math.isnan(factor) else sentences.factor_text(factor)
            for factor in judged.gains(one)[:steps]
        ]
        table.add_row("", Text("  gain", "dim"), *(Text(each, "cyan") for each in factors))


def _numbers(one: CheckedLine, steps: int, *, wide: bool) -> list[Text | str]:
    if one.errors is None:
        reason = Text(harmless(f"{one.status}: {one.reason}"), "red")
        return [*["-"] * steps, *(["-", reason] if wide else [reason])]
    worst, gap = worst_place(one.errors), one.errors.worst("gap")
    first = math.nan if worst is None else worst.pure
    errors = [first, *errors_of(one)[1:]][:steps]
    body = f"{worst.quantity} of {worst.body}" if worst else ""
    return [
        *("" if at and math.isnan(error) else short(error) for at, error in enumerate(errors)),
        *([short(gap.pure) if gap else "-", body] if wide else []),
        halved(one, one.convergence),
    ]


def _disturbing(console: Console, judged: JudgedModel) -> None:
    found = sentences.groups(judged)
    if found:
        console.print("can disturb it:")
    for group in found:
        texts = [group.short(), *([group.effect] if group.effect else [])]
        hanging(console, f"  {group.kind}: ", harmless("; ".join(texts)))
    console.print()


def _recommended(console: Console, judged: JudgedModel) -> None:
    console.print(Text(sentences.recommended_head(judged), "bold"))
    console.print(harmless(judged.patch), markup=False, highlight=False, soft_wrap=True)


def document(judged: JudgedModel, facts: Mapping[str, str]) -> str:
    """Return facts, the reading, every joint, and the lines with their findings and errors; values
    that are not finite are null."""
    account = judged.account
    content = {
        "provenance": dict(facts),
        "verdict": judged.verdict,
        "model": {
            "file": str(account.request.path),
            "driven": account.request.joint,
            "speed_rad_s": account.request.speed_rad_s,
            "key": account.request.key,
            "scene": scene_text(account.scene),
            "notes": list(account.notes),
            "disturbances": [vars(group) for group in sentences.groups(judged)],
            "recommended": judged.patch,
            "helps": account.helps,
        },
        "joints": [
            {
                "joint": joint.name,
                "open_m": joint.open_m,
                "gap_m": dict(joint.gap_m),
                "share_of_limit": joint.share,
            }
            for joint in judged.joints()
        ],
        "cells": [_cell(judged, one) for one in judged.lines],
    }
    return json_text(content)


def _cell(judged: JudgedModel, one: CheckedLine) -> dict[str, object]:
    """Return a line: as a cell of any verification, with its gain at each step and every error."""
    return cell_row(one) | {
        "settings": dict(one.settings),
        "gains": list(judged.gains(one)),
        "notes": list(one.errors.notes) if one.errors else [],
        "findings": [vars(finding) for finding in one.findings],
        "errors": [error_row(row, one.limits) for row in one.errors.rows] if one.errors else [],
    }
