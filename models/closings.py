"""Where else the loops of a scene can be closed."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

from models.errors import EngineError
from models.joints import joints
from models.motion import State
from models.scene import Scene
from models.tree import plan


def closings(scene: Scene, state: State) -> Iterator[tuple[str, ...]]:
    """What ``close`` of `models.tree.plan` may name to have other pins closed than by default.

    The fewest pins first; each choice of closures once. Raises EngineError as `plan` does.
    """
    default = plan(scene, state).closures
    seen = {frozenset(default)}
    pins = [pin.point for pin in joints(scene).pins if pin.point != scene.driver_pivot]
    for count in range(1, len(default) + 1):
        for close in itertools.combinations(pins, count):
            try:
                closures = frozenset(plan(scene, state, close).closures)
            except EngineError:
                continue  # no loop closes at all of them
            if closures not in seen:
                seen.add(closures)
                yield close
