"""Advice on the terminal: a row for each choice, what is to be said of them, and the snippets."""

from __future__ import annotations

import math
from collections.abc import Iterator

from rich.console import Console
from rich.table import Table
from rich.text import Text

from models.errors import harmless
from reports.advise.advice import Advice, Offer
from reports.advise.remarks import remarks
from reports.advise.search import WORDS, Worst
from reports.output.console import hanging, plain_table, say_whole
from reports.output.numbers import count, short
from reports.plan.steps import LEAST_STEPS_PER_TURN

WIDE, WIDEST = 76, 96
"""Columns of a terminal that have room for all, and for more room between."""
ABOUT = "~"
"""Before an error that was not run, but read between the steps of a study."""
COLOURS = {"within": "green", "over": "yellow"}


def show(console: Console, advice: Advice) -> None:
    """Print all of it, but for where it comes from."""
    console.print(Text(title(advice), "bold"))
    console.print(_table(advice, console.width), highlight=False)
    console.print()
    for line in verdict(advice):
        console.print(line, highlight=False)
    for label, text in remarks(advice):
        hanging(console, f"{label}: ", text, style="yellow")
    console.print()
    for offer in advice.best:
        if text := advice.snippet(offer):
            say_whole(console, text)
    for label, text in _settings(advice):
        hanging(console, f"{label}: ", text, style="dim")
    console.print(Text(footer(advice), "dim"), highlight=False)


def title(advice: Advice) -> str:
    """What was asked for."""
    demand = advice.demand
    names = ", ".join(scene.name for scene in demand.scenes)
    few = f", too few: it needs {LEAST_STEPS_PER_TURN} steps" if demand.least > 1 else ""
    return (
        f"{names} at {demand.speed_rad_s:g} rad/s\na frame of {demand.frame_s:g} s: "
        f"{demand.frames_per_turn:.3g} in a turn{few}; error of place up to "
        f"{demand.target:g} over {demand.turns:g} turns"
    )


def word(worst: Worst | None, target: float) -> str:
    """What the frame itself does, in a word or two."""
    if worst is None:
        return "too coarse"
    if worst.seen.status != "ok":
        return WORDS.get(worst.seen.status, worst.seen.status)
    return ("within" if worst.error <= target else "over") + ", grows" * worst.seen.grows


def verdict(advice: Advice) -> Iterator[Text]:
    """The best of each engine, or what comes nearest."""
    demand = advice.demand
    for offer in advice.best:
        promise = offer.reached.promise
        assert promise is not None
        step = demand.frame_s / promise.substeps
        each = f"{count(promise.substeps, 'step')} a frame ({1e3 * step:.4g} ms)"
        yield Text(
            f"{offer.reached.choice.label}, {each}: within {demand.target:g}, "
            f"{short(promise.error)} at worst{_price(offer)}",
            "bold green",
        )
    if not advice.best:
        yield Text(_nothing(advice), "bold red")


def _price(offer: Offer) -> str:
    price = offer.price
    return "" if price is None else f"; {_percent(price.s_per_s)} of real time"


def _nothing(advice: Advice) -> str:
    """What is said where nothing reaches the target."""
    most, nearest = advice.demand.most, advice.nearest
    text = f"NOTHING REACHES {advice.demand.target:g} with up to {count(most, 'sub-step')} a frame"
    if nearest is None or nearest.reached.nearest is None:
        return f"{text}: no run came to its end"
    worst = nearest.reached.nearest
    return (
        f"{text}: nearest is {nearest.reached.choice.label} with {worst.substeps}, "
        f"{short(worst.error)} on {worst.scene}; take a larger target, or search for settings with "
        "crankcheck tune"
    )


