"""Cases of the drive of the crank: its law, its duration, and its steps.

The driver comes to rest before the end and goes back: so do the links, after a turn that is the
sharper the nearer it is. A link that does not follow goes straight on, into the other assembly.
"""

import math
from dataclasses import replace
from functools import partial

from analytic.mechanism.fourbar import FourBar
from models.files.reading import load_scene
from models.scene import Scene, hard
from models.scene.laws import ConstantSpeed, Law, SpeedChange
from reports.stability.case import Case, Trial

SOURCE = "fourbar-lecture-1"
SAME_DT_S = 1e-4
START_RAD = 1.6
SPEED_RAD_S = 10.0
CHANGE_TURNS = 0.77
"""Turns after which the speed changes; no sample falls on it."""


def _driven(law: Law) -> Scene:
    scene = load_scene(SOURCE)
    return replace(scene, driver=replace(scene.driver, law=law))


def _same_dt(speed_rad_s: float) -> Trial:
    law = ConstantSpeed(START_RAD, speed_rad_s)
    return Trial(_driven(law), steps_per_turn=law.period_s / SAME_DT_S, turns=1.0)


def _changed(before: float, after: float, rise_turns: float) -> Trial:
    """Return a change of speed after most of a turn, its ramp in turns of the first speed."""
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
        expected="the same errors as with fewer steps in a turn",
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
        expected="follows: a prescribed crank withstands any impulse",
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
        truth="closed form; every turn is like the first",
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
        expected="reports it, or stays closed",
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
        expected="holds the class, if the engine has it; neither of these two has",
        parameter="precision",
        unit="bit",
        values=(32.0,),
        trial=lambda _: Trial(load_scene(SOURCE), settings={"precision": "float32"}),
    ),
)


BEFORE_RAD = 0.5
"""Distance of the crank's start before the limit, and of its command's end beyond it."""
DT_S = 1e-4
SAMPLES = 1000


def _towards(name: str, lengths: tuple[float, float, float, float], speed: float) -> Trial:
    """Return a crank commanded to pass its far limit by as much as it starts before it."""
    limit = FourBar(*lengths).driver_range_rad[1]
    start = math.degrees(limit - BEFORE_RAD)
    source = f"{name}, driven by a servo towards the end of its range"
    scene = hard.fourbar(name, *lengths, source=source, start_deg=start, speed_rad_s=speed)
    steps = scene.driver.law.period_s / DT_S
    turns = 2.0 * BEFORE_RAD / math.tau
    return Trial(
        scene,
        steps_per_turn=steps,
        turns=turns,
        every=max(round(turns * steps / SAMPLES), 1),
        drive="servo",
        limit_rad=limit,
    )


AT_LIMITS = tuple(
    Case(
        name=f"{name}-limit",
        title=f"{name.capitalize()} against its limit",
        source="limit positions from the triangle of the links in line",
        truth="the driver angle at which coupler and rocker are in line",
        expected="locked: the crank stands at the limit, the pins stay closed, nothing explodes",
        parameter="speed towards the limit",
        unit="rad/s",
        values=(0.1, 1.0, 10.0, 100.0),
        trial=partial(_towards, name, lengths_m),
        good=("locked",),
        judge="limit",
        within=2e-2,
    )
    for name, lengths_m in (
        ("triple-rocker", (0.2, 0.25, 0.3, 0.5)),
        ("double-rocker", (0.25, 0.1, 0.2, 0.3)),
    )
)


SWING_DEG = 30.0
"""Swing of the drivers to each side of their middle."""
TRIAD_CRANK_M = 0.1
TRIAD_END_DEG = 181.22449433474
"""Upper end of that crank, at which two assemblies meet, by `analytic.kinematics.reach`."""
CRANK_M, ROD_M = 0.1, 0.3
FOURBAR_M = (0.2, 0.25, 0.3, 0.5)


def _triad(off_deg: float) -> Trial:
    return Trial(
        hard.swinging_triad_platform(
            "triad-near-limit",
            TRIAD_CRANK_M,
            source="scene triad-platform with a crank that does not turn fully",
            centre_deg=TRIAD_END_DEG - off_deg - SWING_DEG,
            amplitude_deg=SWING_DEG,
        )
    )


def _piston(left_percent: float) -> Trial:
    return Trial(
        hard.slider_crank_by_piston(
            "piston-near-limit",
            CRANK_M,
            ROD_M,
            source="scene slider-crank-by-piston with a stroke that runs to 2 R",
            amplitude_m=CRANK_M * (1.0 - 0.01 * left_percent),
        )
    )


def coupler_end_deg() -> float:
    """Return the largest angle from the crank to the coupler [deg], with A, C and D in line: AC is
    AD less DC then, and the angle is 180 deg less the angle at B in the triangle A B C."""
    crank, coupler, rocker, ground = FOURBAR_M
    cosine = (crank**2 + coupler**2 - (ground - rocker) ** 2) / (2.0 * crank * coupler)
    return 180.0 - math.degrees(math.acos(cosine))


def _coupler(off_deg: float) -> Trial:
    return Trial(
        hard.fourbar_by_coupler(
            "coupler-near-limit",
            *FOURBAR_M,
            source="triple-rocker, driven at the pin of crank and coupler",
            centre_deg=coupler_end_deg() - off_deg - SWING_DEG,
            amplitude_deg=SWING_DEG,
        )
    )


_near = partial(
    Case, expected="turns back with its driver, and does not pass into the other assembly"
)
_off = partial(
    _near, parameter="distance from the limit", unit="deg", values=(10.0, 1.0, 0.1, 0.01)
)
NEAR_LIMITS = (
    _off(
        name="triad-near-limit",
        title="Class III group, its crank ever nearer to a limit position",
        source="triad-platform with a crank of 0.1 m, which cannot turn fully",
        truth="one assembly of at most six, followed with certainty; its last place with the crank",
        trial=_triad,
    ),
    _near(
        name="piston-near-limit",
        title="Slider-crank driven by its piston, ever nearer to both dead points",
        source="slider-crank-by-piston, with a stroke that runs to twice the crank",
        truth="closed form; at the ends of the stroke the crank could go either way",
        parameter="part of the stroke that is left out",
        unit="%",
        values=(5.0, 1.0, 0.1, 0.01),
        trial=_piston,
    ),
    _off(
        name="coupler-near-limit",
        title="Four-bar driven at the pin of crank and coupler, ever nearer to a limit position",
        source="limit position from the triangle of the links in line",
        truth="two assemblies; at the limit A, C and D are in line, and C could go to either side",
        trial=_coupler,
    ),
)
