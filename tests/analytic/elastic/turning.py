"""Elastic scenes at other speeds, with other rockers and damping."""

from __future__ import annotations

from dataclasses import replace

from analytic.elastic.discretisation import Discretisation, Modes
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.natural import lowest_rad_s
from analytic.elastic.reduced import ReducedForm
from models.files import load_scene
from models.laws import ConstantSpeed
from models.scene import Scene

FEW = Modes(2, 1)


def fourbar(ratio: float = 10.5, rocker: float = 1.0, damping_s: float = 0.0) -> Scene:
    """The shipped four-bar with its first frequency so many times the crank's speed, a rocker so
    many times as heavy, and damping."""
    scene = load_scene("fourbar-elastic")
    law, own = scene.driver.law, scene.links["rocker"]
    assert isinstance(law, ConstantSpeed)
    heavy = replace(own, mass_kg=rocker * own.mass_kg, inertia_kg_m2=rocker * own.inertia_kg_m2)
    coupler = replace(scene.elastic["coupler"], damping_s=damping_s)
    return replace(
        scene,
        links={**scene.links, "rocker": heavy},
        elastic={"coupler": coupler},
        driver=replace(
            scene.driver, law=replace(law, speed_rad_s=lowest_rad_s(scene) / ratio, start_rad=1.0)
        ),
    )


def form_of(scene: Scene, by: Discretisation = FEW, *, stiffened: bool = True) -> ReducedForm:
    """Its equations of motion."""
    return DrivenElasticMotion(scene, 1.0, by, "periodic", stiffened).form
