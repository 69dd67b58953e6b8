"""An own model on the terminal: what was read, a line for each way to run it, what to change."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from rich.console import Console
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from models.errors import few, harmless
from reports.judge.cell import Checked
from reports.judge.halving import worst_place
from reports.judge.rules import RULES
from reports.output.columns import hanging, plain_table
from reports.output.numbers import count
from reports.own_model.account import Account, told
from reports.verify.table import MARKS

OPEN = 1e-9
"""A joint that is open by more, over the longest link, is told."""
SHOWN = 6
PARTS = (1, 2, 4)


def show(
    console: Console, account: Account, checked: Sequence[Checked], facts: Mapping[str, str]
) -> None:
    """Print it all."""
    _read(console, account)
    own = checked[0]
    for finding in own.failures:
        rule = RULES[finding.rule]
        hanging(console, f"  {rule.id} ", harmless(f"{rule.title}: {finding.text}"))
    for text in account.disturbances:
        hanging(console, "  there is ", harmless(text))
    console.print()
    console.print(_table(account, checked), "")
    for text in gains(account, checked):
        hanging(console, "", harmless(text))
    if account.patch:
        console.print("\nRecommended, as a diff of the file:", style="bold")
        console.print(harmless(account.patch), markup=False, highlight=False, soft_wrap=True)
    console.print(verdict_line(own))
    console.print(escape("\n".join(footer(account, facts))), style="dim", highlight=False)


def _read(console: Console, account: Account) -> None:
    """What the file was read as."""
    for text in reading(account):
        hanging(console, "", harmless(text))


def reading(account: Account) -> list[str]:
    """What the file was read as, in sentences."""
    scene, request = account.scene, account.request
    links = ", ".join(scene.links)
    sliders = f"; sliders: {', '.join(scene.sliders)}" if scene.sliders else ""
    texts = [
        f"{request.path}: {count(len(scene.links), 'link')} ({links}){sliders}; driven by "
        f"{request.joint} at {request.speed_rad_s:g} rad/s",
        *account.notes,
    ]
    gaping = {
        name: gap for name, gap in account.open_m.items() if gap > OPEN * (scene.longest_m or 1.0)
    }
    if gaping:
        each = few([f"{name} by {gap:.3g} m" for name, gap in gaping.items()], SHOWN)
        texts.append(
            f"the file's own pose is open at {each}; the run starts from the closed form, where "
            "all joints are shut"
        )
    else:
        texts.append("the file's own pose is shut; the run starts from the closed form")
    texts.append("drive: a flywheel on the driven hinge, set at run time; nothing else is changed")
    return texts


def _table(account: Account, checked: Sequence[Checked]) -> Table:
    """A row for each line: the error that is followed, at the step, its half and its quarter."""
    table = plain_table()
    table.add_column("")
    table.add_column("line", no_wrap=True)
    for parts in PARTS:
        head = f"dt {account.dt_s / parts:.4g} s"
        table.add_column(head, justify="right", no_wrap=True)
    table.add_column("gap", justify="right", no_wrap=True)
    table.add_column("of", overflow="fold")
    table.add_column("when dt\nis halved", overflow="fold", min_width=12)
    for one in checked:
        mark = MARKS[one.verdict]
        shown = mark if one.cell.gated or one.verdict == "within" else Text(mark.plain, "yellow")
        table.add_row(shown, one.cell.profile, *_numbers(one))
    return table


def _numbers(one: Checked) -> list[str]:
    """One row, from its numbers on."""
    worst = worst_place(one.errors) if one.errors else None
    if one.errors is None or worst is None:
        return ["-"] * (len(PARTS) + 1) + ["", harmless(f"{one.status}: {one.reason}")]
    seen = one.convergence
    finer = [f"{error:.1e}" for error in seen.error[1:]] if seen else [""] * (len(PARTS) - 1)
    gap = one.errors.worst("gap")
    ended = seen.words if seen else ""
    if one.status != "ok":
        ended = f"{one.status} at t = {one.stopped_at_s:.3g} s"
    return [
        f"{worst.pure:.1e}",
        *finer,
        f"{gap.pure:.1e}" if gap else "-",
        f"{worst.quantity} of {worst.body}",
        ended,
    ]


def error_of(one: Checked) -> float:
    """The largest error of place of a line, as a pure number; NaN where it has none."""
    worst = worst_place(one.errors) if one.errors else None
    return math.nan if worst is None or one.status != "ok" else worst.pure


def gains(account: Account, checked: Sequence[Checked]) -> list[str]:
    """What each other line leaves of the error as written."""
    own, texts = error_of(checked[0]), []
    for one in checked[1:]:
        error = error_of(one)
        name = one.cell.profile
        if math.isnan(error) or math.isnan(own):
            continue
        if name not in told(account.profiles) and not (error < own / 2 or error > 2 * own):
            continue
        if own <= 0.0 or error == own:
            texts.append(f"{name}: the same error")
        elif error < own:
            texts.append(f"{name}: {own / max(error, 1e-300):.3g} times less error")
        else:
            texts.append(f"{name}: {error / own:.3g} times more error")
    return texts


def verdict_line(own: Checked) -> Text:
    """The verdict on the model as written."""
    if own.verdict == "within":
        return Text("WITHIN TOLERANCE as written", "bold green")
    return Text("OUT OF TOLERANCE as written", "bold red")


def footer(account: Account, facts: Mapping[str, str]) -> list[str]:
    """Units, steps and versions."""
    cell_turns = account.steps * account.dt_s / account.scene.driver.law.period_s
    return [
        "Largest error of place against the closed form at the commanded time: rad, or over the "
        "longest link.",
        f"{account.steps} steps of {account.dt_s:g} s, {cell_turns:.4g} turns; "
        f"{', '.join(told(account.profiles))} are run at half and quarter step too",
        ", ".join(f"{name} {value}" for name, value in facts.items()),
    ]
