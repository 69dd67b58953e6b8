"""Where the segments of elastic links start: the state that an engine's chain is given."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from analytic.elastic.discretisation import Segments
from analytic.elastic.elastic_history import elastic_history
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.released import ENOUGH
from analytic.elastic.sampled import ElasticHistory
from analytic.elastic.segments import SegmentChain
from analytic.multibody.as_motion import as_motion
from models.elastic import Shape
from models.motion import State
from models.segmented import SegmentedScene


def chain_motion(own: SegmentedScene, start: Shape, until_s: float = 1.0) -> ElasticHistory:
    """The exact motion of the chains of a scene until then [s], their nodes as named points."""
    by = Segments(own.count, own.corrected)
    motion = elastic_history(own.with_nodes, until_s, by, start, tolerance=ENOUGH)
    if not isinstance(motion, DrivenElasticMotion):
        return motion
    return replace(motion, bare=replace(motion, scene=own.scene))


def segment_start(own: SegmentedScene, start: Shape, motion: ElasticHistory | None = None) -> State:
    """The state at time 0 of `SegmentedScene.rigid`, as the exact chain has it: its joints are
    closed, and its accelerations are those of the equations of motion. ``motion`` is that of
    `chain_motion`, where it is there already."""
    motion = motion or chain_motion(own, start)
    (now, seconds), assembly = motion.begun, motion.assembly
    state = as_motion(assembly, np.zeros(1), now, seconds).state()
    turning = {"theta": dict(state.theta), "omega": dict(state.omega), "alpha": dict(state.alpha)}
    series = zip(turning.values(), (now.q, now.rates, seconds), strict=True)
    for angles, values in series:
        for name in own.scene.elastic:
            chain, at = assembly.elastic[name]
            assert isinstance(chain, SegmentChain)
            del angles[name]
            each = chain.segment_angles(values[0, at])
            angles.update(zip(own.segments(name), map(float, each), strict=True))
    return State(**{**vars(state), **turning})
