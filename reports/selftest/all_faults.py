"""The faults by name."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from models.errors import CrankcheckError, suggestion
from reports.selftest import (
    beams,
    clock,
    dynamics,
    elastic,
    elastic_released,
    engines,
    forces,
    handed_back,
    mechanism,
    misplaced,
    missing,
    record,
    requests,
    stepping,
    values,
)
from reports.selftest.fault import Fault, RunKind

FAULTS: dict[str, Fault] = {
    fault.name: fault
    for module in (
        requests,
        handed_back,
        mechanism,
        engines,
        clock,
        values,
        misplaced,
        missing,
        forces,
        dynamics,
        stepping,
        record,
        elastic,
        beams,
        elastic_released,
    )
    for fault in module.FAULTS
}
"""To add a fault, add it to the module of its group."""
GROUPS = {
    "request": "another run than was asked for",
    "reference": "numbers that are the reference's",
    "scene": "another mechanism in the engine",
    "engine": "something wrong inside the engine",
    "clock": "another instant than the log says",
    "log": "wrong numbers in the log",
    "misplaced": "numbers of the log in a wrong place",
    "missing": "something missing from the log",
    "force": "a right motion with wrong forces",
    "dynamics": "let go, as another machine",
    "stepping": "let go, and spoilt inside the engine",
    "record": "let go, and wrong in the log",
    "segments": "elastic links, as another chain",
    "vibration": "elastic links, spoilt in the engine",
    "deflection": "elastic links, wrong in the log",
    "beam": "elastic links, as an engine's own beam",
}


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
    kinds = (kind, "beam") if kind == "elastic" else (kind,)
    every = [name for name, fault in FAULTS.items() if fault.kind in kinds]
    order = dict.fromkeys(names or every)
    return [FAULTS[name] for name in order if any(map(FAULTS[name].possible, chosen))]
