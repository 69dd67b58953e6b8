"""`crankcheck explain`: a rule, a clause of the contract, or one cell and its error by part."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
from rich.console import Console

from models.errors import CrankcheckError, cut, nearest
from models.files.reading import every_shipped, is_there
from models.motion import Motion
from reports.compare.compare import Beside
from reports.compare.errors import Error, Errors
from reports.judge.cell import Cell, examined
from reports.judge.halving import worst_place
from reports.judge.rules import RULES
from reports.judge.rules.rule import share
from reports.judge.three_steps import Convergence
from reports.output.console import hanging
from reports.output.formats import json_text
from reports.output.numbers import error_text, floor_words, readable
from reports.output.write import Outputs
from reports.requests.options import StepS, StepsPerTurn, argument, given, option
from reports.requests.verify import VerifyRequest, plan
from reports.verify.advised import advised
from sim.engine.settings import profile_of
from sim.registry import engine

HELPS = {
    "drive": "prescribe the motion, or raise the gain of the servo",
    "closure": "stiffer joints, or more iterations",
    "model floor": "other settings of the engine; a shorter step does not help",
    "discretisation": "a shorter step, or an integrator of higher order",
    "sampling phase": "read velocities at their own instants, as they are compared here",
    "differencing": "take the engine's own rates, or a longer step",
}
"""What lowers each part of an error (docs/theory/errors.md)."""
ADDED = ("drive", "model floor", "discretisation")
"""Parts whose sum is the error of a place; the others have scales of their own."""


@dataclass(frozen=True)
class ExplainRequest:
    what: Annotated[str, argument("WHAT", "A rule (CC110), a clause (EC52), or a scene.")]
    engine: Annotated[str | None, option("Engine that runs the scene.", "--engine")] = None
    profile: Annotated[str, option("Settings in which it runs.", "--profile")] = "tuned"
    dt_s: StepS = None
    steps_per_turn: StepsPerTurn = None
    json: Annotated[Path | None, "Write the answer as JSON."] = None

    def run(self, console: Console, progress: Console) -> int:
        """Answer, and return 0. Raises CrankcheckError for an unknown rule, clause, scene or
        engine, and for a scene without an engine."""
        outputs = Outputs({"--json": self.json})
        outputs.check()
        answer = self._of_name() or self._of_cell()
        with outputs.written({"--json": lambda: json_text(answer)}):
            for head, text in answer.items():
                rows = text.items() if isinstance(text, Mapping) else ()
                for part, size in rows:
                    hanging(console, f"  {part} {error_text(size)}: ", HELPS[part])
                if not rows:
                    hanging(console, f"{head}: ", str(text))
        return 0

    def _of_name(self) -> dict[str, object]:
        """Return the answer on a rule or a clause; empty for a scene."""
        from reports.contract.clauses import CLAUSES  # with the solvers

        name, of_scene = self.what.upper(), [*given(self, "engine", "dt_s", "steps_per_turn")]
        if name not in RULES and name not in CLAUSES:
            if self.what in every_shipped() or is_there(self.what):
                return {}
            near = nearest(name, [*RULES, *CLAUSES]) or nearest(self.what, every_shipped())
            hint = f"did you mean {' or '.join(near)}?" if near else "see `crankcheck scenes`"
            raise CrankcheckError(f"{cut(self.what)!r}: no such rule, clause or scene; {hint}")
        if of_scene:
            raise CrankcheckError(f"{of_scene[0]}: for a scene, and {name} is none; leave it out")
        if name in CLAUSES:
            of = CLAUSES[name]
            return {"clause": f"{name} {of.title}", "why": of.why, "what helps": of.cure}
        rule = RULES[name]
        answer = {"rule": f"{name} {rule.title}", "why": rule.explanation}
        return answer | _limit(name) | {"what helps": rule.cure}

    def _of_cell(self) -> dict[str, object]:
        """Return the verdict, the error by part, the limit that binds, and what to change."""
        if self.engine is None:
            raise CrankcheckError(f"--engine is missing: name the one that runs {self.what}")
        steps = self.dt_s, self.steps_per_turn
        cell = plan(VerifyRequest([self.what], [self.engine], [self.profile], *steps))[0]
        checked, run = examined(cell)
        checked = advised(cell) if checked.failures else checked
        head, errors = f"{cell.label}, dt {cell.dt_s:.4g} s: {checked.verdict}", checked.errors
        beside, worst = run and cell.truth.beside(run), errors and worst_place(errors)
        if not (beside and errors and worst):
            return {"cell": f"{head}: {checked.reason}"}
        size = f"{worst.quantity} of {worst.body} {error_text(worst.pure)} {share(worst)}"
        answer: dict[str, object] = {"cell": head, "error": size}
        parts = answer["parts"] = _parts(errors, checked.convergence, beside, worst)
        added = {part: parts[part] for part in ADDED if parts.get(part, 0.0) > 0.0}
        largest = max(added, key=added.__getitem__, default="")
        turns = [f"{n} is the largest part of the error: {HELPS[n]}" for n in added if n == largest]
        if seen := checked.convergence:
            unseen = floor_words(math.nan, seen.error[-1]) if seen.trend == "shrinks" else ""
            answer["when the step is halved"] = "; ".join(filter(None, [seen.words, unseen]))
        if limited := [finding for finding in checked.findings if not math.isnan(finding.taken)]:
            worst_of = max(limited, key=lambda finding: finding.taken)
            title = f"{worst_of.rule} {RULES[worst_of.rule].title}"
            taken = f"error / limit {readable(worst_of.taken, 2)}"
            answer["limit that binds"] = f"{title}, {taken}: {worst_of.text}"
            answer |= _limit(worst_of.rule)
            turns += [f"{worst_of.rule}: {worst_of.cure}"] * bool(worst_of.cure)
        return answer | {"what to change": "\n".join([*turns, *_settings(cell)])}


def _limit(name: str) -> dict[str, object]:
    """Return the reason of a rule's limit; empty without one."""
    tolerance = getattr(RULES[name], "tolerance", None)
    return {"limit": tolerance.reason} if tolerance else {}


