"""pymunk's settings: the two profiles."""

from __future__ import annotations

from sim.engine import Profile, Setting, Settings, SettingValue
from sim.settings import check_choices, check_ranges

AS_SHIPPED = Profile(
    "as-shipped",
    "pymunk",
    "pymunk's own defaults",
    {
        "iterations": Setting(10, "default"),
        "error_bias": Setting(
            0.0017970074436457143,
            "default, (1 - 0.1f)^60: a joint error loses 10 % in 1/60 s, so errors fall as dt",
        ),
        "damping": Setting(1.0, "default: none"),
        "lines": Setting("groove", "points on lines run in pymunk's groove joints"),
        "springs": Setting("native", "springs are pymunk's DampedSpring and DampedRotarySpring"),
    },
)
TUNED = Profile(
    "tuned",
    "pymunk",
    "Joint errors removed within the step",
    {
        "iterations": Setting(
            150,
            "error_bias matters only as far as the iteration converges: with 100 the heavy ram of "
            "scene shaper breaks away at steps below 1/5000 turn, with 130 it holds; 14 of the 18 "
            "shipped scenes need 20 at most (`crankcheck tune`), a quarter of the cost; a chain "
            "of segments is given what it needs, iterations_of_segments",
        ),
        "error_bias": Setting(0.0, "remove the whole joint error in one step: errors fall as dt^2"),
        "damping": Setting(1.0, "none"),
        "lines": Setting(
            "exact",
            "a groove lets the sliding speed leak across the line unless the pushed bodies cannot "
            "turn; there a pin joint with a moving end holds the point (see sim.pymunk.rail)",
        ),
        "springs": Setting(
            "forces",
            "pymunk's own springs pull as these do, but what they damp is the velocity before the "
            "joints have corrected it, so errors of dampers fall as dt: of a slider-crank that one "
            "brings to rest in 10 s the crank is off by 1.0e-3 rad at 1 ms, and by 3.9e-5 rad with "
            "forces of the end of each step, whose errors fall as dt^2; those explode where "
            "damping over mass exceeds 1 / dt, which pymunk's own never do",
        ),
    },
)


RANGES = {
    "iterations": (1, 1_000_000),
    "error_bias": (0.0, 1.0),
    "damping": (0.0, 1.0),
}
"""What Chipmunk takes; outside of it some values end the process."""


def checked(settings: Settings) -> None:
    """Refuse values that Chipmunk does not take. Raises SettingError."""
    check_choices(settings, {"lines": ("groove", "exact"), "springs": ("native", "forces")})
    check_ranges(settings, RANGES)


def held_iterations(settings: Settings, given: int, found: int) -> dict[str, SettingValue]:
    """The iterations that a space was ``found`` with, as settings: where it has those that a chain
    of segments was ``given`` (`sim.pymunk.convergence`), they stand beside those asked for."""
    asked = int(settings["iterations"])
    if found == given > asked:
        return {"iterations": asked, "iterations_of_segments": found}
    return {"iterations": found}


def in_seconds(settings: Settings) -> tuple[str, ...]:
    """What is a loss in a second, whatever the speed: a bias or a damping, but for those that take
    all at once, or nothing."""
    biased, damped = settings["error_bias"] not in (0.0, 1.0), settings["damping"] != 1.0
    return ("error_bias",) * biased + ("damping",) * damped


def exact_lines(settings: Settings) -> bool:
    """Whether points on lines are held exactly."""
    return settings["lines"] == "exact"


def springs_as_forces(settings: Settings) -> bool:
    """Whether springs are forces of the end of each step, and not pymunk's own."""
    return settings["springs"] == "forces"
