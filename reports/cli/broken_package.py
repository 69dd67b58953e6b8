"""Whether it was a package of others that failed while it was imported: no fault of crankcheck."""

from __future__ import annotations

from pathlib import Path
from traceback import walk_tb

HOME = Path(__file__).parents[2]
"""The folder of our packages."""


def broken_package(error: Exception) -> str:
    """The package, not one of ours, in whose import an error was raised; empty where it was not in
    one, as a fault in what we do with it."""
    for frame, _ in walk_tb(error.__traceback__):
        place = Path(frame.f_code.co_filename)
        ours = place.is_relative_to(HOME) and "site-packages" not in place.relative_to(HOME).parts
        name = str(frame.f_globals.get("__name__", "__main__"))
        if frame.f_code.co_name == "<module>" and not ours and name != "__main__":
            return name.partition(".")[0]
    return ""
