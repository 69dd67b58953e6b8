"""What logging costs: the time of a logged run over that of the bare loop of the same steps.

`python benchmarks/logging.py` prints, for each case, the median over the repeats of the ratio of a
logged stretch to the bare stretch beside it, and of a second bare stretch to the first (A/A): the
noise. It exits with 1 if a ratio is over its limit, and with 2 if the noise is over 5 %, when the
machine is too busy to tell.
"""

import gc
import platform
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

if __name__ == "__main__":  # run as a file: the packages are beside this folder
    sys.path[0] = str(Path(__file__).resolve().parents[1])

from analytic.kinematics import solve
from models.files.reading import load_scene
from reports.output.write import processor
from sim.engine import Engine, Session
from sim.engine.settings import resolved
from sim.registry import engine

SCENE, DT_S, STEPS, REPEATS = "fourbar-lecture-1", 1e-3, 2000, 41
NOISE = 0.05
"""The most that the A/A pair may differ from 1 for a ratio to be judged."""


@dataclass(frozen=True)
class Case:
    """One ratio: every ``every``-th step logged, and the most it may cost."""

    engine: str
    profile: str
    every: int
    limit: float


CASES = (
    Case("mujoco", "as-shipped", 1, 1.15),
    Case("mujoco", "tuned", 1, 1.15),
    Case("pymunk", "as-shipped", 1, 2.5),
    Case("pymunk", "as-shipped", 10, 1.2),
    Case("pymunk", "tuned", 1, 2.5),
    Case("pymunk", "tuned", 10, 1.2),
)


def main() -> int:
    """Print the table; 1 if a ratio is over its limit, 2 if the machine is too busy to tell."""
    print(f"{SCENE}, dt {DT_S:g} s, {STEPS} steps, {REPEATS} repeats, serial, collector off\n")
    print(
        f"{'engine':8}{'profile':12}{'logged':10}{'bare us':>9}{'logged us':>11}"
        f"{'ratio':>8}{'limit':>7}{'A/A':>8}"
    )
    missed = noisy = 0
    for case in CASES:
        bare, again, logged = measured(case)
        ratio, noise = paired(logged, bare), paired(again, bare)
        word = ""
        if abs(noise - 1.0) > NOISE:
            word, noisy = "  too noisy to tell", noisy + 1
        elif ratio > case.limit:
            word, missed = "  MISSED", missed + 1
        print(
            f"{case.engine:8}{case.profile:12}{f'1 in {case.every}':10}{min(bare):9.2f}"
            f"{min(logged):11.2f}{ratio:8.3f}{case.limit:7.2f}{noise:8.3f}{word}"
        )
    versions = ", ".join(f"{name} {engine(name).version()}" for name in ("mujoco", "pymunk"))
    versions += f", numpy {np.__version__}, Python {platform.python_version()}"
    print(f"\n{versions}, {processor()}")
    return 1 if missed else 2 if noisy else 0


def paired(times: list[float], beside: list[float]) -> float:
    """The median of the ratios of stretches that ran one after the other."""
    return statistics.median(a / b for a, b in zip(times, beside, strict=True))


def measured(case: Case) -> tuple[list[float], list[float], list[float]]:
    """Microseconds per step: bare, bare again and logged, by turns, each in a new warm session."""
    chosen = engine(case.engine)
    bare, again, logged = [], [], []
    gc.disable()
    try:
        for _ in range(REPEATS):
            bare.append(timed(opened(chosen, case), bare_loop))
            logged.append(opened(chosen, case).record(STEPS, case.every).wall_s / STEPS * 1e6)
            again.append(timed(opened(chosen, case), bare_loop))
    finally:
        gc.enable()
    return bare, again, logged


def opened(chosen: Engine, case: Case) -> Session:
    """A session that has stepped already."""
    scene = load_scene(SCENE)
    start = solve(scene, np.array([0.0])).state(0)
    settings = resolved(chosen.profiles[case.profile], None)
    session = chosen.open(scene, start, settings, DT_S, "prescribed")
    session.step(STEPS // 4)
    return session


def bare_loop(session: Session) -> None:
    """The steps without logging: `mj_step(m, d, nstep)`, or `space.step` in a loop."""
    session.step(STEPS)


def timed(session: Session, work: Callable[[Session], None]) -> float:
    """Microseconds per step."""
    began = time.perf_counter()
    work(session)
    return (time.perf_counter() - began) / STEPS * 1e6


if __name__ == "__main__":
    raise SystemExit(main())
