"""What logging costs: the time of a logged run over that of the bare loop of the same steps.

`python benchmarks/logging.py` prints the ratios, beside an A/A pair that shows the noise, and exits
with 1 if one is missed. A ratio is kept if its median or that of the fastest repeats is within the
limit; as a busy machine disturbs both loops, a ratio over its limit is measured up to three times.
"""

from __future__ import annotations

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
from models.files import load_scene
from sim.engine import Engine, Session
from sim.registry import engine
from sim.settings import resolved

SCENE, DT_S, STEPS, REPEATS = "fourbar-lecture-1", 1e-3, 2000, 41
TRIES = 3


@dataclass(frozen=True)
class Case:
    """One ratio: ``every`` n-th step logged (0: none), and the most it may cost."""

    engine: str
    profile: str
    every: int
    limit: float | None


CASES = (
    Case("mujoco", "as-shipped", 0, None),
    Case("mujoco", "as-shipped", 1, 1.15),
    Case("mujoco", "tuned", 1, 1.15),
    Case("pymunk", "as-shipped", 0, None),
    Case("pymunk", "as-shipped", 1, 2.5),
    Case("pymunk", "as-shipped", 10, 1.2),
    Case("pymunk", "tuned", 1, 2.5),
    Case("pymunk", "tuned", 10, 1.2),
)


def main() -> int:
    """Print the table; 1 if a ratio is over its limit."""
    print(f"{SCENE}, dt {DT_S:g} s, {STEPS} steps, {REPEATS} repeats, serial, collector off\n")
    print(
        f"{'engine':8}{'profile':12}{'logged':12}{'bare us':>9}{'logged us':>11}"
        f"{'ratio med':>11}{'ratio min':>11}{'limit':>7}"
    )
    missed = 0
    for case in CASES:
        for _ in range(TRIES):
            bare, logged = measured(case)
            ratios = [b / a for a, b in zip(bare, logged, strict=True)]
            middle, least = statistics.median(ratios), min(logged) / min(bare)
            over = case.limit is not None and min(middle, least) > case.limit
            if not over:
                break
        missed += over
        what = f"1 in {case.every}" if case.every else "none (A/A)"
        limit = f"{case.limit:.2f}" if case.limit else "-"
        print(
            f"{case.engine:8}{case.profile:12}{what:12}{min(bare):9.2f}{min(logged):11.2f}"
            f"{middle:11.3f}{least:11.3f}{limit:>7}{'  MISSED' if over else ''}"
        )
    versions = ", ".join(f"{name} {engine(name).version()}" for name in ("mujoco", "pymunk"))
    versions += f", numpy {np.__version__}, Python {platform.python_version()}"
    print(f"\n{versions}, {processor()}")
    return 1 if missed else 0


def measured(case: Case) -> tuple[list[float], list[float]]:
    """Microseconds per step of the bare loop and of the logged one, by turns, each new and warm."""
    chosen = engine(case.engine)
    bare, logged = [], []
    gc.disable()
    try:
        for _ in range(REPEATS):
            bare.append(timed(opened(chosen, case), bare_loop))
            if case.every:
                logged.append(opened(chosen, case).record(STEPS, case.every).wall_s / STEPS * 1e6)
            else:
                logged.append(timed(opened(chosen, case), bare_loop))
    finally:
        gc.enable()
    return bare, logged


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


def processor() -> str:
    """The processor's name, as far as the system tells."""
    info = Path("/proc/cpuinfo")
    if info.exists():
        for line in info.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()


if __name__ == "__main__":
    raise SystemExit(main())
