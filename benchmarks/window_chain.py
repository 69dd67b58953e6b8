"""Chains of windows left free: how well the engines hold the benchmark A02, and at what cost.

`python benchmarks/window_chain.py [accuracy] [thousandth] [timings]` prints three tables, or those
that are named. `accuracy` holds N = 40 windows for 20 s (problem A02, see `models.scene.hard`) to
the closed form: energy drift over what a turn exchanges, error of B0 up to several times, the
largest gap of a pin, and whether and where the rods ceased to be parallel. `thousandth` has the
steps and settings tried to hold place and velocity of B0 for 10 s to a thousandth, with N = 2 and
40. `timings` has the time per step for chains of 1 to 200 windows, and the exponent of N. About
eight minutes on two idle processors. It judges nothing and exits with 0, with 2 for a table that is
none of them.
"""

import math
import os
import platform
import statistics
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

if __name__ == "__main__":  # run as a file: the packages are beside this folder
    sys.path[0] = str(Path(__file__).resolve().parents[1])

# Not above: it imports logging, for which Python would take the file beside this one.
from concurrent.futures import ProcessPoolExecutor

from analytic.free.exact_motions import ChainMotion
from models.array import Array
from models.errors import EngineError
from models.scene.hard import WindowChain
from reports.compare.hard_runs import ChainErrors, compared, start_j
from reports.output.write import processor
from sim.engine import Engine, SettingValue
from sim.registry import engine
from sim.run import run, time_run

COUNT, DURATION_S, LOGGED_S = 40, 20.0, 0.01
SEEN_S = (1.0, 2.0, 5.0, 10.0, 20.0)
COUNTS = (1, 2, 5, 10, 20, 40, 100, 200)
FITTED = 20
"""The exponent is fitted over chains of so many windows and more: shorter ones cost by the call."""
PASSES, STEPS = 4, 100
"""Passes over all chains, odd and even ones compared; steps that are timed."""
BEFORE_FLAT_S = 0.06
"""Timed steps begin so long before the rods first lie flat, and go on through it."""


@dataclass(frozen=True)
class Case:
    """Settings of an engine, and the step [s]."""

    engine: str
    profile: str
    dt_s: float = 1e-3
    settings: Mapping[str, SettingValue] = field(default_factory=dict)

    @property
    def words(self) -> str:
        changed = "".join(f" {name} {value:g}" for name, value in self.settings.items())
        return f"{self.engine} {self.profile}{changed}"


ENGINES = ("mujoco", "pymunk", "exudyn")
PLAIN = (
    *(Case(e, p) for e in ("mujoco", "pymunk") for p in ("tuned", "as-shipped")),
    Case("exudyn", "tuned"),
)
MORE = (
    Case("mujoco", "tuned", 2e-3),
    Case("mujoco", "tuned", 5e-4),
    Case("pymunk", "tuned", 2e-3, {"iterations": 1000}),
    Case("pymunk", "as-shipped", 2e-4),
)
"""What else was tried to have the chain held, or held better."""

WITHIN, HELD_S = 1e-3, 10.0
"""The error of B0 [m] and of its velocity [m/s] that is asked for, and for how long."""
STIFF = {"free_timeconst_steps": 5.0}
AS_COMPILED = {"free_inverse_weight_share": 1.0, "free_timeconst_steps": 0.0}
TRIED = {
    2: (
        Case("mujoco", "tuned"),
        Case("mujoco", "tuned", 1e-3, STIFF),
        Case("mujoco", "tuned", 1e-3, AS_COMPILED),
        Case("mujoco", "tuned", 1.25e-4, AS_COMPILED),
        Case("mujoco", "as-shipped"),
        Case("pymunk", "tuned"),
        Case("pymunk", "tuned", 1e-4),
        Case("pymunk", "tuned", 5e-4, {"iterations": 5000}),
        Case("pymunk", "tuned", 2.5e-4, {"iterations": 5000}),
        Case("pymunk", "as-shipped", 1e-4),
        Case("exudyn", "tuned"),
        Case("exudyn", "tuned", 5e-4),
    ),
    40: (
        Case("mujoco", "tuned"),
        Case("mujoco", "tuned", 5e-4),
        Case("mujoco", "tuned", 1e-3, STIFF),
        Case("pymunk", "tuned"),
        Case("pymunk", "tuned", 1e-3, {"iterations": 1000}),
        Case("exudyn", "tuned"),
        Case("exudyn", "tuned", 5e-4),
    ),
}
"""Steps and settings, by the number of windows."""


