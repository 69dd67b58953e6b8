"""The hypotheses by subject, in the order in which equal ones are preferred."""

from collections.abc import Callable, Iterator, Mapping

from reports.causes.account import Account
from reports.causes.hypotheses import other_world
from reports.causes.hypotheses.clock import drift, stamps, time_unit
from reports.causes.hypotheses.dimension import dimension
from reports.causes.hypotheses.filtered import filtered, smoothed
from reports.causes.hypotheses.late import late
from reports.causes.hypotheses.misnamed import misnamed, swapped
from reports.causes.hypotheses.samples import rounded, samples
from reports.causes.hypotheses.straight import straight, turns
from reports.causes.hypotheses.two_faults import two_faults
from reports.causes.inquiry import Inquiry

Hypothesis = Callable[[Inquiry], Iterator[Account | None]]
OF_SAMPLES: Mapping[str, Hypothesis] = {"turns": turns, "samples": samples}
"""Faults of some samples, besides any fault of all samples."""
OF_CHANNELS: Mapping[str, Hypothesis] = {
    "straight": straight,
    "swapped": swapped,
    "misnamed": misnamed,
    **OF_SAMPLES,
    "late": late,
    "filtered": filtered,
    "rounded": rounded,
}
"""Faults of some channels."""
OF_LOGS: Mapping[str, Hypothesis] = {
    "backwards": other_world.backwards,
    "assembly": other_world.assembly,
    "mirrored": other_world.mirrored,
    "time unit": time_unit,
    "stamps": stamps,
    "moved": other_world.moved,
    "turned": other_world.turned,
    "sized": other_world.sized,
    "start angle": other_world.start_angle,
    "dimension": dimension,
    "drift": drift,
    "smoothed": smoothed,
    "two faults": two_faults,
}
"""Faults of the log as a whole, or of the scene; the expensive ones come last, for channels without
a good explanation so far."""
