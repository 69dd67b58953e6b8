"""Colours of the page: enough contrast, one dark theme, a hue and a shade for every outcome."""

import itertools
import re

import numpy as np
import pytest

from models.array import Array
from reports.page.build import HERE
from reports.page.sections.hard import SHADES
from reports.stability.matrix import OUTCOMES

CSS = (HERE / "assets" / "page.css").read_text(encoding="utf-8")
MAP = (HERE / "assets" / "map.css").read_text(encoding="utf-8")
TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])


def themes() -> list[dict[str, str]]:
    """The colours of each block of the style sheet: light, dark by the system, dark by choice."""
    blocks = re.findall(r":root[^{]*\{([^}]*)\}", CSS)
    return [dict(re.findall(r"--([\w-]+): (#\w{6});", block)) for block in blocks]


LIGHT, SYSTEM_DARK, DARK = themes()
THEMES = pytest.mark.parametrize("theme", [LIGHT, DARK], ids=["light", "dark"])


def linear(colour: str | Array) -> Array:
    """Linear red, green and blue of a colour as in a style sheet, or of its parts."""
    parts = colour
    if isinstance(colour, str):
        parts = np.array([int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)])
    return np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)


def contrast(a: str | Array, b: str | Array) -> float:
    """The contrast ratio of WCAG 2."""
    dark, light = sorted(float(TO_XYZ[1] @ linear(colour)) for colour in (a, b))
    return (light + 0.05) / (dark + 0.05)


def test_both_ways_to_the_dark_theme_are_one() -> None:
    assert SYSTEM_DARK == DARK
    assert set(LIGHT) == set(DARK)


@THEMES
def test_text_can_be_read_and_lines_be_seen(theme: dict[str, str]) -> None:
    states = [(each, f"{each}-back") for each in ("good", "bad", "half")]
    soft = [("soft", "half-back"), ("soft", "bad-back"), ("half", "paper")]
    plain = itertools.product(("ink", "soft", "link"), ("paper", "panel"))
    for text, ground in (*plain, *states, *soft):
        assert contrast(theme[text], theme[ground]) >= 4.5, f"{text} on {ground}"
    for name, colour in theme.items():
        if re.fullmatch(r"[cp]\d+", name):
            assert contrast(colour, theme["paper"]) >= 3.0, name


PARTS = {name: int(part) / 100 for name, part in re.findall(r"\.(\w+) \{ --s: (\d+)%; \}", MAP)}
"""How much of its hue a cell of the map has, by the shade of its error."""
RULES = re.findall(r"^([.][^{}]+) \{ --o: (#\w{6}); \}", MAP, re.MULTILINE)
HUES = {name.strip(): hue for names, hue in RULES for name in names.split(",")}
"""The hue of each outcome in the map where it is a failure, and that of what holds."""


def test_every_outcome_has_a_hue_and_every_shade_is_stronger_than_the_one_before() -> None:
    assert {f".o-{name}" for name in (*OUTCOMES, "strange")} | {".cell.held"} == set(HUES)
    names = [f"s{i}" for i in range(len(SHADES) + 1)]
    assert set(PARTS) == {*names, "blank"}
    parts = [PARTS[name] for name in names]
    assert all(b - a >= 0.08 for a, b in itertools.pairwise(parts))
