"""What runs when: `make test` runs what is not marked; `make slow` what takes its time, with the
reason; `benchmarks/long_runs.py` what is longer by nature, such as ten thousand scene files.

    @slow("a minute: the order of the error needs five steps")
    @pytest.mark.parametrize("name", few(SCENES, {"fourbar-lecture-1"}, "one scene shows it"))
    @pytest.mark.parametrize("count", [5, slowly(200, reason="rare kinks")])
"""

from collections.abc import Collection, Iterable

import pytest


def slow(reason: str) -> pytest.MarkDecorator:
    """The mark of a test that `make slow` runs, and why `make test` does without it."""
    return pytest.mark.slow(reason=reason)


def slowly(*case: object, reason: str, id: str | None = None) -> object:
    """A case of a test that `make slow` runs, and why `make test` does without it."""
    return pytest.param(*case, marks=slow(reason), id=id)


def at_length(*case: object, reason: str) -> object:
    """A case of a test that runs for releases, and what only such a number finds."""
    return pytest.param(*case, marks=pytest.mark.long(reason=reason))


def few(cases: Iterable[object], quick: Collection[object], reason: str) -> list[object]:
    """All cases, of which `make test` runs those in ``quick`` alone. Raises ValueError where one of
    these is no case."""
    every = list(cases)
    if lost := [case for case in quick if case not in every]:
        raise ValueError(f"{lost} are none of {every}")
    return [case if case in quick else slowly(case, reason=reason) for case in every]
