"""Which tests reach a line of product code, or a file, by what `tests.recorded.recording` noted."""

import json
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from coverage import CoverageData

from tests.recorded.recording import ROOT, SECONDS, SHARED, USES

COMBINED = "combined"
IN_PHASE = re.compile(r" \((setup|call|teardown)\)(\|.*)?$", re.DOTALL)
"""How a child names its test."""


class Reached:
    """The record of a run of tests in a folder, made in the checkout ``root``."""

    def __init__(self, folder: Path, root: Path = ROOT) -> None:
        self.folder, self.root = folder, root
        self._data = CoverageData(str(folder / COMBINED))
        if not (folder / COMBINED).exists():
            self._combine()
        self._data.read()
        self._users: dict[str, set[str]] = defaultdict(set)
        for user, shared in self._rows(USES):
            self._users[shared].add(user)
        self.seconds: dict[str, float] = defaultdict(float)
        self.failed = set[str]()
        self._of_file: dict[str, set[str]] = {}
        for name, _, seconds, outcome in self._rows(SECONDS):
            self.seconds[name] += seconds
            if outcome == "failed":
                self.failed.add(name)

    def _combine(self) -> None:
        """One file of all processes: a query of one is quick."""
        for path in sorted(self.folder.glob(".coverage.*")):
            part = CoverageData(str(path))
            part.read()
            self._data.update(part)
            path.unlink()

    def _rows(self, file: str) -> Iterator[Any]:
        for path in sorted(self.folder.glob(file.format("*"))):
            yield from map(json.loads, path.read_text(encoding="utf-8").splitlines())

    def by_line(self, file: str) -> dict[int, set[str]]:
        """The tests that run each line of a file (its path in the checkout), imports apart."""
        found = self._data.contexts_by_lineno(str(self.root / file))
        return {line: self._tests(names) for line, names in found.items()}

    def by_file(self, file: str) -> set[str]:
        """The tests that run any line of a file, as above."""
        if file not in self._of_file:
            self._of_file[file] = set().union(*self.by_line(file).values())
        return self._of_file[file]

    def _tests(self, names: Iterable[str]) -> set[str]:
        """The tests of these names, and the users of what these names made for many."""
        waiting, seen = [IN_PHASE.sub("", name) for name in names], set[str]()
        while waiting:
            if (name := waiting.pop()) not in seen:
                seen.add(name)
                waiting += self._users[name] if name.startswith(SHARED) else ()
        return {name for name in seen if "::" in name and not name.startswith(SHARED)}

    def files(self) -> list[str]:
        """The files that any test reaches."""
        every = self._data.measured_files()
        return sorted(Path(path).relative_to(self.root).as_posix() for path in every)
