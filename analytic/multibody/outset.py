"""Coordinates and rates of the start of a motion, from the start in a scene.

The positions are found by Newton's method on all constraints. As many of the named angles and
displacements as the mechanism has freedoms count exactly, the driver's first; further ones are the
first guess of Newton's method, and have to be as near as values read off a drawing. The rates are
those that the constraints allow, and have the named values.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from analytic.multibody.assembly import Assembly
from analytic.multibody.bodies import Configuration
from analytic.multibody.generalised_forces import GeneralisedForces
from models.array import Array
from models.errors import CrankcheckError, few
from models.motion import State
from models.scene import GROUND, Point
from models.scene.joints import frames, local_point, sliding_angle, sliding_body, turned

ROUGH_RAD, ROUGH = math.radians(1.0), 0.01
"""Allowed error of a named angle, and of a named displacement over the longest link, where others
determine the position already."""
SAME = 1e-9
"""Allowed error of a named speed where others determine it already, over the largest."""
INDEPENDENT = 1e-7
"""Singular value over the largest, from which on rows count as independent of each other."""
MOST_STEPS = 60
EPS = float(np.finfo(np.float64).eps)


@dataclass(frozen=True)
class _Named:
    """Value that the start names: of a coordinate, with its derivatives (n,)."""

    words: str
    value: float
    found: float
    row: Array
    rough: float


@dataclass(frozen=True)
class Outset:
    """Finder of the start of the scene of an assembly."""

    assembly: Assembly

    def find(self, near: State | None, bent: Array | None = None) -> tuple[Array, Array]:
        """Return the coordinates and rates (n,) of the start.

        Parameters
        ----------
        near : State or None
            First guess of the position; None for the scene's named values. A driven rigid scene
            takes the rates of the state.
        bent : Array or None
            Coordinates whose coefficients of elastic links count (n,); None for straight links.
            Their rates are 0.

        Raises
        ------
        CrankcheckError
            A start with open joints, or with missing values; speeds that contradict each other.
        """
        scene = self.assembly.scene
        rough = self._guess() if near is None else self._from_state(near)[0]
        if bent is not None:
            own = self.assembly.coefficients
            rough[own] = bent[own]
        if near is not None and not scene.is_free and not self.assembly.elastic:
            return self._closed(rough, []), self._from_state(near)[1]
        q = self._positioned(rough, whole=near is None)
        return q, self._moving(q)

    def _from_state(self, near: State) -> tuple[Array, Array]:
        """Return coordinates and rates at a state; a block without mass has a frame too."""
        assembly = self.assembly
        scene, placed = assembly.scene, frames(assembly.scene, near)
        q, rates = np.zeros(assembly.size), np.zeros(assembly.size)
        sliders = {sliding_body(s): s for s in scene.sliders.values() if s.link is None}
        for body, at in assembly.at.items():
            if body in placed:
                frame = placed[body]
                q[at : at + 3] = *frame.origin, frame.theta
                rates[at : at + 3] = *frame.velocity, frame.omega
            else:
                slider = sliders[body]
                guide = placed[slider.on]
                q[at : at + 3] = *near.position[slider.point], guide.theta + sliding_angle(slider)
                rates[at : at + 3] = *near.velocity[slider.point], guide.omega
        return q, rates

    def _guess(self) -> Array:
        """Place every body by the named angles and displacements of the scene.

        Raises CrankcheckError, with the links that have to be named.
        """
        placing = StartPoses(self.assembly)
        placing.spread()
        missing = [body for body in self.assembly.bodies if body not in placing.origins]
        if missing:
            unknown = [body for body in missing if body not in placing.angles] or missing
            raise CrankcheckError(
                f"{self.assembly.scene.name}: the start of {few(unknown, 8)} is not named; give "
                "their angles in start.angles_deg, to a degree"
            )
        q = np.zeros(self.assembly.size)
        for body, at in self.assembly.at.items():
            q[at : at + 3] = *placing.origins[body], placing.angles[body]
        return q

    def _of_frames(self, rows: Array) -> Array:
        """Return rows of derivatives (m, n) by the coordinates of frames alone."""
        rows = rows.copy()
        rows[:, self.assembly.coefficients] = 0.0
        return rows

    def _named(self, now: Configuration, *, rates: bool) -> Iterator[_Named]:
        """Yield the values that the start names, the driver's first, at coordinates."""
        scene, start = self.assembly.scene, self.assembly.scene.start
        theta, omega, _ = (float(each[0]) for each in scene.driver.law.at(np.zeros(1)))
        own = {scene.driver.link: omega if rates else theta}
        turning = start.rates_rad_s if rates else start.angles_rad
        sliding = start.speeds_m_s if rates else start.displacements_m
        key = "rates_rad_s" if rates else "angles_deg"
        for link, value in [*own.items(), *turning.items()]:
            marker = self.assembly.frames[link]
            found = float((now.velocity if rates else now.place)[0, marker, 2])
            turns = 0.0 if rates else math.tau * round((value - found) / math.tau)
            words = "driver" if link in own else f"start.{key}.{link}"
            yield _Named(words, value - turns, found, now.gradient[0, marker, 2], ROUGH_RAD)
        forces = GeneralisedForces(self.assembly, now.q[0]) if sliding else None
        for name, value in sliding.items():
            assert forces is not None
            slide = forces.slide(name, now)
            found = float((slide.speed if rates else slide.displacement)[0])
            words = f"start.{'speeds_m_s' if rates else 'displacements_m'}.{name}"
            yield _Named(words, value, found, slide.gradient[0], ROUGH * scene.longest_m)

    def _positioned(self, rough: Array, *, whole: bool) -> Array:
        """Return the closed position next to a rough one, with the named values that count."""
        now = self.assembly.at_rest(rough[None])
        rows, counting = self._of_frames(self.assembly.joints.jacobian(now)[0]), []
        frames = 3 * len(self.assembly.bodies)
        rank = self._rank(rows)
        for named in self._named(now, rates=False):
            more = np.vstack([rows, self._of_frames(named.row[None])])
            if self._rank(more) > rank:
                rows, rank = more, rank + 1
                counting.append(named.words)
        if whole and rank < frames:
            raise CrankcheckError(
                f"{self.assembly.scene.name}: {frames - rank} more angles of links are needed "
                f"in start.angles_deg; {few(counting, 8)} determine the others"
            )
        q = self._closed(rough, counting)
        for named in self._named(self.assembly.at_rest(q[None]), rates=False):
            if abs(named.value - named.found) > named.rough:
                raise CrankcheckError(self._apart(named, counting))
        return q

    def _apart(self, named: _Named, counting: list[str]) -> str:
        """Return the text of a named value that the joints do not allow."""
        unit, by = ("m", 1.0) if named.words.startswith("start.displ") else ("deg", 180.0 / math.pi)
        return (
            f"{self.assembly.scene.name}: {named.words} is {by * named.value:.6g} {unit}, and the "
            f"joints are open there by {by * abs(named.value - named.found):.3g} {unit}: with "
            f"{few(counting, 8)} it is {by * named.found:.6g} {unit}"
        )

    def _closed(self, rough: Array, counting: list[str]) -> Array:
        """Close a rough position by Newton's method, by least squares. Raises CrankcheckError."""
        assembly, q = self.assembly, rough
        unit, last = self.assembly.units, math.inf
        for _ in range(MOST_STEPS):
            now = assembly.at_rest(q[None])
            rows, left = [assembly.joints.jacobian(now)[0]], [assembly.joints.gaps(now)[0]]
            for named in self._named(now, rates=False) if counting else ():
                if named.words in counting:
                    rows.append(named.row[None])
                    left.append(np.array([named.found - named.value]))
            step = self._least(self._of_frames(np.vstack(rows)), -np.concatenate(left))
            size = float(np.abs(step / unit).max())
            if size > 0.5:  # no further than half a radian at a time
                step *= 0.5 / size
            q = q + step
            if size <= 4.0 * EPS or (size < 1e-9 and size >= 0.5 * last):
                break
            last = size
        open_by = np.abs(assembly.joints.gaps(assembly.at_rest(q[None]))[0]).max(initial=0.0)
        if open_by > 1e-10 * assembly.scene.longest_m:
            raise CrankcheckError(
                f"{assembly.scene.name}: the start cannot be assembled: at {self._said(counting)} "
                f"the joints stay open by {open_by:.3g} m; name other angles"
            )
        return q

    def _said(self, counting: list[str]) -> str:
        theta = float(self.assembly.scene.driver.law.at(np.zeros(1))[0][0])
        others = [words for words in counting if words != "driver"]
        return few([f"{math.degrees(theta):.6g} deg of the driver", *others], 8)

    def _moving(self, q: Array) -> Array:
        """Return the rates that the joints allow and that have the named values."""
        assembly, scene = self.assembly, self.assembly.scene
        now = assembly.at_rest(q[None])
        named = list(self._named(now, rates=True))
        rows = self._of_frames(
            np.vstack([assembly.joints.jacobian(now)[0], *(one.row for one in named)])
        )
        values = np.array([one.value for one in named])
        if not values.any():
            return np.zeros(assembly.size)
        unnamed = 3 * len(assembly.bodies) - self._rank(rows)
        if unnamed:
            raise CrankcheckError(
                f"{scene.name}: the start moves, and {unnamed} of its freedoms have no speed; give "
                "start.rates_rad_s of as many more links, 0 where they do not turn"
            )
        rates = self._least(rows, np.concatenate([np.zeros(assembly.joints.count), values]))
        off = [abs(float(one.row @ rates) - one.value) for one in named]
        stuck = float(np.abs(assembly.joints.jacobian(now)[0] @ rates).max(initial=0.0))
        worst = int(np.argmax(off))
        # Beside a limit named rates may be slow, and those that follow fast.
        fastest = float(max(np.abs(values).max(), np.abs(rates / assembly.units).max()))
        if max(off[worst], stuck) > SAME * max(1.0, scene.longest_m) * fastest:
            raise CrankcheckError(
                f"{scene.name}: {few([one.words for one in named], 8)} contradict each other: the "
                f"joints allow no speeds of these values; {named[worst].words} is "
                f"{named[worst].value:.6g}, and {named[worst].row @ rates:.6g} in the nearest "
                "that they allow"
            )
        return rates

    def _rank(self, rows: Array) -> int:
        return int(np.linalg.matrix_rank(self.assembly.scaled(rows), tol=INDEPENDENT))

    def _least(self, rows: Array, right: Array) -> Array:
        """Return the smallest of the solutions, or of the nearest to one."""
        scaled = rows * self.assembly.units
        size = np.abs(scaled).max(axis=1, initial=0.0)
        size[size == 0.0] = 1.0
        found = np.linalg.lstsq(scaled / size[:, None], right / size, rcond=INDEPENDENT)[0]
        return np.asarray(found * self.assembly.units)

    def freedoms(self, q: Array) -> Array:
        """Return directions of q that all joints allow, one a row, each of the largest entry 1 in
        the units of coordinates, (f, n)."""
        _, sizes, directions = np.linalg.svd(
            self.assembly.scaled(self.assembly.joints.jacobian(self.assembly.at_rest(q[None]))[0])
        )
        rank = int((sizes > INDEPENDENT).sum())
        free = directions[rank:]
        return np.asarray(free / np.abs(free).max(axis=1, keepdims=True) * self.assembly.units)


