"""Advice on the terminal: a row for each choice, remarks, and the snippets."""

import math
from collections.abc import Iterator, Mapping

from rich.console import Console
from rich.table import Table
from rich.text import Text

from models.errors import few, harmless
from reports.advise.advice import Advice, Offer
from reports.advise.demand import Demand
from reports.advise.search import WORDS, Worst
from reports.output.console import grid, hanging, say_whole
from reports.output.formats import json_text
from reports.output.numbers import count, short
from reports.plan.steps import LEAST_STEPS_PER_TURN
from sim.registry import engine

WIDE, WIDEST = 76, 96
"""Columns of a terminal that have room for all, and for more room between."""
ABOUT = "~"
"""Mark of an error that was not run, but read between the steps of a study."""
COLOURS = {"within": "green", "over": "yellow"}


def show_advice(console: Console, advice: Advice) -> None:
    """Print all of it, except for its provenance."""
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
    """Return the demand in words."""
    demand = advice.demand
    names = ", ".join(scene.name for scene in demand.scenes)
    few = f", too few: it needs {LEAST_STEPS_PER_TURN} steps" if demand.least > 1 else ""
    return (
        f"{names} at {demand.speed_rad_s:g} rad/s\na frame of {demand.frame_s:g} s: "
        f"{demand.frames_per_turn:.3g} in a turn{few}; error of place up to "
        f"{demand.target:g} over {demand.turns:g} turns"
    )


def word(worst: Worst | None, target: float) -> str:
    """Return the result at the frame itself, in a word or two."""
    if worst is None:
        return "too coarse"
    if worst.seen.status != "ok":
        return WORDS.get(worst.seen.status, worst.seen.status)
    return ("within" if worst.error <= target else "over") + ", grows" * worst.seen.grows


def verdict(advice: Advice) -> Iterator[Text]:
    """Yield the best of each engine, or the nearest offer."""
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
    wide = width >= WIDE
    heads = ("settings", "at the\nframe:", "", "sub-\nsteps:", "their\nerror:", "ms per\nsecond:")
    last = (*["of real\ntime:"] * wide, "times\nbest:")
    gap = 2 if width >= WIDEST else 1
    table = grid((*heads, *last), gap=gap, least={"settings": 14, "": 6})
    for offer in advice.offers:
        row = _row(advice, offer)
        table.add_row(*(row if wide else (*row[:-2], row[-1])))
    return table


def _row(advice: Advice, offer: Offer) -> list[Text]:
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
    if worst is None or not math.isfinite(worst.error):
        return "-"
    return (ABOUT if worst.seen.studied else "") + short(worst.error)


def _percent(share: float) -> str:
    return f"{100.0 * share:.2g} %" if share < 1.0 else f"{100.0 * share:.0f} %"


def _times(advice: Advice, offer: Offer) -> str:
    first = advice.promises[0]
    return "1" if advice.equal(offer, first) else f"{offer.s_per_s / first.s_per_s:.2g}"


def _settings(advice: Advice) -> Iterator[tuple[str, str]]:
    for offer in advice.offers:
        yield offer.reached.choice.label, offer.reached.choice.words


def footer(advice: Advice) -> str:
    """Return the meaning of the numbers, and their origin."""
    known, facts = advice.known, dict(advice.facts)
    noise = f", noise {advice.noise:.0%}" if math.isfinite(advice.noise) else ""
    lines = [
        "Errors of place: angle [rad], position and displacement over the longest link, against "
        "the closed form, in the worst scene. At the frame: one step per frame. Sub-steps: the "
        "fewest that reach the target, as do 1.4 and 2 times as many; if none do, those with "
        "the smallest error.",
        "ms per second: stepping alone, for a second of the mechanism's own time, in the "
        f"slowest scene; compare these times only with each other{noise}.",
    ]
    if not advice.named:
        lines.append(
            "Another mechanism may need other numbers: crankcheck advise SCENE ... takes your own."
        )
    if known.folder is not None:
        lines += list(_of_study(advice))
    lines.append(", ".join(f"{name} {value}" for name, value in facts.items()))
    return "\n".join(lines)


