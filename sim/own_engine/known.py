"""The engines that are not ours and that this process has met, by their own names.

The name that an engine gives itself stands in results, not how it was spelled. A process that is
to run one is told the spelling (`told`), as the name says nothing of where it is.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

from models.errors import EngineError, suggestion
from sim.engine import Engine
from sim.own_engine.look_over import looked_over
from sim.own_engine.spelling import WRITTEN, found, installed, only_one, spelling_of
from sim.own_engine.watched import watched


@dataclass(frozen=True)
class _Known:
    """An engine, the object that it was made of, and how that is spelled."""

    engine: Engine
    value: object
    spelling: str


_known: dict[str, _Known] = {}
_told: dict[str, str] = {}


def own_engine(text: str, ours: Collection[str]) -> Engine:
    """The engine of that name or spelling; ``ours`` are the names that are taken.

    Raises
    ------
    EngineError
        An unknown name (the message suggests near ones), an engine that is not to be found or
        imported, an object that is none, one with the name of another.
    """
    if ":" in text:
        return _met(text, ours)
    if text in _known:
        return _known[text].engine
    if text in _told:
        return _met(_told[text], ours)
    points = installed()
    if text not in (names := [point.name for point in points]):
        choices = [*ours, *dict.fromkeys(names)]
        cure = suggestion(text, choices, "there are")
        own = "" if cure.startswith("did you") else f"; one of your own is written {WRITTEN}"
        raise EngineError(f"engine {text!r}: unknown; {cure}{own}")
    point = only_one(text, points)
    engine = _met(spelling_of(point), ours)
    if engine.name != text:
        raise EngineError(
            f"engine {text}: the entry point of that name gives an engine that calls itself "
            f"{engine.name}; give both the same name"
        )
    return engine


def spellings() -> Mapping[str, str]:
    """How the engines that are known here are spelled, by name: what `told` takes."""
    return {**_told, **{name: one.spelling for name, one in _known.items()}}


def told(more: Mapping[str, str]) -> None:
    """Know engines by name that another process has met; they are looked for when asked for."""
    _told.update(more)


def _met(spelling: str, ours: Collection[str]) -> Engine:
    """The engine that is spelled, once it is clear that its name is its own."""
    for one in _known.values():
        if one.spelling == spelling:
            return one.engine
    value = found(spelling)
    engine = looked_over(spelling, value)
    if same := [name for name in ours if name.casefold() == engine.name.casefold()]:
        raise EngineError(
            f"engine {spelling}: it calls itself {engine.name}, as the {same[0]} that crankcheck "
            "has; give it another name"
        )
    before = next((o for n, o in _known.items() if n.casefold() == engine.name.casefold()), None)
    if before is None:
        _known[engine.name] = _Known(watched(spelling, engine), value, spelling)
    elif before.value is not value:
        raise EngineError(
            f"engine {spelling}: it calls itself {engine.name}, as {before.spelling} does; give "
            "one of them another name"
        )
    return _known[engine.name].engine
