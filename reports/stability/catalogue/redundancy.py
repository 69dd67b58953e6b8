"""Mechanisms with more links than they need: by count they cannot move, and they do."""

from __future__ import annotations

import numpy as np

from analytic.free.window_chain import ChainMotion
from models.hard import SOURCE, Chain, double_parallelogram
from reports.stability.case import Case, Trial
from reports.stability.catalogue.change_points import four_turns, through

DURATION_S = 2.5
"""The chain turns over once and falls on, four times through flat positions."""
DT_S = 1e-3


def _three_rockers(steps: float) -> Trial:
    scene = double_parallelogram("double-parallelogram", source="mobility 0 by count, really 1")
    return four_turns(scene, steps)


def _windows(number: float) -> Trial:
    chain = Chain(round(number))
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


CASES = (
    through(
        name="double-parallelogram",
        title="Double parallelogram with three rockers",
        source="mobility by count 0, really 1",
        truth="the coupler keeps its direction, by smooth continuation",
        expected="moves, and passes its flat positions smoothly",
        trial=_three_rockers,
    ),
    Case(
        name="n-fourbar",
        title="A chain of windows, falling freely through its flat positions",
        source=SOURCE,
        truth="l theta'' [(N+1)/3 + N] = -g cos(theta) [(N+1)/2 + N], in elliptic functions",
        expected="keeps its energy, and all rods parallel",
        parameter="windows N",
        values=(1.0, 2.0, 5.0, 10.0, 20.0, 40.0),
        trial=_windows,
        scale="whole",
        judge="chain",
    ),
)
