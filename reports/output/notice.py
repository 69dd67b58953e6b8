"""What is wrong with what was read, on standard error."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence

import typer


def tell(lines: Sequence[str]) -> None:
    """Print a notice, where there is one; a standard error that takes nothing is no fault."""
    if lines:
        with contextlib.suppress(OSError):
            typer.echo("\n".join((f"crankcheck: {lines[0]}", *lines[1:])), err=True)
