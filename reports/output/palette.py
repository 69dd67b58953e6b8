"""Colours of engines, in figures, on pages and on the terminal."""

from collections.abc import Iterable, Mapping

import numpy as np

FAMILY = 4
"""Colours in a family, of which there are three: cool, warm, and green with grey."""
FAMILIES = 3
ALONE = 6
"""Colours of further engines, after those of the families: one each."""
COLOURS = (
    *("#11365a", "#1e6d93", "#00a07e", "#4c0d84", "#6f0a2c", "#c8402a"),
    *("#c97c00", "#b06a8f", "#4c480b", "#48966a", "#8f8f0f", "#164937"),
    *("#1551ff", "#b60872", "#8282fb", "#0401c2", "#fd36c5", "#8e3bc3"),
)
DARK = (
    *("#c6cffe", "#2f93b8", "#66ecbb", "#9a6cf0", "#f0524a", "#fee5b9"),
    *("#e358aa", "#f8ad33", "#e0edcc", "#39b555", "#f0c82f", "#6e8075"),
    *("#67c2d0", "#adfe14", "#a0a2ff", "#0067ca", "#b31cb1", "#ab4a4a"),
)
"""Colours on light and on dark paper."""


def colours_of(family: int) -> range:
    """Return the numbers of the colours of an engine, by its place among the engines."""
    if family < FAMILIES:
        return range(family * FAMILY, (family + 1) * FAMILY)
    number = FAMILIES * FAMILY + (family - FAMILIES) % ALONE
    return range(number, number + 1)


def engine_styles(engines: Iterable[str]) -> Mapping[str, str]:
    """Return the style of each engine's name on a terminal, whose paper may be light or dark: the
    first of its colours that is seen on both."""
    return {
        engine: next(
            paper[n] for paper in (COLOURS, DARK) for n in colours_of(at) if _is_seen(paper[n])
        )
        for at, engine in enumerate(dict.fromkeys(engines))
    }


def _is_seen(colour: str) -> bool:
    """True if a colour has a contrast of 3 to white and to black. Source: WCAG 2."""
    parts = np.array([int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5)])
    linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    return bool(0.1 <= linear @ [0.2126, 0.7152, 0.0722] <= 0.3)
