"""Batches that are requested: their sizes, engines and lengths."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

from models.errors import CrankcheckError
from models.scene import Scene
from reports.protocol.length import Length
from reports.protocol.way import way_of
from sim.registry import declaration, engine

MOST_WORLDS = 10_000
"""Most worlds of a batch."""


def checked_sizes(sizes: Sequence[int]) -> list[int]:
    """Return numbers of worlds, each once. Raises CrankcheckError for one out of range."""
    if wrong := [size for size in sizes if not 1 <= size <= MOST_WORLDS]:
        raise CrankcheckError(f"--worlds: found {wrong[0]}; a batch has 1 to {MOST_WORLDS} worlds")
    return list(dict.fromkeys(sizes))


def with_batches(names: Iterable[str]) -> list[str]:
    """Return the engines that run batches."""
    return [name for name in names if engine(name).batches]


def startable(scenes: Iterable[Scene], *, named: bool) -> list[Scene]:
    """Return the scenes whose motion is known at any angle of the crank; others are left out where
    none is ``named``. Raises CrankcheckError where one is."""
    every = list(scenes)
    kept = [scene for scene in every if way_of(scene).closed_form]
    if named and len(kept) < len(every):
        other = next(scene for scene in every if scene not in kept)
        raise CrankcheckError(
            f"--worlds: {other.name} is in free motion or elastic, and worlds start at angles of a "
            "crank; leave the scene out, or --worlds"
        )
    return kept


def batches_of(name: str, sizes: Sequence[int]) -> Sequence[tuple[int, int]]:
    """Return worlds and threads of the batches of an engine: in one thread, and in as many as it
    takes; the first size where it has none; without sizes a run alone."""
    batches = engine(name).batches
    if not sizes or batches is None:
        return [(sizes[0] if sizes else 0, 1)]
    most = batches.threads
    return [(size, threads) for size in sizes for threads in dict.fromkeys((1, min(size, most)))]


def batch_length(name: str, scene: Scene, asked: Length, *, named: bool) -> Length | None:
    """Return the length of a batch in an engine, by default a turn, or so many steps of a slow one;
    None for a scene that a slow engine leaves out where no scene is ``named``."""
    fewer = declaration(name).fewer
    if fewer and not named and scene.name not in fewer.scenes:
        return None
    if fewer and asked.dt_s is None and asked.steps_per_turn is None:
        asked = replace(asked, steps_per_turn=fewer.steps_per_turn)
    turns = 1.0 if asked.turns is None else asked.turns
    if asked.turns is None and fewer and fewer.batch_steps:
        per_turn = asked.steps_per_turn or scene.driver.law.period_s / (asked.dt_s or 1.0)
        turns = fewer.batch_steps / per_turn
    return replace(asked, turns=turns, least=1)
