"""Where the theories of elastic links part, over the frequency ratio of the shipped four-bar.

`python benchmarks/elastic_theories.py [RATIO ...]` prints, for each on its own periodic motion,
what the deflection of the coupler's middle is off that of the unlinearised beam, over its largest:

    linear       about the rigid motion, without the stiffness that pull gives (the thesis)
    stiffened    the same with it
    chain n      n rigid segments with springs between them, exactly solved: what engines are given
    corrected n  the same with springs that give the chain the sag of the beam
    beam n       n elements of exudyn's own beam, at 2880 steps a turn over the last of two turns
    slopes       the square of the largest slope of a half-wave that deep: what small slopes leave
                 out is 0.7 to 0.9 of it

Whole ratios resonate. About two minutes.
"""

import math
import sys
import time
from pathlib import Path

import numpy as np

if __name__ == "__main__":  # run as a file: the packages are beside this folder
    sys.path[0] = str(Path(__file__).resolve().parents[1])

from analytic.elastic.discretisation import Discretisation, Modes, Segments
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.engine_start import node_start
from analytic.elastic.natural import lowest_rad_s
from analytic.elastic.periodic import (
    FIRST,
    PeriodicMotion,
    instants,
    linear_motion,
    linearise,
    periodic_motion,
)
from analytic.elastic.reduced import ReducedForm
from analytic.lectures.vibration.steady_vibration import at_speed
from models.array import Array
from models.files.reading import load_scene
from models.scene import Scene
from models.scene.cut_scenes import BeamedScene
from sim.run import run

RATIOS = (3.5, 5.5, 8.5, 10.5, 14.5, 20.5)
INSTANTS = 129
SEGMENTS, ELEMENTS, STEPS = (4, 8, 16), (2, 4, 8), 2880


def form_of(scene: Scene, by: Discretisation, *, stiffened: bool = True) -> ReducedForm:
    """The equations of motion."""
    return DrivenElasticMotion(scene, 1.0, by, "periodic", stiffened).form


def middle(form: ReducedForm, motion: PeriodicMotion, times: Array | None = None) -> Array:
    """The deflection of the middle of the one elastic link at times [s], over a period [m]."""
    times = instants(INSTANTS, form.period_s) if times is None else times
    z, rates, _ = motion.at(times)
    ((body, own),) = form.assembly.elastic.values()
    q = form.at(times, z, rates, form.near(times)).now.q[:, own]
    return body.deflections(q, np.array([0.5 * body.length_m]))[:, 0]


def of_engine(scene: Scene, count: int, form: ReducedForm, motion: PeriodicMotion) -> float:
    """What exudyn's beam is off the theory by in the second of two turns [m]."""
    own = BeamedScene(scene, count)
    state, dt_s = node_start(own, "periodic"), form.period_s / STEPS
    done = run(own.given, state, "exudyn", dt_s=dt_s, steps=2 * STEPS, every=8)
    assert done.status == "ok", done.reason
    assert done.motion is not None
    bent = own.folded(done.motion)
    (shape,) = bent.elastic.values()
    times = bent.time_s[len(bent.time_s) // 2 :]
    exact = middle(form, motion, times)
    return float(np.abs(shape.middle[-len(times) :] - exact).max())


def linear(form: ReducedForm) -> PeriodicMotion:
    """The periodic motion of the equations linearised about the rigid motion."""
    scale = FIRST * form.assembly.scene.longest_m
    return linear_motion(form, linearise(form, instants(65, form.period_s), scale))


def row(
    scene: Scene,
    ratio: float,
    segments: tuple[int, ...] = SEGMENTS,
    elements: tuple[int, ...] = ELEMENTS,
) -> dict[str, float]:
    """What the theories are off at a frequency ratio, as shares; and the deflection over the
    length."""
    at = at_speed(scene, lowest_rad_s(scene) / ratio)
    beam = form_of(at, Modes(7, 0))
    theory = periodic_motion(beam)
    exact = middle(beam, theory)
    largest = float(np.abs(exact).max())
    length = next(iter(beam.assembly.elastic.values()))[0].length_m
    told = {"ratio": ratio, "w / l": largest / length}

    def off(name: str, form: ReducedForm, motion: PeriodicMotion) -> None:
        told[name] = float(np.abs(middle(form, motion) - exact).max()) / largest

    for name, stiffened in (("linear", False), ("stiffened", True)):
        form = form_of(at, Modes(7, 0), stiffened=stiffened)
        off(name, form, linear(form))
    for corrected, name in ((False, "chain"), (True, "corrected")):
        for count in segments:
            form = form_of(at, Segments(count, corrected))
            off(f"{name} {count}", form, periodic_motion(form))
    for count in elements:
        told[f"beam {count}"] = of_engine(at, count, beam, theory) / largest
    told["slopes"] = (math.pi * largest / length) ** 2
    return told


def main() -> None:
    scene = load_scene("fourbar-elastic")
    heads: list[str] = []
    for ratio in map(float, sys.argv[1:] or RATIOS):
        began = time.perf_counter()
        told = row(scene, ratio)
        if not heads:
            heads = list(told)
            print("".join(f"{head:>14}" for head in (*heads, "s")))
        shares = [f"{100.0 * told[head]:>13.3g}%" for head in heads[1:]]
        took = time.perf_counter() - began
        print(f"{told['ratio']:>14.4g}{''.join(shares)}{took:>14.1f}", flush=True)


if __name__ == "__main__":
    main()
