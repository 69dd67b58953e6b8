"""Names that a caller chooses: one of them is a text, and no collection of its letters."""

from __future__ import annotations

from collections.abc import Iterable

from models.errors import CrankcheckError, shown


def names_in(chosen: str | Iterable[str], what: str) -> tuple[str, ...]:
    """The chosen names, in order. Raises CrankcheckError for what is neither a name nor several."""
    if isinstance(chosen, str):
        return (chosen,)
    names: tuple[str, ...] | None
    try:
        names = tuple(chosen)
    except TypeError:  # also of an array of no dimension, which is called iterable
        names = None
    if names is None or not all(isinstance(name, str) for name in names):
        raise CrankcheckError(f"{what}: found {shown(chosen)}; give a name, or a list of names")
    return names
