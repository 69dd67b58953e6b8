"""Cells of whole turns."""

from dataclasses import replace
from typing import Any

from models.files.reading import load_scene
from models.scene import Scene
from reports.judge.cell import Cell


def of_turns(
    scene: Scene | str, engine: str = "mujoco", steps: int = 360, turns: int = 1, **other: Any
) -> Cell:
    """Turns of a scene, or of the shipped one of that name, of so many steps each, in an engine
    under profile tuned; at this step alone unless ``converge`` is asked for."""
    made = load_scene(scene) if isinstance(scene, str) else scene
    dt_s = made.driver.law.period_s / steps
    return replace(Cell(made, engine, "tuned", dt_s, turns * steps, converge=False), **other)