def main(names: Sequence[str] = ()) -> int:
    """Print the tables of these names, all if none."""
    tables = {table.__name__: table for table in (accuracy, thousandth, timings)}
    unknown = [name for name in names if name not in tables]
    if unknown:
        print(f"found {', '.join(unknown)}; the tables are {', '.join(tables)}", file=sys.stderr)
        return 2
    for name in names or tables:
        tables[name]()
    versions = ", ".join(f"{name} {engine(name).version()}" for name in ENGINES)
    versions += f", numpy {np.__version__}, Python {platform.python_version()}"
    busy = f"; load {os.getloadavg()[0]:.1f} at the end" if hasattr(os, "getloadavg") else ""
    print(f"\n{versions}, {processor()}, {os.cpu_count()} processors{busy}")
    return 0


def accuracy() -> None:
    """The chain of the benchmark in all cases, two at a time: nothing here is timed."""
    turning = ChainMotion(WindowChain(COUNT))
    print(
        f"N = {COUNT} windows, free from upright, {DURATION_S:g} s, "
        f"{DURATION_S / turning.period_s:.1f} turns of {turning.period_s:.4f} s; "
        f"a turn exchanges {turning.exchanged_j:.1f} J\n"
    )
    until = "".join(f"{f'{t:g} s':>9}" for t in SEEN_S)
    print(f"{'':37}{'':8}{'energy':>9}{'at end':>9}{'   error of B0 [m] up to':45}{'pin gap':>9}")
    print(f"{'settings':37}{'dt':8}{'drift':>9}{'J':>9}{until}{'m':>9}  rods")
    with ProcessPoolExecutor(2) as pool:
        for case, found in zip((*PLAIN, *MORE), pool.map(held, (*PLAIN, *MORE)), strict=True):
            errors = "".join(f"{place_until(found, t):9.1e}" for t in SEEN_S)
            print(
                f"{case.words:37}{case.dt_s:<8g}{energy_drift(found):9.1e}"
                f"{found.energy_j[-1]:9.2g}{errors}{np.max(found.gap_m):9.1e}  {ended(found)}",
                flush=True,
            )


def thousandth() -> None:
    """Which steps and settings keep B0 and its velocity to a thousandth."""
    print(
        f"\nplace and velocity of B0 within {WITHIN:g} m and m/s for {HELD_S:g} s\n\n"
        f"{'N':<5}{'settings':66}{'dt':10}{'m':>9}{'m/s':>9}{'drift':>9}{'us/step':>9}"
    )
    asked = [(count, case) for count, cases in TRIED.items() for case in cases]
    with ProcessPoolExecutor(2) as pool:
        for (count, case), found in zip(asked, pool.map(brief, asked), strict=True):
            place, speed = float(found.place_m.max()), float(speed_error(found).max())
            words = "within" if max(place, speed) <= WITHIN else ""
            cost = found.run.cost
            spent = f"{cost.us_per_step:9.0f}" if cost else f"{'':9}"
            print(
                f"{count:<5}{case.words:66}{case.dt_s:<10g}{place:9.1e}{speed:9.1e}"
                f"{energy_drift(found):9.1e}{spent}  {words}",
                flush=True,
            )


def brief(asked: tuple[int, Case]) -> ChainErrors:
    """A chain of so many windows, for 10 s."""
    return held(asked[1], asked[0], HELD_S)


def held(case: Case, count: int = COUNT, duration_s: float = DURATION_S) -> ChainErrors:
    """One case of the benchmark."""
    return hold(
        WindowChain(count),
        case.engine,
        case.profile,
        dt_s=case.dt_s,
        duration_s=duration_s,
        every=round(LOGGED_S / case.dt_s),
        settings=case.settings,
    )


def hold(
    chain: WindowChain,
    engine: str | Engine,
    profile: str = "tuned",
    *,
    dt_s: float,
    duration_s: float,
    every: int = 1,
    settings: Mapping[str, SettingValue] | None = None,
) -> ChainErrors:
    """Run a chain from upright, free, for ``duration_s`` in steps of ``dt_s``, and compare.

    Every ``every``-th step is logged. Raises CrankcheckError, as `sim.run.run` does, and for a run
    that did not start.
    """
    start = ChainMotion(chain).motion(np.array([0.0])).state(0)
    steps = max(round(duration_s / dt_s / every), 1) * every
    done = run(
        chain.scene(),
        start,
        engine,
        profile,
        dt_s=dt_s,
        steps=steps,
        every=every,
        drive="free",
        settings=settings,
    )
    return compared(chain, done)


