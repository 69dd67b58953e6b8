"""`crankcheck stability` and `selftest`: hard cases with grades, planted faults with rules."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated

import pandas as pd
from rich.console import Console
from rich.progress import Progress

from models.errors import CrankcheckError, suggestion
from reports.judge.cell import Checked
from reports.output.console import say, say_whole
from reports.output.formats import csv, json_text
from reports.output.numbers import count
from reports.output.printed import Print, present
from reports.output.write import Outputs, provenance
from reports.plan.requirements import PROFILES, chosen_engines, chosen_profiles
from reports.plan.singular import silent_note
from reports.protocol.way import WAYS, way
from reports.requests.options import (
    Engines,
    Forces,
    Jobs,
    TextFormat,
    argument,
    given,
    option,
    output_option,
)
from reports.selftest import trial
from reports.selftest.fault import PROFILE, RunKind
from reports.selftest.table import place_row, show_faults
from reports.stability.baseline import baseline, changes, is_worse, show_changes
from reports.stability.case import Case
from reports.stability.grading import CATALOGUE
from reports.stability.matrix import FILE, Matrix, read_matrix, run_rows, to_json
from reports.stability.running import CaseLine, command, run_lines, run_one
from reports.stability.table import show, show_run
from reports.workers.isolated import Limits, checked_limits
from reports.workers.progress import progress_bar
from sim.registry import engine, offering


@dataclass(frozen=True)
class StabilityRequest:
    """Arguments of `stability`, as given; ``at`` is one value of one case."""

    cases: Annotated[Sequence[str], argument("CASE", "Hard cases; default: all driven ones.")] = ()
    engines: Engines = ()
    profiles: Annotated[Sequence[str], option("Profile; may be repeated.", "--profile")] = ()
    at: Annotated[float | None, "Run only this value of the one named case."] = None
    folder: Annotated[Path | None, output_option("Folder for matrix, table and page.")] = None
    baseline: Annotated[
        Path | None, option("Folder, or JSON, of an earlier run; exit 1 when worse than it.", "DIR")
    ] = None
    format: TextFormat = "text"
    limit_s: Annotated[float, "Longest time for a run, in seconds."] = 120.0
    memory_gb: Annotated[float, "Most memory for a run, in GB."] = 4.0
    jobs: Jobs = 0
    forces: Forces = False
    free: Annotated[bool, "Run the cases of free motion."] = False
    elastic: Annotated[bool, "Run the cases of elastic links."] = False

    def run(self, console: Console, progress: Console) -> int:
        """Answer, and return the exit code: 0, or 1 where one value is not held, or anything is
        worse than in the baseline. Raises CrankcheckError for an unknown case, engine or profile, a
        value that has no reference, or a folder that can not be written or compared with."""
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
        base = baseline(self.baseline, lines) if self.baseline else None
        with progress_bar(progress, "lines", len(lines)) as advance:
            graded = run_lines(lines, self.jobs, limits, lambda _: advance())
        matrix = Matrix(
            facts=provenance({name: engine(name).version() for name in engines}),
            cases=tuple(case.facts() for case in cases),
            runs=tuple(run for line in graded for run in line.runs),
            critical=tuple(line.critical for line in graded),
            pictures=tuple(picture for line in graded for picture in line.pictures),
        )
        found = changes(base, matrix) if base else []
        shows: list[Print] = [partial(show, matrix=matrix)]
        shows += [partial(show_changes, found=found)] * bool(base)
        with outputs.written({name: partial(of, matrix) for name, of in CONTENTS.items()}):
            present(console, self.format, "stability", *shows)
        if self.folder is not None:
            say(console, f"{self.folder}: {', '.join(CONTENTS)}")
        return int(is_worse(found))


def _cases(names: Sequence[str], asked: Mapping[str, bool]) -> list[Case]:
    """The named cases, or all cases of the requested way, or those that are driven and rigid."""
    kinds = [kind for kind, given in asked.items() if given]
    if len(kinds) > 1:
        both = " with ".join(f"--{kind}" for kind in kinds)
        raise CrankcheckError(f"{both}: no case belongs to both; give one of them")
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
        raise CrankcheckError(f"--at {value:g}: needs one case, found {len(cases)}; name one")
    for option_ in given(request, "folder", "baseline"):
        raise CrankcheckError(
            f"--at and {option_}: one value is shown, and neither stored nor compared; leave one "
            "of them"
        )
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


KINDS_ASKED: tuple[RunKind, ...] = ("forces", "free", "elastic")
IN_FOLDER = {"selftest.csv": "--csv", "selftest.json": "--json"}


@dataclass(frozen=True)
class SelftestRequest:
    engines: Annotated[
        Sequence[str],
        option("Engine; may be repeated; default: all.", "--engine"),
    ] = ()
    faults: Annotated[
        Sequence[str], option("Fault of the table; may be repeated; default: all.", "--fault NAME")
    ] = ()
    jobs: Jobs = 0
    csv: Annotated[Path | None, "Write a row per fault and place as CSV."] = None
    json: Annotated[Path | None, "Write the same, and more, as JSON."] = None
    folder: Annotated[Path | None, output_option("Write both into a folder.")] = None
    forces: Annotated[bool, "Plant faults of reactions and torques instead."] = False
    free: Annotated[bool, "Plant faults of dynamics in free motion instead."] = False
    elastic: Annotated[bool, "Plant faults of elastic links instead."] = False

    def run(self, console: Console, progress: Console) -> int:
        """Answer, and return the exit code: 0 where every fault is caught; 1 where one escapes or
        changes nothing, or where a fault that need not be seen changes nothing. Raises
        CrankcheckError for an unknown engine or fault, and an output that can not be written."""
        engines, kind = chosen_engines(self.engines), _kind(self)
        faults = trial.chosen_faults(self.faults, engines, kind)
        outputs = Outputs({"--csv": self.csv, "--json": self.json}, self.folder, IN_FOLDER)
        outputs.check()
        for name in engines:
            if name not in offering("spoiler"):
                progress.print(f"engine {name}: has no spoiler, so no fault is planted inside it")
        with Progress(console=progress, transient=True, disable=not progress.is_terminal) as bar:
            task = bar.add_task("planting", total=len(faults))
            names = [fault.name for fault in faults]
            verdicts = trial.tried_all(names, engines, self.jobs, lambda _: bar.advance(task))
        sound = [
            trial.healthy(scene, name, kind=each)
            for each in dict.fromkeys(fault.kind for fault in faults)
            for scene, name in trial.sites([f for f in faults if f.kind == each], engines)
        ]
        passed = [] if self.faults else trial.passed_by(engines, kind)
        facts = provenance({name: engine(name).version() for name in engines})
        rows = [place_row(one, place) for one in verdicts for place in one.places]
        contents = {
            "selftest.csv": lambda: csv(pd.DataFrame(rows)),
            "selftest.json": lambda: _json(verdicts, sound, passed, rows, facts),
        }
        with outputs.written(contents):
            show_faults(console, sound, verdicts, engines, facts, passed)
        return int(not all(one.caught for one in verdicts) or any(one.nothing for one in passed))


def _kind(request: SelftestRequest) -> RunKind:
    """Kind of runs to plant faults in, where none is named. Raises CrankcheckError."""
    asked = [kind for kind in KINDS_ASKED if getattr(request, kind)]
    if len(asked) > 1:
        raise CrankcheckError(
            f"--{asked[0]} with --{asked[1]}: each has its own runs; give one of them"
        )
    return asked[0] if asked else "motion"


def _settings(verdicts: Sequence[trial.Verdict]) -> dict[str, object]:
    kinds = {one.fault.kind for one in verdicts}
    own = (runs.settings.items() for kind, runs in trial.RUNS.items() if kind in kinds)
    return {"profile": PROFILE, **{name: value for items in own for name, value in items}}


def _json(
    verdicts: Sequence[trial.Verdict],
    sound: Sequence[Checked],
    passed: Sequence[trial.Passed],
    rows: Sequence[Mapping[str, object]],
    facts: Mapping[str, str],
) -> str:
    """Facts, settings, the sound runs, every fault in every place, and the faults that pass."""
    content = {
        "provenance": dict(facts),
        "settings": _settings(verdicts),
        "caught": sum(one.caught for one in verdicts),
        "escaped": [one.name for one in verdicts if not one.caught],
        "without_a_fault": [
            {"scene": one.cell.scene.name, "engine": one.cell.engine, "passes": trial.passes(one)}
            for one in sound
        ],
        "places": list(rows),
        "not_seen": [
            {
                "name": one.unseen.name,
                "what": one.unseen.what,
                "reason": one.unseen.reason,
                "failed": dict(one.failed),
                "planted_nothing_in": list(one.nothing),
            }
            for one in passed
        ],
    }
    return json_text(content)
