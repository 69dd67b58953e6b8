"""Random cases by the thousand, for releases: what `make slow` does with fewer of.

    python benchmarks/long_runs.py [PATH ...]      # hours on two cores; PATHs of tests for a part

Runs the tests that are marked long, and prints what each took; the exit code is that of pytest.
"""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
PYTEST = ("-m", "pytest", "-q", "-n", "2", "--dist", "worksteal", "-m", "long", "--durations", "0")


def main() -> int:
    return subprocess.call([sys.executable, *PYTEST, *sys.argv[1:]], cwd=ROOT)


if __name__ == "__main__":
    sys.exit(main())
