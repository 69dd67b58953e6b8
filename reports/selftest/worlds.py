"""Faults of batches: sound logs of the wrong worlds, missing logs, and a world that differs."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from models.motion import State
from models.scene import Scene
from reports.selftest import fault
from sim.engine import Log, Run
from sim.registry import engine
from sim.run.worlds import run_worlds

WORLDS = 6
"""Worlds of the batches that faults are planted in."""


def in_batch(change: Callable[[list[Log], float], list[Log]]) -> fault.Plant:
    """Change the logs that the engine gives of its worlds."""

    @fault.planting
    def runner(
        size: float, scene: Scene, states: Sequence[State], name: str, *args: Any, **options: Any
    ) -> list[Run]:
        own = engine(name)
        assert own.batches is not None
        right = own.batches.record

        def record(*asked: Any) -> Sequence[Log]:
            return change([*right(*asked)], size)

        wrong = replace(own, batches=replace(own.batches, record=record))
        return run_worlds(scene, states, wrong, *args, **options)

    return runner


def _shifted(logs: list[Log], by: float) -> list[Log]:
    """Give each world the bodies of a later one, at its own times."""
    later = logs[round(by) :] + logs[: round(by)]
    return [
        replace(log, poses=replace(log.poses, bodies=other.poses.bodies))
        for log, other in zip(logs, later, strict=True)
    ]


def _off(logs: list[Log], share: float) -> list[Log]:
    """Scale the places of the last world."""
    poses = logs[-1].poses.changed(lambda body: replace(body, origin=(1 + share) * body.origin))
    return [*logs[:-1], replace(logs[-1], poses=poses)]


_batch = partial(
    fault.Fault,
    "batch",
    scenes=(fault.FOURBAR,),
    needs=lambda name: engine(name).batches is not None,
)
FAULTS = (
    _batch("worlds-shifted", "each world has the log of the next", "CC136", in_batch(_shifted),
           1.0, "world", says=("world 3 holds the motion of world 4",), whole=True),
    _batch("world-lost", "the last world has no log", "CC136",
           in_batch(lambda logs, lost: logs[: len(logs) - round(lost)]), 1.0, "world",
           says=("not logged",), whole=True),
    _batch("world-off", "a world differs from its run alone", "CC137", in_batch(_off), 1e-6,
           "of it"),
)  # fmt: skip
