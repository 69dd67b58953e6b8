"""A matrix of hard cases as the page gets it: real runs of shipped scenes, some of which fail."""

import itertools
from dataclasses import replace

from models.files.reading import load_scene
from reports.output.write import provenance
from reports.stability.case import Case, Trial
from reports.stability.grading import graded
from reports.stability.matrix import Matrix
from reports.stability.running import critical

LINES = tuple((e, p) for e in ("mujoco", "pymunk") for p in ("as-shipped", "tuned"))
STEPS = (360.0, 90.0, 30.0, 12.0)
BETWEEN = 60.0
"""A value that stands for one that a bisection looked at."""
SCENES = {
    "fourbar-lecture-1": ("Large steps", "Crank-rocker in ever larger steps"),
    "slider-crank-offset": ("Large steps", "Offset slider-crank in ever larger steps"),
    "shaper": ("Heavy slides", "Shaper: a heavy ram on a slotted lever"),
}


def case_of(name: str) -> Case:
    (group, title), scene = SCENES[name], load_scene(name)
    return Case(
        name=f"{name}-steps", group=group, title=title, source=scene.source,
        truth="The closed form at every instant.",
        expected="follows, with an error that falls with the square of the step",
        parameter="steps in a turn", values=STEPS, labels=tuple(f"{n:g}" for n in STEPS),
        trial=lambda steps: Trial(scene, steps),
    )  # fmt: skip


def matrix() -> Matrix:
    runs, pictures, ends = [], [], []
    cases = [case_of(name) for name in SCENES]
    for case, line in itertools.product(cases, LINES):
        found = [graded(case, *line, steps, draw=True) for steps in (*STEPS, BETWEEN)]
        own = [replace(run, grid=run.value != BETWEEN) for run, _ in found]
        runs += own
        pictures += [picture for _, picture in found if picture is not None]
        ends.append(critical(case, own))
    facts = provenance({"mujoco": "4.0.0", "pymunk": "7.3.1"})
    known = tuple(case.facts() for case in cases)
    return Matrix(facts, known, tuple(runs), tuple(ends), tuple(pictures))
