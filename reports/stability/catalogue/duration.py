"""Many turns: errors that add up show as a growth per turn."""

from __future__ import annotations

from models.files import load_scene
from reports.stability.case import Case, Trial

GROUP = "duration"
SCENES = {"long-fourbar": "fourbar-lecture-1", "long-slider-crank": "slider-crank-offset"}
STEPS_PER_TURN = 90.0
EVERY = 9


def _case(name: str, scene: str) -> Case:
    def trial(value: float) -> Trial:
        return Trial(load_scene(scene), steps_per_turn=STEPS_PER_TURN, turns=value, every=EVERY)

    return Case(
        name=name,
        group=GROUP,
        title=f"Turn after turn, {scene}",
        source=scene,
        truth="closed form; every turn is as the first",
        expected="no growth with the turns",
        parameter="turns",
        unit="",
        values=(10.0, 100.0, 1e3, 1e4),
        trial=trial,
        scale="whole",
    )


CASES = tuple(_case(name, scene) for name, scene in SCENES.items())
