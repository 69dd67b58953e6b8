"""Colours of the page: enough contrast, told apart by those who see fewer, one dark theme."""

from __future__ import annotations

import itertools
import re

import numpy as np
import pytest

from reports.page.build import HERE
from reports.page.looks import FAMILIES, FAMILY
from reports.series import Array

CSS = (HERE / "assets" / "page.css").read_text(encoding="utf-8")
NORMAL = np.eye(3)
DEUTERANOPIA = np.array(
    [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]]
)
PROTANOPIA = np.array(
    [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.052]]
)
"""Machado, Oliveira and Fernandes, IEEE Transactions on Visualization 15 (2009), severity 1."""
TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
WHITE = np.array([0.95047, 1.0, 1.08883])


def themes() -> list[dict[str, str]]:
    """The colours of each block of the style sheet: light, dark by the system, dark by choice."""
    blocks = re.findall(r":root[^{]*\{([^}]*)\}", CSS)
    return [dict(re.findall(r"--([\w-]+): (#\w{6});", block)) for block in blocks]


LIGHT, SYSTEM_DARK, DARK = themes()


def linear(colour: str) -> Array:
    """Linear red, green and blue."""
    parts = np.array([int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)])
    return np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)


def contrast(a: str, b: str) -> float:
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


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=["light", "dark"])
def test_text_can_be_read_and_lines_be_seen(theme: dict[str, str]) -> None:
    for text, ground in (
        *itertools.product(("ink", "soft", "link"), ("paper", "panel")),
        ("good", "good-back"),
        ("bad", "bad-back"),
        ("half", "half-back"),
        ("soft", "half-back"),
        ("soft", "bad-back"),
        ("half", "paper"),
    ):
        assert contrast(theme[text], theme[ground]) >= 4.5, f"{text} on {ground}"
    for name, colour in theme.items():
        if re.fullmatch(r"[cp]\d+", name):
            assert contrast(colour, theme["paper"]) >= 3.0, name


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=["light", "dark"])
@pytest.mark.parametrize(
    "seen", [NORMAL, DEUTERANOPIA, PROTANOPIA], ids=["all", "deutan", "protan"]
)
def test_colours_of_one_family_are_told_apart(theme: dict[str, str], seen: Array) -> None:
    families = [[f"c{FAMILY * k + i}" for i in range(FAMILY)] for k in range(FAMILIES)]
    families.append([f"p{i}" for i in range(5)])
    for family in families:
        for a, b in itertools.combinations(family, 2):
            away = np.linalg.norm(lab(theme[a], seen) - lab(theme[b], seen))
            assert away > 18.0, f"{a} and {b}"
