"""The hypotheses by subject, in the order in which equal ones are preferred."""

from collections.abc import Callable, Iterator, Sequence

from reports.causes.account import Account
from reports.causes.hypotheses import other_world
from reports.causes.hypotheses.clock import drift, stamps, time_unit
from reports.causes.hypotheses.dimension import dimension
from reports.causes.hypotheses.filtered import filtered, forth_and_back, smoothed
from reports.causes.hypotheses.late import late
from reports.causes.hypotheses.lost_rows import lost_rows
from reports.causes.hypotheses.misnamed import misnamed, swapped
from reports.causes.hypotheses.samples import rounded, samples
from reports.causes.hypotheses.straight import straight, turns
from reports.causes.hypotheses.two_faults import two_faults
from reports.causes.inquiry import Inquiry

Hypothesis = Callable[[Inquiry], Iterator[Account | None]]
Hypotheses = Sequence[Hypothesis]
OF_SAMPLES: Hypotheses = (turns, samples)
"""Faults of some samples, besides any fault of all samples."""
OF_CHANNELS: Hypotheses = (
    straight, swapped, misnamed, *OF_SAMPLES, other_world.turned_points, late, filtered,
    forth_and_back, rounded,
)  # fmt: skip
"""Faults of some channels."""
OF_LOGS: Hypotheses = (
    other_world.backwards,
    other_world.assembly,
    other_world.mirrored,
    time_unit,
    stamps,
    lost_rows,
    other_world.moved,
    other_world.turned,
    other_world.sized,
    other_world.start_angle,
    dimension,
    drift,
    smoothed,
    two_faults,
)
"""Faults of the log as a whole, or of the scene; the expensive ones come last, for channels without
a good explanation so far."""
