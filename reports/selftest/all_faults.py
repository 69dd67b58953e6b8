"""The faults by name."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import cast

from models.errors import CrankcheckError, suggestion
from reports.selftest.fault import Fault, RunKind
from reports.selftest.fault_runs import FaultRuns, FaultSet
from reports.way.way import WAYS, way

_SETS = [cast(FaultSet, way(name).own_part("faults", FaultSet((), {}))) for name in reversed(WAYS)]
RUNS: dict[RunKind, FaultRuns] = {kind: runs for each in _SETS for kind, runs in each.runs.items()}
"""By kind."""
GROUPS = {group: title for runs in RUNS.values() for group, title in runs.groups.items()}
_KINDS = {group: kind for kind, runs in RUNS.items() for group in runs.groups}
FAULTS: dict[str, Fault] = {
    fault.name: replace(fault, kind=_KINDS[fault.group]) for each in _SETS for fault in each.faults
}
"""To add a fault, add it to the module of its group."""


def chosen_faults(
    names: Sequence[str], engines: Iterable[str], kind: RunKind = "motion"
) -> list[Fault]:
    """The named faults, each once, or all that are planted in runs of a kind; of them those that
    one of the engines can have.

    Raises
    ------
    CrankcheckError
        An unknown name (the message suggests near ones), or one that these engines can not have.
    """
    chosen = set(engines)
    for name in names:
        if name not in FAULTS:
            hint = suggestion(name, FAULTS, "use")
            raise CrankcheckError(f"--fault {name!r}: there is none of that name; {hint}")
        if not any(map(FAULTS[name].possible, chosen)):
            able = " and ".join(FAULTS[name].engines) or "engines that are not installed"
            raise CrankcheckError(
                f"--fault {name}: it can be planted in {able} only; "
                f"found --engine {', '.join(sorted(chosen))}"
            )
    kinds = (kind, *RUNS[kind].also)
    every = [name for name, fault in FAULTS.items() if fault.kind in kinds]
    order = dict.fromkeys(names or every)
    return [FAULTS[name] for name in order if any(map(FAULTS[name].possible, chosen))]
