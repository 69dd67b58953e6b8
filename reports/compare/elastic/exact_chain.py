"""A chain of segments without an engine: what one that made no error would find."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

from analytic.elastic.elastic_motion import ElasticHistory
from analytic.elastic.engine_start import chain_motion
from models.array import Array
from models.cut_scenes import SegmentedScene
from models.elastic import Shape
from models.motion import Motion


@dataclass(frozen=True)
class ExactChain:
    """A chain of segments as a multibody of our own, and its motion as one of the scene."""

    chain: SegmentedScene
    until_s: float
    shape: Shape

    @cached_property
    def motion(self) -> ElasticHistory:
        return chain_motion(self.chain, self.shape, self.until_s)

    def at(self, time_s: Array) -> Motion:
        """At times [s] (T,), with the links and points of the scene."""
        motion = self.motion.at(time_s)
        first = {
            self.chain.segments(name)[0]: motion.links[name] for name in self.chain.scene.elastic
        }
        return self.chain.folded(replace(motion, links={**motion.links, **first}))
