"""What a second of free motion costs: the reference, scipy on the same equation, and the engines.

Prints three tables. The first has the reference (two integrations and what they leave in doubt)
beside DOP853 of scipy on J phi'' + J' phi'^2 / 2 = Q as one writes it down, with J' in closed form
and by differences: milliseconds, how often the mechanism was worked out, and the largest difference
of the driver's angle from the reference. The second has the largest step at which each engine's
angle is within a target, and what that costs over the reference. The third shows what Baumgarte's
terms cost in the multibody form. About two minutes. It judges nothing and exits with 0.
"""

import sys

sys.path.pop(0)  # this folder, whose logging.py would hide the standard library's

import gc
import platform
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from analytic.free import release as of_release
from analytic.free.free_motion import FreeMotion
from analytic.free.machine import Machine
from analytic.free.release import release
from models.array import Array
from models.errors import EngineError
from models.files.reading import load_scene
from models.scene import Scene
from reports.output.write import processor
from sim.registry import engine
from sim.run import run, time_run
from tests.second_opinions.baumgarte_table import baumgarte_table

SCENES = ("fourbar-swing", "fourbar-pulse", "slider-crank-spring", "press-motor")
LASTS_S = 1.0
SAMPLES = 101
ROUNDS = 5
PACED_S = 1e-3
"""A longest step for DOP853: left to itself it misses its tolerance."""
RTOL, ATOL = 3e-14, 1e-15
NUDGE_RAD = 1e-5
"""Of differences: what they leave out is of its square, and rounding over it."""

ENGINES = ("mujoco", "pymunk", "exudyn")
TARGETS_RAD = (1e-3, 1e-6, 1e-9)
COARSEST_S, HALVINGS = 2e-3, 10
PATIENCE_S = 3.0
"""A run of one second that takes longer ends the search for the step of an engine."""
TIMED = 5000
"""Steps that are timed, at most."""

BAUMGARTE, STEPS_S = "fourbar-swing", (4e-3, 2e-3)


def main() -> int:
    """Print the tables."""
    methods()
    engines()
    baumgarte()
    versions = ", ".join(f"{name} {engine(name).version()}" for name in ENGINES)
    print(
        f"\n{versions}, numpy {np.__version__}, Python {platform.python_version()}, {processor()}"
    )
    return 0


@dataclass(frozen=True)
class Equation:
    """The equation of a machine as one writes it down: J, J' and Q at each call."""

    machine: Machine
    by_differences: bool

    def angle(self, time_s: Array, longest_s: float) -> tuple[Array, int]:
        """The driver's angle at times [s], and how often the mechanism was worked out."""
        law = self.machine.scene.driver.law
        start = [float(row[0]) for row in law.at(np.zeros(1))[:2]]
        done = solve_ivp(
            self._rates, (0.0, float(time_s[-1])), start, "DOP853", time_s,
            rtol=RTOL, atol=ATOL, max_step=longest_s,
        )  # fmt: skip
        return done.y[0], int(done.nfev)

    def _rates(self, time_s: float, state: Array) -> tuple[float, float]:
        phi, omega = state[:1], state[1:]
        inertia, slope = self._inertia(phi)
        push = self.machine.push(np.array([time_s]), phi, omega)[0]
        return float(omega[0]), float((push - 0.5 * slope * omega[0] ** 2) / inertia)

    def _inertia(self, phi: Array) -> tuple[float, float]:
        """J and J'."""
        if not self.by_differences:
            inertia, slope = self.machine.inertia(phi)
            return float(inertia[0]), float(slope[0])
        before, here, after = self.machine.inertia(phi + NUDGE_RAD * np.array([-1.0, 0.0, 1.0]))[0]
        return float(here), float(after - before) / (2.0 * NUDGE_RAD)


def afresh(scene: Scene) -> FreeMotion:
    """The reference, which is kept from call to call otherwise."""
    of_release._released.cache_clear()
    return release(scene, LASTS_S)


def least_s(call: Callable[[], object], rounds: int = ROUNDS) -> float:
    """The least processor time of a few calls [s], which other work does not add to."""
    found = []
    gc.disable()
    for _ in range(rounds):
        start = time.process_time()
        call()
        found.append(time.process_time() - start)
    gc.enable()
    return min(found)


