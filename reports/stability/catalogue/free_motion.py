"""Mechanisms in free motion, and four-bars that are thrown at their toggle."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache, partial

import numpy as np

from analytic.forces.force_elements import spring_lengths
from analytic.free.exact_motions import ToggleBarrier
from analytic.free.machine import Machine
from analytic.mechanism.fourbar import FourBar
from models.files.reading import load_scene
from models.scene import Scene, driver, loads, moved
from models.scene.hard import fourbar
from reports.stability.case import Case, Throw, Trial

SWING, SLIDER_CRANK = "fourbar-swing", "slider-crank-spring"
DT_S = 1e-3
SWING_S = 1.0
"""More than a swing of a four-bar with a crank of a tenth of a metre."""
SLACK_RAD, PULLED_RAD = 1.0, 0.05
"""Angle of the crank at which the spring is slack, and distance of its release: so small that two
steps in a period of the spring are not refused as too few for the crank."""
PERIODS = 10
LONG_DT_S, LONG_TURN_S, FOLLOWED_S = 5e-3, 10.0, 20.0
"""Long runs: step, interval for the growth of errors, and time for which the phase is followed; a
thousand seconds of the reference would cost minutes."""
DOWN = (0.0, -9.81)
FREE_RATIOS = (1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6)


def from_rest(scene: Scene, start_rad: float, lasts_s: float, dt_s: float = DT_S) -> Trial:
    """Return a trial of a scene that is released from rest at a driver angle."""
    law = driver.Released(start_rad, 0.0, lasts_s)
    free = replace(scene, driver=replace(scene.driver, law=law))
    return Trial(free, steps_per_turn=lasts_s / dt_s, turns=1.0, drive="free")


def _swing(scene: Scene, dt_s: float = DT_S) -> Trial:
    return from_rest(scene, 0.0, SWING_S, dt_s)


def _heavier(name: str, ratio: float) -> Trial:
    return _swing(moved.of_mass(load_scene(SWING), name, ratio))


def _stiff(steps: float) -> Trial:
    """Return a slider-crank with a spring from block to ground, of so many steps in a period."""
    scene = load_scene(SLIDER_CRANK)
    machine, slack = Machine(scene), np.array([SLACK_RAD])
    ((_, q, rate),) = spring_lengths(scene, machine.chart.unit(slack))
    inertia = float(machine.inertia(slack)[0][0])
    stiffness = inertia * (math.tau / (steps * DT_S * float(rate[0]))) ** 2
    spring = loads.SlideSpring("back", stiffness, 0.0, float(q[0]), "C")
    sprung = replace(scene, springs={"back": spring})
    return from_rest(sprung, SLACK_RAD + PULLED_RAD, PERIODS * steps * DT_S)


def _beside_flat(off_rad: float) -> Trial:
    """Return a parallelogram released so far from one flat position, and swinging to the other."""
    flat = fourbar("parallelogram-let-go", 0.1, 0.3, 0.1, 0.3, source="Grashof's limiting case")
    # Below its flat position C lies to the right of the line from B to D.
    return from_rest(replace(flat, gravity_m_s2=DOWN, branch={"C": -1}), -off_rad, SWING_S)


def _long(lasts_s: float) -> Trial:
    """Return the lecture's four-bar, ten times as large, swinging about its lowest position."""
    large = fourbar("fourbar-long-swing", 1.0, 2.5, 2.0, 3.0, source=SWING)
    trial = from_rest(replace(large, gravity_m_s2=DOWN), -0.7, LONG_TURN_S, LONG_DT_S)
    return replace(trial, turns=lasts_s / LONG_TURN_S, every=20, followed_s=FOLLOWED_S)


_case: Callable[..., Case] = partial(Case, judge="free-motion")
FREE_MOTION = (
    _case(
        name="free-coarse-step",
        title="Step too large, in free motion",
        source=SWING,
        truth="the equation of the machine, integrated to rounding",
        expected="errors that grow with the step squared, and no blow-up",
        parameter="dt",
        unit="s",
        values=(1e-3, 2e-3, 5e-3, 1e-2, 2e-2, 5e-2),
        trial=lambda dt_s: _swing(load_scene(SWING), dt_s),
    ),
    _case(
        name="free-stiff-spring",
        title="Stiff spring on a slider",
        source=SLIDER_CRANK,
        truth="the equation of the machine; twenty periods of the spring",
        expected="holds down to a few steps in a period, and does not blow up below",
        parameter="steps in a period",
        values=(200.0, 100.0, 50.0, 20.0, 10.0, 5.0, 3.0, 2.0),
        trial=_stiff,
    ),
    _case(
        name="free-heavy-rocker",
        title="Heavy rocker that whirls a light crank",
        source=SWING,
        truth="the equation of the machine; while the rocker stands still, only light links move",
        expected="holds while a step is short for the crank, which is faster by the ratio's root",
        parameter="mass ratio",
        values=FREE_RATIOS,
        trial=partial(_heavier, "rocker"),
    ),
    _case(
        name="free-heavy-coupler",
        title="Heavy coupler between light links, in free motion",
        source=SWING,
        truth="the equation of the machine: its reduced mass becomes that of the coupler",
        expected="holds, with more iterations if need be",
        parameter="mass ratio",
        values=FREE_RATIOS,
        trial=partial(_heavier, "coupler"),
    ),
    _case(
        name="free-change-point",
        title="Parallelogram released beside its flat position",
        source="Grashof's rule; nothing carries it through, as it has no speed there",
        truth="the coupler keeps its direction; a pendulum",
        expected="stays a parallelogram while it falls, and turns back beside the other one",
        parameter="crank off the flat position",
        unit="rad",
        values=(0.3, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6),
        trial=_beside_flat,
    ),
    _case(
        name="free-long",
        title="A four-bar that swings for a long time",
        source=SWING,
        truth="the equation of the machine for 20 s; then geometry and energy alone",
        expected="keeps its energy, and its joints",
        parameter="duration",
        unit="s",
        values=(10.0, 30.0, 100.0, 300.0, 1000.0),
        trial=_long,
        scale="whole",
    ),
)


LENGTHS_M = (0.2, 0.25, 0.3, 0.5)
BEFORE_RAD = 0.3


@lru_cache(maxsize=1)
def _barrier() -> ToggleBarrier:
    limit = FourBar(*LENGTHS_M).driver_range_rad[1]
    return ToggleBarrier.of(
        fourbar(
            "triple-rocker-thrown",
            *LENGTHS_M,
            source="gravity points to where the toggle is the highest place",
            start_deg=math.degrees(limit - BEFORE_RAD),
        )
    )


def _thrown(side: float, margin: float) -> Trial:
    throw = Throw(_barrier(), side * margin)
    scene = throw.barrier.thrown(throw.margin)
    steps = scene.driver.law.period_s / DT_S
    return Trial(scene, steps_per_turn=steps, turns=1.0, drive="free", throw=throw)


TOGGLES = tuple(
    Case(
        name=f"toggle-{name}",
        title=f"Thrown at the toggle with {words}",
        source="limit position on top of a hill of the potential energy",
        truth=f"by its energy it {truth}",
        expected="as its energy requires",
        parameter="energy above that of the top, over the height of the hill",
        values=(1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6),
        trial=partial(_thrown, side),
        judge="toggle",
    )
    for name, words, truth, side in (
        ("over", "just enough energy", "gets over into the other assembly", 1.0),
        ("short", "too little energy", "falls back before the toggle", -1.0),
    )
)
