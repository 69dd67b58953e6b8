"""Vibration over the inertia of a link and the speed of the driver: the map of the thesis.

What a coupler moves sets how hard it is pulled and pushed in a turn, and so its stiffness: with a
heavy rocker the turning feeds the vibration itself. Source: Thesis on vibration of planar
mechanisms with elastic links (2018), chapter 4.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from analytic.elastic.discretisation import Modes
from analytic.lectures.vibration.over_speeds import OverSpeeds, over_speeds
from models.array import Array
from models.errors import CrankcheckError, cut
from models.scene import Scene


@dataclass(frozen=True)
class InertiaMap:
    """The vibration with a ``link`` that is ``factors`` (F,) times as heavy, over speeds each."""

    link: str
    factors: Array
    over: tuple[OverSpeeds, ...]

    @property
    def scene(self) -> Scene:
        """As it is heaviest."""
        return self.over[-1].scene

    @property
    def speeds(self) -> Array:
        return self.over[0].speeds

    @property
    def shares(self) -> Array:
        """The largest deflection over the length, (F, S)."""
        return np.array([[point.share for point in one.points] for one in self.over])

    @property
    def multipliers(self) -> Array:
        """The largest multiplier's size, (F, S)."""
        return np.array([[point.stability.largest for point in one.points] for one in self.over])


def with_inertia(scene: Scene, body: str, factor: float) -> Scene:
    """The scene with a rigid link, or the block of a slider, so many times as heavy.

    Raises
    ------
    CrankcheckError
        No such body; one that is elastic, or the driver, or without mass.
    """
    links = {
        name: own
        for name, own in scene.links.items()
        if name not in scene.elastic and name != scene.driver.link and own.mass_kg
    }
    blocks = {name: own for name, own in scene.sliders.items() if own.mass_kg and name not in links}
    if body in links:
        own = links[body]
        heavy = replace(own, mass_kg=factor * own.mass_kg, inertia_kg_m2=factor * own.inertia_kg_m2)
        return replace(scene, links={**scene.links, body: heavy})
    if body in blocks:
        block = blocks[body]
        mass, inertia = factor * block.mass_kg, factor * block.inertia_kg_m2
        heavier = replace(block, mass_kg=mass, inertia_kg_m2=inertia)
        return replace(scene, sliders={**scene.sliders, body: heavier})
    use = ", ".join((*links, *blocks)) or "a scene with a rigid link of mass beside the driver"
    why = _unchanged(scene, body)
    raise CrankcheckError(f"{scene.name}: inertia of {cut(body)}: {why}; use {use}")


def _unchanged(scene: Scene, body: str) -> str:
    """Why the inertia of a body is not to be changed."""
    if body in scene.elastic:
        return "it is elastic, and its own mass is that of the beam"
    if body == scene.driver.link:
        return "its speed is told, whatever its inertia"
    if body in scene.links or body in scene.sliders:
        return "it has no mass"
    return "no link or slider of that name"


def over_inertia(scene: Scene, by: Modes, speeds: Array, link: str, factors: Array) -> InertiaMap:
    """The vibration with a link so many times as heavy, for each factor at all speeds. Raises
    CrankcheckError as `with_inertia` and `over_speeds`."""
    heavier = [with_inertia(scene, link, float(factor)) for factor in factors]
    return InertiaMap(link, factors, tuple(over_speeds(each, by, speeds) for each in heavier))
