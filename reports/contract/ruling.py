"""Put an engine to the clauses, each in a process apart: what ends it costs its clause alone."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from typing import Literal

from models.errors import EngineError
from models.files.reading import load_scene
from reports.contract.clause import Clause
from reports.contract.clauses import CLAUSES
from reports.contract.subject import NotTriedError, Subject
from reports.workers.isolated import Isolated, Limits, Lost
from reports.workers.scheduler import as_they_end
from sim.engine import Engine
from sim.own_engine.spelling import failure
from sim.own_engine.watched import BrokenContractError
from sim.registry import engine

SCENES = (
    "fourbar-lecture-1",
    "sixbar-watt",
    "slider-crank-offset",
    "slotted-lever",
    "shaper",
    "scotch-yoke",
)
"""One of each kind of joint; the first is what every engine is held to."""
THE_SCENE = "EC21"
"""The clause that a session is the scene: where it is held nowhere, there is no session that the
others could say anything of."""
Answer = Literal["held", "broken", "not tried"]


@dataclass(frozen=True)
class Ruling:
    """What came of a clause: the scenes that it is held on, what breaks it, and why it was not
    tried on others."""

    id: str
    scenes: tuple[str, ...] = ()
    breaches: tuple[str, ...] = ()
    untried: tuple[str, ...] = ()

    @property
    def clause(self) -> Clause:
        return CLAUSES[self.id]

    @property
    def answer(self) -> Answer:
        if self.breaches:
            return "broken"
        return "held" if self.scenes else "not tried"


def put_to(subject: Engine, clause: Clause, scenes: Sequence[str] = SCENES) -> Ruling:
    """What comes of a clause in an engine."""
    held, breaches, untried = [], [], []
    for name in scenes:
        try:
            found = list(clause.check(Subject(subject, load_scene(name))))
        except NotTriedError as error:
            untried.append(f"{name}: {error}")
            continue
        except Exception as error:  # whatever an engine raises breaks the clause
            found = [_raised(error)]
        if found:
            breaches += [f"{name}: {text}" if clause.of_scenes else text for text in found]
        else:
            held.append(name)
        if not clause.of_scenes:
            break
    return Ruling(clause.id, tuple(held), tuple(breaches), tuple(untried))


def _raised(error: Exception) -> str:
    """What an engine raised where it should not."""
    if isinstance(error, BrokenContractError):
        return error.fault
    return str(error) if isinstance(error, EngineError) else f"raised {failure(error)}"


def refuses_all(rulings: Sequence[Ruling]) -> bool:
    """Whether nothing could be tried: no clause is held, or the scene itself was tried nowhere."""
    by_id = {ruling.id: ruling.answer for ruling in rulings}
    return by_id.get(THE_SCENE) == "not tried" or set(by_id.values()) == {"not tried"}


def put_to_all(
    name: str,
    clauses: Sequence[str],
    jobs: int,
    limits: Limits,
    done: Callable[[Ruling], None] = lambda _: None,
) -> list[Ruling]:
    """What comes of clauses, by their ids, in that order; ``done`` hears of each as it ends."""
    results: dict[int, Ruling] = {}
    with closing(as_they_end(partial(_apart, name), clauses, jobs, limits)) as ends:
        for index, result in ends:
            results[index] = result
            done(result)
    return [results[index] for index in range(len(clauses))]


def named(name: str, limits: Limits) -> tuple[str, str]:
    """What an engine calls itself, and its version, looked for in a process apart.

    Raises
    ------
    CrankcheckError
        An engine that is not there, or none; one that hangs, or ends its process, when it is
        imported.
    """
    with closing(Isolated[tuple[str, str]](limits)) as child:
        answer = child.call(_name_and_version, name)
    if not isinstance(answer, Lost):
        return answer
    if answer.error is not None:
        raise answer.error
    raise EngineError(
        f"engine {name}: it can not be imported and asked for its version: {answer.reason}; mend "
        "that first"
    )


def _name_and_version(name: str) -> tuple[str, str]:
    adapter = engine(name)
    return adapter.name, adapter.version()


def by_name(name: str, clause: str) -> Ruling:
    """As `put_to`, in a process that knows neither the engine nor the clause."""
    return put_to(engine(name), CLAUSES[clause])


def _apart(name: str, child: Isolated[Ruling], clause: str) -> Ruling:
    answer = child.call(by_name, name, clause)
    if isinstance(answer, Lost):
        return Ruling(clause, breaches=(answer.reason,))
    return answer
