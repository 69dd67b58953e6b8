"""pymunk settings as Python."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence

from sim.engine import Drive, Settings
from sim.pymunk.settings import AS_SHIPPED
from sim.snippets import SnippetWriter

WIDTH = 96


def pymunk_snippet(
    settings: Settings, steps_per_turn: float, period_s: float, drive: Drive, head: Sequence[str]
) -> str:
    """Lines that act on a variable ``space``, and make its next step.

    Only what differs from pymunk's defaults; see `sim.snippets.snippet`.
    """
    defaults = {name: setting.value for name, setting in AS_SHIPPED.settings.items()}
    complete = defaults | dict(settings)
    speed = 2.0 * math.pi / period_s
    chosen = [name for name in ("iterations", "damping") if complete[name] != defaults[name]]
    lines = [*_comment(head), *(f"space.{name} = {complete[name]!r}" for name in chosen)]
    if complete["error_bias"] != defaults["error_bias"]:
        lines += [
            "for joint in space.constraints:  # once all joints have been added",
            f"    joint.error_bias = {float(complete['error_bias'])!r}",
        ]
    lines += [
        f"dt = {period_s / steps_per_turn!r}  # 2 pi / ({steps_per_turn:g} speed), here for a "
        f"crank at {speed:.6g} rad/s",
        f"space.step(dt)  # {steps_per_turn:g} times a turn",
    ]
    return "\n".join([*lines, *_comment(_notes(complete, defaults, drive))]) + "\n"


def _notes(complete: Settings, defaults: Settings, drive: Drive) -> list[str]:
    """How the crank is driven, how lines are held, and what limits the promise."""
    if drive == "servo":
        notes = ["Drive: a SimpleMotor between the crank and the ground, rate = speed."]
    else:
        notes = [
            "Drive: the crank is a kinematic body with its origin on its pivot and a constant "
            "angular_velocity; the others start with the velocities that go with it."
        ]
    if complete["lines"] == "exact":
        notes.append(
            "Points on lines: where a push turns the sliding body or its guide, not GrooveJoint "
            "but a PinJoint whose far end moves along with the point (crankcheck, "
            "sim/pymunk/rail.py). "
            "Loops of pins need nothing of the kind."
        )
    if complete["error_bias"] == defaults["error_bias"]:
        notes.append(
            "error_bias is a loss in a second, whatever the speed: errors are those of the speeds "
            "at which they were measured."
        )
    return notes


def _comment(paragraphs: Sequence[str]) -> list[str]:
    lines: list[str] = []
    for paragraph in paragraphs:
        lines += [
            f"# {line}" for line in textwrap.wrap(paragraph, WIDTH - 2, break_on_hyphens=False)
        ]
    return lines


SNIPPET = SnippetWriter("python", pymunk_snippet)
