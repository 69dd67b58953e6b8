"""A mechanism of unequal masses is no worse in MuJoCo than one whose masses are alike."""

from dataclasses import replace

import pytest

from models.files.reading import load_scene
from models.scene import Scene
from reports.judge.cell import Cell, Checked, check


def rod_over_block(ratio: float) -> Scene:
    scene = load_scene("slider-crank-offset")
    mass_kg = scene.links["rod"].mass_kg / ratio
    blocks = {name: replace(each, mass_kg=mass_kg) for name, each in scene.sliders.items()}
    return replace(scene, sliders=blocks)


def times_heavier(name: str, ratio: float) -> Scene:
    scene = load_scene("fourbar-lecture-1")
    link = scene.links[name]
    heavy = replace(link, mass_kg=ratio * link.mass_kg, inertia_kg_m2=ratio * link.inertia_kg_m2)
    return replace(scene, links={**scene.links, name: heavy})


def turned(scene: Scene, steps: int, **settings: str) -> Checked:
    dt_s = scene.driver.law.period_s / steps
    return check(Cell(scene, "mujoco", "tuned", dt_s, steps, converge=False, settings=settings))


def worst(checked: Checked) -> float:
    return max(e.pure for name in ("position", "gap") if (e := checked.errors.worst(name)))


def test_a_rod_of_ten_thousand_times_the_mass_of_its_block() -> None:
    heavy, alike = (turned(rod_over_block(ratio), 1440) for ratio in (1e4, 1.0))
    assert worst(heavy) < 1.2 * worst(alike)
    assert not heavy.failures


@pytest.mark.parametrize(("name", "ratio"), [("coupler", 1e-4), ("rocker", 1e4)])
def test_a_link_of_ten_thousand_times_the_mass_of_the_others(name: str, ratio: float) -> None:
    unequal, alike = (turned(times_heavier(name, r), 360) for r in (ratio, 1.0))
    assert worst(unequal) < 3.0 * worst(alike)


def test_a_loop_closed_between_light_and_heavy_gives_way_by_their_ratio() -> None:
    """What the closing is chosen by: R = (1 - d) / d times the inverse masses of both bodies."""
    errors = [worst(turned(rod_over_block(ratio), 360, close="C")) for ratio in (1e3, 1e4)]
    assert errors[1] / errors[0] == pytest.approx(10.0, rel=0.1)
    finer = worst(turned(rod_over_block(1e4), 720, close="C"))
    assert errors[1] / finer == pytest.approx(4.0, rel=0.1)