def _table(advice: Advice, width: int) -> Table:
    """A row for each choice, cheapest first."""
    wide = width >= WIDE
    table = plain_table(gap=2 if width >= WIDEST else 1)
    table.add_column("settings", overflow="fold", min_width=14)
    table.add_column("at the\nframe", justify="right", no_wrap=True)
    table.add_column("", overflow="fold", min_width=6)
    for head in ("sub-\nsteps", "their\nerror", "ms per\nsecond"):
        table.add_column(head, justify="right", no_wrap=True)
    if wide:
        table.add_column("of real\ntime", justify="right", no_wrap=True)
    table.add_column("times\nbest", justify="right", no_wrap=True)
    for offer in advice.offers:
        row = _row(advice, offer)
        table.add_row(*(row if wide else (*row[:-2], row[-1])))
    return table


def _row(advice: Advice, offer: Offer) -> list[Text]:
    """One choice."""
    reached, target = offer.reached, advice.demand.target
    said = word(reached.at_frame, target)
    best = "bold" if any(offer is each for each in advice.best) else ""
    cells = [
        Text(reached.choice.label, best),
        Text(_error(reached.at_frame)),
        Text(said, COLOURS.get(said, "red")),
    ]
    promise = reached.promise
    if promise is None:
        least = _error(reached.nearest)
        return [*cells, Text("none", "red"), Text(least, "dim"), *[Text("-", "dim")] * 3]
    numbers = [f"{promise.substeps}", _error(promise)]
    if offer.price is None:
        return [*cells, *(Text(n, best) for n in (*numbers, "-", "-", "-"))]
    share = offer.price.s_per_s
    numbers += [f"{1e3 * share:.3g}", _percent(share), _times(advice, offer)]
    return [*cells, *(Text(number, best) for number in numbers)]


def _error(worst: Worst | None) -> str:
    """The error with few digits; a dash where there is none."""
    if worst is None or not math.isfinite(worst.error):
        return "-"
    return (ABOUT if worst.seen.studied else "") + short(worst.error)


def _percent(share: float) -> str:
    return f"{100.0 * share:.2g} %" if share < 1.0 else f"{100.0 * share:.0f} %"


def _times(advice: Advice, offer: Offer) -> str:
    """The price over the least."""
    first = advice.promises[0]
    return "1" if advice.equal(offer, first) else f"{offer.s_per_s / first.s_per_s:.2g}"


def _settings(advice: Advice) -> Iterator[tuple[str, str]]:
    for offer in advice.offers:
        yield offer.reached.choice.label, offer.reached.choice.words


def footer(advice: Advice) -> str:
    """What the numbers are, and where they come from."""
    known, facts = advice.known, dict(advice.facts)
    noise = f", noise {advice.noise:.0%}" if math.isfinite(advice.noise) else ""
    lines = [
        "Errors of place: angle [rad], position and displacement over the longest link, against "
        "the closed form, the worst of the scenes. At the frame: with one step to a frame. "
        "Sub-steps: the fewest that reach the target; 1.4 and 2 times as many reach it, too; where "
        "none do, their error is the least that was seen.",
        "ms per second: of stepping alone, for a second of the mechanism's own time, on the "
        f"dearest scene; times of one run, to compare with each other{noise}.",
        *_of_scenes(advice),
    ]
    if known.folder is not None:
        lines += list(_of_study(advice))
    lines.append(", ".join(f"{name} {value}" for name, value in facts.items()))
    return "\n".join(lines)


def _of_scenes(advice: Advice) -> Iterator[str]:
    """What the promise is for, where no scene was named."""
    if not advice.named:
        yield (
            "Another mechanism may need other numbers: crankcheck advise SCENE ... takes your own."
        )


def _of_study(advice: Advice) -> Iterator[str]:
    """What was taken from the study, and what was not."""
    known, folder = advice.known, harmless(str(advice.known.folder))
    if known.measured:
        yield (
            f"{ABOUT} read between the steps of the study in {folder}, {known.turns:g} turns long; "
            "what its steps do not reach to was run now, and so was every promise. Prices are "
            "timed now as well: times of another hour or machine are not compared."
        )
    else:
        yield f"Nothing of the study in {folder} serves: all was run now."
    for text in known.refusals:
        yield f"Run now: {text}."
