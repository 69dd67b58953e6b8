"""The scene file of a scene."""

from __future__ import annotations

import math

from models.laws import ConstantSpeed, Oscillating
from models.scene import Scene
from tests.worlds.scene_files import toml

Tree = dict[str, object]


def scene_text(scene: Scene) -> str:
    """TOML that reads as the scene, but for the rounding of angles in degrees.

    Raises
    ------
    TypeError
        A law that has no words here.
    """
    links: Tree = {
        name: {
            "points": {point: list(place) for point, place in link.points.items()},
            "mass_kg": link.mass_kg,
            "centre_m": list(link.centre_m),
            "inertia_kg_m2": link.inertia_kg_m2,
        }
        for name, link in scene.links.items()
    }
    sliders: Tree = {}
    for name, slider in scene.sliders.items():
        table: Tree = {
            "point": slider.point,
            "on": slider.on,
            "through_m": list(slider.through_m),
            "direction_deg": math.degrees(slider.direction_rad),
        }
        if slider.link is not None:
            table |= {"link": slider.link, "angle_deg": math.degrees(slider.angle_rad)}
        elif slider.mass_kg:
            table |= {"mass_kg": slider.mass_kg, "inertia_kg_m2": slider.inertia_kg_m2}
        sliders[name] = table
    tree: Tree = {
        "name": scene.name,
        "source": scene.source,
        "ground": {"points": {point: list(place) for point, place in scene.ground.items()}},
        "links": links,
        "sliders": sliders,
        "driver": {"link": scene.driver.link} | _law(scene),
        "branch": dict(scene.branch),
    }
    return toml(tree)


def _law(scene: Scene) -> Tree:
    law = scene.driver.law
    if isinstance(law, ConstantSpeed):
        return {"speed_rad_s": law.speed_rad_s, "start_deg": math.degrees(law.start_rad)}
    if isinstance(law, Oscillating):
        return {
            "law": "oscillating",
            "centre_deg": math.degrees(law.centre_rad),
            "amplitude_deg": math.degrees(law.amplitude_rad),
            "frequency_rad_s": law.frequency_rad_s,
            "phase_deg": math.degrees(law.phase_rad),
        }
    raise TypeError(f"{type(law).__name__}: only a constant speed or a swing is written")
