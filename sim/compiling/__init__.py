"""Compiling of an engine before its first step: it takes minutes, once, and counts in no limit."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

_listeners: list[Callable[[bool], None]] = []


def listen(listener: Callable[[bool], None]) -> None:
    """Call ``listener`` with True where compiling begins in this process, with False at its end."""
    _listeners.append(listener)


@contextmanager
def compiling() -> Iterator[None]:
    """Say that this process compiles meanwhile."""
    for listener in _listeners:
        listener(True)
    try:
        yield
    finally:
        for listener in _listeners:
            listener(False)
