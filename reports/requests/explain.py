"""`crankcheck explain`: a rule, a clause of the contract, or one cell and its error by part."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated

from rich.console import Console

from models.errors import CrankcheckError, cut, nearest
from models.files.reading import every_shipped, is_there
from reports.compare.errors import Error, Errors
from reports.judge.cell import examined
from reports.judge.halving import worst_place
from reports.judge.known import known_of, marked
from reports.judge.rules import RULES
from reports.judge.rules.rule import share
from reports.judge.three_steps import Convergence
from reports.output.console import hanging
from reports.output.numbers import error_text, floor_words, readable
from reports.requests.options import StepS, StepsPerTurn, argument, given, option
from reports.requests.verify import VerifyRequest, plan
from reports.verify.advised import remedied
from sim.engine import Run
from sim.engine.settings import profile_of
from sim.registry import engine

HELPS = {
    "drive": "prescribe the motion, or raise the gain of the servo",
    "model floor": "other settings of the engine; a shorter step does not help",
    "discretisation": "a shorter step, or an integrator of higher order",
    "closure": "stiffer joints, or more iterations",
    "sampling phase": "read velocities at their own instants, as they are compared here",
    "differencing": "take the engine's own rates, or a longer step",
}
"""What lowers each part of an error, and the errors beside it (docs/theory/errors.md)."""


@dataclass(frozen=True)
class ExplainRequest:
    what: Annotated[str, argument("WHAT", "A rule (CC110), a clause (EC52), or a scene.")]
    engine: Annotated[str | None, option("Engine that runs the scene.", "--engine")] = None
    profile: Annotated[str, option("Settings in which it runs.", "--profile")] = "tuned"
    dt_s: StepS = None
    steps_per_turn: StepsPerTurn = None

    def run(self, console: Console, progress: Console) -> int:
        """Answer, and return 0. Raises CrankcheckError for an unknown rule, clause, scene or
        engine, and for a scene without an engine."""
        for head, text in self._of_name() or self._of_cell():
            hanging(console, f"{head}: ", text)
        return 0

    def _of_name(self) -> list[tuple[str, str]]:
        """Return the answer on a rule or a clause; empty for a scene."""
        from reports.contract.clauses import CLAUSES  # with the solvers

        name = self.what.upper()
        if name not in RULES and name not in CLAUSES:
            if self.what in every_shipped() or is_there(self.what):
                return []
            near = nearest(name, [*RULES, *CLAUSES]) or nearest(self.what, every_shipped())
            hint = f"did you mean {' or '.join(near)}?" if near else "see `crankcheck scenes`"
            raise CrankcheckError(f"{cut(self.what)!r}: no such rule, clause or scene; {hint}")
        for of_scene in given(self, "engine", "profile", "dt_s", "steps_per_turn"):
            raise CrankcheckError(f"{of_scene}: for a scene, and {name} is none; leave it out")
        of = RULES.get(name) or CLAUSES[name]
        why = CLAUSES[name].why if name in CLAUSES else RULES[name].explanation
        return [(name, of.title), ("why", why), *_limit(name), ("what helps", of.cure)]

    def _of_cell(self) -> Iterator[tuple[str, str]]:
        """Yield the verdict, the error by part, the limit that binds, and what to change."""
        if self.engine is None:
            raise CrankcheckError(f"--engine is missing: name the one that runs {self.what}")
        steps = self.dt_s, self.steps_per_turn
        cell = plan(VerifyRequest([self.what], [self.engine], [self.profile], *steps))[0]
        known = known_of(None, [self.what])
        checked, run = examined(cell)
        (checked,) = marked([remedied(checked)], known)
        yield "cell", f"{cell.label}, dt {cell.dt_s:.4g} s: {checked.verdict}"
        if checked.known:
            yield "known failure", checked.known_text
        worst = checked.errors and worst_place(checked.errors)
        if checked.status != "ok" or not (checked.errors and worst and run):
            yield "ended", f"{checked.status}: {checked.reason}"
            turns = [f"{each.rule}: {each.cure}" for each in checked.failures[:1] if each.cure]
        else:
            yield from _by_part(checked.errors, checked.convergence, worst, run)
            most = max(checked.findings, key=lambda each: each.taken if each.taken > 0.0 else 0.0)
            taken = f"{RULES[most.rule].title}, error / limit {readable(most.taken, 2)}"
            yield "limit that binds", f"{most.rule} {taken}: {most.text}"
            yield from _limit(most.rule)
            turns = [f"{most.rule}: {most.cure}"] * bool(most.cure)
        own, best = (profile_of(engine(cell.engine), name) for name in (cell.profile, "tuned"))
        turns += [
            f"profile tuned has {name} = {each.value}: {each.reason}"
            for name, each in best.settings.items()
            if own.values.get(name) != each.value
        ]
        if turns:
            yield "what to change", "\n".join(turns)


def _limit(name: str) -> list[tuple[str, str]]:
    """Return the reason of a rule's limit; empty without one."""
    tolerance = getattr(RULES.get(name), "tolerance", None)
    return [("limit", tolerance.reason)] if tolerance else []


def _by_part(
    errors: Errors, seen: Convergence | None, worst: Error, run: Run
) -> Iterator[tuple[str, str]]:
    """Yield the worst error of place with the parts whose sum it is, the largest first; then open
    pins, the instants of velocities, and what differencing adds to their error, which are not."""
    size = f"{error_text(worst.pure)} {share(worst)}"
    yield "error", f"{worst.quantity} of {worst.body} {size}, of which"
    place, parts = (worst.quantity, worst.body, "geometric"), dict[str, float]()
    rest = worst.pure
    for row in errors.rows:
        if (row.quantity, row.body, row.kind) == place:
            parts["drive"] = max(rest - row.pure, 0.0)
    rest -= sum(parts.values())
    if seen and math.isfinite(seen.floor):
        parts["model floor"] = min(seen.floor, rest)
    if seen:
        parts["discretisation"] = rest - parts.get("model floor", 0.0)
    for part in sorted(parts, key=parts.__getitem__, reverse=True):
        yield f"  {part} {error_text(parts[part])}", HELPS[part]
    if seen:
        unseen = floor_words(math.nan, seen.error[-1]) if seen.trend == "shrinks" else ""
        yield "when the step is halved", "; ".join(filter(None, [seen.words, unseen]))
    yield "no part of it", "other quantities, each on a scale of its own"
    gap, own = errors.worst("gap"), errors.worst("velocity")
    differenced = errors.worst("velocity", "differenced")
    if gap:
        yield f"  closure {error_text(gap.pure)} {share(gap)}", HELPS["closure"]
    if run.velocity_time_s is not None and run.motion:
        late = (run.velocity_time_s - run.motion.time_s)[-1] / run.dt_s
        yield f"  sampling phase {late:+.2g} steps", HELPS["sampling phase"]
    if own and differenced:
        more = error_text(max(differenced.pure - own.pure, 0.0))
        yield f"  differencing {more} {share(own)}", HELPS["differencing"]
