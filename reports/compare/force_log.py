"""What is seen of the forces of a run beside their errors: stamps, sums, and what is left out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from models.motion import Forces
from reports.compare.errors import Error
from reports.compare.facts import ForceFacts, Unbalanced
from reports.output.numbers import count
from reports.quantities.forces import acting
from sim.engine import Run

ROUNDING = 1e-9
"""A share of a step that stamps may be off by."""


@dataclass(frozen=True)
class ForceErrors:
    """What came of the forces of a run, in the words of `reports.compare.errors.Errors`."""

    rows: tuple[Error, ...] = ()
    not_reported: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    facts: ForceFacts = field(default_factory=ForceFacts)
    incomplete: str = ""
    unsure: Mapping[tuple[str, str], float] = field(default_factory=dict)
    """What the reference is wrong by, as a pure number, of forces that it knows at no sample."""


def off_stamps(run: Run) -> str:
    """Which forces are stamped farther than a step from the sample that they are logged with, ""
    where none are: what acts at another time is no force of that sample."""
    forces = acting(run)
    if forces is None or run.motion is None:
        return ""
    samples = run.motion.time_s[-forces.time_s.size :]
    bad = np.flatnonzero(~(np.abs(forces.time_s - samples) <= (1.0 + ROUNDING) * run.dt_s))
    if not bad.size:
        return ""
    first = int(bad[0])
    return (
        f"forces of the sample at {samples[first]:.9g} s are stamped {forces.time_s[first]:.9g} s, "
        f"over a step away ({count(bad.size, 'sample')} of {samples.size})"
    )


def unbalanced(run: Run, largest_n: float) -> Unbalanced | None:
    """The pin whose forces add up to most, over the largest reaction; what is no number is told
    elsewhere."""
    forces = acting(run)
    sums = dict[str, float]()
    for point, bodies in (forces.pins if forces else {}).items():
        off = np.hypot(*np.sum(list(bodies.values()), axis=0).T)
        if np.any(np.isfinite(off)):
            sums[point] = float(np.max(off, where=np.isfinite(off), initial=0.0)) / largest_n
    point = max(sums, key=lambda name: sums[name], default="")
    return Unbalanced(point, sums[point]) if point else None


def force_notes(run: Run, reference: Forces, dead: int, passed: int) -> tuple[str, ...]:
    """What of the forces is not compared, or not judged, of samples in dead points (``dead``) and
    near change points (``passed``), and why."""
    logged = acting(run)
    notes = [reference.undetermined and f"no reactions: {reference.undetermined}"]
    if dead:
        notes.append(
            f"forces: {count(dead, 'sample')} of {reference.time_s.size} in dead points left out, "
            "or beside jumps of a load or of friction: there they are not determined"
        )
    if passed:
        notes.append(
            f"forces: {count(passed, 'sample')} of {reference.time_s.size} near change points "
            "compared and not judged, as joints may push against each other there"
        )
    if logged is not None and logged.undetermined != reference.undetermined:
        notes.append(logged.undetermined and f"forces: {logged.undetermined}")
    return tuple(note for note in notes if note)
