"""Steps that are too large or very small, and solvers with too little to spend."""

from __future__ import annotations

from models.files import load_scene
from reports.stability.case import Case, Trial

GROUP = "step and solver"
SOURCE = "fourbar-lecture-1"
SHAPER = "shaper"


def _coarse(value: float) -> Trial:
    return Trial(load_scene(SOURCE), steps_per_turn=value)


def _tiny(value: float) -> Trial:
    scene = load_scene(SOURCE)
    steps = scene.driver.law.period_s / value
    return Trial(scene, steps_per_turn=steps, turns=1.0, every=max(round(steps / 720), 1))


def _iterations(value: float) -> Trial:
    return Trial(load_scene(SHAPER), settings={"iterations": int(value)})


def _single_precision(_: float) -> Trial:
    return Trial(load_scene(SOURCE), settings={"precision": "float32"})


CASES = (
    Case(
        name="coarse-step",
        group=GROUP,
        title="Step too large",
        source=SOURCE,
        truth="closed form",
        expected="errors that grow with the step squared, and no blow-up",
        parameter="steps in a turn",
        unit="",
        values=(360.0, 180.0, 90.0, 45.0, 20.0, 10.0, 8.0),
        trial=_coarse,
    ),
    Case(
        name="tiny-step",
        group=GROUP,
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
        group=GROUP,
        title="Few iterations of the solver",
        source=SHAPER,
        truth="closed form of a six-bar with a heavy ram",
        expected="says so, or stays closed",
        parameter="iterations",
        unit="",
        values=(100.0, 50.0, 20.0, 10.0, 5.0, 2.0, 1.0),
        trial=_iterations,
        scale="whole",
    ),
    Case(
        name="single-precision",
        group=GROUP,
        title="Arithmetic in single precision",
        source=SOURCE,
        truth="closed form",
        expected="holds the class, where the engine has it; neither of these two has",
        parameter="precision",
        unit="bit",
        values=(32.0,),
        trial=_single_precision,
    ),
)
