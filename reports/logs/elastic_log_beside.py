"""A user's log of a mechanism whose links bend, beside the beam and beside the exact chain."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from reports.compare.elastic.elastic_truth import ElasticBeside
from reports.logs.log_beside import LogBeside
from sim.engine import Run

if TYPE_CHECKING:
    from reports.compare.elastic.elastic_truth import ElasticTruth


@dataclass(frozen=True)
class ElasticLogBeside(LogBeside, ElasticBeside):
    """A log of as many segments as were told of it."""

    @staticmethod
    def of_log(truth: ElasticTruth, run: Run) -> ElasticLogBeside:
        """The log beside the truth, and the run that it amounts to."""
        assert run.motion is not None
        return ElasticLogBeside(truth, run, run.motion, step_s=run.dt_s, elastic=truth)

    @property
    def has_crank(self) -> bool:
        return False
