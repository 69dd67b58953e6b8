"""Light bodies that hold heavy ones, and the other way about."""

from __future__ import annotations

from dataclasses import replace

from models.files import load_scene
from models.scene import Scene
from reports.stability.case import Case, Trial

GROUP = "mass ratios"
FOURBAR = "fourbar-lecture-1"
SLIDER_CRANK = "slider-crank-offset"
RATIOS = (1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6)
LIGHT = (1.0, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 0.0)


def _weighed(scene: Scene, name: str, factor: float) -> Scene:
    """The scene with one link that many times as heavy, of the same shape."""
    link = scene.links[name]
    mass, inertia = link.mass_kg * factor, link.inertia_kg_m2 * factor
    heavy = replace(link, mass_kg=mass, inertia_kg_m2=inertia)
    return replace(scene, links={**scene.links, name: heavy})


def _heavy_rocker(value: float) -> Trial:
    return Trial(_weighed(load_scene(FOURBAR), "rocker", value))


def _light_rocker(value: float) -> Trial:
    return Trial(_weighed(load_scene(FOURBAR), "rocker", 1.0 / value))


def _light_coupler(value: float) -> Trial:
    return Trial(_weighed(load_scene(FOURBAR), "coupler", value))


def _block(factor: float) -> Trial:
    scene = load_scene(SLIDER_CRANK)
    rod = scene.links["rod"].mass_kg
    sliders = {n: replace(s, mass_kg=rod * factor) for n, s in scene.sliders.items()}
    return Trial(replace(scene, sliders=sliders))


def _heavy_block(value: float) -> Trial:
    return _block(value)


def _light_block(value: float) -> Trial:
    return _block(1.0 / value)


def _case(name: str, title: str, source: str, **given: object) -> Case:
    chosen = {"parameter": "mass ratio", "values": RATIOS} | given
    return Case(
        name=name,
        group=GROUP,
        title=title,
        source=source,
        truth="closed form: the masses do not matter to a driven mechanism",
        expected="holds, with more iterations if need be",
        unit="",
        **chosen,  # type: ignore[arg-type]  # what differs between these cases
    )


CASES = (
    _case("heavy-rocker", "Heavy rocker behind a light coupler", FOURBAR, trial=_heavy_rocker),
    _case("light-rocker", "Light rocker behind a heavy coupler", FOURBAR, trial=_light_rocker),
    _case("heavy-block", "Heavy block behind a light rod", SLIDER_CRANK, trial=_heavy_block),
    _case("light-block", "Light block behind a heavy rod", SLIDER_CRANK, trial=_light_block),
    _case(
        "massless-coupler",
        "Coupler with less and less mass, in the end none",
        FOURBAR,
        trial=_light_coupler,
        parameter="mass of the coupler, over that of a slender rod",
        values=LIGHT,
    ),
)
