"""The first samples of a run: as far as it is judged."""

from __future__ import annotations

from dataclasses import replace

from models.array import Array
from sim.engine import Energy, Run


def first_samples(run: Run, number: int) -> Run:
    """The run with its first samples alone, of all that it logged at each; itself where these are
    all."""
    motion = run.motion
    if motion is None or number >= motion.time_s.size:
        return run

    def cut(series: Array) -> Array:
        return series[:number]

    return replace(
        run,
        motion=replace(motion.each_series(cut), time_s=cut(motion.time_s)),
        gaps={name: cut(gap) for name, gap in run.gaps.items()},
        velocity_time_s=None if run.velocity_time_s is None else cut(run.velocity_time_s),
        acceleration_time_s=(
            None if run.acceleration_time_s is None else cut(run.acceleration_time_s)
        ),
        energy=run.energy and Energy(cut(run.energy.kinetic_j), cut(run.energy.potential_j)),
    )
