"""Drivers that are told to pass a limit position, and drivers that swing ever nearer to one.

The driver comes to rest before the end and goes back: so do the links, after a turn that is the
sharper the nearer it is. What does not follow it goes straight on, into the other assembly.
"""

import math
from functools import partial

from analytic.mechanism.fourbar import FourBar
from models.scene.hard import (
    fourbar,
    fourbar_by_coupler,
    slider_crank_by_piston,
    swinging_triad_platform,
)
from reports.stability.case import Case, Trial

BEFORE_RAD = 0.5
"""How far before the limit the crank starts, and how far beyond it its command ends."""
DT_S = 1e-4
SAMPLES = 1000


def _towards(name: str, lengths: tuple[float, float, float, float], speed: float) -> Trial:
    """A crank that is told to pass its far limit by as much as it starts before it."""
    limit = FourBar(*lengths).driver_range_rad[1]
    start = math.degrees(limit - BEFORE_RAD)
    source = f"{name}, driven by a servo towards the end of its range"
    scene = fourbar(name, *lengths, source=source, start_deg=start, speed_rad_s=speed)
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
"""How far the drivers swing to each side of their middle."""
TRIAD_CRANK_M = 0.1
TRIAD_END_DEG = 181.22449433474
"""The upper end of that crank, at which two assemblies meet, by `analytic.kinematics.reach`."""
CRANK_M, ROD_M = 0.1, 0.3
FOURBAR_M = (0.2, 0.25, 0.3, 0.5)


def _triad(off_deg: float) -> Trial:
    return Trial(
        swinging_triad_platform(
            "triad-near-limit",
            TRIAD_CRANK_M,
            source="scene triad-platform with a crank that does not turn fully",
            centre_deg=TRIAD_END_DEG - off_deg - SWING_DEG,
            amplitude_deg=SWING_DEG,
        )
    )


def _piston(left_percent: float) -> Trial:
    return Trial(
        slider_crank_by_piston(
            "piston-near-limit",
            CRANK_M,
            ROD_M,
            source="scene slider-crank-by-piston with a stroke that runs to 2 R",
            amplitude_m=CRANK_M * (1.0 - 0.01 * left_percent),
        )
    )


def coupler_end_deg() -> float:
    """The largest angle from the crank to the coupler [deg], with A, C and D in line: AC is AD less
    DC then, and the angle is that of the triangle A B C at B, from 180 deg."""
    crank, coupler, rocker, ground = FOURBAR_M
    cosine = (crank**2 + coupler**2 - (ground - rocker) ** 2) / (2.0 * crank * coupler)
    return 180.0 - math.degrees(math.acos(cosine))


def _coupler(off_deg: float) -> Trial:
    return Trial(
        fourbar_by_coupler(
            "coupler-near-limit",
            *FOURBAR_M,
            source="triple-rocker, driven at the pin of crank and coupler",
            centre_deg=coupler_end_deg() - off_deg - SWING_DEG,
            amplitude_deg=SWING_DEG,
        )
    )


_near = partial(
    Case, expected="turns round with its driver, and does not run on into the other assembly"
)
_off = partial(
    _near, parameter="distance from the limit", unit="deg", values=(10.0, 1.0, 0.1, 0.01)
)
NEAR_LIMITS = (
    _off(
        name="triad-near-limit",
        title="Class III group, its crank ever nearer to a limit position",
        source="triad-platform with a crank of 0.1 m, which cannot turn fully",
        truth="one assembly of six at most, followed with certainty; its last place with the crank",
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
