"""Some samples of a run: the first, as far as it is judged, or a few of the whole."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from models.array import Array
from sim.engine import Energy, Run


def first_samples(run: Run, number: int) -> Run:
    """The run with its first samples alone, of all that it logged at each; itself where these are
    all."""
    motion = run.motion
    if motion is None or number >= motion.time_s.size:
        return run
    return each_at(run, lambda series: series[:number])


def each_at(run: Run, chosen: Callable[[Array], Array]) -> Run:
    """The run at some of its samples, of all that it logged at each."""
    assert run.motion is not None
    energy = run.energy
    return replace(
        run,
        motion=replace(run.motion.each_series(chosen), time_s=chosen(run.motion.time_s)),
        gaps={name: chosen(gap) for name, gap in run.gaps.items()},
        velocity_time_s=None if run.velocity_time_s is None else chosen(run.velocity_time_s),
        acceleration_time_s=(
            None if run.acceleration_time_s is None else chosen(run.acceleration_time_s)
        ),
        energy=energy and Energy(chosen(energy.kinetic_j), chosen(energy.potential_j)),
    )