def _parts(
    errors: Errors, seen: Convergence | None, beside: Beside, worst: Error
) -> dict[str, float]:
    """Return the parts of the worst error of place, the gap of the pins, the change of velocities
    between their instants and those of the positions, and what differencing adds; pure."""
    parts, gap = dict[str, float](), errors.worst("gap")
    if errors.worst("drive") and beside.has_crank:
        parts["drive"] = _apart(beside, worst.quantity, beside.at_crank, worst.body)
    parts |= {"closure": gap.pure} if gap else {}
    if seen:
        floor = {"model floor": seen.floor} if math.isfinite(seen.floor) else {}
        parts |= floor | {"discretisation": max(worst.pure - sum(floor.values()), 0.0)}
    own, differenced = errors.worst("velocity"), errors.worst("velocity", "differenced")
    if own and differenced and beside.run.velocity_time_s is not None:
        logged = beside.truth.at(beside.run.velocity_time_s)
        parts["sampling phase"] = _apart(beside, "velocity", logged)
        parts["differencing"] = max(differenced.pure - own.pure, 0.0)
    return parts


def _apart(beside: Beside, quantity: str, other: Motion, body: str = "") -> float:
    """Return how far another reference is from that of a run, for a body, or for all; pure."""
    pairs = zip(*(beside.tracks([quantity], r) for r in (beside.reference, other)), strict=True)
    off = [np.abs(a.error - b.error) / a.scale for a, b in pairs if body in ("", a.body)]
    return max((float(np.max(each)) for each in off), default=math.nan)


def _settings(cell: Cell) -> list[str]:
    """Return the settings that profile tuned has otherwise, with their reasons; or its own."""
    own, best = (profile_of(engine(cell.engine), name) for name in (cell.profile, "tuned"))
    other = {k: each for k, each in best.settings.items() if own.values.get(k) != each.value}
    head, shown = "profile tuned has " * bool(other), other or best.settings
    return [f"{head}{name} = {each.value}: {each.reason}" for name, each in shown.items()]
