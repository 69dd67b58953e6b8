"""Channels, times and numbers in the words of a cause."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence

from models.errors import few
from reports.logs.channel import Channel
from reports.output.numbers import duration, listed

NAMED = 3
"""Channels that are named each; of more the columns are listed."""
SHOWN = 8
CLASSES: Mapping[str, Callable[[Channel], bool]] = {
    "channels": lambda channel: True,
    "rates": lambda channel: channel.kind.order > 0,
    "velocities": lambda channel: channel.kind.order == 1,
    "accelerations": lambda channel: channel.kind.order == 2,
    "places": lambda channel: channel.kind.order == 0,
    "angles": lambda channel: channel.kind.turns,
    "angles and their rates": lambda channel: channel.kind.body_kind == "link",
    "lengths": lambda channel: channel.kind.dimension == "length",
    "lengths and their rates": lambda channel: channel.kind.body_kind != "link",
}
"""Classes of channels, by what they are called together."""


def who(channels: Sequence[Channel], every: Sequence[Channel]) -> str:
    """Channels in a sentence; a class of ``every`` channel of the log by its name."""
    columns = f"(columns {few([channel.column for channel in channels], SHOWN)})"
    chosen = {channel.column for channel in channels}
    for name, belongs in CLASSES.items():
        if len(chosen) > 1 and chosen == {c.column for c in every if belongs(c)}:
            return f"all {name} {columns}"
    if len(channels) > NAMED:
        return f"{len(channels)} channels {columns}"
    return listed([f"{channel.name} (column {channel.column})" for channel in channels])


def sentence(phrase: str, channels: Sequence[Channel], every: Sequence[Channel]) -> str:
    """A phrase with its channels and the verbs that go with them."""
    many = len(channels) > 1
    verbs = {"is": "are", "has": "have", "was": "were", "does": "do", "s": ""}
    words = {one: other if many else one for one, other in verbs.items()}

    def word(match: re.Match[str]) -> str:
        name = match.group(1)
        if name == "who":
            return who(channels, every)
        if name in words:
            return words[name]
        return name.removesuffix("s") if many else name

    return re.sub(r"\{(\w+)\}", word, phrase)


def later(by_s: float, step_s: float) -> str:
    """A delay in samples and seconds: 0.50 samples (0.69 ms) later."""
    samples = abs(by_s) / step_s
    digits = 2 if samples < 100 else 0
    direction = "later" if by_s > 0.0 else "earlier"
    return f"{samples:.{digits}f} samples ({duration(abs(by_s))}) {direction}"


def number(value: float, digits: int = 4) -> str:
    """A number with few digits, 0 where it is nothing."""
    return f"{value:.{digits}g}"


def change(now: float, before: float) -> str:
    """How much more a number is than another one that is not 0: +1 %, -120 ppm."""
    share = now / before - 1.0
    if abs(share) < 0.9995e-3:
        return f"{1e6 * share:+.3g} ppm"
    return f"{100.0 * share:+.3g} %"
