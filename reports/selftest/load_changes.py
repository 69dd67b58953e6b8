"""Change what a load does to the forces of a log."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from models.characteristics import Sine
from models.loads import Load
from models.motion import Forces
from models.scene import Scene
from reports.selftest.force_changes import Change, changed_by_scene, largest_n
from reports.selftest.logs import last
from sim.engine import Run


def of_load(wrong: Callable[[Load, Run, float], Load | None]) -> Change:
    """A load, as large as the largest reaction, is felt otherwise than it acts, or not at all. What
    loads do adds up, so that the scene need have none."""

    def changed(scene: Scene, done: Run, own: Forces, size: float) -> Forces:
        name = last(scene)
        point = [each for each in scene.links[name].points if each not in scene.ground][-1]
        right = Load("push", name, point, Sine(largest_n(own), scene.driver.law.period_s))
        felt = wrong(right, done, size)
        return changed_by_scene(own, _loaded(scene, right), _loaded(scene, felt) if felt else scene)

    return changed


def _loaded(scene: Scene, load: Load) -> Scene:
    return replace(scene, loads={**scene.loads, load.name: load})


def load_late(load: Load, done: Run, steps: float) -> Load:
    """A load over time, felt some steps later."""
    return replace(load, characteristic=load.characteristic.carried(1.0, shift=steps * done.dt_s))


def load_in_body(load: Load, _: Run, size: float) -> Load:
    """A load along an axis of the body, not of the ground."""
    return replace(load, frame="body")
