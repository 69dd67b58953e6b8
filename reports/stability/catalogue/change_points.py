"""Mechanisms that become flat, or nearly, where they could go on in two ways; and mechanisms with
redundant links, immobile by count."""

from functools import partial

import numpy as np

from analytic.free.exact_motions import ChainMotion
from models.scene import Scene, hard
from reports.stability.case import Case, Trial

GRASHOF = "Grashof's rule; the parallelogram and the kite are its limiting cases"
TRIAD_CRANK_M = 0.06387509801
"""Longest crank of triad-platform that turns fully: at 239 deg two assemblies meet then."""
through = partial(Case, parameter="steps in a turn", values=(5760.0, 1440.0, 360.0, 90.0))
"""Case that continues through its change points: its trials come from `four_turns`."""


def four_turns(scene: Scene, steps: float) -> Trial:
    """Return a trial of so many steps in a turn, long enough to pass every change point again."""
    return Trial(scene, steps_per_turn=steps, turns=4.0)


CHANGE_POINTS = (
    Case(
        name="grashof-excess",
        title="Nearly a parallelogram",
        source=GRASHOF,
        truth="closed form; the coupler stays on its side at the flat positions",
        expected="stays on its branch, though the rocker whips past the flat position",
        parameter="Grashof margin p + q - s - l",
        unit="m",
        values=(1e-2, 1e-3, 1e-4, 1e-5, 1e-6),
        trial=lambda margin_m: Trial(
            hard.fourbar("nearly-parallelogram", 0.1, 0.3, 0.1 + margin_m, 0.3, source=GRASHOF)
        ),
    ),
    Case(
        name="triad-excess",
        title="Class III group, two assemblies nearly meeting",
        source="triad-platform with a crank up to the longest that turns fully",
        truth="one assembly of at most six, followed with certainty past the one that comes near",
        expected="stays in its assembly, though the plate turns back sharply",
        parameter="longest crank that turns, less the crank",
        unit="m",
        values=(1e-2, 1e-3, 1e-4, 1e-5, 1e-6),
        trial=lambda margin_m: Trial(
            hard.triad_platform(
                "triad-nearly-singular",
                TRIAD_CRANK_M - margin_m,
                source="scene triad-platform with a longer crank",
            )
        ),
    ),
    through(
        name="parallelogram",
        title="Parallelogram through its flat positions",
        source=GRASHOF,
        truth="the coupler keeps its direction, by smooth continuation",
        expected="continues smoothly: inertia carries it through",
        trial=partial(
            four_turns, hard.fourbar("parallelogram", 0.1, 0.3, 0.1, 0.3, source=GRASHOF)
        ),
    ),
    through(
        name="kite",
        title="Kite through its flat positions",
        source=GRASHOF,
        truth="A and C stay mirror images in the line BD, by smooth continuation",
        expected="continues smoothly: inertia carries it through",
        trial=partial(four_turns, hard.fourbar("kite", 0.1, 0.1, 0.3, 0.3, source=GRASHOF)),
    ),
)


EXCEL = 'Paper "Phan tich dong hoc co cau tay quay con truot bang phan mem Excel"; carried on to 1'


SLIDER_CRANKS = (
    Case(
        name="short-rod",
        title="Rod hardly longer than the crank",
        source=EXCEL,
        truth="closed form; the rod swings past 90 deg faster and faster",
        expected="stays on its branch",
        parameter="L/R - 1",
        values=(0.25, 0.1, 0.05, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6),
        trial=lambda excess: Trial(
            hard.slider_crank("short-rod", 0.1, 0.1 * (1.0 + excess), source="L/R runs to 1")
        ),
    ),
    through(
        name="isosceles",
        title="Isosceles slider-crank, stroke 4R",
        source="L = R: the change point of the slider-crank",
        truth="the pin runs through the crank's pivot, x = 2 R cos(theta), by smooth continuation",
        expected="continues smoothly through the pivot",
        trial=partial(four_turns, hard.slider_crank("isosceles", 0.1, 0.1, source="L = R")),
    ),
)


CULISSE = 'Lecture "Phan tich dong hoc", example 3 (culisse), with AB carried on to AC'
CRANK_M = 0.1


def _swinging(excess: float) -> Trial:
    ground_m = CRANK_M * (1.0 + excess)
    return Trial(hard.slotted_lever("swinging-lever", CRANK_M, ground_m, source="AB/AC to 1"))


def _turning(excess: float) -> Trial:
    crank_m = CRANK_M * (1.0 + excess)
    return Trial(hard.slotted_lever("turning-lever", crank_m, CRANK_M, source="AB/AC to 1"))


_near = partial(
    Case, source=CULISSE, expected="follows", values=(1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
)
LEVERS = (
    _near(
        name="swinging-lever",
        title="Slotted lever, AB/AC up to 1",
        truth="closed form; the lever swings back faster and faster",
        parameter="AC/AB - 1",
        trial=_swinging,
    ),
    _near(
        name="turning-lever",
        title="Whitworth, AB/AC down to 1",
        truth="closed form; the lever turns fully, nearly all at once",
        parameter="AB/AC - 1",
        trial=_turning,
    ),
    through(
        name="lever-through-pivot",
        title="AB = AC: the block runs through the lever's pivot",
        source=CULISSE,
        truth="the lever turns at half the crank's speed, by smooth continuation",
        expected="continues smoothly through the pivot",
        trial=partial(
            four_turns,
            hard.slotted_lever("lever-through-pivot", CRANK_M, CRANK_M, source="AB = AC"),
        ),
    ),
)


THREE_ROCKERS = hard.double_parallelogram(
    "double-parallelogram", source="mobility 0 by count, really 1"
)
DURATION_S = 2.5
"""Time in which the chain turns over once and falls on, four times through flat positions."""
DT_S = 1e-3


def _windows(number: float) -> Trial:
    chain = hard.WindowChain(round(number))
    scene = chain.scene()
    period = scene.driver.law.period_s
    return Trial(
        scene,
        steps_per_turn=period / DT_S,
        turns=DURATION_S / period,
        drive="free",
        start=ChainMotion(chain).motion(np.zeros(1)).state(),
        chain=chain,
    )


REDUNDANCY = (
    through(
        name="double-parallelogram",
        title="Double parallelogram with three rockers",
        source="mobility by count 0, really 1",
        truth="the coupler keeps its direction, by smooth continuation",
        expected="moves, and passes its flat positions smoothly",
        trial=partial(four_turns, THREE_ROCKERS),
    ),
    Case(
        name="n-fourbar",
        title="A chain of windows, falling freely through its flat positions",
        source=hard.SOURCE,
        truth="l theta'' [(N+1)/3 + N] = -g cos(theta) [(N+1)/2 + N], in elliptic functions",
        expected="keeps its energy, and all rods parallel",
        parameter="windows N",
        values=(1.0, 2.0, 5.0, 10.0, 20.0, 40.0),
        trial=_windows,
        scale="whole",
        judge="chain",
    ),
)
