"""Recipes for forces: how to read a joint's reaction and the driving torque out of an engine.

A recipe is a standalone Python program, which knows nothing of crankcheck: to read, to copy, and to
run, which tests do.
"""

from __future__ import annotations

from typing import Protocol, cast

from models.motion import State
from models.scene import Scene
from sim.engine import Settings
from sim.registry import capability


class ForceRecipe(Protocol):
    """What writes the recipe of an engine."""

    def __call__(self, scene: Scene, state: State, settings: Settings, dt_s: float) -> str:
        """The program: it holds ``scene`` from ``state`` on, with a complete set of settings and a
        step [s], turns the driver once, and prints what acts as lines of numbers with commas.

        The first line names the columns: ``time_s``, then ``POINT.BODY.x_n`` and ``POINT.BODY.y_n``
        (the force of the pin at POINT on BODY [N], in the ground's frame) for a pin that closes a
        loop, or for more pins, then ``torque_n_m`` (of the drive on the driver). Times are those at
        which the forces act. Comments say why each line is as it is. Raises EngineError for a scene
        that the engine cannot hold, or that the recipe does not cover.
        """
        ...


def force_recipe(
    engine: str, scene: Scene, state: State, settings: Settings, steps_per_turn: float
) -> str:
    """The recipe of an engine. Raises EngineError where it has none, and as `ForceRecipe`."""
    write = cast(ForceRecipe, capability(engine, "force_recipe"))
    return write(scene, state, settings, scene.driver.law.period_s / steps_per_turn)
