"""Colours of the page: enough contrast, one dark theme, a hue and a shade for every outcome."""

import itertools
import re

import numpy as np

from reports.output.palette import COLOURS, colours_of, engine_styles
from reports.output.palette import DARK as ON_DARK
from reports.page.build import HERE, palette
from reports.page.sections.hard import SHADES
from reports.stability.matrix import OUTCOMES

CSS, MAP = ((HERE / "assets" / f"{n}.css").read_text(encoding="utf-8") for n in ("page", "map"))
THEMES: dict[str, dict[str, str]] = {}
for theme, colours in re.findall(r"(:root[^{]*) \{([^}]*)\}", CSS + palette()):
    THEMES.setdefault(theme, {}).update(re.findall(r"--([\w-]+): (#\w{6});", colours))
LIGHT, DARK, SYSTEM_DARK = THEMES.values()
"""Colours of the style sheet: light, dark by choice, dark by the system."""


def luminance(colour: str) -> float:
    """Of a colour as in a style sheet."""
    parts = np.array([int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)])
    linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    return float(np.dot(linear, [0.2126, 0.7152, 0.0722]))


def contrast(a: str, b: str) -> float:
    """The contrast ratio of WCAG 2."""
    dark, light = sorted(map(luminance, (a, b)))
    return (light + 0.05) / (dark + 0.05)


def test_both_ways_to_the_dark_theme_are_one() -> None:
    assert SYSTEM_DARK == DARK
    assert set(LIGHT) == set(DARK)


def test_figures_have_the_colours_of_the_light_page() -> None:
    assert [LIGHT[f"c{number}"] for number in range(len(COLOURS))] == list(COLOURS)
    assert f"c{len(COLOURS)}" not in LIGHT


def test_names_of_engines_on_a_terminal_are_seen_on_light_and_on_dark_paper() -> None:
    styles = list(engine_styles(f"engine {number}" for number in range(9)).values())
    assert len(set(styles)) == 9
    for number, style in enumerate(styles):
        assert style in {paper[n] for paper in (COLOURS, ON_DARK) for n in colours_of(number)}
        assert min(contrast(style, "#ffffff"), contrast(style, "#000000")) >= 3.0, style


def test_text_can_be_read_and_lines_be_seen() -> None:
    states = [(each, f"{each}-back") for each in ("good", "bad", "half")]
    soft = [("soft", "half-back"), ("soft", "bad-back"), ("half", "paper")]
    plain = [*itertools.product(("ink", "soft", "link"), ("paper", "panel"))]
    for theme in (LIGHT, DARK):
        for text, ground in (*plain, *states, *soft):
            assert contrast(theme[text], theme[ground]) >= 4.5, f"{text} on {ground}"
        for name, colour in theme.items():
            if re.fullmatch(r"[cp]\d+", name):
                assert contrast(colour, theme["paper"]) >= 3.0, name


def test_every_outcome_has_a_hue_and_every_shade_is_stronger_than_the_one_before() -> None:
    rules = re.findall(r"^([.][^{}]+) \{ --o: (#\w{6}); \}", MAP, re.MULTILINE)
    hues = {name.strip() for names, _ in rules for name in names.split(",")}
    # Of each outcome where it is a failure, and of what holds.
    assert {f".o-{name}" for name in (*OUTCOMES, "strange")} | {".cell.held"} == hues
    of_hue = re.findall(r"\.(\w+) \{ --s: (\d+)%; \}", MAP)
    shades = {name: int(part) / 100 for name, part in of_hue}
    names = [f"s{i}" for i in range(len(SHADES) + 1)]
    assert set(shades) == {*names, "blank"}
    parts = [shades[name] for name in names]
    assert all(b - a >= 0.08 for a, b in itertools.pairwise(parts))


RED_GREEN = (
    np.array([[0.1523, 1.0526, -0.2049], [0.1145, 0.7863, 0.0992], [-0.0039, -0.0481, 1.0520]]),
    np.array([[0.3673, 0.8606, -0.2280], [0.2801, 0.6725, 0.0474], [-0.0118, 0.0429, 0.9689]]),
)
"""Linear colours as protanopes and deuteranopes see them. Source: Machado, Oliveira, Fernandes, A
physiologically-based model for simulation of color vision deficiency, 2009."""
LMS = np.array([[0.4122, 0.5363, 0.0514], [0.2119, 0.6807, 0.1074], [0.0883, 0.2817, 0.6300]])
LAB = np.array([[0.2105, 0.7936, -0.0041], [1.9780, -2.4286, 0.4506], [0.0259, 0.7828, -0.8087]])
"""From linear colours to OKLab, where a step just seen is about 0.02."""


def test_colours_of_nine_engines_differ_for_colour_blind_readers() -> None:
    for theme, seen in itertools.product((LIGHT, DARK), (np.eye(3), *RED_GREEN)):
        colours = {}
        for number in range(18):
            hexes = theme[f"c{number}"]
            parts = np.array([int(hexes[i : i + 2], 16) / 255 for i in (1, 3, 5)])
            linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
            colours[number] = LAB @ np.cbrt(LMS @ np.clip(seen @ linear, 0.0, 1.0))
        for new, other in itertools.product(range(12, 18), (*range(10), *range(12, 18))):
            if new != other:
                assert np.linalg.norm(colours[new] - colours[other]) > 0.06, (new, other)
