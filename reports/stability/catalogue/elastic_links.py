"""Elastic links as chains of segments: cases in which an engine loses their deflection."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial

from models.files.reading import load_scene
from models.scene import Scene, laws, moved
from reports.stability.case import Case, Trial

BENT = "fourbar-elastic"
RATIO = 10.5
"""First frequency of the scene's coupler over the driver's speed."""
SEGMENTS, STEPS = 4, 1440.0
STEPS_OF_RATIO = 100.0
"""Steps a turn per unit of frequency ratio: twice the need of explicit steps for these segments."""


@cache
def _bent(ratio: float = RATIO, stiffness: float = 1.0, height: float = 1.0) -> Scene:
    """Return the four-bar at the speed of a frequency ratio, its coupler so much stiffer, or
    higher: stiffness goes with the height's third power, mass with the height. The same object for
    the same numbers, as its reference is kept under it."""
    scene = load_scene(BENT)
    name, own = next(iter(scene.elastic.items()))
    stiff = replace(own, flexural_n_m2=own.flexural_n_m2 * stiffness * height**3)
    law = scene.driver.law
    assert isinstance(law, laws.ConstantSpeed)
    slow = replace(law, speed_rad_s=law.speed_rad_s * RATIO / ratio)
    driver = replace(scene.driver, law=slow)
    return replace(moved.of_mass(scene, name, height), elastic={name: stiff}, driver=driver)


def _run(scene: Scene, steps: float = STEPS, segments: int = SEGMENTS) -> Trial:
    return Trial(
        scene, steps_per_turn=steps, turns=1.0, every=max(round(steps / 720), 1), segments=segments
    )


def _slender(height_over_length: float) -> Trial:
    """Return the four-bar at the same speed, with steps for its greater stiffness."""
    height = height_over_length * 0.75 / 0.003
    return _run(_bent(height=height), STEPS_OF_RATIO * max(RATIO * height, RATIO))


_case: Callable[..., Case] = partial(Case, judge="bend", source=BENT)
CASES = (
    _case(
        name="elastic-thick",
        title="Elastic link so thick that it hardly bends",
        truth="the exact chain of 4 segments; the deflection falls as the height squared",
        expected="holds until a joint's error is as large as the deflection",
        parameter="height over length",
        values=(0.004, 0.006, 0.01, 0.02, 0.04),
        trial=_slender,
    ),
    _case(
        name="elastic-resonance",
        title="Speed beside a critical one",
        truth="the exact chain of 4 segments, ten turns; a frequency ratio of 5 resonates",
        expected="a step's error of the frequency counts more and more over ten turns",
        parameter="frequency ratio over 5",
        values=(0.5, 0.2, 0.1, 0.05, 0.02),
        trial=lambda over: replace(_run(_bent(5.0 + over)), turns=10.0, every=4),
    ),
    _case(
        name="elastic-soft",
        title="Speed near the first frequency",
        truth="the exact chain of 4 segments, on its periodic motion",
        expected="holds while there is one: large deflections are not harder",
        parameter="frequency ratio",
        values=(20.5, 10.5, 5.5, 3.5, 2.5),
        trial=lambda ratio: _run(_bent(ratio), 2.0 * STEPS),
    ),
    _case(
        name="elastic-stiff",
        title="Links too stiff for the step",
        truth="the exact chain of 4 segments",
        expected="holds while the step is short for the fastest frequency, and reports it beyond",
        parameter="stiffness over that of the scene",
        values=(1.05, 3.0, 9.0, 30.0, 100.0, 300.0),
        trial=lambda more: _run(_bent(stiffness=more)),
    ),
    _case(
        name="elastic-segments",
        title="Too many segments for the step",
        truth="the exact chain of as many segments",
        expected="holds while the step is short for the fastest frequency, which grows as n^2",
        parameter="segments",
        values=(2.0, 4.0, 8.0, 12.0),
        trial=lambda count: _run(_bent(), STEPS, int(count)),
        scale="whole",
    ),
    _case(
        name="elastic-step",
        title="Step too large for a chain",
        truth="the exact chain of 4 segments",
        expected="errors that grow with the step squared, up to the limit of explicit steps",
        parameter="steps in a turn",
        values=(2880.0, 1440.0, 720.0, 360.0, 240.0, 120.0, 60.0),
        trial=lambda steps: _run(_bent(), steps),
    ),
)
