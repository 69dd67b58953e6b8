"""`crankcheck selftest`: plant faults, find the rule that catches each, show, write."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import pandas as pd
from rich.console import Console
from rich.progress import Progress

from models.errors import CrankcheckError
from reports.judge.cell import Checked
from reports.output.formats import csv, json_text
from reports.output.write import Outputs, provenance
from reports.plan.chosen import chosen_engines
from reports.requests.options import Jobs, option, output_option
from reports.selftest import trial
from reports.selftest.fault import PROFILE, RunKind
from reports.selftest.table import place_row, show_faults
from sim.registry import engine, offering

KINDS_ASKED: tuple[RunKind, ...] = ("forces", "free", "elastic")
IN_FOLDER = {"selftest.csv": "--csv", "selftest.json": "--json"}


@dataclass(frozen=True)
class SelftestRequest:
    engines: Annotated[
        Sequence[str], option("Engine; may be repeated; all if none.", "--engine")
    ] = ()
    faults: Annotated[
        Sequence[str], option("Fault of the table; may be repeated; all if none.", "--fault NAME")
    ] = ()
    jobs: Jobs = 0
    csv: Annotated[Path | None, "Write a row per fault and place."] = None
    json: Annotated[Path | None, "Write the same and more as JSON."] = None
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
                progress.print(f"engine {name}: it has no spoiler, so nothing is planted inside it")
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
            f"--{asked[0]} with --{asked[1]}: the faults of either have runs of their own; ask for "
            "one of them"
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
