"""Where the segments of elastic links start: the state that an engine's chain is given."""

from __future__ import annotations

import numpy as np

from analytic.elastic.discretisation import Segments
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.segments import SegmentChain
from analytic.multibody.as_motion import as_motion
from models.elastic import Shape
from models.motion import State
from models.segmented import SegmentedScene


def segment_start(own: SegmentedScene, start: Shape) -> State:
    """The state at time 0 of `SegmentedScene.rigid`, as the exact chain has it: its joints are
    closed, and its accelerations are those of the equations of motion."""
    by = Segments(own.count, own.corrected)
    motion = DrivenElasticMotion(own.with_nodes, 1.0, by, start, stiffened=True)
    instant, assembly = motion.first, motion.form.assembly
    seconds = instant.all_seconds(instant.seconds)
    state = as_motion(assembly, np.zeros(1), instant.now, seconds).state()
    turning = {"theta": dict(state.theta), "omega": dict(state.omega), "alpha": dict(state.alpha)}
    series = zip(turning.values(), (instant.now.q, instant.now.rates, seconds), strict=True)
    for angles, values in series:
        for name in own.scene.elastic:
            chain, at = assembly.elastic[name]
            assert isinstance(chain, SegmentChain)
            del angles[name]
            each = chain.segment_angles(values[0, at])
            angles.update(zip(own.segments(name), map(float, each), strict=True))
    return State(**{**vars(state), **turning})