def methods() -> None:
    """The reference beside scipy on the same equation."""
    time_s = np.linspace(0.0, LASTS_S, SAMPLES)
    print(
        f"{LASTS_S:g} s of motion; ms, over the reference, largest difference of the angle, calls\n"
    )
    print(f"{'scene':22}{'method':46}{'ms':>9}{'ratio':>8}{'rad':>10}{'calls':>8}")
    for name in SCENES:
        scene = load_scene(name)
        free = release(scene, LASTS_S)
        true, base = free.law.at(time_s)[0], least_s(lambda scene=scene: afresh(scene))
        again = least_s(lambda scene=scene: afresh(scene))
        doubt = float(free.error_rad(time_s).max())
        print(
            f"{name:22}{'reference (its own estimate)':46}{1e3 * base:9.1f}{1.0:8.2f}{doubt:10.1e}"
        )
        print(f"{'':22}{'again (A/A)':46}{1e3 * again:9.1f}{again / base:8.2f}")
        for by_differences in (False, True):
            equation = Equation(Machine(scene), by_differences)
            for longest_s in (np.inf, PACED_S):
                began = time.process_time()
                angle, calls = equation.angle(time_s, longest_s)
                spent = time.process_time() - began
                words = "DOP853, J' " + ("by differences" if by_differences else "in closed form")
                words += "" if longest_s == np.inf else f", steps <= {PACED_S:g} s"
                off = float(np.abs(angle - true).max())
                print(f"{'':22}{words:46}{1e3 * spent:9.1f}{spent / base:8.2f}{off:10.1e}{calls:8}")
        sys.stdout.flush()


def engines() -> None:
    """Each engine's largest step within a target, and its cost over that of the reference."""
    head = "".join(f"{f'within {target:g} rad':>30}" for target in TARGETS_RAD)
    print(
        f"\n{LASTS_S:g} s in engines, tuned: the largest step [s], halved from {COARSEST_S:g} s, "
        "within a target, ms of bare steps,\nover the reference; or the least error that runs of "
        f"up to {PATIENCE_S:g} s reached\n\n{'scene':22}{'engine':9}{head}"
    )
    for name in SCENES:
        scene = load_scene(name)
        base = least_s(lambda scene=scene: afresh(scene), 2)
        for which in ENGINES:
            found = searched(scene, which)
            cells = "".join(f"{cell(scene, which, found, one, base):>30}" for one in TARGETS_RAD)
            print(f"{name:22}{which:9}{cells}", flush=True)


def searched(scene: Scene, which: str) -> dict[float, float]:
    """The largest error of the driver's angle [rad] over the step [s]."""
    free, found = release(scene, LASTS_S), {}
    start = free.at(np.zeros(1)).state()
    for halving in range(HALVINGS):
        dt_s = COARSEST_S / 2**halving
        steps = round(LASTS_S / dt_s)
        began = time.perf_counter()
        try:
            done = run(
                scene,
                start,
                which,
                dt_s=dt_s,
                steps=steps,
                every=max(steps // 100, 1),
                drive="free",
            )
        except EngineError:
            return found
        if done.motion is not None and done.status == "ok":
            theta = done.motion.links[scene.driver.link].theta
            off = np.abs(theta - free.law.at(done.motion.time_s)[0])
            found[dt_s] = float(off.max())
        if time.perf_counter() - began > PATIENCE_S or min(found.values(), default=1.0) <= min(
            TARGETS_RAD
        ):
            break
    return found


def cell(scene: Scene, which: str, found: dict[float, float], target: float, base: float) -> str:
    """The step that keeps to a target, its cost and that over the reference's."""
    within = [dt_s for dt_s, error in found.items() if error <= target]
    if not within:
        least = min(found, key=lambda dt_s: found[dt_s], default=None)
        return "no run" if least is None else f"{found[least]:.1e} at {least:.2g}"
    dt_s = max(within)
    steps = round(LASTS_S / dt_s)
    start = release(scene, LASTS_S).at(np.zeros(1)).state()
    timing = time_run(
        scene, start, which, dt_s=dt_s, steps=min(steps, TIMED), repeats=2, drive="free"
    )
    spent = 1e-6 * timing.best.us_per_step * steps
    return f"{dt_s:.3g}: {1e3 * spent:.1f} ms, {spent / base:.2g}"


def baumgarte() -> None:
    """The errors of the multibody form with Baumgarte's terms."""
    scene = load_scene(BAUMGARTE)
    near = release(scene, LASTS_S).at(np.zeros(1)).state()
    print(
        f"\n{BAUMGARTE}, {LASTS_S:g} s, multibody form with Baumgarte's terms, steps of order 4\n\n"
        f"{'alpha = beta 1/s':18}{'step s':>9}{'angle rad':>12}{'gap m':>12}{'energy':>12}"
    )
    for row in baumgarte_table(scene, LASTS_S, steps_s=STEPS_S, near=near):
        words = "" if row.stable else "  what is open does not decay at this step"
        print(
            f"{row.alpha:<18g}{row.step_s:9g}{row.error:12.1e}{row.gap:12.1e}{row.drift:12.1e}{words}"
        )


if __name__ == "__main__":
    sys.exit(main())
