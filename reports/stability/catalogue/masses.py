"""Light bodies that hold heavy ones, and the other way about."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from models.files.reading import load_scene
from reports.stability.case import Case, Trial

FOURBAR = "fourbar-lecture-1"
SLIDER_CRANK = "slider-crank-offset"
RATIOS = (1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6)
LIGHT = (1.0, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 0.0)


def _link(name: str, factor: float) -> Trial:
    """The four-bar with one link that many times as heavy, of the same shape."""
    scene = load_scene(FOURBAR)
    link = scene.links[name]
    mass, inertia = link.mass_kg * factor, link.inertia_kg_m2 * factor
    heavy = replace(link, mass_kg=mass, inertia_kg_m2=inertia)
    return Trial(replace(scene, links={**scene.links, name: heavy}))


def _block(factor: float) -> Trial:
    """The slider-crank with a block that many times as heavy as its rod."""
    scene = load_scene(SLIDER_CRANK)
    rod = scene.links["rod"].mass_kg
    sliders = {n: replace(s, mass_kg=rod * factor) for n, s in scene.sliders.items()}
    return Trial(replace(scene, sliders=sliders))


_case = partial(
    Case,
    truth="closed form: the masses do not matter to a driven mechanism",
    expected="holds, with more iterations if need be",
)
_ratio = partial(_case, parameter="mass ratio", values=RATIOS)
CASES = (
    _ratio(
        name="heavy-rocker",
        title="Heavy rocker behind a light coupler",
        source=FOURBAR,
        trial=lambda ratio: _link("rocker", ratio),
    ),
    _ratio(
        name="light-rocker",
        title="Light rocker behind a heavy coupler",
        source=FOURBAR,
        trial=lambda ratio: _link("rocker", 1.0 / ratio),
    ),
    _ratio(
        name="heavy-block",
        title="Heavy block behind a light rod",
        source=SLIDER_CRANK,
        trial=_block,
    ),
    _ratio(
        name="light-block",
        title="Light block behind a heavy rod",
        source=SLIDER_CRANK,
        trial=lambda ratio: _block(1.0 / ratio),
    ),
    _case(
        name="massless-coupler",
        title="Coupler with less and less mass, in the end none",
        source=FOURBAR,
        trial=lambda share: _link("coupler", share),
        parameter="mass of the coupler, over that of a slender rod",
        values=LIGHT,
    ),
)
