"""An engine that misbehaves on request."""

from __future__ import annotations

from pathlib import Path

import pytest

from sim import registry

BAD_ENGINE = '''
"""MuJoCo, with a fault that a setting chooses."""
import os, time
from dataclasses import replace
import numpy as np
from sim.engine import Profile, Setting
from sim.mujoco import engine as mujoco

def opened(scene, state, settings, dt_s, drive):
    fault = settings["fault"]
    if fault == "abort":
        os.abort()
    elif fault == "hang":
        time.sleep(1000)
    elif fault == "fill":
        np.ones(10**12)
    elif fault == "leave":
        os._exit(5)
    elif fault == "throw":
        raise RuntimeError("no luck")
    held = {name: value for name, value in settings.items() if name != "fault"}
    return mujoco.ENGINE.open(scene, state, held, dt_s, drive)

ENGINE = replace(
    mujoco.ENGINE,
    name="bad",
    profiles={
        name: Profile(name, "bad", "", dict(profile.settings) | {"fault": Setting("none", "")})
        for name, profile in mujoco.ENGINE.profiles.items()
    },
    open=opened,
)
'''
DECLARATION = """
from sim.registry import Declaration
DECLARATION = Declaration("mujoco", "mujoco")
"""
KNOWN = "from sim import registry\nregistry.ENGINES['bad'] = 'bad_engine'\n"


@pytest.fixture
def _bad_engine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An engine `bad` is known here, and in the children of this process."""
    folder = tmp_path / "bad"
    folder.mkdir()
    (folder / "bad_engine").mkdir()
    (folder / "bad_engine" / "__init__.py").write_text(DECLARATION)
    (folder / "bad_engine" / "engine.py").write_text(BAD_ENGINE)
    (folder / "sitecustomize.py").write_text(KNOWN)
    monkeypatch.setenv("PYTHONPATH", str(folder))
    monkeypatch.syspath_prepend(folder)
    monkeypatch.setitem(registry.ENGINES, "bad", "bad_engine")
