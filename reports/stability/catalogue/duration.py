"""Many turns: errors that add up show as a growth per turn."""

from __future__ import annotations

from functools import partial

from models.files.reading import load_scene
from reports.stability.case import Case, Trial


def _turns(scene: str, turns: float) -> Trial:
    return Trial(load_scene(scene), steps_per_turn=90.0, turns=turns, every=9)


CASES = tuple(
    Case(
        name=name,
        title=f"Turn after turn, {scene}",
        source=scene,
        truth="closed form; every turn is as the first",
        expected="no growth with the turns",
        parameter="turns",
        values=(10.0, 100.0, 1e3, 1e4),
        trial=partial(_turns, scene),
        scale="whole",
    )
    for name, scene in (
        ("long-fourbar", "fourbar-lecture-1"),
        ("long-slider-crank", "slider-crank-offset"),
    )
)
