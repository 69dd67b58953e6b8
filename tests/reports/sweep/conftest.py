"""The command `crankcheck` as a process of its own, and an engine that misbehaves on request."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from tests.worlds.command import COMMAND, script

BAD_ENGINE = '''
"""MuJoCo, with a fault that a setting chooses."""
import os, time
import numpy as np
from sim.engine import Profile, Setting
from sim.mujoco.engine import MujocoEngine

class BadEngine(MujocoEngine):
    name = "bad"
    profiles = {
        name: Profile(name, "bad", "", dict(profile.settings) | {"fault": Setting("none", "")})
        for name, profile in MujocoEngine.profiles.items()
    }

    def open(self, scene, state, settings, dt_s, drive):
        fault = settings["fault"]
        if fault == "abort":
            os.abort()
        elif fault == "slow":
            time.sleep(5)
        elif fault == "hang":
            time.sleep(1000)
        elif fault == "fill":
            np.ones(10**12)
        elif fault == "leave":
            os._exit(5)
        elif fault == "throw":
            raise RuntimeError("no luck")
        held = {name: value for name, value in settings.items() if name != "fault"}
        return super().open(scene, state, held, dt_s, drive)

ENGINE = BadEngine()
'''
DECLARATION = """
from sim.registry import Declaration
DECLARATION = Declaration("mujoco", "mujoco")
"""
KNOWN = "from sim import registry\nregistry.ENGINES['bad'] = 'bad_engine'\n"
Started = Callable[..., "subprocess.Popen[str]"]


@pytest.fixture(scope="session")
def start() -> Started:
    """Starts `crankcheck` with arguments; its output is to be read from the process."""

    def begin(
        *arguments: object, more: Mapping[str, str] | None = None, cwd: Path | None = None
    ) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [COMMAND, *map(str, arguments)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            cwd=cwd,
            env={**os.environ, **(more or {})},
        )

    return begin


@pytest.fixture
def bad_engine(tmp_path: Path) -> dict[str, str]:
    """The environment in which an engine `bad` is known."""
    folder = tmp_path / "bad"
    folder.mkdir()
    (folder / "bad_engine").mkdir()
    (folder / "bad_engine" / "__init__.py").write_text(script(DECLARATION))
    (folder / "bad_engine" / "engine.py").write_text(script(BAD_ENGINE))
    (folder / "sitecustomize.py").write_text(script(KNOWN))
    return {"PYTHONPATH": str(folder)}
