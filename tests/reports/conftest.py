"""Runs of a fake engine whose error is known."""

from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files.reading import load_scene
from models.scene import Scene
from reports.compare.compare import Truth, compare
from reports.compare.errors import Errors
from sim.engine import Poses, Run
from sim.run import run
from tests.worlds import free_store as of_free
from tests.worlds.small_store import filled

STEPS = 720


@pytest.fixture(scope="session")
def store(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder that is a store of two scenes, four variants and four steps, with made-up times."""
    return filled(tmp_path_factory.mktemp("small") / "store")


@pytest.fixture(scope="session")
def free_store(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder that is a store of a scene that was let go (3 s: runs of two engines)."""
    return of_free.filled(tmp_path_factory.mktemp("free") / "store")


@pytest.fixture(scope="session")
def fourbar() -> Scene:
    return load_scene("fourbar-lecture-1")


@pytest.fixture(scope="session")
def slider_crank() -> Scene:
    return load_scene("slider-crank-offset")


@pytest.fixture(scope="session")
def disturbed(fake_engine: ModuleType) -> Callable[..., Run]:
    """A run over one turn whose poses were disturbed on purpose."""

    def make(
        scene: Scene,
        disturb: Callable[[Poses], Poses] = lambda poses: poses,
        steps: int = STEPS,
        **options: object,
    ) -> Run:
        engine = fake_engine.FakeEngine(disturb=disturb, **options)
        state = solve(scene, np.zeros(1)).state()
        return run(scene, state, engine, dt_s=scene.driver.law.period_s / STEPS, steps=steps)

    return make


@pytest.fixture(scope="session")
def errors_of(disturbed: Callable[..., Run]) -> Callable[..., Errors]:
    def find(scene: Scene, *args: object, **options: object) -> Errors:
        return compare(Truth(scene).beside(disturbed(scene, *args, **options)))

    return find
