"""The thesis's pulse on a mechanism with an elastic coupler, and the control of its crank.

The pulse: rigid, in bending, along, both, by modes and by elements; how far each motion is from the
one by most shapes, and what its energy drifts by after the pulse. Control: how much of the ringing
of a straight start is left after each turn, over the periodic motion, for several gains. Prints two
tables; they take minutes.
"""

import sys

sys.path.pop(0)  # this folder, whose logging.py would hide the standard library's

import math
import time
from dataclasses import replace

import numpy as np

from analytic.elastic.control import control_elastic
from analytic.elastic.discretisation import Discretisation, Elements, Modes
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.released import release_elastic
from analytic.free.release import release
from models.array import Array
from models.files.reading import load_scene
from models.scene import Scene
from models.scene.driver import Controlled
from models.scene.elastic import Shape
from models.scene.laws import ConstantSpeed

PULSE, CONTROLLED = load_scene("fourbar-elastic-pulse"), load_scene("fourbar-elastic-controlled")
LINK = "coupler"
AXIAL_N = 200e9 * 0.01 * 0.0012
UNTIL_S, AFTER_S = 2.0, 1.0
TIME_S = np.linspace(0.0, UNTIL_S, 201)
BENDING = (Modes(5), Modes(3), Elements(3), Elements(2), Elements(1))
ALONG = (Modes(0, 3), Modes(0, 1), Elements(2), Elements(1))
BOTH = (Modes(5, 2), Modes(3, 1), Elements(2), Elements(1))
GAINS = ((10.0, 0.1), (10.0, 0.3), (3.0, 0.1), (3.0, 0.03), (10.0, 0.0))
TURNS = 4


def elastic(bends: bool, stretches: bool) -> Scene:
    """The pulse's scene with a coupler that bends, stretches, or both."""
    own = PULSE.elastic[LINK]
    flexural = own.flexural_n_m2 if bends else math.inf
    link = replace(own, flexural_n_m2=flexural, axial_n=AXIAL_N if stretches else math.inf)
    return replace(PULSE, elastic={LINK: link})


def pulses() -> None:
    """The first table."""
    rigid = replace(PULSE, elastic={}, start=replace(PULSE.start, shape=None))
    theta = release(rigid, UNTIL_S).at(TIME_S, bound=False).links["crank"].theta
    print(f"rigid: crank {theta[-1]:.6f} rad at {UNTIL_S:g} s")
    print("what      by                          w mm    u nm     off w um  off crank  drift    s")
    for what, scene, each in (
        ("bending", elastic(True, False), BENDING),
        ("axial", elastic(False, True), ALONG),
        ("both", elastic(True, True), BOTH),
    ):
        pulse(what, scene, each)


def pulse(what: str, scene: Scene, each: tuple[Discretisation, ...]) -> None:
    """One part of it, the motion by most shapes first."""
    best: tuple[Array, Array] | None = None
    for by in each:
        begun_s = time.perf_counter()
        free = release_elastic(scene, UNTIL_S, by)
        motion, energy = free.at(TIME_S), free.energy(TIME_S)
        took_s = time.perf_counter() - begun_s
        shape, crank = motion.elastic[LINK], motion.links["crank"].theta
        best = best or (shape.middle, crank)
        kept = (energy.kinetic + energy.potential)[AFTER_S < TIME_S]
        print(
            f"{what:9} {by!s:27} {1e3 * largest(shape.middle):6.4f} "
            f"{1e9 * largest(shape.extension):9.5g} {1e6 * largest(shape.middle - best[0]):8.2g} "
            f"{largest(crank - best[1]):9.2g} {np.ptp(kept) / energy.kinetic.max():9.1e} "
            f"{took_s:5.1f}"
        )


def controls() -> None:
    """The second table."""
    law = CONTROLLED.driver.law
    constant = ConstantSpeed(math.radians(90.0), law.peak_speed_rad_s)
    driven = replace(CONTROLLED, driver=replace(CONTROLLED.driver, law=constant))
    until_s = TURNS * law.period_s
    time_s = np.linspace(0.0, until_s, 50 * TURNS + 1)

    def bent(start: Shape) -> Array:
        by = DrivenElasticMotion(driven, until_s, Modes(1), start, stiffened=True)
        return by.at(time_s).elastic[LINK].middle

    periodic = bent("periodic")

    def left(middle: Array) -> str:
        turns = np.abs(middle - periodic)[:-1].reshape(TURNS, -1).max(axis=1)
        return "  ".join(f"{one:.4f}" for one in turns / largest(periodic))

    print(f"ringing left in turns 1 to {TURNS}, over the largest deflection")
    print(f"constant speed              {left(bent('straight'))}")
    for kp, kd in GAINS:
        own = Controlled(constant.start_rad, constant.speed_rad_s, kp, kd)
        scene = replace(CONTROLLED, driver=replace(CONTROLLED.driver, law=own))
        motion = control_elastic(scene, until_s, Modes(1)).at(time_s)
        gives = largest(motion.links["crank"].theta - constant.angle(time_s))
        print(
            f"kP {kp:4g} N m/rad, kD {kd:4g} N m s {left(motion.elastic[LINK].middle)}"
            f"   crank off by {gives:.1e} rad"
        )


def largest(series: Array) -> float:
    """The largest value of a series."""
    return float(np.abs(series).max())


if __name__ == "__main__":
    pulses()
    controls()
