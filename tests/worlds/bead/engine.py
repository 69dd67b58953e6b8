"""The fake engine, as it runs a bead: in the right swing, whose time is off as a step makes it."""

from dataclasses import dataclass, replace

from models.array import Array
from models.motion import Motion, State
from models.scene import Scene
from sim.engine import Drive, Settings
from tests.worlds.bead.swing import moved, swing_of
from tests.worlds.fake.engine import FakeEngine, FakeSession


@dataclass(frozen=True)
class BeadEngine(FakeEngine):
    """As `FakeEngine`; a leapfrog's phase is ahead by (pace * step)^2 / 24."""

    def open(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
    ) -> FakeSession:
        def exact(given: Scene, time_s: Array) -> Motion:
            swing = swing_of(given)
            ahead = 1.0 + (swing.pace_rad_s * dt_s) ** 2 / 24.0
            return moved(given, replace(swing, pace_rad_s=swing.pace_rad_s * ahead), time_s)

        return FakeSession(replace(self, exact=exact), scene, state.time_s, settings, dt_s)


ENGINE = BeadEngine()
