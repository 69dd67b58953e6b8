"""Colours of the page: enough contrast, told apart by those who see fewer, one dark theme."""

import itertools
import re

import numpy as np
import pytest

from models.array import Array
from reports.page.build import HERE
from reports.page.sections.hard import SHADES
from reports.results.lines import FAMILIES, FAMILY
from reports.stability.matrix import OUTCOMES

CSS = (HERE / "assets" / "page.css").read_text(encoding="utf-8")
MAP = (HERE / "assets" / "map.css").read_text(encoding="utf-8")
NORMAL = np.eye(3)
DEUTERANOPIA = np.array(
    [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]]
)
PROTANOPIA = np.array(
    [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.052]]
)
"""Machado, Oliveira and Fernandes, IEEE Transactions on Visualization 15 (2009), severity 1."""
TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
SEEN = pytest.mark.parametrize(
    "seen", [NORMAL, DEUTERANOPIA, PROTANOPIA], ids=["all", "deutan", "protan"]
)
WHITE = np.array([0.95047, 1.0, 1.08883])


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


def lab(colour: str, seen: Array) -> Array:
    """CIELAB as somebody sees it."""
    part = np.clip(TO_XYZ @ np.clip(seen @ linear(colour), 0.0, 1.0), 0.0, None) / WHITE
    f = np.where(part > 0.008856, np.cbrt(part), 7.787 * part + 16 / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


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


@THEMES
@SEEN
def test_colours_of_one_family_are_told_apart(theme: dict[str, str], seen: Array) -> None:
    families = [[f"c{FAMILY * k + i}" for i in range(FAMILY)] for k in range(FAMILIES)]
    families.append([f"p{i}" for i in range(5)])
    for family in families:
        for a, b in itertools.combinations(family, 2):
            away = np.linalg.norm(lab(theme[a], seen) - lab(theme[b], seen))
            assert away > 18.0, f"{a} and {b}"


def mixed(hue: str, part: float, paper: str) -> str:
    """What `color-mix` makes of a hue on paper."""
    pairs = [(int(hue[i : i + 2], 16), int(paper[i : i + 2], 16)) for i in (1, 3, 5)]
    return "#" + "".join(f"{round(part * a + (1.0 - part) * b):02x}" for a, b in pairs)


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


@THEMES
def test_the_signs_of_the_map_can_be_read_on_every_hue_and_shade(theme: dict[str, str]) -> None:
    for (name, hue), part in itertools.product(HUES.items(), PARTS.values()):
        ground = mixed(hue, part, theme["paper"])
        assert contrast(theme["ink"], ground) >= 4.5, f"{name} at {part}"


@THEMES
@SEEN
def test_what_holds_is_told_from_what_fails_by_colour(theme: dict[str, str], seen: Array) -> None:
    held = HUES[".cell.held"]
    for name, hue in (each for each in HUES.items() if each[0] != ".cell.held"):
        bar = lab(mixed(hue, 0.7, theme["ink"]), seen)
        ground = lab(mixed(hue, max(PARTS.values()), theme["paper"]), seen)
        assert np.linalg.norm(bar - ground) > 18.0, f"the bar under {name}"
        strong = [lab(mixed(each, 0.43, theme["paper"]), seen) for each in (held, hue)]
        assert np.linalg.norm(strong[0] - strong[1]) > 13.0, name
