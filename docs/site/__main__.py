"""`python -m docs.site`: build the documentation site, hold its examples to what is printed, and
its links to what is there. Exit code 1, with every fault, where one is not good."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from docs.site.building import build
from docs.site.staging import ROOT


def main() -> int:
    """Build, and say what came of it."""
    parser = argparse.ArgumentParser(prog="python -m docs.site", description=__doc__)
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "out" / "docs")
    parser.add_argument(
        "--without-examples", action="store_true", help="run no command and draw no figure"
    )
    asked = parser.parse_args()
    began = time.monotonic()
    faults = build(asked.output, examples=not asked.without_examples)
    if faults:
        print("\n\n".join(faults), file=sys.stderr)
        print(f"\n{len(faults)} faults; there is no new site", file=sys.stderr)
        return 1
    count = len(list(asked.output.rglob("*.html")))
    print(f"{asked.output / 'index.html'}: {count} pages in {time.monotonic() - began:.0f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