def _of_study(advice: Advice) -> Iterator[str]:
    known, folder = advice.known, harmless(str(advice.known.folder))
    if known.measured:
        yield (
            f"{ABOUT} read between the steps of the study in {folder}, {known.turns:g} turns "
            "long; other steps and every promise were run now. Costs were timed now too: times "
            "of another hour or machine can not be compared."
        )
    else:
        yield f"Nothing in the study in {folder} applies: everything was run now."
    for text in known.refusals:
        yield f"Run now: {text}."


SHOWN = 3
"""Numbers of sub-steps that a sentence names."""


def remarks(advice: Advice) -> Iterator[tuple[str, str]]:
    """Yield the choices with a remark, and the remark."""
    groups: dict[str, list[str]] = {}
    for offer in advice.offers:
        for text in filter(None, _of(advice, offer)):
            groups.setdefault(text, []).append(offer.reached.choice.label)
    for text, labels in groups.items():
        yield ", ".join(labels), text


def _of(advice: Advice, offer: Offer) -> Iterator[str]:
    """Yield the remarks on one offer; "" where there is none."""
    reached = offer.reached
    yield reached.ended.reason if reached.ended else ""
    if reached.unsteady:
        numbers = few((str(n) for n in reached.unsteady), SHOWN)
        yield f"within with {numbers} sub-steps, but not with more: luck, and no promise"
    yield _growth(reached.promise or reached.at_frame)
    yield advice.caution(offer)


def _growth(worst: Worst | None) -> str:
    if worst is None or not worst.seen.grows:
        return ""
    return (
        f"the error grows: with {worst.substeps} a frame it is {worst.seen.growth:.2g} times as "
        "large in the second half of the run"
    )


def document(advice: Advice) -> str:
    """Return the text of the file; numbers that are not finite are null."""
    demand, known = advice.demand, advice.known
    content = {
        "provenance": dict(advice.facts),
        "asked": {
            "scenes": [scene.name for scene in demand.scenes],
            "speed_rad_s": demand.speed_rad_s,
            "frame_s": demand.frame_s,
            "frames_per_turn": demand.frames_per_turn,
            "turns": demand.turns,
            "target": demand.target,
            "most_substeps": demand.most,
        },
        "study": None
        if known.folder is None
        else {
            "folder": str(known.folder),
            "turns": known.turns,
            "lines": len(known.measured),
            "not_used": list(known.refusals),
        },
        "noise": advice.noise,
        "best": [offer.reached.choice.label for offer in advice.best],
        "settings": [_offer(advice, offer) for offer in advice.offers],
    }
    return json_text(content)


def _offer(advice: Advice, offer: Offer) -> Mapping[str, object]:
    reached, demand = offer.reached, advice.demand
    choice, price = reached.choice, offer.price
    return {
        "engine": choice.engine,
        "version": engine(choice.engine).version(),
        "name": choice.name,
        "profile": choice.profile,
        "settings": dict(choice.settings),
        "at_frame": {"word": word(reached.at_frame, demand.target)}
        | _worst(demand, reached.at_frame),
        "promise": reached.promise
        and _worst(demand, reached.promise) | {"held_at": list(reached.held_at)},
        "unsteady": list(reached.unsteady),
        "nearest": reached.nearest and _worst(demand, reached.nearest),
        "ended": reached.ended and {"status": reached.ended.status, "reason": reached.ended.reason},
        "runs": reached.runs,
        "us_per_step": price and price.us_per_step,
        "ms_per_simulated_s": price and 1e3 * price.s_per_s,
        "of_real_time": price and price.s_per_s,
        "dearest_scene": price and price.scene,
        "times_cheapest": price and offer.s_per_s / advice.promises[0].s_per_s,
        "snippet": advice.snippet(offer),
    }


def _worst(demand: Demand, worst: Worst | None) -> dict[str, object]:
    if worst is None:
        return {}
    return {
        "substeps": worst.substeps,
        "dt_s": demand.frame_s / worst.substeps,
        "steps_per_turn": demand.steps_per_turn(worst.substeps),
        "place_error": worst.error,
        "scene": worst.scene,
        "status": worst.seen.status,
        "growth": worst.seen.growth,
        "measured": "study" if worst.seen.studied else "now",
    }
