"""Bodies placed one beside the other, by the angles and displacements that a start names."""

from __future__ import annotations

import math

import numpy as np

from analytic.multibody.assembly import Assembly
from models.joints import local_point, sliding_angle, sliding_body, turned
from models.scene import GROUND, Point


class StartPoses:
    """Bodies placed one beside the other by the angles that are known."""

    def __init__(self, assembly: Assembly) -> None:
        scene = assembly.scene
        self._scene, self._bodies = scene, assembly.bodies
        theta = float(scene.driver.law.at(np.zeros(1))[0][0])
        self.angles: dict[str, float] = {GROUND: 0.0}
        self.angles |= {**scene.start.angles_rad, scene.driver.link: theta}
        self.origins: dict[str, Point] = {GROUND: (0.0, 0.0)}
        self._known: dict[str, Point] = dict(scene.ground)

    def spread(self) -> None:
        """Place what can be placed, until nothing more can."""
        before = -1
        while before < (before := len(self.origins) + len(self.angles)):
            self._slide()
            for name, link in self._scene.links.items():
                if name not in self.origins:
                    self._place(name, {p: at for p, at in link.points.items() if p in self._known})

    def _place(self, name: str, known: dict[str, Point]) -> None:
        """A link with points in known places."""
        if name not in self.angles and len(known) >= 2:
            (p, a), (q, b) = list(known.items())[:2]
            (px, py), (qx, qy) = self._known[p], self._known[q]
            own = math.atan2(b[1] - a[1], b[0] - a[0])
            self.angles[name] = math.remainder(math.atan2(qy - py, qx - px) - own, math.tau)
        if name in self.angles and known:
            point, local = next(iter(known.items()))
            arm, at = turned(local, self.angles[name]), self._known[point]
            self._settle(name, (at[0] - arm[0], at[1] - arm[1]))

    def _settle(self, name: str, origin: Point) -> None:
        self.origins[name] = origin
        for point, local in self._scene.links[name].points.items():
            arm = turned(local, self.angles[name])
            self._known.setdefault(point, (origin[0] + arm[0], origin[1] + arm[1]))

    def _slide(self) -> None:
        """What slides on a body whose angle is known has one; a named displacement is a place."""
        scene = self._scene
        for name, slider in scene.sliders.items():
            body = sliding_body(slider)
            if slider.on in self.angles:
                angle = self.angles[slider.on] + sliding_angle(slider)
                self.angles.setdefault(body, angle)
            elif body in self.angles:
                self.angles.setdefault(slider.on, self.angles[body] - sliding_angle(slider))
            far = scene.start.displacements_m.get(name)
            if far is not None and slider.on in self.origins:
                base, angle = self.origins[slider.on], self.angles[slider.on]
                c, s = turned((1.0, 0.0), slider.direction_rad)
                x, y = slider.through_m
                place = turned((x + far * c, y + far * s), angle)
                self._known.setdefault(slider.point, (base[0] + place[0], base[1] + place[1]))
            if slider.point in self._known and body in self.angles and body not in self.origins:
                self._settle_at(body, slider.point, name)

    def _settle_at(self, body: str, point: str, name: str) -> None:
        """What slides, with the place of its point known."""
        place = self._known[point]
        if self._scene.sliders[name].link is None:
            self.origins[body] = place
        else:
            arm = turned(local_point(self._scene, body, point), self.angles[body])
            self._settle(body, (place[0] - arm[0], place[1] - arm[1]))
