"""What `crankcheck` costs beside the engines: processor time without stepping and imports.

`python benchmarks/verify_overhead.py [--beside CHECKOUT] [ARGUMENT ...]` runs the command of this
checkout, and of another one in turns with it, each in a process of its own. Printed are user and
system time [s], less what the adapters' sessions take to step and log and what imports take, and
the ratio of the medians. Without arguments: `verify --jobs 1`, of all scenes. ``CHAIN`` among them
stands for a scene file of a chain of 100 links.
"""

import argparse
import contextlib
import importlib._bootstrap  # what all imports go through
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve()
ROUNDS = 5
LINKS = 100


def chain(links: int = LINKS) -> str:
    """The scene file of a chain of so many links, the ground among them, an even number.

    ::

             B --- C0 --- C1 --- C2 ..     a crank-rocker, and rockers parallel to its own
            /     /      /      /
           A     D0     D1     D2 ..       on the ground, 0.3 m apart
    """
    rockers = range(links // 2 - 1)
    pivots = ", ".join(f"D{k} = [{0.3 * (k + 1):.1f}, 0.0]" for k in rockers)
    lines = [f'name = "chain-{links}"', 'source = "benchmarks/verify_overhead.py"']
    lines += ["[ground]", f"points = {{ A = [0.0, 0.0], {pivots} }}"]
    lines += ["[driver]", 'link = "crank"', "speed_rad_s = 10.0", "start_deg = 90.0"]
    lines += ["[links]", 'crank = { bar = ["A", "B"], length_m = 0.1 }']
    for k in rockers:
        before, span_m = (f"C{k - 1}", 0.3) if k else ("B", 0.25)
        lines += [f'coupler{k} = {{ bar = ["{before}", "C{k}"], length_m = {span_m} }}']
        lines += [f'rocker{k} = {{ bar = ["D{k}", "C{k}"], length_m = 0.2 }}']
    return "\n".join(lines) + "\n"


class Clock:
    """Processor time [s] that some functions took; one that another of them calls counts once."""

    def __init__(self) -> None:
        self.spent_s, self.running = 0.0, False

    def on(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """The function, timed."""

        def timed(*args: Any, **options: Any) -> Any:
            if self.running:
                return function(*args, **options)
            self.running, began = True, time.process_time()
            try:
                return function(*args, **options)
            finally:
                self.running = False
                self.spent_s += time.process_time() - began

        return timed


def child(checkout: str, arguments: list[str]) -> None:
    """Run the command of a checkout in this process; its time goes to the standard error."""
    sys.path[0] = checkout
    clock = Clock()
    load = importlib._bootstrap._find_and_load
    importlib._bootstrap._find_and_load = clock.on(load)
    began = time.process_time()
    from reports.cli import main
    from sim import registry

    for name in registry.ENGINES:
        adapter = registry.engine(name)

        def opened(*args: Any, open_: Callable[..., Any] = adapter.open, **options: Any) -> Any:
            session = open_(*args, **options)
            session.step, session.record = clock.on(session.step), clock.on(session.record)
            return session

        object.__setattr__(adapter, "open", opened)  # some are frozen, and some are not
    sys.argv = ["crankcheck", *arguments]
    with contextlib.suppress(SystemExit):
        main()
    print(f"\n{time.process_time() - began - clock.spent_s}", file=sys.stderr)


def seconds(checkout: Path, arguments: list[str]) -> float:
    """What the command of a checkout takes, in its own environment where it has one."""
    python = checkout / ".venv" / "bin" / "python"
    program = str(python) if python.exists() else sys.executable
    done = subprocess.run(
        [program, str(HERE), "--child", str(checkout), *arguments],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        env={**os.environ, "PYTHONPATH": str(checkout)},
        text=True,
        check=True,
    )
    return float(done.stderr.split()[-1])


def main() -> None:
    """Print the table."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--beside", type=Path, help="another checkout")
    given, arguments = options.parse_known_args()
    checkouts = [HERE.parents[1], *([given.beside.resolve()] if given.beside else [])]
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "chain.toml"
        scene.write_text(chain(), encoding="utf-8")
        command = [
            str(scene) if a == "CHAIN" else a for a in arguments or ["verify", "--jobs", "1"]
        ]
        times = [[seconds(each, command) for each in checkouts] for _ in range(ROUNDS)]
    middle = [statistics.median(column) for column in zip(*times, strict=True)]
    for checkout, column, median in zip(checkouts, zip(*times, strict=True), middle, strict=True):
        each = "  ".join(f"{time_s:.2f}" for time_s in column)
        print(f"{checkout}: median {median:.2f} s of {each}")
    if len(middle) > 1:
        print(f"ratio {middle[0] / middle[1]:.3f}")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--child"]:
        child(sys.argv[2], sys.argv[3:])
    else:
        main()
