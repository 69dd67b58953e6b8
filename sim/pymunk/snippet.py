"""pymunk settings as Python."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping, Sequence

from sim.engine import Drive, Settings
from sim.pymunk.settings import AS_SHIPPED
from sim.snippets import SnippetWriter

WIDTH = 96
DRIVES: Mapping[Drive, str] = {
    "prescribed": "Drive: the crank is a kinematic body with its origin on its pivot and a "
    "constant angular_velocity; the others start with the velocities that go with it.",
    "servo": "Drive: a SimpleMotor between the crank and the ground, rate = speed.",
    "free": "",
}
"""How the crank of the measured runs was driven."""


def pymunk_snippet(
    settings: Settings, steps_per_turn: float, period_s: float, drive: Drive, head: Sequence[str]
) -> str:
    """Lines that act on variables ``space`` and ``joints``, and make the space's next step.

    The bias of the mechanism's own joints, and the iterations and step, which can only be the
    whole space's. What else differs from pymunk's defaults would change the rest of a user's space
    and stands in a comment; see `sim.snippets.snippet`.
    """
    defaults = {name: setting.value for name, setting in AS_SHIPPED.settings.items()}
    complete = defaults | dict(settings)
    lines = _comment(head)
    if complete["error_bias"] != defaults["error_bias"]:
        lines += [
            "for joint in joints:  # those that hold the mechanism together, and no others",
            f"    joint.error_bias = {float(complete['error_bias'])!r}",
        ]
    lines += _comment(_notes(complete, defaults))
    if (iterations := int(complete["iterations"])) > int(defaults["iterations"]):
        lines.append(
            f"space.iterations = max(space.iterations, {iterations})  # the whole space's, "
            "contacts' too"
        )
    speed = 2.0 * math.pi / period_s
    lines += [
        *_alone(complete, defaults),
        f"dt = {period_s / steps_per_turn!r}  # 2 pi / ({steps_per_turn:g} speed), here for a "
        f"crank at {speed:.6g} rad/s",
        f"space.step(dt)  # {steps_per_turn:g} times a turn; steps all that the space holds",
        *_comment([DRIVES[drive]]),
    ]
    return "\n".join(lines) + "\n"


def _notes(complete: Settings, defaults: Settings) -> list[str]:
    """How lines are held, and what limits the promise."""
    notes = []
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


def _alone(complete: Settings, defaults: Settings) -> list[str]:
    """Settings of the measured runs that are for a space of nothing but the mechanism."""
    lines = []
    if int(complete["iterations"]) < int(defaults["iterations"]):
        lines.append(f"#   space.iterations = {complete['iterations']!r}")
    if complete["damping"] != defaults["damping"]:
        lines.append(f"#   space.damping = {complete['damping']!r}")
    title = "ONLY TO MEASURE AS WE DID, in a space with nothing else in it:"
    return [*_comment([title]), *lines] if lines else []


def _comment(paragraphs: Sequence[str]) -> list[str]:
    lines: list[str] = []
    for paragraph in paragraphs:
        lines += [
            f"# {line}" for line in textwrap.wrap(paragraph, WIDTH - 2, break_on_hyphens=False)
        ]
    return lines


SNIPPET = SnippetWriter("python", pymunk_snippet)
