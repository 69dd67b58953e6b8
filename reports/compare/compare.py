"""Compare a run with the reference: total, geometric, drive and closure errors, rates and all.

Total error: the reference at the commanded time. Geometric error: the reference at the crank angle
that the engine logged, so that a crank which lags shows in the drive and not in the geometry.

What a run is beside (`Beside`) names the modules that compare it, which are loaded when they are
needed.
"""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from typing import Protocol, cast

from reports.compare.beside import Beside
from reports.compare.errors import Error, Errors


class Comparing(Protocol):
    """A module that compares runs of a kind."""

    def compared(self, beside: Beside, errors: Errors | None) -> Errors:
        """The errors of a run, with those that the modules before have found."""
        ...

    def places(self, beside: Beside) -> list[Error]:
        """Drive or phase errors, total errors of place and gaps alone."""
        ...


def compare(beside: Beside | None) -> Errors | None:
    """The errors of a run, or None where it logged nothing.

    Samples that are not finite, and bodies or pins of the scene that a run lacks, give errors
    that are not finite; what a user's own log lacks gives none.

    Returns
    -------
    Errors or None
        One row per quantity, body, source and kind.
    """
    errors: Errors | None = None
    for module in _modules(beside):
        assert beside is not None
        errors = module.compared(beside, errors)
    return errors


def places(beside: Beside | None) -> list[Error]:
    """Drive error, total errors of place and gaps alone; none of a run that logged nothing."""
    if beside is None:
        return []
    return [row for module in _modules(beside) for row in module.places(beside)]


def _modules(beside: Beside | None) -> Iterator[Comparing]:
    """The modules that compare a run."""
    for name in beside.compared_by if beside else ():
        yield cast(Comparing, import_module(name, __package__))
