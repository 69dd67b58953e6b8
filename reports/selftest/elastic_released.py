"""Faults of elastic links that are let go: what acts, what it moves, and what takes its energy."""

from __future__ import annotations

from functools import partial

from reports.selftest.elastic_runs import ELASTIC_RUNS, LOOSE
from reports.selftest.fault import Fault
from reports.selftest.free_changes import later, of_load, reversed_load
from reports.selftest.segment_changes import damped, heavy_rocker, in_chain, springs, stiffer
from reports.selftest.stepping import after_look

_STEP_S = (ELASTIC_RUNS[LOOSE].lasts_s or 0.0) / ELASTIC_RUNS[LOOSE].steps
_fault = partial(Fault, "segments", scenes=(LOOSE,))
FAULTS = (
    _fault(
        name="loose-torque-late",
        what="let go: the torque acts late",
        plant=in_chain(of_load("pulse", later(_STEP_S))),
        size=1.0,
        unit="steps",
        rule="CC127",
    ),
    _fault(
        name="loose-torque-back",
        what="let go: it turns the other way",
        plant=in_chain(of_load("pulse", reversed_load)),
        rule="CC127",
    ),
    _fault(
        name="loose-modulus-off",
        what="let go: the modulus is too large",
        plant=in_chain(springs(stiffer)),
        size=1e-2,
        unit="of it",
        rule="CC132",
    ),
    _fault(
        name="loose-damping",
        what="let go: the springs damp",
        plant=in_chain(springs(damped)),
        size=1e-3,
        unit="s",
        rule="CC132",
    ),
    _fault(
        name="loose-rocker-heavy",
        what="let go: what it moves is too heavy",
        plant=in_chain(heavy_rocker),
        size=1e-2,
        unit="of it",
        rule="CC127",
    ),
    Fault(
        "vibration",
        name="loose-damped",
        what="let go: something damps all joints",
        plant=after_look(lambda tools, session, size: tools.damp(session, size)),
        size=1.0,
        unit="1/s",
        scenes=(LOOSE,),
        rule="CC129",
    ),
)
