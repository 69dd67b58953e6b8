"""An own model in words, on the terminal and as JSON: reading, lines, and recommended changes."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rich.console import Console
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from models.errors import few, harmless
from models.files.assemble import scene_text
from reports.judge.halving import worst_place
from reports.judge.rows import cell_row, error_row
from reports.judge.rules import RULES, titled
from reports.output.console import grid, hanging, show_failed
from reports.output.formats import json_text
from reports.output.numbers import count, error_text, listed, readable, short
from reports.own_model.account import CheckedLine, ModelAccount, told
from reports.own_model.judged import PARTS, JudgedModel, errors_of
from reports.verify.table import HALVED, MARKS, halved, mark
from sim.registry.own_models import FAR_PIN

OPEN = 1e-9
"""Least opening of a joint that is reported, over the longest link."""
SHOWN = 6
NO_HELP = "none of the tried settings helps"
EACH = 3
"""Number of disturbances of a kind that are listed on a terminal."""


@dataclass(frozen=True)
class SentenceGroup:
    """The disturbances of a kind, and the effect of leaving them out: "" without such a line."""

    kind: str
    texts: Sequence[str]
    effect: str

    def short(self) -> str:
        """Return the first of them, and the number of the others."""
        left = len(self.texts) - EACH
        return "; ".join(self.texts[:EACH]) + (f"; and {left} more" if left > 0 else "")


def reading(account: ModelAccount) -> dict[str, str]:
    """Return words for the reading of the file, its drive, and its start, each under its head."""
    scene = account.scene
    sliders = f"; {_count_and_names(list(scene.sliders), 'slider')}" if scene.sliders else ""
    notes = {f"note {n}" if n else "note": text for n, text in enumerate(account.notes)}
    return {
        "read as": f"{_count_and_names(list(scene.links), 'link')}{sliders}",
        **notes,
        "pose": _pose_text(account),
        "drive": _drive_text(account),
    }


def _drive_text(account: ModelAccount) -> str:
    request = account.request
    turned = f"{account.steps * account.dt_s / account.scene.driver.law.period_s:.4g}"
    turns = "1 turn" if turned == "1" else f"{turned} turns"
    start = "the pose as drawn" if request.key is None else f"keyframe {request.key}"
    if request.start_deg is not None:
        start = f"{request.start_deg:g} deg"
    based = any(note.startswith("base:") for note in account.notes)
    on = f"that hinge{', and at rest on the joints of the base' * based}"
    return (
        f"{request.joint} at {request.speed_rad_s:g} rad/s, {turns} from {start}, by a flywheel "
        f"on {on}, set at run time, whose ratio divides the solver's tolerance; nothing else is "
        "changed"
    )


def _count_and_names(names: Sequence[str], noun: str) -> str:
    return f"{count(len(names), noun)} ({few(names, SHOWN)})"


def _pose_text(account: ModelAccount) -> str:
    most = OPEN * (account.scene.longest_m or 1.0)
    gaping = sorted(
        ((gap, name) for name, gap in account.open_m.items() if gap > most), reverse=True
    )
    if not gaping:
        meant = "; is it the linkage that you mean? See far pin below" * bool(_far(account))
        return f"shut as the file has it{meant}; the run starts from the closed form"
    each = few([f"{name} by {short(gap, 3)} m" for gap, name in gaping], SHOWN)
    return (
        f"the file's own is open at {each}; the run starts from the closed form, where every joint "
        "is shut"
    )


def _far(account: ModelAccount) -> list[str]:
    return [each.text for each in account.disturbances if each.kind == FAR_PIN]


def groups(judged: JudgedModel) -> list[SentenceGroup]:
    """Return possible disturbances of the comparison, kind by kind, those on the way first."""
    kinds: dict[str, list[str]] = {}
    for each in judged.account.disturbances:
        kinds.setdefault(each.kind, []).append(each.text)
    return [SentenceGroup(kind, texts, effect(judged, kind)) for kind, texts in kinds.items()]


def effect(judged: JudgedModel, kind: str) -> str:
    """Return the effect of leaving out the disturbances of a kind; "" if no line shows it."""
    one = judged.without(kind)
    if one is None:
        return ""
    if one.status != "ok":
        return f"without: {one.status}"
    if judged.own.status != "ok":
        return "without: it runs to its end"
    return f"without: {factor_words(judged.gains(one)[0])}"


def factor_words(factor: float) -> str:
    """Return an error as written over another one, in words."""
    if math.isnan(factor):
        return "unknown"
    if 0.99 < factor < 1.01:
        return "the same error"
    if factor > 1.0:
        return "no error at all" if math.isinf(factor) else f"{factor_text(factor)} x less error"
    return f"{factor_text(1 / factor)} x more error" if factor > 0.0 else "all of the error"


def factor_text(factor: float) -> str:
    """Return a factor with few digits: 1.3, 27, 1.2e5."""
    if not math.isfinite(factor):
        return "-" if math.isnan(factor) else "inf"
    if factor >= 1e4 or factor < 0.095:
        return short(factor)
    return f"{factor:.0f}" if factor >= 100 else f"{factor:.2g}"


def gaps(judged: JudgedModel) -> str:
    """Return the widest gap of all joints as written, in words; "" where nothing was logged."""
    joints = [joint for joint in judged.joints() if judged.own.cell.profile in joint.gap_m]
    if not joints:
        return ""
    worst, *rest = joints
    name = judged.own.cell.profile
    longest_m = judged.scene.longest_m or 1.0

    def size(gap_m: float) -> str:
        return f"{error_text(gap_m)} m ({error_text(gap_m / longest_m)} L)"

    told_ = f"the widest as written is {worst.name}, {size(worst.gap_m[name])}"
    if math.isfinite(worst.share):
        told_ += f", {share_text(worst.share)}"
    if rest:
        told_ += f"; {count(len(rest), 'other')} up to {size(rest[0].gap_m[name])}"
    return told_


def still_out(judged: JudgedModel) -> str:
    """Return why the recommended settings are out of tolerance, "" if they are within."""
    finding = judged.still()
    if finding is None:
        return ""
    more = len(judged.lines[-1].failures) - 1
    others = f"; and by {count(more, 'more rule')}" if more else ""
    return f"out by {finding.rule} {RULES[finding.rule].title}: {finding.text}{others}"


def share_text(share: float) -> str:
    """Return an error over its limit: 0.12 of its limit, 34 times its limit."""
    return f"{readable(share, 2)} {'of' if share < 1.0 else 'times'} its limit"


def verdict_text(judged: JudgedModel) -> str:
    """Return the verdict on the model as written in one line, and the possible gain."""
    own, last = judged.own, judged.lines[-1]
    if own.verdict == "within":
        head = "WITHIN TOLERANCE as written"
    elif own.verdict == "known":
        head = f"KNOWN FAILURE as written{_why_out(judged)}"
    elif own.verdict == "unsupported":
        head = f"NOT RUN as written: {own.reason}"
    else:
        head = f"OUT OF TOLERANCE as written{_why_out(judged)}"
    if far := _far(judged.account):
        head += f", of a linkage that may not be the one you mean ({far[0].partition(';')[0]})"
    if not judged.account.helps:
        return f"{head}; {NO_HELP}"
    gain = judged.gains(last)[0]
    words = f", {factor_words(gain)}" if math.isfinite(gain) else ""
    return f"{head}; recommended: {last.verdict}{words}"


def _why_out(judged: JudgedModel) -> str:
    own = judged.own
    if own.status != "ok":
        return f": {own.status}"
    worst = worst_place(own.errors) if own.errors else None
    if worst is None:
        return ""
    return f": {worst.quantity} of {worst.body} {short(worst.pure)}"


def footer(judged: JudgedModel) -> list[str]:
    """Return the reference and scale of the numbers, and the length of the run."""
    account, own = judged.account, judged.own
    drive = own.errors.worst("drive") if own.errors else None
    driven = f"; largest drive error {short(drive.maximum)} rad" if drive else ""
    finer = ""
    if account.request.converge:
        finer = f"; {listed(list(told(account.profiles)))} at half and quarter step too"
    per_turn = account.scene.driver.law.period_s / account.dt_s
    return [
        "Largest errors of place against the closed form at the commanded time: rad, or over the "
        "longest link L; gain: the error as written over that of the line.",
        f"dt {account.dt_s:g} s, {per_turn:.4g} steps a turn, {account.steps} steps{driven}"
        f"{finer}.",
    ]


def steps_text(judged: JudgedModel) -> str:
    """Return the steps at which lines are run, in words."""
    if not judged.account.request.converge:
        return f"at dt {judged.account.dt_s:g} s"
    return f"at dt {judged.account.dt_s:g} s, its half and its quarter"


def step_heads(judged: JudgedModel) -> list[str]:
    """Return the heads of the columns of errors."""
    if not judged.account.request.converge:
        return ["dt"]
    return ["dt" if parts == 1 else f"dt/{parts}" for parts in PARTS]


def recommended_head(judged: JudgedModel) -> str:
    """Return the sentence before the recommended settings, if there are any."""
    if not judged.account.helps:
        return f"{NO_HELP.capitalize()}: neither stiff loops nor fourth-order steps do."
    if not judged.patch:
        return "The file has the recommended settings already."
    return f"Recommended{', as a diff of the file' * is_diff(judged.patch)}:"


def is_diff(patch: str) -> bool:
    """True if recommended settings are a diff, and not words."""
    return patch.startswith("--- ")


WIDE, NARROW = 76, 52
"""Columns of a terminal that show the gap and the body of the largest error; and those below which
the convergence by halving is left out, if all lines ran."""
STYLES = {name: "bold green" if name == "within" else "bold red" for name in MARKS}


def show(console: Console, judged: JudgedModel, facts: Mapping[str, str]) -> None:
    """Print the whole model."""
    _failures(console, judged)
    console.print(Text(harmless(str(judged.account.request.path)), "bold"))
    for head, text in reading(judged.account).items():
        hanging(console, f"  {head}: ", harmless(text))
    console.print()
    console.print(_table(judged, console.width), "")
    if text := still_out(judged):
        hanging(console, "recommended: ", harmless(text))
    if text := gaps(judged):
        hanging(console, "joints: ", harmless(text))
    _disturbing(console, judged)
    if text := judged.own.known_text:
        hanging(console, "as written: ", text, style="yellow")
    console.print(Text(recommended_head(judged), "bold"))
    console.print(harmless(judged.patch), markup=False, highlight=False, soft_wrap=True)
    console.print(Text(harmless(verdict_text(judged)), STYLES[judged.verdict]))
    lines = [*footer(judged), ", ".join(f"{name} {value}" for name, value in facts.items())]
    console.print(escape("\n".join(lines)), style="dim", highlight=False)


def _failures(console: Console, judged: JudgedModel) -> None:
    if not judged.failures:
        return
    head = f"{MARKS[judged.verdict].plain}  {judged.account.request.path}, as written"
    show_failed(console, head, titled(judged.failures), judged.own.remedy)
    console.print()


def _table(judged: JudgedModel, width: int) -> Table:
    """Return the three lines, each with its gain, and the others worth reporting."""
    wide = width >= WIDE
    heads = ["", "line", *(f"{head}:" for head in step_heads(judged))]
    heads += ["gap\n/ L:", "largest of"] * wide
    if width >= NARROW or any(one.errors is None for one in judged.lines):
        heads.append(HALVED)
    title = f"largest error of place {steps_text(judged)}"
    least = {"largest of": 12, HALVED: 10}
    table = grid(heads, (), title, gap=1, whole=("line",), cut=("",), least=least)
    for one in (*judged.three, *judged.others):
        _add(table, judged, one, wide=wide)
    return table


def _add(table: Table, judged: JudgedModel, one: CheckedLine, *, wide: bool) -> None:
    columns = len(table.columns) - 2
    steps = len(step_heads(judged))
    table.add_row(mark(one), one.cell.profile, *_numbers(one, steps, wide=wide)[:columns])
    if one is not judged.own and any(map(math.isfinite, judged.gains(one))):
        factors = [
            "" if math.isnan(factor) else factor_text(factor)
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
    found = groups(judged)
    if found:
        console.print("can disturb it:")
    for group in found:
        texts = [group.short(), *([group.effect] if group.effect else [])]
        hanging(console, f"  {group.kind}: ", harmless("; ".join(texts)))
    console.print()


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
            "disturbances": [vars(group) for group in groups(judged)],
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