def energy_drift(errors: ChainErrors) -> float:
    """The largest change of the energy, over the 2 m g l P that rises and falls in a turn; for a
    chain without weight, over the energy of the start."""
    turning = ChainMotion(errors.chain)
    scale = turning.exchanged_j or start_j(turning)
    return float(np.max(np.abs(errors.energy_j))) / scale


def place_until(errors: ChainErrors, time_s: float) -> float:
    """The largest error of B0 up to a time [m]; NaN if the run ended before it."""
    if errors.time_s[-1] < time_s - 1e-9:
        return float("nan")
    return float(np.max(errors.place_m[errors.time_s <= time_s + 1e-9]))


def speed_error(errors: ChainErrors) -> Array:
    """The distance of the velocity of B0 from the true one [m/s], (T,), at its own instants."""
    done, turning = errors.run, ChainMotion(errors.chain)
    assert done.motion is not None
    time_s = done.motion.time_s if done.velocity_time_s is None else done.velocity_time_s
    theta, omega, _ = turning.at(time_s)
    speed = turning.chain.length_m * omega[:, None]
    true = speed * np.stack([-np.sin(theta), np.cos(theta)], axis=-1)
    with np.errstate(all="ignore"):  # a run that came apart may overflow
        return np.asarray(np.hypot(*(done.motion.points["B0"].velocity - true).T))


def ended(found: ChainErrors) -> str:
    """How the motion ended, in words."""
    words = [] if found.run.status == "ok" else [f"{found.run.status}: {found.run.reason}"]
    if found.left is None:
        words.append(f"parallel to {np.max(found.lean_rad):.0e} rad")
    else:
        angle = math.degrees(math.remainder(found.left.driver_rad, math.tau))
        words.append(f"part at {found.left.time_s:.2f} s, {angle:.0f} deg")
    return "; ".join(words)


def timings() -> None:
    """Microseconds per step over the number of windows, and the exponent."""
    dt_s = PLAIN[0].dt_s
    print(
        f"\n{STEPS} bare steps of {dt_s:g} s through the first flat position, us per step: the "
        f"least of {PASSES} passes; serial, warm, collector off\n"
    )
    print(
        f"{'windows N':22}"
        + "".join(f"{n:9}" for n in COUNTS)
        + f"   N^p, N >= {FITTED}    odd/even"
    )
    passes = [
        {case.words: [timed(case, n) for n in COUNTS] for case in PLAIN} for _ in range(PASSES)
    ]
    for case in PLAIN:
        rows = np.array([one[case.words] for one in passes])
        best = rows.min(axis=0)
        power, doubt = exponent(best)
        noise = statistics.median((rows[::2].min(axis=0) / rows[1::2].min(axis=0)).tolist())
        print(
            f"{case.words:22}"
            + "".join(f"{us:9.1f}" for us in best)
            + f"   {power:5.2f} +- {doubt:4.2f}{noise:13.3f}"
        )


def timed(case: Case, count: int) -> float:
    """Microseconds per step of a chain that is about to lie flat; NaN where the engine gives up on
    it there."""
    turning = ChainMotion(WindowChain(count))
    times = np.linspace(0.0, turning.period_s / 2.0, 20_001)
    flat = float(np.interp(0.0, -turning.at(times)[0], times))
    start = turning.motion(np.array([flat - BEFORE_FLAT_S])).state(0)
    try:
        timing = time_run(
            WindowChain(count).scene(),
            start,
            case.engine,
            case.profile,
            dt_s=case.dt_s,
            steps=STEPS,
            repeats=1 if count >= 100 else 3,
            drive="free",
            settings=case.settings,
        )
    except EngineError as error:
        print(f"  {case.words}, {count} windows: {error}")
        return math.nan
    return timing.best.us_per_step


def exponent(us: np.ndarray) -> tuple[float, float]:
    """The slope of log(time) over log(N) for the longer chains, and its standard error; NaN of
    fewer than three."""
    used = (np.array(COUNTS) >= FITTED) & np.isfinite(us)
    if used.sum() < 3:
        return math.nan, math.nan
    x, y = np.log(np.array(COUNTS)[used]), np.log(us[used])
    slope, level = np.polyfit(x, y, 1)
    off = y - slope * x - level
    spread = math.sqrt(float(off @ off) / (len(x) - 2))
    return float(slope), spread / math.sqrt(float(((x - x.mean()) ** 2).sum()))


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
