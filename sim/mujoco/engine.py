"""MuJoCo: hinges and slides as joint coordinates, loops closed by soft `connect` constraints."""

from __future__ import annotations

from collections.abc import Mapping

from models.motion import State
from models.scene import Scene
from sim.engine import Drive, Profile, Settings
from sim.mujoco.session import VERSION, MujocoSession
from sim.mujoco.settings import AS_SHIPPED, TUNED, checked


class MujocoEngine:
    """The adapter."""

    name = "mujoco"
    reports_accelerations = True
    profiles: Mapping[str, Profile] = {"as-shipped": AS_SHIPPED, "tuned": TUNED}

    def version(self) -> str:
        """The version of the C library."""
        return VERSION

    def check(self, settings: Settings) -> None:
        """Raise SettingError for a value that MuJoCo does not take."""
        checked(settings)

    def open(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
    ) -> MujocoSession:
        """A session at ``state``; EngineError where MuJoCo cannot hold the scene."""
        return MujocoSession(scene, state, settings, dt_s, drive)


ENGINE = MujocoEngine()
