"""A chunk of samples while its groups are solved one after the other."""

from __future__ import annotations

from dataclasses import dataclass, field

from analytic.dyads.parts import Dyad, Sliding
from analytic.plane import BodyKinematics, PointKinematics, Real, fixed_point
from models.joints import local_point
from models.scene import GROUND, Scene


@dataclass(slots=True)
class Chunk:
    """What is known so far of a chunk of samples."""

    scene: Scene
    certified: bool
    stretch: bool
    bodies: dict[str, BodyKinematics]
    sliders: dict[str, Sliding] = field(default_factory=dict)
    sines: dict[str, Real] = field(default_factory=dict)
    shortage: dict[str, Real] = field(default_factory=dict)
    points: dict[str, PointKinematics] = field(default_factory=dict)

    def point(self, body: str, name: str) -> PointKinematics:
        """A named point by way of ``body``, worked out once."""
        if name not in self.points:
            local = local_point(self.scene, body, name)
            self.points[name] = (
                fixed_point(local) if body == GROUND else self.bodies[body].point(local)
            )
        return self.points[name]

    def keep(self, key: str, dyad: Dyad) -> None:
        """Note the conditioning of a solved dyad."""
        self.sines[key] = dyad.sine
        if dyad.short_m is not None:
            self.shortage[key] = dyad.short_m
