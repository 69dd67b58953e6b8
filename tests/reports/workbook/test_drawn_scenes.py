"""Formulas of mechanisms whose links have frames, angles and pins that no shipped scene has."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

import pytest

from models.laws import ConstantSpeed
from models.scene import GROUND, Driver, Link, Point, Scene, Slider
from reports.workbook.evaluated import evaluated
from reports.workbook.live_workbook import formulas_of
from tests.worlds.live_tables import held_to_the_reference


class Drawn:
    """Scenes by chance: every frame lies anywhere."""

    def __init__(self, seed: int) -> None:
        self.chance = random.Random(seed)

    def place(self, size: float = 0.3) -> Point:
        return self.chance.uniform(-size, size), self.chance.uniform(-size, size)

    def angle(self) -> float:
        return self.chance.uniform(-math.pi, math.pi)

    def sign(self) -> int:
        return self.chance.choice((-1, 1))

    def bar(self, name: str, pins: str, low: float, high: float) -> Link:
        """A link with a third point, whose first two are so far apart."""
        (x, y), length, angle = self.place(), self.chance.uniform(low, high), self.angle()
        far = x + length * math.cos(angle), y + length * math.sin(angle)
        return self.link(name, {pins[0]: (x, y), pins[1]: far, f"of {name}": self.place()})

    def link(self, name: str, points: dict[str, Point]) -> Link:
        return Link(name, points, 1.0, (0.0, 0.0), 1.0)

    def near(self, centre: Point, size: float) -> Point:
        x, y = self.place(size)
        return centre[0] + x, centre[1] + y

    def scene(self, ground: dict[str, Point], links: list[Link], slider: Slider | None) -> Scene:
        crank = self.bar("crank", "AB", 0.05, 0.15)
        law = ConstantSpeed(self.sign() * self.chance.uniform(0.5, 20.0), self.angle())
        name = "C" if slider is None else slider.name
        links = self.chance.sample([crank, *links], 1 + len(links))
        return Scene(
            "drawn", "here", ground, {each.name: each for each in links},
            {} if slider is None else {slider.name: slider}, Driver("crank", law),
            {name: self.sign()},
        )  # fmt: skip


def ram(drawn: Drawn) -> Scene:
    """A slider that is a link, with the rod's pin off its line."""
    pivot, rod = drawn.place(), drawn.bar("rod", "BC", 0.4, 0.6)
    slides = drawn.link("ram", {"C": drawn.place(0.1), "T": drawn.place(0.1)})
    point, through = drawn.chance.choice("CT"), drawn.near(pivot, 0.1)
    slider = Slider("s", point, GROUND, through, drawn.angle(), "ram", drawn.angle())
    return drawn.scene({"A": pivot}, [rod, slides], slider)


def block(drawn: Drawn) -> Scene:
    pivot, rod = drawn.place(), drawn.bar("rod", "BC", 0.4, 0.6)
    slider = Slider("s", "C", GROUND, drawn.near(pivot, 0.1), drawn.angle(), mass_kg=1.0)
    return drawn.scene({"A": pivot}, [rod], slider)


def lever(drawn: Drawn) -> Scene:
    pivot, turns = drawn.place(), drawn.bar("lever", "CE", 0.1, 0.3)
    through = drawn.near(turns.points["C"], 0.1)
    ground = {"A": pivot, "C": drawn.near((pivot[0] + 0.45, pivot[1]), 0.1)}
    return drawn.scene(ground, [turns], Slider("s", "B", "lever", through, drawn.angle()))


def fourbar(drawn: Drawn) -> Scene:
    pivot, angle = drawn.place(), drawn.angle()
    ground = {"D": (pivot[0] + 0.4 * math.cos(angle), pivot[1] + 0.4 * math.sin(angle)), "A": pivot}
    bars = [drawn.bar("coupler", "BC", 0.35, 0.5), drawn.bar("rocker", "DC", 0.3, 0.4)]
    return drawn.scene(ground, bars, None)


@pytest.mark.parametrize("draw", [ram, block, lever, fourbar])
def test_formulas_are_the_reference_wherever_frames_lie(draw: Callable[[Drawn], Scene]) -> None:
    drawn = Drawn(17)
    for number in range(8):
        scene = draw(drawn)
        table = formulas_of(scene, 13, 27.5)
        assert table is not None, number
        held_to_the_reference(evaluated(table), scene, f"{number}: {scene}", turned=True)


def rod_on_the_pivot(drawn: Drawn) -> Scene:
    slider = Slider("s", "C", GROUND, (0.0, 0.0), drawn.angle())
    return drawn.scene({"A": (0.0, 0.0)}, [drawn.bar("rod", "AC", 0.3, 0.4)], slider)


def lever_on_the_crank(drawn: Drawn) -> Scene:
    turns = drawn.bar("lever", "BE", 0.2, 0.3)
    slider = Slider("s", "A", "lever", turns.points["B"], drawn.angle())
    return drawn.scene({"A": drawn.place()}, [turns], slider)


def links_on_the_pivot(drawn: Drawn) -> Scene:
    bars = [drawn.bar("coupler", "BC", 0.3, 0.3), drawn.bar("rocker", "AC", 0.3, 0.3)]
    return drawn.scene({"A": drawn.place()}, bars, None)


@pytest.mark.parametrize("draw", [rod_on_the_pivot, lever_on_the_crank, links_on_the_pivot])
def test_what_hangs_otherwise_has_values(draw: Callable[[Drawn], Scene]) -> None:
    """Their groups are of the same kinds, yet no sheet is theirs."""
    assert formulas_of(draw(Drawn(1)), 3, 1.0) is None
