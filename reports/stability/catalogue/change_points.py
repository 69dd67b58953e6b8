"""Four-bars that become flat, or nearly: where the linkage could go on in two ways."""

from __future__ import annotations

from models.hard import fourbar
from reports.stability.case import Case, Trial

GROUP = "change points"
SOURCE = "Grashof's rule; the parallelogram and the kite are its limiting cases"
STEPS = (5760.0, 1440.0, 360.0, 90.0)


def _excess(value: float) -> Trial:
    name = "nearly-parallelogram"
    return Trial(fourbar(name, 0.1, 0.3, 0.1 + value, 0.3, source=SOURCE))


def _parallelogram(value: float) -> Trial:
    scene = fourbar("parallelogram", 0.1, 0.3, 0.1, 0.3, source=SOURCE)
    return Trial(scene, steps_per_turn=value, turns=4.0)


def _kite(value: float) -> Trial:
    scene = fourbar("kite", 0.1, 0.1, 0.3, 0.3, source=SOURCE)
    return Trial(scene, steps_per_turn=value, turns=4.0)


CASES = (
    Case(
        name="grashof-excess",
        group=GROUP,
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
        name="parallelogram",
        group=GROUP,
        title="Parallelogram through its flat positions",
        source=SOURCE,
        truth="the coupler keeps its direction, by smooth continuation",
        expected="goes on smoothly: inertia carries it through",
        parameter="steps in a turn",
        unit="",
        values=STEPS,
        trial=_parallelogram,
    ),
    Case(
        name="kite",
        group=GROUP,
        title="Kite through its flat positions",
        source=SOURCE,
        truth="A and C stay mirror images in the line BD, by smooth continuation",
        expected="goes on smoothly: inertia carries it through",
        parameter="steps in a turn",
        unit="",
        values=STEPS,
        trial=_kite,
    ),
)
