"""Check an engine against the clauses, each in a process apart: a crash costs its clause alone."""

from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from typing import Literal

from rich.console import Console
from rich.padding import Padding
from rich.text import Text

from models.errors import EngineError, few, harmless
from models.files.reading import load_scene
from reports.contract.clauses import CLAUSES
from reports.contract.subject import Clause, NotTriedError, Subject
from reports.output.numbers import count
from reports.workers.isolated import Isolated, Limits, Lost, as_they_end, in_order
from sim.engine import Engine
from sim.own_engine.watched import BrokenContractError, failure
from sim.registry import engine

SCENES = (
    "fourbar-lecture-1",
    "sixbar-watt",
    "slider-crank-offset",
    "slotted-lever",
    "shaper",
    "scotch-yoke",
)
"""One scene of each kind of joint; the first applies to every engine."""
THE_SCENE = "EC21"
"""The clause that a session is the scene: if no scene holds it, the others have no session."""
Answer = Literal["held", "broken", "not tried"]


@dataclass(frozen=True)
class Ruling:
    """Result of a clause: the scenes that hold it, its breaches, and reasons for no trial on
    others."""

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
    """Return the ruling on a clause for an engine."""
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
    if isinstance(error, BrokenContractError):
        return error.fault
    return str(error) if isinstance(error, EngineError) else f"raised {failure(error)}"


def refuses_all(rulings: Sequence[Ruling]) -> bool:
    """True if nothing could be tried: no clause is held, or the scene itself was tried nowhere."""
    by_id = {ruling.id: ruling.answer for ruling in rulings}
    return by_id.get(THE_SCENE) == "not tried" or set(by_id.values()) == {"not tried"}


def put_to_all(
    name: str,
    clauses: Sequence[str],
    jobs: int,
    limits: Limits,
    done: Callable[[Ruling], None] = lambda _: None,
) -> list[Ruling]:
    """Return the rulings on clauses, by their ids, in that order; ``done`` gets each as it ends."""
    return in_order(as_they_end(partial(_apart, name), clauses, jobs, limits), done)


def named(name: str, limits: Limits) -> tuple[str, str]:
    """Return an engine's own name and its version, determined in a process apart.

    Raises CrankcheckError for a missing or invalid engine; one that hangs, or ends its process,
    when it is imported.
    """
    with closing(Isolated[tuple[str, str]](limits)) as child:
        answer = child.call(_name_and_version, name)
    if not isinstance(answer, Lost):
        return answer
    if answer.error is not None:
        raise answer.error
    raise EngineError(
        f"engine {name}: importing it and reading its version failed: {answer.reason}; correct "
        "that first"
    )


def _name_and_version(name: str) -> tuple[str, str]:
    adapter = engine(name)
    return adapter.name, adapter.version()


def by_name(name: str, clause: str) -> Ruling:
    """Return `put_to`, in a process that knows neither the engine nor the clause."""
    return put_to(engine(name), CLAUSES[clause])


def _apart(name: str, child: Isolated[Ruling], clause: str) -> Ruling:
    answer = child.call(by_name, name, clause)
    if isinstance(answer, Lost):
        return Ruling(clause, breaches=(answer.reason,))
    return answer


MARKS = {"held": ("ok ", "green"), "broken": ("OUT", "bold red"), "not tried": ("-  ", "dim")}
BREACHES = 4
"""Number of breaches of a clause that are listed; the others are counted."""
INDENT = 10


def show(console: Console, called: str, rulings: Sequence[Ruling], scenes: Sequence[str]) -> None:
    """Print a line for each clause; below it its breaches, reason and cure."""
    for ruling in rulings:
        mark, style = MARKS[ruling.answer]
        line = Text(f"{mark} {ruling.id}  ", style)
        line.append(ruling.clause.title, "" if ruling.answer == "held" else style)
        console.print(line, highlight=False)
        for text in _below(ruling):
            below = Text(harmless(text), "dim" if ruling.answer == "not tried" else "")
            console.print(Padding(below, (0, 0, 0, INDENT)), highlight=False)
    console.print()
    console.print(_verdict(called, rulings), highlight=False)
    if held := [name for name in scenes if any(name in ruling.scenes for ruling in rulings)]:
        console.print(f"Tried on {', '.join(held)}.", style="dim", highlight=False)
    for text in _refused(rulings, scenes):
        console.print(Text(harmless(text), "dim"), highlight=False)


def _below(ruling: Ruling) -> list[str]:
    if ruling.answer == "held":
        return []
    if ruling.answer == "not tried":
        return list(dict.fromkeys(text.partition(": ")[2] for text in ruling.untried))[:1]
    lines = [*ruling.breaches[:BREACHES]]
    if left := len(ruling.breaches) - len(lines):
        lines.append(f"and {left} more")
    return [*lines, f"why: {ruling.clause.why}", f"cure: {ruling.clause.cure}"]


def _verdict(called: str, rulings: Sequence[Ruling]) -> Text:
    broken = [ruling.id for ruling in rulings if ruling.answer == "broken"]
    held = sum(ruling.answer == "held" for ruling in rulings)
    if broken:
        told = f"{count(len(broken), 'clause')} of {len(rulings)}: {few(broken, 8)}"
        return Text(f"BREAKS THE CONTRACT: {called}, {told}", "bold red")
    if refuses_all(rulings):
        return Text(f"NOTHING COULD BE TRIED: {called} refuses every scene", "bold red")
    return Text(f"HOLDS THE CONTRACT: {called}, {held} of {count(held, 'clause')}", "bold green")


def _refused(rulings: Sequence[Ruling], scenes: Sequence[str]) -> list[str]:
    """Return the scenes on which no clause could be tried, with the reasons."""
    tried = {name for ruling in rulings for name in ruling.scenes}
    tried |= {text.partition(": ")[0] for ruling in rulings for text in ruling.breaches}
    reasons: dict[str, str] = {}
    for ruling in rulings:
        for text in ruling.untried:
            name, _, why = text.partition(": ")
            if name not in tried:
                reasons.setdefault(name, why)
    return [f"Refused: {name}: {reasons[name]}" for name in scenes if name in reasons]
