"""Runs of one scene from several starts in one batch of an engine."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from models.errors import EngineError
from models.motion import State
from models.scene import Scene
from sim.engine import Engine, Run
from sim.registry import engine as engine_of
from sim.run import Opened, followed, opened_run


def run_worlds(
    scene: Scene,
    states: Sequence[State],
    engine: str | Engine,
    profile: str = "tuned",
    *,
    threads: int = 1,
    rates: bool = True,
    **options: Any,
) -> list[Run]:
    """Run the scene from each of the states, all in one batch, with the ``options`` of `run`.

    Returns
    -------
    list of Run
        In the order of the states, as many as the engine gives logs; the costs are parts of the
        batch's, without compiling.

    Raises
    ------
    EngineError
        As `run`; also for a scene that the engine cannot hold, and for no such batch in it.
    """
    chosen = engine_of(engine) if isinstance(engine, str) else engine
    if chosen.batches is None:
        raise EngineError(f"{chosen.name} runs one world at a time")
    opened = list[Opened]()
    for state in states:
        one = opened_run(scene, state, chosen, profile, **options)
        if isinstance(one, Run):
            raise EngineError(one.reason)
        opened.append(one)
    blank = opened[0].blank
    try:
        sessions = [one.session for one in opened]
        logs = chosen.batches.record(sessions, blank.steps, blank.every, threads)
    except EngineError:
        raise
    except Exception as error:  # as of one world
        reason = f"{type(error).__name__}: {error}"
        return [replace(one.blank, status="crashed", reason=reason) for one in opened]
    if len(logs) > len(opened):
        raise EngineError(f"{chosen.name}: {len(logs)} logs of {len(opened)} worlds")
    return [
        followed(one, [(blank.steps, [log].pop)], rates=rates)
        for one, log in zip(opened, logs, strict=False)
    ]
