"""pymunk's settings: the two profiles."""

from sim.engine import Profile, Setting, Settings
from sim.engine.settings import checker

AS_SHIPPED = Profile(
    "as-shipped",
    "pymunk",
    "pymunk's own defaults",
    {
        "iterations": Setting(10, "default"),
        "error_bias": Setting(
            0.0017970074436457143,
            "default, (1 - 0.1f)^60: a joint error loses 10 % in 1/60 s, so errors shrink as dt",
        ),
        "damping": Setting(1.0, "default: none"),
        "lines": Setting("groove", "points on lines run in pymunk's groove joints"),
        "springs": Setting("native", "springs are pymunk's DampedSpring and DampedRotarySpring"),
        "free_paths": Setting("chords", "default: joints are closed along the tangents of a step"),
    },
)
TUNED = Profile(
    "tuned",
    "pymunk",
    "Joint errors removed within the step",
    {
        "iterations": Setting(
            150,
            "error_bias matters only as far as the iteration converges: with 100 the heavy ram "
            "of scene shaper breaks away at steps below 1/5000 turn, with 130 it holds; 14 of "
            "the 18 shipped scenes need 20 at most (`crankcheck tune`), a quarter of the cost; "
            "a chain of segments gets what it needs, iterations_of_segments",
        ),
        "error_bias": Setting(
            0.0, "remove the whole joint error in one step: errors shrink as dt^2"
        ),
        "damping": Setting(1.0, "none"),
        "lines": Setting(
            "exact",
            "a groove lets the sliding speed leak across the line unless the pushed bodies cannot "
            "turn; there a pin joint with a moving end holds the point (see sim.pymunk.space)",
        ),
        "springs": Setting(
            "forces",
            "pymunk's own springs pull like these, but damp the velocity before the joints have "
            "corrected it, so errors of dampers shrink as dt: of a slider-crank that one brings "
            "to rest in 10 s the crank is off by 1.0e-3 rad at 1 ms, and by 3.9e-5 rad with "
            "forces of the end of each step, whose errors shrink as dt^2; these explode if "
            "damping over mass exceeds 1 / dt, which pymunk's own never do",
        ),
        "free_paths": Setting(
            "arcs",
            "in free motion pins are closed for the arcs of their points (see sim.pymunk.arcs): "
            "a four-bar that whirls through its limits for 10 s at 1 ms has an error of place "
            "at the same crank angle of 3e-5 instead of 1e-3, a drift of energy of 4e-5 instead "
            "of 7e-3; not in chains of segments",
        ),
    },
)
RANGES = {"iterations": (1, 1_000_000), "error_bias": (0.0, 1.0), "damping": (0.0, 1.0)}
"""Ranges in Chipmunk; some values outside of them end the process."""
CHOICES = {
    "lines": ("groove", "exact"),
    "springs": ("native", "forces"),
    "free_paths": ("chords", "arcs"),
}
checked = checker(CHOICES, RANGES)


def in_seconds(settings: Settings) -> tuple[str, ...]:
    """Return the settings that are a loss in a second, at any speed: a bias or a damping, unless it
    takes all at once, or nothing."""
    biased, damped = settings["error_bias"] not in (0.0, 1.0), settings["damping"] != 1.0
    return ("error_bias",) * biased + ("damping",) * damped
