"""pymunk settings as Python."""

from collections.abc import Mapping, Sequence

from sim.engine import Drive, Settings
from sim.pymunk.settings import AS_SHIPPED
from sim.registry.offers import SnippetWriter, Stepping, alone, comment

DRIVES: Mapping[Drive, str] = {
    "prescribed": "Drive: the crank is a kinematic body with its origin on its pivot and a "
    "constant angular_velocity; the others start with matching velocities.",
    "servo": "Drive: a SimpleMotor between the crank and the ground, rate = speed.",
    "free": "Drive: none. Every link is a dynamic body, the crank pinned to the ground as well. "
    "Positions are those of the start, velocities those of half a step later, v + a dt / 2 "
    "and omega + alpha dt / 2; with those of the start itself errors shrink as dt. Loads "
    "are set before each step, with the size and the place of its end.",
}
"""Drive of the crank in the measured runs."""
OF_FREE = {
    ("springs", "forces"): (
        "Dampers: not those of DampedSpring and DampedRotarySpring, but forces set before each "
        "step, from the lengths at its end (crankcheck, sim/pymunk/bodies.py). Springs "
        "without damping need nothing of the kind."
    ),
    ("free_paths", "arcs"): (
        "Pins: where error_bias is 0, anchors are set before each step for the arcs that they "
        "go in it (crankcheck, sim/pymunk/arcs.py). Without that errors still shrink as dt^2, "
        "but those of places at the same crank angle are 10 to 400 times as large."
    ),
}
"""Notes on free motion, by the setting that needs them."""


def pymunk_snippet(
    complete: Settings, defaults: Settings, stepping: Stepping, drive: Drive, head: Sequence[str]
) -> list[str]:
    """Write lines that act on variables ``space`` and ``joints``, and make the space's next step,
    or all of a frame.

    The bias of the mechanism's own joints, and the iterations and step, which can only be the whole
    space's. Other differences from pymunk's defaults would change the rest of a user's space and
    are in a comment; see `sim.registry.offers.snippet`.
    """
    lines = comment(*head)
    if complete["error_bias"] != defaults["error_bias"]:
        lines += [
            "for joint in joints:  # those that hold the mechanism together, and no others",
            f"    joint.error_bias = {float(complete['error_bias'])!r}",
        ]
    lines += comment(*_notes(complete, defaults, drive))
    only = []
    iterations = int(complete["iterations"])
    if iterations > int(defaults["iterations"]):
        most = f"space.iterations = max(space.iterations, {iterations})"
        lines.append(f"{most}  # the whole space's, contacts' too")
    elif iterations < int(defaults["iterations"]):
        only.append(f"space.iterations = {complete['iterations']!r}")
    if complete["damping"] != defaults["damping"]:
        only.append(f"space.damping = {complete['damping']!r}")
    lines += comment(*alone("space", only))
    return [*lines, *_steps(stepping, drive), *comment(DRIVES[drive])]


def _steps(stepping: Stepping, drive: Drive) -> list[str]:
    counted = stepping.counted_in(drive)
    if counted == "nothing":
        return [f"dt = {stepping.dt_s!r}", "space.step(dt)  # steps all that the space holds"]
    per_turn, number = stepping.per_turn, stepping.substeps
    if counted == "turns":
        return [
            f"dt = {stepping.dt_s!r}  # 2 pi / ({per_turn} speed), here for a crank at "
            f"{stepping.speed}",
            f"space.step(dt)  # {per_turn} times a turn; steps all that the space holds",
        ]
    return [
        f"dt = {stepping.dt_s!r}  # a frame of {stepping.frame}" + f" / {number}" * (number > 1),
        f"for _ in range({number}):  # in every frame; steps all that the space holds",
        "    space.step(dt)",
        *comment(stepping.scaled_in_frames("these steps") + "."),
    ]


def _notes(complete: Settings, defaults: Settings, drive: Drive) -> list[str]:
    """Write notes on lines and, for free motion, springs; and on the limits of the errors."""
    notes = []
    if complete["lines"] == "exact":
        notes.append(
            "Points on lines: where a push turns the sliding body or its guide, not GrooveJoint "
            "but a PinJoint whose far end moves along with the point (crankcheck, "
            "sim/pymunk/space.py). "
            "Loops of pins need nothing of the kind."
        )
    if drive == "free":
        notes += [note for choice, note in OF_FREE.items() if choice in complete.items()]
    if complete["error_bias"] == defaults["error_bias"]:
        notes.append(
            "error_bias is a loss in a second, whatever the speed: errors are those of the speeds "
            "at which they were measured."
        )
    return notes


SNIPPET = SnippetWriter("python", AS_SHIPPED, pymunk_snippet)
