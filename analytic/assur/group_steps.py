"""From the structure of a scene to its steps, one for each group and each redundant link."""

from __future__ import annotations

from collections.abc import Sequence

from analytic.dyads.redundant import BridgeStep
from analytic.dyads.riding import Placed
from analytic.dyads.steps import DYAD_STEPS, Step
from analytic.structure.groups import Bridge, Group, Triad
from analytic.structure.mobility import Structure
from models.scene import GROUND, Scene


def prepare(scene: Scene, structure: Structure) -> list[Step]:
    """The steps of all groups, in solving order."""
    driver, compound = scene.driver, structure.compound
    known = {GROUND} if compound is not None else {GROUND, driver.link}
    steps: list[Step] = []
    for part in structure.order:
        placed = Placed(scene, structure, frozenset(known))
        if isinstance(part, Bridge):
            steps.append(BridgeStep(placed, part))
        elif isinstance(part, Triad) or (compound is not None and compound.name in part.bodies):
            steps.append(_step_of_class_three(placed, part, steps))
        else:
            steps.append(DYAD_STEPS[part.kind](placed, part))
        known.update(part.bodies)
        if compound is not None and compound.name in part.bodies:
            known.update((compound.base, compound.link))
    return steps


def _step_of_class_three(placed: Placed, part: Group | Triad, before: Sequence[Step]) -> Step:
    """The step of a triad, or of a dyad with a compound: most scenes have none, nor load it."""
    from analytic.assur.mounting import Mounting
    from analytic.assur.step import AssurStep

    return AssurStep(Mounting(placed, part), before)