class StartPoses:
    """Bodies placed one beside the other by the known angles."""

    def __init__(self, assembly: Assembly) -> None:
        scene = assembly.scene
        self._scene, self._bodies = scene, assembly.bodies
        theta = float(scene.driver.law.at(np.zeros(1))[0][0])
        self.angles: dict[str, float] = {GROUND: 0.0}
        self.angles |= {**scene.start.angles_rad, scene.driver.link: theta}
        self.origins: dict[str, Point] = {GROUND: (0.0, 0.0)}
        self._known: dict[str, Point] = dict(scene.ground)

    def spread(self) -> None:
        """Place all bodies that follow from the known values."""
        before = -1
        while before < (before := len(self.origins) + len(self.angles)):
            self._slide()
            for name, link in self._scene.links.items():
                if name not in self.origins:
                    self._place(name, {p: at for p, at in link.points.items() if p in self._known})

    def _place(self, name: str, known: dict[str, Point]) -> None:
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
        """Give angles to bodies on known lines, and places to points of named displacements."""
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
                place = self._known[slider.point]
                if slider.link is None:
                    self.origins[body] = place
                else:
                    arm = turned(local_point(scene, body, slider.point), self.angles[body])
                    self._settle(body, (place[0] - arm[0], place[1] - arm[1]))
