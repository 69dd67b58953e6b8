"""`crankcheck stability`: hard cases, graded by rules, with the limit up to which each is held."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated

import pandas as pd
from rich.console import Console

from models.errors import CrankcheckError, suggestion
from reports.output.console import say, say_whole
from reports.output.formats import csv
from reports.output.numbers import count
from reports.output.write import Outputs, provenance
from reports.plan.chosen import PROFILES, chosen_engines, chosen_profiles
from reports.plan.singular import silent_note
from reports.protocol.way import WAYS, way
from reports.requests.options import Engines, Forces, Jobs, argument, option, output_option
from reports.stability.case import Case
from reports.stability.grading import CATALOGUE
from reports.stability.matrix import FILE, Matrix, read_matrix, run_rows, to_json
from reports.stability.running import CaseLine, command, run_lines, run_one
from reports.stability.table import show, show_run
from reports.workers.isolated import Limits, checked_limits
from reports.workers.progress import progress_bar
from sim.registry import engine


@dataclass(frozen=True)
class StabilityRequest:
    """Arguments of `stability`, as given; ``at`` is one value of one case."""

    cases: Annotated[Sequence[str], argument("CASE", "Hard cases; all if none.")] = ()
    engines: Engines = ()
    profiles: Annotated[Sequence[str], option("Profile; may be repeated.", "--profile")] = ()
    at: Annotated[float | None, "Only this value of the one case that is named."] = None
    folder: Annotated[Path | None, output_option("Folder for matrix, table and page.")] = None
    limit_s: Annotated[float, "Longest time for a run, in seconds."] = 120.0
    memory_gb: Annotated[float, "Most memory for a run, in GB."] = 4.0
    jobs: Jobs = 0
    forces: Forces = False
    free: Annotated[bool, "The cases of free motion, which are not among all."] = False
    elastic: Annotated[bool, "Those of elastic links, which are not among all."] = False

    def run(self, console: Console, progress: Console) -> int:
        """Answer, and return the exit code: 0, or for one value 1 where it is not held. Raises
        CrankcheckError for an unknown case, engine or profile, a value that has no reference, or a
        folder that can not be written."""
        cases = _cases(self.cases, {"free": self.free, "elastic": self.elastic})
        engines = chosen_engines(self.engines)
        profiles = [name for name, _ in chosen_profiles(self.profiles or PROFILES, engines)]
        limits = checked_limits(self.limit_s, self.memory_gb)
        if self.forces and (note := silent_note(engines)):
            say_whole(progress, note)
        if self.at is not None:
            return _single(cases, self, engines, profiles, limits, console)
        outputs = Outputs({}, self.folder, dict.fromkeys(CONTENTS, ""))
        outputs.check()
        if self.folder is not None:
            _keep_others(self.folder, {case.name for case in cases})
        lines = [
            CaseLine(case.name, engine_, profile, self.forces)
            for case, engine_, profile in itertools.product(cases, engines, profiles)
        ]
        with progress_bar(progress, "lines", len(lines)) as advance:
            graded = run_lines(lines, self.jobs, limits, lambda _: advance())
        matrix = Matrix(
            facts=provenance({name: engine(name).version() for name in engines}),
            cases=tuple(case.facts() for case in cases),
            runs=tuple(run for line in graded for run in line.runs),
            critical=tuple(line.critical for line in graded),
            pictures=tuple(picture for line in graded for picture in line.pictures),
        )
        with outputs.written({name: partial(of, matrix) for name, of in CONTENTS.items()}):
            show(console, matrix)
        if self.folder is not None:
            say(console, f"{self.folder}: {', '.join(CONTENTS)}")
        return 0


def _cases(names: Sequence[str], asked: Mapping[str, bool]) -> list[Case]:
    """The named cases, or all cases of the requested way, or those that are driven and rigid."""
    kinds = [kind for kind, given in asked.items() if given]
    if len(kinds) > 1:
        both = " with ".join(f"--{kind}" for kind in kinds)
        raise CrankcheckError(f"{both}: no case is of both; ask for one of them")
    for name in names:
        if name not in CATALOGUE:
            raise CrankcheckError(f"case {name!r}: unknown; {suggestion(name, CATALOGUE, 'use')}")
    for kind in kinds:
        known = [name for name, case in CATALOGUE.items() if case.way == kind]
        if others := [name for name in names if name not in known]:
            raise CrankcheckError(
                f"--{kind} and {others[0]}: {way(kind).no_case}; those are {', '.join(known)}"
            )
    own = next(iter(kinds), WAYS[-1])
    every = (name for name, case in CATALOGUE.items() if case.way == own)
    return [CATALOGUE[name] for name in dict.fromkeys(names or every)]


def _keep_others(folder: Path, wanted: set[str]) -> None:
    """Refuse to replace a stored matrix that holds further cases. Raises CrankcheckError."""
    try:
        stored = {case.name for case in read_matrix(folder).cases}
    except CrankcheckError:
        return  # there is none, or none that can be read
    if others := stored - wanted:
        raise CrankcheckError(
            f"-o {folder}: holds a matrix with {count(len(others), 'case')} not run now "
            f"({', '.join(sorted(others)[:3])}); name another folder, or run these cases as well"
        )


def _single(
    cases: Sequence[Case],
    request: StabilityRequest,
    engines: Sequence[str],
    profiles: Sequence[str],
    limits: Limits,
    console: Console,
) -> int:
    """Show one value of one case, in full; return the exit code."""
    value = request.at
    assert value is not None
    if len(cases) != 1:
        raise CrankcheckError(f"--at {value:g}: a value of one case; found {len(cases)}, name one")
    if request.folder is not None:
        raise CrankcheckError("--at and -o: one value is shown and not stored; leave one of them")
    case, code = cases[0], 0
    case.refuse(value)
    for name, profile in itertools.product(engines, profiles):
        run = run_one(CaseLine(case.name, name, profile, request.forces), value, limits)
        show_run(console, case.facts(), run)
        code = max(code, int(run.outcome not in case.good))
    return code


def _table(matrix: Matrix) -> str:
    told = zip(run_rows(matrix), matrix.runs, strict=True)
    return csv(pd.DataFrame([row | {"command": command(run)} for row, run in told]))


def _page(matrix: Matrix) -> str:
    from reports.page.build import stability_page

    return stability_page(matrix)


CONTENTS = {FILE: to_json, "stability.csv": _table, "stability.html": _page}
"""The files of a matrix."""
