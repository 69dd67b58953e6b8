"""Steps that are too large or very small, and solvers with too little to spend."""

from __future__ import annotations

from models.files.reading import load_scene
from reports.stability.case import Case, Trial

SOURCE = "fourbar-lecture-1"
SHAPER = "shaper"


def _tiny(dt_s: float) -> Trial:
    scene = load_scene(SOURCE)
    steps = scene.driver.law.period_s / dt_s
    return Trial(scene, steps_per_turn=steps, turns=1.0, every=max(round(steps / 720), 1))


CASES = (
    Case(
        name="coarse-step",
        title="Step too large",
        source=SOURCE,
        truth="closed form",
        expected="errors that grow with the step squared, and no blow-up",
        parameter="steps in a turn",
        values=(360.0, 180.0, 90.0, 45.0, 20.0, 10.0, 8.0),
        trial=lambda steps: Trial(load_scene(SOURCE), steps_per_turn=steps),
    ),
    Case(
        name="tiny-step",
        title="Step very small",
        source=SOURCE,
        truth="closed form; one turn, so up to 600 000 steps",
        expected="rounding does not add up",
        parameter="dt",
        unit="s",
        values=(1e-3, 1e-4, 1e-5, 1e-6),
        trial=_tiny,
    ),
    Case(
        name="few-iterations",
        title="Few iterations of the solver",
        source=SHAPER,
        truth="closed form of a six-bar with a heavy ram",
        expected="says so, or stays closed",
        parameter="iterations",
        values=(100.0, 50.0, 20.0, 10.0, 5.0, 2.0, 1.0),
        trial=lambda number: Trial(load_scene(SHAPER), settings={"iterations": int(number)}),
        scale="whole",
    ),
    Case(
        name="single-precision",
        title="Arithmetic in single precision",
        source=SOURCE,
        truth="closed form",
        expected="holds the class, where the engine has it; neither of these two has",
        parameter="precision",
        unit="bit",
        values=(32.0,),
        trial=lambda _: Trial(load_scene(SOURCE), settings={"precision": "float32"}),
    ),
)
