"""Four-bars thrown at a toggle: which engines know whether they get over it.

`python benchmarks/toggle.py [COUNT]` draws COUNT four-bars (200) whose toggle lies on top of a hill
of their potential energy (`analytic.free.exact_motions`), throws each at it with a little more or
less energy than the hill needs (margins of 1e-6 to 1e-1 of it, both sides), and runs every engine
at dt 1e-3, tuned and as shipped. The truth is the energy of the start; the integrated motion has to
agree. Printed are the outcomes, the rights of each decade of the margin, and the margin from which
on all are right. About four minutes on two processors. It judges no engine, and exits with 1 only
where the two truths disagree.
"""

import math
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

if __name__ == "__main__":  # run as a file: the packages are beside this folder
    sys.path[0] = str(Path(__file__).resolve().parents[1])

# Not above: it imports logging, for which Python would take the file beside this one.
from concurrent.futures import ProcessPoolExecutor

from analytic.free.exact_motions import ToggleBarrier
from analytic.free.release import release
from analytic.mechanism.fourbar import FourBar
from models.errors import CrankcheckError
from models.scene.hard import fourbar
from reports.compare.hard_runs import toggle_passage
from sim.registry import engine
from sim.run import run

COUNT, SEED, DT_S = 200, 15, 1e-3
SHORTEST_M, LONGEST_M = 0.1, 0.4
DECADES = tuple(range(-6, -1))
"""The least margins of the decades, as powers of ten."""
LINES = tuple((e, p) for e in ("mujoco", "pymunk", "exudyn") for p in ("tuned", "as-shipped"))
BEFORE_RAD = 1e-3
"""How far before its limit a driver is in the scene that is looked at; it starts elsewhere."""


@dataclass(frozen=True)
class RandomThrow:
    """A four-bar that is thrown at its toggle; it gets over where the margin is above 0."""

    lengths_m: tuple[float, float, float, float]
    margin: float

    def barrier(self) -> ToggleBarrier:
        """Raises CrankcheckError where it has none."""
        limit = FourBar(*self.lengths_m).driver_range_rad[1]
        start = math.degrees(limit - BEFORE_RAD)
        return ToggleBarrier.of(
            fourbar("thrown", *self.lengths_m, source="drawn at random", start_deg=start)
        )


@dataclass(frozen=True)
class Thrown:
    """What came of a throw: the ``outcomes`` of `LINES`, and whether the integrated motion gets
    over."""

    throw: RandomThrow
    gets_over: bool
    outcomes: tuple[str, ...]

    @property
    def truth(self) -> str:
        return "over" if self.throw.margin > 0.0 else "back"


def main(count: int = COUNT) -> int:
    """Print the tables; 1 where the truths disagree."""
    with ProcessPoolExecutor(2) as pool:
        results = list(pool.map(threw, throws(count)))
    print(f"{count} four-bars at dt {DT_S:g} s, seed {SEED}; rights of all in each decade")
    decades = "".join(f"{f'1e{k}..':>10}" for k in DECADES)
    print(f"{'':18}{decades}{'right':>8}{'all right from':>16}   wrong: truth -> outcome")
    for index, line in enumerate(LINES):
        print(f"{' '.join(line):18}{told(results, index)}")
    print(", ".join(f"{name} {engine(name).version()}" for name in dict(LINES)))
    doubtful = [result.throw for result in results if result.gets_over != (result.truth == "over")]
    for throw in doubtful:
        print(f"energy and integrated motion disagree: {throw}")
    return int(bool(doubtful))


def throws(count: int) -> Iterator[RandomThrow]:
    """So many throws; those of fewer are the first of more."""
    draw = np.random.default_rng(SEED)
    done = 0
    while done < count:
        lengths = draw.uniform(SHORTEST_M, LONGEST_M, 4)
        margin = 10.0 ** draw.uniform(DECADES[0], DECADES[-1] + 1)
        a, b, c, d = lengths.tolist()
        throw = RandomThrow((a, b, c, d), margin * (-1.0) ** done)
        try:
            throw.barrier()
        except (CrankcheckError, ValueError):
            continue  # its driver turns fully, or it has no single hill
        done += 1
        yield throw


def threw(throw: RandomThrow) -> Thrown:
    """One throw in all engines."""
    barrier = throw.barrier()
    scene, start = barrier.thrown(throw.margin), barrier.start(throw.margin)
    lasts_s = barrier.lasts_s(throw.margin)
    outcomes = []
    for name, profile in LINES:
        done = run(
            scene, start, name, profile, dt_s=DT_S, steps=round(lasts_s / DT_S), drive="free"
        )
        if done.motion is None:
            outcomes.append(done.status)
            continue
        outcomes.append(toggle_passage(barrier, done).outcome)
    # To the half: a motion that has fallen back may come round to the toggle again after it.
    passages = release(scene, 0.5 * lasts_s).passages
    return Thrown(throw, any(barrier.is_toggle(one) for one in passages), tuple(outcomes))


def told(results: Sequence[Thrown], index: int) -> str:
    """A line of the table."""
    words = []
    for power in DECADES:
        inside = [r for r in results if 10.0**power <= abs(r.throw.margin) < 10.0 ** (power + 1)]
        right = sum(r.outcomes[index] == r.truth for r in inside)
        words.append(f"{f'{right}/{len(inside)}':>10}")
    wrong = [r for r in results if r.outcomes[index] != r.truth]
    words.append(f"{len(results) - len(wrong):8d}{right_from(results, index):16.1e}")
    kinds = Counter(f"{r.truth} -> {r.outcomes[index]}" for r in wrong)
    return "".join(words) + "   " + ", ".join(f"{kind}: {n}" for kind, n in kinds.items())


def right_from(results: Sequence[Thrown], index: int) -> float:
    """The least margin such that all throws with as much or more came out right; inf if none."""
    least = math.inf
    for result in sorted(results, key=lambda one: -abs(one.throw.margin)):
        if result.outcomes[index] != result.truth:
            break
        least = abs(result.throw.margin)
    return least


if __name__ == "__main__":
    raise SystemExit(main(*map(int, sys.argv[1:2])))
