"""Where a result comes from: versions, processor, system, time."""

import os
import platform
import sys
from collections.abc import Mapping
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path


def crankcheck_version() -> str:
    """The installed version of crankcheck."""
    try:
        return version("crankcheck")
    except PackageNotFoundError:  # run from a source tree that was not installed
        return "not installed"


def provenance(engines: Mapping[str, str]) -> dict[str, str]:
    """What a result needs to be repeated; ``engines`` maps name to version."""
    return {
        "crankcheck": crankcheck_version(),
        **engines,
        "numpy": version("numpy"),
        "python": platform.python_version(),
        "processor": processor(),
        "processors": str(os.cpu_count() or 1),
        "system": f"{platform.system()} {platform.machine()}",
        "made": datetime.now(UTC).isoformat(timespec="seconds"),
    }


def processor() -> str:
    """The processor by its own name where the system tells it."""
    if sys.platform == "linux":
        try:
            for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
                if line.startswith("model name"):
                    return line.partition(":")[2].strip()
        except OSError:
            pass
    return platform.processor() or platform.machine()
