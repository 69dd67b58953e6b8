"""How the crank is driven, for how long, and in which steps."""

import math
from dataclasses import replace
from functools import partial

from models.files.reading import load_scene
from models.scene import Scene
from models.scene.laws import ConstantSpeed, Law, SpeedChange
from reports.stability.case import Case, Trial

SOURCE = "fourbar-lecture-1"
SAME_DT_S = 1e-4
START_RAD = 1.6
SPEED_RAD_S = 10.0
CHANGE_TURNS = 0.77
"""Where the speed changes; no sample falls on it."""


def _driven(law: Law) -> Scene:
    scene = load_scene(SOURCE)
    return replace(scene, driver=replace(scene.driver, law=law))


def _same_dt(speed_rad_s: float) -> Trial:
    law = ConstantSpeed(START_RAD, speed_rad_s)
    return Trial(_driven(law), steps_per_turn=law.period_s / SAME_DT_S, turns=1.0)


def _changed(before: float, after: float, rise_turns: float) -> Trial:
    """A change of speed after most of a turn, its ramp in turns of the first speed."""
    period = math.tau / SPEED_RAD_S
    at, rise = CHANGE_TURNS * period, rise_turns * period
    law = SpeedChange(START_RAD, before, after, at, rise)
    turns = (CHANGE_TURNS + rise_turns) * period / law.period_s + 1.0
    return Trial(_driven(law), turns=turns)


_case = partial(Case, source=SOURCE)
_faster = partial(
    _case, parameter="crank speed", unit="rad/s", values=(1.0, 10.0, 100.0, 300.0, 1000.0, 3000.0)
)
_ramp = partial(
    _case,
    expected="follows, also through a ramp of a few steps",
    parameter="length of the ramp",
    unit="turn",
)
DRIVING = (
    _faster(
        name="speed-same-dt",
        title=f"Faster and faster at the same dt of {SAME_DT_S:g} s",
        truth="closed form; errors grow with the turn in a step, squared",
        expected="errors as those of fewer steps in a turn",
        trial=_same_dt,
    ),
    _faster(
        name="speed-same-steps",
        title="Faster and faster at 360 steps in a turn",
        truth="closed form; as a pure number nothing changes",
        expected="the same error at every speed",
        trial=lambda speed_rad_s: Trial(_driven(ConstantSpeed(START_RAD, speed_rad_s))),
    ),
    _ramp(
        name="reversal",
        title="Direction reversed in mid-run",
        truth="closed form with a cycloidal ramp from +10 to -10 rad/s",
        values=(0.5, 0.1, 0.03, 0.01, 3e-3, 1e-3, 1e-4),
        trial=lambda rise_turns: _changed(SPEED_RAD_S, -SPEED_RAD_S, rise_turns),
    ),
    _ramp(
        name="from-rest",
        title="Start from rest by a smooth law",
        truth="closed form with a cycloidal ramp from 0 to 10 rad/s",
        values=(1.0, 0.3, 0.1, 0.03, 0.01, 1e-3),
        trial=lambda rise_turns: _changed(0.0, SPEED_RAD_S, rise_turns),
    ),
    _case(
        name="speed-jump",
        title="The speed jumps",
        truth="closed form; the angle of the crank has a corner",
        expected="follows: a prescribed crank takes any push",
        parameter="speed after over speed before",
        values=(1.1, 2.0, 5.0, 10.0, 30.0, 100.0),
        trial=lambda ratio: _changed(SPEED_RAD_S, ratio * SPEED_RAD_S, 0.0),
    ),
)


def _turns(scene: str, turns: float) -> Trial:
    return Trial(load_scene(scene), steps_per_turn=90.0, turns=turns, every=9)


DURATION = tuple(
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


SHAPER = "shaper"


def _tiny(dt_s: float) -> Trial:
    scene = load_scene(SOURCE)
    steps = scene.driver.law.period_s / dt_s
    return Trial(scene, steps_per_turn=steps, turns=1.0, every=max(round(steps / 720), 1))


STEPPING = (
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
