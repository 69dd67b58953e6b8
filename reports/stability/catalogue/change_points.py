"""Four-bars that become flat, or nearly: where the linkage could go on in two ways."""

from __future__ import annotations

from functools import partial

from models.hard import fourbar, triad_platform
from models.scene import Scene
from reports.stability.case import Case, Trial

SOURCE = "Grashof's rule; the parallelogram and the kite are its limiting cases"
TRIAD_CRANK_M = 0.06387509801
"""The longest crank of triad-platform that turns fully: at 239 deg two assemblies meet then."""
through = partial(Case, parameter="steps in a turn", values=(5760.0, 1440.0, 360.0, 90.0))
"""A case that goes on through its change points: its trials are of `four_turns`."""


def four_turns(scene: Scene, steps: float) -> Trial:
    """A trial of so many steps in a turn, long enough to be through every change point again."""
    return Trial(scene, steps_per_turn=steps, turns=4.0)


def _excess(margin_m: float) -> Trial:
    name = "nearly-parallelogram"
    return Trial(fourbar(name, 0.1, 0.3, 0.1 + margin_m, 0.3, source=SOURCE))


def _triad_excess(margin_m: float) -> Trial:
    name, source = "triad-nearly-singular", "scene triad-platform with a longer crank"
    return Trial(triad_platform(name, TRIAD_CRANK_M - margin_m, source=source))


def _parallelogram(steps: float) -> Trial:
    return four_turns(fourbar("parallelogram", 0.1, 0.3, 0.1, 0.3, source=SOURCE), steps)


def _kite(steps: float) -> Trial:
    return four_turns(fourbar("kite", 0.1, 0.1, 0.3, 0.3, source=SOURCE), steps)


CASES = (
    Case(
        name="grashof-excess",
        title="Nearly a parallelogram",
        source=SOURCE,
        truth="closed form; the coupler stays on its side at the flat positions",
        expected="stays on its branch, though the rocker whips past the flat position",
        parameter="Grashof margin p + q - s - l",
        unit="m",
        values=(1e-2, 1e-3, 1e-4, 1e-5, 1e-6),
        trial=_excess,
    ),
    Case(
        name="triad-excess",
        title="Class III group, two assemblies nearly meeting",
        source="triad-platform with a crank up to the longest that turns fully",
        truth="one assembly of six at most, followed with certainty past the one that comes near",
        expected="stays in its assembly, though the plate turns back sharply",
        parameter="longest crank that turns, less the crank",
        unit="m",
        values=(1e-2, 1e-3, 1e-4, 1e-5, 1e-6),
        trial=_triad_excess,
    ),
    through(
        name="parallelogram",
        title="Parallelogram through its flat positions",
        source=SOURCE,
        truth="the coupler keeps its direction, by smooth continuation",
        expected="goes on smoothly: inertia carries it through",
        trial=_parallelogram,
    ),
    through(
        name="kite",
        title="Kite through its flat positions",
        source=SOURCE,
        truth="A and C stay mirror images in the line BD, by smooth continuation",
        expected="goes on smoothly: inertia carries it through",
        trial=_kite,
    ),
)
