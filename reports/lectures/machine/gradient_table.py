"""`sensitivity --engine`: derivatives of engines beside those of the reference, as a table."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from rich.console import Console

from analytic.gradients.dimensions import dimensions
from models.errors import CrankcheckError, nearest, shown
from models.scene import Scene
from reports.lectures.machine.effects import followed
from reports.lectures.machine.engine_gradients import (
    TOLERANCE,
    EngineGradient,
    Question,
)
from reports.output.console import grid, say
from reports.output.numbers import readable, short
from reports.plan.requirements import chosen_engines
from sim.registry import engine

MOST_STEPS = 100_000
"""Steps that are differentiated at most."""


def asked(
    scene: Scene, of: str, by: Sequence[str], steps: str, per_turn: float, start_deg: float | None
) -> Question:
    """Return the question of a request. Raises CrankcheckError."""
    if scene.is_free or scene.elastic:
        raise CrankcheckError(f"{scene.name}: engines are compared with a driver, all links rigid")
    if start_deg is not None:
        scene = started(scene, start_deg)
    dt_s = scene.driver.law.period_s / per_turn
    names = tuple(by or dimensions(scene))
    return Question(scene, names, numbers_of(steps), dt_s, followed(scene, of))


def started(scene: Scene, angle_deg: float) -> Scene:
    """Return the scene with its driver at an angle at the start. Raises CrankcheckError."""
    if scene.driver.slider is not None:
        raise CrankcheckError(f"--start-deg: {scene.name} is driven at a slider; leave it out")
    if not math.isfinite(angle_deg):
        raise CrankcheckError(f"--start-deg: found {angle_deg:g}; give an angle in degrees")
    law = scene.driver.law
    ahead = math.radians(angle_deg) - float(law.at(np.zeros(1))[0][0])
    return replace(scene, driver=replace(scene.driver, law=law.turned(ahead)))


def numbers_of(text: str) -> tuple[int, ...]:
    """Return numbers of steps in rising order. Raises CrankcheckError."""
    try:
        found = sorted({int(part) for part in text.split(",")})
    except ValueError:
        found = [0]
    if found[0] < 1 or found[-1] > MOST_STEPS:
        raise CrankcheckError(
            f"--steps {shown(text)}: write whole numbers from 1 to {MOST_STEPS}, such as 1,10,100"
        )
    return tuple(found)


def chosen(engines: Sequence[str], profiles: Sequence[str]) -> list[tuple[str, str]]:
    """Return the engines with those of the profiles that they have; `tuned` by default. Raises
    EngineError, and CrankcheckError for a profile that none of them has."""
    names = chosen_engines(engines)
    every = {name: list(engine(name).profiles) for name in names}
    have = list(dict.fromkeys(profile for own in every.values() for profile in own))
    for profile in profiles:
        if profile not in have:
            near = nearest(profile, have, 2) or have
            raise CrankcheckError(f"--profile {profile!r}: did you mean {' or '.join(near)}?")
    wanted = tuple(profiles) or ("tuned",)
    return [(name, p) for name, own in every.items() for p in wanted if p in own]


def show(console: Console, question: Question, found: Sequence[EngineGradient]) -> None:
    """Print the comparison."""
    scene = question.scene
    turn = scene.driver.law.period_s / question.dt_s
    say(
        console,
        f"{scene.name}: derivatives of engines by {', '.join(question.names)}, {turn:g} steps in a "
        "turn\n",
    )
    heads = ["engine", "profile", "method", "steps:", "error:", "largest by", "angle deg:"]
    heads += ["order:"] * any(one.finer is not None for one in found)
    heads.append("finding")
    cells = []
    for one in found:
        for row in one.rows():
            line = [one.engine, one.profile, one.method, str(row["steps"])]
            line += [short(row["error"]), row["dimension"], angle_text(row["angle_rad"])]
            if "order:" in heads:
                line.append("" if math.isnan(row["order"]) else f"{row['order']:.2f}")
            marks = ["OUT"] * (not row["within"]) + row["findings"]
            cells.append([*line, "; ".join(marks)])
    console.print(grid(heads, cells, whole=("engine", "profile", "method"), wraps=True))
    say(console, "")
    sizes = map(readable, question.sizes.tolist())
    say(
        console,
        f"Error: over the largest derivative of the reference, {', '.join(sizes)} after these "
        f"steps; at most {TOLERANCE:g}. Angle: between the gradients of {question.of}.",
    )
    for one in found:
        if one.refusal:
            what = f"{one.label}, {one.method}" if one.method else one.label
            say(console, f"Not differentiable: {what}: {one.refusal}.")
    if np.isnan(question.truth).any():
        say(console, "Left out: derivatives of the reference that are not certain.")


def angle_text(angle_rad: float) -> str:
    """Return an angle [rad] in degrees, "none" for the gradient of zero."""
    return "none" if math.isnan(angle_rad) else readable(math.degrees(angle_rad), 2)


def document(question: Question, found: Sequence[EngineGradient]) -> Mapping[str, object]:
    """Return the comparison as the data of a JSON file."""
    return {
        "scene": question.scene.name,
        "of": question.of,
        "dimensions": list(question.names),
        "dt_s": question.dt_s,
        "tolerance": TOLERANCE,
        "rows": [row for one in found for row in one.rows()],
        "not_differentiable": [
            {
                "engine": one.engine,
                "profile": one.profile,
                "method": one.method,
                "reason": one.refusal,
            }
            for one in found
            if one.refusal
        ],
        "within": all(one.within for one in found),
    }
